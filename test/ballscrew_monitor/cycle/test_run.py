# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The main job from end to end, on a short bag: the real node, the real middleware."""

import contextlib
import dataclasses
import json
import os
from pathlib import Path
import re
import signal
import subprocess
import sys
import threading
import types

from ballscrew_monitor.cli import main
from ballscrew_monitor.core.fault_codes import Fault
from ballscrew_monitor.core.fields import stamp_of
from ballscrew_monitor.cycle.node_process import child_environment, ros_environment
from ballscrew_monitor.cycle.outcome import plan
from ballscrew_monitor.cycle.run import run, Supervision
from ballscrew_monitor.messages import diagnostics
from ballscrew_monitor.recordings.bag import Bag
from ballscrew_monitor.recordings.replay import replay
from ballscrew_monitor.settings.parameters import read_file
from ballscrew_msgs.msg import BallScrewState
from diagnostic_msgs.msg import DiagnosticArray
import polars as pl
import pytest
from rclpy.serialization import deserialize_message, serialize_message
from rosbags.highlevel import AnyReader
from surrogate.tasks import child

ROOT = Path(__file__).resolve().parents[3]
PARAMS = ROOT / 'config' / 'nominal_cycle.yaml'
DEADLINE = 600.0  # [s] which only ends a hang
STATE = '/ballscrew_monitor/x/state'


def start(*arguments):
    return subprocess.Popen(
        [sys.executable, '-u', '-m', 'ballscrew_monitor', 'run', *map(str, arguments)],
        cwd=ROOT,
        env=child_environment(0),
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )


@contextlib.contextmanager
def running(bag, out):
    """Start a run and wait for its status; give its process and the number of its node."""
    with start('--bag', bag, '--params', PARAMS, '--out', out) as process:
        for line in process.stdout:
            if line.startswith('['):
                break
        children = Path(f'/proc/{process.pid}/task/{process.pid}/children').read_text()
        yield process, int(children)


@pytest.fixture(scope='module')
def patient(tmp_path_factory):
    """Return parameters of the cycle whose inputs stay fresh on a machine that is busy."""
    path = tmp_path_factory.mktemp('params') / 'patient.yaml'
    waits = ''.join(f'      {name}:\n        timeout: 60.0\n' for name in ('speed', 'load'))
    path.write_text(PARAMS.read_text() + waits)
    return path


@pytest.fixture(scope='module')
def finished(short_bag, patient, tmp_path_factory):
    out = tmp_path_factory.mktemp('run') / 'out'
    with start('--bag', short_bag, '--params', patient, '--out', out) as process:
        text, errors = process.communicate(timeout=DEADLINE)
    return out, text, errors, process.returncode


def test_it_succeeds_and_leaves_its_products_and_no_process(finished, is_alive):
    out, text, errors, code = finished
    assert (code, errors) == (0, '')
    assert {path.name for path in out.iterdir() if not path.name.startswith('.')} == {
        *('cycle.mcap', 'metadata.yaml', 'node.log', 'ros_log'),
        *('cycle.png', 'events.csv', 'judged', 'report.html', 'states.parquet', 'summary.json'),
    }
    assert '300 sent, 300 judged' in text
    assert re.search(r'^\[#+\.*\] 0:\d\d left .* rev/min .* RCS ', text, flags=re.MULTILINE)
    assert 'zone        optimal' in text
    pid = int(re.search(r'process (\d+)', finished[1]).group(1))
    assert not is_alive(pid)


def test_its_page_is_that_of_a_replay_and_another_library_reads_its_recording(finished, tmp_path):
    assert main(['replay', str(finished[0] / 'cycle.mcap'), '--out', str(tmp_path)]) == 0
    for name in ('report.html', 'summary.json', 'events.csv'):
        assert (tmp_path / name).read_bytes() == (finished[0] / name).read_bytes()
    with AnyReader([finished[0]]) as reader:
        for connection, _, data in reader.messages():
            reader.deserialize(data, connection.msgtype)
        assert set(reader.topics) == set(Bag(finished[0]).topics)


def test_its_page_shows_what_the_node_judged(finished, says):
    names = ['stamp', 'speed', 'axial_load', 'zone']
    rows = pl.read_parquet(finished[0] / 'states.parquet').select(pl.col(names).to_physical())
    zones = {tuple(point): zone for *point, zone in rows.rows()}
    states = [
        deserialize_message(message.data, BallScrewState)
        for message in Bag(finished[0]).messages([STATE])
    ]
    judged = {
        (stamp_of(state), state.point.speed, state.point.axial_load): state.zone
        for state in states
    }
    # Between topics the order of arrival is not promised: a speed may meet the next load.
    paired = zones.keys() & judged.keys()
    assert len(paired) > 0.3 * len(zones)
    assert all(zones[point] == judged[point] for point in paired)
    (note,) = json.loads((finished[0] / 'summary.json').read_text())['notes']
    assert note.startswith(says('during_run_node'))


def test_the_recording_holds_inputs_and_outputs(finished, short_bag):
    recorded, played = Bag(finished[0]), Bag(short_bag)
    for topic, info in played.topics.items():
        assert recorded.topics[topic].count == info.count
    assert recorded.topics[STATE].count >= played.topics['/joint_states'].count
    for name in ('x/out_of_zone', 'x/surface_info'):
        assert recorded.topics[f'/ballscrew_monitor/{name}'].count >= 1
    assert recorded.topics['/diagnostics'].count >= 1


def test_the_node_says_what_the_replay_says(finished, short_bag, patient):
    online = [
        deserialize_message(message.data, BallScrewState)
        for message in Bag(finished[0]).messages([STATE])
    ]
    # A tick that finds the speed stale, on a busy machine, repeats the number of the last sample.
    first = {state.judged: state for state in reversed(online) if state.judged}
    online = [what_was_judged(first[number]) for number in sorted(first)]
    offline = [what_was_judged(state) for state, _ in replay(Bag(short_bag), read_file(patient))]
    assert [sample for sample, _, _ in online] == [sample for sample, _, _ in offline]
    # Between topics the order of arrival is not promised: a speed may meet the next load.
    paired = [
        (here, there)
        for (_, point, here), (_, other, there) in zip(online, offline, strict=True)
        if point == other
    ]
    assert paired
    assert all(here == there for here, there in paired)


def what_was_judged(state):
    """Return the sample, its operating point and what came out, comparable in spite of NaN."""
    return (stamp_of(state), state.judged), str(state.point), str((state.zone, state.result))


def test_an_interrupt_ends_everything_in_order(
    short_bag, nominal_bag, tmp_path, bound_addresses, is_alive, refused
):
    out = tmp_path / 'out'
    with running(nominal_bag, out) as (process, node):
        refused('use_by_another', run, plan(short_bag, PARAMS, out, 1.0))
        for pid in (process.pid, node):  # nothing that another machine could reach
            assert {address for address, _ in bound_addresses(pid)} == {'127.0.0.1'}
        process.send_signal(signal.SIGTERM)
        _, errors = process.communicate(timeout=DEADLINE)
    assert process.returncode == 128 + signal.SIGTERM
    assert errors.startswith('ballscrew: interrupted')
    assert not is_alive(node)
    recorded = Bag(out)
    list(recorded.messages())
    assert recorded.topics[STATE].count >= 1


def test_a_reader_that_goes_away_ends_it(nominal_bag, tmp_path, is_alive):
    with running(nominal_bag, tmp_path / 'out') as (process, node):
        process.stdout.close()
        errors = process.stderr.read()
        process.wait(DEADLINE)
    assert (process.returncode, errors) == (1, '')
    assert not is_alive(node)
    list(Bag(tmp_path / 'out').messages())


def test_a_node_that_dies_is_a_failure(nominal_bag, tmp_path):
    with running(nominal_bag, tmp_path / 'out') as (process, node):
        os.kill(node, signal.SIGKILL)
        _, errors = process.communicate(timeout=DEADLINE)
    assert process.returncode == 1
    assert 'the node ended with exit code -9' in errors
    list(Bag(tmp_path / 'out').messages())


def keep_environment(monkeypatch):
    """Have the variables that a run sets put back."""
    for name, value in ros_environment(0).items():
        monkeypatch.setenv(name, value)


def test_a_node_that_dies_at_its_start_is_a_failure(short_bag, tmp_path, monkeypatch, capsys):
    keep_environment(monkeypatch)
    old = [tmp_path / name for name in ('cycle.png', 'report.html', 'judged/judged.mcap')]
    (tmp_path / 'judged').mkdir()
    for path in old:
        path.write_bytes(b'of an earlier run')
    made = plan(short_bag, PARAMS, tmp_path, 1.0)
    monkeypatch.setattr(child, 'sys', types.SimpleNamespace(executable='false'))
    assert run(made) == 1
    out, err = capsys.readouterr()
    assert err.startswith('ballscrew: the node ended with exit code 1')
    assert out.endswith('node.log; nothing was recorded\n')
    assert not any(path.exists() for path in old)


def test_samples_without_a_verdict_are_a_failure(short_bag, tmp_path, monkeypatch, capsys):
    keep_environment(monkeypatch)
    params = tmp_path / 'params.yaml'
    params.write_text(
        '/**/ballscrew_monitor:\n  ros__parameters:\n    x:\n'
        '      load: {offset: 9.0e+3}\n      temperature: {topic: oil_temperature}\n'
    )
    assert run(plan(short_bag, params, tmp_path / 'out', 1.0)) == 1
    err = capsys.readouterr().err
    assert re.search(
        r'had no verdict, the recorded states name the reason$', err, flags=re.MULTILINE
    )
    axis = json.loads((tmp_path / 'out' / 'summary.json').read_text())['axes']['x']
    assert axis['time_by_reason_s']['load_out_of_range'] > 0.0


def test_what_is_not_judged_is_a_failure(short_bag, patient, tmp_path, monkeypatch, capsys, says):
    keep_environment(monkeypatch)
    made = plan(short_bag, patient, tmp_path, 1.0)
    assert run(dataclasses.replace(made, expected={'x': made.expected['x'] + 1})) == 1
    assert capsys.readouterr().err == says('300_301_speed')
    assert [thread.name for thread in threading.enumerate() if thread.name == 'player'] == []


@pytest.mark.parametrize(
    ('change', 'expected'),
    [
        ({'bag': Path('/nowhere')}, 'bag_nowhere_does'),
        ({'params': Path('/nowhere.yaml')}, 'file_cannot_read'),
        ({'rate': 0.0}, 'rate_0_above'),
        ({'rate': float('nan')}, 'rate_nan'),
        ({'out': Path('/proc/nowhere')}, 'output_directory_proc'),
    ],
)
def test_bad_input_is_one_sentence_at_once(short_bag, tmp_path, change, expected, refused):
    given = {'bag': short_bag, 'params': PARAMS, 'out': tmp_path / 'out', 'rate': 1.0} | change
    with refused(expected):
        run(plan(given['bag'], given['params'], given['out'], given['rate']))
    assert not (tmp_path / 'out').exists()


def test_the_bag_is_not_overwritten_by_its_recording(finished, refused):
    refused('would_overwritten', plan, finished[0], PARAMS, finished[0], 1.0)


def test_of_a_damaged_bag_what_is_whole_is_to_be_judged(short_bag, tmp_path):
    data = (short_bag / 'short.mcap').read_bytes()
    cut = tmp_path / 'cut.mcap'
    cut.write_bytes(data[: 3 * len(data) // 4])
    made, whole = (plan(bag, PARAMS, tmp_path / 'out', 1.0) for bag in (cut, short_bag))
    assert 0 < made.expected['x'] < whole.expected['x']
    assert made.expected['x'] == made.bag.topics['/joint_states'].count
    assert 'is truncated or damaged: used are the ' in made.bag.notes[0]


def test_parameters_that_the_node_would_refuse_are_refused_first(short_bag, tmp_path, refused):
    params = tmp_path / 'params.yaml'
    params.write_text("/**/ballscrew_monitor:\n  ros__parameters:\n    x:\n      oil: 'olive'\n")
    refused('surface_shipped_screw', plan, short_bag, params, tmp_path / 'out', 1.0)
    assert [path.name for path in tmp_path.iterdir()] == ['params.yaml']


@pytest.mark.parametrize(
    ('code', 'sentence', 'is_final'),
    [
        (Fault.NOT_BUILT, 'whatever the sentence says', True),
        (Fault.NOT_CONFIGURED, 'not configured: yet', False),
    ],
)
def test_an_axis_that_cannot_be_built_is_known_by_its_code(code, sentence, is_final):
    """Whoever rewords the sentence does not make the run wait for a node that has given up."""
    run_so_far = types.SimpleNamespace(
        _active=set(), _plan=types.SimpleNamespace(expected={'x': 1}), _reason=''
    )
    array = DiagnosticArray(status=diagnostics.failed('/n', 'x', sentence, code))
    Supervision._on_diagnostics(run_so_far, serialize_message(array))
    assert run_so_far._reason == (sentence if is_final else '')
