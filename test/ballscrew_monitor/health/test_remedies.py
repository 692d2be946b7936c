# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Remedies for a programme outside its zone, verified by the surface itself."""

import copy
import dataclasses
import math

from ballscrew_monitor.core.judgement import Limits
from ballscrew_monitor.health.records import Cell
from ballscrew_monitor.health.remedies import AIMED, Programme, remedies_of, remedy_text
from hypothesis import given
from hypothesis import strategies as st
import pytest
from surrogate.surface import find_surface, Surface
from surrogate.units import MINUTE, TURN, ZERO_CELSIUS

SURFACE = Surface.load(find_surface('closed_form'))
LIMITS = Limits(
    rcs=0.01,
    efficiency=0.5,
    light_load=250.0,
    standstill_speed=0.1,
    raise_delay=0,
    clear_delay=0,
    hysteresis=0.1,
)


def point(speed, *, load=0.0, temperature=333.15, hours=1.0):
    """Return a cell."""
    return Cell(
        first_day=20_000,
        direction=1 if speed > 0 else -1,
        stretches=9,
        duration=hours * 3600.0,
        speed=speed,
        axial_load=load,
        temperature=temperature,
        motor_torque=0.1,
    )


def with_oil(**changes):
    """Return the surface with another statement of its oil; None leaves a key out."""
    other = copy.copy(SURFACE)
    inputs = SURFACE.header['inputs']
    oil = {key: one for key, one in (inputs['lubricant'] | changes).items() if one is not None}
    other.header = {**SURFACE.header, 'inputs': {**inputs, 'lubricant': oil}}
    return other


def border(temperature=333.15):
    """Return the speed at which RCS passes its limit without load [rad/s]."""
    low, high = 0.1, 200.0
    for _ in range(60):
        middle = math.sqrt(low * high)
        inside = SURFACE.lookup(middle, 0.0, temperature).rcs < LIMITS.rcs
        low, high = (low, middle) if inside else (middle, high)
    return high


def remedies(points, surface=SURFACE, **options):
    """Return the advice, and the remedies by kind."""
    kinds = remedies_of(Programme(surface, LIMITS, points), **options)
    return remedy_text(points, surface, LIMITS, **options), kinds


def test_a_programme_inside_needs_nothing():
    inside = [point(2 * border())]
    assert Programme(SURFACE, LIMITS, inside).share() == 1.0
    assert remedy_text(inside, SURFACE, LIMITS) == ''


def test_remedies_of_a_slow_programme(says):
    """A cooler or thicker oil; the feed only where the axis is free in it."""
    slow = point(-0.7 * border())
    advice, kinds = remedies([slow])
    programme = Programme(SURFACE, LIMITS, [slow])
    assert programme.share() == 0.0
    assert set(kinds) == {'temperature', 'grade'}
    cooler = kinds['temperature'] + ZERO_CELSIUS - slow.temperature
    assert cooler < 0
    assert programme.share(warmer=cooler) >= AIMED > programme.share(warmer=cooler + 1.0)
    assert kinds['grade'] == 100.0
    assert advice == says('slow')
    free, kinds = remedies([slow], speed_allowed=True)
    speed = kinds['feed'] / MINUTE * TURN / SURFACE.lead
    assert speed == pytest.approx(border(), rel=0.05)
    assert programme.share(slowest=speed) == 1.0
    assert free == says('slow_and_free', feed=f'{kinds["feed"]:.3g}')


def test_a_starved_film():
    """Half of the film is that of 0.36 of the speed."""
    grease = with_oil(film_factor=0.5)
    helped, not_helped = (remedies([point(share * border())], grease) for share in (0.4, 0.3))
    assert helped[1]['film factor'] == 1.0
    assert 'film factor' not in not_helped[1]


def test_what_no_remedy_reaches():
    """Far below the border neither oil nor film helps; no grade where the oil is not stated."""
    _, kinds = remedies([point(0.06)], with_oil(kinematic_viscosity_40=None), speed_allowed=True)
    assert set(kinds) <= {'feed'}
    assert remedies([point(0.06)]) == ('', {})


def test_points_that_the_surface_does_not_know():
    """Less than half of the time known is not known."""
    for points in ([], [point(1e6)], [point(1e6, hours=2.0), point(50.0)]):
        assert math.isnan(Programme(SURFACE, LIMITS, points).share())
        assert remedy_text(points, SURFACE, LIMITS) == ''


@given(st.lists(st.tuples(st.floats(0.1, 200.0), st.floats(-2e3, 2e3)), min_size=1, max_size=5))
def test_each_remedy_does_what_it_says(places):
    """Asked again, most of the programme is inside with the remedy."""
    points = [point(speed, load=load) for speed, load in places]
    strict = dataclasses.replace(LIMITS, efficiency=0.9)
    programme = Programme(SURFACE, strict, points)
    remedies = remedies_of(programme)
    if 'temperature' in remedies:
        shift = remedies['temperature'] + ZERO_CELSIUS - programme.temperature
        assert programme.share(warmer=shift) >= AIMED
