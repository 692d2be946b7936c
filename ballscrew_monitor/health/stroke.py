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
from typing import NamedTuple

from ballscrew_monitor.core.conversions import SECOND
from ballscrew_monitor.health.bands import day_of, load_band, speed_band
from ballscrew_monitor.health.history import two_ways
from ballscrew_monitor.health.records import Cell, CellKind, LoadSource, Stretch
import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Stamps = NDArray[np.int64]
FINEST = 0.01  # step of the finest grid [m]; each other one has twice the step of that before
MOST_STEPS = 12  # of the travel of a log: 6 to 12, so a tenth or so
LONGEST_TRAVEL = 100.0  # beyond any stroke, as a turntable has [m]: such a position has no cells
FEWEST_SAMPLES = 3  # of a step in each direction that its friction needs
WINDOW = SECOND // 2  # before and after a reversal in which the distance is compared [ns]
PAUSE = 10 * SECOND  # longest rest at a reversal [ns]
TAKEN_UP = 2e-4  # travel from the turning point on after which the lost motion is taken up [m]
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


def stroke_cells(
    stamps: Stamps, position: Array, torque: Array, stretches: Iterable[Stretch], start: int
) -> list[Cell]:
    """
    Return a cell for each step of the stroke of a log, by the samples of its steady stretches.

    Samples of motion in their order: stamps [ns], position [m], torque [N m], NaN where unknown;
    the log begins at `start` [ns].

    """
    known = np.isfinite(position) & np.isfinite(torque)
    stamps, position, torque = stamps[known], position[known], torque[known]
    sums: dict[tuple[int, int, int, int], Array] = {}
    warmth, measured = np.zeros(2), True
    for stretch in (stretch for stretch in stretches if stretch.speed != 0.0):
        end = stretch.start + round(stretch.duration * SECOND)
        part = slice(*np.searchsorted(stamps, [stretch.start, end]).tolist())
        if part.stop <= part.start:
            continue
        derived = stretch.load_source == LoadSource.DERIVED
        band = 0 if derived else load_band(stretch.axial_load)
        place = speed_band(abs(stretch.speed)), band, int(stretch.speed > 0.0)
        steps, at = np.unique(np.floor(position[part] / FINEST).astype(int), return_inverse=True)
        count = np.bincount(at)
        time = count * stretch.duration / len(at)
        rows = np.column_stack([count, np.bincount(at, torque[part]), time])
        for step, row in zip(steps.tolist(), rows, strict=True):
            sums[*place, step] = sums.get((*place, step), 0.0) + row
        warmth += stretch.duration * np.array([1.0, stretch.temperature])
        measured &= stretch.temperature_measured
    steps_seen = [key[3] for key in sums]
    if not sums or (max(steps_seen) - min(steps_seen)) * FINEST > LONGEST_TRAVEL:
        return []
    level = level_of(min(steps_seen), max(steps_seen))
    first, last = min(steps_seen) >> level, max(steps_seen) >> level
    friction, time = _by_step(sums, level, first, last)
    seen, weight = time > 0.0, time.sum(axis=1)
    if seen.sum() < 2:
        return []
    classes, along = two_ways(np.log(np.where(seen, friction, 1.0)).T, time.T)
    usual = float(classes @ time.sum(axis=0) / weight.sum())
    return [
        Cell(
            start=start,
            first_day=day_of(start),
            kind=CellKind.STROKE,
            speed_band=first + at,
            load_band=level,
            temperature_measured=measured,
            stretches=int((seen[at]).sum()),
            duration=float(weight[at]),
            temperature=float(warmth[1] / warmth[0]),
            motor_torque=math.exp(usual + along[at]),
        )
        for at in np.flatnonzero(weight > 0.0).tolist()
    ]


def _by_step(
    sums: dict[tuple[int, int, int, int], Array], level: int, first: int, last: int
) -> tuple[Array, Array]:
    """Return the friction [N m] of steps by classes, and its time [s], 0 where not known."""
    classes = sorted({key[:2] for key in sums})
    total = np.zeros((2, last - first + 1, len(classes), 3))
    for (speed, load, forth, step), row in sums.items():
        total[forth, (step >> level) - first, classes.index((speed, load))] += row
    torques = total[..., 1] / np.maximum(total[..., 0], 1.0)
    friction = 0.5 * (torques[1] - torques[0])
    seen = (total[..., 0] >= FEWEST_SAMPLES).all(axis=0) & (friction > 0.0)
    return friction, np.where(seen, total[..., 2].min(axis=0), 0.0)


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


def reversal_cells(
    stamps: Stamps, speed: Array, motor: Array, table: Array, start: int
) -> list[Cell]:
    """
    Return the cell of the lost motion of a log that begins at `start` [ns], none without it.

    Samples of motion in their order: stamps [ns], speed of the table [m/s], both positions [m].
    Within each reversal, distance = constant + sense of motion x lost motion / 2 + skew x speed,
    by least squares over all of them; the speed takes what the encoders are sampled apart.

    """
    known = np.isfinite(motor) & np.isfinite(table) & (speed != 0.0)
    stamps, speed, motor, table = stamps[known], speed[known], motor[known], table[known]
    normal, pull, count = np.zeros((2, 2)), np.zeros(2), 0
    turns = (np.flatnonzero(np.diff(np.sign(speed)) != 0) + 1).tolist()
    bounds = [0, *turns, len(stamps)]
    for begin, turn, end in zip(bounds, turns, bounds[2:], strict=False):
        first = max(begin, int(np.searchsorted(stamps, stamps[turn - 1] - WINDOW)))
        last = min(end, int(np.searchsorted(stamps, stamps[turn] + WINDOW, 'right')))
        near, before = slice(first, last), np.arange(first, last) < turn
        sense = np.sign(speed[near])
        turning_point = np.max(motor[near] * sense[0]) * sense[0]
        clear = np.abs(motor[near] - turning_point) > TAKEN_UP
        fewest = min((clear & before).sum(), (clear & ~before).sum())
        if fewest < FEWEST_SAMPLES or stamps[turn] - stamps[turn - 1] > PAUSE:
            continue
        design = np.column_stack([0.5 * sense, speed[near]])[clear]
        distance = (motor[near] - table[near])[clear]
        design = design - design.mean(axis=0)
        normal += design.T @ design
        pull += design.T @ (distance - distance.mean())
        count += 1
    if not count:
        return []
    prior = np.diag([0.0, (NOISE / SKEW) ** 2])
    return [
        Cell(
            start=start,
            first_day=day_of(start),
            kind=CellKind.REVERSAL,
            stretches=count,
            duration=float(count),
            backlash=float(np.linalg.solve(normal + prior, pull)[0]),
        )
    ]
