# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Alarms of a fleet: control of the share of false ones among the axes that are told worse.

Each axis has an e-value against "no change" that only grows within a year, so that it is valid at
any time. Axes are told by the rule of Benjamini and Hochberg for e-values, with shares of the
level in the order of their first logs: neither a later log nor a further axis withdraws an alarm.

"""

from collections.abc import Mapping, Sequence
import dataclasses
import math
from typing import TypeVar

from ballscrew_monitor.health.assess import DRAG
from ballscrew_monitor.health.mixed import CHANGE_RATE
from ballscrew_monitor.health.records import Condition, Health
from ballscrew_monitor.health.rows import DAY
from ballscrew_monitor.health.words import verdict_of
import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Key = TypeVar('Key')
LEVEL = 0.1  # share of false alarms among the axes told worse in a year, at most in the mean [-]
ALARM = 0.02  # probability that an axis without a change alarms by itself in a year, at most [-]
YEAR, WEEK = 365 * DAY, 7 * DAY
NOT_TOLD = 'worse by its own logs; beside the other axes it needs more of them to be told so'
SHARES = 2.10974  # sum of 1/(n ln(n)^2) over all n from 2 on


def bayes_factor(stamps: NDArray[np.int64], doubt: Array) -> Array:
    """
    Return the Bayes factor of a lasting change against none after each look [-].

    The odds after the data over those before, which grow with the time since the first look.
    `stamps` [ns] of all looks of an axis; `doubt` [-] that nothing lasting has come.

    """
    before = CHANGE_RATE * (stamps - stamps[0]) / DAY
    after = (1.0 - doubt) / np.maximum(doubt, 1e-12)
    return np.divide(after, before, out=np.zeros_like(doubt), where=before > 0.0)


def evidence(stamps: NDArray[np.int64], factor: Array, begins: NDArray[np.bool_]) -> Array:
    """
    Return the e-value of an axis after each of its looks within one year.

    `stamps` [ns] of the looks; `factor` [-] is the Bayes factor of each, `begins` where an alarm
    of the axis alone begins. The first look has no time before it, and so no weight.

    """
    share = np.diff(stamps, prepend=stamps[:1]) / YEAR
    alarm = np.logical_or.accumulate(begins) / ALARM
    return np.asarray(0.5 * alarm + 0.5 * np.cumsum(share * factor))


def shares(count: int) -> Array:
    """Return the shares of the level of axes in order [-]; the sum stays below 1 for any count."""
    number = np.arange(2.0, count + 2.0)
    return np.asarray(1.0 / (number * np.log(number) ** 2 * SHARES))


def told(values: Array, share: Array) -> NDArray[np.bool_]:
    """Return which axes are told worse by their e-values and their shares of the level [-]."""
    score = values * share
    ordered = np.sort(score)[::-1]
    enough = np.flatnonzero(ordered * LEVEL * np.arange(1, len(score) + 1) >= 1.0)
    return np.asarray(score >= (ordered[enough[-1]] if len(enough) else math.inf))


def confirmed(
    stamps: Sequence[NDArray[np.int64]],
    factor: Sequence[Array],
    begins: Sequence[NDArray[np.bool_]],
) -> NDArray[np.int64]:
    """
    Return from which stamp [ns] on each axis is told worse, the largest number for never.

    Looks of axes as for `evidence`, axes in the order of their first looks. Years begin with the
    first look of all, and axes are told week by week.

    """
    never = np.iinfo(np.int64).max
    since = np.full(len(stamps), never)
    first, last = (int(part) for part in (stamps[0][0], max(part[-1] for part in stamps)))
    share = shares(len(stamps))
    for year in range(first, last + 1, YEAR):
        axes = []  # looks within the year, with their e-values
        for times, factors, begin in zip(stamps, factor, begins, strict=True):
            own = (times >= year) & (times < year + YEAR)
            axes.append((times[own], evidence(times[own], factors[own], begin[own])))
        for week in range(year, min(year + YEAR, last + 1), WEEK):
            known = [(np.searchsorted(times, week + WEEK), values) for times, values in axes]
            alarms = told(np.array([values[at - 1] if at else 0.0 for at, values in known]), share)
            since = np.where(alarms, np.minimum(since, week), since)
    return np.asarray(since)


def controlled(courses: Mapping[Key, Sequence[Health]]) -> tuple[dict[Key, list[Health]], str]:
    """
    Return the courses of axes with their alarms controlled, and a sentence, '' for one axis.

    A worse axis that is not told yet has slightly changed.

    """
    known = {key: course for key, course in courses.items() if course}
    order = sorted(known, key=lambda key: (known[key][0].stamp, str(key)))
    if len(order) < 2:
        return {key: list(course) for key, course in courses.items()}, ''
    stamps, factors, begins = [], [], []
    for key in order:
        stamps.append(np.array([health.stamp for health in known[key]]))
        doubt = np.array([health.doubt for health in known[key]])
        factors.append(bayes_factor(stamps[-1], doubt))
        worse = np.array([health.condition is Condition.WORSE for health in known[key]])
        begins.append(worse & ~np.concatenate([[False], worse[:-1]]))
    dates = dict(zip(order, confirmed(stamps, factors, begins).tolist(), strict=True))
    lowered = {key: list(course) for key, course in known.items()}
    for key, course in lowered.items():
        for at, health in enumerate(course):
            if health.stamp < dates[key] and health.condition is Condition.WORSE:
                condition, drag = Condition.SLIGHTLY_CHANGED, health.quantity(DRAG)
                verdict = verdict_of(health.axis, condition, drag, health.causes, health.since)
                notes = [*health.notes, NOT_TOLD]
                course[at] = dataclasses.replace(
                    health, condition=condition, verdict=verdict, notes=notes
                )
    alone, together = (
        sum(course[-1].condition is Condition.WORSE for course in part.values())
        for part in (known, lowered)
    )
    return lowered, (
        f'{len(known)} axes, {together} of them worse: in the mean at most {100 * LEVEL:.0f} % of '
        f'such are so by chance; by its own logs alone each, {alone} would be worse, with '
        f'at most {ALARM * len(known):.2g} false alarms a year'
    )
