# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
The first look at the judged rows of an axis: spans, sums, gaps, and what could not be judged.

Each row is taken to last until the next one, unless that is longer than the timeout of the speed:
then it is a gap. Rows come in blocks, so that a long recording need not fit into memory.

"""

import dataclasses
import heapq
import math
from typing import Any

from ballscrew_monitor.core.conversions import Direction, SECOND
from ballscrew_monitor.core.inputs import Source
from ballscrew_monitor.core.judgement import PointSource, Reason, Zone
from ballscrew_monitor.core.state import Extremes
from ballscrew_monitor.recordings.columns import Flags, Floats, JudgedColumns, Times
from ballscrew_monitor.recordings.declared import unwritten, written
import numpy as np

REST = 'no speed was recorded'
"""The time without rows in words."""
MOST_GAPS = 1000  # of the longest that are kept
STRAY = 1.5  # times the span of log times from which on stamps are no time line
STRAY_MARGIN = 60 * SECOND  # [ns]
COLUMN_OF = {
    Source.SPEED: 'speed',
    Source.LOAD: 'axial_load',
    Source.TEMPERATURE: 'temperature',
    Source.TORQUE: 'motor_torque',
}


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class TorqueFit:
    """Torque measured less modelled in motion: samples, mean and root mean square [N m]."""

    count: int = unwritten()
    forward: float = written('Nm', key='mean_forward', because='silence')
    backward: float = written('Nm', key='mean_backward', because='silence')
    spread: float = written('Nm', key='rms', because='silence')
    measured: float = unwritten()

    @property
    def silence(self) -> str:
        """Return why a mean is not known."""
        return 'not in one way' if self.count else 'no torque was measured in motion'


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class Gaps:
    """How often an input was interrupted, and how long in all [s]."""

    count: int = 0
    time: float = written('s', default=0.0)


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class Survey:
    """
    What an axis was like as a whole.

    `first` and `last` [ns] on the time line, of the stamps or, `by_stamp` false, of the log, and
    `shift` [ns] from stamps to it. Spans of measured inputs in SI; of load that opposes motion [N]
    and temperature [K] in motion. `reasons` [s] of all rows, `moving` [s] of the samples in motion
    alone; `uncounted` [s] before the next row where that came after the timeout of the speed.
    `gaps` of all inputs, that of the speed between two samples, that of any other from its timeout
    on; `speed_gaps`, the longest of them first, as start and length [ns]. `energy` [J] by zone.

    """

    axis: str
    rows: int
    first: int
    last: int
    by_stamp: bool
    shift: int
    inputs: dict[Source, Extremes]
    sources: dict[Source, frozenset[PointSource]]
    opposing: Extremes
    oil: Extremes
    reasons: dict[Reason, float]
    moving: dict[Reason, float]
    uncounted: float
    gaps: dict[Source, Gaps]
    speed_gaps: tuple[tuple[int, int], ...]
    energy: dict[Zone, float]
    torque: TorqueFit

    @property
    def rest(self) -> float:
        """Return the time without rows [s], 0 where stamps are no time line."""
        return self.uncounted if self.by_stamp else 0.0

    @property
    def possible_motion(self) -> float:
        """Return the time of motion, and of what may be motion as the speed is not known [s]."""
        still = self.reasons.get(Reason.STANDSTILL, 0.0)
        return math.fsum(self.reasons.values()) - still + self.rest

    @property
    def span(self) -> float:
        """Return the length of the time line [s]."""
        return (self.last - self.first) / SECOND


def opposing_loads(block: JudgedColumns) -> Floats:
    """Return the loads that oppose the motion [N], NaN where its direction is not known."""
    signs = np.full(3, np.nan)
    signs[Direction.POSITIVE], signs[Direction.NEGATIVE] = -1.0, 1.0
    return 0.0 + signs[block.direction] * block.axial_load


class _Running:
    """Lowest, highest and sum of the finite numbers so far."""

    def __init__(self) -> None:
        self.low = self.high = math.nan
        self.total, self.squares, self.count = 0.0, 0.0, 0

    def add(self, values: Floats) -> None:
        known = values[np.isfinite(values)]
        if known.size:
            self.low = float(np.fmin(self.low, known.min()))
            self.high = float(np.fmax(self.high, known.max()))
            self.total += float(known.sum())
            self.squares += float(np.square(known).sum())
            self.count += known.size

    @property
    def mean(self) -> float:
        return self.total / self.count if self.count else math.nan

    @property
    def rms(self) -> float:
        return math.sqrt(self.squares / self.count) if self.count else math.nan

    def span(self) -> Extremes:
        return Extremes(low=self.low, high=self.high, mean=self.mean)


class _Stretches:
    """How often and how long something held from row to row."""

    def __init__(self) -> None:
        self._count, self._time, self._before = 0, 0.0, False

    def add(self, holds: Flags, steps: Floats) -> None:
        """Take the next rows; `steps` [s] lead to each of them, or to each but the very first."""
        held = np.insert(holds[:-1], 0, self._before)
        self._count += int(np.count_nonzero(holds & ~held))
        first = len(held) - len(steps)
        self._time += float(steps[held[first:]].sum())
        self._before = bool(holds[-1])

    def gaps(self) -> Gaps:
        return Gaps(count=self._count, time=self._time)


class Surveyor:
    """Takes the blocks of one axis in order."""

    def __init__(self, axis: str, *, standstill: float, max_gap: int) -> None:
        """Begin; the screw moves from a speed `standstill` [rad/s] on; `max_gap` [ns]."""
        self._axis, self._standstill, self._max_gap = axis, standstill, max_gap
        self._rows = 0
        self._inputs = {source: _Running() for source in COLUMN_OF}
        self._sources: dict[Source, set[int]] = {source: set() for source in COLUMN_OF}
        self._opposing, self._oil = _Running(), _Running()
        self._reasons, self._moving = np.zeros(len(Reason)), np.zeros(len(Reason))
        self._uncounted = 0.0
        self._energy = np.zeros(len(Zone))
        self._gaps: list[tuple[int, int]] = []
        self._gap_count, self._gap_time = 0, 0
        self._stale = {source: _Stretches() for source in COLUMN_OF if source != Source.SPEED}
        self._residuals = {direction: _Running() for direction in Direction}
        self._residual, self._measured = _Running(), _Running()
        self._stamps = [math.inf, -math.inf]
        self._logs = [math.inf, -math.inf]
        self._before: tuple[Any, ...] | None = None
        self._last_sample: int | None = None

    def add(self, block: JudgedColumns) -> None:
        """Take the next block of rows."""
        if not len(block):
            return
        self._rows += len(block)
        _widen(self._stamps, block.stamp)
        _widen(self._logs, block.log_time)
        moving = np.abs(block.speed) >= self._standstill
        self._add_inputs(block)
        self._opposing.add(opposing_loads(block)[moving])
        self._oil.add(block.temperature[moving])
        self._add_sums(block, moving)
        self._add_gaps(block.stamp[~block.tick])
        self._add_torque(block, moving)

    def result(self) -> Survey:
        """Return what came of all blocks; there must have been a row."""
        (first, last), (first_log, last_log) = self._stamps, self._logs
        by_stamp = last - first <= STRAY * (last_log - first_log) + STRAY_MARGIN
        longest_first = sorted(self._gaps, key=lambda gap: (-gap[0], gap[1]))
        return Survey(
            axis=self._axis,
            rows=self._rows,
            first=int(first if by_stamp else first_log),
            last=int(last if by_stamp else last_log),
            by_stamp=by_stamp,
            shift=0 if by_stamp else int(last_log - last),
            inputs={source: running.span() for source, running in self._inputs.items()},
            sources={
                source: frozenset(map(PointSource, codes))
                for source, codes in self._sources.items()
            },
            opposing=self._opposing.span(),
            oil=self._oil.span(),
            reasons=_by_reason(self._reasons),
            moving=_by_reason(self._moving),
            uncounted=self._uncounted,
            gaps={source: stale.gaps() for source, stale in self._stale.items()}
            | {Source.SPEED: Gaps(count=self._gap_count, time=self._gap_time / SECOND)},
            speed_gaps=tuple((at, length) for length, at in longest_first),
            energy=dict(zip(Zone, self._energy.tolist())),
            torque=TorqueFit(
                count=self._residual.count,
                forward=self._residuals[Direction.POSITIVE].mean,
                backward=self._residuals[Direction.NEGATIVE].mean,
                spread=self._residual.rms,
                measured=self._measured.rms,
            ),
        )

    def _add_inputs(self, block: JudgedColumns) -> None:
        for source, name in COLUMN_OF.items():
            origin = getattr(block, f'{name}_source')
            self._sources[source].update(np.flatnonzero(np.bincount(origin)).tolist())
            known = (origin == PointSource.MEASURED) | (origin == PointSource.DERIVED)
            self._inputs[source].add(getattr(block, name)[known])

    def _add_sums(self, block: JudgedColumns, moving: Flags) -> None:
        """Add the time and the energy of each row up to the next one."""
        power = np.nan_to_num(block.friction_torque * np.abs(block.speed))
        power[np.abs(block.speed) < self._standstill] = 0.0
        moved = moving & ~block.tick
        columns: list[np.ndarray] = [block.stamp, block.reason, moved, power, block.zone]
        if self._before is not None:
            columns = [np.insert(one, 0, first) for first, one in zip(self._before, columns)]
        self._before = tuple(column[-1].item() for column in columns)
        stamps, reasons, moved, power, zones = columns
        steps = np.diff(stamps)
        self._uncounted += float(steps[steps > self._max_gap].sum()) / SECOND
        steps = np.where((steps > 0) & (steps <= self._max_gap), steps, 0) / SECOND
        self._reasons += np.bincount(reasons[:-1], steps, len(Reason))
        self._moving += np.bincount(reasons[:-1], steps * moved[:-1], len(Reason))
        self._energy += np.bincount(zones[:-1], steps * power[:-1], len(Zone))
        for source, stale in self._stale.items():
            stale.add(getattr(block, f'{COLUMN_OF[source]}_source') == PointSource.HELD, steps)

    def _add_gaps(self, samples: Times) -> None:
        if not samples.size:
            return
        if self._last_sample is not None:
            samples = np.insert(samples, 0, self._last_sample)
        self._last_sample = int(samples[-1])
        steps = np.diff(samples)
        for at in np.flatnonzero(steps > self._max_gap).tolist():
            self._gap_count += 1
            self._gap_time += int(steps[at])
            keep = heapq.heappush if len(self._gaps) < MOST_GAPS else heapq.heappushpop
            keep(self._gaps, (int(steps[at]), int(samples[at])))

    def _add_torque(self, block: JudgedColumns, moving: np.ndarray) -> None:
        residual = block.torque_residual
        known = moving & np.isfinite(residual)
        self._residual.add(residual[known])
        self._measured.add(block.motor_torque[known])
        for direction, running in self._residuals.items():
            running.add(residual[known & (block.direction == direction)])


def _by_reason(times: Floats) -> dict[Reason, float]:
    return {reason: float(time) for reason, time in zip(Reason, times) if time > 0}


def _widen(line: list[float], times: Times) -> None:
    line[0], line[1] = min(line[0], int(times.min())), max(line[1], int(times.max()))
