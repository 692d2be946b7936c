# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Messages as bytes that any reader takes: little-endian CDR of the exact length, padded with zeros.

A serialiser of ROS leaves the padding as the memory was, and after an empty array of float64 more
bytes than belong to the message, which strict readers refuse.

"""

from collections.abc import Callable, Sequence
import functools
import itertools
import operator
import struct
from typing import Any

from ballscrew_monitor.core.fields import FORMATS, message_class
from rosidl_parser import definition
from surrogate.files import InputError

HEADER = b'\0\1\0\0'  # little-endian CDR
LARGEST = 8  # bytes of the largest number, to a multiple of which anything is aligned
_LENGTH = struct.Struct('<I')
Encoder = Callable[[bytearray, Any], None]


def serialized(message: Any) -> bytes:
    """Return a message serialised; raises InputError for a field of wide characters."""
    data = bytearray()
    _message_encoder(message.__class__)(data, message)
    return HEADER + bytes(data)


@functools.lru_cache
def _message_encoder(message_type: Any) -> Encoder:
    names = message_type.get_fields_and_field_types()
    parts: list[tuple[str, Encoder]] = []  # numbers in a row have no name
    fields = zip(names, message_type.SLOT_TYPES)
    for plain, group in itertools.groupby(fields, key=lambda field: _is_plain(field[1])):
        run = list(group)
        parts += [('', _row(run))] if plain else [(name, _encoder(kind)) for name, kind in run]

    def encode(data: bytearray, message: Any) -> None:
        for name, encode_part in parts:
            encode_part(data, getattr(message, name) if name else message)
        if not parts:  # a message without fields has one byte
            data.append(0)

    return encode


def _is_plain(kind: Any) -> bool:
    """Return True if a field is a number as it stands; an octet is a `bytes` of length one."""
    return getattr(kind, 'typename', 'octet') in FORMATS.keys() - {'octet'}


def _row(fields: Sequence[tuple[str, Any]]) -> Encoder:
    """Return what appends numbers in a row, packed at once."""
    names, kinds = zip(*fields)
    values = operator.attrgetter(*names)
    codes = [FORMATS[kind.typename] for kind in kinds]
    packs = []
    for begin in range(LARGEST):  # each number stands at a multiple of its size
        layout = '<'
        for code in codes:
            gap = -(begin + struct.calcsize(layout)) % struct.calcsize(f'<{code}')
            layout += 'x' * gap + code
        packs.append(struct.Struct(layout).pack)

    def encode(data: bytearray, message: Any) -> None:
        pack, numbers = packs[len(data) % LARGEST], values(message)
        data += pack(*numbers) if len(names) > 1 else pack(numbers)

    return encode


def _encoder(kind: Any) -> Encoder:
    """Return what appends a field of a type."""
    if isinstance(kind, definition.Array):
        return _all_of(kind.value_type, counted=False)
    if isinstance(kind, definition.AbstractSequence):
        return _all_of(kind.value_type, counted=True)
    if isinstance(kind, definition.AbstractString):
        return _put_text
    if isinstance(kind, definition.NamespacedType):
        return _message_encoder(message_class('/'.join(kind.namespaced_name())))
    encode_all = _numbers(kind)
    return lambda data, value: encode_all(data, (value,))


def _all_of(kind: Any, *, counted: bool) -> Encoder:
    """Return what appends every element, after their number if they are `counted`."""
    numbers = isinstance(kind, definition.BasicType)
    encode_element = _numbers(kind) if numbers else _encoder(kind)

    def encode(data: bytearray, values: Sequence[Any]) -> None:
        if counted:
            _align(data, _LENGTH.size)
            data += _LENGTH.pack(len(values))
        if numbers and len(values):
            encode_element(data, values)  # all of them at once
        elif not numbers:
            for value in values:
                encode_element(data, value)

    return encode


def _numbers(kind: Any) -> Encoder:
    name = getattr(kind, 'typename', '')
    if name not in FORMATS:
        raise InputError(f'a field is of type {type(kind).__name__}, which cannot be serialised')
    code = FORMATS[name]
    size = struct.calcsize(f'<{code}')

    def encode(data: bytearray, values: Sequence[Any]) -> None:
        _align(data, size)
        numbers = map(ord, values) if name == 'octet' else values
        data += struct.pack(f'<{len(values)}{code}', *numbers)

    return encode


def _put_text(data: bytearray, value: str) -> None:
    text = value.encode() + b'\0'
    _align(data, _LENGTH.size)
    data += _LENGTH.pack(len(text)) + text


def _align(data: bytearray, size: int) -> None:
    data += bytes(-len(data) % size)
