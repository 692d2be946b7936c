# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Writes an MCAP file in chunks, one message or many at once; and text and hash of its types.

All ways give the bytes that the writer of the package `mcap` gives, which knows only the first.
The records are those of that package, but for messages and their indexes, of which there are many.

"""

from collections import Counter
from collections.abc import Mapping, Sequence
import functools
import json
import os
from pathlib import Path
import struct
import sys
from typing import Any, BinaryIO
import zlib

from mcap import records
from mcap.data_stream import RecordBuilder
from mcap.opcode import Opcode
from mcap.writer import MCAP0_MAGIC
import numpy as np
from numpy.typing import NDArray
from surrogate.files import InputError
from surrogate.surface.compiled import compiled
import zstandard

SEPARATOR = '=' * 80


def message_definition(type_name: str) -> str:
    """
    Return the `ros2msg` text of a type such as `sensor_msgs/msg/JointState`.

    The definition of each type inside follows after a line of 80 `=` and its name. Raises
    InputError when the type is not installed.

    """
    names = [entry['type_name'] for entry in _described(type_name)]
    texts = [_share_file(type_name, 'msg').read_text()]
    for name in sorted(set(names) - {type_name}):
        package, _, leaf = name.split('/')
        texts.append(f'{SEPARATOR}\nMSG: {package}/{leaf}\n{_share_file(name, "msg").read_text()}')
    return ''.join(text if text.endswith('\n') else f'{text}\n' for text in texts)


def type_hash(type_name: str) -> str:
    """Return the RIHS01 hash of a message type; raises InputError when it is not installed."""
    for entry in _described(type_name):
        if entry['type_name'] == type_name:
            return str(entry['hash_string'])
    raise InputError(f'message type {type_name}: its description holds no hash')


@functools.lru_cache
def _described(type_name: str) -> tuple[dict[str, str], ...]:
    return tuple(json.loads(_share_file(type_name, 'json').read_text())['type_hashes'])


def _share_file(type_name: str, suffix: str) -> Path:
    parts = type_name.split('/')
    if len(parts) != 3:
        raise InputError(f'message type {type_name!r} is not of the form package/msg/Name')
    paths = os.environ.get('AMENT_PREFIX_PATH', '').split(os.pathsep)
    prefixes = [*filter(None, paths), sys.prefix]
    for prefix in prefixes:
        path = Path(prefix) / 'share' / parts[0] / parts[1] / f'{parts[2]}.{suffix}'
        if path.is_file():
            return path
    raise InputError(f'message type {type_name} is not installed below {" or ".join(prefixes)}')


MESSAGE = struct.Struct('<BQHIQQ')  # code, length, channel, number, log time, publish time
MESSAGE_FIELDS = np.dtype(
    [
        ('code', '<u1'),
        ('length', '<u8'),
        ('channel', '<u2'),
        ('sequence', '<u4'),
        ('log_time', '<u8'),
        ('publish_time', '<u8'),
    ]
)
"""The same as `MESSAGE`, for arrays."""
HEAD = MESSAGE.size
BEFORE_LENGTH = 9  # [bytes] of a record that its length does not count
INDEX = struct.Struct('<BQHI')  # code, length, channel, length of the pairs
PAIR = struct.Struct('<QQ')  # log time, offset in the chunk
Integers = NDArray[np.int64]


class McapFile:
    """One growing MCAP file; times [ns]."""

    def __init__(self, stream: BinaryIO, *, chunk_size: int, compress: bool) -> None:
        """Begin a file in `stream`, with chunks that end once they exceed a size [bytes]."""
        self._stream, self._chunk_size, self._compress = stream, chunk_size, compress
        self._schemas: list[records.Schema] = []
        self._channels: list[records.Channel] = []
        self._chunks: list[records.ChunkIndex] = []
        self._metadata: list[records.MetadataIndex] = []
        self._counts: Counter[int] = Counter()
        self._begin = self._end = 0  # log times of the messages in the chunk
        self._clear()
        stream.write(MCAP0_MAGIC + _bytes(records.Header('ros2', 'ballscrew_monitor')))

    def add_channel(
        self, *, topic: str, kind: str, definition: bytes, metadata: dict[str, str]
    ) -> int:
        """Add a channel of messages in CDR, of a kind that is defined here; return its number."""
        number = len(self._channels) + 1
        schema = records.Schema(id=number, data=definition, encoding='ros2msg', name=kind)
        channel = records.Channel(
            id=number, topic=topic, message_encoding='cdr', schema_id=number, metadata=metadata
        )
        self._schemas.append(schema)
        self._grow(_bytes(schema))
        self._channels.append(channel)
        self._grow(_bytes(channel))
        return number

    def add_metadata(self, name: str, texts: Mapping[str, str]) -> None:
        """Add metadata, which stand before the chunk that still grows."""
        raw = _bytes(records.Metadata(name=name, metadata=dict(texts)))
        place = records.MetadataIndex(offset=self._stream.tell(), length=len(raw), name=name)
        self._metadata.append(place)
        self._stream.write(raw)

    def add_message(
        self, channel: int, data: bytes, *, log_time: int, publish_time: int, sequence: int
    ) -> None:
        """Append a message."""
        length = len(data) + MESSAGE.size - BEFORE_LENGTH
        head = MESSAGE.pack(Opcode.MESSAGE, length, channel, sequence, log_time, publish_time)
        self._count(channel, 1, PAIR.pack(log_time, len(self._data)), log_time, log_time)
        self._grow(head + data)

    def add_messages(
        self,
        channel: Integers,
        data: bytes,
        begin: Integers,
        size: Integers,
        *,
        log_time: Integers,
        sequence: Integers,
    ) -> None:
        """Append messages, which lie in `data` [bytes] and are published when they are logged."""
        heads = np.empty(len(sequence), MESSAGE_FIELDS)
        heads['code'], heads['length'] = Opcode.MESSAGE, size + MESSAGE.size - BEFORE_LENGTH
        heads['channel'], heads['sequence'] = channel, sequence
        heads['log_time'] = heads['publish_time'] = log_time
        raw = np.empty(heads.nbytes + int(size.sum()), np.uint8)
        compiled_join()(heads.view(np.uint8), np.frombuffer(data, np.uint8), begin, size, raw)
        ends = np.cumsum(heads['length'].astype(np.int64) + BEFORE_LENGTH)
        first, done = 0, 0
        while first < len(heads):
            room = done + self._chunk_size - len(self._data)
            exceeding = int(np.searchsorted(ends, room, side='right'))
            last = min(exceeding + 1, len(heads))
            begins = np.concatenate(([done], ends[first:last]))
            end = int(begins[-1])
            self._index(heads[first:last], begins[:-1] - done + len(self._data))
            self._grow(raw.data[done:end])
            first, done = last, end

    def flush(self) -> None:
        """End the chunk, and let the system have all that was written."""
        self._end_chunk()
        self._stream.flush()

    def finish(self) -> None:
        """End the file; what it is made of stands once more behind the data."""
        self._end_chunk()
        self._stream.write(_bytes(records.DataEnd(0)))
        begin = self._stream.tell()
        raw, offsets = b'', []
        for code, members in self._summary():
            group = b''.join(map(_bytes, members))
            offsets.append(records.SummaryOffset(code, begin + len(raw), len(group)))
            raw += group
        at = begin + len(raw)
        raw += b''.join(map(_bytes, offsets))
        crc = zlib.crc32(struct.pack('<BQQQ', Opcode.FOOTER, 20, begin, at), zlib.crc32(raw))
        self._stream.write(raw + _bytes(records.Footer(begin, at, crc)) + MCAP0_MAGIC)

    def _index(self, heads: NDArray[np.void], places: Integers) -> None:
        """Note messages that go into the chunk at some places [bytes]."""
        pairs = np.column_stack((heads['log_time'], places.astype('<u8')))
        numbers, firsts = np.unique(heads['channel'], return_index=True)
        for number in numbers[np.argsort(firsts)]:
            own = pairs[heads['channel'] == number]
            times = own[:, 0]
            self._count(int(number), len(own), own.tobytes(), int(times.min()), int(times.max()))

    def _count(self, channel: int, count: int, pairs: bytes, first: int, last: int) -> None:
        """Note messages, at the places `pairs`, that go into the chunk."""
        self._begin = min(self._begin, first) if self._pairs else first
        self._end = max(self._end, last)
        self._pairs.setdefault(channel, bytearray()).extend(pairs)
        self._counts[channel] += count

    def _grow(self, raw: bytes | memoryview) -> None:
        self._data += raw
        if len(self._data) > self._chunk_size:
            self._end_chunk()

    def _clear(self) -> None:
        self._data = bytearray()
        self._pairs: dict[int, bytearray] = {}
        self._begin = self._end = 0

    def _end_chunk(self) -> None:
        """Write the chunk and its indexes; one that holds no message waits for the first."""
        if not self._pairs:
            return
        packed = zstandard.compress(self._data) if self._compress else bytes(self._data)
        chunk = records.Chunk(
            compression='zstd' if self._compress else '',
            data=packed,
            message_start_time=self._begin,
            message_end_time=self._end,
            uncompressed_crc=zlib.crc32(self._data),
            uncompressed_size=len(self._data),
        )
        raw, begin = _bytes(chunk), self._stream.tell()
        indexes, places = b'', {}
        for number, pairs in self._pairs.items():
            places[number] = begin + len(raw) + len(indexes)
            length = INDEX.size - BEFORE_LENGTH + len(pairs)
            indexes += INDEX.pack(Opcode.MESSAGE_INDEX, length, number, len(pairs)) + pairs
        self._stream.write(raw + indexes)
        self._chunks.append(
            records.ChunkIndex(
                message_start_time=self._begin,
                message_end_time=self._end,
                chunk_start_offset=begin,
                chunk_length=len(raw),
                message_index_offsets=places,
                message_index_length=len(indexes),
                compression=chunk.compression,
                compressed_size=len(packed),
                uncompressed_size=chunk.uncompressed_size,
            )
        )
        self._clear()

    def _summary(self) -> Sequence[tuple[Opcode, Sequence[records.McapRecord]]]:
        statistics = records.Statistics(
            attachment_count=0,
            channel_count=len(self._channels),
            channel_message_counts=dict(self._counts),
            chunk_count=len(self._chunks),
            message_count=self._counts.total(),
            message_end_time=max((chunk.message_end_time for chunk in self._chunks), default=0),
            message_start_time=min(
                (chunk.message_start_time for chunk in self._chunks), default=0
            ),
            metadata_count=len(self._metadata),
            schema_count=len(self._schemas),
        )
        return (
            (Opcode.SCHEMA, self._schemas),
            (Opcode.CHANNEL, self._channels),
            (Opcode.STATISTICS, [statistics]),
            (Opcode.CHUNK_INDEX, self._chunks),
            (Opcode.ATTACHMENT_INDEX, []),
            (Opcode.METADATA_INDEX, self._metadata),
        )


def join_messages(heads: Any, data: Any, begin: Any, size: Any, raw: Any) -> None:
    """Write into `raw` messages that lie in `data`, each behind its head; arrays of bytes."""
    at = 0
    for message in range(len(size)):
        for place in range(HEAD):
            raw[at + place] = heads[message * HEAD + place]
        at += HEAD
        for place in range(size[message]):
            raw[at + place] = data[begin[message] + place]
        at += size[message]


@functools.cache
def compiled_join() -> Any:
    """Return `join_messages` compiled; raises ImportError without numba."""
    return compiled(join_messages)


def _bytes(record: records.McapRecord) -> bytes:
    builder = RecordBuilder()
    record.write(builder)
    raw: bytes = builder.end()
    return raw
