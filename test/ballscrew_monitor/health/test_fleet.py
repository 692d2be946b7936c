# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""A fleet of simulated axes: few of its alarms are false, and what is said of them."""

import math

from ballscrew_monitor.health.detection import DOUBT, look
from ballscrew_monitor.health.fleet import fleet_note, SOUND_ALARMS
from ballscrew_monitor.health.history import Group, History
from ballscrew_monitor.health.records import Condition, Health, TOLERANCE
from ballscrew_monitor.health.rows import DAY
import numpy as np

WEEKS = 52
LOOKS = range(15, WEEKS + 1, 3)
FORGOTTEN = 15.0  # [weeks]


def axis_year(rng, change, week):
    """
    Return weekly logs of a year at one place, whose friction changes by `change` at a week.

    Scatter of logs, a wander that is forgotten over 15 weeks, and a temperature with its slope.

    """
    kept = math.exp(-1.0 / FORGOTTEN)
    walk = rng.standard_normal(WEEKS)
    for at in range(1, WEEKS):
        walk[at] = kept * walk[at - 1] + math.sqrt(1.0 - kept**2) * walk[at]
    warmth = 6.0 * np.sin(2.0 * math.pi * np.arange(WEEKS) / WEEKS + rng.uniform(0.0, 6.3))
    effect = rng.uniform(0.002, 0.02) * walk + rng.uniform(0.01, 0.02) * rng.standard_normal(WEEKS)
    effect += rng.normal(-0.01, 0.004) * warmth + change * (np.arange(WEEKS) >= week)
    full = np.ones((WEEKS, 1))
    return History(
        start=(20_000 + 7 * np.arange(WEEKS)) * DAY,
        groups=(Group(10, 0, False, 0),),
        friction=np.exp(effect)[:, None],
        offset=0.0 * full,
        speed=full,
        load=0.0 * full,
        ideal=0.0 * full,
        temperature=300.0 + warmth[:, None],
        weight=full,
        standstill=np.full(WEEKS, np.nan),
        gain=np.full(WEEKS, np.nan),
        warm=True,
        load_known=True,
    )


def alarm_of(history):
    """Return the number of logs and the sign with which an axis is worse first, or 0 and 0."""
    for count in LOOKS:
        sign = look(history.until(count)).raised
        if sign:
            return count, sign
    return 0, 0


def alarms_of(seed, axes, changed):
    """
    Return how many axes alarm, how many of them falsely, and the share of large changes found.

    A share of `changed` axes has a change of 15 % in the mean square, at some week; it is true
    where it has come beyond the tolerance with its sign.

    """
    rng = np.random.default_rng(seed)
    alarms, false, found = 0, 0, []
    for _ in range(axes):
        change = rng.normal(0.0, 0.15) if rng.random() < changed else 0.0
        week = int(rng.integers(4, WEEKS))
        count, sign = alarm_of(axis_year(rng, change, week))
        alarms += count > 0
        false += count > 0 and not (sign * change > TOLERANCE and week < count)
        if abs(change) > 0.12 and 14 < week < WEEKS - 8:
            found.append(count > week)
    return alarms, false, np.mean(found) if found else math.nan


def test_few_alarms_of_a_fleet_are_false_and_large_changes_are_found():
    alarms, false, found = alarms_of(7, 60, 0.5)
    assert alarms > 12
    assert false <= DOUBT * alarms + 2.0 * math.sqrt(DOUBT * alarms)
    assert found > 0.9


def test_a_sound_fleet_hardly_alarms():
    alarms, false, _ = alarms_of(8, 60, 0.0)
    assert false == alarms <= SOUND_ALARMS * 60 + 2.0 * math.sqrt(SOUND_ALARMS * 60)


def health(condition):
    return Health(axis='x', stamp=0, condition=condition, verdict='Axis x.')


def test_the_note_counts_the_axes_that_are_worse_at_last():
    sound, worse = health(Condition.NORMAL), health(Condition.WORSE)
    courses = [[sound]] * 29 + [[sound, worse], [worse, sound], []]
    assert fleet_note(courses) == (
        '31 axes, 1 of them worse: in the mean at most 5 % of such alarms are false, and where no '
        'axis changes, at most 0.31 of them come a year'
    )
    assert fleet_note([[worse], []]) == ''
