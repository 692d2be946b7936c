# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Messages are found in the chunks of a file, and an index that lies is not believed."""

import io
import struct

from ballscrew_monitor.recordings.bulk.chunks import chunk_indexes, read_chunk
from mcap.data_stream import RecordBuilder
from mcap.records import Chunk, ChunkIndex, MessageIndex
from mcap.writer import CompressionType, Writer
import numpy as np
import pytest
import zstandard

COUNT = 20


@pytest.fixture
def written():
    """Return a file of one chunk with two topics, and where the chunk stands."""
    stream = io.BytesIO()
    writer = Writer(stream, compression=CompressionType.NONE)
    writer.start(profile='', library='')
    channels = [
        writer.register_channel(topic, 'cdr', writer.register_schema('T', 'ros2msg', b''))
        for topic in ('/a', '/b')
    ]
    for number in range(COUNT):
        data = bytes([number]) * (number + 1)
        writer.add_message(channels[number % 2], log_time=number, data=data, publish_time=0)
    writer.finish()
    (place,), _ = chunk_indexes(stream, ['/a'])
    return stream, place


def contents(found):
    ends = found.begin + found.size
    return [found.data[begin:end] for begin, end in zip(found.begin, ends)]


def change(stream, at, data):
    stream.seek(at)
    stream.write(data)


EXPECTED = [bytes([number]) * (number + 1) for number in range(COUNT)]


def test_a_chunk_is_read_and_an_index_of_a_part_or_damage_is_not_believed(written, refused):
    found = read_chunk(*written)
    assert contents(found) == EXPECTED
    assert found.log_time.tolist() == list(range(COUNT))
    assert len(np.unique(found.channel)) == 2
    assert list(chunk_indexes(written[0], ['/b'])[1].values()) == ['/b']
    assert chunk_indexes(written[0], ['/c']) == ([], {})
    stream, place = written
    change(stream, place.chunk_start_offset + place.chunk_length, b'\x0f')
    assert contents(read_chunk(stream, place)) == EXPECTED
    change(stream, place.chunk_start_offset + place.chunk_length - 3, b'\xff')
    refused('checksum_wrong', read_chunk, stream, place)
    change(stream, place.chunk_start_offset, b'\x01')
    refused('chunk_stands', read_chunk, stream, place)


@pytest.mark.parametrize('offset', [0, 5, 10**6, 2**63])
def test_an_index_that_lies_is_not_believed(written, offset):
    stream, place = written
    # Behind the heads of the record and of its list, and the log time of the first message.
    change(
        stream,
        place.chunk_start_offset + place.chunk_length + 9 + 6 + 8,
        struct.pack('<Q', offset),
    )
    assert contents(read_chunk(stream, place)) == EXPECTED


def test_an_index_does_not_hide_how_many_records_a_chunk_holds(refused):
    """One message is named; behind it stand records without content, which pack to nothing."""
    data = struct.pack('<BQHIQQ', 5, 22, 1, 0, 0, 0) + bytes(9 * 40_000)
    packed, size = zstandard.compress(data), len(data)
    times = {'message_start_time': 0, 'message_end_time': 0, 'compression': 'zstd'}
    builder = RecordBuilder()
    Chunk(data=packed, uncompressed_crc=0, uncompressed_size=size, **times).write(builder)
    length = builder.count
    MessageIndex(channel_id=1, records=[(0, 0)]).write(builder)
    place = ChunkIndex(
        chunk_start_offset=0,
        chunk_length=length,
        message_index_offsets={1: length},
        message_index_length=builder.count - length,
        compressed_size=len(packed),
        uncompressed_size=size,
        **times,
    )
    refused('many', read_chunk, io.BytesIO(builder.end()), place)


def test_chunks_within_each_other_are_refused(written, refused):
    """Else a chunk would be unpacked once for each that holds it."""
    stream, place = written
    span = struct.pack('<QQ', place.chunk_start_offset, place.chunk_length)
    at = stream.getvalue().index(span)
    change(stream, at + 8, struct.pack('<Q', 2 * len(stream.getvalue())))
    change(stream, len(stream.getvalue()) - 12, bytes(4))  # no checksum of the summary
    refused('overlap', chunk_indexes, stream, ['/a'])
