# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
The messages that the rows of a table are in a bag: which field of which topic is which column.

A pattern is a message whose numbers are the places of their columns, from 1 on. So whatever reads
a field of a message reads of a pattern which column that is.

"""

from collections.abc import Iterator
import dataclasses
import math
from typing import Any

from ballscrew_monitor.core.conversions import SECOND
from ballscrew_monitor.recordings.tables.series import quantities_of, Series
from ballscrew_monitor.recordings.tables.times import Rows
from ballscrew_monitor.settings.parameters import absolute
from geometry_msgs.msg import WrenchStamped
import numpy as np
from numpy.typing import NDArray
from sensor_msgs.msg import JointState, Temperature

JOINTS = 'joint_states'
STAMP = 1
"""Stamp of a pattern [ns], as a message without one has none."""
OF_JOINTS = (('velocity', 'speed'), ('position', 'position'), ('effort', 'torque'))
"""Fields of the joints, and the quantities in them."""
CDR = np.frombuffer(b'\0\1\0\0', 'V4')  # little-endian


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class Pattern:
    """The pattern of a topic, and the group of columns that it is made of."""

    message: Any
    group: int


def joints_topic(group: int) -> str:
    """Return the name of the topic of the joints that a group of columns gives."""
    return JOINTS if group == 0 else f'{JOINTS}_{group + 1}'


def patterns_of(series: Series) -> tuple[dict[str, Pattern], list[str]]:
    """
    Return the pattern of each topic, the joints last, and names of the columns by their places.

    What no axis has is an empty list of the joints, and what one axis has not is NaN.

    """
    columns: list[str] = []

    def place(axis: str, kind: str) -> float:
        columns.append(f'{axis}.{kind}')
        return float(len(columns))

    patterns: dict[str, Pattern] = {}
    axes = series.mapping.axes
    known = {
        axis.name: {kind: series.of(axis, kind) for kind in quantities_of(axis)} for axis in axes
    }
    for name, kinds in known.items():
        if 'temperature' in kinds:
            warmth = Temperature(temperature=place(name, 'temperature'))
            topic = absolute(f'{name}/oil_temperature')
            patterns[topic] = Pattern(message=warmth, group=kinds['temperature'])
        if 'load' in kinds:
            wrench = WrenchStamped()
            wrench.header.frame_id = f'{name}_nut'
            wrench.wrench.force.x = place(name, 'load')
            patterns[absolute(f'{name}/axial_load')] = Pattern(message=wrench, group=kinds['load'])
    groups = {kinds[kind] for kinds in known.values() for _, kind in OF_JOINTS if kind in kinds}
    for group in sorted(groups):
        held = {
            name: {kind for _, kind in OF_JOINTS if kinds.get(kind) == group}
            for name, kinds in known.items()
        }
        held = {name: kinds for name, kinds in held.items() if kinds}
        joints = JointState(name=[f'{name}_axis' for name in held])
        for field, kind in OF_JOINTS:
            if any(kind in kinds for kinds in held.values()):
                places = [
                    place(name, kind) if kind in kinds else math.nan
                    for name, kinds in held.items()
                ]
                setattr(joints, field, places)
        patterns[absolute(joints_topic(group))] = Pattern(message=joints, group=group)
    for pattern in patterns.values():
        pattern.message.header.stamp.nanosec = STAMP
    return patterns, columns


def column_of(number: float, columns: list[str]) -> str:
    """Return the name of the column whose place a number of a pattern is, empty for a constant."""
    return columns[int(number) - 1] if number >= 1.0 else ''


def serialised(pattern: Any, columns: list[str], rows: Rows) -> NDArray[np.void]:
    """
    Return the messages of a pattern that some rows are, in CDR.

    They are as long as each other, and their fields are aligned like those of a struct of C.

    """
    fields = list(_fields(pattern))
    kinds = [(str(at), kind) for at, (kind, _) in enumerate(fields)]
    messages = np.zeros(len(rows.stamps), [('cdr', 'V4'), ('body', np.dtype(kinds, align=True))])
    messages['cdr'], body = CDR, messages['body']
    for at, (_, value) in enumerate(fields):
        name = column_of(value, columns) if isinstance(value, float) else ''
        body[str(at)] = rows.columns[name] if name else value
    body['0'], body['1'] = np.divmod(rows.stamps, SECOND)
    return messages.view(f'V{messages.itemsize}')


def _fields(message: Any) -> Iterator[tuple[str, Any]]:
    """Yield the fields of a message with a header, each as a kind of numpy and its value."""
    for name in message.get_fields_and_field_types():
        value = getattr(message, name)
        if hasattr(value, 'get_fields_and_field_types'):
            yield from _fields(value)
        elif isinstance(value, int):  # of a stamp
            yield {'sec': '<i4', 'nanosec': '<u4'}[name], value
        elif isinstance(value, float):
            yield '<f8', value
        elif isinstance(value, str):
            yield from _text(value)
        else:
            yield '<u4', len(value)
            for each in value:
                yield from _text(each) if isinstance(each, str) else [('<f8', each)]


def _text(text: str) -> Iterator[tuple[str, Any]]:
    content = text.encode() + b'\0'
    yield '<u4', len(content)
    yield f'S{len(content)}', content
