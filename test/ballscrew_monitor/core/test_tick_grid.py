# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Ticks on a grid of stamps, and how long a clock has stood, with both clocks handed in."""

from ballscrew_monitor.core.tick_grid import ClockSteps, LEAST_STEP, TickGrid
import pytest

PERIOD = 100
HOUR = 3600 * 10**9


def test_each_stamp_of_the_grid_is_given_once_on_a_clock_that_jumps_or_stands():
    ticks = TickGrid(PERIOD)
    given = [ticks.tick(now) for now in (1050, 1099, 1100, 1101, 1350)]
    assert given == [1000, None, 1100, None, 1300]
    ticks = TickGrid(PERIOD)
    begin = 2 * HOUR
    assert ticks.tick(begin) == begin
    expected = [begin - HOUR + 100, begin - HOUR + 200]
    assert [ticks.tick(begin - HOUR + step) for step in (100, 200)] == expected
    ticks = TickGrid(PERIOD)
    assert [ticks.stood(now, steady) for now, steady in ((0, 50), (0, 70), (1, 80), (1, 95))] == [
        0,
        20,
        0,
        15,
    ]
    assert ticks.stood(0, 200) == 0


@pytest.mark.parametrize('step', [HOUR, -HOUR, LEAST_STEP + 1, -LEAST_STEP - 1])
def test_a_step_of_a_clock_is_told_once_and_exactly(step):
    steps = ClockSteps()
    assert steps.take(5 * HOUR, 100, 100) == 0
    assert steps.take(5 * HOUR + 50, 150, 150) == 0
    assert steps.take(5 * HOUR + 80 + step, 180, 180) == step
    assert steps.take(5 * HOUR + 90 + step, 190, 190) == 0


@pytest.mark.parametrize('step', [0, LEAST_STEP, -LEAST_STEP])
def test_a_slow_look_and_a_clock_that_is_slewed_are_no_step(step):
    """The process may stand still for long between the looks at both clocks, and within one."""
    steps = ClockSteps()
    steps.take(5 * HOUR, 0, 0)
    assert steps.take(6 * HOUR + step, HOUR, HOUR) == 0
    assert steps.take(7 * HOUR + step, HOUR + 1, 3 * HOUR) == 0
    assert steps.take(8 * HOUR + step, 3 * HOUR, 3 * HOUR) == 0
