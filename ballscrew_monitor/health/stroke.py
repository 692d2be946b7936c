# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Friction along the stroke, and lost motion at reversals, as cells of the summary of a log.

The stroke is cut into steps on a fixed grid, so that those of one log are those of another one.
The friction of a step is half the difference of the torques of both directions there, so that
weight and offset cancel; a table with two ways, classes of speed and load by steps, then parts
where the axis runs from how fast it does. Lost motion is the jump of the distance between motor
and table when the motion turns (ISO 230-1), backlash and wind-up under friction together.

"""

from collections.abc import Iterable
import math
from typing import Any, NamedTuple

from ballscrew_monitor.core.conversions import SECOND
from ballscrew_monitor.health.bands import day_of, load_band, speed_band
from ballscrew_monitor.health.history import two_ways
from ballscrew_monitor.health.records import Cell, CellKind, LoadSource, Stretch
from ballscrew_monitor.health.rows import has_torque_many, moves_many
import numpy as np
from numpy.typing import NDArray
from surrogate.units import TURN

Array = NDArray[np.float64]
Stamps = NDArray[np.int64]
FINEST = 0.01
"""Step of the finest grid [m]; each other one has twice the step of the one before."""
MOST_STEPS = 12
"""Steps of the travel of a log: 6 to 12, so a tenth or so."""
LONGEST_TRAVEL = 100.0
"""Travel beyond any stroke, as a turntable has [m]: such a position has no cells."""
FEWEST_SAMPLES = 3
"""Samples of a step in each direction that its friction needs."""
MOST_ROWS = 1 << 20
"""Rows that wait for their stretch; the oldest go first."""
WINDOW = SECOND // 2
"""Time before and after a reversal in which the distance is compared [ns]."""
PAUSE = 10 * SECOND
"""Longest rest at a reversal [ns]."""
TAKEN_UP = 2e-4
"""Travel from the turning point on after which the lost motion is taken up [m]."""
SKEW, NOISE = 2e-3, 1e-6
"""Prior of the time between the samples of both encoders [s], and noise of their distance [m]."""


class Positions(NamedTuple):
    """
    Positions of an axis over stamps [ns] that rise.

    By the motor [m], and by the scale of the table [m], None where there is no scale.

    """

    stamps: Stamps
    motor: Array
    table: Array | None = None

    def at(self, stamps: Stamps) -> tuple[Array, Array]:
        """Return both at some stamps, NaN where no sample is of just that time."""
        places = np.minimum(np.searchsorted(self.stamps, stamps), len(self.stamps) - 1)
        same = self.stamps[places] == stamps
        table = math.nan if self.table is None else self.table[places]
        return np.where(same, self.motor[places], math.nan), np.where(same, table, math.nan)


class StrokeSums:
    """Sums of torque and time along the stroke, from the samples of the steady stretches."""

    def __init__(self) -> None:
        self._waiting = np.zeros((0, 2)), np.zeros(0, np.int64)
        self._sums: dict[tuple[int, int, int, int], Array] = {}
        self._warmth = np.zeros(2)
        self._measured = True

    def add(self, stamps: Stamps, position: Array, torque: Array) -> None:
        """Take samples of motion in their order: stamps [ns], position [m], torque [N m]."""
        known = np.isfinite(position) & np.isfinite(torque)
        values, before = self._waiting
        rows = np.column_stack([position[known], torque[known]])
        self._waiting = (
            np.concatenate([values, rows])[-MOST_ROWS:],
            np.concatenate([before, stamps[known]])[-MOST_ROWS:],
        )

    def take(self, stretches: Iterable[Stretch]) -> None:
        """Count the samples of stretches that have ended, in their order."""
        values, stamps = self._waiting
        last = 0
        for stretch in (each for each in stretches if each.speed != 0.0):
            end = stretch.start + round(stretch.duration * SECOND)
            first, last = np.searchsorted(stamps, [stretch.start, end])
            if last > first:
                self._count(stretch, values[first:last])
        self._waiting = values[last:], stamps[last:]

    def _count(self, stretch: Stretch, samples: Array) -> None:
        derived = stretch.load_source == LoadSource.DERIVED
        band = 0 if derived else load_band(stretch.axial_load)
        place = speed_band(abs(stretch.speed)), band, (1 if stretch.speed > 0.0 else -1)
        steps, at = np.unique(np.floor(samples[:, 0] / FINEST).astype(int), return_inverse=True)
        count = np.bincount(at)
        sums = np.column_stack([count, np.bincount(at, samples[:, 1])])
        sums = np.column_stack([sums, count * stretch.duration / len(samples)])
        for step, row in zip(steps.tolist(), sums, strict=True):
            key = (*place, step)
            self._sums[key] = self._sums.get(key, 0.0) + row
        self._warmth += stretch.duration * np.array([1.0, stretch.temperature])
        self._measured &= stretch.temperature_measured

    def cells(self, start: int) -> list[Cell]:
        """Return a cell for each step of the stroke of the log that begins at `start` [ns]."""
        steps = [key[3] for key in self._sums]
        if not steps or (max(steps) - min(steps)) * FINEST > LONGEST_TRAVEL:
            return []
        level = level_of(min(steps), max(steps))
        friction, time = _table(self._sums, level)
        seen = time > 0.0
        if seen.sum() < 2:
            return []
        logs = np.log(np.where(seen, friction, 1.0))
        classes, along = two_ways(logs.T, time.T)
        weight = time.sum(axis=1)
        usual = float(classes @ time.sum(axis=0) / weight.sum())
        temperature = self._warmth[1] / self._warmth[0]
        return [
            Cell(
                start=start,
                first_day=day_of(start),
                kind=CellKind.STROKE,
                speed_band=(min(steps) >> level) + at,
                load_band=level,
                temperature_measured=self._measured,
                stretches=int((seen[at]).sum()),
                duration=float(weight[at]),
                temperature=float(temperature),
                motor_torque=math.exp(usual + along[at]),
            )
            for at in np.flatnonzero(weight > 0.0).tolist()
        ]


def level_of(first: int, last: int) -> int:
    """Return the finest grid on which two steps of the finest one are less than 12 steps apart."""
    level = 0
    while (last >> level) - (first >> level) >= MOST_STEPS:
        level += 1
    return level


def span_of(step: int, level: int) -> tuple[float, float]:
    """Return begin and end [m] of a step of a grid."""
    width = FINEST * 2.0**level
    return step * width, (step + 1) * width


def _table(sums: dict[tuple[int, int, int, int], Array], level: int) -> tuple[Array, Array]:
    """Return the friction [N m] of steps by classes, and its time [s], 0 where not known."""
    first = min(key[3] for key in sums) >> level
    classes = sorted({key[:2] for key in sums})
    count = (max(key[3] for key in sums) >> level) - first + 1
    total = np.zeros((2, count, len(classes), 3))
    for (speed, load, way, step), row in sums.items():
        total[int(way > 0), (step >> level) - first, classes.index((speed, load))] += row
    both = (total[..., 0] >= FEWEST_SAMPLES).all(axis=0)
    back, forth = total[..., 1] / np.maximum(total[..., 0], 1.0)
    friction = 0.5 * (forth - back)
    good = both & (friction > 0.0)
    return np.where(good, friction, 0.0), np.where(good, total[..., 2].min(axis=0), 0.0)


class ReversalSums:
    """
    Lost motion from the distance between motor and table about reversals.

    Within each reversal, distance = constant + sense of motion x lost motion / 2 + skew x speed,
    by least squares over all of them; the speed takes what the encoders are sampled apart.

    """

    def __init__(self) -> None:
        self._rows = np.zeros((0, 3)), np.zeros(0, np.int64)
        self._normal, self._pull, self._count = np.zeros((2, 2)), np.zeros(2), 0

    def add(self, stamps: Stamps, speed: Array, motor: Array, table: Array) -> None:
        """Take samples of motion: stamps [ns], speed of the table [m/s], both positions [m]."""
        known = np.isfinite(motor) & np.isfinite(table) & (speed != 0.0)
        values, before = self._rows
        rows = np.concatenate([values, np.column_stack([speed, motor, motor - table])[known]])
        stamps = np.concatenate([before, stamps[known]])
        turns = (np.flatnonzero(np.diff(np.sign(rows[:, 0])) != 0) + 1).tolist()
        bounds, keep, oldest = [0, *turns, len(stamps)], 0, stamps[-1:]
        for begin, turn, end in zip(bounds, turns, bounds[2:], strict=False):
            keep = begin
            if end == len(stamps) and stamps[-1] - stamps[turn] < WINDOW:
                earlier = turn - 1
                oldest = stamps[earlier:turn]  # this reversal waits for its end
                break
            self._take(stamps, rows, begin, turn, end)
            keep = turn
        keep = max(keep, *np.searchsorted(stamps, oldest - WINDOW).tolist(), 0)
        self._rows = rows[keep:], stamps[keep:]

    def _take(self, stamps: Stamps, rows: Array, begin: int, turn: int, end: int) -> None:
        """Count a reversal at the row `turn` between the rows of two motions."""
        if stamps[turn] - stamps[turn - 1] > PAUSE:
            return
        first = max(begin, int(np.searchsorted(stamps, stamps[turn - 1] - WINDOW)))
        last = min(end, int(np.searchsorted(stamps, stamps[turn] + WINDOW, 'right')))
        near, before = rows[first:last], np.arange(first, last) < turn
        sense = np.sign(near[:, 0])
        extreme = np.max(near[:, 1] * sense[0]) * sense[0]
        clear = np.abs(near[:, 1] - extreme) > TAKEN_UP
        if min((clear & before).sum(), (clear & ~before).sum()) < FEWEST_SAMPLES:
            return
        design = np.column_stack([0.5 * sense, near[:, 0]])[clear]
        distance = near[clear, 2]
        design = design - design.mean(axis=0)
        self._normal += design.T @ design
        self._pull += design.T @ (distance - distance.mean())
        self._count += 1

    def cells(self, start: int) -> list[Cell]:
        """Return the cell of the lost motion of a log, none without a reversal."""
        if not self._count:
            return []
        prior = np.diag([0.0, (NOISE / SKEW) ** 2])
        lost = float(np.linalg.solve(self._normal + prior, self._pull)[0])
        return [
            Cell(
                start=start,
                first_day=day_of(start),
                kind=CellKind.REVERSAL,
                stretches=self._count,
                duration=float(self._count),
                backlash=lost,
            )
        ]


def motion_of(rows: NDArray[Any], lead: float) -> tuple[Stamps, Array, Array]:
    """
    Return the samples of motion among rows (an array of ROW); lead [m].

    Stamps [ns], speed of the table [m/s], measured torque [N m] or NaN.

    """
    moving = rows[moves_many(rows) & np.isfinite(rows['speed'])]
    torque = np.where(has_torque_many(moving), moving['motor_torque'], math.nan)
    return moving['stamp'].copy(), moving['speed'] * lead / TURN, torque
