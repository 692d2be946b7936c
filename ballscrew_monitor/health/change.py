# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Change of the friction since the baseline, at equal speed, load and direction.

The surface in use adjusts what differs in speed, load and temperature within a group of places. A
day is the unit of the scatter: all of its stretches share the warmth of the machine.

"""

from collections.abc import Iterator, Sequence
import dataclasses
import functools
import itertools
import math

from ballscrew_monitor.health.bands import WEEK
from ballscrew_monitor.health.calibration import EXPECTED
from ballscrew_monitor.health.model import Model
from ballscrew_monitor.health.records import ComparablePoint, LoadSource
from ballscrew_monitor.health.scatter import (
    Group,
    group_of,
    Information,
    information_of,
    scatter_of,
    Seen,
    seen_of,
    WORTH,
)
import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
SLOPE_DOUBT = 0.03
"""
What the fitted surface may be wrong by between two temperatures, over the difference [-].

Once for all groups alike, and once for each of them.

"""
WARMTH, UNMEASURED = 0.25, 10.0
"""
Standard deviation of the temperature of the contacts over the measured one, or without [K].

That of the days comes beside it.

"""
WIPER_DRIFT, SEAL_DRIFT = 0.07, 0.2
"""
Standard deviation of the drag of a wiper over months, over that drag [-].

The constant drag, and what it has more near standstill.

"""
SCATTER_DAYS = 14
"""Days before today of which the scatter counts, beside those of the baseline."""
MOST_DOUBLINGS = 12
"""Times that a week is doubled for another look at all of the days: 80 years."""


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class Change:
    """
    Changes of groups that both the baseline and a later time have.

    `groups`, the points of their baselines and `change` [N m], positive for more drag, belong
    together; so do `friction` [N m], what was measured in the baseline, and `covariance` [N2 m2].
    `common` [-] is the change of all of them with its standard deviation, with `freedom` degrees.

    """

    groups: tuple[Group, ...]
    points: tuple[ComparablePoint, ...]
    change: Array
    friction: Array
    covariance: Array
    common: float
    deviation: float
    freedom: int
    stretches: int

    @property
    def relative(self) -> Array:
        """Return the change of each group over its friction [-]."""
        return self.change / self.friction


class Days:
    """What a baseline and the days after it tell of the friction of its groups."""

    def __init__(
        self, before: Sequence[ComparablePoint], later: Sequence[ComparablePoint], model: Model
    ) -> None:
        """Take the points of both times; groups without friction in the baseline tell nothing."""
        self._model = model
        means = mean_points(telling(before, model))
        kept = {g: one for g, one in means.items() if model.measured(one) > 0.0}
        self.groups, self.points = tuple(kept), tuple(kept.values())
        friction = np.array([model.measured(one) for one in self.points])
        self._before, self._later = (
            seen_of(points, self.groups, friction, model) for points in (before, later)
        )
        self._measured = all(one.temperature_measured for one in (*before, *later))

    @functools.cached_property
    def _information(self) -> tuple[dict[int, Information], dict[int, Information]]:
        """Return what each day tells, of the baseline and later."""
        late = self._later.where(self._later.day > self._later.day.max() - SCATTER_DAYS)
        scatter = scatter_of((self._before, late))
        first, last = (
            {int(day.day[0]): information_of(day, scatter) for day in seen.days()}
            for seen in (self._before, self._later)
        )
        return first, last

    def splits(self) -> Iterator[Change]:
        """Yield the changes of the last week, two, four and so on since all days before."""
        day = self._later.day
        lengths = [WEEK * 2**power for power in range(MOST_DOUBLINGS)] if day.size else []
        for length in lengths:
            since = int(day.max()) - length + 1
            change = self.change(since, joined=True)
            if change is not None:
                yield change
            if not (day < since).any():
                return

    def change(self, since: int, *, joined: bool = False) -> Change | None:
        """
        Return the change of the days from `since` on, None where they have no group in common.

        Before are the days of the baseline, or, if `joined`, all days before `since`.

        """
        is_now = self._later.day >= since
        now = self._later.where(is_now)
        earlier = self._later.where(~is_now & joined)
        common = np.unique(now.group)
        common = common[np.isin(common, self._before.group)]
        if not common.size:
            return None
        first, last = self._information
        days = [last[day] for day in np.unique(now.day).tolist()]
        past = [last[day] for day in np.unique(earlier.day).tolist()]
        old, old_covariance = _means([*first.values(), *past], common)
        new, new_covariance = _means(days, common)
        friction = self._before.friction[common]
        change = new - old
        covariance = old_covariance + new_covariance + self._doubt(earlier, now, common)
        weights = friction / friction.sum()
        relative = covariance / np.outer(friction, friction)
        return Change(
            groups=tuple(self.groups[at] for at in common),
            points=tuple(self.points[at] for at in common),
            change=change,
            friction=friction,
            covariance=covariance,
            common=float(weights @ (change / friction)),
            deviation=math.sqrt(float(weights @ relative @ weights)),
            freedom=len(np.unique(self._before.day)) - 1 + WORTH,
            stretches=int(now.stretches.sum()),
        )

    def _doubt(self, earlier: Seen, now: Seen, common: NDArray[np.int64]) -> Array:
        """
        Return the covariance of what groups share beside the days [N2 m2].

        What the fit leaves open between both conditions, and what may come and go: warmth of the
        contacts by another programme, drag of the wiper.

        """
        calibration = self._model.calibration
        slopes, before = (
            np.stack([one.mean(slope)[common] for slope in one.slopes.T], axis=1)
            for one in (now, self._before)
        )
        apart = slopes - before
        drag = math.hypot(calibration.values[1], EXPECTED[1])
        warmth = WARMTH if self._measured else UNMEASURED
        drifting = slopes * [0.0, WIPER_DRIFT * drag, SEAL_DRIFT * drag, warmth]
        adjusted = SLOPE_DOUBT * (
            now.mean(now.modelled) - self._before.mean(self._before.modelled)
        )
        adjusted = adjusted[common]
        fitted = apart @ np.array(calibration.covariance) @ apart.T
        alike = np.outer(adjusted, adjusted) + np.diag(adjusted**2)
        return np.asarray(fitted + drifting @ drifting.T + alike)


def change_between(
    before: Sequence[ComparablePoint], now: Sequence[ComparablePoint], model: Model
) -> Change | None:
    """Return the change from `before` to `now`, None where no group has points of both."""
    return Days(before, now, model).change(0)


def parts_of(change: Change) -> tuple[Array, Array] | None:
    """
    Return constant [N m] and rate [N m s] of the change over the speed, and their deviations.

    Weighted least squares; None where all groups have one speed.

    """
    speeds = np.array([abs(one.speed) for one in change.points])
    if np.ptp(speeds) < 0.25 * speeds.max():
        return None
    design = np.stack([np.ones_like(speeds), speeds], axis=1)
    inverse = np.linalg.inv(change.covariance)
    normal = np.linalg.inv(design.T @ inverse @ design)
    found = normal @ design.T @ inverse @ change.change
    return found, np.sqrt(np.diag(normal))


def select(change: Change, chosen: Sequence[bool]) -> tuple[float, float]:
    """Return the mean relative change of some groups with its deviation [-], NaN for none."""
    mask = np.array(chosen)
    if not mask.any():
        return math.nan, math.nan
    friction = change.friction[mask]
    weights = friction / friction.sum()
    relative = change.covariance[np.ix_(mask, mask)] / np.outer(friction, friction)
    value = float(weights @ change.relative[mask])
    return value, math.sqrt(float(weights @ relative @ weights))


def _means(days: Sequence[Information], common: NDArray[np.int64]) -> tuple[Array, Array]:
    """Return the mean residual of groups [N m] with their covariance [N2 m2]."""
    matrix, pull = (sum(parts) for parts in zip(*days))
    known = np.flatnonzero(np.diag(matrix) > 0.0)
    inverse = np.linalg.inv(matrix[np.ix_(known, known)])
    chosen = np.searchsorted(known, common)
    return (inverse @ pull[known])[chosen], inverse[np.ix_(chosen, chosen)]


def telling(points: Sequence[ComparablePoint], model: Model) -> list[ComparablePoint]:
    """Return the points that tell of friction: an independent load, within the surface."""
    free = [one for one in points if one.load_source is not LoadSource.DERIVED]
    return list(itertools.compress(free, np.isfinite(model.friction(free))))


def mean_points(points: Sequence[ComparablePoint]) -> dict[Group, ComparablePoint]:
    """Return the mean point of each group, in order."""
    found: dict[Group, list[ComparablePoint]] = {}
    for one in points:
        found.setdefault(group_of(one), []).append(one)
    return {group: _mean_point(found[group]) for group in sorted(found)}


def _mean_point(points: Sequence[ComparablePoint]) -> ComparablePoint:
    counts = [one.stretches for one in points]

    def mean(name: str) -> float:
        return float(np.average([getattr(one, name) for one in points], weights=counts))

    return dataclasses.replace(
        points[0],
        speed=mean('speed'),
        axial_load=mean('axial_load'),
        temperature=mean('temperature'),
        motor_torque=mean('motor_torque'),
        residual=math.nan,
        temperature_measured=all(one.temperature_measured for one in points),
    )
