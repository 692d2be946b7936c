# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The command: exit codes, sentences, and what is imported when."""

import json
from pathlib import Path
import subprocess
import sys

from ballscrew_monitor import cli
from ballscrew_monitor.cycle.node_process import child_environment
from ballscrew_monitor.node.restart_state import RestartState
from ballscrew_monitor.node.state_records import entry_of, Kind
import pytest
from surrogate.files import InputError
from surrogate.parameters import find_sheet
from surrogate.surface import SurfaceError

ROOT = Path(__file__).resolve().parents[2]
PARAMS = ROOT / 'config' / 'nominal_cycle.yaml'
UNREADABLE = 'cannot be read or written'
VISCOSITY = 'oil: viscosity is -1 Pa s, allowed is above 0'


def python(*arguments, **environment):
    return subprocess.run(
        [sys.executable, *map(str, arguments)],
        cwd=ROOT,
        env=child_environment(0) | environment,
        capture_output=True,
        text=True,
        check=False,
    )


def test_a_replay_prints_the_summary_or_json(short_bag, capsys, says):
    assert cli.main(['replay', str(short_bag), '--params', str(PARAMS)]) == 0
    out = capsys.readouterr().out
    assert out.startswith(says('300_speed_samples'))
    assert '  events      1\n' in out
    assert cli.main(['replay', str(short_bag), '--params', str(PARAMS), '--json']) == 0
    record = json.loads(capsys.readouterr().out)
    assert record['x']['judged'] == 300
    assert record['x']['events'][0]['cause'] == 'RCS >= limit'


def test_a_terminal_that_lacks_a_character_shows_a_mark(short_bag):
    done = python('-m', 'ballscrew_monitor', 'replay', short_bag, PYTHONIOENCODING='ascii')
    assert done.returncode == 0, done.stderr
    assert ' ?C, ' in done.stdout


@pytest.mark.parametrize('command', ['replay', 'health', 'run'])
def test_a_recording_that_is_refused_in_its_middle_leaves_no_folder(
    short_bag, tmp_path, capsys, command
):
    damaged, out = tmp_path / 'damaged.mcap', tmp_path / 'new' / 'out'
    data = bytearray((short_bag / 'short.mcap').read_bytes())
    data[3 * len(data) // 10] ^= 0x55
    damaged.write_bytes(data)
    log = ['--bag', str(damaged)] if command == 'run' else [str(damaged)]
    assert cli.main([command, *log, '--params', str(PARAMS), '--out', str(out)]) == 2
    assert 'is truncated or damaged' in capsys.readouterr().err
    assert list(tmp_path.iterdir()) == [damaged]


def test_a_replay_that_judges_nothing_is_a_failure(short_bag, tmp_path, capsys, says):
    params = tmp_path / 'params.yaml'
    text = PARAMS.read_text(encoding='utf-8')
    params.write_text(text + "      speed: {field: 'velocity[nope]'}\n", encoding='utf-8')
    assert cli.main(['replay', str(short_bag), '--params', str(params)]) == 1
    assert says('nothing_was_judged') in capsys.readouterr().err


def test_defaults_hold_in_any_working_directory(short_bag, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    assert cli.main(['replay', str(short_bag)]) == 0
    assert '300 speed samples judged' in capsys.readouterr().out


@pytest.mark.parametrize(
    ('error', 'code', 'sentence'),
    [
        (OSError(28, 'No space left on device'), 1, 'there_cannot_read'),
        (InputError(VISCOSITY), 2, 'oil_viscosity_1'),
        (SurfaceError(VISCOSITY), 2, 'oil_viscosity_1'),
        (KeyboardInterrupt(), 130, 'interrupted_2'),
    ],
)
def test_an_end_is_a_sentence_and_an_exit_code(error, code, sentence, monkeypatch, capsys, says):
    def fail(args):
        raise error

    monkeypatch.setitem(cli.COMMANDS, 'run', (fail, ''))
    assert cli.main(['run', '--out', 'there']) == code
    assert capsys.readouterr() == ('', f'ballscrew: {says(sentence)}\n')


def test_a_fault_of_the_program_is_a_sentence_and_a_file_to_send(
    monkeypatch, capsys, says, tmp_path
):
    def fail(args):
        raise RuntimeError('no\x1b[2J')

    monkeypatch.setattr(cli.tempfile, 'tempdir', str(tmp_path))
    monkeypatch.setitem(cli.COMMANDS, 'run', (fail, ''))
    assert cli.main(['run']) == 70
    (file,) = tmp_path.iterdir()
    assert capsys.readouterr() == ('', f'ballscrew: {says("bug")}{file}\n')
    text = file.read_text(encoding='utf-8')
    assert 'Traceback (most recent call last)' in text
    assert text.endswith('RuntimeError: no\x1b[2J\n')


def test_what_does_not_exist_is_refused(capsys, says, tmp_path):
    assert cli.main(['replay', '/nowhere', '--params', str(PARAMS)]) == 2
    assert capsys.readouterr().err == says('log_nowhere_does')
    assert cli.main(['events', str(tmp_path)]) == 2
    assert f'{tmp_path} has no state.sqlite3' in capsys.readouterr().err


def test_every_command_is_listed(capsys):
    with pytest.raises(SystemExit) as caught:
        cli.main(['--help'])
    assert caught.value.code == 0
    out = capsys.readouterr().out
    for command in ('run', 'replay', 'play', 'point', 'surface'):
        assert f'    {command} ' in out


@pytest.mark.parametrize('command', ['run', 'replay'])
def test_help_names_the_defaults_without_the_place_of_the_clone(command, capsys):
    with pytest.raises(SystemExit):
        cli.main([command, '--help'])
    out = ' '.join(capsys.readouterr().out.split())
    assert 'config/nominal_cycle.yaml of the repository' in out
    assert str(ROOT) not in out


def test_offline_commands_import_no_ros(tmp_path):
    """The point is one of a smooth raceway, which has no onset of contact to look for."""
    sheet = tmp_path / 'smooth.yaml'
    sheet.write_text(find_sheet('nominal', 'screws').read_text().replace('0.12\n', '0.0\n'))
    script = (
        'import sys\n'
        'from ballscrew_monitor.cli import main\n'
        "more = ['--tier', 'closed_form', '--screw', sys.argv[1]]\n"
        "code = main(['point', '--speed-rpm', '600', '--load-N', '1000', *more])\n"
        "print(code, [name for name in sys.modules if name.split('.')[0] in\n"
        "      ('rclpy', 'ballscrew_msgs', 'mcap', 'matplotlib')])\n"
    )
    done = python('-c', script, sheet)
    assert done.returncode == 0, done.stderr
    assert done.stdout.splitlines()[-1] == '0 []'


def test_a_reader_that_has_seen_enough_is_no_crash(short_bag):
    process = subprocess.Popen(
        [sys.executable, '-m', 'ballscrew_monitor', 'replay', short_bag, '--params', PARAMS],
        cwd=ROOT,
        env=child_environment(0),
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )
    process.stdout.close()
    errors = process.stderr.read()
    process.stderr.close()
    process.wait()
    assert 'Traceback' not in errors


@pytest.fixture(name='state')
def make_state(tmp_path):
    state = RestartState(tmp_path / 'ballscrew_monitor' / 'ballscrew_monitor')
    state.keep(None, entry_of(Kind.NODE_START, None, 1, {}))
    seen = {'event': 4, 'name': 'Ada\x1b[2J', 'reason': 'nut is ordered'}
    state.keep(None, entry_of(Kind.ACKNOWLEDGE, 'x', 2, seen))
    facts = {'event': 4, 'text': '', 'ending': 'ended', 'worst_value': float('nan')}
    state.keep(None, entry_of(Kind.EVENT_END, 'x', 2, facts))
    state.flush()
    yield state
    state.close()


def test_the_event_log_is_printed_as_text_and_json(state, capsys, monkeypatch, tmp_path):
    assert cli.main(['events', str(state.folder)]) == 0
    start, seen, end = capsys.readouterr().out.splitlines()
    assert start.split()[1:] == ['-', 'node_start']
    assert seen.endswith(r'  x         acknowledge     event 4: by Ada\x1b[2J: nut is ordered')
    assert end.split()[1:] == ['x', 'event_end', 'event', '4:', 'ended']
    monkeypatch.setenv('XDG_STATE_HOME', str(tmp_path))
    state.close()
    assert cli.main(['events', '--json']) == 0
    start, seen, end = map(json.loads, capsys.readouterr().out.splitlines())
    assert (seen['name'], seen['reason']) == ('Ada\x1b[2J', 'nut is ordered')
    assert (start['kind'], start['axis'], start['stamp_ns']) == ('node_start', None, 1)
    assert (end['event'], end['worst_value'], end['ending']) == (4, None, 'ended')
