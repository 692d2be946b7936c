# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
From a table to a bag that says how it is to be judged, and what was assumed to make it.

Topics are `joint_states` with speed, position and torque of each screw, `<axis>/axial_load` and
`<axis>/oil_temperature`. Parameters of the node, map, assumptions and notes are in the metadata.

"""

import math
from pathlib import Path
from typing import Any

from ballscrew_monitor.core.conversions import SECOND
from ballscrew_monitor.core.reasons import enough_timeout
from ballscrew_monitor.node import parameters
from ballscrew_monitor.node.axis import load_surface
from ballscrew_monitor.node.topics import absolute
from ballscrew_monitor.recordings.bag_writer import BagWriter, Offer, Topic
from ballscrew_monitor.recordings.log_facts import Assumption, LogFacts
from ballscrew_monitor.recordings.tables.mapping import AxisMap, TableMap
from ballscrew_monitor.recordings.tables.series import read_series, Series
from geometry_msgs.msg import WrenchStamped
from rclpy.serialization import serialize_message
from sensor_msgs.msg import JointState, Temperature
from surrogate.files import InputError
from surrogate.units import MILLI

JOINTS = 'joint_states'
SLOW = 0.5  # of the timeout: rows that far apart leave no room for a late one
SAME = 1e-6  # part by which two leads may differ


def convert(path: Path, mapping: TableMap, out: Path) -> LogFacts:
    """
    Write the log at `path` as a bag to the directory `out`; return what the bag says of itself.

    Raises InputError when the log cannot be read by the map, before anything is written.

    """
    if out.is_file():
        raise InputError(f'output {out} is a file, it must be a directory')
    series = read_series(path, mapping)
    notes = list(series.notes)
    facts = LogFacts(
        source=path.name,
        parameters=_parameters(mapping, series, notes),
        mapping=mapping.content,
        assumptions=(*mapping.assumptions, *_derived(mapping)),
        notes=tuple(notes),
    )
    with BagWriter(out, out.name) as writer:
        writer.add_metadata(facts.texts())
        _write(writer, series)
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
    values: dict[str, Any] = dict(axis.texts) | {'load.topic': f'{axis.name}/axial_load'}
    if 'temperature' in axis.columns:
        values['temperature.topic'] = f'{axis.name}/oil_temperature'
    elif math.isfinite(axis.temperature):
        values['temperature.default'] = axis.temperature
    # A torque that the load was worked out from has nothing to be compared with.
    if 'torque' in axis.columns and axis.load_from != 'torque':
        joint = {'topic': JOINTS, 'type': 'sensor_msgs/msg/JointState'}
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
            found.append(_assumption(f'{axis.name}.speed', 'slope of the position', why))
        if 'load' not in axis.columns and not axis.load_from:
            why = axis.unknown.get('load', 'the map names none')
            found.append(_assumption(f'{axis.name}.load', 'unknown', why))
    return found


def _assumption(key: str, value: str, reason: str) -> Assumption:
    return Assumption(key=key, value=value, reason=reason)


def _write(writer: BagWriter, series: Series) -> None:
    loads = {axis.name: absolute(f'{axis.name}/axial_load') for axis in series.axes}
    warmths = {
        axis.name: absolute(f'{axis.name}/oil_temperature')
        for axis in series.axes
        if axis.temperature is not None
    }
    joints = absolute(JOINTS)
    topics = {joints: 'sensor_msgs/msg/JointState'}
    topics |= dict.fromkeys(loads.values(), 'geometry_msgs/msg/WrenchStamped')
    topics |= dict.fromkeys(warmths.values(), 'sensor_msgs/msg/Temperature')
    for name, kind in topics.items():
        writer.add_topic(Topic(name=name, type_name=kind, offer=Offer.RELIABLE))

    def write(topic: str, message: Any, stamp: int) -> None:
        message.header.stamp.sec, message.header.stamp.nanosec = divmod(stamp, SECOND)
        writer.write(topic, serialize_message(message), log_time=stamp, publish_time=stamp)

    rows = _Rows(series)
    for row, stamp in enumerate(series.stamps.tolist()):
        for axis in series.axes:
            if axis.temperature is not None:
                warm = Temperature(temperature=float(axis.temperature[row]))
                write(warmths[axis.name], warm, stamp)
            load = WrenchStamped()
            load.header.frame_id = f'{axis.name}_nut'
            load.wrench.force.x = float(axis.load[row])
            write(loads[axis.name], load, stamp)
        write(joints, rows.joints(row), stamp)


class _Rows:
    """The joints of each row: a list that no axis has stays empty, as the message asks for."""

    def __init__(self, series: Series) -> None:
        self._names = [f'{axis.name}_axis' for axis in series.axes]
        self._speed = [axis.speed for axis in series.axes]
        self._position = self._all([axis.position for axis in series.axes])
        self._torque = self._all([axis.torque for axis in series.axes])

    def joints(self, row: int) -> JointState:
        return JointState(
            name=self._names,
            velocity=[float(values[row]) for values in self._speed],
            position=[math.nan if one is None else float(one[row]) for one in self._position],
            effort=[math.nan if one is None else float(one[row]) for one in self._torque],
        )

    @staticmethod
    def _all(found: list[Any]) -> list[Any]:
        return found if any(one is not None for one in found) else []
