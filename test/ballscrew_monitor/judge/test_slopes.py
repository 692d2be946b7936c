# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The slope over a ring: closed forms and normal equations, and compiled."""

import cmath
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
from hypothesis import given
from hypothesis import strategies as st
import numpy as np
import pytest
from surrogate.surface.compiled import compiled
from surrogate.surface.records import as_array

WINDOW, GAP, START = SECOND // 10, SECOND // 2, 1_767_600_000 * SECOND
SHORT, STEP = SECOND // 20, SECOND // 1000
STEPS = st.sampled_from([0, 1, 500_000, 10**6, 10**7, 5 * 10**7, GAP, GAP + 1, -1, -(10**9)])
VALUES = st.floats(-300.0, 300.0)
SAMPLES = st.lists(st.tuples(STEPS, VALUES), min_size=1, max_size=60)


def stamped(steps):
    stamp, made = START, []
    for step, value in steps:
        stamp += step
        made.append((stamp, value))
    return made


def counting(samples):
    """Return the samples of the last run that a slope counts, the two newest at least."""
    run = []
    for stamp, value in samples:
        if run and stamp == run[-1][0]:
            run.pop()
        elif run and not 0 < stamp - run[-1][0] <= GAP:
            run = []
        run.append((stamp, value))
    within = [sample for sample in run if run[-1][0] - sample[0] <= WINDOW]
    return (within if len(within) > 1 else run[-2:])[-MOST:]


def least_squares(samples):
    """Return the slope of the normal equations [1/s] by exact sums, NaN with one sample."""
    times = [(stamp - samples[-1][0]) / SECOND for stamp, _ in samples]
    arms = [time - math.fsum(times) / len(times) for time in times]
    moment = math.fsum(arm * value for arm, (_, value) in zip(arms, samples))
    return moment / math.fsum(arm * arm for arm in arms) if len(samples) > 1 else math.nan


def assert_line(ring, samples, scale):
    """Hold a ring against the normal equations; `scale` is the size of the values."""
    kept = counting(samples)
    newest = [sample for sample in kept if kept[-1][0] - sample[0] <= WINDOW // 4]
    newest = newest if len(newest) > 1 else kept[-2:]
    assert ring.count == len(kept)
    slope = least_squares(kept)
    span = max(newest[-1][0] - newest[0][0], 1) / SECOND
    tolerance = {'rel': 1e-12, 'abs': 4e-12 * scale / min(span, 1.0), 'nan_ok': True}
    assert slope_of(ring) == pytest.approx(slope, **tolerance)
    expected = abs(least_squares(newest) - slope)
    assert slope_change(ring, WINDOW) == pytest.approx(expected, **tolerance)


@given(SAMPLES, st.floats(-10.0, 10.0))
def test_it_is_the_least_squares_line_wherever_the_values_lie(steps, amount):
    ring, samples = SlopeRing(), stamped(steps)
    for place, (stamp, value) in enumerate(samples, start=1):
        slope_take(ring, WINDOW, GAP, stamp, value)
        assert_line(ring, samples[:place], 600.0)
    slope_shift(ring, amount)
    assert_line(ring, samples, 600.0)
    newest = (ring.begin + ring.count - 1) % MOST
    assert ring.values[newest] == samples[-1][1] + amount
    slope_restart(ring, START, amount)
    assert_line(ring, [(START, amount)], 600.0)


def test_a_fast_source_goes_round_the_ring_and_one_sample_has_no_slope():
    ring = SlopeRing()
    samples = [(START + i * 50_000, math.sin(0.01 * i)) for i in range(3 * MOST + 7)]
    for stamp, value in samples:
        slope_take(ring, WINDOW, GAP, stamp, value)
    assert ring.count == MOST
    assert_line(ring, samples, 1.0)
    ring = SlopeRing()
    assert math.isnan(slope_of(ring))
    assert math.isnan(slope_change(ring, WINDOW))
    slope_take(ring, WINDOW, GAP, START, 1.0)
    assert math.isnan(slope_of(ring))
    slope_take(ring, WINDOW, GAP, START + 10**6, 1e308)
    slope_take(ring, WINDOW, GAP, START + 2 * 10**6, -1e308)
    assert math.isnan(slope_of(ring))


@pytest.mark.parametrize('sign', [1.0, -1.0])
def test_the_largest_difference_still_has_a_slope(sign):
    for largest, slope in ((1e300, sign * 1e303), (math.nextafter(1e300, math.inf), math.nan)):
        ring = SlopeRing()
        slope_take(ring, WINDOW, GAP, START, 0.0)
        slope_take(ring, WINDOW, GAP, START + 10**6, sign * largest)
        assert slope_of(ring) == pytest.approx(slope, nan_ok=True)


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


def slopes(samples, window=SHORT, of=slope_of):
    ring, found = SlopeRing(), []
    for stamp, value in samples:
        slope_take(ring, window, GAP, stamp, value)
        found.append(of(ring))
    return found


@given(
    st.floats(-1e3, 1e3),
    st.floats(-1e3, 1e3),
    st.lists(st.integers(1, SECOND // 50), min_size=1, max_size=60),
)
def test_a_ramp_is_exact_however_it_is_sampled(slope, offset, gaps):
    stamps = [START + sum(gaps[:i]) for i in range(len(gaps) + 1)]
    ramp = [(stamp, offset + slope * (stamp - START) / SECOND) for stamp in stamps]
    found = slopes(ramp)
    assert math.isnan(found[0])
    # Rounding of the values over the time between the first two of them.
    rounding = 4e-16 * (abs(offset) + abs(slope)) * SECOND / min(gaps)
    assert found[1:] == pytest.approx([slope] * len(gaps), rel=1e-9, abs=1e-9 + 4 * rounding)


@pytest.mark.parametrize('turn', [0.5, 2.0, 4.0])
def test_a_sine_is_late_by_half_a_window_and_smaller_as_stated(turn):
    omega = turn / (SHORT / SECOND)
    times = [i * STEP // 10 for i in range(3000)]  # up to MOST samples in a window
    samples = [(START + time, math.sin(omega * time / SECOND)) for time in times]
    u = 0.5 * turn
    gain = 3.0 * (math.sin(u) - u * math.cos(u)) / u**3
    expected = [
        omega * gain * math.cos(omega * (time - SHORT / 2) / SECOND) for time in times[600:]
    ]
    assert slopes(samples)[600:] == pytest.approx(expected, abs=1e-2 * omega * gain)


@given(st.integers(3, 60), st.floats(1.0, 60.0))
def test_the_response_of_few_samples_is_the_least_squares_line(count, omega):
    """Against the normal equations of the samples in the window, as phasors."""
    window = (count - 1) * STEP
    times = [i * STEP / SECOND for i in range(-(count - 1), 1)]
    arms = [time - sum(times) / count for time in times]
    response = sum(arm * cmath.exp(1j * omega * time) for arm, time in zip(arms, times))
    response /= sum(arm * arm for arm in arms)
    wave = [
        (START + i * STEP, cmath.exp(1j * omega * i * STEP / SECOND)) for i in range(2 * count)
    ]
    found = slopes([(stamp, value.real) for stamp, value in wave], window)[-1]
    assert found == pytest.approx((response * wave[-1][1]).real, rel=1e-6, abs=1e-6 * omega)


def changes(values, step=STEP):
    samples = [(START + i * step, value) for i, value in enumerate(values)]
    return slopes(samples, of=lambda ring: slope_change(ring, SHORT))


def test_a_ramp_does_not_change_and_few_samples_do_as_the_last_two():
    found = changes([3.0 * i for i in range(100)])
    assert math.isnan(found[0])
    assert found[1:] == pytest.approx([0.0] * 99, abs=1e-9)
    found = changes([0.0, 0.0, 0.0, 1.0], step=SHORT // 3)[-1]
    assert found == pytest.approx(60.0 - 0.3 * 60.0)


def test_a_slope_that_sets_in_shows_until_the_window_knows_it():
    sets_in = 60
    values = [max(i - sets_in, 0) * STEP / SECOND for i in range(200)]
    found = changes(values)
    assert found[sets_in] == 0.0
    after = sets_in + 13  # samples of a quarter of the window
    slope = slopes([(START + i * STEP, value) for i, value in enumerate(values)])[after]
    assert found[after] == pytest.approx(1.0 - slope, rel=1e-9)
    assert found[-1] == pytest.approx(0.0, abs=1e-9)
