# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""From what a monitor says of one sample to a row of columns, and of one event to its record."""

from collections.abc import Iterable
import math
from typing import Any

from ballscrew_monitor.core.estimate import MachinePoint, PointEstimate, PointSource, PointValidity
from ballscrew_monitor.core.judgement import Gate, Verdict, Zone
from ballscrew_monitor.core.monitor import Monitor
from ballscrew_monitor.core.state import Event, Instant
from ballscrew_monitor.recordings.columns import (
    AxisOutcome,
    BY_VALIDITY,
    COLUMNS,
    JudgedColumns,
    Reason,
)
from ballscrew_monitor.recordings.summary import event_record, EventRecord
import numpy as np

Row = tuple[Any, ...]


class RowCollector:
    """Hears all judgements of one monitor: rows, and what the axis comes to."""

    def __init__(self, axis: str, monitor: Monitor) -> None:
        """Begin to observe `monitor`."""
        self.axis = axis
        self._waiting: list[Row] = []
        self._rows = self._states = self._first = self._last = self._now = self._stamp = 0
        self._events: dict[int, EventRecord] = {}
        self._reason = ''
        self.observe(monitor)

    def observe(self, monitor: Monitor) -> None:
        """Go on with another monitor, in which an event may have ended meanwhile."""
        self._monitor = monitor
        monitor.observer = self._take
        if monitor.event.number in self._events:
            self._note(monitor.event, monitor.event.stamp)

    def __len__(self) -> int:
        """Return the number of rows that wait."""
        return len(self._waiting)

    def block(self) -> JudgedColumns:
        """Return the rows that wait, at least one, and begin anew."""
        rows, self._waiting = self._waiting, []
        return columns_of(self.axis, rows)

    def add(self, columns: JudgedColumns, edges: Iterable[Event], reason: str) -> None:
        """Count rows, at least one, judged in the place of the monitor; `reason` of the last."""
        self._reason = reason
        published = columns.stamp[columns.published]
        self._rows += len(columns)
        self._stamp, self._now = int(columns.stamp[-1]), int(columns.log_time[-1])
        if len(published):
            self._first = self._first if self._states else int(published[0])
            self._last = int(published[-1])
            self._states += len(published)
        for edge in edges:
            self._note(edge, edge.stamp)

    def outcome(self) -> AxisOutcome:
        """Return what the axis comes to so far."""
        monitor = self._monitor
        if monitor.event.active:
            self._note(monitor.event, self._stamp)
        return AxisOutcome(
            axis=self.axis,
            first=self._first,
            last=self._last,
            rows=self._rows,
            states=self._states,
            judged=monitor.judged,
            totals=monitor.totals,
            events=tuple(self._events[number] for number in sorted(self._events)),
            inputs=monitor.input_status(self._now),
            refused=monitor.refused,
            limits=monitor.settings.limits,
            reason=self._reason,
        )

    def _take(self, instant: Instant) -> None:
        self._waiting.append(row_of(instant))
        self._rows += 1
        self._stamp, self._now = instant.stamp, instant.now
        self._reason = instant.estimate.reason
        if instant.edge is not None:
            self._note(instant.edge, instant.stamp)
        if instant.published:
            self._first = self._first if self._states else instant.stamp
            self._last = instant.stamp
            self._states += 1

    def _note(self, event: Event, until: int) -> None:
        self._events[event.number] = event_record(event, until=until)


def row_of(instant: Instant) -> Row:
    """Return what a row holds, in the order of COLUMNS."""
    point, result, verdict = instant.point, instant.estimate, instant.verdict
    return (
        instant.stamp,
        instant.now,
        point.speed,
        point.axial_load,
        point.temperature,
        point.motor_torque,
        point.speed_source,
        point.axial_load_source,
        point.temperature_source,
        point.motor_torque_source,
        point.direction,
        result.validity,
        result.efficiency,
        result.rcs,
        result.film_ratio,
        math.nan if result.numbers is None else result.numbers.friction_torque,
        result.machine_torque,
        point.axial_load_uncertainty,
        result.worst_nut,
        result.regime,
        result.contact_state,
        gate_bits(verdict),
        verdict.zone,
        reason_of(point, result, verdict),
        instant.level,
        instant.event.number,
        instant.tick,
        instant.published,
    )


def columns_of(axis: str, rows: Iterable[Row]) -> JudgedColumns:
    """Return rows as columns; there must be at least one."""
    pairs = zip(COLUMNS.items(), zip(*rows, strict=True), strict=True)
    return JudgedColumns(
        axis=axis, **{name: np.array(values, dtype=kind) for (name, kind), values in pairs}
    )


def gate_bits(verdict: Verdict) -> int:
    """Return the gates that are shut as bits."""
    return sum(1 << (gate - Gate.STANDSTILL) for gate in verdict.gates)


def reason_of(point: MachinePoint, result: PointEstimate, verdict: Verdict) -> Reason:
    """Return why the zone is unknown, if it is."""
    if verdict.zone is not Zone.UNKNOWN:
        return Reason.JUDGED
    if Gate.STANDSTILL in verdict.gates:  # whatever else is missing, there is nothing to judge
        return Reason.STANDSTILL
    if result.validity is PointValidity.NO_INPUT:
        return _lost(point)
    if point.derived is not None and result.validity is PointValidity.UNKNOWN:
        return Reason.NO_DERIVED_LOAD
    return BY_VALIDITY[result.validity]


def _lost(point: MachinePoint) -> Reason:
    inputs = (
        (Reason.NO_SPEED, point.speed, point.speed_source),
        (Reason.NO_LOAD, point.axial_load, point.axial_load_source)
        if point.derived is None
        else (Reason.NO_TORQUE, point.motor_torque, point.motor_torque_source),
        (Reason.NO_TEMPERATURE, point.temperature, point.temperature_source),
    )
    lost = [
        reason
        for reason, value, source in inputs
        if not math.isfinite(value) or source is PointSource.HELD
    ]
    return lost[0] if len(lost) == 1 else Reason.NO_INPUTS
