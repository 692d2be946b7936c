# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Record, page and picture of the onset by the topography."""

from dataclasses import replace
import math

import numpy as np
import pytest
from surrogate.asperities.law import FILM_BANDS
from surrogate.formulas.geometry import screw_contact
from surrogate.formulas.inlet import inlet_speed
from surrogate.formulas.kinematics import no_slip_rates
from surrogate.formulas.load_sharing import normal_force
from surrogate.parameters import BallRoughness, load_screw
from surrogate.screw import closed_form
from surrogate.screw.contacts import oil_at
from surrogate.screw.figures import figure_onset
from surrogate.screw.onset_record import extrapolated, onset_page, onset_record
from surrogate.screw.opened import Contacts
from surrogate.screw.screw_onset import (
    law_band,
    onset_over_working_load,
    onset_point,
    onset_speeds,
    with_raceway,
)
from surrogate.units import RPM

pytestmark = pytest.mark.usefixtures('small_tiles')
KELVIN = 313.15


@pytest.fixture(scope='module')
def record(screw, oil):
    return onset_record(screw, oil, 0.0, KELVIN)


PAGE = """\
s, o: 500 N, 40 degC
  new, after its first pass  contact begins at 60 rev/min (30 to 120), film 50 nm, cut at 7 GPa
  run in                     contact begins at 30 rev/min (15 to 60), film 25 nm, cut at 3 GPa
                             a measured m leaves 17.2 to 47.7 rev/min
  Contact is likely below 15 rev/min and possible below 120 rev/min.
  summits are cut under 2800 N, 1.5 GPa
  run in under 1400 N, contact begins at 45 rev/min, under 12050 N at 12 rev/min
  extrapolated: Rq
  roughness: rough"""


def test_the_page_of_a_record_by_hand():
    state = {'speed_rad_s': 60 * RPM, 'central_film_m': 50e-9, 'cutting_pressure_Pa': 7e9}
    run_in = {'speed_rad_s': 30 * RPM, 'central_film_m': 25e-9, 'cutting_pressure_Pa': 3e9}
    record = {
        'screw': 's',
        'oil': 'o',
        'load_N': 500.0,
        'temperature_K': 313.15,
        'states': {'new': state, 'run_in': run_in},
        'working_load_stated': True,
        'working_load_N': 2800.0,
        'working_pressure_Pa': 1.5e9,
        'other_working_loads_N': [1400.0, 12050.0],
        'other_working_load_speeds_rad_s': [45 * RPM, 12 * RPM],
        'extrapolated': ['Rq'],
        'roughness': 'rough',
    }
    for one in (state, run_in):
        one |= {'band': [0.5, 2.0], 'numerical_band': [0.8, 1.25], 'measure': [], 'marched': False}
    run_in['measure'] = [{'measurement': 'm', 'limit_band': [0.6, 1.5]}]
    assert onset_page(record) == PAGE


def test_both_states_and_their_bounds_stand_in_the_record(record, screw, oil):
    new, run = record['states']['new'], record['states']['run_in']
    assert new['speed_rad_s'] > run['speed_rad_s'] > 0
    assert new['cutting_pressure_Pa'] == 7e9
    assert record['working_load_stated'] is False


def test_other_working_loads_cut_the_summits_of_the_last_state(record, screw, oil):
    """The higher the load, the lower the summits and the slower the onset; half and double."""
    low, high = record['other_working_loads_N']
    assert [low, high] == pytest.approx([math.sqrt(2) * 990, 4 * math.sqrt(2) * 990])
    slow = with_raceway(screw, state='run_in')
    for load, speed in zip((low, high), record['other_working_load_speeds_rad_s'], strict=True):
        assert (
            speed
            == onset_point(Contacts.of(replace(slow, working_load=load)), oil, 0.0, KELVIN)[
                'speed_rad_s'
            ]
        )
    half, double = record['other_working_load_speeds_rad_s']
    assert half > record['states']['run_in']['speed_rad_s'] > double > 0


def test_summits_persist_whatever_load_ran_them_in(oil):
    """A 40 x 10 under 5.4 to 25 kN, 1.5 to 2.5 GPa on summits that yield at 3 GPa."""
    run_in, loads = load_screw('iso3408_40x10'), [5.4e3, 10e3, 15e3, 25e3]
    speeds = onset_over_working_load(run_in, oil, 0.0, KELVIN, loads)
    assert speeds == sorted(speeds, reverse=True)
    assert 1.0 < speeds[0] / speeds[-1] < 1.5
    # Also where the contact itself is pressed by more than that.
    (crushed,) = onset_over_working_load(run_in, oil, 0.0, KELVIN, [80e3])
    assert 0.8 < crushed / speeds[-1] < 1.1


def test_a_point_is_where_the_law_of_the_state_says(screw, oil, record):
    """Of the faster side, by the entrainment; a film of the same size as the roughness."""
    force, fluid = float(normal_force(screw, screw.preload)), oil_at(oil, KELVIN)
    for state, found in record['states'].items():
        onsets = Contacts.of(with_raceway(screw, state=state)).law.onsets
        assert found['entrainment_speed_m_s'] == max(
            onset.speed(screw_contact(screw, side), force, fluid, oil.film_floor)
            for side, onset in onsets.items()
        )
        entrainment = found['speed_rad_s'] * no_slip_rates(screw).entrainment
        slowed = [
            float(inlet_speed(screw, oil, side, force, entrainment, KELVIN)) for side in onsets
        ]
        assert any(found['entrainment_speed_m_s'] == pytest.approx(speed) for speed in slowed)
        assert 0.3 < found['central_film_m'] / screw.roughness.rms < 2


def test_the_band_in_speed_is_that_in_film_by_the_slope_of_the_place(screw, oil, record):
    """Of nearly a power law: ln(high/low) = 2 ln F/s; summits that were cut flatter it."""
    bands = {
        state: law_band(Contacts.of(with_raceway(screw, state=state)), oil, 0.0, KELVIN)
        for state in record['states']
    }
    for found in bands.values():
        (low, high), factor = found['band'], found['film_factor']
        assert factor == pytest.approx(FILM_BANDS['isotropic'])
        assert low < 1 / factor < 1 < factor < high
        heated = math.log(high / low)  # the inlet slows the faster end
        assert heated == pytest.approx(2 * math.log(factor) / found['slope'], rel=0.05)
    new, run_in = (bands[state] for state in ('new', 'run_in'))
    assert run_in['slope'] < new['slope']
    assert run_in['band'][1] > new['band'][1]
    floor = law_band(Contacts.of(with_raceway(screw, rms=0.01e-6)), oil, 0.0, KELVIN)
    assert floor['slope'] == pytest.approx(0.67, abs=0.03)  # a film of floors alone


def test_half_the_film_of_starvation_needs_a_faster_speed(screw, oil, record):
    starved = onset_point(Contacts.of(screw), replace(oil, film_factor=0.5), 0.0, KELVIN)
    assert starved['speed_rad_s'] > 2 * record['states']['new']['speed_rad_s']


def test_the_page_says_where_contact_is_sure_and_where_possible(record):
    page = onset_page(record)
    new = record['states']['new']
    fastest = new['band'][1] * new['speed_rad_s'] / RPM
    assert f'possible below {fastest:.3g} rev/min' in page
    assert 'cut at 7 GPa' in page
    assert 'assumed: it unloads the relieved nut' in page


def test_a_profile_traced_after_running_in_has_one_state_that_larger_loads_cut(screw, oil, record):
    traced = with_raceway(screw, state='run_in', traced='run_in')
    found = onset_record(traced, oil, 0.0, KELVIN)
    assert list(found['states']) == ['run_in']
    speed = found['states']['run_in']['speed_rad_s']
    assert speed == record['states']['new']['speed_rad_s']
    assert onset_record(traced, oil, -5000.0, KELVIN)['working_load_N'] == 5000.0
    found = onset_record(replace(traced, working_load=900.0), oil, 500.0, KELVIN)
    assert (found['working_load_N'], found['working_load_stated']) == (900.0, True)
    assert 'cut under 900 N, ' in onset_page(found)


def test_a_calibrated_raceway_has_the_state_and_the_band_of_its_calibration(screw, oil, record):
    """Every onset of a surface follows, and the page says the day."""
    sheet = with_raceway(screw, onset_factor=0.5, onset_band=1.15, calibrated='2026-11-24')
    found = onset_record(sheet, oil, 0.0, KELVIN)
    assert list(found['states']) == ['new']
    state = found['states']['new']
    assert state['band'] == pytest.approx([1 / 1.15, 1.15], rel=0.01)
    assert state['film_factor'] == 1
    new = record['states']['new']
    assert state['entrainment_speed_m_s'] == 0.5 * new['entrainment_speed_m_s']
    assert state['speed_rad_s'] == pytest.approx(0.5 * new['speed_rad_s'], rel=0.01)
    assert 'onset calibrated on 2026-11-24 within 1.15' in onset_page(found)
    place = np.array([0.0, 500.0]), np.array([KELVIN])
    usual, scaled = (onset_speeds(Contacts.of(one), oil, *place) for one in (screw, sheet))
    np.testing.assert_allclose(scaled, 0.5 * usual, rtol=0.01)
    speeds = np.array([5.0, 20.0, 40.0])
    rcs, slower = (
        closed_form.solve(
            Contacts.of(one), oil, part * speeds, 0.0, KELVIN, inlet_heating=False
        ).rcs
        for one, part in ((screw, 1.0), (sheet, 0.5))
    )
    np.testing.assert_allclose(slower, rcs, rtol=1e-9)


def test_an_onset_that_was_marched_says_so_in_its_state_alone(screw, oil, record):
    """The other state, its range and other loads are by the law."""
    sheet = with_raceway(screw, marched_film=1.2, marched_error=0.03, rms=0.04e-6)
    assert extrapolated(sheet) == []
    sheet = with_raceway(screw, marched_film=1.2, marched_error=0.03)
    found = onset_record(sheet, oil, 0.0, KELVIN)
    new, usual = found['states']['new'], record['states']['new']
    assert (new['marched'], usual['marched']) == (True, False)
    assert found['states']['run_in'] == record['states']['run_in']
    assert new['speed_rad_s'] > 1.2 * usual['speed_rad_s']
    assert new['film_factor'] == pytest.approx(math.exp(1.645 * 0.03))
    # The error of the strips by the slope, beside 2 % of speed for the lookup.
    (low, high), (least, most) = new['numerical_band'], usual['numerical_band']
    reach = math.hypot(1.645 * 0.03 / new['slope'], 0.022)
    assert [low, high] == pytest.approx([math.exp(-reach), math.exp(reach)], rel=0.01)
    assert least < low < 1 < high < most
    assert new['limit_band'] == pytest.approx(usual['limit_band'], rel=0.05)
    begins, other = onset_page(found).splitlines()[1:3]
    assert 'new, after its first pass  marched on this raceway: contact begins at ' in begins
    assert 'marched' not in other


@pytest.mark.parametrize(
    ('load', 'kelvin', 'sentence'),
    [
        (math.nan, KELVIN, 'load_n_nan'),
        (math.inf, KELVIN, 'load_n_inf'),
        (0.0, 450.0, 'temperature_176_85'),
    ],
)
def test_a_place_that_no_screw_has_is_refused(screw, oil, load, kelvin, sentence, refused):
    refused(sentence, onset_record, screw, oil, load, kelvin)


@pytest.mark.parametrize(
    ('name', 'ends'), [('rms', (0.05e-6, 0.4e-6)), ('cutoff_short', (1.25e-6, 10e-6))]
)
def test_the_ends_of_what_was_marched_are_not_extrapolated(screw, name, ends):
    for end, beyond in zip(ends, (0.0, math.inf), strict=True):
        assert extrapolated(with_raceway(screw, **{name: end})) == []
        assert len(extrapolated(with_raceway(screw, **{name: math.nextafter(end, beyond)}))) == 1


def test_what_was_not_marched_is_called_extrapolated(screw, says):
    assert extrapolated(screw) == []
    assert extrapolated(with_raceway(screw, rms=0.0)) == []
    rough = replace(screw, ball_roughness=BallRoughness(grade='G10'))
    assert extrapolated(rough) == ['rough balls (marched: smooth ones)']
    fine = with_raceway(screw, cutoff_short=0.5e-6, rms=0.04e-6)
    assert extrapolated(fine) == [says('rms_0_04'), says('short')]
    assert extrapolated(with_raceway(screw, lay='longitudinal', fan_angle=0.2, rms=0.4e-6)) == []
    known = {'onset_factor': 0.6, 'onset_band': 1.4, 'calibrated': '2026-11-24'}
    assert extrapolated(with_raceway(screw, rms=0.04e-6, **known)) == []


@pytest.mark.parametrize('lay', ['longitudinal', 'transverse'])
def test_ridges_without_a_fan_have_an_onset(screw, oil, lay):
    ridges = with_raceway(screw, lay=lay, fan_angle=0.0, state='run_in')
    assert onset_point(Contacts.of(ridges), oil, 0.0, KELVIN)['speed_rad_s'] > 0


def test_smooth_raceways_say_so(screw, oil):
    smooth = with_raceway(screw, rms=0.0)
    speeds = onset_speeds(Contacts.of(smooth), oil, np.array([0.0]), np.array([KELVIN]))
    assert speeds == pytest.approx(1e-3 / no_slip_rates(screw).entrainment)
    assert onset_point(Contacts.of(smooth), oil, 0.0, KELVIN)['speed_rad_s'] == 0.0
    page = onset_page(onset_record(smooth, oil, 0.0, KELVIN))
    assert 'no contact: raceway and ball are smooth' in page
    assert 'Contact is likely' not in page
    assert 'run in under' not in page


def test_the_picture_is_a_line_of_speed_by_state_and_temperature(screw, oil, record):
    """Where contact is sure ends and where it is free begins, as the record has them."""
    axes = figure_onset(screw, oil, record).axes[0]
    names = [label.get_text() for label in axes.get_yticklabels()]
    assert names == [f'{state}, {warm} °C' for state in ('new', 'run in') for warm in (25, 40, 55)]
    bars = [one for one in axes.patches if one.get_width() > 0]
    ends = {}
    for bar in bars:
        ends.setdefault(round(bar.get_y() + 0.36), []).append(bar.get_x() + bar.get_width())
    states = record['states']
    low, high = (factor * states['new']['speed_rad_s'] / RPM for factor in states['new']['band'])
    assert sorted(ends[1])[:2] == pytest.approx([low, high])
    run_in = states['run_in']
    low, high = (factor * run_in['speed_rad_s'] / RPM for factor in run_in['band'])
    assert sorted(ends[4])[:2] == pytest.approx([low, high])
    assert sorted(ends[0])[0] < sorted(ends[1])[0] < sorted(ends[2])[0]  # colder oil is thicker
    assert {round(max(edges), 6) for edges in ends.values()} == {
        round(screw.fastest_speed / RPM, 6)
    }


def test_the_picture_of_smooth_raceways_is_free_of_contact(screw, oil):
    smooth = with_raceway(screw, rms=0.0)
    axes = figure_onset(smooth, oil, onset_record(smooth, oil, 0.0, KELVIN)).axes[0]
    wide = [bar for bar in axes.patches if bar.get_width() > 0]
    assert len(wide) == len(axes.get_yticklabels())
