# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The slope over a ring: that of its plain twin, interpreted and compiled."""

import math

from ballscrew_monitor.core.conversions import SECOND
from ballscrew_monitor.judge.slopes import (
    MOST,
    slope_change,
    slope_of,
    slope_restart,
    slope_shift,
    slope_take,
    SlopeRing,
)
from hypothesis import given, settings
from hypothesis import strategies as st
import numpy as np
from plain_slope import SlopeFilter
import pytest
from surrogate.surface.compiled import compiled
from surrogate.surface.records import as_array

WINDOW, GAP, START = SECOND // 10, SECOND // 2, 1_767_600_000 * SECOND
STEPS = st.sampled_from([0, 1, 500_000, 10**6, 10**7, 5 * 10**7, GAP, GAP + 1, -1, -(10**9)])
VALUES = st.floats(-300.0, 300.0)
SAMPLES = st.lists(st.tuples(STEPS, VALUES), min_size=1, max_size=60)


def stamped(steps):
    """Return stamps and values."""
    stamp, made = START, []
    for step, value in steps:
        stamp += step
        made.append((stamp, value))
    return made


def assert_same(ring, kept, scale):
    """Hold ring and filter against each other; `scale` is the size of the values."""
    samples = list(kept._samples)
    assert ring.count == len(samples)
    places = [(ring.begin + place) % MOST for place in range(ring.count)]
    assert [(ring.stamps[at], ring.values[at]) for at in places] == samples
    span = max(samples[-1][0] - samples[0][0], 1) / SECOND
    tolerance = {'rel': 1e-12, 'abs': 1e-12 * scale / span, 'nan_ok': True}
    assert slope_of(ring) == pytest.approx(kept.slope, **tolerance)
    quarter = (
        4e-12 * scale / min(span, (samples[-1][0] - samples[-2][0]) / SECOND, 1.0)
        if (len(samples) > 1)
        else 0.0
    )
    assert slope_change(ring, WINDOW) == pytest.approx(
        kept.change, rel=1e-12, abs=quarter, nan_ok=True
    )


@given(SAMPLES, st.floats(-10.0, 10.0))
def test_it_is_the_filter_of_the_twin(steps, amount):
    ring, kept = SlopeRing(), SlopeFilter(window=WINDOW, max_gap=GAP)
    for stamp, value in stamped(steps):
        slope_take(ring, WINDOW, GAP, stamp, value)
        kept.take(stamp, value)
        assert_same(ring, kept, 600.0)
    slope_shift(ring, amount)
    kept.shift(amount)
    assert_same(ring, kept, 600.0)
    slope_restart(ring, START, amount)
    kept.restart(START, amount)
    assert_same(ring, kept, 600.0)


def test_a_fast_source_goes_round_the_ring():
    ring, kept = SlopeRing(), SlopeFilter(window=WINDOW, max_gap=GAP)
    for number in range(3 * MOST + 7):
        stamp, value = START + number * 50_000, math.sin(0.01 * number)
        slope_take(ring, WINDOW, GAP, stamp, value)
        kept.take(stamp, value)
    assert ring.count == MOST
    assert_same(ring, kept, 1.0)


@given(st.floats(-1e3, 1e3), st.integers(2, 40))
def test_a_ramp_has_its_slope_and_does_not_change(slope, count):
    ring = SlopeRing()
    for number in range(count):
        slope_take(ring, WINDOW, GAP, START + number * 10**6, slope * number * 1e-3)
    assert slope_of(ring) == pytest.approx(slope, rel=1e-12, abs=1e-12)
    assert slope_change(ring, WINDOW) == pytest.approx(0.0, abs=1e-9 * abs(slope) + 1e-12)


def test_without_two_samples_there_is_no_slope():
    ring = SlopeRing()
    assert math.isnan(slope_of(ring))
    assert math.isnan(slope_change(ring, WINDOW))
    slope_take(ring, WINDOW, GAP, START, 1.0)
    assert math.isnan(slope_of(ring))
    slope_take(ring, WINDOW, GAP, START + 10**6, 1e308)
    slope_take(ring, WINDOW, GAP, START + 2 * 10**6, -1e308)
    assert math.isnan(slope_of(ring))


@settings(max_examples=100)
@given(SAMPLES)
def test_compiled_it_has_the_same_bits(steps):
    pytest.importorskip('numba')
    take, slope, change = COMPILED
    ring, array = SlopeRing(), as_array(SlopeRing())
    for stamp, value in stamped(steps):
        slope_take(ring, WINDOW, GAP, stamp, value)
        take(array[0], WINDOW, GAP, stamp, value)
        for ours, theirs in (
            (slope_of(ring), slope(array[0])),
            (slope_change(ring, WINDOW), change(array[0], WINDOW)),
        ):
            np.testing.assert_array_equal(ours, theirs)


COMPILED = [compiled(each) for each in (slope_take, slope_of, slope_change)]
