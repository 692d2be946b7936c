# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Any numeric field of any message, by name.

A field path names attributes, with an index for an array: `data`, `wrench.force.x`, `position[0]`,
or the name of a joint, `velocity[x_axis]`, looked up in the `name` field beside the array. Its
form is checked without a type, the rest when it is compiled for one.

"""

from collections.abc import Callable
import dataclasses
import importlib
import operator
import re
from typing import Any

from ballscrew_monitor.core.conversions import SECOND
from surrogate.files import InputError

_SEGMENT = re.compile(r'([A-Za-z]\w*)(?:\[([^\[\]]+)\])?')
_DOT = re.compile(r'\.(?![^\[\]]*\])')  # one between brackets belongs to the name of a joint
_ARRAY = re.compile(r'(?:sequence<(?P<sequence>.+?)(?:, \d+)?>|(?P<array>.+)\[\d+\])')
FORMATS = {
    'boolean': '?',
    'octet': 'B',
    'float': 'f',
    'double': 'd',
    'int8': 'b',
    'uint8': 'B',
    'int16': 'h',
    'uint16': 'H',
    'int32': 'i',
    'uint32': 'I',
    'int64': 'q',
    'uint64': 'Q',
}
"""Numbers of a message, and the letter of `struct` for each."""
_NUMBERS = FORMATS.keys() - {'boolean'}
_INDEX = re.compile(r'[+-]?\d+')


@dataclasses.dataclass(frozen=True, slots=True)
class OtherJoints:
    """What a message names instead of the joint that is asked of its `array`."""

    array: str
    joint: str
    names: tuple[str, ...]


@dataclasses.dataclass(frozen=True, slots=True)
class TooShort:
    """An `array` of `length` elements, which has no element `key`."""

    array: str
    key: str
    length: int


ReadStep = Callable[[Any], Any]
FieldReader = Callable[[object], float | OtherJoints | TooShort]


class _Absent(Exception):
    """The message does not hold what a step asks for."""

    def __init__(self, absence: OtherJoints | TooShort) -> None:
        self.absence = absence


MessageClass = Any
"""A generated class; its `get_fields_and_field_types` tells the types of its fields by name."""


def message_class(type_name: str) -> MessageClass:
    """Return the class of a message type such as `sensor_msgs/msg/JointState`."""
    parts = type_name.split('/')
    if len(parts) != 3 or parts[1] != 'msg' or not all(parts):
        raise InputError(f'message type {type_name!r} is not of the form package/msg/Name')
    try:
        kind: MessageClass = getattr(importlib.import_module(f'{parts[0]}.msg'), parts[2])
    except (ImportError, AttributeError):
        raise InputError(f'message type {type_name!r} is not installed') from None
    return kind


def type_name_of(message: Any) -> str:
    """Return the type of a message as `message_class` takes it."""
    kind = type(message)
    return f'{kind.__module__.split(".")[0]}/msg/{kind.__name__}'


def stamp_of(message: Any) -> int:
    """Return the stamp of a message with a header [ns]."""
    stamp = message.header.stamp
    return int(stamp.sec) * SECOND + int(stamp.nanosec)


def check_path(path: str) -> None:
    """Raise InputError unless `path` has the form of a field path."""
    for segment in _DOT.split(path):
        _name_and_key(path, segment)


def segments_of(path: str) -> list[tuple[str, str | None]]:
    """Return the names along a field path, each with its index or joint if it has one."""
    segments = map(_SEGMENT.fullmatch, _DOT.split(path))
    return [(segment[1], segment[2]) for segment in segments if segment]


def arrays_of(path: str) -> list[tuple[str, str]]:
    """Return name and key of each array that a field path reads an element of."""
    return [(name, key) for name, key in segments_of(path) if key is not None]


def compile_field(path: str, message_type: MessageClass) -> FieldReader:
    """
    Return the function that reads the field `path` of a message of class `message_type`.

    It returns what a message holds instead where there is no such joint or element. Raises
    InputError when the path does not lead to a number.

    """
    steps: list[ReadStep] = []
    kind: MessageClass | str = message_type
    for segment in _DOT.split(path):
        if isinstance(kind, str):
            raise InputError(f'field {path!r}: {segment!r} is asked of a {kind}')
        name, key = _name_and_key(path, segment)
        whole, fields = _name(kind), kind.get_fields_and_field_types()
        if name not in fields:
            raise InputError(
                f'field {path!r}: {whole} has no field {name!r}, it has {", ".join(fields)}'
            )
        array = _ARRAY.fullmatch(fields[name])
        if key is None:
            steps.append(operator.attrgetter(name))
            kind = _resolve(fields[name])
            continue
        if array is None:
            raise InputError(f'field {path!r}: {name!r} of {whole} is {fields[name]}, no array')
        kind = _resolve(array['sequence'] or array['array'])
        if not key.isdecimal() and fields.get('name') != 'sequence<string>':
            raise InputError(f'field {path!r}: {whole} has no list of names to find {key!r} in')
        steps.append(_element(name, key))
    if not isinstance(kind, str) or kind not in _NUMBERS:
        raise InputError(f'field {path!r} of {_name(message_type)} is {_name(kind)}, not a number')
    steps += [ord] if kind == 'octet' else []  # that is bytes in Python

    def read(message: object) -> float | OtherJoints | TooShort:
        value: Any = message
        try:
            for step in steps:
                value = step(value)
        except _Absent as absent:
            return absent.absence
        return float(value)

    return read


def number_fields(message_type: MessageClass) -> tuple[str, ...]:
    """Return paths of the numbers of a message, of an array the first, none of its header."""
    paths: list[str] = []
    for name, field_type in message_type.get_fields_and_field_types().items():
        array = _ARRAY.fullmatch(field_type)
        if field_type in _NUMBERS:
            paths.append(name)
        elif array and (array['sequence'] or array['array']) in _NUMBERS:
            paths.append(f'{name}[0]')
        elif '/' in field_type and field_type != 'std_msgs/Header':
            nested = _resolve(field_type)
            if not isinstance(nested, str):
                paths += [f'{name}.{path}' for path in number_fields(nested)]
    return tuple(paths)


def _name_and_key(path: str, segment: str) -> tuple[str, str | None]:
    """Return the name of a segment, and the index or joint between its brackets if any."""
    match = _SEGMENT.fullmatch(segment)
    if match is None:
        raise InputError(f'field {path!r}: {segment!r} is not a name or name[index]')
    name, key = match.groups()
    if key is not None and _INDEX.fullmatch(key) and not key.isdecimal():
        raise InputError(
            f'field {path!r}: the index {key} has a sign, allowed is 0 or more, or a joint'
        )
    return name, key


def _resolve(field_type: str) -> MessageClass | str:
    """Return the class of a nested message; any other type as its text."""
    package, slash, name = field_type.partition('/')
    if not slash or _ARRAY.fullmatch(field_type):
        return field_type
    return message_class(f'{package}/msg/{name}')


def _name(kind: MessageClass | str) -> str:
    return kind if isinstance(kind, str) else kind.__name__


def _element(name: str, key: str) -> ReadStep:
    """Return the step to an element of an array by its index, or by the joint named like it."""
    index = int(key) if key.isdecimal() else None

    def step(message: Any) -> Any:
        array = getattr(message, name)
        try:
            place = message.name.index(key) if index is None else index
        except ValueError:
            raise _Absent(OtherJoints(name, key, tuple(message.name))) from None
        try:
            return array[place]
        except IndexError:
            raise _Absent(TooShort(name, key, len(array))) from None

    return step
