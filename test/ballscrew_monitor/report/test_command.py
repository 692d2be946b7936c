# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""`ballscrew replay` with `--out`: exit codes, several recordings, one of them bad."""

import json
import os
from pathlib import Path
import shutil

from ballscrew_monitor import cli
import pytest


@pytest.fixture
def logs(short_bag, tmp_path):
    folder = tmp_path / 'logs'
    for name in ('first', 'second <script>'):
        shutil.copytree(short_bag, folder / name)
    (folder / 'broken.mcap').write_bytes(b'no recording')
    return folder


def test_one_recording(short_bag, tmp_path, capsys):
    assert cli.main(['replay', str(short_bag), '--out', str(tmp_path / 'out')]) == 0
    shown = capsys.readouterr()
    assert 'Outside: axis x ran outside its optimal zone' in shown.out
    assert 'the nominal ones' in shown.err
    assert (tmp_path / 'out' / 'report.html').exists()


def test_an_axis_without_a_sample_is_named_and_the_other_is_judged(short_bag, tmp_path, capsys):
    params = tmp_path / 'two.yaml'
    params.write_text(
        "/**/ballscrew_monitor:\n  ros__parameters:\n    axes: ['x', 'y']\n"
        "    x: {temperature: {topic: 'oil_temperature'}}\n"
        "    y: {speed: {field: 'velocity[nope]'}, load: {topic: 'axial_load'}}\n"
    )
    out = tmp_path / 'out'
    arguments = ['replay', str(short_bag), '--params', str(params), '--out', str(out)]
    assert cli.main(arguments) == 1
    assert cli.main([*arguments, '--most-unjudged-percent', '100']) == 0
    assert 'nothing was judged on axis y' in capsys.readouterr().err
    assert json.loads((out / 'summary.json').read_text())['unjudged_axes'] == ['y']


def test_one_bad_recording_does_not_stop_the_rest(logs, tmp_path, capsys):
    out = tmp_path / 'out'
    arguments = ['--out', str(out), '--workers', '1', '--json']
    assert cli.main(['replay', str(logs), *arguments]) == 1
    shown = capsys.readouterr()
    assert 'broken.mcap: bag' in shown.err
    assert 'first: Outside: axis x ran outside' in shown.err
    assert '3 recordings, 1 bad' in shown.err
    record = json.loads(shown.out)
    assert record[str(logs / 'first')]['x']['judged'] == 300
    assert record[str(logs / 'broken.mcap')] is None
    assert 'neither an MCAP nor a sqlite3 file' in record[f'{logs / "broken.mcap"}_reason']
    assert sorted(path.name for path in out.iterdir()) == ['first', 'index.html', 'second_script_']
    index = (out / 'index.html').read_text()
    assert 'href="first/report.html"' in index
    assert '<b>broken.mcap</b>' in index
    assert '<script>' not in index.partition('<main>')[2].partition('</main>')[0]


def test_several_recordings_are_printed_one_after_the_other_or_as_one_json(logs, capsys, says):
    paths = [str(logs / name) for name in ('broken.mcap', 'first')]
    assert cli.main(['replay', *paths]) == 1
    shown = capsys.readouterr()
    assert 'axis x: 300 speed samples judged' in shown.out
    assert says('broken_mcap_neither') in shown.err
    assert cli.main(['replay', str(logs / 'first'), str(logs / 'second <script>'), '--json']) == 0
    record = json.loads(capsys.readouterr().out)
    assert [one['x']['judged'] for one in record.values()] == [300, 300]
    broken = str(logs / 'broken.mcap')
    assert cli.main(['replay', broken, str(logs / 'first'), '--json']) == 1
    record = json.loads(capsys.readouterr().out)
    assert record[broken] is None
    assert says('broken_mcap_neither') in record[f'{broken}_reason']


def test_one_report_is_the_same_json(short_bag, tmp_path, capsys):
    assert cli.main(['replay', str(short_bag), '--json']) == 0
    printed = json.loads(capsys.readouterr().out)
    assert cli.main(['replay', str(short_bag), '--json', '--out', str(tmp_path / 'out')]) == 0
    shown = capsys.readouterr()
    reported = json.loads(shown.out)
    # A report follows the health of its axes, too.
    normal = [record.pop('normal') for record in reported.values()]
    assert normal == ['not known: no torque was measured while the axis moved']
    assert reported == printed
    assert 'report in' in shown.err


def test_metres_read_as_millimetres_are_told_and_no_success(short_bag, tmp_path, capsys):
    params = tmp_path / 'params.yaml'
    params.write_text(
        '/**/ballscrew_monitor:\n  ros__parameters:\n'
        "    x: {temperature: {topic: 'oil_temperature'}, speed: {unit: 'mm/s', scale: 0.001}}\n"
    )
    assert cli.main(['replay', str(short_bag), '--params', str(params)]) == 1
    shown = capsys.readouterr()
    assert 'Not known: axis x never moved' in shown.out
    assert 'check       x.speed: the axis never moves' in shown.out
    assert 'nothing was judged on axis x: it never moved' in shown.err


def test_a_folder_without_recordings_is_bad_input(tmp_path, capsys):
    assert cli.main(['replay', str(tmp_path), '--out', str(tmp_path / 'out')]) == 2
    assert 'holds no recording' in capsys.readouterr().err


@pytest.mark.parametrize('option', ['--params', '--map', '--out'])
def test_what_serves_no_recording_is_bad_input_at_once(logs, option, tmp_path, capsys):
    (logs / 'table.csv').write_text('v\n1\n')
    (tmp_path / 'file').write_text('neither: parameters nor a map')
    assert cli.main(['replay', str(logs), option, str(tmp_path / 'file')]) == 2
    said = capsys.readouterr().err
    assert said.count(str(tmp_path / 'file')) == 1


@pytest.mark.parametrize('more', [[], ['--out']])
@pytest.mark.usefixtures('one_worker')
def test_a_folder_of_one_recording_is_json_by_recording(short_bag, more, tmp_path, capsys):
    folder = tmp_path / 'folder'
    shutil.copytree(short_bag, folder / 'bag')
    more = [*more, str(tmp_path / 'out')] if more else []
    assert cli.main(['replay', str(folder), '--json', *more]) == 0
    assert list(json.loads(capsys.readouterr().out)) == [str(folder / 'bag')]


@pytest.mark.usefixtures('one_worker')
def test_a_folder_of_bags_and_tables_is_judged_with_a_map_and_without(logs, tmp_path, capsys):
    (logs / 'broken.mcap').unlink()
    table, mapping, out = logs / 'log.csv', tmp_path / 'map.yaml', tmp_path / 'out'
    table.write_text('t,v,f\n' + ''.join(f'{0.01 * i:.2f},100,1\n' for i in range(50)))
    assert cli.main(['replay', str(logs), '--out', str(out), '--workers', '1']) == 0
    sentence = f'left out, as tables are judged by a --map: {table}'
    assert sentence in capsys.readouterr().err
    assert f'<p>L{sentence[1:]}.</p>' in (out / 'index.html').read_text()
    mapping.write_text(
        'time: {column: t, unit: s, epoch: 2000-01-01}\n'
        'axes: {x: {lead_mm: 10.0, speed: {column: v, unit: mm/s}, '
        'load: {column: f, unit: N}, temperature_degC: 40.0}}\n'
    )
    assert cli.main(['replay', str(logs), '--map', str(mapping), '--json']) == 0
    shown = capsys.readouterr()
    assert [one['x']['judged'] for one in json.loads(shown.out).values()] == [50, 300, 300]
    assert 'left out' not in shown.err


def test_a_map_without_a_table_is_bad_input(logs, tmp_path, capsys, says):
    assert cli.main(['replay', str(logs), '--map', str(tmp_path / 'map.yaml')]) == 2
    assert says('tables_none_3') in capsys.readouterr().err


@pytest.mark.skipif(
    'BALLSCREW_RECORDINGS' not in os.environ, reason='BALLSCREW_RECORDINGS names no recordings'
)
def test_the_real_log_ends_in_a_page_that_says_what_was_assumed(tmp_path, capsys, says):
    log = Path(os.environ['BALLSCREW_RECORDINGS']) / 'cnc_mill' / 'experiment_01.csv'
    assert cli.main(['import', str(log), '--guess']) == 0
    stated = capsys.readouterr().out.replace('rate_Hz: null', 'rate_Hz: 10')
    (tmp_path / 'map.yaml').write_text(stated.replace('unit: null', 'unit: A'))
    out = tmp_path / 'out'
    arguments = ['replay', str(log), '--map', str(tmp_path / 'map.yaml'), '--out', str(out)]
    assert cli.main(arguments) == 1, 'axis z has no load'
    assert 'nothing was judged on axis z' in capsys.readouterr().err
    page = (out / 'report.html').read_text()
    assert 'Assumed, neither measured nor stated:' in page
    assert says('axes_y_axial') in page
    assert 'without a date' in page
    assert 'M1_CURRENT' not in page  # nor any other column of the part program
    record = json.loads((out / 'summary.json').read_text())
    assert set(record['axes']) == {'x', 'y', 'z'}
    assert record['unjudged_axes'] == ['z']
    assert not record['axes']['x']['inputs']['load']['measured']
