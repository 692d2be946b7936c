# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
The intact part of a damaged MCAP file: its records, and a complete bag of them.

A recording whose writer was killed is so mended; the file itself is left as it is. Nothing is
decoded, so the types need not be installed.

"""

from collections.abc import Container, Iterable, Iterator
import contextlib
from pathlib import Path
import struct
from typing import Any, BinaryIO

from ballscrew_monitor.recordings.bag_writer import ACTIVE, BagWriter, whole_bag
from mcap.data_stream import ReadDataStream
from mcap.exceptions import McapError
from mcap.reader import make_reader
from mcap.records import Channel, Chunk, Metadata, Schema
from mcap.records import Message as McapMessage
from mcap.stream_reader import breakup_chunk, StreamReader
from mcap.summary import Summary
from surrogate.files import InputError
import yaml
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


SUFFIX = '.mcap'


def recover(path: Path) -> tuple[Path, int, float]:
    """
    Write the intact part of a recording; return the new file, its messages and its seconds.

    `path` is an MCAP file, unfinished or damaged, or the folder of an unfinished one. A finished
    name is taken away from an unfinished file, any other gets `_recovered` behind its name. Raises
    InputError when there is nothing to be had.

    """
    file = _unfinished(path) if path.is_dir() else path
    if not file.is_file():
        raise InputError(f'{file} does not exist, it must be an MCAP file or the folder of one')
    target = _target(file)
    if target.exists():
        raise InputError(f'{target} is there already, it would be written over: move it away')
    topics = _topics(file)
    if not topics:
        raise InputError(f'{file} holds no message that is whole, nothing can be recovered')
    with whole_bag(target.parent, target.name.removesuffix(SUFFIX)) as writer:
        _copy(file, topics, writer)
    return target, writer.total, (writer.last - writer.first) * 1e-9


def _unfinished(folder: Path) -> Path:
    found = sorted(folder.glob(f'*{SUFFIX}{ACTIVE}'))
    if len(found) != 1:
        raise InputError(f'{folder} holds {len(found)} unfinished recordings, it must be one')
    return found[0]


def _target(file: Path) -> Path:
    if file.name.endswith(ACTIVE):
        return file.with_name(file.name.removesuffix(ACTIVE))
    name = f'{file.name.removesuffix(SUFFIX)}_recovered'
    return file.with_name(name) / f'{name}{SUFFIX}'


def _topics(file: Path) -> dict[int, tuple[Channel, Schema]]:
    """Return the channels that hold a message, by their numbers, each with its schema."""
    schemas: dict[int, Schema] = {}
    channels: dict[int, Channel] = {}
    used: set[int] = set()
    for record in whole_records(file):
        if isinstance(record, Schema):
            schemas[record.id] = record
        elif isinstance(record, Channel):
            channels[record.id] = record
        elif isinstance(record, McapMessage):
            used.add(record.channel_id)
    return {
        number: (channels[number], schemas[channels[number].schema_id])
        for number in sorted(used & channels.keys())
        if channels[number].schema_id in schemas
    }


def _copy(file: Path, topics: dict[int, tuple[Channel, Schema]], writer: BagWriter) -> None:
    """Copy messages and what the file says of itself."""
    for channel, schema in topics.values():
        said = channel.metadata
        profiles = yaml.safe_load(said.get('offered_qos_profiles', '')) or []
        kind = said.get('topic_type_hash', '')
        names = channel.topic, schema.name
        writer.announce(*names, schema.data, type_hash=kind, profiles=profiles)
    for message in whole_records(file):
        if isinstance(message, Metadata):
            writer.add_metadata(message.metadata, name=message.name)
        if not isinstance(message, McapMessage) or message.channel_id not in topics:
            continue
        writer.write(
            topics[message.channel_id][0].topic,
            message.data,
            log_time=message.log_time,
            publish_time=message.publish_time,
            sequence=message.sequence,
        )
