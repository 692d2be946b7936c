# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Records are found whatever an index says, and what contradicts itself is no summary."""

import struct

from ballscrew_monitor.recordings.mcap_records import (
    DAMAGE,
    read_metadata,
    read_summary,
    RecordDamage,
    walked,
    whole_records,
)
from mcap.records import Message
from mcap.writer import CompressionType, IndexType, Writer
import pytest
from surrogate.files import limits

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


def numbers(path):
    return [one.log_time for one in whole_records(path) if isinstance(one, Message)]


def summary_of(path):
    with path.open('rb') as stream:
        return read_summary(stream)


def test_all_records_are_read_past_attachments(file):
    assert numbers(file) == list(range(COUNT))
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


def up_to_damage(file):
    """Return the numbers of the messages before the damage, and that."""
    numbers = []
    try:
        for record in whole_records(file):
            if isinstance(record, Message):
                numbers.append(record.log_time)
    except RecordDamage as damage:
        return numbers, damage
    pytest.fail('no damage was found')


def test_records_are_read_up_to_the_damage(file, says):
    data = file.read_bytes()
    chunks = [one.chunk_start_offset for one in summary_of(file).chunk_indexes]
    # Of the chunk that begins there: its length, the length of its data, and a byte of them.
    for at in (chunks[2] + 6, chunks[2] + 40, chunks[2] + 500):
        changed = bytearray(data)
        changed[at] ^= 0x41
        file.write_bytes(changed)
        found, damage = up_to_damage(file)
        assert COUNT / len(chunks) < len(found) < 3 * COUNT / len(chunks)
        assert found == [*range(len(found))]
        assert damage.place == chunks[2]
        assert damage.lost == says('lost', at=chunks[2], bytes=len(data) - chunks[2])
        assert str(damage).startswith(says('damaged', at=chunks[2]))


@pytest.mark.parametrize('share', [0.3, 0.5, 0.7])
def test_a_file_may_end_within_a_record(share, file):
    data = file.read_bytes()
    file.write_bytes(data[: int(share * len(data))])
    found, damage = up_to_damage(file)
    assert found == [*range(len(found))]
    assert damage.place <= int(share * len(data))


def test_pictures_of_one_grey_pass_and_records_that_pack_as_well_do_not(tmp_path, refused):
    """Both come to over a thousand times their file; equal messages tell no times of their own."""
    pictures, bomb = tmp_path / 'pictures.mcap', tmp_path / 'bomb.mcap'
    for file, kept, size, count in ((pictures, True, 1280 * 1024, 50), (bomb, False, 0, 40_000)):
        with file.open('wb') as stream:
            writer = Writer(stream, index_types=IndexType.ALL if kept else IndexType.NONE)
            writer.start('ros2', 'test')
            schema = writer.register_schema('T', 'ros2msg', b'')
            channel = writer.register_channel('/a', 'cdr', schema)
            for number in range(count):
                writer.add_message(channel, number * kept, bytes(size), 0)
            writer.finish()
    assert 1000 * pictures.stat().st_size < 50 * 1280 * 1024
    assert numbers(pictures) == [*range(50)]
    with refused('bomb'):
        numbers(bomb)


def test_a_chunk_of_too_many_records_is_not_taken_apart(refused, monkeypatch):
    """As many as are allowed at all, and as the chunk has bytes in its file."""
    record = struct.pack('<BQ', 0x80, 0)
    for limit, stored in ((3, 100), (4, 3)):
        monkeypatch.setattr(limits, 'RECORDS', limit)
        assert walked(3 * record, stored) == [(0x80, 0), (0x80, 9), (0x80, 18)]
        refused('many', walked, 4 * record, stored)
        refused('cut', walked, 3 * record + b'\x80', stored)
