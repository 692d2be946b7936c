# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Rates and units estimated from the numbers of a log."""

from ballscrew_monitor.recordings.tables.estimates import (
    DAY,
    is_rising,
    Midnights,
    period,
    position_unit,
    speed_unit,
    time_unit,
)
from hypothesis import given
from hypothesis import strategies as st
import numpy as np
import pytest


def test_the_axis_that_moves_decides_on_the_period():
    time = np.arange(400) * 0.1
    speed = 0.05 * np.sin(time)
    moved = np.concatenate([[0.0], np.cumsum((speed[1:] + speed[:-1]) / 2 * 0.1)])
    noise = np.random.default_rng(1).normal(size=(2, 400))
    still = (1e-4 * noise[0], 1e-4 * noise[1])
    assert period([still, (moved, speed)]) == pytest.approx(0.1, rel=0.01)
    assert np.isnan(period([]))
    assert np.isnan(period([(np.zeros(9), np.zeros(9))]))


@pytest.mark.parametrize(
    ('largest', 'unit'), [(2.0, 'm/s'), (2.1, 'mm/s'), (2000.0, 'mm/s'), (2001.0, 'mm/min')]
)
def test_the_largest_speed_tells_the_unit_where_nothing_else_does(largest, unit):
    speed = np.array([0.0, -largest, np.nan])
    assert speed_unit(speed, None, 0.1)[0] == unit


def test_the_largest_place_tells_the_unit():
    assert position_unit(np.array([0.0, 2.0]))[0] == 'm'
    assert position_unit(np.array([0.0, -2.1]))[0] == 'mm'


@pytest.mark.parametrize(
    ('begin', 'step', 'expected'),
    [
        (1.7e9, 0.01, 's'),
        (1.7e12, 10.0, 'ms'),
        (1.7e15, 1e4, 'us'),
        (1.7e18, 1e7, 'ns'),
        (0.0, 0.01, ''),
        (0.0, 0.5, ''),
        (0.0, 1e-7, ''),
        (45852.5, 1.0 / 86400, ''),
        (5.0, 10.0, ''),
        (0.0, 1.0, ''),
        (0.0, 0.0, ''),
        (0.0, 2.5, ''),
        (1.7e9, 10.0, ''),
        (1.34e17, 2e5, ''),
        (6.4e17, 2e5, ''),
    ],
)
def test_size_and_step_tell_the_unit_of_times_or_nothing_does(begin, step, expected):
    """
    Times since 1970 alone; others, with decimals or without, may be of any unit.

    The last are ticks of 100 ns since 1601 and since the year 1.

    """
    assert time_unit(begin + step * np.arange(10.0)) == expected


def test_times_rise_but_for_a_few():
    rising = np.arange(50.0)
    assert is_rising(rising)
    rising[20] = 3.0
    assert is_rising(rising)
    assert not is_rising(np.zeros(50))
    assert not is_rising(np.sin(np.arange(50.0)))


@given(
    st.floats(0.0, DAY - 1.0),
    st.lists(st.floats(-5.0, 0.49 * DAY), min_size=1, max_size=40),
    st.integers(1, 41),
)
def test_times_of_a_day_go_on_through_midnight_in_blocks_of_any_size(begin, steps, block):
    """Rows that come a little late after midnight are of the day before it."""
    true = np.maximum(np.cumsum([begin, *steps]), 0.0)
    told, midnights = true % DAY, Midnights()
    parts = np.split(told, range(block, len(told), block))
    np.testing.assert_allclose(np.concatenate([midnights.passed(one) for one in parts]), true)


def test_what_is_no_time_of_a_day_stays_so_and_passes_no_midnight():
    found = Midnights().passed(np.array([np.nan, DAY - 1.0, np.nan, 1.0, np.nan]))
    np.testing.assert_array_equal(found, [np.nan, DAY - 1.0, np.nan, DAY + 1.0, np.nan])
    assert Midnights().passed(np.zeros(0)).size == 0
