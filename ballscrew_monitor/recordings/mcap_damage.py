# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The intact part of a damaged MCAP file: records, by the index of its chunks if it has one."""

from collections.abc import Container, Iterable, Iterator
import contextlib
from pathlib import Path
import struct
from typing import Any, BinaryIO

from mcap.data_stream import ReadDataStream
from mcap.exceptions import McapError
from mcap.reader import make_reader
from mcap.records import Chunk
from mcap.records import Message as McapMessage
from mcap.stream_reader import breakup_chunk, StreamReader
from mcap.summary import Summary
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
CHUNK_BODY = 9  # [bytes] of a record before its content


def whole_records(file: Path) -> Iterator[Any]:
    """
    Yield the records of an MCAP file that are whole, those of a chunk in its place.

    A summary tells where chunks are, and what it holds comes first; else nothing follows damage.

    """
    with file.open('rb') as stream, contextlib.suppress(*DAMAGE):
        summary = _summary(stream)
        if summary is not None and summary.chunk_indexes:
            yield from [*summary.schemas.values(), *summary.channels.values()]
            with contextlib.suppress(*DAMAGE):
                yield from make_reader(stream).iter_metadata()
            for begin in sorted(one.chunk_start_offset for one in summary.chunk_indexes):
                yield from _chunk_at(stream, begin) or ()
            return
        stream.seek(0)
        for record in StreamReader(stream, emit_chunks=True).records:
            if not isinstance(record, Chunk):
                yield record
                continue
            with contextlib.suppress(*DAMAGE):
                yield from breakup_chunk(record, validate_crc=True)


def _summary(stream: BinaryIO) -> Summary | None:
    try:
        return make_reader(stream, validate_crcs=True).get_summary()
    except (*DAMAGE, OSError):  # a file may be shorter than what is to be at its end
        return None


def damaged_chunks(file: Path) -> frozenset[int]:
    """Return where the chunks begin [bytes] that the summary of a file names and that are lost."""
    with file.open('rb') as stream:
        if (summary := _summary(stream)) is None:
            return frozenset()
        begins = [index.chunk_start_offset for index in summary.chunk_indexes]
        return frozenset(at for at in begins if not _is_whole(stream, at, summary.channels))


def _is_whole(stream: BinaryIO, offset: int, channels: Container[int]) -> bool:
    """Tell whether a chunk can be read, and its messages are of known channels."""
    records = _chunk_at(stream, offset)
    return records is not None and all(
        one.channel_id in channels for one in records if isinstance(one, McapMessage)
    )


def _chunk_at(stream: BinaryIO, offset: int) -> Iterable[Any] | None:
    """Return the records of a chunk, None of a damaged one."""
    try:
        stream.seek(offset + CHUNK_BODY)
        return breakup_chunk(Chunk.read(ReadDataStream(stream)), validate_crc=True)
    except DAMAGE:
        return None
