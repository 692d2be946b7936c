# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Rates and units estimated from the numbers of a log."""

from ballscrew_monitor.recordings.tables.amounts import (
    fault_of_slope,
    is_magnitude,
    is_one_sided,
    reverses,
)
from ballscrew_monitor.recordings.tables.estimates import (
    DAY,
    is_within_turn,
    largest_speed_unit,
    Midnights,
    period,
    position_unit,
    Turns,
    unit_by_factor,
    way_per_speed,
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
    with np.errstate(over='ignore'):  # speeds that no machine has make no rate
        assert np.isnan(period([(np.arange(9.0), np.full(9, 1e200))]))


@pytest.mark.parametrize(
    ('largest', 'unit'), [(2.0, 'm/s'), (2.1, 'mm/s'), (2000.0, 'mm/s'), (2001.0, 'mm/min')]
)
def test_the_largest_speed_tells_the_unit_where_nothing_else_does(largest, unit):
    assert largest_speed_unit(largest)[0] == unit


@given(st.floats(1e-4, 1e4), st.floats(0.2, 5.0), st.sampled_from([-1.0, 1.0]))
def test_the_way_for_each_of_a_speed_is_that_of_its_integral(factor, frequency, sign):
    """The integral of a sine is a cosine; both have rows of their own."""
    times, seconds = np.arange(0.0, 20.0, 0.013), np.arange(0.0, 20.0, 0.004)
    places = 3.0 - sign * factor * np.cos(frequency * times) / frequency
    speeds = np.sin(frequency * seconds)
    speeds[::7] = np.nan
    found = way_per_speed((times, places), (seconds, speeds))
    assert found == pytest.approx(sign * factor, rel=0.01)


def test_a_speed_of_another_motion_tells_no_way():
    times = np.arange(0.0, 20.0, 0.01)
    place, other = np.sin(times), np.sin(3.0 * times)
    assert np.isnan(way_per_speed((times, place), (times, other)))
    assert np.isnan(way_per_speed((times, place), (times, np.zeros(len(times)))))
    assert np.isnan(way_per_speed((times[:3], place[:3]), (times, other)))


def test_a_unit_is_near_to_its_factor():
    units = {'m/s': 1.0, 'mm/s': 1e-3}
    assert [unit_by_factor(value, units) for value in (1.04, 0.97e-3, 1.06)] == ['m/s', 'mm/s', '']


@given(
    st.lists(st.floats(-0.49, 0.49), min_size=1, max_size=40),
    st.integers(1, 41),
    st.sampled_from([1.0, 360.0]),
)
def test_turns_of_a_scale_are_counted_in_blocks_of_any_size(steps, block, turn):
    true = turn * np.cumsum([0.1, *steps])
    told, scale = true % turn, Turns(turn)
    parts = np.split(told, range(block, len(told), block))
    counted = np.concatenate([scale.counted(part) for part in parts])
    np.testing.assert_allclose(np.diff(counted), np.diff(true), atol=1e-9 * turn)
    np.testing.assert_allclose(counted % turn, told, atol=1e-9 * turn)


def test_unknown_positions_stay_so_and_count_no_turn():
    found = Turns(360.0).counted(np.array([np.nan, 350.0, np.nan, 10.0]))
    np.testing.assert_array_equal(found, [np.nan, 350.0, np.nan, 370.0])
    assert Turns(360.0).counted(np.zeros(0)).size == 0


def test_a_scale_of_one_turn_is_used_for_the_most_of_it():
    ends = [(0.0, 359.9), (-180.0, 180.0), (0.0, 170.0), (0.0, 720.0)]
    assert [is_within_turn(np.array(pair), 360.0) for pair in ends] == [True, True, False, False]
    radians = [(0.0, 6.2832), (-3.1416, 3.1416), (0.0, 6.3)]
    turn = 2.0 * np.pi
    assert [is_within_turn(np.array(pair), turn) for pair in radians] == [True, True, False]


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
    assert is_magnitude(torque, speed, makes_load=True)
    assert not is_magnitude(torque, np.abs(speed), makes_load=True)
    apart = np.where(odd, torque, np.nan), np.where(odd, np.nan, speed)
    assert is_magnitude(*apart, makes_load=False) is None


RUNNING = np.repeat([0.0, 75.0, 0.0, -40.0], 100)


@pytest.mark.parametrize(
    ('torque', 'expected'),
    [
        (np.abs(RUNNING), True),
        (np.abs(RUNNING) - 2.0, True),
        (np.where(np.arange(400) == 150, -50.0, np.abs(RUNNING)), True),
        (np.where(RUNNING == 0.0, -30.0, np.abs(RUNNING)), True),
        (RUNNING, False),
        (0.0 * RUNNING, False),
    ],
)
def test_noise_a_glitch_and_rest_are_no_other_sign(torque, expected):
    assert is_one_sided(torque, RUNNING) is expected


ROWS_OF_FAST_AHEAD = np.repeat(RUNNING, np.repeat([1, 30, 1, 1], 100))
"""The same motion where 30 times as many rows are written ahead as back."""


@pytest.mark.parametrize(
    ('speed', 'sign'),
    [
        (np.where(np.arange(400) == 20, 9e4, RUNNING), 1.0),
        (np.where(np.arange(400) == 370, -9e4, RUNNING), 1.0),
        (np.where(np.arange(400) == 150, 9e4, RUNNING), -1.0),
        (ROWS_OF_FAST_AHEAD, 1.0),
        (ROWS_OF_FAST_AHEAD, -1.0),
    ],
)
def test_a_jump_and_rows_of_another_rate_hide_no_change_of_sign(speed, sign):
    force = sign * np.sign(speed) * 900.0
    assert not is_one_sided(force, speed)
    assert is_one_sided(np.abs(force), speed)


@pytest.mark.parametrize(
    ('ways', 'expected'),
    [
        ([5.0] * 50 + [-0.1, -0.1, -0.2] * 10, True),
        ([5.0] * 50 + [-0.01, 0.01] * 500, False),  # jitter at rest
        ([*[5.0] * 50, -250.0] * 4, False),  # the next run begins where the last did
        ([5.0, np.nan, 0.0] * 9 + [-5.0, 0.0, np.nan] * 9, True),
        ([], False),
    ],
)
def test_an_axis_reverses_if_it_goes_some_way_in_both_directions(ways, expected):
    assert reverses(np.array(ways)) is expected
    assert reverses(-np.array(ways)) is expected


SLOW = np.concatenate([np.zeros(50), 75.0 * np.arange(300) / 100.0, np.full(50, 225.0)])
"""Places of an axis at 75 mm/s, 100 rows in a second, between two rests."""
SWING = 100.0 * np.cos(np.arange(600) / 50.0)


@pytest.mark.parametrize(
    ('places', 'runs', 'fault'),
    [
        (SWING, 1, ''),
        (SLOW, 1, ''),
        (np.where(np.arange(600) % 7 == 0, SWING, np.nan), 1, ''),
        (SWING[np.arange(600) // 7 * 7], 1, 'stays'),
        (np.round(SWING, 0), 1, 'moves in steps'),
        (np.round(SWING, 3), 1, ''),
        (SWING % 40.0, 1, 'jumps'),
        (np.tile(SLOW, 5), 5, ''),
        (np.tile(SLOW, 5), 1, 'jumps'),
    ],
)
def test_a_position_that_is_held_coarse_or_begins_again_has_no_slope(places, runs, fault):
    assert fault_of_slope(places, runs).startswith(fault)
    assert bool(fault_of_slope(places, runs)) is bool(fault)
