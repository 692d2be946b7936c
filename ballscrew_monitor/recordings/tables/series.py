# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""From the columns of a table to stamped quantities in SI units, by the map."""

import dataclasses
import math
from pathlib import Path

from ballscrew_monitor.core.conversions import (
    celsius,
    CURRENT_UNITS,
    LINEAR_POSITION_UNITS,
    LINEAR_SPEED_UNITS,
    LOAD_UNITS,
    ROTARY_POSITION_UNITS,
    ROTARY_SPEED_UNITS,
    SECOND,
    TEMPERATURE_UNITS,
    TIME_UNITS,
)
from ballscrew_monitor.recordings.tables.mapping import AxisMap, Column, TableMap
from ballscrew_monitor.recordings.tables.read import Array, read_table, Table
import numpy as np
from numpy.typing import NDArray
from surrogate.files import InputError
from surrogate.units import TURN

Stamps = NDArray[np.int64]

LATEST = (1 << 31) * SECOND  # [ns] a stamp holds no later time
HUGE_GAP = 100  # times the usual time between rows


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class AxisSeries:
    """
    One axis by rows, NaN where a quantity is not known.

    Speed [rad/s], position [rad] and torque [N m] of the screw, force on the nut [N] and oil
    temperature [degC], machine frame; None for what the log does not hold, but for the speed, and
    for a load that the node works out.

    """

    name: str
    speed: Array
    load: Array | None
    position: Array | None
    torque: Array | None
    temperature: Array | None


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class Series:
    """Rows in the order of their stamps [ns], the axes, and what was wrong with the log."""

    stamps: Stamps
    axes: tuple[AxisSeries, ...]
    notes: tuple[str, ...]

    @property
    def usual_period(self) -> float:
        """Return the time between rows [s] that half of them keep."""
        return float(np.median(np.diff(self.stamps))) / SECOND


def read_series(path: Path, mapping: TableMap) -> Series:
    """Return the log at `path` read by the map; raises InputError when that is impossible."""
    table = read_table(path, mapping.columns)
    notes = list(table.notes)
    times = _times(table, mapping)
    rows, stamps = _order(path, times, mapping, notes)
    if len(rows) < 2:
        raise InputError(f'log {path} holds {len(rows)} rows with a time, at least two are needed')
    axes = tuple(_axis(axis, table, rows, stamps) for axis in mapping.axes)
    _note_gaps(path, stamps, notes)
    return Series(stamps=stamps, axes=axes, notes=tuple(notes))


def _times(table: Table, mapping: TableMap) -> Array:
    """Return the time of each row [s], as the log counts it."""
    if mapping.time is None:
        return np.arange(table.rows) / mapping.rate
    return _line(table.columns[mapping.time.name], mapping.time, TIME_UNITS[mapping.time.unit])


def _order(
    path: Path, times: Array, mapping: TableMap, notes: list[str]
) -> tuple[NDArray[np.intp], Stamps]:
    """Return the rows with a time in the order of it, and their stamps."""
    known = np.flatnonzero(np.isfinite(times))
    if len(known) < len(times):
        notes.append(f'log {path}: {len(times) - len(known)} rows without a time are left out')
    if not len(known):
        return known, np.zeros(0, np.int64)
    back = int((np.diff(times[known]) < 0.0).sum())
    if back:
        notes.append(f'log {path}: {back} rows are earlier than the row before, they were sorted')
    rows = known[np.argsort(times[known], kind='stable')]
    begin, ordered = times[rows[0]], times[rows]
    shift = 0 if mapping.epoch is None else mapping.epoch
    seconds = ordered if mapping.epoch is None else ordered - begin
    if seconds[-1] * SECOND + shift >= LATEST or seconds[0] * SECOND + shift <= 0:
        raise InputError(
            f'log {path}: its times are {ordered[0]:g} to {ordered[-1]:g} s, which give no stamps '
            'after 1970 and before 2038: correct time.unit, or state a time.epoch'
        )
    return rows, np.round(seconds * SECOND).astype(np.int64) + shift


def _axis(axis: AxisMap, table: Table, rows: NDArray[np.intp], stamps: Stamps) -> AxisSeries:
    def column(kind: str, factor: float) -> Array | None:
        found = axis.columns.get(kind)
        return None if found is None else _line(table.columns[found.name], found, factor)[rows]

    def unit(kind: str) -> str:
        return axis.columns[kind].unit if kind in axis.columns else ''

    per_metre = TURN / axis.lead
    position = column(
        'position',
        _turned(unit('position'), LINEAR_POSITION_UNITS, ROTARY_POSITION_UNITS, per_metre),
    )
    speed = column(
        'speed', _turned(unit('speed'), LINEAR_SPEED_UNITS, ROTARY_SPEED_UNITS, per_metre)
    )
    if speed is None:
        assert position is not None  # the map has one of them
        speed = _slope(position, stamps)
    torque = column('torque', 1.0)
    current = column('current', CURRENT_UNITS.get(unit('current'), 1.0))
    if torque is None and current is not None and math.isfinite(axis.torque_constant):
        torque = current * axis.torque_constant
    load = column('load', LOAD_UNITS.get(unit('load'), 1.0))
    if load is None:
        load = _load_without_column(axis, torque, len(rows))
    warmth = column('temperature', 1.0)
    zero = TEMPERATURE_UNITS.get(unit('temperature'), 0.0)
    return AxisSeries(
        name=axis.name,
        speed=speed,
        load=load,
        position=position,
        torque=torque,
        temperature=None if warmth is None else np.vectorize(celsius)(warmth + zero),
    )


def _load_without_column(axis: AxisMap, torque: Array | None, count: int) -> Array | None:
    """Return the load of an axis as the map says, None if the node is to work it out."""
    if axis.load_from == 'motor_torque':
        return None
    if not axis.load_from or torque is None:
        return np.full(count, math.nan)
    return force_of(torque, lead=axis.lead, efficiency=axis.efficiency)


def force_of(torque: Array, *, lead: float, efficiency: float) -> Array:
    """
    Return the force on the nut [N] that a motor torque [N m] holds, all of it taken for load.

    force = 2 pi efficiency torque / lead, lead [m], against the torque; efficiency [-].

    """
    return 0.0 - TURN * efficiency * torque / lead


def _turned(
    unit: str, linear: dict[str, float], rotary: dict[str, float], per_metre: float
) -> float:
    """Return the factor from a unit to that of the screw in [rad]."""
    return linear[unit] * per_metre if unit in linear else rotary.get(unit, 1.0)


def _line(values: Array, column: Column, factor: float) -> Array:
    return (values * column.scale + column.offset) * factor


def _slope(position: Array, stamps: Stamps) -> Array:
    """Return the speed of positions; rows of one time give none of their own."""
    seconds = (stamps - stamps[0]) / SECOND
    with np.errstate(divide='ignore', invalid='ignore'):
        slope = np.asarray(np.gradient(position, seconds))
    return np.where(np.isfinite(slope), slope, math.nan)


def _note_gaps(path: Path, stamps: Stamps, notes: list[str]) -> None:
    steps = np.diff(stamps)
    usual = float(np.median(steps))
    long = np.flatnonzero(steps > HUGE_GAP * usual) if usual > 0 else np.zeros(0, np.intp)
    if len(long):
        longest = int(steps.argmax())
        notes.append(
            f'log {path}: {len(long)} gaps are longer than {HUGE_GAP} rows, the longest is '
            f'{steps[longest] / SECOND:.4g} s, after row {longest + 1}; nothing is judged in them'
        )
