# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Means of groups of places over days, with the scatter that days bring.

All groups of a day share how it differs from others, and the warmth of the contacts of that day;
each group has a scatter of its own beside it. The means are those of generalised least squares, so
that groups of different days are compared as far as the days allow.

"""

from collections.abc import Sequence
import dataclasses
from typing import NamedTuple

from ballscrew_monitor.health.model import Model
from ballscrew_monitor.health.records import ComparablePoint, LoadSource
import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Numbers = NDArray[np.int64]
ROUNDS = 5


class Group(NamedTuple):
    """Places that are compared: bands of speed and load, and the direction."""

    speed: int
    load: int
    direction: int


class Scatter(NamedTuple):
    """
    Standard deviations between days: what groups share, and what each has of its own [-].

    Both are over the friction; `warmth` [K] is that of the contacts over the measured temperature.

    """

    common: float
    warmth: float
    own: float


USUAL = Scatter(common=0.012, warmth=0.5, own=0.01)
"""What is expected before it is seen."""
WORTH, OWN_WORTH = 4, 10
"""Days, and days of groups, that the expected scatter counts as."""


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class Seen:
    """
    Groups over days: an entry for each day of each group.

    An entry has the number of its `group`, the `day`, its `stretches`, and in means over them the
    `residual` and the `modelled` friction [N m] against the motion, the variance `noise` [N2 m2]
    of the residual by the scatter of stretches, and the `slopes` of the calibration. `friction`
    [N m] is that of each group.

    """

    friction: Array
    group: Numbers
    day: Numbers
    stretches: Array
    residual: Array
    modelled: Array
    noise: Array
    slopes: Array

    def where(self, chosen: NDArray[np.bool_]) -> 'Seen':
        """Return some of the entries."""
        names = (one.name for one in dataclasses.fields(self) if one.name != 'friction')
        return dataclasses.replace(self, **{name: getattr(self, name)[chosen] for name in names})

    def days(self) -> list['Seen']:
        """Return the entries of each day."""
        return [self.where(self.day == day) for day in np.unique(self.day)]

    def mean(self, values: Array) -> Array:
        """Return the mean of values of entries, by group; NaN for groups without an entry."""
        total = np.bincount(self.group, self.stretches, len(self.friction))
        with np.errstate(invalid='ignore'):
            return np.asarray(
                np.bincount(self.group, self.stretches * values, len(self.friction)) / total
            )


def group_of(point: ComparablePoint) -> Group:
    """Return the group of a point."""
    return Group(point.place.speed, point.place.load, point.place.direction)


def seen_of(
    points: Sequence[ComparablePoint], groups: Sequence[Group], friction: Array, model: Model
) -> Seen:
    """Return the days of groups with a `friction` [N m] from those points that tell of it."""
    number = {group: at for at, group in enumerate(groups)}
    free = [one for one in points if one.load_source is not LoadSource.DERIVED]
    points = [one for one in free if group_of(one) in number]
    slopes = model.slopes(points)
    known = np.flatnonzero(np.isfinite(slopes).all(axis=1))
    points, slopes = [points[at] for at in known], slopes[known]
    modelled = slopes[:, :3] @ model.calibration.values[:3]
    residual = np.array([model.measured(one) for one in points]) - modelled
    kinds = np.array([number[group_of(one)] for one in points], dtype=np.int64)
    keys = np.stack([kinds, np.array([one.first_day for one in points], dtype=np.int64)], axis=1)
    unique, entry = np.unique(keys, axis=0, return_inverse=True)
    entry, group = entry.ravel(), unique[:, 0]
    counts = np.array([float(one.stretches) for one in points])
    stretches = np.bincount(entry, counts).astype(float)

    def mean(values: Array) -> Array:
        return np.asarray(np.bincount(entry, counts * values) / stretches)

    squares = np.bincount(kinds, [one.torque_squares for one in points], len(groups))
    spread = squares / np.maximum(np.bincount(kinds, counts - 1.0, len(groups)), 1.0)
    return Seen(
        friction=friction,
        group=group,
        day=unique[:, 1],
        stretches=stretches,
        residual=mean(residual),
        modelled=mean(modelled),
        noise=spread[group] / stretches,
        slopes=np.stack([mean(one) for one in slopes.T], axis=1),
    )


class Information(NamedTuple):
    """What days tell of the mean residual of each group: inverse covariance, and its product."""

    matrix: Array
    pull: Array


def information_of(day: Seen, scatter: Scatter) -> Information:
    """Return what a day tells of the means of the groups; it adds up over days."""
    size = len(day.friction)
    matrix, pull = np.zeros((size, size)), np.zeros(size)
    inverse = np.linalg.inv(_covariance(day, scatter))
    matrix[np.ix_(day.group, day.group)] = inverse
    pull[day.group] = inverse @ day.residual
    return Information(matrix, pull)


def scatter_of(periods: Sequence[Seen]) -> Scatter:
    """
    Return the scatter between the days of each of some periods.

    By expectation and maximisation (Laird and Ware 1982), with what is expected before.

    """
    usual, worth = np.square(USUAL), np.array([WORTH, WORTH, OWN_WORTH])
    entries = sum(len(seen.group) for seen in periods)
    spare = entries - sum(len(np.unique(seen.group)) for seen in periods)
    found, days = USUAL, [seen.days() for seen in periods]
    for _ in range(ROUNDS):
        total = sum((_squares(one, found) for one in days), np.zeros((2, 3)))
        total[0, 2] *= entries / max(spare, 1)
        squares = (total[0] + worth * usual) / (total[1] + worth)
        found = Scatter(*np.sqrt(squares).tolist())
    return found


def _squares(days: Sequence[Seen], scatter: Scatter) -> Array:
    """Return the expected squares of the three parts of the scatter, and their counts."""
    known = [information_of(day, scatter) for day in days]
    matrix, pull = (np.sum(parts, axis=0) for parts in zip(*known))
    mean = np.linalg.lstsq(matrix, pull, rcond=None)[0]
    return np.asarray(np.sum([_squares_of(day, scatter, mean) for day in days], axis=0))


def _squares_of(day: Seen, scatter: Scatter, mean: Array) -> Array:
    torque = day.friction[day.group]
    shared = np.stack([torque, day.slopes[:, 3]], axis=1)
    own = (scatter.own * torque) ** 2
    sure = 1.0 / (own + day.noise)
    normal = (shared.T * sure) @ shared + np.diag([scatter.common**-2.0, scatter.warmth**-2.0])
    left = np.linalg.inv(normal)
    apart = day.residual - mean[day.group]
    effect = left @ (shared.T @ (sure * apart))
    rest = (apart - shared @ effect) ** 2 + np.einsum('ij,jk,ik->i', shared, left, shared)
    part = own * sure
    squares = effect**2 + np.diag(left)
    own_square = scatter.own**2 * float(np.sum(part * sure * rest))
    return np.array([[*squares, own_square], [1.0, 1.0, float(part.sum())]])


def _covariance(day: Seen, scatter: Scatter) -> Array:
    torque, slope = day.friction[day.group], day.slopes[:, 3]
    own = np.diag(day.noise + (scatter.own * torque) ** 2)
    shared = scatter.common**2 * np.outer(torque, torque)
    return np.asarray(own + shared + scatter.warmth**2 * np.outer(slope, slope))
