# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Messages are found in the chunks of a file, and an index that lies is not believed."""

import io
import struct

from ballscrew_monitor.recordings.bulk.chunks import chunk_indexes, read_chunk
from mcap.writer import CompressionType, Writer
import numpy as np
import pytest

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
