# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The latch that nothing flaps, blocks of logs, and losses that are found."""

import math

from ballscrew_monitor.health.detection import (
    baseline_of,
    binned,
    bins_of,
    latched,
    Look,
    looks,
    now_of,
    RECOVERY,
    smallest_loss,
)
from ballscrew_monitor.health.history import Group, History
from ballscrew_monitor.health.mixed import estimate, Logs
from ballscrew_monitor.health.records import Condition
from ballscrew_monitor.health.rows import DAY
import numpy as np
import pytest

NORMAL, WORSE, SLIGHT, UNKNOWN = (
    Condition.NORMAL,
    Condition.WORSE,
    Condition.SLIGHTLY_CHANGED,
    Condition.UNKNOWN,
)
FIRST = 20_000


def seen(week, change, *, raised=0, shifted=0, half=0.03):
    return Look(
        log=week,
        time=7.0 * week,
        change=change,
        low=change - half,
        high=change + half,
        raised=raised,
        shifted=shifted or raised,
        onset=week,
    )


def states(many):
    return [condition for condition, _ in latched(many)]


def test_what_is_worse_stays_until_eight_weeks_within_the_tolerance():
    many = [seen(0, 0.0), seen(1, -0.1, raised=-1)]
    many += [seen(week, -0.06) for week in range(2, 10)]
    many += [seen(week, -0.02) for week in range(10, 20)]
    found = latched(many)
    conditions = [condition for condition, _ in found]
    back = 10 + round(RECOVERY / 7.0)
    assert conditions == [NORMAL] + [WORSE] * (back - 1) + [NORMAL] * (20 - back)
    assert {since for condition, since in found if condition is WORSE} == {1}
    assert found[-1] == (NORMAL, -1)


def test_a_relapse_begins_the_eight_weeks_again():
    many = [seen(0, -0.1, raised=-1)]
    many += [seen(week, -0.02 if week != 6 else -0.05) for week in range(1, 13)]
    assert states(many) == [WORSE] * 13


def test_the_date_is_that_of_the_first_alarm_and_a_change_may_grow():
    many = [seen(0, -0.04, shifted=-1), seen(1, -0.09, raised=-1), seen(2, -0.12, raised=-1)]
    assert latched(many) == [(SLIGHT, 0), (WORSE, 1), (WORSE, 1)]


def test_looks_that_say_nothing_leave_the_condition():
    nothing = Look(log=3, time=21.0)
    assert states([nothing, seen(4, 0.0), seen(5, 0.0, half=0.2)]) == [UNKNOWN, NORMAL, UNKNOWN]
    assert states([seen(0, -0.1, raised=-1), nothing._replace(log=1)]) == [WORSE, WORSE]


def parts_of(time):
    now = np.arange(len(time)) >= len(time) - now_of(time)
    return baseline_of(time, now, 91.0), now


def test_the_baseline_is_a_quarter_and_four_logs_are_now():
    baseline, now = parts_of(7.0 * np.arange(30.0))
    assert np.flatnonzero(baseline).tolist() == list(range(14))
    assert np.flatnonzero(now).tolist() == [26, 27, 28, 29]
    assert parts_of(np.array([0.0, 7.0, 14.0, 21.0]))[0].sum() == 2


def test_three_monthly_runs_are_a_baseline_and_two_are_now():
    baseline, now = parts_of(30.0 * np.arange(5.0))
    assert baseline.tolist() == [True] * 3 + [False] * 2
    assert now.tolist() == [False] * 3 + [True] * 2


def test_logs_of_some_days_are_one_and_no_more_sure_than_three():
    days = np.arange(100.0)
    found = binned(Logs(days, days, np.zeros(100), np.ones(100)), bins_of(days))
    assert len(found.time) == 8 + 19  # weeks, and three days each
    assert found.noise.min() == pytest.approx(1.0 / 3.0)
    hours = np.arange(40.0) / 2.0
    few = binned(Logs(hours, hours, np.zeros(40), np.ones(40)), bins_of(hours))
    assert few.time == pytest.approx(np.arange(20.0) + 0.25)


def test_the_smallest_loss_grows_with_the_scatter():
    def loss(scatter):
        time = 7.0 * np.arange(30.0)
        effect = np.random.default_rng(5).normal(0.0, scatter, 30)
        logs = Logs(time, effect, np.zeros(30), np.ones(30))
        return smallest_loss(estimate(logs, *parts_of(time)), time)

    assert 0.04 < loss(0.006) < loss(0.015) < loss(0.03) < 0.2
    assert math.isfinite(loss(0.0))


def year(random, *, loss=0.0, at=26, scatter=0.012, wander=0.0, weeks=52, swing=8.0):
    """Return a year of weekly logs with four groups; the friction is lost at one week."""
    warmth = swing * np.sin(np.arange(weeks) / 8.3) + random.normal(0.0, 1.5, weeks)
    drift = random.normal(0.0, scatter, weeks) + wander * np.sin(np.arange(weeks) / 12.0)
    drift[at:] += math.log(1.0 - loss)
    effect = drift - 0.012 * warmth
    friction = np.exp(effect)[:, None] * np.array([0.9, 0.7, 0.8, 1.1])
    friction *= np.exp(random.normal(0.0, 0.005, friction.shape))
    full = np.ones_like(friction)
    return History(
        start=(FIRST + 7 * np.arange(weeks)) * DAY,
        groups=tuple(Group(speed, 0, False, 0) for speed in (5, 10, 15, 20)),
        friction=friction,
        offset=0.0 * full,
        speed=full,
        load=0.0 * full,
        temperature=300.0 + warmth[:, None] * full,
        weight=full,
        standstill=np.full(weeks, np.nan),
        gain=np.full(weeks, np.nan),
        warm=True,
        load_known=True,
    )


def test_clean_years_end_normal_without_an_alarm():
    for seed in range(6):
        course = list(looks(year(np.random.default_rng(seed))))
        assert not any(one.raised for one in course)
        assert course[13].high - course[13].low < 0.08
        assert states(course)[-1] is NORMAL


def test_a_loss_of_a_tenth_is_found_within_eight_weeks_with_its_size_and_date():
    found = 0
    for seed in range(8):
        course = list(looks(year(np.random.default_rng(100 + seed), loss=0.1)))
        raised = [one.log for one in course if one.raised < 0]
        found += bool(raised) and 26 <= raised[0] < 34
        assert course[33].low < -0.1 < course[33].high
    assert found >= 7


def test_the_smallest_loss_is_found_in_nine_of_ten():
    """Years whose friction falls by the loss that the axis stated the week before."""
    found, plan = 0, {'scatter': 0.015, 'swing': 4.0}
    for seed in range(300, 310):
        before = list(looks(year(np.random.default_rng(seed), weeks=26, **plan)))
        lost = year(np.random.default_rng(seed), loss=before[-1].smallest, weeks=34, **plan)
        found += any(one.raised < 0 for one in looks(lost))
    assert found >= 8


def test_fresh_grease_passes_and_is_no_change():
    for seed in range(4):
        greased = year(np.random.default_rng(seed), scatter=0.01, weeks=40)
        greased.friction[26] *= 1.12
        greased.friction[27] *= 1.05
        assert not any(one.raised for one in looks(greased))


def test_what_came_and_went_is_no_change_any_more():
    mended = year(np.random.default_rng(3), loss=0.15, at=20)
    mended.friction[36:] /= 0.85
    course = list(looks(mended))
    assert course[34].raised == -1
    assert abs(course[-1].change) < 0.03
    assert not course[-1].raised
    assert states(course)[-1] is NORMAL


def test_the_date_is_that_of_the_step():
    course = list(looks(year(np.random.default_rng(9), loss=0.15)))
    assert {one.onset for one in course if one.raised} <= {25, 26, 27}
