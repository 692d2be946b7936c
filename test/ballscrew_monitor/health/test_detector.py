# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Self-starting CUSUM: scores, sums, no look-ahead, and a screw that wore until it failed."""

import csv
import dataclasses
import itertools
import math
import os
from pathlib import Path
import re

from ballscrew_monitor.core.conversions import clock_text, TIME_UNITS
from ballscrew_monitor.health.baseline import RUNNING_IN
from ballscrew_monitor.health.detector import (
    DAILY_FLOOR,
    DAILY_LIMIT,
    first_alarm,
    FLOOR,
    LIMIT,
    normal_score_wallace_1959,
    note_on_runs,
    run_length_siegmund_1985,
    SelfStarting,
    SLACK,
)
from ballscrew_monitor.health.model import Model
from ballscrew_monitor.health.records import LoadSource
from ballscrew_monitor.health.rows import DAY
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


def test_daily_readings_that_drift_by_the_season_seldom_alarm():
    """Of 500 years: days scatter by 2 %, a season moves all by 1 %, each axis at its own time."""
    rng, year = np.random.default_rng(2), np.arange(250) / 250.0
    phase = rng.uniform(0.0, 1.0, (500, 1))
    series = 1.0 + 0.01 * np.sin(2 * np.pi * (year + phase)) + rng.normal(0.0, 0.02, (500, 250))
    daily = {'limit': DAILY_LIMIT, 'floor': DAILY_FLOOR}
    assert sum(first_alarm(hourly(one), **daily) is not None for one in series) < 0.05 * 500
    assert sum(first_alarm(hourly(one)) is not None for one in series) > 0.8 * 500
    fallen = series - 0.1 * np.clip((year - 0.5) / 0.2, 0.0, 1.0)
    assert all(first_alarm(hourly(one), **daily) is not None for one in fallen)


@pytest.fixture(name='runs', scope='module')
def runs_of_a_screw(motion, surface):
    """Return what gives points and motion by day of runs, one each 35 h, and their model."""

    def made(readings, **changes):
        points = [
            motion.point(
                first_day=motion.today + 2 * at,
                load_source=LoadSource.FREE,
                axial_load=0.0,
                motor_torque=reading,
                **changes,
            )
            for at, reading in enumerate(readings)
        ]
        spent = {one.first_day: 35.0 * HOUR for one in points} | {motion.today: 0.0}
        return points, spent, Model(surface)

    return made


def test_a_run_that_differs_is_named_with_its_day_and_its_change(runs, says):
    steady = [0.2, *[0.100, 0.101, 0.099] * 6]  # the first one is of the running-in
    points, spent, model = runs([*steady, 0.09])
    assert note_on_runs(*runs(steady)) == ''
    date = clock_text(points[-1].first_day * DAY)[:10]
    assert re.fullmatch(says('run', date=date, change='-10'), note_on_runs(points, spent, model))
    later, _, _ = runs([*steady, 0.09, 0.2])
    assert note_on_runs(later, spent, model) == note_on_runs(points, spent, model)


def test_readings_of_an_axis_that_is_always_free_need_a_larger_change(runs):
    """One of each day; a rest changes no rule."""
    points, spent, model = runs([*[0.100, 0.101, 0.099] * 6, 0.096, 0.096, 0.096])
    first = points[0].first_day
    each = [dataclasses.replace(one, first_day=first + at) for at, one in enumerate(points)]
    hours = dict.fromkeys((one.first_day for one in each), 35.0 * HOUR)
    assert note_on_runs(points, spent, model) != ''
    assert note_on_runs(each, hours, model) != ''
    assert note_on_runs(each, hours, model, always_free=True) == ''
    far = [
        dataclasses.replace(one, motor_torque=(0.8 if at > 17 else 1.0) * one.motor_torque)
        for at, one in enumerate(each)
    ]
    assert note_on_runs(far, hours, model, always_free=True) != ''


def test_a_change_of_speed_or_load_source_is_no_change_of_the_runs(runs):
    """The model takes the place of a run into account; only what is free of load counts."""
    points, spent, model = runs([0.1] * 12)
    fast, _, _ = runs([0.1] * 12, speed=120.0)
    for one, other in zip(points[6:], fast[6:]):
        part = model.friction([other])[0] / model.friction([one])[0]
        spot = points.index(one)
        points[spot] = dataclasses.replace(other, motor_torque=part * one.motor_torque)
    assert note_on_runs(points, spent, model) == ''
    loaded = [
        dataclasses.replace(one, load_source=LoadSource.MEASURED, motor_torque=0.2 + 0.1 * at)
        for at, one in enumerate(points)
    ]
    assert note_on_runs(loaded, spent, model) == ''


def test_runs_of_the_running_in_and_outside_the_surface_do_not_count(runs):
    points, spent, model = runs([*[0.1, 0.101, 0.099] * 4, 0.2])
    assert note_on_runs(points, spent, model) != ''
    assert note_on_runs(points, dict.fromkeys(spent, 0.0), model) == ''
    far, _, _ = runs([0.2] * 13, speed=1e4)
    assert note_on_runs([*points[:-1], far[-1]], spent, model) == ''
    assert note_on_runs([], {}, model) == ''


@pytest.fixture(name='worn', scope='session')
def worn_screws():
    """Return times and readings of two screws that wore until they failed."""
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


def day_of_hour(motion, hour):
    """Return the day of the run after some hours."""
    return clock_text((motion.today + 2 * hour // 35) * DAY)[:10]


@pytest.mark.parametrize(('name', 'alarm', 'rule'), [('up', 280, 315), ('down', 280, 490)])
def test_a_screw_that_wears_is_told_before_two_readings_below_ten_percent(
    worn, runs, motion, name, alarm, rule
):
    """By what was seen until then alone."""
    readings = [reading for _, reading in worn[name]]
    seen = 1 + alarm // 35
    said = f'the friction without process force of {day_of_hour(motion, alarm)} '
    assert note_on_runs(*runs(readings)).startswith(said)
    assert note_on_runs(*runs(readings[:seen])) == note_on_runs(*runs(readings))
    assert note_on_runs(*runs(readings[: seen - 1])) == ''
    assert second_below(worn[name], 0.1) == rule * HOUR
    assert alarm < rule


def test_the_rule_by_the_second_reading_comes_later(worn):
    assert second_below(worn['up'][1:], 0.1) == 350 * HOUR
    assert second_below(worn['down'][1:], 0.1) == 595 * HOUR


def test_running_in_of_a_worn_screw_is_no_alarm(worn, runs):
    """The second screw fell by 5 % after its first reading and stayed for 140 h."""
    assert note_on_runs(*runs([reading for _, reading in worn['down'][:6]])) == ''
