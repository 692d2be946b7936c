# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Serialised messages of many rows at once.

Messages of one shape differ in their stamp and their numbers alone: these are put into the bytes
of one of them.

"""

from collections.abc import Iterator, Sequence
import struct
from typing import Any

from ballscrew_monitor.core.cdr import serialized
from ballscrew_monitor.core.conversions import SECOND
import numpy as np
from numpy.typing import NDArray

BLOCK = 4096  # rows that are made at a time
_STAMP = (1_234_567_891, 987_654_321)  # [s], [ns]


def marks(count: int) -> list[float]:
    """Return numbers that stand in a message for those of its rows, in their order."""
    return [1.234567890123e200 * (number + 1) for number in range(count)]


class RowTemplate:
    """One message with a header, and `count` numbers in it that are `marks`."""

    def __init__(self, message: Any, count: int) -> None:
        """Find where the stamp and the marks stand in the bytes of `message`."""
        message.header.stamp.sec, message.header.stamp.nanosec = _STAMP
        data = serialized(message)
        self._bytes = np.frombuffer(data, np.uint8)
        self._stamp = data.index(struct.pack('<iI', *_STAMP))
        self._places = [data.index(struct.pack('<d', mark)) for mark in marks(count)]

    def rows(
        self, stamps: NDArray[np.int64], numbers: Sequence[NDArray[np.float64]]
    ) -> Iterator[bytes]:
        """Yield the message of each row, of its stamp [ns] and its numbers."""
        for begin in range(0, len(stamps), BLOCK):
            part = slice(begin, begin + BLOCK)
            yield from self._block(stamps[part], [values[part] for values in numbers])

    def _block(
        self, stamps: NDArray[np.int64], numbers: Sequence[NDArray[np.float64]]
    ) -> Iterator[bytes]:
        data = np.tile(self._bytes, (len(stamps), 1))
        times = np.stack([stamps // SECOND, stamps % SECOND], axis=1).astype('<u4')
        _put(data, self._stamp, times)
        for place, values in zip(self._places, numbers, strict=True):
            _put(data, place, np.array(values, dtype='<f8').reshape(-1, 1))
        return (row.tobytes() for row in data)


def _put(data: NDArray[np.uint8], begin: int, numbers: NDArray[Any]) -> None:
    """Write the numbers of each row to its bytes."""
    parts = numbers.view(np.uint8)
    end = begin + parts.shape[1]
    data[:, begin:end] = parts
