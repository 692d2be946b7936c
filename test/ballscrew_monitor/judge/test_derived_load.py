# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""A load out of the motor torque: round trips, refusals, what the uncertainty holds, compiled."""

import dataclasses
import math
from types import SimpleNamespace

from ballscrew_monitor.core.conversions import Direction, direction_of, opposing_load, signed
from ballscrew_monitor.core.state import LoadDerivation
from ballscrew_monitor.judge import derived_load
from ballscrew_monitor.judge.records import Row, Settings
from ballscrew_monitor.messages.unjudged import derived_text
from hypothesis import assume, given
from hypothesis import strategies as st
import numpy as np
import pytest
from surrogate.surface import scan, shipped_surface, Surface, Validity
from surrogate.surface.file import read


def masked():
    """Return a surface without the middle of its loads."""
    data = read(shipped_surface())
    mask = data.mask.copy()
    mask[:, 12:20, :] = True
    return Surface(dataclasses.replace(data, mask=mask))


def surfaces():
    """Return the shipped ones, one that a full solve has pulled, and one with a hole."""
    shipped = [Surface.load(shipped_surface(tier=tier)) for tier in ('closed_form', 'full')]
    point = SimpleNamespace(speed=62.8, opposing_load=1020.0, temperature=313.15)
    pulled = shipped[1].with_correction(point, SimpleNamespace(friction_torque=0.5))
    return [*shipped, pulled, masked()]


SURFACES = surfaces()
either = st.sampled_from(SURFACES)
SPEEDS = st.floats(0.5, 220.0)
LOADS = st.floats(1.0, 3900.0)
KELVINS = st.floats(284.0, 352.0)
SIGNS = st.sampled_from((-1.0, 1.0))
INERTIA = 2e-3  # [kg m2]
PER_NEWTON = 0.01 / math.tau  # [N m/N]
USUAL = Settings(inertia=1e-3, torque_uncertainty=0.05, parts_uncertainty=0.1, largest_share=0.8)
IDLE = (2600.0, 2860.0)  # [N] about the load at which a nut falls idle the torque turns back


def told(**changes):
    """Return settings without uncertainty that derive whatever inertia takes."""
    values = {
        'inertia': INERTIA,
        'window': 50_000_000,
        'torque_uncertainty': 0.0,
        'parts_uncertainty': 0.0,
        'largest_share': 1e9,
    }
    return LoadDerivation(**(values | changes))


def at(speed, torque, *, acceleration=0.0, change=0.0, temperature=313.15):
    """Return how a screw runs in the direction of its speed."""
    return speed, acceleration, change, torque, temperature


def derived_number(surface, how, course):
    """Return the row with the load that follows."""
    speed, acceleration, change, torque, temperature = course
    row = Row(speed=speed, motor_torque=torque, temperature=temperature)
    row.direction = int(direction_of(speed))
    derived_load.derive_load(surface.tables, how, row, acceleration, change)
    return row


def derived(running, surface, how):
    row = derived_number(surface, how, running)
    return SimpleNamespace(
        validity=Validity(row.validity),
        axial_load=row.axial_load,
        uncertainty=row.axial_load_uncertainty,
        reason=derived_text(row),
    )


def motor_torque(surface, speed, force, *, acceleration=0.0, temperature=313.15):
    """Return the torque [N m] that a motor gives at a load [N], machine frame; None: no answer."""
    direction = direction_of(speed)
    point = surface.lookup(abs(speed), opposing_load(force, direction), temperature)
    if point.validity != Validity.VALID:
        return None
    return signed(point.driving_torque, direction) + INERTIA * acceleration


@given(either, SPEEDS, SIGNS, LOADS, SIGNS, KELVINS, st.floats(-100.0, 100.0))
def test_the_load_comes_back(surface, amount, way, force, sign, temperature, acceleration):
    assume(not IDLE[0] < force < IDLE[1])
    speed, load = way * amount, sign * force
    torque = motor_torque(surface, speed, load, acceleration=acceleration, temperature=temperature)
    assume(torque is not None)
    found = derived(
        at(speed, torque, acceleration=acceleration, temperature=temperature), surface, told()
    )
    assume(found.validity is not Validity.MASKED)  # a gap beside the load hides it
    assert found.reason == ''
    assert found.axial_load == pytest.approx(load, rel=1e-6)


@given(either, SPEEDS, SIGNS, LOADS, SIGNS, st.floats(0.001, 0.5), st.floats(-1.0, 1.0))
def test_the_uncertainty_holds_the_load(surface, amount, way, force, sign, uncertainty, off):
    speed, load = way * amount, sign * force
    torque = motor_torque(surface, speed, load)
    assume(torque is not None)
    how = told(torque_uncertainty=uncertainty)
    found = derived(at(speed, torque + off * uncertainty), surface, how)
    assume(found.validity is Validity.VALID)
    # Linear between the scanned loads, so not to the last digit.
    assert abs(found.axial_load - load) <= found.uncertainty * 1.02 + 1e-6


@given(SPEEDS, LOADS, SIGNS)
def test_a_mirrored_machine_mirrors_the_load(amount, force, sign):
    surface = SURFACES[0]
    torque = motor_torque(surface, amount, sign * force)
    here, there = (
        derived(at(way * amount, way * torque), surface, told(torque_uncertainty=0.01))
        for way in (1.0, -1.0)
    )
    assert there.validity is here.validity
    assert there.axial_load == pytest.approx(-here.axial_load, rel=1e-12, nan_ok=True)
    assert there.uncertainty == pytest.approx(here.uncertainty, rel=1e-12, nan_ok=True)


@pytest.fixture
def straight(core):
    """Return a surface of 0.125 N m of friction at any load, and 1/1024 N m more a newton."""
    made = core.surface(driving_torque=lambda speed, load: load / 1024.0 + 0.125)
    made.lead = math.tau / 1024.0
    return made


@pytest.mark.parametrize(
    ('speed', 'torque', 'load'),
    [
        (10.0, 1.125, -1024.0),  # drives against a load that opposes, by its direction alone
        (10.0, -0.875, 1024.0),  # brakes a load that assists
        (10.0, 0.0, 128.0),  # a load that just overcomes friction
        (-10.0, -1.125, 1024.0),
        (-10.0, 0.875, -1024.0),
    ],
)
def test_four_quadrants_by_hand(straight, speed, torque, load):
    found = derived(at(speed, torque), straight, told(inertia=0.0))
    assert found.axial_load == pytest.approx(load, rel=1e-12)


def test_inertia_is_taken_off_and_the_half_width_is_the_sum_of_what_is_stated(straight):
    for way in (1.0, -1.0):
        for acceleration in (100.0, -100.0):
            running = at(way * 10.0, way * 1.125 + INERTIA * acceleration)
            running = at(running[0], running[3], acceleration=acceleration)
            found = derived(running, straight, told())
            assert found.axial_load == pytest.approx(-way * 1024.0, rel=1e-9)
    straight.numbers |= {'friction_torque_error': 0.0625, 'friction_torque_stderr': 0.03125}
    straight.parasitic_torque = 0.25
    how = told(torque_uncertainty=0.125, parts_uncertainty=0.5)
    running = at(10.0, 1.125 + INERTIA * 125.0, acceleration=125.0, change=50.0)
    found = derived(running, straight, how)
    parts = 0.25 + INERTIA * 125.0
    expected = (0.125 + 0.5 * parts + INERTIA * 50.0 + 0.0625 + 0.03125) * 1024.0
    assert found.uncertainty == pytest.approx(expected, rel=1e-9)


@pytest.mark.parametrize('end', [1.0, -1.0])
def test_the_range_may_reach_beyond_the_surface(core, end):
    """32 N up to its end, and the rest of the torque as without friction, half as steep."""
    surface = core.surface(driving_torque=lambda speed, load: load / 512.0)
    surface.lead = math.tau / 1024.0
    found = derived(at(10.0, end * 7.75), surface, told(inertia=0.0, torque_uncertainty=1.0))
    assert found.uncertainty == pytest.approx(32.0 + 0.9375 * 1024.0, rel=1e-9)


def test_drag_is_not_taken_off_twice(straight):
    """The friction of the surface holds it already."""
    without = derived(at(10.0, 1.125), straight, told())
    straight.parasitic_torque = 0.1
    assert derived(at(10.0, 1.125), straight, told()).axial_load == without.axial_load


def test_a_share_of_inertia_and_drag_up_to_the_stated_one(straight, says):
    straight.parasitic_torque = 0.25
    running = at(10.0, 1.0, acceleration=0.25 / INERTIA)
    assert derived(running, straight, told(largest_share=0.5)).validity is Validity.VALID
    below = math.nextafter(0.5, 0.0)
    found = derived(running, straight, told(largest_share=below))
    assert (found.validity, found.reason) == (Validity.UNKNOWN, says('inertia_drag_take'))
    assert math.isnan(found.axial_load)
    assert math.isnan(found.uncertainty)


def test_without_an_acceleration_inertia_is_not_known(straight):
    running = at(10.0, 1.0, acceleration=math.nan)
    assert derived(running, straight, told()).reason.startswith(
        'the acceleration is not known yet'
    )
    assert derived(running, straight, told(inertia=0.0)).validity is Validity.VALID


def folded(speed, load):
    """Return a driving torque that falls by 1 N m from 1000 to 1024 N."""
    drop = min(max((load - 1000.0) / 24.0, 0.0), 1.0)
    return load / 1024.0 + 0.125 - drop


def test_a_torque_of_several_loads_is_that_of_none(core, says):
    surface = core.surface(driving_torque=folded)
    surface.lead = math.tau / 1024.0
    found = derived(at(10.0, 0.6), surface, told(inertia=0.0))
    assert found.validity is Validity.UNKNOWN
    assert found.reason == says('torque_several_loads')
    wide = derived(at(10.0, 0.6), surface, told(inertia=0.0, torque_uncertainty=0.6))
    assert wide.axial_load == pytest.approx(-0.5 * (486.4 + 1510.4), rel=1e-3)
    # Between 0 and 1.2 N m, from -128 N of the lower branch to 2124.8 N of the upper one.
    assert wide.uncertainty == pytest.approx(0.5 * (2124.8 + 128.0), rel=1e-3)


@pytest.mark.parametrize('torque', [4.5, -4.5, 1e12])
@pytest.mark.parametrize('known', [4000.0, 3900.0, 3800.0])
def test_a_torque_beyond_the_surface(core, torque, known):
    surface = core.surface(
        driving_torque=lambda speed, load: load / 1024.0 if abs(load) <= known else math.nan
    )
    found = derived(at(10.0, torque), surface, told(inertia=0.0))
    assert found.validity is Validity.LOAD_OUT_OF_RANGE
    assert found.reason == (
        f'the torque along the motion, {torque:.3g} N m, asks for a load outside the surface, '
        f'-{known:.0f} to {known:.0f} N that oppose the motion'
    )


NAN = math.nan


@pytest.mark.parametrize(
    ('torques', 'found'),
    [
        ([-2.0, -1.0, 1.0, 2.0], (1, 1, False)),
        ([-1.0, 0.0, 1.0], (1, 1, False)),  # one that is the driving torque is not above it
        ([-1.0, 1.0, 0.0, -1.0, 1.0], (0, 3, False)),
        ([NAN, 1.0, NAN, 2.0, 3.0], (-1, -1, False)),
        ([1.0, -1.0, NAN, 1.0], (0, 0, True)),
        ([NAN, NAN], (-1, -1, False)),
    ],
)
def test_crossings_of_zero(torques, found):
    assert derived_load.crossings(torques, 0.0, 0, len(torques)) == found


def test_a_gap_of_the_surface_that_may_hold_the_load(core):
    surface = core.surface(
        driving_torque=lambda speed, load: (
            math.nan if 900.0 < load < 1100.0 else load / 1024.0 + 0.125
        )
    )
    assert derived(at(10.0, 1.125), surface, told()).validity is Validity.MASKED
    assert derived(at(10.0, 2.125), surface, told()).validity is Validity.VALID
    surface = core.surface(driving_torque=math.nan)
    assert derived(at(10.0, 1.0), surface, told()).validity is Validity.MASKED


@pytest.mark.parametrize(
    ('course', 'code', 'validity'),
    [
        ((60.0, 0.0, 0.0, 2.0, 313.15), derived_load.DERIVED_OK, Validity.VALID),
        ((-60.0, 10.0, 1.0, -2.0, 313.15), derived_load.DERIVED_OK, Validity.VALID),
        ((60.0, math.nan, 0.0, 2.0, 313.15), derived_load.NO_ACCELERATION, Validity.UNKNOWN),
        ((60.0, 1e4, 0.0, 2.0, 313.15), derived_load.TOO_MUCH_INERTIA, Validity.UNKNOWN),
        ((60.0, 0.0, 0.0, 50.0, 313.15), derived_load.OUTSIDE, Validity.LOAD_OUT_OF_RANGE),
        ((300.0, 0.0, 0.0, 2.0, 313.15), derived_load.NO_NUMBER, Validity.SPEED_ABOVE_RANGE),
        ((0.01, 0.0, 0.0, 2.0, 313.15), derived_load.NO_NUMBER, Validity.SPEED_BELOW_RANGE),
        ((60.0, 0.0, 0.0, 2.0, 200.0), derived_load.NO_NUMBER, Validity.TEMPERATURE_OUT_OF_RANGE),
    ],
)
def test_every_code(course, code, validity):
    found = derived_number(SURFACES[1], USUAL, course)
    assert (found.derived, found.validity) == (code, validity)
    assert math.isfinite(found.axial_load) is (code == derived_load.DERIVED_OK)


def test_a_hole_in_the_loads_is_masked():
    surface = SURFACES[3]
    scan(surface.tables, 60.0, 313.15)
    torques = np.array(surface.tables.scan_torques)
    known = torques[np.isfinite(torques)]
    hole = np.flatnonzero(np.isnan(torques))
    middle = 0.5 * (torques[hole[0] - 1] + torques[hole[-1] + 1])
    assert known[0] < middle < known[-1]
    found = derived_number(surface, USUAL, (60.0, 0.0, 0.0, float(middle), 313.15))
    assert (found.derived, found.validity) == (derived_load.NO_NUMBER, Validity.MASKED)


@pytest.mark.parametrize(
    ('heres', 'middles'),
    [
        ([0.5, 0.0], [0.5, 0.25]),  # half the rest at the new end: half of that at the other
        ([2.0, 0.0], [0.5, 0.1]),  # more than before: half all the same
        ([1.0, 0.0], [0.5, 1.0 / 6.0]),
        ([-0.5, 0.0], [0.5, 2.0 / 3.0]),  # the other side: a secant
    ],
)
def test_the_rest_of_an_end_that_stays_is_made_smaller(monkeypatch, heres, middles):
    """As Anderson and Bjorck say, from -1 N m at 0 N to 1 N m at 1 N."""
    torques, places = iter(heres), []

    def look_up(tables, speed, load, temperature, row):
        places.append(load)
        row.driving_torque = next(torques)

    monkeypatch.setattr(derived_load, 'look_up', look_up)
    tables = SimpleNamespace(scan_loads=[0.0, 1.0], scan_torques=[-1.0, 1.0])
    assert derived_load.root(tables, Row(), 0.0, 0) == places[-1]
    assert places == pytest.approx(middles)


@pytest.mark.parametrize(
    ('middle', 'margin', 'error', 'loads'),
    [
        (1000.0, 100.0, 0.0, (800.0, 1200.0)),  # the ends of the margin are loads of the scan
        (1000.0, 60.0, 40.0, (800.0, 1200.0)),
        (1000.0, 99.0, 0.0, (900.0, 1100.0)),
        (1050.0, 0.0, 0.0, (1000.0, 1100.0)),
        (1000.0, 0.0, 0.0, (900.0, 1100.0)),
        (1250.0, 50.0, 0.0, (1000.0, 1400.0)),  # 1100 and 1200 N are not known
        (4000.0, 100.0, 0.0, (3800.0, 4000.0)),
        (-4000.0, 100.0, 0.0, (-4000.0, -3800.0)),
        (9000.0, 100.0, 0.0, (4000.0, 4000.0)),
        (-9000.0, 100.0, 0.0, (-4000.0, -4000.0)),
    ],
)
def test_the_part_that_is_scanned_holds_the_margin_and_a_load_on_either_side(
    core, middle, margin, error, loads
):
    """Friction is 0.125 N m at any load, so that bounds of the torque are bounds of the load."""
    unknown = (1100.0, 1200.0) if middle == 1250.0 else ()
    surface = core.surface(
        driving_torque=lambda speed, load: math.nan if load in unknown else load / 1024.0 + 0.125
    )
    surface.lead = math.tau / 1024.0
    surface.torque_low = surface.torque_high = 0.125
    surface.torque_error = error / 1024.0
    row = Row(speed=-10.0, temperature=313.15)
    driving = middle / 1024.0 + 0.125
    begin, end = derived_load.part_of(surface, row, driving, margin / 1024.0)
    found = surface.scan_loads[begin:end]
    assert (found[0], found[-1]) == loads


@pytest.mark.parametrize(
    ('torques', 'driving', 'load', 'margin', 'reach'),
    [
        ([0.0, 1.0, 2.0, 3.0], 1.5, 1.5, 0.25, 0.25),
        ([0.0, 1.0, 2.0, 3.0], 1.0, 1.0, 0.0, 0.0),
        ([0.0, 1.0, 2.0, 3.0], 1.5, 1.5, 1.5, 1.5),  # just from end to end
        ([0.0, 1.0, 2.0, 3.0], 1.5, 1.5, 2.0, 2.0),  # and as far beyond as without friction
        ([0.0, 1.0, 4.0, 5.0], 1.0, 1.0, 0.5, 0.5),
        ([0.0, 1.0, 4.0, 5.0], 1.0, 1.0, 1.5, 1.5),
        ([0.0, 1.0, 4.0, 5.0], 4.0, 2.0, 1.5, 1.5),
        ([0.0, 10.0, 20.0, 30.0], 5.0, 0.5, 1.0, 0.1),
        ([0.0, 10.0, 20.0, 30.0], 25.0, 2.5, 1.0, 0.1),
        ([0.0, 1.0, 1.0, 9.0], 0.0, 0.0, 1.0, 2.0),  # on the margin is within it
        ([-9.0, -1.0, -1.0, 0.0], 0.0, 3.0, 1.0, 2.0),
        ([NAN, 1.0, 2.0, NAN], 1.5, 1.5, 2.0, 2.0),
        ([0.0, NAN, 4.0, 5.0], 2.0, 1.0, 1.5, 0.75),  # straight over what is not known
    ],
)
def test_a_load_reaches_as_far_as_the_margin_of_its_torque(torques, driving, load, margin, reach):
    """At loads of 0 to 3 N with 1 N m a newton; linear between them and as steep beyond."""
    tables = SimpleNamespace(scan_loads=[0.0, 1.0, 2.0, 3.0], scan_torques=torques, lead=math.tau)
    found = derived_load.reach_of(tables, 0, 4, driving, load, margin)
    assert found == pytest.approx(reach, abs=1e-12)
    shifted = SimpleNamespace(
        scan_loads=[-9.0, *(one - 7.0 for one in tables.scan_loads), 9.0],
        scan_torques=[5.0, *(one - 3.0 for one in torques), 5.0],
        lead=math.tau,
    )
    again = derived_load.reach_of(shifted, 1, 5, driving - 3.0, load - 7.0, margin)
    assert again == pytest.approx(reach, abs=1e-12)


def test_crossings_count_from_the_driving_torque_and_in_the_part_asked_for():
    torques = [9.0, 4.0, 6.0, 4.0, 9.0]
    assert derived_load.crossings(torques, 5.0, 0, 5) == (0, 3, False)
    assert derived_load.crossings(torques, 5.0, 1, 3) == (1, 1, False)
    assert derived_load.crossings(torques, 5.0, 2, 4) == (2, 2, False)
    assert derived_load.crossings(torques, -5.0, 0, 5) == (-1, -1, False)


def test_a_root_on_a_load_of_the_scan_needs_no_lookup_and_one_that_is_lost_is_none(monkeypatch):
    tables = SimpleNamespace(scan_loads=[-1.0, 0.0, 2.0], scan_torques=[3.0, 4.0, 7.0])
    monkeypatch.setattr(derived_load, 'look_up', None)
    assert derived_load.root(tables, Row(), 7.0, 1) == 2.0

    def look_up(tables, speed, load, temperature, row):
        row.driving_torque = math.nan

    monkeypatch.setattr(derived_load, 'look_up', look_up)
    assert math.isnan(derived_load.root(tables, Row(), 5.0, 1))


def test_codes_are_those_of_their_enumerations_and_stay_those_of_files():
    names = 'UNKNOWN', 'VALID', 'LOAD_OUT_OF_RANGE', 'MASKED'
    kinds = 'UNKNOWN', 'VALID', 'OUTSIDE_LOADS', 'NO_ANSWER'
    for name, kind in zip(names, kinds, strict=True):
        assert getattr(derived_load, kind) == Validity[name]
    for name in ('POSITIVE', 'NEGATIVE'):
        assert getattr(derived_load, name) == Direction[name]
    codes = 'DERIVED_OK NO_ACCELERATION TOO_MUCH_INERTIA SEVERAL_LOADS'
    codes += ' OUTSIDE NO_NUMBER STANDSTILL NOT_FRESH'
    assert [getattr(derived_load, code) for code in codes.split()] == list(range(1, 9))


@pytest.mark.parametrize(('margin', 'code'), [(0.499, 'SEVERAL_LOADS'), (0.501, 'DERIVED_OK')])
def test_loads_that_lie_apart_by_twice_the_margin_are_one(core, margin, code):
    """486.4 and 1510.4 N, 1 N m apart without friction."""
    surface = core.surface(driving_torque=folded)
    surface.lead = math.tau / 1024.0
    settings = Settings(torque_uncertainty=margin, largest_share=1.0)
    row = derived_number(surface, settings, at(10.0, 0.6))
    assert row.derived == getattr(derived_load, code)
    if code == 'SEVERAL_LOADS':
        assert (row.derived_first, row.derived_second) == pytest.approx((486.4, 1510.4))
