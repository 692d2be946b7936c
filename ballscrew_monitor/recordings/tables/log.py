# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
A table and the map of its columns as a log: rows are events at once, and messages if asked for.

Topics are `joint_states` with speed, position and torque of each screw, `<axis>/axial_load` and
`<axis>/oil_temperature`. Parameters of the node, map, assumptions and notes are in the metadata.

"""

from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
import math
from pathlib import Path
from typing import Any

from ballscrew_monitor.core.fields import type_name_of
from ballscrew_monitor.core.inputs import Input, Why
from ballscrew_monitor.health.stroke import Positions
from ballscrew_monitor.messages.reasons import enough_timeout
from ballscrew_monitor.recordings.bag import Bag
from ballscrew_monitor.recordings.bulk.batches import Batch, batches, END
from ballscrew_monitor.recordings.bulk.chunks import Messages
from ballscrew_monitor.recordings.bulk.decode import refuse
from ballscrew_monitor.recordings.bulk.events import (
    event_of,
    Events,
    inserted,
    joined,
    Notes,
    repeated,
    some,
)
from ballscrew_monitor.recordings.bulk.order import EventOrder, OnDone, ordered_events
from ballscrew_monitor.recordings.log_facts import Assumption, LogFacts
from ballscrew_monitor.recordings.positions import positions_of
from ballscrew_monitor.recordings.storages import Message, TopicInfo
from ballscrew_monitor.recordings.tables import times
from ballscrew_monitor.recordings.tables.mapping import AxisMap, MOTOR, TableMap
from ballscrew_monitor.recordings.tables.messages import (
    column_of,
    joints_topic,
    Pattern,
    patterns_of,
    serialised,
    STAMP,
)
from ballscrew_monitor.recordings.tables.series import fits_of, quantities_of, read_series, Series
from ballscrew_monitor.recordings.tables.times import Rows
from ballscrew_monitor.recordings.words import Shown, shown_progress
from ballscrew_monitor.settings import parameters
from ballscrew_monitor.settings.axis import Axis, load_surface
from ballscrew_monitor.settings.parameters import absolute, MOTOR_TORQUE
import numpy as np
from sensor_msgs.msg import JointState
from surrogate.files import InputError
from surrogate.units import MILLI, TURN

SLOW = 0.5  # of the timeout: rows that far apart leave no room for a late one
SAME = 1e-6  # part by which two leads may differ
NAMES_NONE = 'the map names none'
PASSES = 2  # over a table, at most, before it is judged, of which each is shown
AT_ONCE = 32768  # events that are made at a time: they stay in the cache


class TableLog(Bag):
    """A table read by a map; what its rows say of the map is a remark once all are read."""

    absent = 'rows without a time or a value'

    def __init__(self, path: Path, mapping: TableMap, shown: Shown = shown_progress) -> None:
        """
        Look through the table at `path`, and show how far that is.

        Raises InputError when it cannot be read by the map.

        """
        self._series = read_series(path, mapping, shown)
        self.facts = _facts_of(path, mapping, self._series)
        self._patterns, self._columns = patterns_of(self._series)
        self.path, self.files, self.metadata = path, [path], self.facts.texts()
        self.count = self._series.count
        self.promised = {
            name: self._series.rows[pattern.group] for name, pattern in self._patterns.items()
        }
        self.topics = {
            name: TopicInfo(
                type_name=type_name_of(pattern.message),
                encoding='cdr',
                count=self._series.counts[pattern.group],
            )
            for name, pattern in self._patterns.items()
        }
        self.unread = self._series.unread
        if self._series.more_rows:
            self.absent = f'{self.absent}, or in parts of the file that are not read'
        self.worked_out = frozenset(
            absolute(joints_topic(self._series.of(axis, 'torque')))
            for axis in self._series.mapping.axes
            if axis.load_from in MOTOR and 'torque' in quantities_of(axis)
        )
        self.start_time, self.end_time = self._series.begin, self._series.end
        self.storages, self.refused, self.remarks, self._missing = [], {}, [], []

    def messages(self, topics: Collection[str] | None = None) -> Iterator[Message]:
        """Yield messages of `topics` (None: all) by log time."""
        for batch in self.batches(self.topics if topics is None else topics):
            yield from batch.messages()

    def batches(self, topics: Collection[str]) -> Iterator[Batch]:
        """Yield the messages of `topics` that the rows are."""
        wanted = [name for name in self._patterns if name in topics]
        begin = done = 0
        for groups in self._blocks():
            stamps = [groups[self._patterns[name].group].stamps for name in wanted]
            order = np.lexsort(
                [
                    np.repeat(np.arange(len(wanted)), [len(each) for each in stamps]),
                    np.concatenate([np.zeros(0, np.int64), *stamps]),
                ]
            )
            place = np.empty(len(order), np.int64)
            place[order] = begin + np.arange(len(order))
            by_topic, at = {}, 0
            for name, each in zip(wanted, stamps, strict=True):
                pattern, count, end = self._patterns[name], len(each), at + len(each)
                rows = groups[pattern.group]
                messages = serialised(pattern.message, self._columns, rows)
                by_topic[name] = Messages(
                    data=messages.tobytes(),
                    channel=np.zeros(count, np.int64),
                    begin=np.arange(count) * messages.itemsize,
                    size=np.full(count, messages.itemsize),
                    log_time=each,
                    place=place[at:end],
                    sequence=place[at:end] // max(len(wanted), 1),
                )
                at = end
            begin += len(order)
            done += sum(len(rows.stamps) for rows in groups)
            until = (
                END
                if done == self.count
                else max(int(rows.stamps[-1]) for rows in groups if len(rows.stamps))
            )
            yield Batch(topics=by_topic, until=until, done=done / self.count)

    def events(
        self, axes: list[Axis], period: int, notes: Notes, on_done: OnDone
    ) -> Iterator[Events]:
        """Yield the events of `axes` as `ordered_events` does."""
        inputs = sorted(
            [(number, one) for number, axis in enumerate(axes) for one in axis.inputs],
            key=lambda each: (each[1].source, each[0]),
        )
        parts = [
            (
                joined([self._event(one, notes, axis=number) for number, one in held]),
                [one for _, one in held],
            )
            for group in range(len(self._series.counts))
            for held in [[each for each in inputs if self._pattern(each[1]).group == group]]
        ]
        order, done = EventOrder(period, self.run_borders), 0
        most = max(AT_ONCE // max(len(inputs), 1), 1)
        for groups in _together(self._blocks(), most=most):
            every = [self._events(rows, *part) for rows, part in zip(groups, parts, strict=True)]
            stamps = groups[0].stamps
            events = every[0]
            if len(groups) > 1:
                read = [rows.stamps for rows, (_, held) in zip(groups, parts, strict=True) if held]
                stamps = np.unique(np.concatenate(read))
                events = joined(every)
                events = some(events, np.lexsort((events['source'], events['stamp'])))
            if len(stamps):
                due = order.ticks(stamps)
                at = np.searchsorted(events['stamp'], due['stamp'], 'right')
                yield inserted(events, at, due)
            done += sum(len(rows.stamps) for rows in groups)
            on_done(done / self.count)

    def _pattern(self, one: Input) -> Pattern:
        return self._patterns[absolute(one.topic)]

    def positions(self, axis: str) -> Positions | None:
        """Return the positions of an axis, None where the map names no column of them."""
        lead = next(each.lead for each in self._series.mapping.axes if each.name == axis)
        group = self._series.places.get(f'{axis}.position', 0)
        parts = [groups[group] for groups in self._series.blocks()]
        rows = times.joined([part for part in parts if len(part.stamps)])
        if f'{axis}.position' not in rows.columns:
            return None
        motor = rows.columns[f'{axis}.position'] * lead / TURN
        return Positions(rows.stamps, motor, rows.columns.get(f'{axis}.table_position'))

    def _event(self, one: Input, notes: Notes, *, axis: int) -> Events:
        """Return what an input of an axis reads of any row, but for its time and number."""
        read = one.read(self._pattern(one).message, now=STAMP, max_future=0)
        return event_of(read, notes, axis=axis, log_time=STAMP, place=0)

    def _events(self, rows: Rows, row: Events, inputs: Sequence[Input]) -> Events:
        """Return the events of some rows by stamp and source: those of any row, and its inputs."""
        if not inputs:
            return row
        events = repeated(row, len(rows.stamps))
        by_row = events.reshape(-1, len(row))
        for name in ('log_time', 'stamp', 'arrival'):
            by_row[name] = rows.stamps[:, None]
        for at, one in enumerate(inputs):
            number = one.read_field(self._pattern(one).message)
            name = column_of(number, self._columns) if isinstance(number, float) else ''
            if not name:
                continue
            raw = rows.columns[name]
            with np.errstate(invalid='ignore', over='ignore'):
                value = raw * one.scaling.factor + one.scaling.shift
            by_row['value'][:, at] = value
            refuse(by_row[:, at], ~np.isfinite(value), Why.NOT_A_NUMBER, raw, math.nan)
        if len(row) > 1 and (np.diff(rows.stamps) == 0).any():
            events = some(events, np.lexsort((events['source'], events['stamp'])))
        return events

    def _blocks(self) -> Iterator[list[Rows]]:
        """Yield the rows in blocks, and compare the speeds with the positions beside them."""
        fits = fits_of(self._series)
        for groups in self._series.blocks():
            for fit in fits:
                for rows in groups:
                    fit.add(rows)
            yield groups
        for note in filter(None, (fit.note() for fit in fits)):
            self.remark(note)


@batches.register
def _(bag: TableLog, topics: Collection[str], *, as_written: bool = False) -> Iterator[Batch]:
    return bag.batches(topics)


@positions_of.register
def _(bag: TableLog, axis: str, values: Mapping[str, Any]) -> Positions | None:
    return bag.positions(axis)


@ordered_events.register
def _(
    bag: TableLog, axes: list[Axis], period: int, notes: Notes, *, on_done: OnDone
) -> Iterator[Events]:
    return bag.events(axes, period, notes, on_done)


def _together(blocks: Iterable[list[Rows]], most: int) -> Iterator[list[Rows]]:
    """Yield rows in blocks of at most so many, or more if these are of one stamp."""
    held: Rows | None = None
    for groups in blocks:
        if len(groups) > 1:
            yield groups
            continue
        block = groups[0]
        for begin in range(0, len(block.stamps), most):
            end = begin + most
            rows = block[begin:end]
            if held is not None:
                same = int(np.searchsorted(rows.stamps, held.stamps[-1], 'right'))
                held, rows = times.joined([held, rows[:same]]) if same else held, rows[same:]
                if not len(rows.stamps):
                    continue
                yield [held]
            held = rows
    if held is not None:
        yield [held]


def _facts_of(path: Path, stated: TableMap, series: Series) -> LogFacts:
    """Return what is known of a table that is read by a map."""
    mapping, notes = series.mapping, [*series.notes, *_unknown(stated)]
    return LogFacts(
        source=path.name,
        parameters=_parameters(mapping, series, notes),
        mapping=mapping.content,
        assumptions=(*mapping.assumptions, *_derived(mapping)),
        notes=tuple(notes),
        run_borders=series.run_borders,
    )


def _parameters(mapping: TableMap, series: Series, notes: list[str]) -> dict[str, Any]:
    """Return what the node is to be told; add a note about each thing that does not fit."""
    names = [axis.name for axis in mapping.axes]
    values: dict[str, Any] = {'axes': names}
    for axis in mapping.axes:
        values |= _axis_parameters(axis, series)
    every = parameters.defaults(names)
    period = series.usual_period
    for name, default in every.items():
        if name.endswith('.timeout') and period > SLOW * default:
            values[name] = enough_timeout(period)
    if any(name.endswith('.timeout') for name in values):
        notes.append(f'rows are {period:.3g} s apart: timeouts are longer than usual')
    values |= mapping.parameters
    parameters.check(parameters.table(names), values)
    notes += [note for axis in mapping.axes if (note := _lead_note(axis, every | values))]
    return values


def _axis_parameters(axis: AxisMap, series: Series) -> dict[str, Any]:
    values: dict[str, Any] = dict(axis.texts)
    if group := series.of(axis, 'speed'):
        values['speed.topic'] = joints_topic(group)
    by_node = axis.load_from == MOTOR_TORQUE
    if by_node:
        values |= {
            'load.source': MOTOR_TORQUE,
            'torque.uncertainty': axis.torque_uncertainty,
            'inertia': axis.inertia,
            'health.free_load': axis.free_load,
            'health.always_free': axis.always_free,
        }
    else:
        values['load.topic'] = f'{axis.name}/axial_load'
    if 'temperature' in axis.columns:
        values['temperature.topic'] = f'{axis.name}/oil_temperature'
    elif math.isfinite(axis.temperature):
        values['temperature.default'] = axis.temperature
    # A torque that the load was worked out from has nothing to be compared with.
    if by_node or ('torque' in axis.columns and axis.load_from != 'torque'):
        topic = joints_topic(series.of(axis, 'torque'))
        joint = {'topic': topic, 'type': type_name_of(JointState())}
        joint['field'] = f'effort[{axis.name}_axis]'
        values |= {f'torque.{key}': value for key, value in joint.items()}
    return {f'{axis.name}.{key}': value for key, value in values.items()}


def _lead_note(axis: AxisMap, values: dict[str, Any]) -> str:
    """Return what is to be said about the surface that an axis is judged with, if anything."""
    try:
        lead = load_surface(axis.name, values).lead
    except InputError as error:
        return f'{error}: the bag cannot be judged before there is a surface'
    if abs(lead / axis.lead - 1.0) <= SAME:
        return ''
    return (
        f'axis {axis.name}: the lead is {axis.lead * MILLI:g} mm, that of the surface '
        f'{lead * MILLI:g} mm: build the surface of this screw'
    )


def _derived(mapping: TableMap) -> list[Assumption]:
    """Return what the import itself works out."""
    assumptions = []
    for axis in mapping.axes:
        if 'speed' not in axis.columns:
            why = 'the map names no column of the speed'
            key = f'{axis.name}.speed'
            assumptions.append(Assumption(key=key, value='slope of the position', reason=why))
        if 'load' not in axis.columns and not axis.load_from:
            why = axis.unknown.get('load', NAMES_NONE)
            assumptions.append(Assumption(key=f'{axis.name}.load', value='unknown', reason=why))
    return assumptions


def _unknown(mapping: TableMap) -> list[str]:
    """Return of which axis the map says no load, and what to write there."""
    return [
        f'axis {axis.name}: the load is unknown ({axis.unknown.get("load", NAMES_NONE)}), '
        f'name a column of a force, torque or current for axes.{axis.name} in the map'
        for axis in mapping.axes
        if 'load' not in axis.columns and not axis.load_from
    ]
