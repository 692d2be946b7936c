# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Stamped quantities in SI units out of the columns of a table, by the map, in blocks of rows.

Speeds that do not make the positions beside them are told, with the unit in which they would.

"""

from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
import dataclasses
import itertools
import math
from pathlib import Path

from ballscrew_monitor.core import conversions
from ballscrew_monitor.core.conversions import SECOND
from ballscrew_monitor.recordings.tables import sources
from ballscrew_monitor.recordings.tables.amounts import fault_of_speed
from ballscrew_monitor.recordings.tables.cells import Array
from ballscrew_monitor.recordings.tables.dates import dated
from ballscrew_monitor.recordings.tables.doubts import (
    doubts_of_columns,
    doubts_of_motion,
    motion_of,
    of_other_axes,
    of_slope,
    with_sign,
)
from ballscrew_monitor.recordings.tables.estimates import is_within_turn, NEAR, Turns
from ballscrew_monitor.recordings.tables.mapping import AxisMap, TableMap
from ballscrew_monitor.recordings.tables.quantities import MOTION
from ballscrew_monitor.recordings.tables.read import open_table, Table
from ballscrew_monitor.recordings.tables.stated_rate import doubts_of_rate, other_period
from ballscrew_monitor.recordings.tables.time_gate import INSTEAD, run_offsets
from ballscrew_monitor.recordings.tables.times import groups_of, in_step, joined, line, Rows, Times
from ballscrew_monitor.recordings.words import short, Shown, shown_progress
from ballscrew_monitor.settings.parameters import MOTOR_TORQUE
import numpy as np
from numpy.typing import NDArray
from surrogate.files import InputError
from surrogate.units import TURN

BETWEEN = 2.0  # [s] between runs, at least: longer than a sample is fresh
MOST_NAMED = 5  # parts of a file in a sentence
LONG_GAP = 20.0  # times the usual time between rows, the same
LONG = 3.0  # times the usual time between rows: across more the speed is not known
DOUBTFUL = 0.45  # of a turn between rows: noise may make it a motion the other way
OF_ONE_TURN = (
    'stays within a turn: where it jumps by more than half of one, the axis is taken to go on'
)
TOGETHER = 16  # rows whose way is compared with their speed
ALIKE = 0.9  # squared correlation from which a speed and its position are of one motion


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class Series:
    """
    A log by rows, and what was wrong with it.

    `count` is the number of those with a time, `rows` that of each group that should have one,
    `usual_period` the time between them [s].

    `mapping` is that by which it is read, without the columns that hold nothing; `begin` and `end`
    are the first and the last stamp [ns], `run_begins` the first of each run and `run_borders`
    those in the pauses between them; `unread` says why parts of the file are not read, `more_rows`
    of which have the same columns. Columns of
    one time are a group, of which `places` names that of each quantity. The rows themselves are
    read when they are asked for.

    """

    count: int
    rows: tuple[int, ...]
    usual_period: float
    begin: int
    end: int
    run_begins: tuple[int, ...]
    run_borders: tuple[int, ...]
    notes: tuple[str, ...]
    unread: Mapping[str, str]
    more_rows: int
    mapping: TableMap
    places: Mapping[str, int]
    _times: tuple[Times, ...]
    _turns: Mapping[str, float]

    @property
    def counts(self) -> tuple[int, ...]:
        """Return the rows of each group."""
        return tuple(times.count for times in self._times)

    def blocks(self) -> Iterator[list[Rows]]:
        """
        Yield the rows in blocks, a list of those of each group, the columns such as `x.load`.

        Speed [rad/s], position [rad] and torque [N m] of the screw, position of the table [m],
        load on the nut [N] and oil temperature [degC], machine frame, NaN where not known: those
        of `quantities_of`.

        """
        streams = [self._group(number, times) for number, times in enumerate(self._times)]
        if len(streams) == 1:
            yield from ([rows] for rows in streams[0])
        else:
            yield from in_step(streams)

    def _group(self, number: int, times: Times) -> Iterator[Rows]:
        """Yield the rows of a group."""
        held = [
            (axis, {kind for kind in quantities_of(axis) if self.of(axis, kind) == number})
            for axis in self.mapping.axes
        ]
        every = self._with_turns(times)
        blocks: Iterable[tuple[Rows, slice]] = ((rows, slice(None)) for rows in every)
        if any('speed' in kinds and 'speed' not in axis.columns for axis, kinds in held):
            blocks = _with_neighbours(every)
        for rows, part in blocks:
            columns: dict[str, Array] = {}
            for axis, kinds in held:
                quantities = _axis(axis, kinds, rows, part, self)
                columns |= {f'{axis.name}.{kind}': one for kind, one in quantities.items()}
            yield Rows(stamps=rows.stamps[part], columns=columns)

    def _with_turns(self, times: Times) -> Iterator[Rows]:
        """Yield the rows of a group; positions that begin again after each turn go on."""
        turns = {name: turn for name, turn in self._turns.items() if name in times.group.columns}
        scales = {name: Turns(turn) for name, turn in turns.items()}
        stamps, ends = np.zeros(0, np.int64), dict.fromkeys(turns, np.zeros(0))
        for rows in times.rows():
            steps = np.diff(np.append(stamps, rows.stamps))
            soon = steps <= int(LONG * SECOND * times.usual_period)
            columns = {name: scale.counted(rows.columns[name]) for name, scale in scales.items()}
            for name, places in columns.items():
                moved = np.abs(np.diff(np.append(ends[name], places)))[soon] / turns[name]
                if (moved > DOUBTFUL).any():
                    raise InputError(
                        f'{short(name)} begins again after each turn, and moves by up to '
                        f'{np.nanmax(moved):.2g} turns from row to row, which may be of either '
                        f'direction above {DOUBTFUL:g}: record more rows in a second, or take it '
                        'out of the map'
                    )
                ends[name] = places[-1:]
            stamps = rows.stamps[-1:]
            yield dataclasses.replace(rows, columns={**rows.columns, **columns})

    def of(self, axis: AxisMap, kind: str) -> int:
        """Return the group in which a quantity of an axis is."""
        return self.places[source_of(axis, kind)]


def source_of(axis: AxisMap, kind: str) -> str:
    """Return the column of which a quantity is made; an unknown one has that of the speed."""
    held = axis.columns
    motor = 'torque' if 'torque' in held else 'current'
    choices = {
        'speed': ('speed', 'position'),
        'torque': (motor,),
        'load': ('load', motor if axis.load_from in ('torque', 'current') else '', *MOTION),
    }.get(kind, (kind,))
    return next(held[one].name for one in choices if one in held)


def quantities_of(axis: AxisMap) -> set[str]:
    """Return what is known of an axis by rows: its speed, and what the log holds otherwise."""
    held = {'speed', *({'position', 'table_position', 'temperature'} & set(axis.columns))}
    motor = {kind for kind in ('torque', 'current') if kind in axis.columns}
    if 'torque' in motor or (motor and math.isfinite(axis.motor_torque('current'))):
        held.add('torque')
    return held if axis.load_from == MOTOR_TORQUE else held | {'load'}


def read_series(path: Path, mapping: TableMap, shown: Shown = shown_progress) -> Series:
    """
    Return the log at `path` read by the map, and show how far that is.

    Raises InputError when it cannot be read by the map.

    """
    source = sources.source_of(path, mapping.layout, mapping.sheet)
    mapping = dated(source, mapping)
    columns = mapping.columns
    table = open_table(
        source,
        columns,
        layout=mapping.layout,
        decimal=mapping.decimal,
        order=mapping.order,
        optional=columns,
        marks=mapping.marks,
        shown=shown,
    )
    for name in mapping.time_columns:
        if name in table.left_out:
            raise InputError(f'{table.left_out[name]}: name a time that is read, or {INSTEAD}')
    inputs = {
        f'axes.{axis.name}.{kind}': column.name
        for axis in mapping.axes
        for kind, column in axis.columns.items()
    }
    of_rate = doubts_of_rate(mapping.rate, inputs, table) if mapping.time is None else ()
    for doubt in itertools.chain(of_rate, doubts_of_columns(mapping, table)):
        raise InputError(f'log {path}: {doubt}')
    axes = [_readable(axis, table.left_out) for axis in mapping.axes]
    moving = [_moving(axis, table) for axis in axes]
    turns = dict(_turns_of(axes, table))
    signed = [with_sign(path, axis, table, turns) for axis, _ in moving]
    held = dataclasses.replace(mapping, axes=tuple(axis for axis, _ in signed))
    times = [Times(table, held, group, shown) for group in groups_of(table, held)]
    for doubt in doubts_of_motion(held, table, turns, times):
        raise InputError(f'log {path}: {doubt}')
    _look_at_slopes(held, turns, times)
    run_begins, run_borders = _place(path, times)
    notes = [note for one in times for note in one.notes()]
    period = next(one.mean_period for one in times if one.group.is_motion)
    notes += [f'log {path}: {why}' for why in [other_period(source.head, mapping, period)] if why]
    unread, more_rows = table.source.unread(columns), table.source.rows_alike(columns)
    return Series(
        count=sum(one.count for one in times),
        rows=tuple((one.count if one.group.hold else one.promised) + more_rows for one in times),
        usual_period=max(one.usual_period for one in times if one.count > 1),
        begin=times[0].begin,
        end=max(one.end for one in times),
        run_begins=(times[0].begin, *run_begins),
        run_borders=tuple(run_borders),
        notes=(
            *_unread(path, unread),
            *of_other_axes(mapping),
            *_losses(mapping, table.left_out),
            *filter(None, (note for _, note in [*moving, *signed])),
            *table.notes,
            *(f'{short(name)} {OF_ONE_TURN}' for name in turns),
            *dict.fromkeys(notes),
        ),
        unread=unread,
        more_rows=more_rows,
        mapping=held,
        places={name: at for at, one in enumerate(times) for name in one.group.columns},
        _times=tuple(times),
        _turns=turns,
    )


def _moving(axis: AxisMap, table: Table) -> tuple[AxisMap, str]:
    """Return an axis without a speed that cannot be that of its position; a note."""
    if not set(MOTION) <= set(axis.columns):
        return axis, ''
    speed, position = (axis.columns[kind].name for kind in MOTION)
    places = table.readings[position].extremes, table.sampled(position)
    fault = fault_of_speed(table.readings[speed].extremes, *places)
    if not fault:
        return axis, ''
    columns = {kind: column for kind, column in axis.columns.items() if kind != 'speed'}
    return dataclasses.replace(axis, columns=columns), of_slope(axis.name, speed, fault)


def _look_at_slopes(mapping: TableMap, turns: Mapping[str, float], times: Sequence[Times]) -> None:
    """Take the rows of positions that tell a speed as even where they are; may ask."""
    for axis in mapping.axes:
        name = motion_of(axis).name
        if 'speed' in axis.columns:
            continue
        counted = Turns(turns[name]).counted if name in turns else np.asarray
        group = next(one for one in times if name in one.group.columns)
        if mapping.time is None:
            group.check_ways(name, counted)
        elif not group.group.hold:
            group.look_at_slope(name, counted)


def _turns_of(axes: Iterable[AxisMap], table: Table) -> Iterator[tuple[str, float]]:
    """Yield the columns of positions that stay within a turn, and how long that is in each."""
    for axis in axes:
        column = axis.columns.get('position')
        if column is None or column.unit not in conversions.ROTARY_POSITION_UNITS:
            continue
        turn = TURN / abs(column.scale * conversions.ROTARY_POSITION_UNITS[column.unit])
        if is_within_turn(table.readings[column.name].extremes, turn):
            yield column.name, turn


def _place(path: Path, times: Sequence[Times]) -> tuple[list[int], list[int]]:
    """
    Let the runs of all groups follow each other, and all stamps count from the first time.

    Return the first stamps [ns] of all runs but the first, and stamps in the pauses before them.

    """
    motion = [one for one in times if one.group.is_motion]
    runs = len(motion[0].gate.runs)
    for one in times:
        if len(one.gate.runs) > runs > 1 or (one in motion and len(one.gate.runs) != runs):
            raise InputError(
                f'log {path}: time begins again {runs - 1} times for '
                f'{short(motion[0].group.columns[0])} and {len(one.gate.runs) - 1} times for '
                f'{short(one.group.columns[0])}: split the log there'
            )
    gap = max(BETWEEN, *(LONG_GAP * one.gate.step for one in motion))
    alike = [one.gate for one in times if len(one.gate.runs) == runs]
    offsets, begins = run_offsets(alike, gap)
    for one in times:
        one.place(offsets, motion[0], begins)
    begin = min(one.first for one in times)
    for one in times:
        one.since(begin)
    return times[0].stamps(begins), times[0].stamps([begin - gap / 2 for begin in begins])


def _readable(axis: AxisMap, left_out: Mapping[str, str]) -> AxisMap:
    """Return an axis without the columns that cannot be read; raises InputError without motion."""
    for kind in ('speed', 'position'):
        if kind in axis.columns and not set(MOTION) & set(axis.without(left_out).columns):
            raise InputError(
                f'{left_out[axis.columns[kind].name]}: name another column for '
                f'axes.{axis.name}.{kind} in the map'
            )
    return axis.without(left_out)


def _unread(path: Path, unread: Mapping[str, str]) -> list[str]:
    """Return in a sentence which parts of a file are not read, and why."""
    parts = [f'{short(name)}, as {why}' for name, why in unread.items()]
    more = [f'and {len(parts) - MOST_NAMED} more'] if len(parts) > MOST_NAMED else []
    words = '; '.join([*parts[:MOST_NAMED], *more])
    return [f'log {path}: not read of this file: {words}'] if parts else []


def _losses(mapping: TableMap, left_out: Mapping[str, str]) -> list[str]:
    """Return what is judged without which column, and what to write in the map."""
    return [
        f'{left_out[column.name]}: axis {axis.name} is judged without its {kind}, name another '
        f'column for axes.{axis.name}.{kind} in the map'
        for axis in mapping.axes
        for kind, column in axis.columns.items()
        if column.name in left_out
    ]


def _with_neighbours(blocks: Iterable[Rows]) -> Iterator[tuple[Rows, slice]]:
    """Yield blocks with the row before and the row after, and which rows are those between."""
    before: Rows | None = None
    now: Rows | None = None
    for later in itertools.chain(blocks, [None]):
        if now is not None:
            first = 0 if before is None else len(before.stamps)
            window = [before, now, None if later is None else later[:1]]
            held = joined([rows for rows in window if rows is not None])
            yield held, slice(first, first + len(now.stamps))
            before = now[-1:]
        now = later


def _axis(
    axis: AxisMap, known: Collection[str], rows: Rows, part: slice, log: Series
) -> dict[str, Array]:
    """Return known quantities of an axis in a part of the rows of a log."""

    def column(kind: str, factor: float, part: slice = part) -> Array:
        found = axis.columns[kind]
        return line(rows.columns[found.name][part], found, factor)

    def unit(kind: str) -> str:
        return axis.columns[kind].unit if kind in axis.columns else ''

    def motor(kind: str) -> Array:
        torque = column(kind, axis.motor_torque(kind))
        if not axis.columns[kind].magnitude:
            return torque
        return np.copysign(np.abs(torque), found['speed'] + 0.0)

    held = axis.columns.keys()
    linear, rotary = conversions.LINEAR_POSITION_UNITS, conversions.ROTARY_POSITION_UNITS
    turned = _turned(unit('position'), linear, rotary, TURN / axis.lead)
    found: dict[str, Array] = {}
    if 'position' in known:
        found['position'] = column('position', turned)
    if 'table_position' in known:
        found['table_position'] = column('table_position', linear[unit('table_position')])
    if 'speed' in known and 'speed' in held:
        found['speed'] = column('speed', speed_factor(unit('speed'), axis.lead))
    elif 'speed' in known:
        position = column('position', turned, slice(None))
        found['speed'] = _slope(position, rows.stamps, log)[part]
    kind = 'torque' if 'torque' in held else 'current'
    if 'torque' in known:
        found['torque'] = motor(kind)
    if 'load' in known and 'load' in held:
        found['load'] = column('load', conversions.LOAD_UNITS[unit('load')])
    elif 'load' in known and axis.load_from in ('torque', 'current'):
        torque = motor(kind)
        found['load'] = force_of(torque, lead=axis.lead, efficiency=axis.efficiency)
    elif 'load' in known:
        found['load'] = np.full(len(rows.stamps[part]), math.nan)
    if 'temperature' in known:
        zero = conversions.TEMPERATURE_UNITS[unit('temperature')]
        found['temperature'] = column('temperature', 1.0) + zero + conversions.celsius(0.0)
    return found


def force_of(torque: Array, *, lead: float, efficiency: float) -> Array:
    """
    Return the force on the nut [N] that a motor torque [N m] holds, all of it taken for load.

    force = 2 pi efficiency torque / lead, lead [m], against the torque; efficiency [-].

    """
    return 0.0 - TURN * efficiency * torque / lead


def speed_factor(unit: str, lead: float) -> float:
    """Return the factor from a unit of speed to that of a screw of a lead [m] in [rad/s]."""
    return _turned(
        unit, conversions.LINEAR_SPEED_UNITS, conversions.ROTARY_SPEED_UNITS, TURN / lead
    )


def _turned(
    unit: str, linear: dict[str, float], rotary: dict[str, float], per_metre: float
) -> float:
    """Return the factor from a unit to that of the screw in [rad]."""
    return linear[unit] * per_metre if unit in linear else rotary.get(unit, 1.0)


def _slope(position: Array, stamps: NDArray[np.int64], log: Series) -> Array:
    """
    Return the speed of positions at stamps [ns], of each run of a log by itself.

    Rows of one time give none of their own.

    """
    runs = np.searchsorted(log.run_borders, stamps)
    seconds = (stamps - np.array(log.run_begins)[runs]) / SECOND
    places = np.flatnonzero(np.diff(runs)) + 1
    with np.errstate(divide='ignore', invalid='ignore'):
        slope = np.concatenate(
            [
                np.gradient(values, times) if len(times) > 1 else np.full(len(times), math.nan)
                for values, times in zip(
                    np.split(position, places), np.split(seconds, places), strict=True
                )
            ]
        )
    return np.where(np.isfinite(slope), slope, math.nan)


def fits_of(series: Series) -> list['Fit']:
    """Return what compares speed and position of each axis in rows that have both."""
    return [
        Fit(axis, LONG * series.usual_period)
        for axis in series.mapping.axes
        if set(MOTION) <= set(axis.columns)
        and series.of(axis, 'speed') == series.of(axis, 'position')
    ]


class Fit:
    """How far an axis moves by its position, over how far by its speed, by least squares."""

    def __init__(self, axis: AxisMap, longest: float) -> None:
        """Begin with no row of an axis; rows `longest` [s] apart have no gap between them."""
        self._axis, self._longest = axis, longest
        self._across = self._by_speed = self._by_position = 0.0

    def add(self, rows: Rows) -> None:
        """Take further rows."""
        steps, name = np.diff(rows.stamps) / SECOND, self._axis.name
        if f'{name}.speed' not in rows.columns:
            return
        speed, position = (rows.columns[f'{name}.{kind}'] for kind in MOTION)
        expected = (speed[1:] + speed[:-1]) / 2 * steps
        moved = np.diff(position)
        good = np.isfinite(expected) & np.isfinite(moved) & (steps <= self._longest)
        if not good.any():
            return
        # Over several rows together the stamps may be rounded.
        moved, expected = (
            np.add.reduceat(np.where(good, each, 0.0), np.arange(0, len(good), TOGETHER))
            for each in (moved, expected)
        )
        with np.errstate(over='ignore', invalid='ignore'):
            self._across += float(moved @ expected)
            self._by_speed += float(expected @ expected)
            self._by_position += float(moved @ moved)

    def note(self) -> str:
        """Return a sentence if both are of one motion but differ in size or sign, else nothing."""
        both = math.sqrt(self._by_speed) * math.sqrt(self._by_position)
        if not 0.0 < both < math.inf or abs(self._across) < math.sqrt(ALIKE) * both:
            return ''
        factor = self._across / self._by_speed
        if abs(factor - 1.0) <= NEAR:
            return ''
        return (
            f'axis {self._axis.name}: its position moves {factor:.4g} times as far as its speed '
            f'in {self._axis.columns["speed"].unit} says: {self._advice(factor)}'
        )

    def _advice(self, factor: float) -> str:
        if factor < 0.0:
            return 'one of both has the wrong sign of its scale'
        needed = factor * speed_factor(self._axis.columns['speed'].unit, self._axis.lead)
        misses = {
            unit: abs(speed_factor(unit, self._axis.lead) / needed - 1.0)
            for unit in conversions.SPEED_UNITS
        }
        best = min(misses, key=misses.__getitem__)
        if misses[best] <= NEAR:
            return f'{best} fits, if unit and scale of the position are right'
        return 'check units and scales of both, the time and the lead'
