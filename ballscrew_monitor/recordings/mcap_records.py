# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Records of an MCAP file within limits: its summary, those of a chunk, and all that are whole.

Nothing is decoded, so the types need not be installed.

"""

from collections.abc import Iterator
import io
from pathlib import Path
import struct
from typing import Any, BinaryIO
import zlib

from ballscrew_monitor.recordings.unpacking import unpacked
from mcap.data_stream import ReadDataStream
from mcap.exceptions import McapError
from mcap.reader import SeekingReader
from mcap.records import Channel, Chunk, Message, Metadata, Schema
from mcap.summary import Summary
from surrogate.files import limits
from zstandard import ZstdError

# What the reader is known to raise for a file that is not as it should be.
DAMAGE = (
    McapError,
    ValueError,
    KeyError,
    IndexError,
    TypeError,
    AttributeError,
    EOFError,
    struct.error,
    MemoryError,
    OverflowError,
    RuntimeError,
    ZstdError,
)
MAGIC_SIZE = 8  # [bytes] at the begin and at the end of a file
RECORD = struct.Struct('<BQ')  # operation code and length of what follows
FOOTER = struct.Struct('<BQQQI')  # code, length, begin of summary and its offsets, checksum
FOOTER_HEAD = [2, FOOTER.size - RECORD.size]
KINDS: dict[int, Any] = {3: Schema, 4: Channel, 12: Metadata}
"""Records that are read besides messages and chunks, by their operation codes."""
MESSAGE, CHUNK, DATA_END = 5, 6, 15


class RecordDamage(ValueError):
    """The first record that is not whole: where it begins, what is lost with it, and why."""

    def __init__(self, place: int, end: int, reason: str) -> None:
        """Name the record at `place` [bytes] of a file that has `end` bytes."""
        super().__init__(f'the record at byte {place} is damaged: {reason}')
        self.place = place
        self.lost = ''
        if place < end:
            self.lost = f'the last {end - place} bytes, from byte {place} on, are left out'


class NoSummary(McapError):
    """A file that does without a summary, or whose summary leaves out what its channels are."""


def read_summary(stream: BinaryIO) -> Summary:
    """
    Return the summary of a file.

    Raises NoSummary for a file that has none, and one of `DAMAGE` for one that contradicts itself.

    """
    whole = stream.seek(0, io.SEEK_END)
    if whole < FOOTER.size + 2 * MAGIC_SIZE:
        raise McapError('it has no summary')
    stream.seek(-(FOOTER.size + MAGIC_SIZE), io.SEEK_END)
    *head, begin, _, checksum = FOOTER.unpack(stream.read(FOOTER.size))
    size = stream.tell() - begin
    if not begin and head == FOOTER_HEAD:
        raise NoSummary('it has no summary')
    if not begin or not 0 < size <= limits.SUMMARY:
        raise McapError('it has no summary')
    stream.seek(begin)
    if checksum and zlib.crc32(stream.read(size)[:-4]) != checksum:
        raise McapError('the checksum of its summary is wrong')
    stream.seek(0)
    reader = SeekingReader(stream, record_size_limit=limits.SUMMARY)
    summary = reader.get_summary()
    if summary is None:
        raise McapError('it has no summary')
    statistics = summary.statistics
    if (
        statistics is None
        or (statistics.message_count and statistics.channel_count and not summary.channels)
        or (statistics.schema_count and not summary.schemas)
    ):
        raise NoSummary('its summary tells nothing of its messages')
    _check(summary, whole)
    return summary


def _check(summary: Summary, size: int) -> None:
    """Raise McapError if a summary contradicts itself, or the `size` of its file [bytes]."""
    # Chunks within each other would be unpacked again and again.
    sizes = [chunk.chunk_length + chunk.message_index_length for chunk in summary.chunk_indexes]
    if sum(sizes) > size:
        raise McapError('its chunks overlap')
    statistics = summary.statistics
    assert statistics is not None
    named = {chunk.chunk_start_offset for chunk in summary.chunk_indexes}
    # A file may do without an index.
    if named and not statistics.chunk_count == len(summary.chunk_indexes) == len(named):
        raise McapError(
            f'its statistics count {statistics.chunk_count} chunks, its summary names {len(named)}'
        )
    counts, channels = statistics.channel_message_counts, summary.channels
    counted = sum(count for number, count in counts.items() if number in channels)
    if counted != statistics.message_count:
        raise McapError(
            f'its statistics count {statistics.message_count} messages, of its channels {counted}'
        )


def read_metadata(stream: BinaryIO) -> Iterator[Metadata]:
    """Yield what a file says of itself; raises one of `DAMAGE`."""
    for index in read_summary(stream).metadata_indexes:
        stream.seek(index.offset)
        code, length = RECORD.unpack(stream.read(RECORD.size))
        record = _parsed(code, _body(stream, length))
        if not isinstance(record, Metadata):
            raise McapError('no metadata stand where they should')
        yield record


def chunk_data(chunk: Chunk) -> bytes:
    """Return the records of a chunk, unpacked and with the right checksum; raises ValueError."""
    size = chunk.uncompressed_size
    if size > limits.CHUNK:
        raise ValueError(f'it states {size} bytes, allowed are {limits.CHUNK}')
    data = unpacked(chunk.data, size, compression=chunk.compression)
    if len(data) != size:
        raise ValueError(f'it holds {len(data)} bytes, it should hold {size}')
    if chunk.uncompressed_crc and zlib.crc32(data) != chunk.uncompressed_crc:
        raise ValueError('its checksum is wrong')
    return data


def walked(data: bytes, stored: int) -> list[tuple[int, int]]:
    """
    Return code and begin [bytes] of the records of a chunk; raises ValueError.

    A chunk of `stored` [bytes] in its file holds no more records: the times of a message alone
    take three bytes and more, while pictures of one grey take next to none. So the size of a file
    bounds the work.

    """
    records, at, end, unpack = [], 0, len(data) - RECORD.size, RECORD.unpack_from
    most = min(limits.RECORDS, stored)
    while at <= end:
        code, length = unpack(data, at)
        records.append((code, at))
        if len(records) > most:
            raise ValueError(f'it holds more than {most} records')
        at += RECORD.size + length
    if at != len(data):
        raise ValueError('its last record is cut off')
    return records


def whole_records(file: Path) -> Iterator[Any]:
    """
    Yield the records of an MCAP file up to the end of its data, those of a chunk in its place.

    Raises RecordDamage at the first record that is not whole.

    """
    with file.open('rb') as stream:
        end, at = stream.seek(0, io.SEEK_END), MAGIC_SIZE
        while at + RECORD.size <= end:
            stream.seek(at)
            code, length = RECORD.unpack(stream.read(RECORD.size))
            if code == DATA_END:
                return
            try:
                yield from _read(stream, code, min(length, end))
            except DAMAGE as error:
                raise RecordDamage(at, end, ' '.join(str(error).split())) from None
            at += RECORD.size + length
        raise RecordDamage(min(at, end), end, 'the file ends within it')


def _read(stream: BinaryIO, code: int, length: int) -> Iterator[Any]:
    if code == CHUNK:
        data = chunk_data(Chunk.read(ReadDataStream(io.BytesIO(_body(stream, length)))))
        for kind, at in walked(data, length):
            begin = at + RECORD.size
            end = begin + RECORD.unpack_from(data, at)[1]
            yield from _known(kind, data[begin:end])
    elif code in KINDS or code == MESSAGE:
        yield from _known(code, _body(stream, length))


def _known(code: int, body: bytes) -> Iterator[Any]:
    record = _parsed(code, body)
    if record is not None:
        yield record


def _body(stream: BinaryIO, length: int) -> bytes:
    if length > limits.CHUNK:
        raise McapError(f'a record of {length} bytes, allowed are {limits.CHUNK}')
    body = stream.read(length)
    if len(body) != length:
        raise McapError('a record is cut off')
    return body


def _parsed(code: int, body: bytes) -> Any:
    """Return a record, None of a kind that is not read; raises one of `DAMAGE`."""
    stream = ReadDataStream(io.BytesIO(body))
    if code == MESSAGE:
        return Message.read(stream, len(body))
    return KINDS[code].read(stream) if code in KINDS else None
