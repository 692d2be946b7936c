# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
The number of an input in the bytes of a message, without an object of its type.

Lengths and texts tell where a number stands, and change seldom: while they are those of an earlier
message, the number stands where it stood there. What the steps of a layout do not reach is read
from the decoded message, as is a message that lacks the number.

"""

from collections.abc import Callable
import operator
import struct
from typing import Any, NamedTuple

from ballscrew_monitor.core.cdr import HEADER
from ballscrew_monitor.core.conversions import SECOND
from ballscrew_monitor.core.inputs import Input
from ballscrew_monitor.recordings.bulk.layout import (
    BY_NAME,
    COUNTED,
    HEAD,
    Layout,
    NAMES,
    NoLayout,
    NUMBERS,
    STAMP,
    TEXTS,
)

MOST_FORMS = 8
"""Forms of the messages of a topic that are known at a time, such as those of its publishers."""
_LENGTH, _STAMP = struct.Struct('<I'), struct.Struct('<iI')
Unpack = Callable[[bytes, int], tuple[Any, ...]]


class _Form(NamedTuple):
    """Lengths and texts of a message, and where its number and its stamp stand, -1 if nowhere."""

    size: int
    spans: Callable[[bytes], Any]
    content: Any  # of the spans
    number: int
    stamp: int


class RawField:
    """Finds the number of an input in serialised messages, and their stamp."""

    def __init__(self, source: Input) -> None:
        """Make the steps; raises NoLayout when that is not possible."""
        self.layout = layout = Layout(source)
        self._steps = [tuple(step) for step in layout.steps.tolist()]
        if any(step[0] not in (NUMBERS, TEXTS) for step in self._steps):
            raise NoLayout  # behind a list of messages
        self._joint = layout.joint.tobytes()
        self._unpack: Unpack = struct.Struct(layout.code).unpack_from
        self._forms: list[_Form] = []

    def find(self, data: bytes) -> tuple[float, int] | None:
        """Return number and stamp [ns] of a message, None if the decoded message is to tell."""
        size = len(data)
        for form in self._forms:
            if form.size == size and form.spans(data) == form.content:
                break
        else:
            try:
                form = self._form(data)
            except (struct.error, UnicodeDecodeError, ValueError):
                return None  # of a message that these steps do not pass
            self._forms = [form, *self._forms[: MOST_FORMS - 1]]
        if form.number < 0:
            return None
        number = float(self._unpack(data, form.number)[0])
        if form.stamp < 0:
            return number, 0
        seconds, nanoseconds = _STAMP.unpack_from(data, form.stamp)
        return number, seconds * SECOND + nanoseconds

    def _form(self, data: bytes) -> _Form:
        spans = [slice(0, HEAD)]
        at, place, number, stamp = HEAD, -1, -1, -1
        for kind, size, count, most, wanted in self._steps:
            if count == COUNTED:
                at, count = _length(data, at, spans)
                if count > min(most, len(data)):
                    raise ValueError
            if kind == TEXTS:
                for element in range(count):
                    at, length = _length(data, at, spans)
                    text = _text(data, at, length)
                    spans.append(slice(at, at + length))
                    if wanted == NAMES and place < 0 and text == self._joint:
                        place = element
                    at += length
                continue
            at += -(at - HEAD) % size if count else 0
            index = place if wanted == BY_NAME else wanted
            if wanted == STAMP:
                stamp = at
            elif 0 <= index < count:
                number = at + index * size
            at += count * size
        if at > len(data) or data[:HEAD] != HEADER:
            raise ValueError
        spanned = operator.itemgetter(*spans)
        return _Form(len(data), spanned, spanned(data), number, stamp)


def _length(data: bytes, at: int, spans: list[slice]) -> tuple[int, int]:
    """Return the place behind a length, and the length."""
    at += -(at - HEAD) % _LENGTH.size
    spans.append(slice(at, at + _LENGTH.size))
    return at + _LENGTH.size, _LENGTH.unpack_from(data, at)[0]


def _text(data: bytes, at: int, length: int) -> bytes:
    """Return a text without its end; raises ValueError unless it is of ASCII letters."""
    end = at + length
    text, last = data[at:end][:-1], data[at:end][-1:]
    if length and (last != b'\0' or len(text) != length - 1 or b'\0' in text):
        raise ValueError
    text.decode('ascii')
    return text
