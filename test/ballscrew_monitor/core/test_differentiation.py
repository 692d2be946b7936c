# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Slopes of ramps and sines in closed form, and speeds from positions."""

import cmath
import math

from ballscrew_monitor.core.conversions import SECOND
from ballscrew_monitor.core.inputs import InputSample, Refusal, Source, StampSource, Why
from hypothesis import given
from hypothesis import strategies as st
from plain_slope import MOST, PositionSettings, SlopeFilter, SpeedFromPosition
import pytest

START = 1_700_000_000 * SECOND
WINDOW, TIMEOUT, STEP = SECOND // 20, SECOND // 2, SECOND // 1000
TURN = 2.0 * math.pi
MOST_SPEED = 300.0  # [rad/s]


def slopes(samples, window=WINDOW):
    """Return the slope after each sample."""
    made, found = SlopeFilter(window=window, max_gap=TIMEOUT), []
    for stamp, value in samples:
        made.take(stamp, value)
        found.append(made.slope)
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
    omega = turn / (WINDOW / SECOND)
    times = [i * STEP // 10 for i in range(3000)]  # up to MOST samples in a window
    samples = [(START + time, math.sin(omega * time / SECOND)) for time in times]
    u = 0.5 * turn
    gain = 3.0 * (math.sin(u) - u * math.cos(u)) / u**3
    expected = [
        omega * gain * math.cos(omega * (time - WINDOW / 2) / SECOND) for time in times[600:]
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
    """Return how the slope changes after each sample."""
    made, found = SlopeFilter(window=WINDOW, max_gap=TIMEOUT), []
    for i, value in enumerate(values):
        made.take(START + i * step, value)
        found.append(made.change)
    return found


def test_a_ramp_does_not_change():
    found = changes([3.0 * i for i in range(100)])
    assert math.isnan(found[0])
    assert found[1:] == pytest.approx([0.0] * 99, abs=1e-9)


def test_a_slope_that_sets_in_shows_until_the_window_knows_it():
    sets_in = 60
    values = [max(i - sets_in, 0) * STEP / SECOND for i in range(200)]
    found = changes(values)
    assert found[sets_in] == 0.0
    after = sets_in + 13  # samples of a quarter of the window
    slope = slopes([(START + i * STEP, value) for i, value in enumerate(values)])[after]
    assert found[after] == pytest.approx(1.0 - slope, rel=1e-9)
    assert found[-1] == pytest.approx(0.0, abs=1e-9)


def test_the_change_of_few_samples_is_that_of_the_last_two():
    found = changes([0.0, 0.0, 0.0, 1.0], step=WINDOW // 3)[-1]
    assert found == pytest.approx(60.0 - 0.3 * 60.0)


def test_sources_slower_than_the_window_give_the_last_difference():
    assert slopes([(START, 0.0), (START + 2 * WINDOW, 1.0)])[-1] == pytest.approx(10.0)


@pytest.mark.parametrize('jump', [-1, -SECOND, TIMEOUT + 1])
def test_a_step_back_and_a_hole_begin_anew(jump):
    found = slopes([(START, 0.0), (START + STEP, 1.0), (START + STEP + jump, 9.0)])
    assert math.isnan(found[-1])


def test_an_equal_stamp_replaces_the_last_sample():
    again = [(START, 0.0), (START + STEP, 5.0), (START + STEP, 1.0)]
    assert slopes(again)[-1] == pytest.approx(1000.0)


def test_a_fast_source_fills_no_more_memory():
    found = slopes([(START + i, float(i)) for i in range(3 * MOST)], window=SECOND)
    assert found[-1] == pytest.approx(SECOND, rel=1e-9)


def position(value, stamp, stamp_source=StampSource.HEADER):
    return InputSample(source=Source.SPEED, value=value, stamp=stamp, stamp_source=stamp_source)


def speeds(values, *, wrap=0.0, step=STEP, stamp_source=StampSource.HEADER):
    """Return what comes of positions, `step` [ns] apart."""
    made = SpeedFromPosition(PositionSettings(window=WINDOW, wrap=wrap), max_gap=TIMEOUT)
    return [
        made.take(position(value, START + i * step, stamp_source), most=MOST_SPEED)
        for i, value in enumerate(values)
    ]


@pytest.mark.parametrize('speed', [-200.0, 0.0, 50.0])
@pytest.mark.parametrize('offset', [0.0, -7.0, 1e6])
def test_a_constant_velocity_is_exact_through_every_wrap(speed, offset):
    turned = [speed * i * STEP / SECOND for i in range(500)]
    plain = speeds([offset + angle for angle in turned])
    wrapped = speeds([(offset + angle) % TURN for angle in turned], wrap=TURN)
    assert plain[0] is wrapped[0] is None
    for found in (*plain[1:], *wrapped[1:]):
        assert found.value == pytest.approx(speed, abs=1e-6)
    assert found.stamp == START + 499 * STEP


def test_a_wrap_that_is_not_stated_is_refused_with_its_cure():
    found = speeds([6.2, 6.28, 0.08, 0.16, 0.24])
    assert [type(one) for one in found[2:]] == [Refusal, InputSample, InputSample]
    assert found[2].why is Why.IMPLAUSIBLE
    assert found[2].text == (
        'the position jumps by 6.2 rad of the screw within 0.001 s, plausible is a speed of '
        '300 rad/s: mend the source, or set speed.wrap to the position at which it begins anew'
    )
    assert found[4].value == pytest.approx(80.0)


def test_a_glitch_of_one_position_leaves_no_trace():
    found = speeds([0.0, 0.01, 1e6, 0.03, 0.04, 0.05])
    assert [isinstance(one, Refusal) for one in found] == [False, False, True, True, False, False]
    assert [one.value for one in found[4:]] == pytest.approx([10.0, 10.0])


def test_a_position_after_a_hole_gives_no_speed():
    first, second, third = speeds([0.0, 1.0, 2.0], step=TIMEOUT + 1)
    assert first is None
    for refusal in (second, third):
        assert refusal.why is Why.HOLE
        assert refusal.text == (
            'no position for 0.5 s, so no speed follows: send more, or raise speed.timeout'
        )


def test_a_burst_of_unstamped_positions_is_no_jump():
    burst = [0.0, 1.0, 2.0]
    assert isinstance(speeds(burst, step=1000)[1], Refusal)
    received = speeds(burst, step=1000, stamp_source=StampSource.RECEIVE)
    assert not any(isinstance(one, Refusal) for one in received)
