# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Onset of contact now, as a speed over that of the baseline, by the upturn of the friction.

Below the onset friction rises towards standstill. Whatever moves the onset, a film starved of oil
or a thinner oil, moves this part of the curve of Stribeck along the speed: where contact begins at
r times the speed, the friction at w is that of the surface at w / r. Fitted are the r of the
baseline, for the onset of a sheet is uncertain by a factor, and the ratio to it since, each beside
a constant drag, a factor on all friction and another boundary friction. `surrogate.identify` fits
the same to a staircase, with sheets instead of a surface.

"""

from collections.abc import Sequence
import dataclasses
from itertools import compress
import math

from ballscrew_monitor.health.causes import birge, INTERVAL, PATTERN_DOUBT, vertex
from ballscrew_monitor.health.change import Change, telling
from ballscrew_monitor.health.faults import OWN_ERROR
from ballscrew_monitor.health.life import unknown
from ballscrew_monitor.health.model import FILM_EXPONENT, Model
from ballscrew_monitor.health.points import by_place
from ballscrew_monitor.health.records import ComparablePoint, Quantity
from ballscrew_monitor.health.scatter import Group, group_of
import numpy as np
from numpy.typing import NDArray
from surrogate.units import RPM

Array = NDArray[np.float64]
NAME = 'onset of contact'
STEP = 0.07
STARTS, MOVES = np.arange(-20, 21), np.arange(-26, 27)
"""Steps that are tried of the logarithm of r in the baseline, and of its ratio since [-]."""
SHEET_DOUBT = 0.67
"""Standard deviation of that logarithm in the baseline: nine of ten within a factor of 3 [-]."""
UPTURN, REACH = 0.5, 3.0
"""Speeds over that of the onset: up to which contact shows in the torque, and places count [-]."""
FEWEST_SLOW, FEWEST = 2, 4
"""Places that are needed up to both."""
BESIDE = 0.3
"""Standard deviation of each of the three that may stand beside, over the friction [-]."""
WIDEST = 3.0
"""Upper over lower end of an interval, above which the ratio is not known [-]."""
ALIKE = 'not known: wiper, friction and onset look alike at these speeds and loads'
UNMEASURED = 'not known: 10 K move it by a factor of 2; measure the oil temperature'


@dataclasses.dataclass(frozen=True, slots=True)
class Ran:
    """Points of groups in one time, and for each group what makes a mean over its stretches."""

    points: Sequence[ComparablePoint]
    mean: Array

    def of(self, groups: NDArray[np.int64]) -> 'Ran':
        """Return some of the groups, by number."""
        kept = np.asarray(self.mean[groups].any(axis=0)).tolist()
        return Ran(list(compress(self.points, kept)), self.mean[groups][:, kept])

    def moved(self, model: Model, steps: NDArray[np.int64]) -> Array:
        """Return what the friction changes [N m] where r is that of some steps, by group."""
        films = np.repeat(np.exp(-FILM_EXPONENT * STEP * steps), len(self.points))
        found = model.starved([*self.points] * len(steps), films)
        return np.asarray(found.reshape(len(steps), -1) @ self.mean.T)

    def beside(self, model: Model, friction: Array) -> Array:
        """Return the covariance of what may stand beside the onset [N2 m2]."""
        drag = np.full_like(friction, friction.mean())
        boundary = self.mean @ model.asperity_share(self.points) * friction.mean()
        found = BESIDE * np.stack([drag, friction, boundary], axis=1)
        return np.asarray(found @ found.T)


def onset_of(
    change: Change | None,
    before: Sequence[ComparablePoint],
    lately: Sequence[ComparablePoint],
    model: Model,
    reason: str,
) -> Quantity:
    """
    Return the speed of the onset over that of the baseline, or why it is not known.

    The `change` is that from the points `before` to those of `lately`. Both count at their own
    temperatures, since 10 K move the onset by a factor of 2.

    """
    if change is None:
        return unknown(NAME, '-', reason)
    was, now = (ran_of(points, change.groups, model) for points in (before, lately))
    if not all(one.temperature_measured for one in (*was.points, *now.points)):
        return unknown(NAME, '-', UNMEASURED)
    onsets = model.onsets(now.points)
    part = now.mean @ (np.abs([one.speed for one in now.points]) / onsets)
    groups = np.flatnonzero((part > 0.0) & (part <= REACH) & was.mean.any(axis=1))
    slow = int(np.count_nonzero(part[groups] <= UPTURN))
    if slow < FEWEST_SLOW or len(groups) < FEWEST:
        return unknown(NAME, '-', _what_is_needed(onsets))
    chis = _misfits(change, groups, was.of(groups), now.of(groups), model)
    evidence = f'{len(groups)} places at low speed, {slow} of them where friction turns up'
    return _best(chis, len(groups), evidence)


def onset_note(onset: Quantity, tolerance: float, sure: float) -> str:
    """
    Return in a sentence that contact begins faster than in the baseline, or ''.

    Only where the rise lies beyond a `tolerance` [-] by `sure` times the interval.

    """
    if not onset.is_known:
        return ''
    if onset.value * (onset.low / onset.value) ** sure <= 1.0 + tolerance:
        return ''
    return (
        f'contact begins at {onset.value:.2g} times the speed of the baseline ({onset.low:.2g} to '
        f'{onset.high:.2g}): the film is thinner, because oil is missing, thinner or warmer'
    )


def ran_of(points: Sequence[ComparablePoint], groups: Sequence[Group], model: Model) -> Ran:
    """Return how groups ran by points, whatever their days and surfaces."""
    number = {group: at for at, group in enumerate(groups)}
    alike = [dataclasses.replace(one, first_day=0, days=1, surface='') for one in points]
    pooled = telling(list(by_place(alike).values()), model)
    kept = [one for one in pooled if group_of(one) in number]
    weights = np.zeros((len(number), len(kept)))
    for column, one in enumerate(kept):
        weights[number[group_of(one)], column] = one.stretches
    return Ran(kept, weights / np.maximum(weights.sum(axis=1, keepdims=True), 1.0))


def _what_is_needed(onsets: Array) -> str:
    if not onsets.size:
        return 'not known: the surface does not reach the motion of these days'
    slow, far = (part * float(np.median(onsets)) / RPM for part in (UPTURN, REACH))
    return (
        f'not known yet: it needs {FEWEST_SLOW} places with a measured torque below '
        f'{slow:.3g} rev/min, where friction turns up, and {FEWEST} below {far:.3g} rev/min'
    )


def _misfits(change: Change, groups: NDArray[np.int64], was: Ran, now: Ran, model: Model) -> Array:
    """Return chi squared of both times, a row for each of `STARTS`, a column of `MOVES`."""
    friction, seen = change.friction[groups], change.change[groups]
    start = was.moved(model, STARTS)
    apart = was.mean @ model.residuals(was.points) - start
    own = np.diag(np.square(OWN_ERROR * friction)) + was.beside(model, friction)
    before = _chi(apart, own) + np.square(STARTS * STEP / SHEET_DOUBT)
    most = int(STARTS[-1] + MOVES[-1])
    table = now.moved(model, np.arange(-most, most + 1))
    end = table[STARTS[:, None] + MOVES + most]
    covariance = change.covariance[np.ix_(groups, groups)] + now.beside(model, friction)
    covariance = covariance + np.diag(np.square(PATTERN_DOUBT * seen))
    return np.asarray(before[:, None] + _chi(seen - (end - start[:, None]), covariance))


def _chi(apart: Array, covariance: Array) -> Array:
    return np.asarray(np.sum(apart @ np.linalg.inv(covariance) * apart, axis=-1))


def _best(chis: Array, groups: int, evidence: str) -> Quantity:
    """Return the ratio of least chi squared with its 95 % interval, over all of `STARTS`."""
    profile = np.where(np.isfinite(chis), chis, np.inf).min(axis=0)
    value, least = vertex(MOVES.astype(float), profile, int(np.argmin(profile)))
    within = MOVES[profile <= least + INTERVAL * birge(least, 2 * groups)]
    low, high = (float(np.exp(STEP * end)) for end in (within[0] - 0.5, within[-1] + 0.5))
    if within[0] == MOVES[0] or within[-1] == MOVES[-1] or high > WIDEST * low:
        return unknown(NAME, '-', ALIKE)
    return Quantity(name=NAME, value=math.exp(STEP * value), low=low, high=high, evidence=evidence)
