# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Sensitivity to the inputs, its bands and its picture."""

from dataclasses import fields, replace
import math

import numpy as np
import pytest
from surrogate.parameters import OperatingPoint
from surrogate.screw import sensitivity
from surrogate.screw.closed_form import solve
from surrogate.screw.onset_bands import unknown_band
from surrogate.screw.opened import Contacts
from surrogate.screw.screw_onset import onset_point, run_in_at, with_raceway
from surrogate.screw.sensitivity import _fastest, sensitivity_page, sensitivity_record
from surrogate.screw.uncertain_inputs import INPUTS, ScrewCase
from surrogate.units import RPM

pytestmark = pytest.mark.usefixtures('small_tiles')
POINT = OperatingPoint(speed=600 * RPM, load=500.0, temperature=313.15)
QUICK = [one for one in INPUTS if one.part in ('point', 'lubricant')]
BY_NAME = {one.name: one for one in INPUTS}


@pytest.fixture(scope='module')
def record(screw, oil):
    """Return the record of the inputs that leave the topography, with Rq."""
    return sensitivity_record(screw, oil, POINT, inputs=[*QUICK, BY_NAME['rms']])


@pytest.mark.parametrize(
    ('spare', 'speed'),
    [
        ([1.0, 1.0, -1.0, -1.0], 2.0 * math.sqrt(2.0)),
        ([1.0, 1.0, -3.0, -3.0], 2.0 * 2.0**0.25),
        ([1.0, -1.0, 3.0, -1.0], 4.0 * 2.0**0.75),  # the last of several
        ([2.0, 1.0, 0.0, -1.0], 4.0),  # on a speed that was tried
        ([2.0, -1.0, -1.0, -1.0], 2.0 ** (2.0 / 3.0)),
        ([2.0, 1.0, 1.0, -1.0], 4.0 * math.sqrt(2.0)),
        ([1.0, -1.0, -1.0, 0.0], math.nan),  # the fastest speed has it again
        ([1.0, 1.0, 1.0, 1.0], math.nan),
        ([-1.0, -1.0, -1.0, -1.0], math.nan),
        ([-1.0, -1.0, -1.0, 1.0], math.nan),
        ([1.0, 1.0, 1.0, math.nan], math.nan),
    ],
)
def test_what_is_spare_runs_out_at_the_fastest_speed_between_two(spare, speed):
    """Linear over the logarithm of the speed, 1 to 8 rad/s."""
    found = _fastest(np.array([1.0, 2.0, 4.0, 8.0]), np.array(spare))
    assert found == pytest.approx(speed, nan_ok=True)


def test_a_limit_is_looked_for_among_sixty_speeds_about_the_onset(screw, oil, monkeypatch):
    """From its 2.5th part to 2.5 times the onset, and from there to the fastest speed."""
    asked = []

    def solve_once(opened, lubricant, speed, *place):
        asked.append(speed)
        return solve(opened, lubricant, speed, *place)

    monkeypatch.setattr(sensitivity.closed_form, 'solve', solve_once)
    case = ScrewCase(screw=screw, lubricant=oil, point=POINT)
    sensitivity._outcome(case)
    ((first, *rest),) = asked
    near, wide = np.array(rest[:60]), np.array(rest[60:])
    assert (first, len(wide)) == (POINT.speed, 60)
    assert near[[0, -1]] == pytest.approx([case.onset / 2.5, 2.5 * case.onset])
    assert wide[[0, -1]] == pytest.approx([near[0], screw.fastest_speed])


def test_the_ranges_are_those_of_their_reasons():
    """Factors and steps below and above the stated value; the others say their ends."""
    assert {one.name: (one.times, one.plus) for one in INPUTS if one.ends is None} == {
        'temperature': (1.0, 5.0),
        'viscosity': (1.1, 0.0),
        'film_factor': (1 / 0.7, 0.0),
        'fractal_dimension': (1.0, 0.1),
        'rms_slope': (1.2, 0.0),
        'preload': (1.2, 0.0),
        'conformity_screw': (1.0, 0.01),
        'cutoff_short': (2.0, 0.0),
    }


def row_of(record, key):
    return next(row for row in record['inputs'] if row['key'] == key)


def test_what_is_stated_is_what_onset_and_point_say(screw, oil, record):
    assert record.keys() == sensitivity.KEYS.keys()
    stated = record['stated']
    assert (
        stated['onset_speed_rad_s']
        == onset_point(Contacts.of(screw), oil, 500.0, 313.15)['speed_rad_s']
    )
    found = solve(Contacts.of(screw), oil, [POINT.speed, *list_of_limits(stated)], 500.0, 313.15)
    assert stated['friction_torque_Nm'] == found.friction_torque[0]
    assert found.rcs[1] == pytest.approx(0.01, rel=0.01)
    ideal = 500.0 * screw.lead / (2 * math.pi)
    assert ideal / (ideal + found.friction_torque[2]) == pytest.approx(0.85, rel=1e-3)


def list_of_limits(stated):
    return stated['rcs_limit_speed_rad_s'], stated['efficiency_limit_speed_rad_s']


def test_five_kelvin_move_the_onset_by_a_third(record):
    colder, warmer = row_of(record, 'temperature_degC')['onset_factors']
    assert 1.3 < warmer < 1.4
    assert 1.3 < 1 / colder < 1.4


def test_more_floor_heat_and_roughness_begin_to_touch_sooner(record):
    """More film does the opposite, and the limit of RCS goes with the onset."""
    for key in ('film_floor_nm', 'temperature_degC', 'rms_um'):
        low, high = row_of(record, key)['onset_factors']
        assert low < 1 < high
    for key in ('viscosity_Pa_s', 'film_factor'):
        low, high = row_of(record, key)['onset_factors']
        assert low > 1 >= high
    for row in record['inputs']:
        for end, factor in zip(('at_low', 'at_high'), row['onset_factors'], strict=True):
            moved = row[end]['rcs_limit_speed_rad_s'] / record['stated']['rcs_limit_speed_rad_s']
            assert moved == pytest.approx(factor, rel=0.1)


def test_values_are_in_the_unit_of_the_key_and_ends_in_that_of_the_sheet(record):
    floor = row_of(record, 'film_floor_nm')
    assert [floor[end] for end in ('low', 'stated', 'high')] == pytest.approx([1.0, 3.0, 5.0])
    heat = row_of(record, 'temperature_degC')
    assert [heat[end] for end in ('low', 'stated', 'high')] == pytest.approx([35.0, 40.0, 45.0])
    # Flooded is the most that a sheet may state, and changes nothing.
    factor = row_of(record, 'film_factor')
    assert (factor['low'], factor['high'], factor['onset_factors'][1]) == (0.7, 1.0, 1.0)
    assert factor['at_high'] == record['stated']


def test_an_input_without_a_range_changes_nothing(screw, oil):
    """And leaves a band of the other inputs alone."""
    sure = replace(oil, film_floor_low=oil.film_floor, film_floor_high=oil.film_floor)
    told = []
    found = sensitivity_record(
        screw, sure, POINT, inputs=[BY_NAME['film_floor']], progress=lambda *at: told.append(at)
    )
    assert told == [(0, 1), (1, 1)]
    assert found['inputs'][0]['onset_factors'] == [1.0, 1.0]
    assert found['limit_band'] == [1.0, 1.0]


def test_the_largest_effect_stands_first_and_what_is_measured_leaves_the_band(record):
    first, *_ = record['inputs']
    assert first['key'] == 'film_floor_nm'
    low, high = record['limit_band']
    assert low < min(min(row['onset_factors']) for row in record['inputs'])
    assert high > max(max(row['onset_factors']) for row in record['inputs'])
    one, two = record['measure']
    assert (one['measurement'], two['measurement']) == (
        'film floor by torque at slow speeds',
        'oil temperature at the nut',
    )
    assert low < one['limit_band'][0] < two['limit_band'][0] < 1
    left = [('', row_of(record, key)['onset_factors']) for key in ('viscosity_Pa_s', 'rms_um')]
    assert two['limit_band'] == pytest.approx(unknown_band(left))


def test_running_in_is_an_input_of_a_raceway_that_has_run_in(screw, oil):
    """From its lowest pressure to none of it; hardness takes its place on a new one."""
    new = ScrewCase(screw=screw, lubricant=oil, point=POINT)
    run_in = replace(new, screw=with_raceway(screw, state='run_in'))
    traced = replace(new, screw=with_raceway(screw, state='run_in', traced='run_in'))
    running, hard = BY_NAME['run_in_pressure'], BY_NAME['hardness']
    assert running.bounds(run_in) == (screw.roughness.run_in_low, screw.roughness.hardness)
    assert hard.bounds(run_in) is None
    assert running.bounds(new) is running.bounds(traced) is None
    low, high = hard.bounds(new)
    assert (low, high) == pytest.approx((7e9 / 1.15, 7e9 * 1.15))
    assert hard.bounds(traced) == (low, high)
    assert running.at(run_in, 2e9).screw == run_in_at(run_in.screw, 2e9)
    assert hard.at(new, low).roughness.cutting_pressure == low
    marched = replace(new, screw=with_raceway(screw, marched_film=1.2, marched_error=0.03))
    assert hard.at(marched, low).roughness.marched_film == 1.2


def test_a_long_cutoff_is_an_input_where_the_sheet_leaves_it_to_the_table(screw, oil):
    case = ScrewCase(screw=screw, lubricant=oil, point=POINT)
    free = replace(case, screw=with_raceway(screw, cutoff_long=None))
    cutoff = BY_NAME['cutoff_long']
    assert cutoff.bounds(case) is None
    assert cutoff.bounds(free) == pytest.approx((0.079e-3, 0.79e-3), rel=0.01)
    assert cutoff.at(free, 0.8e-3).roughness.cutoff_long == 0.8e-3


def test_every_end_of_every_input_is_a_sheet(screw, oil):
    """Also at the ends of what a sheet may state, and both conformities at once."""
    groove = replace(screw, conformity_screw=0.505, conformity_nut=0.505)
    sloped = with_raceway(groove, fractal_dimension=None, rms_slope=0.02)
    for one in INPUTS:
        found = 0
        for sheet in (groove, sloped, with_raceway(groove, cutoff_long=None, state='run_in')):
            case = ScrewCase(screw=sheet, lubricant=oil, point=POINT)
            ends = one.bounds(case) or ()
            found += len(ends)
            assert all(one.at(case, value) for value in ends)
        assert found
    low, _ = BY_NAME['conformity_screw'].bounds(
        ScrewCase(screw=groove, lubricant=oil, point=POINT)
    )
    assert low == 0.501
    nut = BY_NAME['conformity_screw'].at(ScrewCase(screw=groove, lubricant=oil, point=POINT), low)
    assert nut.screw.conformity_nut == 0.501
    assert {spec.name for spec in fields(OperatingPoint)} >= {'temperature'}


def test_unequal_conformities_move_by_the_same_step(screw, oil):
    """The nut from its own value, as far as a sheet may state it."""
    uneven = replace(screw, conformity_screw=0.52, conformity_nut=0.54)
    groove, case = BY_NAME['conformity_screw'], ScrewCase(screw=uneven, lubricant=oil, point=POINT)
    sheets = [groove.at(case, value).screw for value in groove.bounds(case)]
    assert [sheet.conformity_screw for sheet in sheets] == pytest.approx([0.51, 0.53])
    assert [sheet.conformity_nut for sheet in sheets] == pytest.approx([0.53, 0.55])
    stated = groove.at(case, groove.stated(case)).screw
    assert (stated.conformity_screw, stated.conformity_nut) == (0.52, 0.54)
    tight = replace(case, screw=replace(uneven, conformity_nut=0.505))
    assert groove.at(tight, 0.51).screw.conformity_nut == 0.501


def test_the_page_says_where_the_law_is_off_by_more_than_its_band(screw, oil, record, says):
    assert record['law_doubt'] == ''
    assert '\n  law ' not in sensitivity_page(record)
    fine = sensitivity_record(with_raceway(screw, rms=0.04e-6), oil, POINT, inputs=QUICK[:1])
    assert f'\n  law        {says("rms_0_04")}\n' in sensitivity_page(fine)


def test_half_and_double_of_the_working_load_move_what_ran_in_by_less_than_a_fifth(screw, oil):
    """Assumed or stated, so that they are in no band; a raceway traced as it runs has none."""
    load = BY_NAME['working_load']
    case = ScrewCase(screw=screw, lubricant=oil, point=POINT)
    assert load.bounds(case) is None
    run_in = with_raceway(screw, state='run_in')
    assumed = math.sqrt(2) * 990, 4 * math.sqrt(2) * 990
    assert load.bounds(replace(case, screw=run_in)) == pytest.approx(assumed)
    traced = with_raceway(run_in, traced='run_in')
    assert load.bounds(replace(case, screw=traced)) is None
    run_in = replace(run_in, working_load=1000.0)
    assert load.bounds(replace(case, screw=run_in)) == (500.0, 2000.0)
    found = sensitivity_record(run_in, oil, POINT, inputs=[load, BY_NAME['temperature']])
    row = row_of(found, 'working_load_N')
    assert [row[end] for end in ('low', 'stated', 'high')] == [500.0, 1000.0, 2000.0]
    light, heavy = row['onset_factors']
    assert 1.2 > light > 1 > heavy > 0.8
    heat = row_of(found, 'temperature_degC')['onset_factors']
    assert found['limit_band'] == pytest.approx(unknown_band([('', heat)]))


def test_an_end_that_the_model_refuses_is_not_known(screw, oil, refused):
    """It leaves a band that is not known, and the page has the sentence."""
    heavy = [replace(BY_NAME['preload'], times=100.0, measured='torque without load')]
    found = sensitivity_record(screw, oil, POINT, inputs=heavy)
    assert math.isnan(found['inputs'][0]['onset_factors'][1])
    assert all(map(math.isnan, found['limit_band']))
    assert 'allowed is up to static_rating_kN' in sensitivity_page(found)
    refused('smooth', sensitivity_record, with_raceway(screw, rms=0.0), oil, POINT)


def test_the_page_has_a_line_per_input_and_keeps_the_bands_apart(record):
    page = sensitivity_page(record)
    assert '600 rev/min, 500 N, 40 degC, closed form' in page
    assert page.count('\n  film_floor_nm ') == 1
    low, high = record['limit_band']
    assert f'not known  contact begins at {low:.2g} to {high:.2g} times the stated speed' in page
    low, high = record['numerical_band']
    assert f'numerics   contact begins at {low:.2g} to {high:.2g} times' in page
    assert 'measure    film floor by torque at slow speeds: ' in page
    assert 'then       oil temperature at the nut: ' in page


PAGE = """\
s, o: 30 rev/min, 500 N, 40 degC, closed form
low stated high onset torque RCS 0.01 eta 0.85
rev/min N m rev/min rev/min
as stated 60 0.5 90 -
a_unit 0.5 - 10710 30 to 120 0.4 to - 45 to 180 - to 300 because
b 1 1.5 1000000 30 to 120 0.4 to - 45 to 180 - to 300 not so
not known contact begins at 0.5 to 2 times the stated speed: 30 to 120 rev/min
numerics contact begins at 0.8 to 1.2 times the stated speed: 48 to 75 rev/min
both contact begins at 0.4 to 2.5 times the stated speed: 24 to 150 rev/min
law here it is off
measure m: 0.66 to 1.5 times is left
then n: 0.78 to 1.3 times is left"""


def test_the_page_of_a_record_by_hand():
    names = ('onset_speed_rad_s', 'friction_torque_Nm')
    names += ('rcs_limit_speed_rad_s', 'efficiency_limit_speed_rad_s')
    stated, low, high = (
        dict(zip(names, numbers, strict=True))
        for numbers in (
            (60 * RPM, 0.5, 90 * RPM, math.nan),
            (30 * RPM, 0.4, 45 * RPM, math.nan),
            (120 * RPM, math.nan, 180 * RPM, 300 * RPM),
        )
    )
    ends = {'at_low': low, 'at_high': high, 'reason': 'because'}
    record = {
        'screw': 's',
        'oil': 'o',
        'speed_rad_s': 30 * RPM,
        'load_N': 500.0,
        'temperature_K': 313.15,
        'stated': stated,
        'inputs': [
            {'key': 'a_unit', 'low': 0.5, 'stated': None, 'high': 10714.0, 'refused': '', **ends},
            {'key': 'b', 'low': 1.0, 'stated': 1.5, 'high': 1e6, 'refused': 'not so', **ends},
        ],
        'limit_band': [0.5, 2.0],
        'numerical_band': [0.8, 1.25],
        'band': [0.4, 2.5],
        'law_doubt': 'here it is off',
        'measure': [
            {'measurement': 'm', 'limit_band': [0.7, 1.4]},
            {'measurement': 'n', 'limit_band': [0.9, 1.1]},
        ],
    }
    lines = sensitivity_page(record).splitlines()
    assert [' '.join(line.split()) for line in lines] == PAGE.splitlines()


def test_a_light_load_has_no_limit_of_efficiency(screw, oil):
    point = replace(POINT, load=100.0)
    found = sensitivity_record(screw, oil, point, inputs=QUICK[:1])
    assert math.isnan(found['stated']['efficiency_limit_speed_rad_s'])
    assert sensitivity_page(found).splitlines()[3].split()[-1] == '-'


def test_the_picture_has_a_bar_per_end_and_the_bands(record, tmp_path):
    pytest.importorskip('matplotlib')
    from surrogate.screw.figures import draw_sensitivity, figure_sensitivity

    figure = figure_sensitivity(record)
    assert [axes.get_title() for axes in figure.axes] == [
        'Contact begins',
        'Friction torque',
        'Efficiency falls to 0.85',
    ]
    bars = 2 * len(record['inputs'])
    assert [len(axes.patches) for axes in figure.axes] == [bars + 3, bars, bars]
    words = [text.get_text() for text in figure.axes[0].get_yticklabels()]
    assert words[:3] == ['both', 'numerics', 'not known']
    assert words[-1] == 'film_floor_nm  1 to 5'
    assert draw_sensitivity(tmp_path, record).name == 'sensitivity_nominal_iso_vg_68.png'


def test_columns_stay_apart_whatever_their_numbers_are(record):
    """Also where a number is longer than its column is wide."""
    row = record['inputs'][0]
    small = {end: dict.fromkeys(row[end], 1.23e-09) for end in ('at_low', 'at_high')}
    long = {**record, 'inputs': [{**row, **small, 'low': 1.234e-9, 'high': 5.678e-9}]}
    (line,) = [one for one in sensitivity_page(long).splitlines() if f'  {row["key"]} ' in one]
    fields = line.split()
    assert (fields[1], fields[3]) == ('0.000000001234', '0.000000005678')
    assert fields[4:13:3] == fields[6:13:3] != fields[5:13:3] == ['to'] * 3
