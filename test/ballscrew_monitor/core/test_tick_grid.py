# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Ticks on a grid of stamps, and how long a clock has stood, with both clocks handed in."""

from ballscrew_monitor.core.tick_grid import TickGrid

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
