# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
The first look at the judged rows of an axis: spans, sums, gaps, and what could not be judged.

Each row is taken to last until the next one, unless that is longer than the timeout of the speed:
then it is a gap. One compiled pass adds the rows up as they are judged, so that nothing of a
recording need be kept, and a replay that is only printed asks for no table of them. It gathers
the products of load and torque for `balance.py`, too. Functions of the subset that numba
compiles; `row` is a `judge.records.Row`.

"""

import dataclasses
import functools
import heapq
import math
from typing import Any

from ballscrew_monitor.core.conversions import Direction, SECOND
from ballscrew_monitor.core.inputs import Source
from ballscrew_monitor.core.judgement import Limits, PointSource, Reason, Zone
from ballscrew_monitor.judge.certainty import least_factor, surely_outside
from ballscrew_monitor.judge.inputs import (
    DERIVED,
    HELD,
    LOAD,
    MEASURED,
    SPEED,
    TEMPERATURE,
    TORQUE,
)
from ballscrew_monitor.judge.point import NO_DIRECTION, opposing_load, POSITIVE
from ballscrew_monitor.recordings.declared import unwritten, written
import numpy as np
from numpy.typing import NDArray
from surrogate.surface import Surface
from surrogate.surface.compiled import compiled
from surrogate.surface.records import as_array, from_array, many
from surrogate.units import TURN

NAN = math.nan
REST = 'no speed was recorded'
"""The time without rows in words."""
MOST_GAPS = 1000  # of the longest that are kept
STRAY = 1.5  # times the span of log times from which on stamps are no time line
STRAY_MARGIN = 60 * SECOND  # [ns]
INPUTS, ORIGINS = len(Source), len(PointSource)
# Places of the numbers of a span: the inputs, what opposes the motion and the oil in motion,
# measured and modelled torque there, and their difference by the direction of the motion.
OPPOSING, OIL, COMPARED, RESIDUAL, BY_DIRECTION = range(INPUTS, INPUTS + 5)
SPANS = BY_DIRECTION + len(Direction)
TERMS = 4
"""Terms of a balance: load torque, motion, one and motor torque."""


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
class Extremes:
    """Smallest, mean and largest value, NaN when there was none."""

    low: float = math.nan
    mean: float = math.nan
    high: float = math.nan


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
    alone, `samples` the number of all that are no ticks; `uncounted` [s] before the next row where
    that came after the timeout of the speed. `gaps` of all inputs, that of the speed between two
    samples, that of any other from its timeout on; `speed_gaps`, the longest of them first, as
    start and length [ns]; `missed` [s] of the gaps lies between two samples in motion. `energy`
    [J] by zone. A log may hold several `runs`; the `pauses` [s]
    between these are on the time line alone. `no_speed` [s] lies before the first and behind the
    last sample of the speed, as far as either is a gap.

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
    samples: dict[Reason, int]
    uncounted: float
    gaps: dict[Source, Gaps]
    speed_gaps: tuple[tuple[int, int], ...]
    energy: dict[Zone, float]
    torque: TorqueFit
    missed: float = 0.0
    runs: int = 1
    pauses: float = 0.0
    no_speed: float = 0.0

    @property
    def rest(self) -> float:
        """Return the time without rows [s], 0 where stamps are no time line."""
        return self.uncounted if self.by_stamp else 0.0

    @property
    def missed_share(self) -> float:
        """Return the share of the motion that lies in gaps between samples in motion [-]."""
        motion = math.fsum(self.moving.values()) + self.missed
        return self.missed / motion if motion else 0.0

    @property
    def possible_motion(self) -> float:
        """Return the time of motion, and of what may be motion as the speed is not known [s]."""
        still = self.reasons.get(Reason.STANDSTILL, 0.0)
        return math.fsum(self.reasons.values()) - still + self.rest

    @property
    def span(self) -> float:
        """Return the time that was recorded [s]."""
        return self.length - self.pauses

    @property
    def length(self) -> float:
        """Return the length of the time line [s]."""
        return (self.last - self.first) / SECOND


@dataclasses.dataclass(slots=True)
class RowSums:
    """
    The sums over rows, and the last of them; stamps and times [ns], energy [J], the rest SI.

    Products of all terms of a balance by all are summed over the rows in motion where the load is
    known, where the torque is, and where both are; there also the friction by the model [N m], and
    in how many rows it is known.

    """

    rows: int = 0
    begin: int = 0
    first: int = 0
    last: int = 0
    first_log: int = 0
    last_log: int = 0
    count: list[int] = many(SPANS, 0)
    low: list[float] = many(SPANS, math.inf)
    high: list[float] = many(SPANS, -math.inf)
    total: list[float] = many(SPANS, 0.0)
    squares: list[float] = many(SPANS, 0.0)
    sources: list[int] = many(INPUTS * ORIGINS, 0)  # rows by input, then by source
    gaps: list[int] = many(INPUTS, 0)
    gap_time: list[int] = many(INPUTS, 0)
    reason_time: list[int] = many(len(Reason), 0)
    moving_time: list[int] = many(len(Reason), 0)
    uncounted: int = 0
    pauses: int = 0
    parted: bool = False  # the next row is the first of another run
    energy: list[float] = many(len(Zone), 0.0)
    samples: list[int] = many(len(Reason), 0)
    sure_time: int = 0  # surely outside the zone
    of_load: list[float] = many(TERMS * TERMS, 0.0)
    of_torque: list[float] = many(TERMS * TERMS, 0.0)
    of_both: list[float] = many(TERMS * TERMS, 0.0)
    friction: float = 0.0
    friction_rows: int = 0
    # the last row
    stamp: int = 0
    reason: int = 0
    zone: int = 0
    moved: bool = False
    sure: bool = False
    power: float = 0.0
    held: list[int] = many(INPUTS, 0)


def add_rows(
    sums: Any, rows: Any, sure: Any, lead: float, standstill: float, max_gap: int
) -> None:
    """
    Add rows, and whether each is surely outside the zone, to an array of one `RowSums`.

    The screw of a lead [m] moves from a speed `standstill` [rad/s] on; a row lasts until the next
    one, at most `max_gap` [ns].

    """
    for at in range(len(rows)):
        _add_time(sums[0], rows[at], sure[at], max_gap)
        moving = abs(rows[at].speed) >= standstill
        _add_numbers(sums[0], rows[at], moving)
        if moving and rows[at].direction != NO_DIRECTION:
            _add_balance(sums[0], rows[at], lead)


def _add_time(sums: Any, row: Any, sure: bool, max_gap: int) -> None:
    """Add the time from the last row to this one to what held at the last one."""
    if sums.rows == 0:
        sums.begin = sums.first = sums.last = row.stamp
        sums.first_log, sums.last_log = row.now, row.now
    else:
        step = row.stamp - sums.stamp
        if sums.sure and 0 < step <= max_gap:
            sums.sure_time += step
        if sums.parted:
            sums.pauses += step
        elif step > max_gap:
            sums.uncounted += step
        elif step > 0:
            sums.reason_time[sums.reason] += step
            if sums.moved:
                sums.moving_time[sums.reason] += step
            sums.energy[sums.zone] += sums.power * (step / SECOND)
            for source in range(INPUTS):
                if sums.held[source] != 0:
                    sums.gap_time[source] += step
    sums.rows += 1
    sums.parted = False
    sums.sure = sure
    sums.first, sums.last = min(sums.first, row.stamp), max(sums.last, row.stamp)
    sums.first_log, sums.last_log = min(sums.first_log, row.now), max(sums.last_log, row.now)


def _add_numbers(sums: Any, row: Any, moving: bool) -> None:
    """Add the numbers of a row, and keep what holds until the next one."""
    _add_input(sums, SPEED, row.speed, row.speed_source)
    _add_input(sums, LOAD, row.axial_load, row.axial_load_source)
    _add_input(sums, TEMPERATURE, row.temperature, row.temperature_source)
    _add_input(sums, TORQUE, row.motor_torque, row.motor_torque_source)
    power = row.friction_torque * abs(row.speed)
    sums.power = power if moving and math.isfinite(power) else 0.0
    sums.stamp, sums.reason, sums.zone = row.stamp, row.reason, row.zone
    sums.moved = moving and not row.tick
    if not row.tick:
        sums.samples[row.reason] += 1
    if not moving:
        return
    _add(sums, OIL, row.temperature)
    if row.direction != NO_DIRECTION:
        _add(sums, OPPOSING, opposing_load(row))
    # Of a load that is derived from it, the torque of the model says nothing new.
    if row.motor_torque_source == MEASURED and row.axial_load_source != DERIVED:
        residual = row.motor_torque - row.machine_torque
        if math.isfinite(residual):
            _add(sums, COMPARED, row.motor_torque)
            _add(sums, RESIDUAL, residual)
            _add(sums, BY_DIRECTION + row.direction, residual)


def _add_balance(sums: Any, row: Any, lead: float) -> None:
    """Add the products of a row in motion to the sums of a balance."""
    # A load that was derived from the torque says nothing new.
    known = row.axial_load_source != DERIVED and math.isfinite(row.axial_load)
    load = -lead / TURN * row.axial_load if known else 0.0
    motion = 1.0 if row.direction == POSITIVE else -1.0
    measured = row.motor_torque_source == MEASURED and math.isfinite(row.motor_torque)
    torque = row.motor_torque if measured else 0.0
    terms = (load, motion, 1.0, torque)
    for term in range(TERMS):
        for other in range(TERMS):
            place, product = TERMS * term + other, terms[term] * terms[other]
            if known:
                sums.of_load[place] += product
            if measured:
                sums.of_torque[place] += product
            if known and measured:
                sums.of_both[place] += product
    if known and measured and math.isfinite(row.friction_torque):
        sums.friction += row.friction_torque
        sums.friction_rows += 1


def _add_input(sums: Any, source: int, value: float, origin: int) -> None:
    sums.sources[source * ORIGINS + origin] += 1
    if origin == MEASURED or origin == DERIVED:
        _add(sums, source, value)
    held = int(origin == HELD)
    if held > sums.held[source]:
        sums.gaps[source] += 1
    sums.held[source] = held


def _add(sums: Any, span: int, value: float) -> None:
    if math.isfinite(value):
        sums.count[span] += 1
        sums.low[span] = min(sums.low[span], value)
        sums.high[span] = max(sums.high[span], value)
        sums.total[span] += value
        sums.squares[span] += value * value


@functools.cache
def compiled_sums() -> Any:
    """Return `add_rows` compiled; raises ImportError without numba."""
    return compiled(add_rows)


class Surveyor:
    """Takes the rows of one axis in order."""

    def __init__(self, axis: str, surface: Surface, limits: Limits, *, max_gap: int) -> None:
        """Begin without rows of an axis; a row lasts `max_gap` [ns] at most."""
        self._axis, self._surface, self._limits, self._max_gap = axis, surface, limits, max_gap
        self._sums = as_array(RowSums())
        self._gaps: list[tuple[int, int]] = []
        self._gap_count = self._gap_time = self._missed = 0
        self._last_sample, self._last_moved = np.empty((2, 0), np.int64), np.empty(0, np.bool_)
        self._run, self._runs, self._speeds = 0, 1, np.empty(0, np.int64)

    def add(self, rows: NDArray[Any], run: int = 0) -> None:
        """Take the next rows, an array of ROW, of the run of a number."""
        if run != self._run:
            self._run, self._runs = run, self._runs + 1
            self._sums['parted'] = True
            self._last_sample, self._last_moved = self._last_sample[:, :0], self._last_moved[:0]
        sure = surely_outside(rows, self._surface, self._limits)
        lead, standstill = self._surface.lead, self._limits.standstill_speed
        compiled_sums()(self._sums, rows, sure, lead, standstill, self._max_gap)
        of_speed = rows[~rows['tick']]
        stamps = np.append(self._speeds, of_speed['stamp'])
        self._speeds = stamps[[0, -1]] if stamps.size else stamps
        times = np.array([of_speed['stamp'], of_speed['now']])
        samples = np.concatenate([self._last_sample, times], axis=1)
        moved = np.abs(of_speed['speed']) >= standstill
        moved = np.concatenate([self._last_moved, moved])
        self._last_sample, self._last_moved = samples[:, -1:].copy(), moved[-1:].copy()
        steps = np.diff(samples)
        for at in np.flatnonzero(steps[0] > self._max_gap).tolist():
            step, lasting = int(steps[0, at]), int(steps[:, at].min())
            self._gap_count += 1
            self._gap_time += step
            if lasting > self._max_gap and moved[at] and moved[at + 1]:  # else one clock leaps
                self._missed += lasting
            keep = heapq.heappush if len(self._gaps) < MOST_GAPS else heapq.heappushpop
            keep(self._gaps, (step, int(samples[0, at])))

    @property
    def sums(self) -> RowSums:
        """Return the sums over all rows."""
        return from_array(RowSums, self._sums[0])

    @property
    def sure_time(self) -> float:
        """Return the time surely outside the zone [s], NaN on a surface without its bands."""
        return self.sums.sure_time / SECOND if math.isfinite(least_factor(self._surface)) else NAN

    def result(self) -> Survey:
        """Return what came of all rows; there must have been one."""
        sums = self.sums
        span, log_span = sums.last - sums.first, sums.last_log - sums.first_log
        by_stamp = span <= STRAY * log_span + STRAY_MARGIN
        # Runs whose stamps begin again lie over each other: they last longer than the span.
        pauses = sums.pauses + span - (sums.stamp - sums.begin) if self._runs > 1 else 0
        ends = np.abs(self._speeds - (sums.first, sums.last)) if self._speeds.size else np.zeros(2)
        longest_first = sorted(self._gaps, key=lambda gap: (-gap[0], gap[1]))
        gaps = zip(Source, zip(sums.gaps, sums.gap_time))
        return Survey(
            axis=self._axis,
            rows=sums.rows,
            first=sums.first if by_stamp else sums.first_log,
            last=sums.last if by_stamp else sums.last_log,
            by_stamp=by_stamp,
            shift=0 if by_stamp else sums.last_log - sums.last,
            inputs={source: _extremes(sums, source) for source in Source},
            sources={
                source: frozenset(
                    origin for origin in PointSource if sums.sources[source * ORIGINS + origin]
                )
                for source in Source
            },
            opposing=_extremes(sums, OPPOSING),
            oil=_extremes(sums, OIL),
            reasons=_by_reason(sums.reason_time),
            moving=_by_reason(sums.moving_time),
            samples={reason: count for reason, count in zip(Reason, sums.samples) if count},
            uncounted=sums.uncounted / SECOND,
            missed=self._missed / SECOND,
            runs=self._runs,
            pauses=pauses / SECOND if by_stamp else 0.0,
            no_speed=float(ends[ends > self._max_gap].sum()) / SECOND if by_stamp else 0.0,
            gaps={source: Gaps(count=count, time=time / SECOND) for source, (count, time) in gaps}
            | {Source.SPEED: Gaps(count=self._gap_count, time=self._gap_time / SECOND)},
            speed_gaps=tuple((at, length) for length, at in longest_first),
            energy=dict(zip(Zone, sums.energy)),
            torque=TorqueFit(
                count=sums.count[RESIDUAL],
                forward=_extremes(sums, BY_DIRECTION + Direction.POSITIVE).mean,
                backward=_extremes(sums, BY_DIRECTION + Direction.NEGATIVE).mean,
                spread=_rms(sums, RESIDUAL),
                measured=_rms(sums, COMPARED),
            ),
        )


def _extremes(sums: RowSums, span: int) -> Extremes:
    if not (count := sums.count[span]):
        return Extremes()
    return Extremes(low=sums.low[span], mean=sums.total[span] / count, high=sums.high[span])


def _rms(sums: RowSums, span: int) -> float:
    return math.sqrt(sums.squares[span] / sums.count[span]) if sums.count[span] else NAN


def _by_reason(times: list[int]) -> dict[Reason, float]:
    return {reason: time / SECOND for reason, time in zip(Reason, times) if time}
