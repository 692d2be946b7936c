# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
The way to a number in the serialised messages of a type: steps from the first byte to the last.

The steps are made once from the definition of the type. `walk` follows them through one message,
`walk_many` through many; both keep to the subset that `surrogate.surface.compiled` describes.

"""

import enum
import functools
import re
from typing import Any, NamedTuple

from ballscrew_monitor.core import fields
from ballscrew_monitor.core.cdr import HEADER
from ballscrew_monitor.core.fields import MessageClass
from ballscrew_monitor.core.inputs import Input
import numpy as np
from numpy.typing import NDArray
from surrogate.surface.compiled import compiled

HEAD = len(HEADER)
_0, _1, _2, _3 = HEADER
NUMBERS, TEXTS, LOOP, LOOP_ENDS = 0, 1, 2, 3
"""Kinds of a step: some numbers, some texts, the begin and the end of a list of messages."""
COUNTED = -1
"""Count of a step whose count stands in the message."""
NOT_WANTED, BY_NAME = -1, -2
"""Elements of a step that are not wanted, or the one that is named like the joint."""
STAMP, NAMES = -3, -4
"""Second and nanosecond of the header, and the names of the joints."""
ANY = 2**31
"""Most elements of a list without a bound."""
KINDS = {
    name: f'<{letter}' for name, letter in (fields.FORMATS | {'boolean': 'B', 'char': 'B'}).items()
}
_SEQUENCE = re.compile(r'sequence<(.+?)(?:, (\d+))?>')
_ARRAY = re.compile(r'(.+)\[(\d+)\]')
_TEXT = re.compile(r'string(?:<(\d+)>)?')


class Outcome(enum.IntEnum):
    """What a walk finds in a message."""

    NUMBER = 0
    OTHER_JOINTS = 1
    TOO_SHORT = 2
    UNREADABLE = 3  # by these steps; the decoder of the middleware may know more


NUMBER, OTHER_JOINTS, TOO_SHORT, UNREADABLE = map(int, Outcome)
WALKED = np.dtype(
    [
        ('outcome', np.int64),
        ('bits', np.uint64),  # of the number; its element is missing in an array of that length
        ('seconds', np.int64),
        ('nanoseconds', np.int64),
        ('names_begin', np.int64),
        ('names_end', np.int64),
    ]
)
"""What `walk_many` says of each message."""


class NoLayout(Exception):
    """A type whose steps `walk` cannot follow."""


class _Step(NamedTuple):
    kind: int
    size: int = 1  # [bytes] of an element; steps of a list of messages
    elements: int = 1
    most: int = ANY
    wanted: int = NOT_WANTED


class Layout:
    """The steps to the field of an input in the messages of its type."""

    def __init__(self, source: Input) -> None:
        """Make the steps; raises NoLayout when that is not possible."""
        *self._path, (self._name, key) = fields.segments_of(source.field)
        self._key = key
        self._kind = ''
        self._steps: list[_Step] = []
        self._stamped = source.stamped
        self._message(source.message_type, self._path, is_top=True)
        if not self._kind or not self._steps:
            raise NoLayout
        by_name = key is not None and not key.isdecimal()
        self.joint = np.frombuffer((key or '').encode() if by_name else b'', np.uint8)
        self.steps = np.array(self._steps, dtype=np.int64)
        arrays = fields.arrays_of(source.field)
        self.array = arrays.index((self._name, key)) if key is not None else 0

    def walk(self, data: bytes, begin: NDArray[np.int64], size: NDArray[np.int64]) -> NDArray[Any]:
        """Return what is found in the messages in `data`, as WALKED."""
        walked = np.zeros(len(begin), dtype=WALKED)
        view = np.frombuffer(data, np.uint8)
        # Fields are attributes of its records, compiled or not.
        records = walked.view(np.recarray)
        compiled_walk()(view, begin, size, self.steps, self.joint, records)
        return walked

    def numbers(self, walked: NDArray[Any]) -> NDArray[np.float64]:
        """Return the number of each message that has one."""
        return numbers_of(walked['bits'], self._kind)

    @property
    def code(self) -> str:
        """Return the code of the number, as `struct` takes it."""
        return self._kind

    def _message(self, kind: MessageClass, path: list[Any], *, is_top: bool = False) -> None:
        """Add the steps through a message, in which the rest of the path may begin."""
        members = kind.get_fields_and_field_types()
        if not members:
            raise NoLayout
        for name, member in members.items():
            inside = bool(path) and path[0][0] == name
            if is_top and name == 'header' and self._stamped:
                self._steps.append(_Step(NUMBERS, 4, 2, wanted=STAMP))
                self._steps.append(_Step(TEXTS))
            elif not path and name == self._name and not self._kind:
                self._wanted(member)
            elif name == 'name' and not path and self._key and not self._key.isdecimal():
                self._steps.append(_Step(TEXTS, elements=COUNTED, wanted=NAMES))
            elif inside and path[0][1] is None and '/' in member:
                self._message(_class(member), path[1:])
            elif inside:
                raise NoLayout  # within a list of messages
            else:
                self._pass(member)

    def _wanted(self, member: str) -> None:
        kind, count, most = _parts(member)
        if kind not in KINDS:
            raise NoLayout
        wanted = 0
        if self._key is not None:
            wanted = int(self._key) if self._key.isdecimal() else BY_NAME
        if wanted == BY_NAME and all(step.wanted != NAMES for step in self._steps):
            raise NoLayout  # the names come behind the numbers
        self._kind = KINDS[kind]
        self._steps.append(_Step(NUMBERS, _size(kind), count, most, wanted))

    def _pass(self, member: str) -> None:
        kind, count, most = _parts(member)
        if kind in KINDS:
            self._steps.append(_Step(NUMBERS, _size(kind), count, most))
        elif _TEXT.fullmatch(kind):
            self._steps.append(_Step(TEXTS, elements=count, most=most))
        elif '/' in kind and member == kind:
            self._inner(kind)
        elif '/' in kind:
            begin = len(self._steps)
            self._inner(kind)
            body = self._steps[begin:]
            if any(step.kind == LOOP for step in body):
                raise NoLayout  # lists within lists
            self._steps[begin:] = [
                _Step(LOOP, len(body) + 1, count, most),
                *body,
                _Step(LOOP_ENDS),
            ]
        else:
            raise NoLayout

    def _inner(self, kind: str) -> None:
        members = _class(kind).get_fields_and_field_types()
        if not members:
            raise NoLayout
        for member in members.values():
            self._pass(member)


def numbers_of(bits: NDArray[np.uint64], code: str) -> NDArray[np.float64]:
    """Return the numbers that bits stand for by the code of their kind."""
    kind = np.dtype(code)
    raw = np.ascontiguousarray(bits).astype('<u8').view(np.uint8).reshape(-1, 8)
    return np.ascontiguousarray(raw[:, : kind.itemsize]).view(kind)[:, 0].astype(np.float64)


def _class(kind: str) -> MessageClass:
    package, name = kind.split('/')
    return fields.message_class(f'{package}/msg/{name}')


def _size(kind: str) -> int:
    return np.dtype(KINDS[kind]).itemsize


def _parts(member: str) -> tuple[str, int, int]:
    """Return the type of the elements of a member, how many there are, and at most are."""
    if sequence := _SEQUENCE.fullmatch(member):
        return sequence[1], COUNTED, int(sequence[2] or ANY)
    if array := _ARRAY.fullmatch(member):
        return array[1], int(array[2]), ANY
    return member, 1, ANY


@functools.cache
def compiled_walk() -> Any:
    """Return `walk_many`, compiled where there is numba."""
    try:
        return compiled(walk_many)
    except ImportError:
        return walk_many


def walk_many(data: Any, begin: Any, size: Any, steps: Any, joint: Any, walked: Any) -> None:
    """Follow the steps through messages in `data` that begin there and have a size [bytes]."""
    for at in range(len(begin)):
        walk(data, begin[at], begin[at] + size[at], steps, joint, walked[at])


def walk(data: Any, begin: int, end: int, steps: Any, joint: Any, told: Any) -> None:
    """Follow the steps through the message between two places of `data`; fill `told` of it."""
    told.outcome = UNREADABLE
    if end - begin < HEAD or data[begin] != _0 or data[begin + 1] != _1:
        return
    if data[begin + 2] != _2 or data[begin + 3] != _3:  # not of little-endian CDR
        return
    origin = begin + HEAD
    at, number, place, outcome = origin, 0, -1, UNREADABLE
    loop_begins, loop_left = 0, 0
    while number < len(steps):
        kind, size = steps[number, 0], steps[number, 1]
        count, wanted = steps[number, 2], steps[number, 4]
        number += 1
        if kind == LOOP_ENDS:
            loop_left -= 1
            if loop_left > 0:
                number = loop_begins
            continue
        if count == COUNTED:
            at += (origin - at) % 4
            if end - at < 4:
                return
            count = _word(data, at)
            at += 4
            if count > end - at or count > steps[number - 1, 3]:
                return
        if kind == LOOP:
            loop_begins, loop_left = number, count
            if count == 0:
                number += size
        elif kind == TEXTS:
            first = at
            for element in range(count):
                at += (origin - at) % 4
                if end - at < 4:
                    return
                length = _word(data, at)
                at += 4
                if length > end - at or not _is_plain_text(data, at, length):
                    return
                if wanted == NAMES and place < 0 and _is_text(data, at, length, joint):
                    place = element
                at += length
            if wanted == NAMES:
                told.names_begin, told.names_end = first, at
        elif count > 0:
            at += (origin - at) % size
            if count * size > end - at:
                return
            if wanted == STAMP:
                seconds = _word(data, at)
                told.seconds = seconds - 4294967296 if seconds >= 2147483648 else seconds
                told.nanoseconds = _word(data, at + 4)
            elif wanted >= 0 or wanted == BY_NAME:
                index = place if wanted == BY_NAME else wanted
                if 0 <= index < count:
                    told.bits = _number(data, at + index * size, size)
                    outcome = NUMBER
                else:
                    told.bits = count
                    outcome = TOO_SHORT
            at += count * size
        elif wanted >= 0 or wanted == BY_NAME:
            told.bits = 0
            outcome = TOO_SHORT
        if wanted == BY_NAME and place < 0:
            outcome = OTHER_JOINTS
    told.outcome = outcome


def _word(data: Any, at: int) -> Any:
    low = np.int64(data[at]) | np.int64(data[at + 1]) << 8
    high = np.int64(data[at + 2]) | np.int64(data[at + 3]) << 8
    return low | high << 16


def _number(data: Any, at: int, size: int) -> Any:
    if size == 8:
        return np.uint64(_word(data, at)) | np.uint64(_word(data, at + 4)) << np.uint64(32)
    if size == 4:
        return np.uint64(_word(data, at))
    bits = np.uint64(data[at])
    return bits | np.uint64(data[at + 1]) << np.uint64(8) if size == 2 else bits


def _is_plain_text(data: Any, at: int, length: int) -> bool:
    """Return True if a text of a `length` with its end is of ASCII letters."""
    if length == 0:
        return True
    for place in range(at, at + length - 1):
        if data[place] == 0 or data[place] >= 128:
            return False
    return bool(data[at + length - 1] == 0)


def _is_text(data: Any, at: int, length: int, text: Any) -> bool:
    """Return True if a text of a `length` with its end is this one."""
    if length - 1 != len(text):
        return False
    for place in range(len(text)):
        if data[at + place] != text[place]:
            return False
    return True
