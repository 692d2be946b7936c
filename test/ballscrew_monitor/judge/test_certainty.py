# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Certainty of a point outside: beyond both bands, within them, or on a file without bands."""

import copy
import math

from ballscrew_monitor.core.judgement import Zone
from ballscrew_monitor.judge.certainty import least_factor, Outside, outside_of
import pytest
from surrogate.surface import shipped_surface, Surface

SURFACE = Surface.load(shipped_surface())
LOAD, WARM = 1000.0, 313.15
BARE = copy.copy(SURFACE)
BARE.header = {**SURFACE.header, 'numerical_band': (math.nan, math.nan)}


@pytest.fixture(scope='module')
def limit():
    """Return the speed [rad/s] at which RCS is at its limit, by bisection."""
    low, high = SURFACE.speed_range
    for _ in range(60):
        middle = math.sqrt(low * high)
        above = SURFACE.lookup(middle, LOAD, WARM).rcs >= 0.01
        low, high = (middle, high) if above else (low, middle)
    return high


def certainty(speed, *, zone=Zone.OUTSIDE, surface=SURFACE, efficiency=0.9):
    return outside_of(
        zone,
        surface,
        rcs_limit=0.01,
        efficiency_limit=0.85,
        speed=speed,
        load=LOAD,
        temperature=WARM,
        efficiency=efficiency,
    )


@pytest.mark.parametrize(
    ('share', 'changes', 'expected'),
    [
        (0.99, {}, Outside.SURELY),
        (1.01, {}, Outside.PERHAPS),
        (1.01, {'efficiency': 0.84}, Outside.SURELY),
        (1.01, {'efficiency': math.nan}, Outside.PERHAPS),
        (0.5, {'zone': Zone.OPTIMAL}, Outside.NOT),
        (0.5, {'zone': Zone.UNKNOWN}, Outside.UNKNOWN),
        (0.5, {'surface': BARE}, Outside.UNBANDED),
        (0.5, {'surface': BARE, 'efficiency': 0.5}, Outside.SURELY),
    ],
)
def test_a_point_is_surely_outside_where_it_is_wherever_the_limit_lies(
    limit, share, changes, expected
):
    """`share` of the least speed at which the limit may lie."""
    factor = least_factor(SURFACE)
    assert factor < min(*SURFACE.limit_band, *SURFACE.numerical_band)
    assert certainty(share * factor * limit, **changes) is expected
