# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
The messages that the rows of a table are in a bag: which field of which topic is which column.

A pattern is a message whose numbers are the places of their columns, from 1 on. So whatever reads
a field of a message reads of a pattern which column that is.

"""

from collections.abc import Iterator, Mapping
import math
from typing import Any

from ballscrew_monitor.core.conversions import SECOND
from ballscrew_monitor.recordings.tables.mapping import TableMap
from ballscrew_monitor.recordings.tables.series import quantities_of
from ballscrew_monitor.recordings.tables.times import Rows
from ballscrew_monitor.settings.parameters import absolute
from geometry_msgs.msg import WrenchStamped
import numpy as np
from numpy.typing import NDArray
from sensor_msgs.msg import JointState, Temperature

JOINTS = 'joint_states'
STAMP = 1
"""Stamp of a pattern [ns], as a message without one has none."""
CDR = np.frombuffer(b'\0\1\0\0', 'V4')  # little-endian
Patterns = Mapping[str, Any]
"""The pattern of each topic by its full name."""


def patterns_of(mapping: TableMap) -> tuple[Patterns, list[str]]:
    """
    Return the patterns of a table, the joints last, and the names of the columns by their places.

    What no axis has is an empty list of the joints, and what one axis has not is NaN.

    """
    columns: list[str] = []

    def place(axis: str, kind: str) -> float:
        columns.append(f'{axis}.{kind}')
        return float(len(columns))

    patterns: dict[str, Any] = {}
    known = {axis.name: quantities_of(axis) for axis in mapping.axes}
    for name, kinds in known.items():
        if 'temperature' in kinds:
            warmth = Temperature(temperature=place(name, 'temperature'))
            patterns[absolute(f'{name}/oil_temperature')] = warmth
        if 'load' in kinds:
            wrench = WrenchStamped()
            wrench.header.frame_id = f'{name}_nut'
            wrench.wrench.force.x = place(name, 'load')
            patterns[absolute(f'{name}/axial_load')] = wrench
    joints = JointState(name=[f'{name}_axis' for name in known])
    for field, kind in (('velocity', 'speed'), ('position', 'position'), ('effort', 'torque')):
        if any(kind in kinds for kinds in known.values()):
            places = [
                place(name, kind) if kind in kinds else math.nan for name, kinds in known.items()
            ]
            setattr(joints, field, places)
    patterns[absolute(JOINTS)] = joints
    for pattern in patterns.values():
        pattern.header.stamp.nanosec = STAMP
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
