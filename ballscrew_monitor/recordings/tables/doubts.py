# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Doubts about the inputs of a log, which its map has to settle: signs, directions, gaps, factors.

A first map asks by the same sentences for which a log is refused whose map leaves them open.

"""

from collections.abc import Collection, Iterator, Mapping, Sequence
import dataclasses
from pathlib import Path

from ballscrew_monitor.recordings.tables.amounts import (
    are_amounts,
    brakes_always,
    fault_of_slope,
    opposes,
    slopes,
    stays_in_gaps,
)
from ballscrew_monitor.recordings.tables.cells import Array
from ballscrew_monitor.recordings.tables.estimates import marks_of_none, Turns
from ballscrew_monitor.recordings.tables.interleaved import cells_of_sources, of_several
from ballscrew_monitor.recordings.tables.mapping import AxisMap, Column, MOTOR, SIGNED, TableMap
from ballscrew_monitor.recordings.tables.names import axis_of_all, LINEAR, read_name
from ballscrew_monitor.recordings.tables.quantities import MOTION
from ballscrew_monitor.recordings.tables.read import Table
from ballscrew_monitor.recordings.tables.times import line, SHOWING, Times
from ballscrew_monitor.recordings.words import counted, short
import numpy as np
from surrogate.files import InputError

OF_SLOPE = 'the speed is the slope of the position'
ONE_SIGN = {
    **dict.fromkeys(
        MOTOR,
        'never changes its sign while the axis reverses, as amounts do, and a torque that holds a '
        'weight',
    ),
    'load': 'never changes its sign while the axis reverses, as amounts do, and a weight',
    'speed': 'never changes its sign, but the torque or force turns between motions, as beside '
    'amounts',
}
"""What makes a sign doubtful, by quantity."""
FARTHEST = 1e100  # position in whatever unit, so that squares of what is moved have a sum


def of_slope(axis: str, speed: str, fault: str) -> str:
    """Return why the speed of an axis is worked out from its position."""
    return f'axis {axis}: {short(speed)} {fault}: {OF_SLOPE}'


def of_amounts(axis: str, kind: str, column: str) -> str:
    """Return what is wrong with a torque or current that has the sign of the motion."""
    return (
        f'axis {axis}: {short(column)} never changes its sign while the axis reverses: its '
        f'{kind} is taken with the sign of the motion, which is wrong where the axis brakes or '
        'the load drives it'
    )


def unclear_sign(axis: str, kind: str, column: str, *, apart: bool) -> str:
    """Return what decides whether a column of one sign holds amounts, at times of its own."""
    why = f'{short(column)} {ONE_SIGN[kind]}'
    if apart or kind not in MOTOR:
        also = ', and amounts need the times of the motion' if apart else ''
        return (
            f'state `axes.{axis}.{kind}.magnitude: false` in the map if it has a sign, else take '
            f'the column out of the map: {why}{also}'
        )
    return f'state axes.{axis}.{kind}.magnitude in the map, true or false: {why}'


def unclear_brake(axis: str, kind: str, column: str, scale: float = 1.0) -> str:
    """Return what decides whether a torque against all motion has the wrong sign."""
    return (
        f'state axes.{axis}.{kind}.scale in the map, {-scale:g} if the sign of {short(column)} is '
        f'turned, {scale:g} if a load drives the axis both ways: it is against the motion in both '
        'directions, at steady speeds too, where friction asks for a torque that goes with it'
    )


def unclear_direction(axis: str, speed: str, position: str) -> str:
    """Return what decides which of a speed and a position of other signs is right."""
    return (
        f'state axes.{axis}.speed.scale or axes.{axis}.position.scale in the map: '
        f'{short(position)} moves against {short(speed)}, a scale below 0 turns that one of both '
        'whose sign is not that of the axis'
    )


def unclear_gaps(axis: str, kind: str, column: str) -> str:
    """Return what decides whether a value that is the same after a gap has stayed."""
    return (
        f'state axes.{axis}.{kind}.hold in the map, true if {short(column)} was written when it '
        'changed, false if nothing is known in gaps: it is the same before and after gaps, in '
        'motion'
    )


def unclear_none(
    axis: str, kind: str, column: str, values: Array, stated: Sequence[float] = ()
) -> str:
    """Return what decides whether numbers stand for no value beside stated ones, if any may."""
    marks = marks_of_none(values)
    if not marks:
        return ''
    words, every, known = (
        [f'{one:.12g}' for one in some] for some in (marks, sorted({*stated, *marks}), stated)
    )
    stand, if_not, them = ('stand', 'they are values', 'them')
    if len(marks) == 1:
        stand, if_not, them = ('stands', 'it is one', 'it')
    rows = [counted(int(np.count_nonzero(values == one)), 'row') for one in marks]
    emptied = f' and leave the cells of {" and ".join(known)} empty' if stated else ''
    return (
        f'state axes.{axis}.{kind}.none in the map, [{", ".join(every)}] if {" and ".join(words)} '
        f'{stand} for no value, []{emptied} if {if_not}: {short(column)} holds {them} in '
        f'{" and ".join(rows)}, far beyond all others'
    )


def unclear_factors(factors: str) -> str:
    """Return what decides by what columns are scaled of which the head states factors."""
    return (
        f'its head states {short(repr(factors))}: state `scale` and `offset` of these columns in '
        'the map, or take that row out if the cells hold it'
    )


def are_apart(table: Table, one: str, other: str) -> bool:
    """Return True if two columns of one time have their samples in different rows."""
    return table.readings[one].holes != table.readings[other].holes


def with_sign(
    path: Path, axis: AxisMap, table: Table, turns: Mapping[str, float]
) -> tuple[AxisMap, str]:
    """
    Return an axis whose torque or current says whether it holds amounts; a note if it does.

    Raises InputError where neither the rows nor the map tell whether a column has a sign.

    """
    kinds = [kind for kind in SIGNED if kind in axis.columns]
    data, motion, note = _sampled(axis, table, turns), motion_of(axis), ''
    for kind in kinds:
        column = axis.columns[kind]
        if column.magnitude is None:
            magnitude = are_amounts(
                kind, data, makes_load=bool(axis.load_from), own_time=column.time != motion.time
            )
            if magnitude is None:
                apart = kind in MOTOR and are_apart(table, column.name, motion.name)
                raise InputError(
                    f'log {path}: {unclear_sign(axis.name, kind, column.name, apart=apart)}'
                )
            column = dataclasses.replace(column, magnitude=magnitude)
            axis = dataclasses.replace(axis, columns={**axis.columns, kind: column})
        if column.magnitude:
            note = of_amounts(axis.name, kind, column.name)
    return axis, note


def motion_of(axis: AxisMap) -> Column:
    """Return the speed of an axis, or the position of which it is made."""
    return axis.columns.get('speed') or axis.columns['position']


def _sampled(axis: AxisMap, table: Table, turns: Mapping[str, float]) -> dict[str, Array]:
    """Return rows of what has a sign and of the motion that span a log, in units of the map."""
    data = {}
    for kind in filter(axis.columns.__contains__, (*MOTION, *SIGNED)):
        column = axis.columns[kind]
        values = table.sampled(column.name)
        counted = Turns(turns[column.name]).counted(values) if column.name in turns else values
        data[kind] = line(counted, column, 1.0)
    return data


def doubts_of_columns(mapping: TableMap, table: Table) -> Iterator[str]:
    """Yield what is unclear of the rows and scales of columns, and wrong with positions."""
    marks = [mark.column for each in mapping.marks.values() for mark in each.held]
    by_column = cells_of_sources(table.source, {*mapping.columns, *marks})
    for name, cells in by_column.items():
        if len(cells) > 1:
            yield of_several(name, cells)
        else:
            what = f'column {short(repr(name))} says that its rows are'
            yield from _of_another_axis(mapping, what, ''.join(cells))
    what = f'sheet {short(repr(table.source.sheet))} is'
    yield from _of_another_axis(mapping, what, table.source.sheet)
    factors = table.source.head.factors
    columns = [column for axis in mapping.axes for column in axis.columns.values()]
    first = mapping.time or motion_of(mapping.axes[0])
    for column in columns:
        if fault := table.source.fault_of_length(column.name, column.time or first.name):
            yield f'{fault}: state its `time` in the map, a column of its length'
    if factors and all(column.scale == 1.0 and column.offset == 0.0 for column in columns):
        yield unclear_factors(factors)
    for axis in mapping.axes:
        for kind, column in axis.columns.items():
            stated = column.marks.none
            if column.name in table.readings and stated != ():
                values = table.sampled(column.name)
                if why := unclear_none(axis.name, kind, column.name, values, stated or ()):
                    yield why
        position = axis.columns.get('position')
        if position is None or position.name not in table.readings:
            continue
        for place in table.readings[position.name].extremes.tolist():
            if abs(place) > FARTHEST:
                unit = position.unit
                yield (
                    f'column {short(repr(position.name))} holds a position of {place:g} {unit}, '
                    f'allowed is up to {FARTHEST:g} {unit} in both directions: name another '
                    f'column for axes.{axis.name}.position in the map, or none'
                )


def _of_another_axis(mapping: TableMap, what: str, text: str) -> Iterator[str]:
    """Yield what is wrong if a text about all rows names another axis than the only one."""
    named, stated = axis_of_all(text), axis_of_all(mapping.axes[0].name)
    if len(mapping.axes) == 1 and named and stated not in ('', named):
        yield f'{what} of axis {named}, the map states axis {stated}: name axis {named} in the map'


def of_other_axes(mapping: TableMap) -> Iterator[str]:
    """Yield a sentence about each column whose name says another axis than the map does."""
    for axis in mapping.axes:
        stated = axis_of_all(axis.name)
        for kind, column in axis.columns.items():
            named = read_name(column.name)
            axis_named = named.axis[:1] if named.place == 'axis' else ''
            if stated and axis_named in LINEAR - {stated}:
                yield (
                    f'axis {axis.name}: its {kind} is {short(column.name)} by the map, which the '
                    f'name says to be of axis {axis_named}'
                )


def doubts_of_motion(
    mapping: TableMap, table: Table, turns: Mapping[str, float], times: Sequence[Times]
) -> Iterator[str]:
    """Yield what is unclear of the motion of each axis, and of the inputs beside it."""
    groups = [{*each.group.columns} for each in times]
    assumed = {one.key for one in mapping.assumptions}
    for axis in mapping.axes:
        motion = motion_of(axis).name
        for kind in filter(axis.columns.__contains__, MOTOR):
            column = axis.columns[kind]
            if column.magnitude and not any({motion, column.name} <= held for held in groups):
                yield (
                    f'{short(column.name)} holds amounts without a sign at other times than '
                    f'{short(motion)}: name another column for axes.{axis.name}.{kind} in the '
                    'map, or none'
                )
    for axis in mapping.axes:
        yield from _doubts_of_signs(axis, table, turns, assumed)
    rows: dict[str, Array] = {}
    for axis in mapping.axes if mapping.time else ():
        speed = axis.columns.get('speed')
        if mapping.time and speed and speed.hold is None:
            rows = rows or table.head(SHOWING)
            if stays_in_gaps(rows[speed.time or mapping.time.name], rows[speed.name]):
                yield unclear_gaps(axis.name, 'speed', speed.name)
    for axis in [axis for axis in mapping.axes if 'speed' not in axis.columns]:
        rows, position = rows or table.head(SHOWING), axis.columns['position'].name
        places = rows[position]
        places = Turns(turns[position]).counted(places) if position in turns else places
        if fault := fault_of_slope(places, len(times[0].gate.runs)):
            yield (
                f'{short(position)} {fault}: its slope is no speed. Name a column of the speed '
                f'for axes.{axis.name} in the map, or record the position so that its cells are '
                'empty where it is not new'
            )


def _doubts_of_signs(
    axis: AxisMap, table: Table, turns: Mapping[str, float], assumed: Collection[str]
) -> Iterator[str]:
    """Yield what is unclear of a motion, or a torque of which the load is made, by their signs."""

    def are_together(one: Column, other: Column) -> bool:
        return one.time == other.time and not are_apart(table, one.name, other.name)

    motion, data = motion_of(axis), dict[str, Array]()
    kind = next((one for one in MOTOR if one in axis.columns), '')
    if set(MOTION) <= set(axis.columns):
        speed, position = (axis.columns[kind] for kind in MOTION)
        data = _sampled(axis, table, turns)
        if are_together(speed, position) and opposes(data['speed'], data['position']):
            yield unclear_direction(axis.name, speed.name, position.name)
    if kind and axis.load_from and are_together(axis.columns[kind], motion):
        column = axis.columns[kind]
        is_scaled = column.is_scaled and f'{axis.name}.{kind}.scale' not in assumed
        if not column.magnitude and not is_scaled:
            data = data or _sampled(axis, table, turns)
            slope = data['speed'] if 'speed' in data else slopes(data['position'])
            if brakes_always(data[kind], slope):
                yield unclear_brake(axis.name, kind, column.name, column.scale)
