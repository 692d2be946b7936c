# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Places of the numbers in the serialised messages of one topic.

Lengths and texts decide where everything else stands, so messages with equal ones are read alike.
A layout is taken from one message and trusted for all others whose deciding bytes are equal.

"""

from collections.abc import Iterator, Sequence
import math
import re
import struct
from types import SimpleNamespace
from typing import Any

from ballscrew_monitor.core import fields
from ballscrew_monitor.core.cdr import HEADER
from ballscrew_monitor.core.inputs import Input
from ballscrew_monitor.recordings.bulk.chunks import Integers, unaligned
import numpy as np
from numpy.typing import NDArray

HEAD = len(HEADER)
WORD = 8  # [bytes] compared at once
KINDS = {
    name: f'<{letter}' for name, letter in (fields.FORMATS | {'boolean': 'B', 'char': 'B'}).items()
}
_SEQUENCE = re.compile(r'sequence<(.+?)(?:, \d+)?>')
_ARRAY = re.compile(r'(.+)\[(\d+)\]')
_TEXT = re.compile(r'string(<\d+>)?')


class NoLayout(Exception):
    """A message whose numbers have no place that could be told from its bytes."""


class Layout:
    """Places of all numbers of the messages that are like one example."""

    def __init__(self, example: bytes, message_type: fields.MessageClass) -> None:
        """Learn from one message; raises NoLayout when that is not possible."""
        walk = _Walk(example)
        try:
            self._places = walk.message(message_type)
        except (struct.error, UnicodeDecodeError, MemoryError):
            raise NoLayout from None
        self.size = len(example)
        self._kinds = walk.kinds
        self._words = list(_words(example, walk.fixed))

    def fits(self, data: bytes, begin: Integers, size: Integers) -> NDArray[np.bool_]:
        """Tell which messages in `data` are like the example."""
        fits = size == self.size
        # Messages of another size may end before the word does.
        begin = np.where(fits, begin, begin[fits][0] if fits.any() else 0)
        if fits.any():
            words = unaligned(data, '<u8')
            for place, mask, expected in self._words:
                fits &= (words[begin + place] & mask) == expected
        return fits

    def find(self, source: Input) -> int | fields.OtherJoints | fields.TooShort:
        """Return where the field of an input stands [bytes], or what there is instead."""
        found = source.read_field(self._places)
        return int(found) if isinstance(found, float) else found

    def numbers(self, data: bytes, begin: Integers, place: int) -> NDArray[np.float64]:
        """Return the number at a `place` of each message."""
        values = unaligned(data, self._kinds[place])[begin + place]
        return values.astype(np.float64)

    def stamps(self, data: bytes, begin: Integers) -> Integers:
        """Return the stamp in the header of each message [ns]."""
        stamp = self._places.header.stamp
        seconds = unaligned(data, '<i4')[begin + stamp.sec].astype(np.int64)
        return seconds * 1_000_000_000 + unaligned(data, '<u4')[begin + stamp.nanosec]


class _Walk:
    """One way through a serialised message; numbers become their places."""

    def __init__(self, data: bytes) -> None:
        if data[:HEAD] != HEADER:
            raise NoLayout
        self._data, self._at = data, HEAD
        self.kinds: dict[int, str] = {}
        self.fixed = np.zeros(len(data), dtype=bool)
        self.fixed[:HEAD] = True

    def message(self, kind: fields.MessageClass) -> SimpleNamespace:
        """Pass a message; return its fields by name."""
        kinds = kind.get_fields_and_field_types()
        if not kinds:
            raise NoLayout
        return SimpleNamespace(**{name: self._value(each) for name, each in kinds.items()})

    def _value(self, kind: str) -> Any:
        if sequence := _SEQUENCE.fullmatch(kind):
            return self._elements(sequence[1], self._length())
        if array := _ARRAY.fullmatch(kind):
            return self._elements(array[1], int(array[2]))
        if kind in KINDS:
            return self._numbers(kind, 1)[0]
        if _TEXT.fullmatch(kind):
            return self._text()
        if '/' not in kind:
            raise NoLayout
        package, name = kind.split('/')
        return self.message(fields.message_class(f'{package}/msg/{name}'))

    def _elements(self, kind: str, count: int) -> Any:
        if kind in KINDS:
            return self._numbers(kind, count)
        return [self._value(kind) for _ in range(count)]

    def _numbers(self, kind: str, count: int) -> Sequence[Any]:
        """Pass numbers of one kind; return their places."""
        size = np.dtype(KINDS[kind]).itemsize
        if count:
            self._align(size)
        places = range(self._at, self._at + count * size, size)
        self._pass(count * size)
        self.kinds.update(dict.fromkeys(places, KINDS[kind]))
        # Of an octet, which is no number in Python, the reader of a field takes the code.
        return [chr(place) for place in places] if kind == 'octet' else places

    def _length(self) -> int:
        """Pass the length of what follows, which decides on the layout."""
        self._align(4)
        (length,) = struct.unpack_from('<I', self._data, self._at)
        self._fix(4)
        if length > len(self._data):
            raise NoLayout
        return int(length)

    def _text(self) -> str:
        length, begin = self._length(), self._at
        self._fix(length)
        content = self._data[slice(begin, self._at)]
        if length and content[-1]:
            raise NoLayout
        return content[:-1].decode()

    def _align(self, size: int) -> None:
        self._at += (HEAD - self._at) % size

    def _fix(self, size: int) -> None:
        begin = self._at
        self._pass(size)
        self.fixed[slice(begin, self._at)] = True

    def _pass(self, size: int) -> None:
        self._at += size
        if self._at > len(self._data):
            raise NoLayout


def _words(example: bytes, fixed: NDArray[np.bool_]) -> Iterator[tuple[int, Any, Any]]:
    """Yield place, mask and content of the words that hold all fixed bytes."""
    if len(example) < WORD:
        raise NoLayout
    left, content = fixed.copy(), np.frombuffer(example, np.uint8)
    while left.any():
        place = min(int(left.argmax()), len(example) - WORD)
        part = slice(place, place + WORD)
        mask = np.where(fixed[part], 255, 0).astype(np.uint8)
        yield place, mask.view('<u8')[0], (content[part] & mask).view('<u8')[0]
        left[part] = False


def reads_alike(layout: Layout, example: bytes, message: Any, source: Input) -> bool:
    """Tell whether a layout reads of its example what is in the decoded `message`."""
    found, expected = layout.find(source), source.read_field(message)
    if not isinstance(found, int) or not isinstance(expected, float):
        return found == expected
    begin = np.zeros(1, dtype=np.int64)
    value = float(layout.numbers(example, begin, found)[0])
    return value == expected or (math.isnan(value) and math.isnan(expected))
