# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The offline commands as a user types them."""

from functools import partial
import json

import numpy as np
import pytest
from surrogate.commands.cli import add_commands, Parser
from surrogate.files import InputError, json_text
from surrogate.parameters import load_lubricant, load_screw, OperatingPoint
from surrogate.screw.sensitivity import sensitivity_page, sensitivity_record
from surrogate.screw.uncertain_inputs import INPUTS
from surrogate.units import RPM, ZERO_CELSIUS

pytestmark = pytest.mark.usefixtures('small_tiles')
COMMAND = ('point',)
NEGATIVE = ('-5e-324', '-1e3', '-1E+3', '-.5e1', '-5.', '-0')

POINT = ['--screw', 'nominal', '--oil', 'iso_vg_68', '--tier', 'closed_form']


@pytest.fixture
def record(run, capsys):
    def printed(*words):
        assert run(*POINT, '--json', *words) == 0
        return json.loads(capsys.readouterr().out)

    return printed


def test_point_as_json(record):
    found = record('--speed-rpm', '600', '--load-N', '1000')
    assert found['tier'] == 'closed_form'
    assert found['efficiency'] == pytest.approx(0.936, abs=2e-3)
    assert found['entrainment_speed_m_s'] == pytest.approx(0.49657, abs=1e-5)
    expected = 10 / (2 * np.pi) + found['friction_torque_Nm']
    assert found['driving_torque_Nm'] == pytest.approx(expected)
    wanted = [('loaded', 'screw'), ('loaded', 'nut'), ('relieved', 'screw'), ('relieved', 'nut')]
    assert [(c['nut'], c['side']) for c in found['contacts']] == wanted
    assert found['normal_force_loaded_N'] > 27.6 > found['normal_force_relieved_N']
    assert found['regime'] == 'mixed'


def test_unknown_numbers_are_null_with_a_reason(record):
    """Past unloading the relieved nut has no film: null, and a word why."""
    found = record('--speed-rpm', '600', '--load-N', '3000')
    relieved = found['contacts'][2]
    assert relieved['central_film_m'] is None
    assert relieved['reason'] == 'no load on this nut, so no film'
    assert any('unloading begins at 2800 N' in text for text in found['warnings'])


@pytest.mark.parametrize('number', NEGATIVE)
def test_a_negative_number_with_an_exponent_is_no_option(number):
    """It is one after a space as it is after an equals sign."""
    parser = Parser()
    add_commands(parser.add_subparsers(required=True), {})
    words = *COMMAND, *POINT, '--speed-rpm', '600'
    spaced = parser.parse_args([*words, '--load-N', number])
    assert spaced == parser.parse_args([*words, f'--load-N={number}'])
    assert float(number) in vars(spaced).values()


@pytest.mark.parametrize(
    ('rpm', 'load', 'drives'),
    [
        ('600', '1000', False),
        ('600', '-1000', True),
        ('-600', '1000', True),
        ('-600', '-1000', False),
    ],
)
def test_four_quadrants(record, rpm, load, drives):
    found = record('--speed-rpm', rpm, '--load-N', load)
    assert found['back_driving'] is drives
    assert (found['driving_torque_Nm'] < 0) is drives
    assert found['efficiency'] == pytest.approx(0.931 if drives else 0.936, abs=2e-3)


def test_point_as_a_page(run, capsys):
    """A person reads the tier, the point and, where it is asked for, what leaves a range."""
    asked = (*POINT, '--speed-rpm', '600', '--load-N', '1000', '--temperature-degC', '40')
    assert run(*asked) == 0
    assert 'outside its range' not in capsys.readouterr().out
    assert run(*asked, '--verbose') == 0
    text = capsys.readouterr().out
    for part in (
        'tier closed_form: 600 rev/min, 1000 N, 40 degC',
        'Contact begins at 321 rev/min (168 to 658; a measured film floor by torque at slow ',
        'efficiency           0.936',
        'relieved nut, screw',
        'outside its range',
        'status: closed form',
    ):
        assert part in text


def test_at_rest_no_film_is_compared(run, capsys):
    """No formula gives one, and the page says why."""
    assert run(*POINT, '--speed-rpm', '0', '--load-N', '500') == 0
    text = capsys.readouterr().out
    assert 'N m, no film at rest or without load\n' in text
    assert 'nan' not in text


@pytest.mark.parametrize(
    'words',
    [
        ['--speed-rpm', 'nan', '--load-N', '1'],
        ['--speed-rpm', '1', '--load-N', 'inf'],
        ['--speed-rpm', '1', '--load-N', '1', '--temperature-degC', '900'],
    ],
)
def test_a_number_out_of_range_is_refused(run, words, refused):
    refused('text', run, *POINT, *words)


def test_comparator_knows_the_quadrant(record):
    """With the load driving, constant friction yields less than against it, and a brake torque."""
    against = record('--speed-rpm', '600', '--load-N', '1000')['comparators']
    driven = record('--speed-rpm', '600', '--load-N', '-1000')['comparators']
    assert driven['constant_friction_efficiency'] == pytest.approx(0.895, abs=1e-3)
    assert against['constant_friction_efficiency'] == pytest.approx(0.905, abs=1e-3)
    assert driven['constant_friction_torque_Nm'] < 0 < against['constant_friction_torque_Nm']


def test_full_tier_is_solved_and_a_failure_is_an_exit_code(run, capsys, monkeypatch):
    """1000 N at 2000 rev/min by solved contacts; what did not converge returns 1."""
    words = (*POINT[:-1], 'full', '--json', '--speed-rpm', 2000, '--load-N', 1000)
    assert run(*words) == 0
    found = json.loads(capsys.readouterr().out)
    assert found['tier'] == 'full'
    assert found['rcs'] < 1e-3
    assert 0.8 < found['efficiency'] < 0.95
    failed = found | {'converged': False}
    monkeypatch.setattr('surrogate.screw.full_record.solution_record', lambda *inputs: failed)
    assert run(*words) == 1


def test_options_of_the_full_tier(run, tmp_path, capsys):
    """Kinematics, isothermal inlet and picture reach the solve; only it has the others."""
    words = ('--speed-rpm', '600', '--load-N', '0', '--json')
    more = ('--kinematics', 'smooth', '--isothermal', '--plot', tmp_path)
    assert run(*words, *more) == 0
    found = json.loads(capsys.readouterr().out)
    assert found['asperity_law'] == 'no roughness'
    assert found['rcs'] == 0.0
    assert found['inlet_heating'] is False
    assert 0.9 < found['inlet_heating_factor'] < 0.995
    assert [file.suffix for file in tmp_path.iterdir()] == ['.png']
    for option in (('--kinematics', 'rolling'), ('--plot', tmp_path)):
        with pytest.raises(InputError, match=f'{option[0]} needs --tier full'):
            run(*words, '--tier', 'closed_form', *option)
    for option, film in (((), 0.156), (('--isothermal',), 0.159)):
        assert run(*words, '--tier', 'closed_form', *option) == 0
        found = json.loads(capsys.readouterr().out)
        assert found['inlet_heating'] is not bool(option)
        assert 1e6 * found['central_film_m'] == pytest.approx(film, abs=1e-3)
    blocked = tmp_path / 'file'
    blocked.write_text('')
    with pytest.raises(InputError, match='--plot: .*file cannot be made'):
        run(*words, '--tier', 'full', '--plot', blocked)


def test_sensitivity_is_a_table_json_or_a_picture_of_the_closed_form(
    run, capsys, monkeypatch, tmp_path
):
    """With progress on stderr; here of the inputs that leave the topography."""
    pytest.importorskip('matplotlib')
    quick = [one for one in INPUTS if one.part == 'lubricant']
    short = partial(sensitivity_record, inputs=quick)
    monkeypatch.setattr('surrogate.screw.sensitivity.sensitivity_record', short)
    sheets = load_screw('nominal'), load_lubricant('iso_vg_68')
    point = OperatingPoint(speed=600 * RPM, load=500.0, temperature=40 + ZERO_CELSIUS)
    words = ('--screw', 'nominal', '--speed-rpm', '600', '--load-N', '500', '--sensitivity')
    assert run(*words, '--plot', tmp_path) == 0
    printed = capsys.readouterr()
    assert printed.out == sensitivity_page(record := short(*sheets, point)) + '\n'
    assert '3/3 inputs' in printed.err
    assert f'{tmp_path}/sensitivity_nominal_iso_vg_68.png' in printed.err
    assert run(*words, '--json') == 0
    assert json.loads(capsys.readouterr().out) == json.loads(json_text(record))
    with pytest.raises(InputError, match='--sensitivity is given with --isothermal'):
        run(*words, '--isothermal')
    with pytest.raises(InputError, match='--sensitivity is given with --tier full'):
        run(*words, '--tier', 'full')


def test_oil_that_is_no_liquid_is_named_with_its_temperature(run):
    with pytest.raises(InputError, match=r'temperature is -40 degC: iso_vg_68: viscosity is'):
        run(*POINT[:-1], 'full', '--speed-rpm', '60', '--load-N', '0', '--temperature-degC', '-40')
