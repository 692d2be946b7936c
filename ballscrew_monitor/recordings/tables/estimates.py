# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Estimates from the numbers of a log: rate, units of time and speeds, constant columns."""

from collections.abc import Mapping, Sequence
import math

from ballscrew_monitor.core.conversions import LINEAR_POSITION_UNITS, LINEAR_SPEED_UNITS
from ballscrew_monitor.recordings.tables.cells import Array
from ballscrew_monitor.recordings.tables.quantities import EPOCHS, SCALES
import numpy as np

LONG = 3.0  # times the usual time between rows: across more nothing is known
NEAR = 0.05  # part by which a speed may miss what its position says
FAST = 2.0  # [m/s] no feed axis moves faster
FASTEST = 2000.0  # in mm/s, the same
UNIVERSAL = (946_684_800.0, 2_147_483_648.0)  # [s] of the universal clock: 2000 to 2038
DAY = 86400.0  # [s]
SLOWEST = 0.5  # [Hz] of a plausible log
RARE, SHORTEST = 0.01, 0.95e-5  # [Hz] of the slowest, and [s] between rows of the fastest
FINEST = 1e-5  # of seconds that are written; of days it would be 0.9 s
ALIKE = 0.8  # squared correlation of a motion and its speed
LONGEST_AXIS = 20.0  # [m]
FEW = 8  # rows that tell no way of a speed
STRETCHES = 2000  # of a motion, at least, that tell how far a speed goes
FEWEST_STRETCHES = 24  # of a short motion
TOGETHER = 8  # rows of a stretch, at least, whose stamps may be rounded
ROUNDED = 1e-3  # of a turn, by which a scale of few digits goes beyond one
FULL = frozenset(
    round(count * part, 9)
    for part in (1.0, 0.1, 0.01, 1e-3)
    for count in (*(10**digits - 1 for digits in range(3, 8)), *(2**15 - 1, 2**15, 2**16 - 1))
)
"""Amounts that a control writes for no value: all digits 9, or a full integer, and parts of it."""
LARGE, LEAP = 100.0, 10.0  # of such an amount near others, and of its steps times usual ones
HELD, FAR, MOST_HELD = 3, 3.0, 0.2  # rows of such an amount, times all others, part of all rows


def marks_of_none(values: Array) -> tuple[float, ...]:
    """Return the values by which rows are marked that hold none: full, and far from all others."""
    left = known = values[np.isfinite(values)]
    full: set[float] = set()
    while len(left) and (
        outer := {
            value
            for value in (float(left.min()), float(left.max()))
            if round(abs(value), 9) in FULL
            and HELD <= np.count_nonzero(left == value) <= MOST_HELD * len(known)
        }
    ):
        full |= outer
        left = left[~np.isin(left, [*outer])]
    return tuple(
        value
        for value in sorted(full)
        if np.all(np.abs(left) < abs(value) / FAR)
        or _leaps(known[~np.isin(known, [*(full - {value})])], value)
    )


def usual_step(times: Array) -> float:
    """Return the usual step between times that differ, 0 if none do."""
    steps = np.diff(times[np.isfinite(times)])
    return float(np.median(steps[steps > 0.0])) if (steps > 0.0).any() else 0.0


def counts_rows(values: Array) -> bool:
    """Return True if values are whole numbers that count the rows."""
    whole = len(values) > 1 and bool((values == np.floor(values)).all())
    return whole and bool((np.diff(values) == 1.0).all())


def _leaps(values: Array, value: float) -> bool:
    """Return True if a large value is reached and left in steps far above those of the others."""
    steps, held = np.abs(np.diff(values)), values == value
    edges = held[1:] != held[:-1]
    usual = float(np.quantile(steps[~edges], 0.9)) if not edges.all() else math.inf
    return abs(value) >= LARGE and bool(np.all(steps[edges] > LEAP * usual)) and edges.any()


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
    step = across / along if along > 0.0 else math.nan
    return step if 0.0 < step < math.inf else math.nan


def largest_speed_unit(largest: float) -> tuple[str, str]:
    """Return the linear unit of speeds up to a largest amount [-] and why it is that."""
    if largest <= FAST:
        return 'm/s', f'its largest amount is {largest:.3g}'
    if largest <= FASTEST:
        return 'mm/s', f'its largest amount is {largest:.3g}, more than a feed axis does in m/s'
    return 'mm/min', f'its largest amount is {largest:.3g}, more than a feed axis does in mm/s'


def way_per_speed(position: tuple[Array, Array], speed: tuple[Array, Array]) -> float:
    """
    Return how far an axis moves for a unit and second of its speed, NaN if both are not alike.

    It is below 0 where both have other signs. Places and speeds [-] each stand behind their times
    [s], of which the longest run counts. Least squares over some thousand stretches without a gap,
    for which the speed is integrated by the trapezoidal rule.

    """
    times, places = _longest_run(*position)
    seconds, speeds = _longest_run(*speed)
    if min(len(places), len(speeds)) < FEW:
        return math.nan
    every = max(len(places) // STRETCHES, min(len(places) // FEWEST_STRETCHES, TOGETHER), 1)
    ways = np.append(0.0, np.cumsum((speeds[1:] + speeds[:-1]) / 2 * np.diff(seconds)))
    times, places = times[::every], places[::every]
    steps, moved = np.diff(times), np.diff(places)
    expected = np.diff(np.interp(times, seconds, ways))
    within = (times[:-1] >= seconds[0]) & (times[1:] <= seconds[-1])
    good = within & (steps <= LONG * np.median(steps))
    moved, expected = moved[good], expected[good]
    with np.errstate(over='ignore', invalid='ignore'):
        across, along = float(moved @ expected), float(expected @ expected)
        both = math.sqrt(along) * math.sqrt(float(moved @ moved))
    if not 0.0 < both < math.inf or abs(across) < math.sqrt(ALIKE) * both:
        return math.nan
    return across / along


def _longest_run(times: Array, values: Array) -> tuple[Array, Array]:
    """Return the most known values in a row whose times do not begin again, with these."""
    known = np.isfinite(times) & np.isfinite(values)
    times, values = times[known], values[known]
    ends = np.array([0, *(np.flatnonzero(np.diff(times) < 0.0) + 1), len(times)])
    longest = int(np.argmax(np.diff(ends)))
    run = slice(ends[longest], ends[longest + 1])
    return times[run], values[run]


def unit_by_factor(factor: float, units: Mapping[str, float]) -> str:
    """Return the unit that a factor is near to, empty if it is near to none."""
    return next((unit for unit, one in units.items() if abs(factor / one - 1.0) < NEAR), '')


class Turns:
    """Positions within one turn made to go on where they begin again: the shorter way is taken."""

    def __init__(self, turn: float) -> None:
        """Begin with the first row; a turn is so long in the unit of the positions."""
        self._turn, self._last = turn, np.zeros(0)

    def counted(self, positions: Array) -> Array:
        """Return further positions with their whole turns, NaN where they are."""
        known = np.isfinite(positions)
        every = np.unwrap(np.append(self._last, positions[known]), period=self._turn)
        counted = positions.copy()
        before, self._last = len(self._last), every[-1:]
        counted[known] = every[before:]
        return counted


def is_within_turn(extremes: Array, turn: float) -> bool:
    """Return True if the least and the most of positions are those of a scale of one turn."""
    return turn / 2 < float(np.ptp(extremes)) <= turn * (1.0 + ROUNDED)


def position_unit(position: Array) -> tuple[str, str]:
    """Return the linear unit of a position and why it is that."""
    largest = float(np.nanmax(np.abs(position)))
    if largest <= FAST:
        return 'm', f'its largest amount is {largest:.3g}'
    return 'mm', f'its largest amount is {largest:.3g}, more than a feed axis has in m'


def epoch_units(values: Array) -> list[str]:
    """
    Return the units in which times [-] may begin between 2000 and 2038, at a rate of a log.

    Days have more digits than seconds of a day, such as 45852.001.

    """
    step = float(np.median(np.diff(values)))
    digits = values / FINEST
    are_seconds = bool(np.allclose(digits, np.round(digits), rtol=0.0, atol=1e-3))
    return [
        unit
        for unit in ('s', 'ms', 'us', 'ns', *EPOCHS)
        if is_universal(values, unit)
        and SHORTEST <= step * SCALES[unit][0] <= 1.0 / RARE
        and not (are_seconds and SCALES[unit][0] == DAY)
    ]


def is_universal(values: Array, unit: str) -> bool:
    """Return True if the first of times in a unit may be one of the universal clock."""
    factor, shift = SCALES[unit]
    return UNIVERSAL[0] <= float(values[0]) * factor + shift < UNIVERSAL[1]


def unit_by_period(step: float, period: float) -> str:
    """Return the unit of times a step apart of which the period [s] is known, else nothing."""
    return next(
        (
            unit
            for unit in ('s', 'ms', 'us', 'ns')
            if abs(step * SCALES[unit][0] / period - 1) < NEAR
        ),
        '',
    )


def unit_by_motion(
    times: Array, position: Array, speed: Array, *, places: Sequence[str], speeds: Sequence[str]
) -> str:
    """
    Return the only unit of times [-] in which a position [-] is the integral of its speed [-].

    `places` and `speeds` are the units that these may have: no feed axis is longer than 20 m or
    faster than 2 m/s. Empty where several units fit, or none.

    """
    mean, moved = (speed[1:] + speed[:-1]) / 2 * np.diff(times), np.diff(position)
    good = np.isfinite(mean) & np.isfinite(moved)
    across, along = float(moved[good] @ mean[good]), float(mean[good] @ mean[good])
    if not across > 0.0 or across * across < ALIKE * along * float(moved[good] @ moved[good]):
        return ''
    fits = {
        unit
        for unit in ('s', 'ms', 'us', 'ns')
        for place in places
        for fast in speeds
        if float(np.ptp(position[good.nonzero()[0]])) * LINEAR_POSITION_UNITS[place] < LONGEST_AXIS
        and float(np.nanmax(np.abs(speed))) * LINEAR_SPEED_UNITS[fast] <= FAST
        and abs(
            across
            / along
            * LINEAR_POSITION_UNITS[place]
            / (LINEAR_SPEED_UNITS[fast] * SCALES[unit][0])
            - 1.0
        )
        < NEAR
    }
    return fits.pop() if len(fits) == 1 else ''


def is_of_days(extremes: Array) -> bool:
    """Tell whether the least and the most of times [s] are begins of days by the calendar."""
    return bool((extremes > UNIVERSAL[0]).all() and not (extremes % DAY).any())


def is_of_a_day(extremes: Array) -> bool:
    """Tell whether the least and the most of times [s] are those of one day."""
    return bool((extremes >= 0.0).all() and (extremes <= DAY).all())


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


def oddities(name: str, speed: Array, unit: str, factors: Mapping[str, float]) -> list[str]:
    """Return what is odd about a linear speed: none at all, or more [m/s] than axes do."""
    if is_silent(speed):
        return [f'axis {name} never moves: its speed is always 0']
    largest = float(np.nanmax(np.abs(speed))) * factors.get(unit, 0.0)
    if largest > FAST:
        return [f'axis {name} moves at up to {largest:.3g} m/s: is its speed in {unit}?']
    return []
