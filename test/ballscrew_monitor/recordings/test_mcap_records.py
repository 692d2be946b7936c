# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Records are found whatever an index says, and what contradicts itself is no summary."""

import struct

from ballscrew_monitor.recordings.mcap_records import (
    DAMAGE,
    read_metadata,
    read_summary,
    walked,
    whole_records,
)
from mcap.records import Message
from mcap.writer import CompressionType, Writer
import pytest
from surrogate import limits

COUNT = 200


@pytest.fixture
def file(tmp_path):
    """Return a file of several chunks, with what it says of itself."""
    path = tmp_path / 'a.mcap'
    with path.open('wb') as stream:
        writer = Writer(stream, chunk_size=1000, compression=CompressionType.NONE)
        writer.start('ros2', 'test')
        channel = writer.register_channel('/a', 'cdr', writer.register_schema('T', 'ros2msg', b''))
        writer.add_metadata('own', {'key': 'value'})
        writer.add_attachment(0, 0, 'a picture', 'image/png', bytes(5000))
        for number in range(COUNT):
            writer.add_message(channel, number, number.to_bytes(8, 'little'), number)
        writer.finish()
    return path


def numbers(path, **more):
    return [one.log_time for one in whole_records(path, **more) if isinstance(one, Message)]


def summary_of(path):
    with path.open('rb') as stream:
        return read_summary(stream)


def test_all_records_are_read_past_attachments(file):
    assert numbers(file, strict=True) == list(range(COUNT))
    with file.open('rb') as stream:
        assert [one.metadata for one in read_metadata(stream)] == [{'key': 'value'}]


def test_any_flipped_byte_of_a_summary_loses_no_message(file):
    data = file.read_bytes()
    begin, _ = struct.unpack_from('<QQ', data, len(data) - 28)
    for at in range(begin, len(data) - 8, 3):
        changed = bytearray(data)
        changed[at] ^= 0x41
        file.write_bytes(changed)
        with pytest.raises(DAMAGE):
            summary_of(file)
        assert numbers(file) == list(range(COUNT))


def test_a_flipped_byte_of_the_data_loses_one_chunk_at_most(file):
    data, begins = (
        file.read_bytes(),
        [one.chunk_start_offset for one in summary_of(file).chunk_indexes],
    )
    most = 1 + COUNT // (len(begins) - 1)
    for at in range(8, begins[3], 7):
        changed = bytearray(data)
        changed[at] ^= 0x41
        file.write_bytes(changed)
        found = numbers(file)
        assert len(found) >= COUNT - most
        assert set(found) <= set(range(COUNT))


def test_a_strict_reader_says_where_a_record_is_damaged(file, refused):
    data = bytearray(file.read_bytes())
    begin = summary_of(file).chunk_indexes[2].chunk_start_offset
    data[begin + 6] = 0xFF
    file.write_bytes(data)
    assert len(numbers(file)) < COUNT
    with refused('damaged', at=begin):
        numbers(file, strict=True)


def test_chunks_that_come_to_too_much_together_are_refused(file, refused, monkeypatch):
    """Each is within its own limit; neither the index nor the file without one gets past it."""
    sizes = [one.uncompressed_size for one in summary_of(file).chunk_indexes]
    monkeypatch.setattr(limits, 'PACKING', 0)
    monkeypatch.setattr(limits, 'CHUNK', sum(sizes))
    assert numbers(file, strict=True) == list(range(COUNT))
    monkeypatch.setattr(limits, 'CHUNK', sum(sizes) - 1)
    with refused('summary_too_much'):
        summary_of(file)
    for strict in (False, True):
        with refused('too_much', file=file):
            numbers(file, strict=strict)
    monkeypatch.setattr(limits, 'PACKING', 1)  # the size of the file counts
    assert numbers(file) == list(range(COUNT))


def test_a_chunk_of_too_many_records_is_not_taken_apart(refused, monkeypatch):
    monkeypatch.setattr(limits, 'RECORDS', 3)
    record = struct.pack('<BQ', 0x80, 0)
    assert walked(3 * record) == [(0x80, 0), (0x80, 9), (0x80, 18)]
    refused('many', walked, 4 * record)
    refused('cut', walked, 3 * record + b'\x80')
