# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Rates and units estimated from the numbers of a log."""

from ballscrew_monitor.recordings.tables.estimates import (
    DAY,
    is_magnitude,
    Midnights,
    period,
    position_unit,
    speed_unit,
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


def test_torques_at_other_times_do_not_show_whether_they_are_amounts():
    speed = np.sin(np.arange(200) / 20.0)
    torque, odd = np.abs(np.sign(speed) + 0.3 * np.cos(np.arange(200) / 20.0)), np.arange(200) % 2
    assert is_magnitude(torque, speed)
    assert not is_magnitude(torque, np.abs(speed))
    apart = np.where(odd, torque, np.nan), np.where(odd, np.nan, speed)
    assert is_magnitude(*apart) is None
