# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Remedies for a programme outside its zone, verified by the surface itself."""

import copy
import dataclasses
import math

from ballscrew_monitor.core.judgement import Limits
from ballscrew_monitor.health.records import Cell
from ballscrew_monitor.health.remedies import AIMED, Programme, remedies_of
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


def found(points, surface=SURFACE, **options):
    """Return the remedies and those by kind."""
    advice = remedies_of(points, surface, LIMITS, **options)
    return advice, {one.kind: one for one in advice.remedies}


def test_a_programme_inside_needs_nothing():
    advice, kinds = found([point(2 * border())])
    assert advice.share == 1.0
    assert (advice.text, kinds) == ('', {})


def test_remedies_of_a_slow_programme(says):
    """A cooler or thicker oil; the feed only where the axis is free in it."""
    slow = point(-0.7 * border())
    advice, kinds = found([slow])
    assert advice.share == 0.0
    assert set(kinds) == {'temperature', 'grade', 'film factor'}
    programme = Programme(SURFACE, LIMITS, [slow])
    cooler = kinds['temperature'].value + ZERO_CELSIUS - slow.temperature
    assert cooler < 0
    assert programme.share(warmer=cooler) >= AIMED > programme.share(warmer=cooler + 1.0)
    assert kinds['grade'].value == 100.0
    assert kinds['film factor'].reason == says('plenty')
    assert advice.text == says('slow')
    free, kinds = found([slow], speed_allowed=True)
    speed = kinds['feed'].value / MINUTE * TURN / SURFACE.lead
    assert speed == pytest.approx(border(), rel=0.05)
    assert programme.share(slowest=speed) == 1.0
    assert free.text == says('slow_and_free', feed=f'{kinds["feed"].value:.3g}')


def test_a_starved_film(says):
    """Half of the film is that of 0.36 of the speed."""
    grease = with_oil(film_factor=0.5)
    helped, not_helped = (found([point(share * border())], grease) for share in (0.4, 0.3))
    assert helped[1]['film factor'].value == 1.0
    assert not_helped[1]['film factor'].reason == says('plenty_would_not')


def test_what_no_remedy_reaches(says):
    """Far below the border nothing helps, and the advice is empty."""
    advice, kinds = found([point(0.06)], with_oil(kinematic_viscosity_40=None), speed_allowed=True)
    assert kinds['temperature'].reason == says('no_temperature')
    assert kinds['grade'].reason == says('no_oil')
    assert 'feed' in kinds
    assert all(math.isnan(kinds[one].value) for one in ('temperature', 'grade', 'film factor'))
    _, kinds = found([point(0.06)])
    assert kinds['grade'].reason == says('no_grade')
    assert remedies_of([point(0.06)], SURFACE, LIMITS).text == ''


def test_points_that_the_surface_does_not_know():
    """Less than half of the time known is not known."""
    for points in ([], [point(1e6)], [point(1e6, hours=2.0), point(50.0)]):
        advice, _ = found(points)
        assert math.isnan(advice.share)
        assert advice.text == ''


@given(st.lists(st.tuples(st.floats(0.1, 200.0), st.floats(-2e3, 2e3)), min_size=1, max_size=5))
def test_each_remedy_does_what_it_says(places):
    """Asked again, the share inside is that of the remedy."""
    points = [point(speed, load=load) for speed, load in places]
    strict = dataclasses.replace(LIMITS, efficiency=0.9)
    programme = Programme(SURFACE, strict, points)
    for one in remedies_of(points, SURFACE, strict).remedies:
        assert math.isnan(one.value) == bool(one.reason)
        if one.kind == 'temperature' and not one.reason:
            shift = one.value + ZERO_CELSIUS - programme.temperature
            assert programme.share(warmer=shift) == one.share >= AIMED
