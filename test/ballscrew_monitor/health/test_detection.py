# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The latch that nothing flaps, blocks of logs, and losses that are found."""

import math

from ballscrew_monitor.health.detection import (
    binned,
    blocks_of,
    latched,
    Look,
    look,
    looks,
    RECOVERY,
    smallest_loss,
)
from ballscrew_monitor.health.history import Group, History
from ballscrew_monitor.health.mixed import Estimate, Logs
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
    )


def states(many):
    return [one.condition for one in latched(many, [one.log for one in many])]


def test_what_is_worse_stays_until_eight_weeks_within_the_tolerance():
    many = [seen(0, 0.0), seen(1, -0.1, raised=-1)]
    many += [seen(week, -0.06) for week in range(2, 10)]
    many += [seen(week, -0.02) for week in range(10, 20)]
    found = latched(many, [one.log for one in many])
    conditions = [one.condition for one in found]
    back = 10 + round(RECOVERY / 7.0)
    assert conditions == [NORMAL] + [WORSE] * (back - 1) + [NORMAL] * (20 - back)
    assert {one.since for one in found if one.condition is WORSE} == {1}
    assert found[-1].since == -1


def test_a_relapse_begins_the_eight_weeks_again():
    many = [seen(0, -0.1, raised=-1)]
    many += [seen(week, -0.02 if week != 6 else -0.05) for week in range(1, 13)]
    assert states(many) == [WORSE] * 13


def test_the_date_is_that_of_the_first_alarm_and_a_change_may_grow():
    many = [seen(0, -0.04, shifted=-1), seen(1, -0.09, raised=-1), seen(2, -0.12, raised=-1)]
    found = latched(many, [0, 1, 2])
    assert [(one.condition, one.since) for one in found] == [(SLIGHT, 0), (WORSE, 1), (WORSE, 1)]


def test_looks_that_say_nothing_leave_the_condition():
    nothing = Look(log=3, time=21.0)
    assert states([nothing, seen(4, 0.0), seen(5, 0.0, half=0.2)]) == [UNKNOWN, NORMAL, UNKNOWN]
    assert states([seen(0, -0.1, raised=-1), nothing._replace(log=1)]) == [WORSE, WORSE]


def test_blocks_are_the_baseline_eight_weeks_each_and_now():
    blocks = blocks_of(7.0 * np.arange(30.0), 91.0)
    assert blocks[:14].tolist() == [0] * 14
    assert blocks[14:26].tolist() == [1] * 8 + [2] * 4
    assert blocks[26:].tolist() == [3] * 4
    assert blocks_of(np.array([0.0, 7.0, 14.0, 21.0]), 91.0) is None


def test_three_monthly_runs_are_a_baseline_and_two_are_now():
    blocks = blocks_of(30.0 * np.arange(5.0), 91.0)
    assert blocks.tolist() == [0, 0, 0, 1, 1]
    *before, first, second = blocks_of(30.0 * np.arange(12.0), 91.0).tolist()
    assert first == second == before[-1] + 1


def test_logs_of_some_days_are_one_and_no_more_sure_than_three():
    days = np.arange(100.0)
    found = binned(Logs(days, days, np.zeros(100), np.ones(100)))
    assert len(found.time) == 8 + 19  # weeks, and three days each
    assert found.noise.min() == pytest.approx(1.0 / 3.0)
    hours = np.arange(40.0) / 2.0
    few = binned(Logs(hours, hours, np.zeros(40), np.ones(40)))
    assert few.time == pytest.approx(np.arange(20.0) + 0.25)


def test_the_smallest_loss_grows_with_the_doubt():
    def loss(deviation):
        one = np.array([deviation])
        return smallest_loss(
            Estimate(weight=np.ones(1), mean=np.zeros(1), known=one, lasting=one, slope=0.0)
        )

    assert 0.0 < loss(0.005) < loss(0.02) < loss(0.05) < 0.3
    assert loss(0.0) == pytest.approx(1.0 - math.exp(-0.03))


def year(random, *, loss=0.0, at=26, scatter=0.012, wander=0.0, weeks=52):
    """Return a year of weekly logs with four groups; the friction is lost at one week."""
    warmth = 8.0 * np.sin(np.arange(weeks) / 8.3) + random.normal(0.0, 1.5, weeks)
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
        ideal=0.0 * full,
        temperature=300.0 + warmth[:, None] * full,
        weight=full,
        standstill=np.full(weeks, np.nan),
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


def test_the_p_value_is_small_as_rarely_as_it_says_and_at_once_after_a_loss():
    chances = []
    for seed in range(30):
        clean = year(np.random.default_rng(200 + seed))
        assert look(clean.until(10)).chance == 1.0
        chances += [look(clean.until(count)).chance for count in (24, 50)]
    assert np.mean(np.array(chances) < 0.05) <= 0.05
    assert np.mean(np.array(chances) < 0.5) <= 0.6
    lost = year(np.random.default_rng(300), loss=0.15)
    assert look(lost.until(31)).chance < 1e-4
