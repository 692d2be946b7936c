# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Messages as bytes that any reader takes: little-endian CDR of the exact length, padded with zeros.

A serialiser of ROS leaves the padding as the memory was, and after an empty array of float64 more
bytes than belong to the message, which strict readers refuse.

"""

from collections.abc import Callable, Sequence
import functools
import struct
from typing import Any

from ballscrew_monitor.core.fields import message_class
from rosidl_parser import definition
from surrogate.files import InputError

HEADER = b'\0\1\0\0'  # little-endian CDR
_LENGTH = struct.Struct('<I')
_FORMATS = {
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

Encoder = Callable[[bytearray, Any], None]


def serialized(message: Any) -> bytes:
    """Return a message serialised; raises InputError for a field of wide characters."""
    data = bytearray()
    _message_encoder(message.__class__)(data, message)
    return HEADER + bytes(data)


@functools.lru_cache
def _message_encoder(message_type: Any) -> Encoder:
    names = list(message_type.get_fields_and_field_types())
    fields = [(name, _encoder(kind)) for name, kind in zip(names, message_type.SLOT_TYPES)]

    def encode(data: bytearray, message: Any) -> None:
        for name, encode_field in fields:
            encode_field(data, getattr(message, name))
        if not fields:  # a message without fields has one byte
            data.append(0)

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
    return _number(kind)


def _number(kind: Any) -> Encoder:
    pack = _format(kind)
    whole = _whole(kind)

    def encode(data: bytearray, value: Any) -> None:
        _align(data, pack.size)
        data += pack.pack(whole(value))

    return encode


def _all_of(kind: Any, *, counted: bool) -> Encoder:
    """Return what appends every element, after their number if they are `counted`."""
    numbers = isinstance(kind, definition.BasicType)
    encode_all = _numbers(kind) if numbers else _each(_encoder(kind))

    def encode(data: bytearray, values: Sequence[Any]) -> None:
        if counted:
            _align(data, _LENGTH.size)
            data += _LENGTH.pack(len(values))
        if len(values):
            encode_all(data, values)

    return encode


def _numbers(kind: Any) -> Encoder:
    size, code, whole = _format(kind).size, _format(kind).format[1:], _whole(kind)

    def encode(data: bytearray, values: Sequence[Any]) -> None:
        _align(data, size)
        data += struct.pack(f'<{len(values)}{code}', *map(whole, values))

    return encode


def _each(encode_one: Encoder) -> Encoder:
    def encode(data: bytearray, values: Sequence[Any]) -> None:
        for value in values:
            encode_one(data, value)

    return encode


def _format(kind: Any) -> struct.Struct:
    name = getattr(kind, 'typename', '')
    if name not in _FORMATS:
        raise InputError(f'a field is of type {type(kind).__name__}, which cannot be serialised')
    return struct.Struct(f'<{_FORMATS[name]}')


def _whole(kind: Any) -> Callable[[Any], Any]:
    """Return what makes a number of a value: an octet is a `bytes` of length one."""
    return ord if kind.typename == 'octet' else _same


def _same(value: Any) -> Any:
    return value


def _put_text(data: bytearray, value: str) -> None:
    text = value.encode() + b'\0'
    _align(data, _LENGTH.size)
    data += _LENGTH.pack(len(text)) + text


def _align(data: bytearray, size: int) -> None:
    data += bytes(-len(data) % size)
