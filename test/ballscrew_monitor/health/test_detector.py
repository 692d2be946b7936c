# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Self-starting CUSUM: scores, sums, no look-ahead, and a screw that wore until it failed."""

import csv
import itertools
import math
import os
from pathlib import Path

from ballscrew_monitor.core.conversions import TIME_UNITS
from ballscrew_monitor.health.baseline import RUNNING_IN
from ballscrew_monitor.health.detector import (
    first_alarm,
    FLOOR,
    LIMIT,
    normal_score_wallace_1959,
    run_length_siegmund_1985,
    SelfStarting,
    SLACK,
)
from hypothesis import given
from hypothesis import strategies as st
import numpy as np
import pytest
from scipy import stats

HOUR = TIME_UNITS['h']
NUMBERS = st.lists(st.floats(0.1, 10.0), min_size=5, max_size=40)


def hourly(readings, begin=RUNNING_IN):
    return [(begin + at * HOUR, reading) for at, reading in enumerate(readings)]


@pytest.mark.parametrize('freedom', [2, 3, 5, 20, 200])
def test_scores_are_normal_deviates_of_the_probability_of_student(freedom):
    for ratio in (0.0, 0.5, 1.0, 2.0, 3.0, 5.0):
        exact = stats.norm.isf(stats.t.sf(ratio, freedom))
        assert normal_score_wallace_1959(ratio, freedom) == pytest.approx(exact, abs=0.05)
        assert normal_score_wallace_1959(-ratio, freedom) == -normal_score_wallace_1959(
            ratio, freedom
        )


@given(NUMBERS)
def test_mean_and_squares_are_those_of_the_readings(readings):
    state = SelfStarting()
    for reading in readings:
        state.take(reading)
    assert state.count == len(readings)
    assert state.mean == pytest.approx(np.mean(readings))
    assert state.squares == pytest.approx(np.var(readings) * len(readings), abs=1e-9)


def test_a_score_is_by_the_readings_before():
    state = SelfStarting()
    for reading in (1.0, 2.0, 3.0):
        assert math.isnan(state.score(reading))
        state.take(reading)
    ratio = (5.0 - 2.0) / 1.0 * math.sqrt(3 / 4)
    assert state.score(5.0) == normal_score_wallace_1959(ratio, 2)
    score = state.score(5.0)
    assert state.take(5.0) == score - SLACK
    assert state.low == 0.0


def test_equal_readings_have_the_least_spread():
    state = SelfStarting()
    for _ in range(4):
        state.take(2.0)
    assert state.score(2.0) == 0.0
    ratio = 1.0 * math.sqrt(4 / 5)
    assert state.score(2.0 * (1 + FLOOR)) == pytest.approx(normal_score_wallace_1959(ratio, 3))


@given(NUMBERS, st.floats(0.5, 3.0))
def test_the_unit_and_the_sign_of_readings_change_nothing(readings, unit):
    series = hourly(readings)
    told = first_alarm(series)
    # Products round: a sum that lies on the limit may end on either side.
    near = [abs(one - LIMIT) < 1e-6 for one in map(SelfStarting().take, readings)]
    if not any(near):
        assert first_alarm([(time, unit * one) for time, one in series]) == told
        assert first_alarm([(time, -one) for time, one in series]) == told


@given(NUMBERS, NUMBERS)
def test_no_look_ahead(readings, later):
    """What comes after an alarm changes nothing about it."""
    told = first_alarm(hourly(readings))
    if told is not None:
        assert first_alarm(hourly(readings + later)) == told


def test_readings_of_the_running_in_are_set_aside_and_gaps_left_out():
    steady = [1.0, 1.01, 0.99] * 10
    assert first_alarm(hourly(steady)) is None
    assert first_alarm([(0.0, 2.0), *hourly(steady)]) is None
    assert first_alarm([(0.0, 2.0), *hourly(steady, begin=RUNNING_IN - 1.0)]) is None
    assert first_alarm(hourly([math.nan, *steady, math.inf, *steady])) is None
    assert first_alarm(hourly([*steady, 1.1, 1.1])) is not None
    assert first_alarm(hourly([*steady, 0.9, 0.9])) is not None
    assert first_alarm([]) is None


@pytest.mark.parametrize(('slack', 'limit', 'known'), [(0.5, 4.0, 335.0), (0.5, 5.0, 930.0)])
def test_run_lengths_are_those_of_the_tables(slack, limit, known):
    """One-sided: Montgomery, Statistical Quality Control, table 9.3 times two (168 and 465)."""
    assert run_length_siegmund_1985(slack, limit) == pytest.approx(known, rel=0.02)
    assert run_length_siegmund_1985(slack, limit, slack) == pytest.approx((limit + 1.166) ** 2)
    assert run_length_siegmund_1985(slack, limit, slack + 1e-4) == pytest.approx(
        (limit + 1.166) ** 2, rel=1e-2
    )


def test_false_alarms_come_as_often_as_stated():
    """Of 2000 normal series of 30 readings; the spread is above the least one."""
    rng = np.random.default_rng(1)
    series = rng.normal(1.0, 0.03, (2000, 30))
    found = sum(first_alarm(hourly(one)) is not None for one in series) / len(series)
    assert 0.12 < found < 0.2
    assert run_length_siegmund_1985(SLACK, LIMIT) / 2 == pytest.approx(124, abs=1)


@pytest.fixture(name='worn', scope='session')
def worn_screws():
    """Return hours and readings of two screws that wore until they failed."""
    folder = os.environ.get('BALLSCREW_RECORDINGS', '')
    path = Path(folder) / 'xjtu_torque.csv'
    if not folder or not path.is_file():
        pytest.skip('BALLSCREW_RECORDINGS names no folder with xjtu_torque.csv')
    with path.open() as file:
        rows = [{name: float(one) for name, one in row.items()} for row in csv.DictReader(file)]
    return {name: [(row['hours'] * HOUR, row[name]) for row in rows] for name in ('up', 'down')}


def second_below(series, share):
    """Return when two readings in a row were below the first one by a share."""
    limit = (1.0 - share) * series[0][1]
    pairs = itertools.pairwise(series)
    return next(time for (_, one), (time, other) in pairs if max(one, other) < limit)


@pytest.mark.parametrize(('name', 'alarm', 'rule'), [('up', 280, 315), ('down', 280, 490)])
def test_a_screw_that_wears_is_told_before_two_readings_below_ten_percent(worn, name, alarm, rule):
    """By what was seen until then alone."""
    series = worn[name]
    told = first_alarm(series)
    assert told == alarm * HOUR
    assert first_alarm([one for one in series if one[0] <= told]) == told
    assert first_alarm([one for one in series if one[0] < told]) is None
    assert second_below(series, 0.1) == rule * HOUR
    assert told < second_below(series, 0.1)


def test_the_rule_by_the_second_reading_comes_later(worn):
    assert second_below(worn['up'][1:], 0.1) == 350 * HOUR
    assert second_below(worn['down'][1:], 0.1) == 595 * HOUR


def test_running_in_of_a_worn_screw_is_no_alarm(worn):
    """The second screw fell by 5 % after its first reading and stayed for 140 h."""
    assert first_alarm(worn['down'][:6]) is None
