# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The identify command as a user types it."""

import csv
from datetime import date
import json
import math

import numpy as np
import pytest
from surrogate.parameters import load_lubricant, load_screw
from surrogate.screw import closed_form
from surrogate.screw.opened import Contacts
from surrogate.screw.screw_onset import with_raceway

COMMAND = ('identify',)

SCREW, OIL = load_screw('nominal'), load_lubricant('iso_vg_68')
OPENED = Contacts.of(SCREW)
RPM = np.array([60, 100, 200, 400, 800, 1600, -60, -200, -800, -1600])
ROWS = RPM * math.pi / 30
TORQUE = np.sign(ROWS) * (
    np.asarray(closed_form.solve(OPENED, OIL, np.abs(ROWS), 0.0, 313.15).friction_torque) + 0.12
)
TORQUE = TORQUE + 4e-4 * ROWS + 0.03


def read_table(args, lead):
    """Return the columns of a table of numbers in SI units, whose torque may be a current."""
    with args.data.open(encoding='utf-8') as file:
        rows = [{name: float(cell) for name, cell in row.items()} for row in csv.DictReader(file)]
    torque = next(name for name in ('torque_Nm', 'current_A') if name in rows[0])
    columns = {
        'speed': np.array([row['speed_rpm'] * math.pi / 30 for row in rows]),
        'torque': np.array([row[torque] * (args.torque_constant or 1.0) for row in rows]),
    }
    if 'temperature_degC' in rows[0]:
        columns['temperature'] = np.array([row['temperature_degC'] + 273.15 for row in rows])
    return columns, ()


@pytest.fixture
def run(run):
    """Return the function that runs a command line, with a reader of tables unless it has one."""
    return lambda *words, **readers: run(*words, **({'table': read_table} | readers))


@pytest.fixture
def data(tmp_path):
    """Return the path of a clean synthetic recording."""
    path = tmp_path / 'drag.csv'
    rows = ''.join(f'{rpm},{torque:.12f}\n' for rpm, torque in zip(RPM, TORQUE, strict=True))
    path.write_text('speed_rpm,torque_Nm\n' + rows, encoding='utf-8')
    return path


def test_json_is_whole_and_only_the_screw_is_written_where_the_oil_is_kept(
    run, capsys, data, tmp_path
):
    assert run(data, '--json') == 0
    record = json.loads(capsys.readouterr().out)
    values = {one['name']: one['value'] for one in record['parameters']}
    expected = {'parasitic_torque': 0.12, 'parasitic_torque_rate': 4e-4, 'torque_offset': 0.03}
    assert values == pytest.approx(expected, abs=1e-9)
    assert record['points'] == 10
    assert record['temperature_K'] == pytest.approx(313.15)
    assert record['data'] == 'drag.csv'
    assert run(data) == 0
    assert [path.name for path in tmp_path.iterdir()] == ['drag.csv']
    assert run(data, '--out', tmp_path / 'found.yaml') == 0
    assert sorted(path.name for path in tmp_path.iterdir()) == ['drag.csv', 'found.yaml']


def test_the_written_sheet_gives_the_measured_torque(run, capsys, data, tmp_path, says):
    """`point` with the written sheets prints the torque along the motion without the offset."""
    sheet = tmp_path / 'deep' / 'found.yaml'
    assert run(data, '--out', sheet, '--fit', 'viscosity', '--temperature-degC', 35) == 0
    assert '95 %' in capsys.readouterr().out
    screw = load_screw(str(sheet))
    oil = load_lubricant(str(sheet.with_name('found_oil.yaml')))
    kelvin = oil.reference_temperature
    assert kelvin == pytest.approx(308.15)
    found = closed_form.solve(Contacts.of(screw), oil, np.abs(ROWS), 0.0, kelvin).friction_torque
    np.testing.assert_allclose(found, np.sign(ROWS) * (TORQUE - 0.03), rtol=5e-3)
    assert says('parasitic_torque_identified') in screw.source
    assert str(tmp_path) not in sheet.read_text(encoding='utf-8')
    assert screw.name == 'nominal_identified'


def test_the_full_tier_is_asked_for_by_name(run, data, monkeypatch, capsys):
    """It hands on what is fitted, and whom to tell."""
    asked = []

    def model(screw, lubricant, points, fitted, *, progress):
        from surrogate.identify.model import closed_form_model

        asked.append(fitted)
        for done in range(3):
            progress(done, 2)
        return closed_form_model(screw, lubricant, points)

    monkeypatch.setattr('surrogate.identify.table.solved_model', model)
    words = ('--fit', 'viscosity', '--fit', 'asperity_friction', '--fit', 'viscosity')
    assert run(data, '--tier', 'full', *words) == 0
    assert asked == [('viscosity_factor', 'asperity_friction')]
    assert '2/2 speeds solved' in capsys.readouterr().err


def test_a_fit_that_did_not_converge_exits_with_1(run, data, monkeypatch, capsys):
    from scipy.optimize import least_squares

    monkeypatch.setattr(
        'surrogate.identify.fit.least_squares',
        lambda *given, **options: least_squares(*given, **options, max_nfev=1),
    )
    sheet = data.with_name('found.yaml')
    assert run(data, '--fit', 'viscosity', '--json', '--out', sheet) == 1
    assert not sheet.exists()
    record = json.loads(capsys.readouterr().out)
    assert record['converged'] is False
    assert record['status'] == 'the fit ended before it converged'


def test_datasheets_that_are_read_are_not_written_over(run, data, tmp_path, refused):
    mine = tmp_path / 'mine.yaml'
    assert run(data, '--out', mine) == 0
    before = mine.read_text(encoding='utf-8')
    refused('datasheet_given_as', run, data, '--screw', mine, '--out', mine)
    with refused('datasheet_given'):
        run(data, '--oil', tmp_path / 'other_oil.yaml', '--out', tmp_path / 'other.yaml')
    assert mine.read_text(encoding='utf-8') == before


def test_the_onset_makes_a_calibrated_sheet(run, tmp_path, capsys, refused):
    """From a current; the sheet says the day and the band, the picture shows the onset."""
    machine = with_raceway(SCREW, onset_factor=0.5)
    rpm = np.geomspace(4, 1200, 12)
    drag = (
        closed_form.solve(
            Contacts.of(machine), OIL, rpm * math.pi / 30, 0.0, 313.15
        ).friction_torque
        + 0.05
    )
    data = tmp_path / 'staircase.csv'
    lines = [f'{speed},{torque / 0.4}' for speed, torque in zip(rpm, drag, strict=True)]
    data.write_text('\n'.join(['speed_rpm,current_A', *lines]), encoding='utf-8')
    sheet, words = tmp_path / 'found.yaml', ('--onset', '--torque-constant', 0.4)
    assert run(data, *words, '--out', sheet, '--plot', tmp_path, '--json') == 0
    onset = json.loads(capsys.readouterr().out)['onset']
    found = load_screw(str(sheet)).roughness
    assert found.onset_factor == pytest.approx(0.5, rel=0.03)
    assert found.onset_band == pytest.approx(onset['band'])
    assert date.fromisoformat(found.calibrated)
    assert (tmp_path / 'identify.png').exists()
    refused('onset_beside', run, data, *words, '--fit', 'viscosity')
    refused('onset_beside', run, data, *words, '--loss', 'soft_l1')


def test_an_onset_that_is_refused_leaves_no_sheet(run, tmp_path, capsys, says):
    """A seal of 0.3 N m over a textbook's curve: one sentence, exit code 1, nothing to build."""
    rpm = np.geomspace(3, 1000, 14)
    drag = 0.06 * np.exp(-rpm / 210) + 0.05 * (rpm / 600) ** 0.6 + 0.15
    drag += 0.15 * np.exp(-rpm * math.pi / 30 * SCREW.pitch_radius / 0.02)
    drag *= 1 + 0.01 * np.cos(5 * np.arange(rpm.size))
    data = tmp_path / 'stairs.csv'
    lines = [f'{speed},{torque}' for speed, torque in zip(rpm, drag, strict=True)]
    data.write_text('\n'.join(['speed_rpm,torque_Nm', *lines]), encoding='utf-8')
    sheet = tmp_path / 'found.yaml'
    assert run(data, '--onset', '--out', sheet, '--plot', tmp_path) == 1
    printed = capsys.readouterr()
    assert says('onset_not_told') in printed.out
    assert str(sheet) not in printed.err
    assert sorted(path.name for path in tmp_path.iterdir()) == ['identify.png', 'stairs.csv']
    assert run(data, '--onset', '--json') == 1
    onset = json.loads(capsys.readouterr().out)['onset']
    assert (onset['refused'], onset['band']) == (True, None)


def test_options_that_mean_nothing_are_refused(run, data, tmp_path, refused):
    """Bag options for a table, and the other way round; a temperature that stands twice."""
    refused('speed_topic_has', run, data, '--speed-topic', 'joint_states')
    refused('torque_column_has', run, tmp_path, '--torque-column', 'torque_Nm')
    refused('bag_only_command', run, tmp_path)
    refused('no_constant', run, data, '--torque-constant', 0)
    text = data.read_text(encoding='utf-8').replace('\n', ',40\n')
    data.write_text(text.replace('torque_Nm,40', 'torque_Nm,temperature_degC'), encoding='utf-8')
    refused('holds_temperature_too', run, data, '--temperature-degC', 40)
    for celsius in ('-300', 'nan', 'inf'):
        refused('temperature_degc_number', run, data, f'--temperature-degC={celsius}')
    assert run(data) == 0


def test_a_bag_is_read_by_who_can(run, tmp_path, capsys):
    seen = []

    def reader(args, lead):
        seen.append((args.data, args.speed_topic, lead))
        return {'speed': ROWS, 'torque': TORQUE}, ('half of it was steady',)

    assert run(tmp_path, '--speed-topic', 'joint_states', bag=reader) == 0
    assert seen == [(tmp_path, 'joint_states', SCREW.lead)]
    assert 'note: half of it was steady' in capsys.readouterr().out


def test_a_picture(run, data, tmp_path, refused):
    """One file, nothing half-written; without a place for it one sentence."""
    pytest.importorskip('matplotlib')
    folder = tmp_path / 'deep' / 'plots'
    assert run(data, '--plot', folder) == 0
    assert [path.name for path in folder.iterdir()] == ['identify.png']
    refused('plot_drag_cannot', run, data, '--plot', data)
