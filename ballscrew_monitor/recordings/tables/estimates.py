# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Estimates from the numbers of a log: rate, units of time and speeds, constant columns."""

from collections.abc import Mapping, Sequence
import math

from ballscrew_monitor.core.conversions import LINEAR_SPEED_UNITS, TIME_UNITS
import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

NEAR = 0.05  # part by which a speed may miss what its position says
FAST = 2.0  # [m/s] no feed axis moves faster
FASTEST = 2000.0  # in mm/s, the same
UNIVERSAL = (946_684_800.0, 4_102_444_800.0)  # [s] of the universal clock: 2000 to 2100
DAY = 86400.0  # [s]
SLOWEST = 0.5  # [Hz] of a plausible log
FACTOR = 1.5  # by which a place and its speed may disagree


def is_silent(values: Array) -> bool:
    """Tell whether there is nothing but zeros."""
    return not np.nan_to_num(values).any()


def period(motions: Sequence[tuple[Array, Array]]) -> float:
    """
    Return the time between rows [s] for which places are the integrals of their speeds, NaN: none.

    Each motion is positions [m] and speeds [m/s] of an axis; all are fitted as one by least
    squares, so that fast motion counts and noise at rest does not.

    """
    across = along = 0.0
    for position, speed in motions:
        mean, moved = (speed[1:] + speed[:-1]) / 2, np.diff(position)
        good = np.isfinite(mean) & np.isfinite(moved)
        across += float(moved[good] @ mean[good])
        along += float(mean[good] @ mean[good])
    return across / along if across > 0.0 and along > 0.0 else math.nan


def speed_unit(speeds: Array, motion: tuple[Array, Array] | None, step: float) -> tuple[str, str]:
    """
    Return the linear unit of speeds and why it is that.

    A motion, positions [m] and such speeds a `step` [s] apart, decides if it is known; else the
    largest amount does.

    """
    if motion is not None and math.isfinite(step):
        position, speed = motion
        for unit, factor in LINEAR_SPEED_UNITS.items():
            found = period([(position, speed * factor)])
            if step / FACTOR < found < step * FACTOR:
                return unit, 'it agrees with the position over time'
    largest = float(np.nanmax(np.abs(speeds)))
    if largest <= FAST:
        return 'm/s', f'its largest amount is {largest:.3g}'
    if largest <= FASTEST:
        return 'mm/s', f'its largest amount is {largest:.3g}, more than a feed axis does in m/s'
    return 'mm/min', f'its largest amount is {largest:.3g}, more than a feed axis does in mm/s'


def position_unit(position: Array) -> tuple[str, str]:
    """Return the linear unit of a position and why it is that."""
    largest = float(np.nanmax(np.abs(position)))
    if largest <= FAST:
        return 'm', f'its largest amount is {largest:.3g}'
    return 'mm', f'its largest amount is {largest:.3g}, more than a feed axis has in m'


def time_unit(values: Array) -> str:
    """
    Return the unit of times that none is stated for, empty where they may be of any.

    It is known of the universal clock alone.

    """
    step = float(np.median(np.diff(values)))
    for unit in ('s', 'ms', 'us', 'ns'):
        if is_universal(values, unit) and step * TIME_UNITS[unit] <= 1.0 / SLOWEST:
            return unit
    return ''


def is_universal(values: Array, unit: str) -> bool:
    """Return True if the first of times in a unit may be one of the universal clock."""
    return UNIVERSAL[0] <= float(values[0]) * TIME_UNITS[unit] < UNIVERSAL[1]


def is_of_days(extremes: Array) -> bool:
    """Tell whether the least and the most of times [s] are begins of days by the calendar."""
    return bool((extremes > UNIVERSAL[0]).all() and not (extremes % DAY).any())


def is_of_a_day(extremes: Array) -> bool:
    """Tell whether the least and the most of times [s] are those of one day."""
    return bool((extremes >= 0.0).all() and (extremes < DAY).all())


class Midnights:
    """
    Times of a day [s] made to go on through midnight, where they begin again.

    A fall of more than half a day is midnight, a rise of as much a row that comes late after it.

    """

    def __init__(self) -> None:
        """Begin on the day of the first row."""
        self._last, self._day = math.nan, 0

    def passed(self, times: Array) -> Array:
        """Return further times since the first midnight [s], NaN where one is."""
        known = np.isfinite(times)
        steps = np.diff(times[known], prepend=self._last)
        days = np.full(len(steps), self._day)
        for at in np.flatnonzero(np.abs(steps) > DAY / 2):
            self._day = self._day + 1 if steps[at] < 0.0 else max(self._day - 1, 0)
            days[at:] = self._day
        self._last = times[known][-1] if known.any() else self._last
        made = times.copy()
        made[known] += DAY * days
        return made


def is_rising(values: Array) -> bool:
    """Tell whether values can be times: they rise, but for a few."""
    steps = np.diff(values[np.isfinite(values)])
    return bool(len(steps) and np.mean(steps >= 0.0) > 0.9 and steps.sum() > 0.0)


def oddities(name: str, speed: Array, unit: str, factors: Mapping[str, float]) -> list[str]:
    """Return what is odd about a linear speed: none at all, or more [m/s] than axes do."""
    if is_silent(speed):
        return [f'axis {name} never moves: its speed is always 0']
    largest = float(np.nanmax(np.abs(speed))) * factors.get(unit, 0.0)
    if largest > FAST:
        return [f'axis {name} moves at up to {largest:.3g} m/s: is its speed in {unit}?']
    return []
