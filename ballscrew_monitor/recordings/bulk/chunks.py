# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Finds the messages in the chunks of an MCAP file by one compiled walk over their records.

What the message indexes behind a chunk say is not asked.

"""

from collections.abc import Collection, Sequence
import dataclasses
import functools
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
)
from mcap.data_stream import ReadDataStream
from mcap.records import Chunk, ChunkIndex
import numpy as np
from numpy.typing import NDArray
from surrogate.files import limits
from surrogate.surface.compiled import compiled

Integers = NDArray[np.int64]

LATEST = 2**62  # [ns] later log times are taken for this one, which leaves room for differences
LONGEST = limits.CHUNK + limits.SUMMARY  # [bytes] of a chunk as it stands and its indexes
PUBLISHED = struct.Struct('<Q')  # the last of the head of a message
MESSAGE_HEAD = 22  # [bytes] channel, number, log time and publish time
RECORD_HEAD = RECORD.size
SHORTEST = RECORD_HEAD + MESSAGE_HEAD  # [bytes] of a record with a message
TOO_MANY, CUT_OFF, HEADLESS = -1, -2, -3
DEFECTS = {
    TOO_MANY: 'it holds more than {most} records',
    CUT_OFF: 'its last record is cut off',
    HEADLESS: 'a message has no head',
}
"""What is wrong with the records of a chunk."""
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
        data = _records(stream.read(place.chunk_length), place.uncompressed_size)
        most = min(limits.RECORDS, length)  # the reason is that of `mcap_records.walked`
        starts = np.empty(min(most, len(data) // SHORTEST) + 1, dtype=np.int64)
        count = int(compiled_record_walk()(np.frombuffer(data, np.uint8), starts, most))
        if count in DEFECTS:
            raise ChunkDamage(DEFECTS[count].format(most=most))
        return _messages(data, starts[:count])
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


@functools.cache
def compiled_record_walk() -> Any:
    """Return `message_starts`, compiled where there is numba."""
    try:
        return compiled(message_starts)
    except ImportError:
        return message_starts


def message_starts(data: Any, starts: Any, most: int) -> int:
    """Put where messages begin into `starts`; return how many, or one of `DEFECTS`."""
    at, count, records = 0, 0, 0
    while at + RECORD_HEAD <= len(data):
        length = np.int64(0)
        for place in range(7, -1, -1):
            if length > len(data):
                return CUT_OFF
            length = length << 8 | np.int64(data[at + 1 + place])
        records += 1
        if records > most:
            return TOO_MANY
        if length > len(data) - at - RECORD_HEAD:
            return CUT_OFF
        if data[at] == MESSAGE:
            if length < MESSAGE_HEAD:
                return HEADLESS
            starts[count] = at
            count += 1
        at += RECORD_HEAD + int(length)
    return count if at == len(data) else CUT_OFF


def _messages(data: bytes, starts: Integers) -> Messages:
    length = unaligned(data, '<i8')[starts + 1]
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
