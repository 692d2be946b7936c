# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""`ballscrew check`: a folder of logs and a sheet become a page, maps, sheets and surfaces."""

import json
import math
import shutil

from ballscrew_monitor import cli
from ballscrew_monitor.recordings.opener import opened_log
from ballscrew_monitor.recordings.tables.mapping import read_map
from ballscrew_monitor.report.check import map_beside, sheets_of
from ballscrew_monitor.report.check_page import _surfaces
from ballscrew_monitor.report.free_run import identified
from ballscrew_monitor.report.parameters import parameters_for
from ballscrew_monitor.settings.parameters import read_file
import pytest
from surrogate.parameters import find_sheet, load_lubricant, load_screw
from surrogate.surface import shipped_surface
from surrogate.surface.file import read

pytestmark = pytest.mark.usefixtures('one_worker')
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


def test_a_lead_of_the_log_that_is_not_that_of_the_sheet_is_asked_for(tmp_path, capsys, says):
    path = tmp_path / 'logs' / 'cut.csv'
    write(path, SPEEDS)
    path.write_text(f'Lead: 5 mm\n{path.read_text()}')
    assert check(tmp_path / 'logs', tmp_path, *SHEETS, '--json') == 1
    failure = json.loads(capsys.readouterr().out)['recordings']['cut.csv']['failure']
    assert failure == says('another_lead')


def test_a_log_that_contradicts_itself_and_a_stray_file_are_named_on_the_page(
    tmp_path, capsys, says
):
    """A position that moves half as far as its speed says, as behind a screw of half the lead."""
    folder = tmp_path / 'logs'
    write(folder / 'cut.csv', SPEEDS)
    rows = (folder / 'cut.csv').read_text().splitlines()
    moved, before, lines = 0.0, 0.0, [f'{rows[0]},x_position_mm']
    for row in rows[1:]:
        speed = float(row.split(',')[1])
        moved += 0.5 * (before + speed) / 2 / 100
        before = speed
        lines.append(f'{row},{moved:.6f}')
    (folder / 'cut.csv').write_text('\n'.join(lines) + '\n')
    (folder / 'plan.pdf').write_text('%PDF-1.4')
    (folder / 'cut.map.yaml').write_text(
        'time: {column: time_s, unit: s, epoch: 2026-01-05T08:00:00Z}\n'
        'axes: {x: {lead_mm: 10.0, speed: {column: x_velocity_mm_s, unit: mm/s}, '
        'position: {column: x_position_mm, unit: mm}, temperature_degC: 40.0, '
        'load: {column: x_force_N, unit: N, magnitude: false}}}\n'
    )
    check(folder, tmp_path, *SHEETS, '--json')
    printed = capsys.readouterr()
    record = json.loads(printed.out)
    assert record['left_out'] == [says('stray', folder=folder)]
    assert says('half') in record['notes']
    page = (tmp_path / 'out' / 'index.html').read_text()
    for sentence in (*record['left_out'], says('half')):
        assert sentence in page
        assert sentence in printed.err


def test_remarks_and_lists_are_no_bad_recordings(tmp_path, capsys, says):
    folder = tmp_path / 'logs'
    write(folder / 'cut.csv', SPEEDS)
    (folder / 'README.txt').write_text('Messungen vom 15.03.2025\nMotor 3,5 Nm\n')
    (folder / 'parts.csv').write_text('Datum;Teil;Stueck\n1.1.2025;A;5\n2.1.2025;B;6\n')
    assert check(folder, tmp_path, *SHEETS, '--json') == 0
    printed = capsys.readouterr()
    assert says('no_motion') in printed.err
    record = json.loads(printed.out)
    assert set(record['recordings']) == {'cut.csv'}
    assert record['no_recordings'] == ['README.txt', 'parts.csv']
    assert not [step for step in record['what_to_do'] if 'map' in step]
    assert says('no_motion') in (tmp_path / 'out' / 'index.html').read_text()


def test_a_long_table_of_unknown_names_is_a_bad_recording(tmp_path, capsys, says):
    folder = tmp_path / 'logs'
    write(folder / 'cut.csv', SPEEDS)
    (folder / 'channels.csv').write_text('a,b\n' + ''.join(f'{at},{at % 7}\n' for at in range(99)))
    assert check(folder, tmp_path, *SHEETS, '--json') == 1
    assert says('lay_map') in json.loads(capsys.readouterr().out)['what_to_do']


def test_one_sheet_for_logs_of_several_axes_is_that_of_one(tmp_path, capsys, says):
    folder = tmp_path / 'logs'
    text = write(folder / 'first.csv', SPEEDS[:1]).read_text()
    (folder / 'second.csv').write_text(text.replace('x_', 'y_'))
    assert check(folder, tmp_path, *SHEETS, '--json') == 0
    record = json.loads(capsys.readouterr().out)
    assert says('several_axes') in record['what_to_do']
    assert [*record['surfaces']] == ['x', 'y']
    shutil.copy(tmp_path / 'out' / 'maps' / 'second.yaml', folder / 'second.map.yaml')
    assert check(folder, tmp_path, *SHEETS, '--json') == 0
    record = json.loads(capsys.readouterr().out)
    assert [*record['surfaces']] == ['x']
    assert not [step for step in record['what_to_do'] if step.startswith('The sheet')]


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


@pytest.mark.parametrize(
    ('kind', 'name', 'old', 'new', 'key'),
    [
        ('screws', 'nominal', 'lead_mm: 10.0', 'lead_mm: 10,0', 'unread_lead'),
        ('screws', 'nominal', 'lead_mm:', 'steigung_mm:', 'unread_key'),
        ('screws', 'nominal', 'lead_mm: 10.0', 'lead_mm: [10.0', 'unread_yaml'),
        ('lubricants', 'iso_vg_32', 'density_kg_m3:', 'density_kg_m3: x', 'unread_oil'),
    ],
)
def test_a_sheet_that_cannot_be_read_is_one_sentence(kind, name, old, new, key, tmp_path, refused):
    text = find_sheet(name, kind).read_text()
    assert old in text
    (tmp_path / 'my.yaml').write_text(text.replace(old, new))
    with refused(key, file=tmp_path / 'my.yaml'):
        sheets_of(tmp_path, None, None)


def test_a_file_of_other_keys_is_no_sheet(tmp_path):
    (tmp_path / 'feed.map.yaml').write_text('log: feed.csv\naxes: {x: {lead_mm: 5,0}}\n')
    (tmp_path / 'machine.yaml').write_text('name: mill\nlist: [1\n')
    assert sheets_of(tmp_path, None, None) is None


def test_a_map_beside_is_that_of_one_log(tmp_path):
    for name in ('feed.json', 'feed.map.yaml'):
        (tmp_path / name).write_text('')
    assert map_beside(tmp_path / 'feed.json') == tmp_path / 'feed.map.yaml'
    (tmp_path / 'feed.csv').write_text('')
    assert map_beside(tmp_path / 'feed.csv') == tmp_path / 'feed.map.yaml'
    assert map_beside(tmp_path / 'feed.json') is None
    (tmp_path / 'feed.json.map.yaml').write_text('')
    assert map_beside(tmp_path / 'feed.json') == tmp_path / 'feed.json.map.yaml'


def run_of(tmp_path, name, drag, load=0.0, **more):
    """Return a free run with a drag [N m] that the test wrote, as it is identified."""
    path = write(
        tmp_path / f'{name}.csv', [*SPEEDS, *(-one for one in SPEEDS)], load=load, drag=drag
    )
    mapping = tmp_path / 'map.yaml'
    mapping.write_text(
        f'log: {path.name}\ntime: {{column: time_s, unit: s}}\naxes:\n  x:\n'
        '    speed: {column: x_velocity_mm_s, unit: mm/s}\n'
        '    load: {column: x_force_N, unit: N, magnitude: false}\n'
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


def test_a_single_nut_with_oversize_balls_goes_from_its_catalogue_page_to_a_verdict(
    tmp_path, capsys
):
    folder = tmp_path / 'logs'
    write(folder / 'cut.csv', SPEEDS)
    page = ['--nominal-diameter-mm', '40', '--lead-mm', '10', '--ball-diameter-mm', '6.35']
    page += ['--nut', 'oversize', '--turns', '4', '--dynamic-rating-kN', '37.89']
    assert cli.main(['screw', 'new', *page, '--out', str(folder / 'screw.yaml')]) == 0
    capsys.readouterr()
    assert check(folder, tmp_path, '--oil', 'iso_vg_68', '--json') == 0
    record = json.loads(capsys.readouterr().out)
    axis = record['recordings']['cut.csv']['axes']['x']
    assert (axis['expected'], axis['judged']) == (2000, 2000)
    assert axis['verdict']
    inputs = read(record['surfaces']['x']).header['inputs']
    assert inputs['screw']['nut'] == 'oversize'


def test_the_page_says_of_an_own_surface_that_its_raceway_was_not_marched(tmp_path):
    shipped = shipped_surface(tier='full')
    own = shutil.copy(shipped, tmp_path)
    texts = list(map(str, _surfaces({'x': str(own), 'y': str(shipped)})))
    assert ['raceway was not marched' in text for text in texts] == [True, False]
