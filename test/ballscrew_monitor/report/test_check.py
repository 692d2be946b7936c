# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""`ballscrew check`: a folder of logs and a sheet become a page, maps, sheets and surfaces."""

import json
import math
import shutil

from ballscrew_monitor import cli
from ballscrew_monitor.recordings.opener import opened_log
from ballscrew_monitor.recordings.tables.mapping import read_map
from ballscrew_monitor.report.free_run import identified
from ballscrew_monitor.report.parameters import parameters_for
from ballscrew_monitor.settings.parameters import read_file
import pytest
from surrogate.parameters import find_sheet, load_lubricant, load_screw
from surrogate.surface import shipped_surface

SPEEDS = [20.0, 40.0, 60.0, 80.0, 100.0]
QUICK = ['--tier', 'closed_form', '--workers', '1']
SHEETS = ['--screw', 'nominal', '--oil', 'iso_vg_68']


def write(path, speeds, *, load=-1500.0, drag=0.3, time='time_s', loads=True):
    """Write 4 s at each speed [mm/s] at 100 Hz, with a load [N] and the motor torque [N m]."""
    path.parent.mkdir(exist_ok=True, parents=True)
    lines = [f'{time},x_velocity_mm_s' + (',x_force_N' if loads else '') + ',x_torque_Nm,oil_C']
    for row in range(400 * len(speeds)):
        speed = speeds[row // 400]
        torque = math.copysign(drag, speed) + 0.003 * math.sin(1.7 * row)
        force = f',{load + 10.0 * math.sin(0.1 * row):.2f}' if loads else ''
        lines.append(f'{row / 100:.2f},{speed}{force},{torque:.5f},38')
    path.write_text('\n'.join(lines) + '\n')
    return path


def check(folder, tmp_path, *more):
    return cli.main(['check', str(folder), '--out', str(tmp_path / 'out'), *QUICK, *more])


def test_a_table_and_a_sheet_become_a_page_and_the_map_that_was_used(tmp_path, capsys):
    write(tmp_path / 'logs' / 'cut.csv', SPEEDS)
    assert check(tmp_path / 'logs', tmp_path, *SHEETS, '--json') == 0
    record = json.loads(capsys.readouterr().out)
    axis = record['recordings']['cut.csv']['axes']['x']
    assert (axis['expected'], axis['judged']) == (2000, 2000)
    assert record['surfaces']['x'] == str(shipped_surface(tier='closed_form'))
    mapping = tmp_path / 'out' / record['recordings']['cut.csv']['map']
    stated = read_map(mapping).content['axes']['x']
    assert (stated['screw'], stated['oil']) == ('nominal', 'iso_vg_68')
    arguments = ['replay', str(tmp_path / 'logs' / 'cut.csv'), '--map', str(mapping), '--json']
    assert cli.main(arguments) == 0
    assert json.loads(capsys.readouterr().out)['x']['verdict'] == axis['verdict']
    page = (tmp_path / 'out' / 'index.html').read_text()
    for head in ('What to do next, and what to record', 'What was read', 'Surfaces'):
        assert f'<h2>{head}</h2>' in page
    assert axis['verdict'] in page
    assert 'href="maps/cut.yaml"' in page


def test_a_bag_is_judged_by_the_sheet_that_lies_in_the_folder(short_bag, tmp_path, capsys):
    folder = tmp_path / 'logs'
    shutil.copytree(short_bag, folder / 'bag')
    shutil.copy(find_sheet('nominal', 'screws'), folder / 'screw.yaml')
    assert check(folder, tmp_path, '--json') == 0
    record = json.loads(capsys.readouterr().out)
    written = read_file(tmp_path / 'out' / record['recordings']['bag']['map'])
    assert written['x.surface'] == str(shipped_surface(tier='closed_form'))
    assert [one for one in record['what_to_do'] if one.startswith('State the oil')]


def test_logs_of_any_ending_are_found_and_other_files_are_not(tmp_path, capsys):
    folder = tmp_path / 'logs'
    write(folder / 'cut.rec', SPEEDS)
    write(folder / 'below' / 'cut', SPEEDS)
    rows = [[row, 0.5 * row, 1.0] for row in range(100)]
    names = [{'Name': 'ENC_POS|1', 'Axis': 'X'}, {'Name': 'TORQUE|1', 'Axis': 'X'}]
    head = {'CycleTimeMs': 2, 'SignalListHFData': [{'Name': 'CYCLE'}, *names]}
    trace = {'Header': head, 'Payload': [{'HFData': rows}]}
    (folder / 'trace.json').write_text(json.dumps(trace))
    (folder / 'readme').write_text('Logs of a mill.\nOf 2026-07-22 and later.\n' * 30)
    (folder / 'settings.json').write_text('{"rate": 100}')
    (folder / 'numbers').write_text(''.join(f'{row} {row / 2}\n' for row in range(100)))
    check(folder, tmp_path, *SHEETS, '--json')
    record = json.loads(capsys.readouterr().out)
    assert set(record['recordings']) == {'cut.rec', 'trace.json', 'cut', 'numbers'}
    failure = record['recordings']['numbers']['failure']
    assert 'no line names its columns' in failure
    assert f'numbers: {failure}' in record['what_to_do']
    assert record['recordings']['cut.rec']['axes']['x']['judged'] == 2000


def test_without_a_sheet_the_page_asks_for_one(tmp_path, capsys, says):
    write(tmp_path / 'logs' / 'cut.csv', SPEEDS)
    assert check(tmp_path / 'logs', tmp_path, '--json') == 0
    assert says('no_sheet') in json.loads(capsys.readouterr().out)['what_to_do']


def test_a_time_that_is_not_stated_is_asked_for_and_the_map_waits(tmp_path, capsys, says):
    write(tmp_path / 'logs' / 'cut.csv', SPEEDS, time='t')
    assert check(tmp_path / 'logs', tmp_path, *SHEETS, '--json') == 1
    record = json.loads(capsys.readouterr().out)
    assert 'time.unit' in record['recordings']['cut.csv']['failure']
    text = (tmp_path / 'out' / 'maps' / 'cut.yaml').read_text()
    assert 'unit: null' in text
    assert says('lay_beside') in record['what_to_do']
    (tmp_path / 'logs' / 'cut.map.yaml').write_text(text.replace('unit: null', 'unit: s'))
    assert check(tmp_path / 'logs', tmp_path, *SHEETS, '--json') == 0
    record = json.loads(capsys.readouterr().out)
    assert record['recordings']['cut.csv']['axes']['x']['judged'] == 2000


@pytest.mark.parametrize(('text', 'key'), [('a,b\n1,2\n', 'no_column'), (None, 'no_recording')])
def test_nothing_readable_is_one_sentence_and_no_folder(tmp_path, capsys, text, key, says):
    folder = tmp_path / 'logs'
    folder.mkdir()
    if text:
        (folder / 'words.csv').write_text(text)
    assert check(folder, tmp_path, *SHEETS) == 2
    (sentence,) = capsys.readouterr().err.splitlines()
    assert sentence.startswith(says(key, folder=folder))
    assert not (tmp_path / 'out').exists()


@pytest.mark.parametrize(
    ('more', 'key'),
    [
        (['--free-run', 'other.csv'], 'no_such_run'),
        (['--most-unjudged-percent', '200'], 'most_unjudged'),
    ],
)
def test_options_are_refused_before_anything_is_made(tmp_path, capsys, more, key, says):
    write(tmp_path / 'logs' / 'cut.csv', SPEEDS)
    assert check(tmp_path / 'logs', tmp_path, *SHEETS, *more) == 2
    assert says(key) in capsys.readouterr().err
    assert not (tmp_path / 'out').exists()


def test_several_screws_in_a_folder_need_a_name(tmp_path, capsys, says):
    folder = tmp_path / 'logs'
    write(folder / 'cut.csv', SPEEDS)
    for name in ('nominal', 'iso3408_16x5'):
        shutil.copy(find_sheet(name, 'screws'), folder)
    assert check(folder, tmp_path) == 2
    assert says('several_screws', folder=folder) in capsys.readouterr().err


def run_of(tmp_path, name, drag, load=0.0, **more):
    """Return a free run with a drag [N m] that the test wrote, as it is identified."""
    path = write(
        tmp_path / f'{name}.csv', [*SPEEDS, *(-one for one in SPEEDS)], load=load, drag=drag
    )
    mapping = tmp_path / 'map.yaml'
    mapping.write_text(
        f'log: {path.name}\ntime: {{column: time_s, unit: s}}\naxes:\n  x:\n'
        '    speed: {column: x_velocity_mm_s, unit: mm/s}\n'
        '    load: {column: x_force_N, unit: N}\n'
        '    torque: {column: x_torque_Nm, unit: N m}\n    lead_mm: 10.0\n    screw: nominal\n'
        '    oil: iso_vg_68\n    temperature_degC: 38.0\nassumed:\n'
        '  time.epoch: {value: "2026-01-05T08:00:00Z", reason: test}\n'
    )
    bag = opened_log(path, mapping=mapping)
    values = parameters_for(bag, None, mapping).values
    sheets = load_screw('nominal'), load_lubricant('iso_vg_68')
    return identified(bag, values, 'x', sheets, tmp_path / f'{name}.yaml', **more)


def test_a_free_run_tells_how_much_more_drag_there_is(tmp_path):
    low, high = (run_of(tmp_path, name, drag) for name, drag in (('low', 0.6), ('high', 0.9)))
    drags = [load_screw(str(run.sheet)).parasitic_torque for run in (low, high)]
    assert drags[1] - drags[0] == pytest.approx(0.3, abs=0.01)


def test_a_run_under_load_is_none_unless_somebody_says_so(tmp_path):
    assert run_of(tmp_path, 'cut', 0.6, load=-1500.0) is None
    assert run_of(tmp_path, 'cut', 0.6, load=-1500.0, is_free=True) is not None
