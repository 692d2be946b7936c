# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""From the columns of a table to stamped quantities in SI units, by the map, in blocks of rows."""

from collections.abc import Iterable, Iterator
import dataclasses
import itertools
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
)
from ballscrew_monitor.recordings.progress import Shown, silent
from ballscrew_monitor.recordings.tables.cells import Array
from ballscrew_monitor.recordings.tables.mapping import AxisMap, TableMap
from ballscrew_monitor.recordings.tables.read import open_table
from ballscrew_monitor.recordings.tables.times import line, Rows, Stamps, Times
import numpy as np
from surrogate.units import TURN


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

    def __getitem__(self, part: slice) -> 'AxisSeries':
        """Return some of the rows."""

        def cut(values: Array | None) -> Array | None:
            return None if values is None else values[part]

        return AxisSeries(
            name=self.name,
            speed=self.speed[part],
            load=cut(self.load),
            position=cut(self.position),
            torque=cut(self.torque),
            temperature=cut(self.temperature),
        )


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class Block:
    """Some rows in the order of their stamps [ns], and the axes."""

    stamps: Stamps
    axes: tuple[AxisSeries, ...]


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class Series:
    """
    A log by rows: their number, the usual time between them [s], and what was wrong with it.

    The rows themselves are read when they are asked for.

    """

    count: int
    usual_period: float
    notes: tuple[str, ...]
    _times: Times
    _mapping: TableMap

    def blocks(self) -> Iterator[Block]:
        """Yield the rows in blocks."""
        for rows, part in _with_neighbours(self._times.rows()):
            axes = tuple(_axis(axis, rows, self._times.begin)[part] for axis in self._mapping.axes)
            yield Block(stamps=rows.stamps[part], axes=axes)


def read_series(path: Path, mapping: TableMap, shown: Shown = silent) -> Series:
    """
    Return the log at `path` read by the map, and show how far that is.

    Raises InputError when it cannot be read by the map.

    """
    table = open_table(path, mapping.columns, shown=shown)
    times = Times(table, mapping, shown)
    return Series(
        count=times.count,
        usual_period=times.usual_period,
        notes=(*table.notes, *times.notes()),
        _times=times,
        _mapping=mapping,
    )


def _with_neighbours(blocks: Iterable[Rows]) -> Iterator[tuple[Rows, slice]]:
    """Yield blocks with the row before and the row after, and which rows are those between."""
    before: Rows | None = None
    now: Rows | None = None
    for later in itertools.chain(blocks, [None]):
        if now is not None:
            first = 0 if before is None else len(before.stamps)
            window = now if before is None else before + now
            window = window if later is None else window + later[:1]
            yield window, slice(first, first + len(now.stamps))
            before = now[-1:]
        now = later


def _axis(axis: AxisMap, rows: Rows, begin: int) -> AxisSeries:
    """Return an axis by rows of a log that begins at a stamp [ns]."""

    def column(kind: str, factor: float) -> Array | None:
        found = axis.columns.get(kind)
        return None if found is None else line(rows.columns[found.name], found, factor)

    def unit(kind: str) -> str:
        return axis.columns[kind].unit if kind in axis.columns else ''

    per_metre = TURN / axis.lead
    position = column(
        'position',
        _turned(unit('position'), LINEAR_POSITION_UNITS, ROTARY_POSITION_UNITS, per_metre),
    )
    speed = column('speed', speed_factor(unit('speed'), axis.lead))
    if speed is None:
        assert position is not None  # the map has one of them
        speed = _slope(position, (rows.stamps - begin) / SECOND)
    torque = column('torque', 1.0)
    current = column('current', CURRENT_UNITS.get(unit('current'), 1.0))
    if torque is None and current is not None and math.isfinite(axis.torque_constant):
        torque = current * axis.torque_constant
    load = column('load', LOAD_UNITS.get(unit('load'), 1.0))
    if load is None:
        load = _load_without_column(axis, torque, len(rows.stamps))
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


def speed_factor(unit: str, lead: float) -> float:
    """Return the factor from a unit of speed to that of a screw of a lead [m] in [rad/s]."""
    return _turned(unit, LINEAR_SPEED_UNITS, ROTARY_SPEED_UNITS, TURN / lead)


def _turned(
    unit: str, linear: dict[str, float], rotary: dict[str, float], per_metre: float
) -> float:
    """Return the factor from a unit to that of the screw in [rad]."""
    return linear[unit] * per_metre if unit in linear else rotary.get(unit, 1.0)


def _slope(position: Array, seconds: Array) -> Array:
    """Return the speed of positions at times [s]; rows of one time give none of their own."""
    with np.errstate(divide='ignore', invalid='ignore'):
        slope = np.asarray(np.gradient(position, seconds))
    return np.where(np.isfinite(slope), slope, math.nan)
