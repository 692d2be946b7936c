# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Finds the messages in the chunks of an MCAP file, many at once.

Where they begin is what the message indexes behind a chunk say; that is believed when they and
what else stands there fill the chunk without a gap. Otherwise the records are walked one by one.

"""

from collections.abc import Collection, Iterable, Sequence
import dataclasses
import io
import itertools
import struct
from typing import Any, BinaryIO

from ballscrew_monitor.recordings.mcap_records import (
    CHUNK,
    chunk_data,
    DAMAGE,
    MESSAGE,
    read_summary,
    RECORD,
    walked,
)
from mcap.data_stream import ReadDataStream
from mcap.records import Chunk, ChunkIndex
import numpy as np
from numpy.typing import NDArray
from surrogate import limits

Integers = NDArray[np.int64]

LATEST = 2**62  # [ns] later log times are taken for this one, which leaves room for differences
MESSAGE_INDEX = 7  # operation code of a record
LONGEST = limits.CHUNK + limits.SUMMARY  # [bytes] of a chunk as it stands and its indexes
PUBLISHED = struct.Struct('<Q')  # the last of the head of a message
MESSAGE_HEAD = 22  # [bytes] channel, number, log time and publish time
CHANNEL_NUMBER, SEQUENCE, LOG_TIME = RECORD.size, RECORD.size + 2, RECORD.size + 6  # in a record


class ChunkDamage(ValueError):
    """A chunk that cannot be used, and why."""


ARRAYS = ('channel', 'begin', 'size', 'log_time', 'place', 'sequence')


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class Messages:
    """
    Messages within `data`: where each begins and how long it is [bytes].

    `channel` and `sequence` are their numbers in the file, `log_time` in [ns]. `place` is that in
    what they were read from: a chunk, or the bag as it is written.

    """

    data: bytes
    channel: Integers
    begin: Integers
    size: Integers
    log_time: Integers
    place: Integers
    sequence: Integers

    def __len__(self) -> int:
        """Return the number of messages."""
        return len(self.begin)

    def some(self, which: NDArray[Any]) -> 'Messages':
        """Return some of the messages."""
        return Messages(data=self.data, **{name: getattr(self, name)[which] for name in ARRAYS})

    def contents(self) -> list[bytes]:
        """Return all messages."""
        spans = zip(self.begin.tolist(), (self.begin + self.size).tolist(), strict=True)
        return [self.data[begin:end] for begin, end in spans]

    def content(self, at: int) -> bytes:
        """Return one message."""
        begin = int(self.begin[at])
        end = begin + int(self.size[at])
        return self.data[begin:end]

    def publish_time(self, at: int) -> int:
        """Return when one message was published [ns]."""
        return int(PUBLISHED.unpack_from(self.data, int(self.begin[at]) - PUBLISHED.size)[0])


def joined(parts: Sequence[Messages]) -> Messages:
    """Return all messages of `parts`, at least one, one part after the other."""
    shifts = [0, *itertools.accumulate(len(part.data) for part in parts)]
    arrays = {name: np.concatenate([getattr(part, name) for part in parts]) for name in ARRAYS}
    arrays['begin'] += np.repeat(shifts[:-1], [len(part) for part in parts])
    return Messages(data=b''.join(part.data for part in parts), **arrays)


def chunk_indexes(
    stream: BinaryIO, topics: Collection[str]
) -> tuple[list[ChunkIndex], dict[int, str]]:
    """Return the chunks with messages of `topics` and these topics by channel number."""
    summary = read_summary(stream)
    channels = {
        number: channel.topic
        for number, channel in summary.channels.items()
        if channel.topic in topics
    }
    indexes = [
        index
        for index in summary.chunk_indexes
        if not index.message_index_offsets or channels.keys() & index.message_index_offsets.keys()
    ]
    return indexes, channels


def read_chunk(stream: BinaryIO, place: ChunkIndex) -> Messages:
    """Return the messages of a chunk as they stand in it; raises ChunkDamage."""
    try:
        stream.seek(place.chunk_start_offset)
        length = place.chunk_length + place.message_index_length
        if length > LONGEST:
            raise ChunkDamage(f'it has {length} bytes, allowed are {LONGEST}')
        raw = stream.read(length)
        chunk, indexes = raw[: place.chunk_length], raw[slice(place.chunk_length, None)]
        data = _records(chunk, place.uncompressed_size)
        starts = _indexed(data, indexes, length)
        return _messages(data, _walked(data, length) if starts is None else starts)
    except ChunkDamage:
        raise
    except DAMAGE as error:
        raise ChunkDamage(' '.join(str(error).split())) from None


def _records(raw: bytes, size: int) -> bytes:
    """Return the records of a chunk that the index says comes to a `size` [bytes]."""
    code, length = RECORD.unpack_from(raw)
    if code != CHUNK or length != len(raw) - RECORD.size:
        raise ChunkDamage('no chunk stands where there should be one')
    chunk = Chunk.read(ReadDataStream(io.BytesIO(raw[slice(RECORD.size, None)])))
    if size < chunk.uncompressed_size <= limits.CHUNK:
        raise ChunkDamage(f'it states {chunk.uncompressed_size} bytes, the index {size}')
    return chunk_data(chunk)


def _indexed(data: bytes, indexes: bytes, stored: int) -> Integers | None:
    """
    Return where message records begin by the `indexes`, None if these do not tell of all.

    Of records that are none at most as many are passed as the chunk has `stored` [bytes].

    """
    parts, at = [], 0
    while at + RECORD.size <= len(indexes):
        code, length = RECORD.unpack_from(indexes, at)
        at += RECORD.size
        if code == MESSAGE_INDEX and length >= 6 and at + length <= len(indexes):
            pairs = np.frombuffer(indexes, '<u8', (length - 6) // 16 * 2, at + 6)
            parts.append(pairs[1::2].astype(np.int64))
        at += length
    if not parts:
        return None
    starts = np.sort(np.concatenate(parts))
    if len(starts) > limits.RECORDS:
        raise ChunkDamage(f'it holds more than {limits.RECORDS} records')
    return starts if _fill(data, starts, stored) else None


def _fill(data: bytes, starts: Integers, stored: int) -> bool:
    """Tell whether messages at `starts`, and records that are none, fill all of the data."""
    last = len(data) - RECORD.size - MESSAGE_HEAD
    if not len(starts) or starts[0] < 0 or starts[-1] > last:
        return False
    if (np.frombuffer(data, np.uint8)[starts] != MESSAGE).any():
        return False
    ends = starts + RECORD.size + unaligned(data, '<i8')[starts + 1]
    gaps = np.flatnonzero(ends[:-1] != starts[1:])
    holes = [(0, starts[0]), *((ends[gap], starts[gap + 1]) for gap in gaps)]
    return _hold_no_message(data, [*holes, (ends[-1], len(data))], stored)


def _hold_no_message(data: bytes, holes: Iterable[tuple[int, int]], most: int) -> bool:
    """Tell whether at most so many records, none of them a message, fill holes of the data."""
    for begin, end in holes:
        while begin + RECORD.size <= end:
            code, length = RECORD.unpack_from(data, begin)
            most -= 1
            if code == MESSAGE or most < 0:
                return False
            begin += RECORD.size + length
        if begin != end:
            return False
    return True


def _walked(data: bytes, stored: int) -> Integers:
    """Return where message records begin, one after another, in a chunk of `stored` [bytes]."""
    return np.array([at for code, at in walked(data, stored) if code == MESSAGE], dtype=np.int64)


def _messages(data: bytes, starts: Integers) -> Messages:
    length = unaligned(data, '<i8')[starts + 1]
    if (length < MESSAGE_HEAD).any():
        raise ChunkDamage('a message has no head')
    begin = starts + RECORD.size + MESSAGE_HEAD
    return Messages(
        data=data,
        channel=unaligned(data, '<u2')[starts + CHANNEL_NUMBER].astype(np.int64),
        begin=begin,
        size=length - MESSAGE_HEAD,
        log_time=np.minimum(unaligned(data, '<u8')[starts + LOG_TIME], LATEST).astype(np.int64),
        place=begin,
        sequence=unaligned(data, '<u4')[starts + SEQUENCE].astype(np.int64),
    )


def unaligned(data: bytes, kind: str) -> NDArray[Any]:
    """Return a view of the data that begins a number of this `kind` at every byte."""
    count = max(len(data) - np.dtype(kind).itemsize + 1, 0)
    return np.ndarray((count,), kind, data, strides=(1,))
