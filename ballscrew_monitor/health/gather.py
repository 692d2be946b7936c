# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Stretches of steady motion out of the rows of the judgement, one row at a time.

Rows make blocks of a tenth of a second, or of one row where they come more slowly, so that noise
of a single sample ends nothing. Blocks whose means lie within a band about the mean of all before
make a run. The width of the band follows the ripple of the reported speed, which is the median
difference of two samples. The first blocks of a run are left out, while the torque settles, and so
is the last one, in which the next ramp may begin. The rest is a stretch if it is long enough. Rest
with a measured torque is a stretch of speed 0, however short its parts are.

No surface is asked: a row counts wherever its point lies.

`step` keeps to the subset that compiles, see `surrogate.surface.compiled`: the node interprets it
row by row, recordings compile it.

"""

import dataclasses
import math
from typing import Any

from ballscrew_monitor.core.conversions import SECOND
from ballscrew_monitor.health.records import LoadSource
from ballscrew_monitor.health.rows import has_torque, MAX_GAP, moves
from ballscrew_monitor.judge.inputs import HELD, MEASURED
from surrogate.surface.records import many

SPEED_SHARE, WIDEST_SHARE = 0.02, 0.08
"""Distance of a block from the mean speed over that mean [-], at least and at most."""
RIPPLES, FIRST_RIPPLE, RIPPLE_STEP = 4.0, 0.003, 1.03
"""Ripples of a block mean that are steady, the first ripple [-], and how it follows the median."""
LOAD_SHARE, LOAD_WIDTH = 0.2, 100.0
"""Distance of a block from the mean load: over that mean [-], or in [N] if this is more."""
TEMPERATURE_WIDTH = 1.0  # distance of a block from the mean temperature [K]
BLOCK, SETTLING = SECOND // 10, SECOND // 5
SHORTEST, LONGEST = SECOND // 4, 10 * SECOND  # of a stretch [ns]; a longer motion has several
FEWEST_SAMPLES = 3
LONGEST_REST = 600 * SECOND  # time of rest that is handed over as one stretch [ns]
PERIODS, LARGEST_GAP = 5, 2 * SECOND  # sample periods of a gap, and the longest such gap [ns]
FOLLOWING = 16  # samples over which the sample period follows a slower rate
SUMS = 4
SPEED, LOAD, TEMPERATURE, TORQUE = range(SUMS)
MEASURED_LOAD, DERIVED_LOAD, FREE_LOAD = map(int, LoadSource)


@dataclasses.dataclass(slots=True)
class GatherSettings:
    """
    What axis and surface state.

    A gap above `max_gap` [ns], or above five sample periods if these are longer, ends a stretch.
    `free_load` [N, machine frame] is the load of motion that is free of process force: of a
    reference run, and, where the axis is `always_free`, of all motion whose load is derived.
    `sliding` [m/rad] is that of the surface, NaN if not stated.

    """

    max_gap: int = MAX_GAP
    free_load: float = 0.0
    always_free: bool = False
    sliding: float = math.nan


@dataclasses.dataclass(slots=True)
class GatherMemory:
    """What is remembered between rows: stamps [ns], sums of samples in SI units."""

    known: bool = False  # a row to go on from
    stamp: int = 0
    period: int = 0
    direction: int = 0
    derived: bool = False
    temperature_measured: bool = False
    block_samples: int = 0
    block_start: int = 0
    block: list[float] = many(SUMS, 0.0)
    run_samples: int = 0
    run_start: int = 0
    run: list[float] = many(SUMS, 0.0)
    pending_samples: int = 0  # the last block of the run
    pending_start: int = 0
    pending_end: int = 0
    pending: list[float] = many(SUMS, 0.0)
    samples: int = 0  # of the stretch
    start: int = 0
    end: int = 0
    total: list[float] = many(SUMS, 0.0)
    ripple: float = FIRST_RIPPLE  # of the speed from sample to sample [-]
    speed: float = 0.0  # of the last row in motion
    rest_stamp: int = 0  # of the last row at rest, 0 for none
    rest_start: int = 0
    rest_time: int = 0  # [ns]
    rest_torque: float = 0.0  # torque times time [N m ns]


def step(settings: Any, memory: Any, row: Any, stretch: Any) -> bool:
    """
    Take a row; return True if a stretch has ended, which then is in `stretch`.

    A standstill, another direction or source and a gap end a stretch. A row without torque, or
    whose load or temperature is an input that is missing, is left out.

    """
    if not moves(row):
        ended = finish(settings, memory, stretch)
        _rest(settings, memory, row)
        return ended
    memory.rest_stamp = 0
    if not has_torque(row) or not _is_known(row):
        return False
    if memory.rest_time >= LONGEST_REST and memory.block_samples == 0:
        return _end_rest(memory, stretch)
    ended = False
    if memory.known:
        span = row.stamp - memory.stamp
        if span == 0:
            return False
        longest = max(settings.max_gap, min(PERIODS * memory.period, LARGEST_GAP))
        same_sources = (row.axial_load_source != MEASURED) == memory.derived
        same_sources &= (row.temperature_source == MEASURED) == memory.temperature_measured
        if not 0 < span <= longest or row.direction != memory.direction or not same_sources:
            ended = finish(settings, memory, stretch)
        # The ripple follows the median difference of two samples of the speed over the speed.
        elif abs(row.speed - memory.speed) > memory.ripple * abs(row.speed):
            memory.ripple = min(memory.ripple * RIPPLE_STEP, WIDEST_SHARE)
        else:
            memory.ripple = max(memory.ripple / RIPPLE_STEP, 1e-5)
        if 0 < span <= LARGEST_GAP:  # the period follows at once if it is shorter, else slowly
            slower = memory.period > 0 and span >= memory.period
            change = span - memory.period
            memory.period += change // FOLLOWING if slower else change
    memory.speed = row.speed
    if memory.block_samples > 0 and row.stamp - memory.block_start >= BLOCK:
        ended = _end_block(settings, memory, stretch)
    _add(memory, row)
    return ended


def step_many(
    settings: Any, memory: Any, rows: Any, stretches: Any, begin: int, room: int
) -> tuple[int, int]:
    """
    Take rows from `begin` on; return the place after the last one, and the number of stretches.

    `settings` and `memory` are arrays of one record, `stretches` have `room` for so many.

    """
    count = 0
    for at in range(begin, len(rows)):
        if count == room:
            return at, count
        if step(settings[0], memory[0], rows[at], stretches[count]):
            count += 1
    return len(rows), count


def finish(settings: Any, memory: Any, stretch: Any) -> bool:
    """End the motion so far; return True if it is a stretch, which then is in `stretch`."""
    ended = _end_stretch(settings, memory, stretch)
    memory.known = False
    memory.block_samples = memory.run_samples = memory.pending_samples = 0
    return ended


def finish_rest(memory: Any, stretch: Any) -> bool:
    """End the rest so far; return True if it is a stretch, which then is in `stretch`."""
    return memory.rest_time >= SHORTEST and _end_rest(memory, stretch)


def _is_known(row: Any) -> bool:
    """Return True if load and temperature of a row are measured, or are no input."""
    missing = row.axial_load_source == HELD or row.temperature_source == HELD
    load = row.axial_load_source != MEASURED or math.isfinite(row.axial_load)
    return load and not missing and math.isfinite(row.temperature) and row.direction != 0


def _rest(settings: Any, memory: Any, row: Any) -> None:
    """Add a row at rest to the rest of the log."""
    if row.tick or not has_torque(row):
        memory.rest_stamp = 0
        return
    span = row.stamp - memory.rest_stamp
    if memory.rest_stamp > 0 and 0 < span <= settings.max_gap:
        if memory.rest_time == 0:
            memory.rest_start, memory.rest_torque = memory.rest_stamp, 0.0
        memory.rest_time += span
        memory.rest_torque += row.motor_torque * span
    memory.rest_stamp = row.stamp


def _end_rest(memory: Any, stretch: Any) -> bool:
    stretch.start, stretch.duration = memory.rest_start, memory.rest_time / SECOND
    stretch.samples, stretch.speed = 1, 0.0
    stretch.motor_torque = memory.rest_torque / memory.rest_time
    stretch.axial_load = stretch.temperature = math.nan
    stretch.load_source, stretch.temperature_measured = DERIVED_LOAD, False
    memory.rest_time, memory.rest_torque = 0, 0.0
    return True


def _add(memory: Any, row: Any) -> None:
    """Add a row to the block."""
    memory.known, memory.stamp = True, row.stamp
    memory.direction = row.direction
    memory.derived = row.axial_load_source != MEASURED
    memory.temperature_measured = row.temperature_source == MEASURED
    if memory.block_samples == 0:
        memory.block_start = row.stamp
        for at in range(SUMS):
            memory.block[at] = 0.0
    memory.block_samples += 1
    memory.block[SPEED] += row.speed
    memory.block[LOAD] += 0.0 if memory.derived else row.axial_load
    memory.block[TEMPERATURE] += row.temperature
    memory.block[TORQUE] += row.motor_torque


def _end_block(settings: Any, memory: Any, stretch: Any) -> bool:
    """Take the block into the run, or begin a run with it; return True if a stretch has ended."""
    ended = False
    if memory.run_samples > 0 and not _fits(memory):
        ended = _end_stretch(settings, memory, stretch)
        memory.run_samples = memory.pending_samples = 0
    if memory.run_samples == 0:
        memory.run_start = memory.block_start
    if memory.pending_samples > 0:  # the block before is not the last one of the run
        if memory.samples == 0:
            memory.start = memory.pending_start
        _add_all(memory.total, memory.pending, memory.samples == 0)
        memory.samples += memory.pending_samples
        memory.end, memory.pending_samples = memory.pending_end, 0
        if memory.end - memory.start >= LONGEST:
            ended = _end_stretch(settings, memory, stretch)
            memory.run_samples = 0
    _add_all(memory.run, memory.block, memory.run_samples == 0)
    memory.run_samples += memory.block_samples
    if memory.block_start - memory.run_start >= SETTLING:
        memory.pending_samples = memory.block_samples
        memory.pending_start, memory.pending_end = memory.block_start, memory.stamp
        _add_all(memory.pending, memory.block, True)
    memory.block_samples = 0
    return ended


def _fits(memory: Any) -> bool:
    """Return True if the means of the block lie within the band about those of the run."""
    block, run = memory.block, memory.run
    samples, count = memory.run_samples, memory.block_samples
    speed, load = run[SPEED] / samples, run[LOAD] / samples
    warmer = block[TEMPERATURE] / count - run[TEMPERATURE] / samples
    noise = RIPPLES * memory.ripple / math.sqrt(max(count, 1))
    share = min(max(SPEED_SHARE, noise), WIDEST_SHARE)
    return (
        abs(block[SPEED] / count - speed) <= share * abs(speed)
        and abs(block[LOAD] / count - load) <= max(LOAD_SHARE * abs(load), LOAD_WIDTH)
        and abs(warmer) <= TEMPERATURE_WIDTH
    )


def _end_stretch(settings: Any, memory: Any, stretch: Any) -> bool:
    """End the stretch and fill `stretch`; return True if it is long enough."""
    samples, span = memory.samples, memory.end - memory.start
    memory.samples = 0
    if samples < FEWEST_SAMPLES or span < SHORTEST:
        return False
    stretch.start, stretch.duration, stretch.samples = memory.start, span / SECOND, samples
    stretch.speed = memory.total[SPEED] / samples
    stretch.axial_load = memory.total[LOAD] / samples
    stretch.temperature = memory.total[TEMPERATURE] / samples
    stretch.motor_torque = memory.total[TORQUE] / samples
    stretch.temperature_measured = memory.temperature_measured
    stretch.load_source = DERIVED_LOAD if memory.derived else MEASURED_LOAD
    if memory.derived and settings.always_free:
        stretch.axial_load, stretch.load_source = settings.free_load, FREE_LOAD
    return True


def _add_all(sums: Any, more: Any, anew: bool) -> None:
    for at in range(SUMS):
        sums[at] = more[at] if anew else sums[at] + more[at]
