# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Ticks on a grid of stamps, with both clocks handed in."""

from ballscrew_monitor.core.pulse import Pulse
import pytest

PERIOD = 100
HOUR = 3600 * 10**9


def test_each_stamp_of_the_grid_is_given_once():
    pulse = Pulse(PERIOD)
    given = [pulse.tick(now, now) for now in (1050, 1099, 1100, 1101, 1350)]
    assert given == [1000, None, 1100, None, 1300]


def test_a_clock_that_is_set_back_is_ticked_on_at_once():
    pulse = Pulse(PERIOD)
    begin = 2 * HOUR
    assert pulse.tick(begin, 0) == begin
    assert [pulse.tick(begin - HOUR + step, step) for step in (100, 200)] == [
        begin - HOUR + 100,
        begin - HOUR + 200,
    ]


def test_after_a_long_callback_ticks_wait_until_the_queues_are_empty():
    pulse = Pulse(PERIOD)
    assert pulse.tick(1000, 0) == 1000
    pulse.be_busy(0, 500)
    assert pulse.tick(1500, 500) is None  # comes before the first message
    pulse.take_input()
    assert pulse.tick(1600, 600) is None
    assert pulse.tick(1700, 700) == 1700  # nothing was left


def test_an_input_that_never_ends_does_not_silence_the_ticks():
    pulse = Pulse(PERIOD)
    pulse.be_busy(0, 500)
    ticks = []
    for steady in range(500, 1300, PERIOD):
        pulse.take_input()
        ticks.append(pulse.tick(1000 + steady, steady))
    assert ticks == [None] * 5 + [2000, 2100, 2200]


@pytest.mark.parametrize('length', [0, PERIOD])
def test_a_short_callback_delays_nothing(length):
    pulse = Pulse(PERIOD)
    pulse.be_busy(0, length)
    pulse.take_input()
    assert pulse.tick(1000, length) == 1000


def test_for_how_long_the_clock_has_stood():
    pulse = Pulse(PERIOD)
    assert [pulse.stood(now, steady) for now, steady in ((0, 50), (0, 70), (1, 80), (1, 95))] == [
        0,
        20,
        0,
        15,
    ]
    assert pulse.stood(0, 200) == 0
