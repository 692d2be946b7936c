# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The time surely outside: of rows beyond both bands of the limit, and of a low efficiency."""

import copy
import math

from ballscrew_monitor.core.conversions import Direction
from ballscrew_monitor.core.judgement import Limits, Zone
from ballscrew_monitor.judge.records import LIGHT_LOAD
from ballscrew_monitor.report.certainty import SureTime
import numpy as np
import pytest
from surrogate.surface import shipped_surface, Surface

SURFACE = Surface.load(shipped_surface())
LEAST = SURFACE.onset_band[0]
PERIOD, GAP = 10_000_000, 50_000_000  # [ns]
LIMITS = Limits(
    rcs=0.01,
    efficiency=0.5,
    light_load=1.0,
    standstill_speed=0.1,
    raise_delay=0,
    clear_delay=0,
    hysteresis=0.1,
)


def seconds(rows, surface=SURFACE, *, parts=1):
    """Return the time surely outside of rows that come in parts."""
    sure = SureTime(surface, LIMITS, max_gap=GAP)
    for some in np.array_split(rows, parts):
        sure.add(some)
    return sure.seconds


@pytest.fixture
def outside(judged):
    """Return a function that gives 101 rows outside, a second, at a share of the limit's speed."""
    low, high = SURFACE.speed_range
    for _ in range(60):
        middle = math.sqrt(low * high)
        above = SURFACE.lookup(middle, 1000.0, 313.15).rcs >= LIMITS.rcs
        low, high = (middle, high) if above else (low, middle)

    def rows(share, **changes):
        values = {
            'speed': -share * high,
            'axial_load': 1000.0,
            'direction': Direction.NEGATIVE,
            'zone': Zone.OUTSIDE,
            'rcs': 0.02,
        }
        return judged.rows(0, 101, **values | changes).rows

    return rows


@pytest.mark.parametrize('parts', [1, 7])
@pytest.mark.parametrize(
    ('share', 'sure'), [(0.98 * LEAST, 1.0), (1.02 * LEAST, 0.0), (0.98, 0.0)]
)
def test_slower_than_both_bands_is_sure(outside, share, sure, parts):
    assert seconds(outside(share), parts=parts) == pytest.approx(sure)


def test_too_low_an_efficiency_is_sure_where_it_is_judged(outside):
    assert seconds(outside(0.98, efficiency=0.4)) == pytest.approx(1.0)
    assert seconds(outside(0.98, efficiency=0.4, gates=LIGHT_LOAD)) == 0.0


def test_neither_rows_inside_nor_gaps_count(outside):
    assert seconds(outside(0.5 * LEAST, zone=Zone.OPTIMAL)) == 0.0
    rows = outside(0.5 * LEAST)
    rows['stamp'][50:] += GAP
    assert seconds(rows) == pytest.approx(0.99)


def test_a_surface_without_its_bands_does_not_tell(outside):
    surface = copy.copy(SURFACE)
    surface.header = {**SURFACE.header, 'limit_band': (math.nan, math.nan)}
    assert math.isnan(seconds(outside(0.1), surface))
