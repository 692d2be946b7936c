# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Units and frames, exactly."""

import math

from ballscrew_monitor.core import conversions
from ballscrew_monitor.core.conversions import Direction, Nut
from hypothesis import given
from hypothesis import strategies as st
import pytest

POSITIVE, NEGATIVE = Direction.POSITIVE, Direction.NEGATIVE
PLAIN = {'scale': 1.0, 'offset': 0.0}
finite = st.floats(allow_nan=False, allow_infinity=False)


def speed(unit, value, *, handedness='right', lead=0.01, **changes):
    scaling = conversions.speed_scaling(
        unit, lead=lead, handedness=handedness, **(PLAIN | changes)
    )
    return scaling(value)


@pytest.mark.parametrize(
    ('unit', 'value', 'expected'),
    [
        ('rad/s', 12.5, 12.5),
        ('rev/min', 600.0, 20.0 * math.pi),
        ('m/s', 0.01, 2.0 * math.pi),  # one lead in a second
        ('mm/s', 10.0, 2.0 * math.pi),
        ('mm/min', 600.0, 2.0 * math.pi),
        ('m/min', 0.6, 2.0 * math.pi),
    ],
)
def test_speed_units(unit, value, expected):
    assert speed(unit, value) == pytest.approx(expected, rel=1e-15)
    assert speed(unit, -value) == -speed(unit, value)


def test_handedness_turns_rotary_speeds_and_torques():
    assert speed('rad/s', 3.0, handedness='left') == -3.0
    assert speed('rev/min', 60.0, handedness='left') == -speed('rev/min', 60.0)
    assert speed('mm/s', 10.0, handedness='left') == speed('mm/s', 10.0)
    assert conversions.torque_scaling(1.0, handedness='right', **PLAIN)(2.0) == 2.0
    assert conversions.torque_scaling(1.0, handedness='left', **PLAIN)(2.0) == -2.0
    assert conversions.signed(2.0, POSITIVE) == 2.0
    assert conversions.signed(2.0, NEGATIVE) == -2.0


def test_scale_comes_before_offset_and_both_before_the_unit():
    assert speed('rad/s', 3.0, scale=2.0, offset=-1.0) == 5.0
    assert conversions.load_scaling('kN', scale=2.0, offset=1.0)(3.0) == 7000.0
    assert conversions.temperature_scaling('degC', scale=0.5, offset=10.0)(60.0) == 313.15
    assert conversions.torque_scaling(0.5, scale=2.0, offset=1.0, handedness='left')(3.0) == -3.5


@pytest.mark.parametrize(('unit', 'torque'), [('N m', 4.0), ('A', 0.5 * 4.0), ('%', 0.25 * 4.0)])
def test_a_torque_in_the_unit_of_the_drive(unit, torque):
    motor = {'constant': 0.5, 'rated': 25.0, 'gear_ratio': 4.0}
    assert conversions.torque_unit(unit, **motor) == torque


@pytest.mark.parametrize(
    ('unit', 'hand', 'angle'),
    [('rad', 'left', -1.0), ('deg', 'right', math.pi / 180), ('rev', 'right', math.tau)]
    + [('m', 'left', math.tau / 0.01), ('mm', 'right', math.tau / 10.0)],
)
def test_a_position_is_an_angle_of_the_screw(unit, hand, angle):
    made = conversions.speed_scaling(unit, lead=0.01, handedness=hand, **PLAIN)
    assert made(1.0) == pytest.approx(angle, rel=1e-15)
    assert abs(made(1.0)) == pytest.approx(conversions.screw_turn(unit, lead=0.01), rel=1e-15)


@pytest.mark.parametrize(
    ('call', 'match'),
    [
        (lambda: speed('furlong/day', 1.0), 'speed_unit_furlong'),
        (lambda: speed('rad/s', 1.0, handedness='both'), 'handedness_both_unknown'),
        (lambda: conversions.load_scaling('lbf', **PLAIN), 'load_unit_lbf'),
        (lambda: conversions.temperature_scaling('degF', **PLAIN), 'temperature_unit_degf'),
        (lambda: conversions.torque_unit('N'), 'torque_unit_n'),
        (lambda: conversions.torque_unit('A'), 'torque_unit_needs'),
        (lambda: conversions.torque_unit('%'), 'torque_unit'),
    ],
)
def test_unknown_units_and_constants_that_are_not_stated_are_refused(call, match, refused):
    refused(match, call)


@pytest.mark.parametrize('force', [100.0, -100.0])
@pytest.mark.parametrize(('direction', 'sign'), [(POSITIVE, -1.0), (NEGATIVE, 1.0)])
def test_opposing_load_in_four_quadrants(force, direction, sign):
    assert conversions.opposing_load(force, direction) == sign * force
    assert conversions.opposing_load(sign * force, direction) == force


@given(force=finite, direction=st.sampled_from([POSITIVE, NEGATIVE]))
def test_the_power_that_an_opposing_load_takes_has_the_same_sign_in_both_frames(force, direction):
    motion = conversions.signed(1.0, direction)
    assert conversions.opposing_load(force, direction) == -motion * force


@pytest.mark.parametrize('direction', [POSITIVE, NEGATIVE])
def test_no_load_is_never_minus_zero(direction):
    assert math.copysign(1.0, conversions.opposing_load(0.0, direction)) == 1.0


@pytest.mark.parametrize(
    ('nut', 'force', 'expected'),
    [
        (1, 5.0, Nut.POSITIVE),
        (2, 5.0, Nut.NEGATIVE),
        (1, -5.0, Nut.NEGATIVE),
        (2, -5.0, Nut.POSITIVE),
        (1, 0.0, Nut.UNKNOWN),
        (0, 5.0, Nut.UNKNOWN),
        (1, math.nan, Nut.UNKNOWN),
    ],
)
def test_nut_that_the_load_presses(nut, force, expected):
    assert conversions.machine_nut(nut, force) is expected


@given(st.floats(min_value=1e-3, max_value=1e6))
def test_a_rounded_number_is_read_within_half_a_percent(value):
    """Whatever its size: the speed of an advice must still clear the warning."""
    assert float(conversions.rounded(value)) == pytest.approx(value, rel=0.005)
    assert conversions.rounded(-value) == f'-{conversions.rounded(value)}'


def test_direction_of():
    assert conversions.direction_of(1e-300) is POSITIVE
    assert conversions.direction_of(-1e-300) is NEGATIVE
    assert conversions.direction_of(0.0) is conversions.direction_of(math.nan) is Direction.UNKNOWN


@given(st.integers(min_value=0, max_value=2**33))
def test_milliseconds_survive_as_seconds(milliseconds):
    """Of 48 days, the nanosecond; beyond, a double of seconds holds it within one."""
    off = (
        conversions.nanoseconds(conversions.seconds(milliseconds * 1_000_000))
        - milliseconds * 1_000_000
    )
    assert abs(off) <= (milliseconds >= 1000 * 2**22)
