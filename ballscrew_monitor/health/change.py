# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Change of the friction since the baseline, at equal speed, load and direction.

The surface in use adjusts what differs in speed, load and temperature within a group of places. A
day is the unit of the scatter: all of its stretches share the warmth of the machine.

"""

from collections.abc import Iterable, Sequence
import dataclasses
import math
from typing import NamedTuple

from ballscrew_monitor.health.model import Model
from ballscrew_monitor.health.records import ComparablePoint, LoadSource
import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
USUAL_SCATTER, USUAL_FREEDOM = 0.02, 4
"""Scatter between days that is expected before it is seen [-], and the days that it counts as."""
OWN_SCATTER, OWN_FREEDOM = 0.01, 10
"""The same of one group apart from the others [-], and what it counts as."""
SLOPE_DOUBT = 0.05
"""
What the fitted surface may be wrong by between two temperatures, over the difference [-].

Once for all groups alike, and once for each of them.

"""
WARMTH, UNMEASURED = 1.2, 10.0
"""Standard deviation of the temperature of the contacts over the measured one, or without [K]."""
WIPER_DRIFT = 0.1
"""Standard deviation of the drag of a wiper from weeks to weeks, over that drag [-]."""


class Group(NamedTuple):
    """Places that are compared: bands of speed and load, and the direction."""

    speed: int
    load: int
    direction: int


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class Days:
    """
    One group over some days: a mean point, its residual, and what each day had.

    `residual` and `friction` [N m] oppose the motion; `days` and `residuals` belong together;
    `spread` [N m] is the standard deviation of one stretch.

    """

    point: ComparablePoint
    residual: float
    friction: float
    days: tuple[int, ...]
    residuals: tuple[float, ...]
    stretches: int
    spread: float


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


def grouped(points: Iterable[ComparablePoint]) -> dict[Group, list[ComparablePoint]]:
    """Return the points that tell of friction, by group."""
    found: dict[Group, list[ComparablePoint]] = {}
    for point in points:
        if point.load_source is not LoadSource.DERIVED:
            place = point.place
            found.setdefault(Group(place.speed, place.load, place.direction), []).append(point)
    return found


def days_of(points: Sequence[ComparablePoint], model: Model) -> Days | None:
    """Return what a group comes to over the days of its points, None outside the surface."""
    residuals = model.residuals(points)
    known = np.isfinite(residuals)
    if not known.any():
        return None
    points = [one for one, fits in zip(points, known) if fits]
    residuals, counts = residuals[known], np.array([one.stretches for one in points])
    days = sorted({one.first_day for one in points})
    daily = [_mean(residuals, counts, [one.first_day == day for one in points]) for day in days]
    squares = sum(one.torque_squares for one in points)
    freedom = sum(one.stretches - 1 for one in points)
    point = _mean_point(points, counts)
    return Days(
        point=point,
        residual=float(np.mean(daily)),
        friction=float(np.average([model.measured(one) for one in points], weights=counts)),
        days=tuple(days),
        residuals=tuple(daily),
        stretches=int(counts.sum()),
        spread=math.sqrt(squares / freedom) if freedom else 0.0,
    )


def change_between(
    before: Sequence[ComparablePoint], now: Sequence[ComparablePoint], model: Model
) -> Change | None:
    """Return the change from `before` to `now`, None where no group has points of both."""
    pairs: dict[Group, tuple[Days, Days]] = {}
    old, new = grouped(before), grouped(now)
    for group in old.keys() & new.keys():
        first, last = days_of(old[group], model), days_of(new[group], model)
        if first and last and first.friction > 0.0:
            pairs[group] = first, last
    if not pairs:
        return None
    groups = tuple(sorted(pairs))
    firsts, lasts = zip(*(pairs[group] for group in groups))
    friction = np.array([one.friction for one in firsts])
    change = np.array([b.residual - a.residual for a, b in zip(firsts, lasts)])
    scatter, own_scatter, freedom = _scatter(firsts, friction)
    shares = _days_share(firsts) + _days_share(lasts)
    own = _own_variance(firsts, own_scatter * friction)
    own += _own_variance(lasts, own_scatter * friction)
    covariance = np.diag(own) + _doubt(model, firsts, lasts)
    covariance += scatter**2 * shares * np.outer(friction, friction)
    weights = friction / friction.sum()
    common = float(weights @ (change / friction))
    relative = covariance / np.outer(friction, friction)
    return Change(
        groups=groups,
        points=tuple(one.point for one in firsts),
        change=change,
        friction=friction,
        covariance=covariance,
        common=common,
        deviation=math.sqrt(float(weights @ relative @ weights)),
        freedom=freedom,
        stretches=sum(one.stretches for one in lasts),
    )


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


def _mean(values: Array, counts: Array, chosen: Sequence[bool]) -> float:
    mask = np.array(chosen)
    return float(np.average(values[mask], weights=counts[mask]))


def _mean_point(points: Sequence[ComparablePoint], counts: Array) -> ComparablePoint:
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


def _scatter(groups: Sequence[Days], friction: Array) -> tuple[float, float, int]:
    """
    Return the scatter between the days of a baseline [-], with the degrees of freedom.

    What all groups of a day share comes first, then what a group has beside it.

    """
    apart: dict[int, list[tuple[float, float]]] = {}
    for one, torque in zip(groups, friction):
        for day, residual in zip(one.days, one.residuals):
            apart.setdefault(day, []).append(((residual - one.residual) / torque, torque))
    daily: list[float] = []
    rest: list[float] = []
    for pairs in apart.values():
        values, weights = zip(*pairs)
        daily.append(float(np.average(values, weights=weights)))
        rest += [value - daily[-1] for value in values]
    freedom = len(daily) - 1
    squares = float(np.sum(np.square(daily))) + USUAL_FREEDOM * USUAL_SCATTER**2
    own_freedom = max(len(rest) - len(daily) - len(groups), 0)
    own_squares = float(np.sum(np.square(rest))) + OWN_FREEDOM * OWN_SCATTER**2
    common = math.sqrt(squares / (freedom + USUAL_FREEDOM))
    return common, math.sqrt(own_squares / (own_freedom + OWN_FREEDOM)), freedom + USUAL_FREEDOM


def _days_share(groups: Sequence[Days]) -> float:
    """Return one over the number of days that groups have together."""
    return 1.0 / len({day for one in groups for day in one.days})


def _own_variance(groups: Sequence[Days], scatter: Array) -> Array:
    """Return the variance of each mean that no other group shares [N2 m2], `scatter` [N m]."""
    return np.array(
        [
            one.spread**2 / one.stretches + own**2 / len(one.days)
            for one, own in zip(groups, scatter)
        ]
    )


def _doubt(model: Model, firsts: Sequence[Days], lasts: Sequence[Days]) -> Array:
    """
    Return the covariance of what groups share beside the days [N2 m2].

    What the fit leaves open between both conditions, and what may come and go: warmth of the
    contacts by another programme, drag of the wiper.

    """
    before, now = [one.point for one in firsts], [one.point for one in lasts]
    slopes = model.slopes(now)
    apart = np.nan_to_num(slopes - model.slopes(before))
    measured = all(one.temperature_measured for one in (*before, *now))
    drags = np.abs(model.calibration.values[1:3])
    drifts = np.array([0.0, *(WIPER_DRIFT * drags), WARMTH if measured else UNMEASURED])
    drifting = np.nan_to_num(slopes) * drifts
    adjusted = SLOPE_DOUBT * (model.friction(now) - model.friction(before))
    fitted = apart @ np.array(model.calibration.covariance) @ apart.T
    adjusted = np.nan_to_num(adjusted)
    alike = np.outer(adjusted, adjusted) + np.diag(adjusted**2)
    return np.asarray(fitted + drifting @ drifting.T + alike)
