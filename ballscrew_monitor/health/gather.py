# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Stretches of steady motion out of the rows of the judgement, one row at a time.

Rows make blocks of a tenth of a second, or of one row where they come more slowly, so that noise
of a single sample ends nothing. Blocks whose means lie within a band about the mean of all before
make a run. The first blocks of a run are left out, while the torque settles, and so is the last
one, in which the next ramp may begin. What is left is a stretch if it is long enough.

`step` keeps to the subset that compiles, see `surrogate.surface.compiled`: the node interprets it
row by row, recordings compile it.

"""

import dataclasses
from typing import Any

from ballscrew_monitor.core.conversions import SECOND
from ballscrew_monitor.health.records import LoadSource
from ballscrew_monitor.health.rows import has_torque, MAX_GAP, moves
from ballscrew_monitor.judge.inputs import DERIVED, MEASURED
from ballscrew_monitor.judge.zone import NO_INPUT, VALID
from surrogate.surface.records import many

SPEED_SHARE = 0.02
"""Distance of a block from the mean speed over that mean [-]."""
LOAD_SHARE, LOAD_WIDTH = 0.1, 50.0
"""Distance of a block from the mean load: over that mean [-], or in [N] if this is more."""
TEMPERATURE_WIDTH = 1.0
"""Distance of a block from the mean temperature [K]."""
BLOCK, SETTLING = SECOND // 10, SECOND // 5
SHORTEST, LONGEST = SECOND // 2, 10 * SECOND
"""Times of a stretch [ns]; a longer motion gives several."""
FEWEST_SAMPLES = 5
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


def step(settings: Any, memory: Any, row: Any, made: Any) -> bool:
    """
    Take a row; tell whether a stretch has ended, which then is in `made`.

    A standstill, a tick, another direction, a gap and a place outside the surface end a stretch. A
    row without torque, load or temperature is left out.

    """
    if not moves(row) or (row.validity != VALID and 0 < row.validity < NO_INPUT):
        return finish(settings, memory, made)
    if row.validity != VALID or not has_torque(row):
        return False
    ended = False
    if memory.known:
        span = row.stamp - memory.stamp
        if span == 0:
            return False
        if not 0 < span <= _longest_gap(settings, memory) or _is_other(memory, row):
            ended = finish(settings, memory, made)
        _follow_period(memory, span)
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
    """End what has been gathered; tell whether it is a stretch, which then is in `made`."""
    ended = _end_stretch(settings, memory, made)
    memory.known = False
    memory.block_samples = memory.run_samples = memory.pending_samples = 0
    return ended


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
    """Tell whether a row has another direction or other sources than the one before."""
    return (
        row.direction != memory.direction
        or (row.axial_load_source == DERIVED) != memory.derived
        or (row.temperature_source == MEASURED) != memory.temperature_measured
    )


def _add(memory: Any, row: Any) -> None:
    """Add a row to the block."""
    memory.known, memory.stamp = True, row.stamp
    memory.direction = row.direction
    memory.derived = row.axial_load_source == DERIVED
    memory.temperature_measured = row.temperature_source == MEASURED
    if memory.block_samples == 0:
        memory.block_start = row.stamp
        _clear(memory.block)
    memory.block_samples += 1
    memory.block[SPEED] += row.speed
    memory.block[LOAD] += row.axial_load
    memory.block[TEMPERATURE] += row.temperature
    memory.block[TORQUE] += row.motor_torque


def _end_block(settings: Any, memory: Any, made: Any) -> bool:
    """Take the block into the run, or begin a run with it; tell whether a stretch has ended."""
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
    """Tell whether the means of the block lie within the band about those of the run."""
    block, run = memory.block, memory.run
    samples, count = memory.run_samples, memory.block_samples
    speed, load = run[SPEED] / samples, run[LOAD] / samples
    warmer = block[TEMPERATURE] / count - run[TEMPERATURE] / samples
    return (
        abs(block[SPEED] / count - speed) <= SPEED_SHARE * abs(speed)
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
    """End the stretch and fill `made`; tell whether it is long enough."""
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
