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
TEMPERATURE_WIDTH = 1.0
"""Distance of a block from the mean temperature [K]."""
BLOCK, SETTLING = SECOND // 10, SECOND // 5
SHORTEST, LONGEST = SECOND // 4, 10 * SECOND
"""Times of a stretch [ns]; a longer motion gives several."""
FEWEST_SAMPLES = 3
LONGEST_REST = 600 * SECOND
"""Time of rest that is handed over as one stretch [ns]."""
PERIODS, LARGEST_GAP = 5, 2 * SECOND
"""Sample periods that a gap may last, and the longest of such gaps [ns]."""
FOLLOWING = 16
"""Samples over which the sample period follows a slower rate."""
SUMS = 4
SPEED, LOAD, TEMPERATURE, TORQUE = range(SUMS)
MEASURED_LOAD, DERIVED_LOAD, FREE_LOAD = map(int, LoadSource)


@dataclasses.dataclass(slots=True)
class GatherSettings:
    """
    What the axis states.

    A gap above `max_gap` [ns], or above five sample periods if these are longer, ends a stretch.
    `free_load` [N, machine frame] is the load of motion that is free of process force: of a
    reference run, and, where the axis is `always_free`, of all motion whose load is derived.

    """

    max_gap: int = MAX_GAP
    free_load: float = 0.0
    always_free: bool = False


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


def step(settings: Any, memory: Any, row: Any, made: Any) -> bool:
    """
    Take a row; return True if a stretch has ended, which then is in `made`.

    A standstill, another direction or source and a gap end a stretch. A row without torque, or
    whose load or temperature is an input that is missing, is left out.

    """
    if not moves(row):
        ended = finish(settings, memory, made)
        _rest(settings, memory, row)
        return ended
    memory.rest_stamp = 0
    if not has_torque(row) or not _is_known(row):
        return False
    if memory.rest_time >= LONGEST_REST and memory.block_samples == 0:
        return _end_rest(memory, made)
    ended = False
    if memory.known:
        span = row.stamp - memory.stamp
        if span == 0:
            return False
        if not 0 < span <= _longest_gap(settings, memory) or _is_other(memory, row):
            ended = finish(settings, memory, made)
        else:
            _follow_ripple(memory, row.speed)
        _follow_period(memory, span)
    memory.speed = row.speed
    if memory.block_samples > 0 and row.stamp - memory.block_start >= BLOCK:
        ended = _end_block(settings, memory, made)
    _add(memory, row)
    return ended


def step_many(
    settings: Any, memory: Any, rows: Any, made: Any, begin: int, room: int
) -> tuple[int, int]:
    """
    Take rows from `begin` on; return the place after the last one, and the number of stretches.

    `settings` and `memory` are arrays of one record, `made` has `room` for stretches.

    """
    count = 0
    for at in range(begin, len(rows)):
        if count == room:
            return at, count
        if step(settings[0], memory[0], rows[at], made[count]):
            count += 1
    return len(rows), count


def finish(settings: Any, memory: Any, made: Any) -> bool:
    """End the motion so far; return True if it is a stretch, which then is in `made`."""
    ended = _end_stretch(settings, memory, made)
    memory.known = False
    memory.block_samples = memory.run_samples = memory.pending_samples = 0
    return ended


def finish_rest(memory: Any, made: Any) -> bool:
    """End the rest so far; return True if it is a stretch, which then is in `made`."""
    return memory.rest_time >= SHORTEST and _end_rest(memory, made)


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


def _end_rest(memory: Any, made: Any) -> bool:
    made.start, made.duration = memory.rest_start, memory.rest_time / SECOND
    made.samples, made.speed = 1, 0.0
    made.motor_torque = memory.rest_torque / memory.rest_time
    made.axial_load = made.temperature = math.nan
    made.load_source, made.temperature_measured = DERIVED_LOAD, False
    memory.rest_time, memory.rest_torque = 0, 0.0
    return True


def _follow_ripple(memory: Any, speed: float) -> None:
    """Follow the median of the difference of two samples of the speed over the speed [-]."""
    if abs(speed - memory.speed) > memory.ripple * abs(speed):
        memory.ripple = min(memory.ripple * RIPPLE_STEP, WIDEST_SHARE)
    else:
        memory.ripple = max(memory.ripple / RIPPLE_STEP, 1e-5)


def _speed_share(memory: Any) -> float:
    """Return the distance of a steady block from the mean speed over that mean [-]."""
    noise = RIPPLES * memory.ripple / math.sqrt(max(memory.block_samples, 1))
    return min(max(SPEED_SHARE, noise), WIDEST_SHARE)


def _longest_gap(settings: Any, memory: Any) -> int:
    """Return the longest gap [ns] that ends nothing."""
    slow = min(PERIODS * memory.period, LARGEST_GAP)
    return max(settings.max_gap, slow)


def _follow_period(memory: Any, span: int) -> None:
    """Follow the sample period: at once if it is shorter, else slowly."""
    if not 0 < span <= LARGEST_GAP:
        return
    if memory.period == 0 or span < memory.period:
        memory.period = span
    else:
        memory.period += (span - memory.period) // FOLLOWING


def _is_other(memory: Any, row: Any) -> bool:
    """Return True if a row has another direction or other sources than the one before."""
    return (
        row.direction != memory.direction
        or (row.axial_load_source != MEASURED) != memory.derived
        or (row.temperature_source == MEASURED) != memory.temperature_measured
    )


def _add(memory: Any, row: Any) -> None:
    """Add a row to the block."""
    memory.known, memory.stamp = True, row.stamp
    memory.direction = row.direction
    memory.derived = row.axial_load_source != MEASURED
    memory.temperature_measured = row.temperature_source == MEASURED
    if memory.block_samples == 0:
        memory.block_start = row.stamp
        _clear(memory.block)
    memory.block_samples += 1
    memory.block[SPEED] += row.speed
    memory.block[LOAD] += 0.0 if memory.derived else row.axial_load
    memory.block[TEMPERATURE] += row.temperature
    memory.block[TORQUE] += row.motor_torque


def _end_block(settings: Any, memory: Any, made: Any) -> bool:
    """Take the block into the run, or begin a run with it; return True if a stretch has ended."""
    ended = False
    if memory.run_samples > 0 and not _fits(memory):
        ended = _end_stretch(settings, memory, made)
        memory.run_samples = memory.pending_samples = 0
    if memory.run_samples == 0:
        memory.run_start = memory.block_start
        _clear(memory.run)
    if memory.pending_samples > 0:
        _take_pending(memory)
        if memory.end - memory.start >= LONGEST:
            ended = _end_stretch(settings, memory, made)
            memory.run_samples = 0
            _clear(memory.run)
    _add_all(memory.run, memory.block)
    memory.run_samples += memory.block_samples
    if memory.block_start - memory.run_start >= SETTLING:
        memory.pending_samples = memory.block_samples
        memory.pending_start, memory.pending_end = memory.block_start, memory.stamp
        _clear(memory.pending)
        _add_all(memory.pending, memory.block)
    memory.block_samples = 0
    return ended


def _fits(memory: Any) -> bool:
    """Return True if the means of the block lie within the band about those of the run."""
    block, run = memory.block, memory.run
    samples, count = memory.run_samples, memory.block_samples
    speed, load = run[SPEED] / samples, run[LOAD] / samples
    warmer = block[TEMPERATURE] / count - run[TEMPERATURE] / samples
    return (
        abs(block[SPEED] / count - speed) <= _speed_share(memory) * abs(speed)
        and abs(block[LOAD] / count - load) <= max(LOAD_SHARE * abs(load), LOAD_WIDTH)
        and abs(warmer) <= TEMPERATURE_WIDTH
    )


def _take_pending(memory: Any) -> None:
    """Take the last block of the run into the stretch."""
    if memory.samples == 0:
        memory.start = memory.pending_start
        _clear(memory.total)
    memory.end = memory.pending_end
    memory.samples += memory.pending_samples
    _add_all(memory.total, memory.pending)
    memory.pending_samples = 0


def _end_stretch(settings: Any, memory: Any, made: Any) -> bool:
    """End the stretch and fill `made`; return True if it is long enough."""
    samples, span = memory.samples, memory.end - memory.start
    memory.samples = 0
    if samples < FEWEST_SAMPLES or span < SHORTEST:
        return False
    made.start, made.duration, made.samples = memory.start, span / SECOND, samples
    made.speed = memory.total[SPEED] / samples
    made.axial_load = memory.total[LOAD] / samples
    made.temperature = memory.total[TEMPERATURE] / samples
    made.motor_torque = memory.total[TORQUE] / samples
    made.temperature_measured = memory.temperature_measured
    made.load_source = DERIVED_LOAD if memory.derived else MEASURED_LOAD
    if memory.derived and settings.always_free:
        made.axial_load, made.load_source = settings.free_load, FREE_LOAD
    return True


def _clear(sums: Any) -> None:
    for at in range(SUMS):
        sums[at] = 0.0


def _add_all(sums: Any, more: Any) -> None:
    for at in range(SUMS):
        sums[at] += more[at]
