# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Conversion of a table to a bag that says how it is to be judged, and on which assumptions.

Topics are `joint_states` with speed, position and torque of each screw, `<axis>/axial_load` and
`<axis>/oil_temperature`. Parameters of the node, map, assumptions and notes are in the metadata.
`ballscrew import` makes such a bag, or prints a first map of a table.

"""

from collections.abc import Callable, Iterator, Sequence
import dataclasses
import itertools
import math
from pathlib import Path
import struct
from typing import Any

from ballscrew_monitor.core.cdr import serialized
from ballscrew_monitor.core.conversions import SECOND
from ballscrew_monitor.core.fields import type_name_of
from ballscrew_monitor.messages.reasons import enough_timeout
from ballscrew_monitor.recordings.bag_files import is_bag
from ballscrew_monitor.recordings.bag_writer import BagWriter, Offer, Topic, whole_bag
from ballscrew_monitor.recordings.log_facts import Assumption, LogFacts
from ballscrew_monitor.recordings.tables.cells import Array
from ballscrew_monitor.recordings.tables.guess import guess
from ballscrew_monitor.recordings.tables.mapping import AxisMap, read_map, TableMap
from ballscrew_monitor.recordings.tables.series import Block, Fit, fits_of, read_series, Series
from ballscrew_monitor.recordings.words import say, Shown, shown_progress
from ballscrew_monitor.settings import parameters
from ballscrew_monitor.settings.axis import load_surface
from ballscrew_monitor.settings.parameters import absolute, MOTOR_TORQUE
from geometry_msgs.msg import WrenchStamped
import numpy as np
from numpy.typing import NDArray
from sensor_msgs.msg import JointState, Temperature
from surrogate.files import InputError, printable
from surrogate.units import MILLI

JOINTS = 'joint_states'
SLOW = 0.5  # of the timeout: rows that far apart leave no room for a late one
PASSES = 3  # over a table, at most, of which each is shown
SAME = 1e-6  # part by which two leads may differ
NAMES_NONE = 'the map names none'
ROWS = 4096  # whose messages are made at once
_STAMP = (1_234_567_891, 987_654_321)  # [s], [ns]


def convert(
    path: Path, mapping: TableMap, out: Path, *, shown: Shown = shown_progress
) -> LogFacts:
    """
    Write the log at `path` as a bag to the directory `out`; return what the bag says of itself.

    Shows how far it is. Raises InputError when the log cannot be read by the map, before anything
    is written.

    """
    if out.is_file():
        raise InputError(f'output {out} is a file, it must be a directory')
    series = read_series(path, mapping, shown)
    notes = [*series.notes, *_unknown(mapping)]
    mapping = series.mapping
    facts = LogFacts(
        source=path.name,
        parameters=_parameters(mapping, series, notes),
        mapping=mapping.content,
        assumptions=(*mapping.assumptions, *_derived(mapping)),
        notes=tuple(notes),
    )
    with whole_bag(out, out.resolve().name) as writer:
        writer.add_metadata(facts.texts())
        fits = fits_of(mapping, series.usual_period)
        with shown(series.count, 'rows written') as show:
            _write(writer, series, fits, show)
        if found := list(filter(None, (fit.note() for fit in fits))):
            facts = dataclasses.replace(facts, notes=(*facts.notes, *found))
            writer.add_metadata(facts.texts())
    return facts


def _parameters(mapping: TableMap, series: Series, notes: list[str]) -> dict[str, Any]:
    """Return what the node is to be told; add a note about each thing that does not fit."""
    names = [axis.name for axis in mapping.axes]
    values: dict[str, Any] = {'axes': names}
    for axis in mapping.axes:
        values |= _axis_parameters(axis)
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


def _axis_parameters(axis: AxisMap) -> dict[str, Any]:
    values: dict[str, Any] = dict(axis.texts)
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
        joint = {'topic': JOINTS, 'type': type_name_of(JointState())}
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
    found = []
    for axis in mapping.axes:
        if 'speed' not in axis.columns:
            why = 'the map names no column of the speed'
            key = f'{axis.name}.speed'
            found.append(Assumption(key=key, value='slope of the position', reason=why))
        if 'load' not in axis.columns and not axis.load_from:
            why = axis.unknown.get('load', NAMES_NONE)
            found.append(Assumption(key=f'{axis.name}.load', value='unknown', reason=why))
    return found


def _unknown(mapping: TableMap) -> list[str]:
    """Return of which axis the map says no load, and what to write there."""
    return [
        f'axis {axis.name}: the load is unknown ({axis.unknown.get("load", NAMES_NONE)}), '
        f'name a column of a force, torque or current for axes.{axis.name} in the map'
        for axis in mapping.axes
        if 'load' not in axis.columns and not axis.load_from
    ]


def _write(
    writer: BagWriter, series: Series, fits: list[Fit], show: Callable[[float], None]
) -> None:
    """Write all rows and compare them; the topics are those of the first of them."""
    templates: dict[str, RowTemplate] = {}
    done = 0
    for block in series.blocks():
        for fit in fits:
            fit.add(block)
        rows = {}
        for name, message, numbers in _topics(block):
            if name not in templates:
                kind = type_name_of(message)
                writer.add_topic(Topic(name=name, type_name=kind, offer=Offer.RELIABLE))
                templates[name] = RowTemplate(message, len(numbers))
            rows[name] = templates[name].rows(block.stamps, numbers)
        for at in range(0, len(block.stamps), ROWS):
            part = slice(at, at + ROWS)
            some = {name: content[part] for name, content in rows.items()}
            writer.write_rows(some, block.stamps[part])
        done += len(block.stamps)
        show(done / series.count)


def _topics(block: Block) -> Iterator[tuple[str, Any, list[Array]]]:
    """Yield full name, message with marks and numbers of each topic, the joints last."""
    for axis in block.axes:
        (mark,) = marks(1)
        if axis.temperature is not None:
            warm = Temperature(temperature=mark)
            yield absolute(f'{axis.name}/oil_temperature'), warm, [axis.temperature]
        if axis.load is not None:
            load = WrenchStamped()
            load.header.frame_id = f'{axis.name}_nut'
            load.wrench.force.x = mark
            yield absolute(f'{axis.name}/axial_load'), load, [axis.load]
    yield absolute(JOINTS), *_joints(block)


def _joints(block: Block) -> tuple[JointState, list[Array]]:
    """Return the joints with marks, and the numbers: what no axis has stays an empty list."""
    found: dict[str, list[Array]] = {'velocity': [axis.speed for axis in block.axes]}
    found['position'] = _all(block, [axis.position for axis in block.axes])
    found['effort'] = _all(block, [axis.torque for axis in block.axes])
    numbers = [values for part in found.values() for values in part]
    message = JointState(name=[f'{axis.name}_axis' for axis in block.axes])
    left = iter(marks(len(numbers)))
    for field, part in found.items():
        setattr(message, field, list(itertools.islice(left, len(part))))
    return message, numbers


def _all(block: Block, found: list[Array | None]) -> list[Array]:
    """Return a quantity of all axes, NaN for those without; nothing if none has it."""
    if all(one is None for one in found):
        return []
    unknown = np.full(len(block.stamps), math.nan)
    return [unknown if one is None else one for one in found]


def marks(count: int) -> list[float]:
    """Return numbers that stand in a message for those of its rows, in their order."""
    return [1.234567890123e200 * (number + 1) for number in range(count)]


class RowTemplate:
    """
    One message with a header, and `count` numbers in it that are `marks`.

    Messages of one shape differ in their stamp and their numbers alone: these are put into the
    bytes of one of them.

    """

    def __init__(self, message: Any, count: int) -> None:
        """Find where the stamp and the marks stand in the bytes of `message`."""
        message.header.stamp.sec, message.header.stamp.nanosec = _STAMP
        data = self._data = serialized(message)
        stamp = data.index(struct.pack('<iI', *_STAMP))
        places = [data.index(struct.pack('<d', mark)) for mark in marks(count)]
        self._names = [str(number) for number in range(count)]
        self._row = np.dtype(
            {
                'names': ['sec', 'nanosec', *self._names],
                'formats': ['<i4', '<u4', *['<f8'] * count],
                'offsets': [stamp, stamp + 4, *places],
                'itemsize': len(data),
            }
        )

    def rows(
        self, stamps: NDArray[np.int64], numbers: Sequence[NDArray[np.float64]]
    ) -> NDArray[np.void]:
        """Return the message of each row, of its stamp [ns] and its numbers."""
        content = bytearray(self._data * len(stamps))
        rows = np.frombuffer(content, self._row)
        rows['sec'], rows['nanosec'] = np.divmod(stamps, SECOND)
        for name, values in zip(self._names, numbers, strict=True):
            rows[name] = values
        return np.frombuffer(content, f'V{len(self._data)}')


def print_guess(log: Path) -> None:
    """Print a first map of a log, and to standard error what is to be said about it."""
    _check_log(log)
    made = guess(log, shown=shown_progress)
    print(made.text, end='')
    say(*made.notes, *made.unstated)


def make_bag(log: Path, config: Path | None, out: Path | None) -> None:
    """Write a log as a bag to `out` by the map in `config`; raises InputError without them."""
    _check_log(log)
    if config is None or out is None:
        missing = '--config' if config is None else '--out'
        raise InputError(f'{missing} is missing; --guess prints a first map for --config')
    facts = convert(log, read_map(config), out, shown=shown_progress)
    say(*facts.notes)
    print(f'{out}: judge it by ballscrew replay {out}')
    for one in facts.assumptions:
        print(printable(f'  assumed {one.key} = {one.value}: {one.reason}'))


def _check_log(log: Path) -> None:
    if log.is_dir() or (log.exists() and is_bag(log)):
        raise InputError(
            f'log {log} is no table; a bag needs no import, ballscrew replay takes it'
        )
