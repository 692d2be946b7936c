# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Files of rosbag2 and rosbags are read, and those without an end up to there."""

import dataclasses
import itertools
import os
import shutil

from ballscrew_monitor.recordings.bag import Bag
from ballscrew_monitor.recordings.bag_writer import BagWriter, Offer, Topic
from mcap.reader import make_reader
from mcap.writer import Writer as McapWriter
import pytest
from rosbags.rosbag2 import CompressionFormat, CompressionMode, StoragePlugin, Writer
from rosbags.typesys import get_typestore, Stores
import yaml
import zstandard

KINDS = list(itertools.product(StoragePlugin, CompressionMode))
TYPES = {
    '/joint_states': 'sensor_msgs/msg/JointState',
    '/axial_load': 'geometry_msgs/msg/WrenchStamped',
    '/oil_temperature': 'sensor_msgs/msg/Temperature',
}


@pytest.fixture(scope='module')
def messages(short_bag):
    return list(Bag(short_bag).messages())


def content(bag):
    """Return what is to be the same whatever the storage."""
    return [(one.topic, one.log_time, one.data) for one in bag.messages()]


def plain(messages):
    return [(one.topic, one.log_time, one.data) for one in messages]


def write(path, messages, storage, compression=CompressionMode.NONE):
    store = get_typestore(Stores.ROS2_JAZZY)
    writer = Writer(path, version=9, storage_plugin=storage)
    if compression is not CompressionMode.NONE:
        writer.set_compression(compression, CompressionFormat.ZSTD)
    with writer:
        connections = {
            topic: writer.add_connection(topic, kind, typestore=store)
            for topic, kind in TYPES.items()
        }
        for one in messages:
            writer.write(connections[one.topic], one.log_time, one.data)
    return path


@pytest.fixture
def sqlite_file(messages, tmp_path):
    return next(write(tmp_path / 'bag', messages, StoragePlugin.SQLITE3).glob('*.db3'))


def overwrite(file, begin, content):
    with file.open('r+b') as stream:
        stream.seek(begin)
        stream.write(content)


def flip(file, at):
    overwrite(file, at, bytes([file.read_bytes()[at] ^ 0x55]))


@pytest.mark.parametrize(
    ('storage', 'compression'),
    [pair for pair in KINDS if pair != (StoragePlugin.SQLITE3, CompressionMode.STORAGE)],
    ids=lambda word: word.name,
)
def test_every_storage_of_rosbags_is_read(storage, compression, messages, tmp_path):
    bag = Bag(write(tmp_path / 'bag', messages, storage, compression))
    assert content(bag) == plain(messages)
    assert bag.types == TYPES
    assert (bag.start_time, bag.end_time) == (messages[0].log_time, messages[-1].log_time)
    assert len(list(bag.messages(['/axial_load']))) == bag.topics['/axial_load'].count > 100
    assert not list(bag.messages([]))


@pytest.mark.parametrize('storage', list(StoragePlugin), ids=lambda word: word.name)
def test_a_split_bag_is_one(storage, messages, tmp_path, refused):
    half = len(messages) // 2
    parts = [
        write(tmp_path / name, some, storage)
        for name, some in (('one', messages[:half]), ('two', messages[half:]))
    ]
    whole, names = tmp_path / 'whole', []
    whole.mkdir()
    for part in parts:
        file = next(part.glob(f'{part.name}*'))
        names.append(shutil.copy(file, whole / file.name).name)
    information = {'storage_identifier': storage.name.lower(), 'relative_file_paths': names}
    (whole / 'metadata.yaml').write_text(
        yaml.safe_dump({'rosbag2_bagfile_information': information})
    )
    assert content(Bag(whole)) == plain(messages)
    (whole / names[1]).write_bytes(b'')
    refused('truncated_damaged', Bag, whole)
    left = Bag(whole, salvage=True)
    assert content(left) == plain(messages[:half])
    assert names[1] in left.notes[0]
    assert left.notes[0].endswith('it is left out')


def test_the_tenth_part_of_a_bag_comes_after_the_second(messages, tmp_path):
    half, whole = len(messages) // 2, tmp_path / 'whole'
    whole.mkdir()
    for number, some in ((2, messages[:half]), (10, messages[half:])):
        part = tmp_path / f'part_{number}'
        write(part, some, StoragePlugin.MCAP)
        shutil.copy(next(part.glob('*.mcap')), whole / f'whole_{number}.mcap')
    assert [file.name for file in Bag(whole).files] == ['whole_2.mcap', 'whole_10.mcap']
    assert plain(Bag(whole).as_written()) == plain(messages)


def test_a_lone_file_may_be_packed(short_bag, messages, tmp_path, refused):
    packed = tmp_path / 'short.mcap.zstd'
    packed.write_bytes(zstandard.compress((short_bag / 'short.mcap').read_bytes()))
    bag = Bag(packed)
    assert content(bag) == plain(messages)
    folder = bag.files[0].parent
    assert folder.is_dir()
    del bag
    assert not folder.exists()
    packed.write_bytes(packed.read_bytes()[:4] + bytes(20))
    refused('truncated_damaged', Bag, packed)


def test_what_a_bag_says_of_itself_may_be_damaged(messages, tmp_path, refused):
    with BagWriter(tmp_path, 'own') as writer:
        writer.add_metadata({'source': 'mill.csv'})
        for name, kind in TYPES.items():
            writer.add_topic(Topic(name=name, type_name=kind, offer=Offer.SENSOR))
        for one in messages:
            writer.write(one.topic, one.data, log_time=one.log_time, publish_time=one.log_time)
    path = tmp_path / 'own.mcap'
    assert Bag(path).metadata == {'source': 'mill.csv'}
    at = path.read_bytes().index(b'source') - 8  # the length of all texts
    overwrite(path, at, b'\xff' * 4)
    refused('truncated_damaged', Bag, path)
    bag = Bag(path, salvage=True)
    assert bag.metadata == {}
    assert content(bag) == plain(messages)
    assert bag.notes[0].endswith('what it says of itself is left out')


@pytest.mark.parametrize('part', [0.6, 0.8, 0.95])
def test_intact_parts_of_a_truncated_file_are_read(short_bag, messages, tmp_path, part):
    data = (short_bag / 'short.mcap').read_bytes()
    cut = tmp_path / 'cut.mcap.active'
    cut.write_bytes(data[: int(part * len(data))])
    bag = Bag(tmp_path, salvage=True)
    found = content(bag)
    assert 0 < len(found) <= len(messages)
    assert found == plain(messages)[: len(found)]
    assert f'used are the {len(found)} messages of ' in bag.notes[0]
    assert sum(info.count for info in bag.topics.values()) == len(found)


@pytest.mark.parametrize('salvage', [True, False])
def test_a_damaged_chunk_is_named_and_what_copies_the_others(
    salvage, short_bag, tmp_path, refused
):
    path = shutil.copy(short_bag / 'short.mcap', tmp_path / 'bad.mcap')
    flip(path, int(0.2 * path.stat().st_size))
    refused('damaged_chunk', content, Bag(path, salvage=salvage))


def chunks(path, content):
    """Write messages in small chunks; return where these begin [bytes]."""
    with path.open('wb') as stream:
        writer = McapWriter(stream, chunk_size=2000)
        writer.start('ros2', 'test')
        numbers = {}
        for topic, log_time, data in content:
            if topic not in numbers:
                numbers[topic] = writer.register_channel(topic, 'cdr', 0)
            writer.add_message(numbers[topic], log_time, data, log_time)
        writer.finish()
    with path.open('rb') as stream:
        indexes = make_reader(stream).get_summary().chunk_indexes
    return [index.chunk_start_offset for index in indexes]


def test_a_chunk_that_is_none_is_named(messages, tmp_path, refused):
    path = tmp_path / 'bad.mcap'
    begins = chunks(path, plain(messages))
    assert len(begins) > 5
    overwrite(path, begins[2], b'\xff' * 200)
    with refused('no_chunk', at=begins[2]):
        content(Bag(path, salvage=True))


def test_a_file_without_its_end_is_read_up_to_the_damage(messages, tmp_path, says):
    path, written = tmp_path / 'bad.mcap', plain(messages)
    begins = chunks(path, written)
    size = begins[-1] + 10
    os.truncate(path, size)
    flip(path, begins[3] + 100)
    bag = Bag(path, salvage=True)
    found = content(bag)
    assert len(written) * 2 / len(begins) < len(found) < len(written) * 4 / len(begins)
    assert found == written[: len(found)]
    assert (content(bag), plain(bag.as_written())) == (found, found)
    (note,) = bag.notes
    assert says('used', count=len(found)) in note
    assert note.endswith(says('lost', bytes=size - begins[3], at=begins[3]))


def test_a_file_without_chunks_is_refused_where_it_is_damaged(messages, tmp_path, refused):
    path = tmp_path / 'bad.mcap'
    with path.open('wb') as stream:
        writer = McapWriter(stream, use_chunking=False)
        writer.start('ros2', 'test')
        channel = writer.register_channel('/a', 'cdr', 0)
        places = []
        for one in messages:
            places.append(stream.tell())
            writer.add_message(channel, one.log_time, one.data, one.log_time)
        writer.finish()
    assert len(content(Bag(path))) == len(messages)
    overwrite(path, places[1] + 7, b'\xff')
    with refused('no_record', at=places[1]):
        content(Bag(path, salvage=True))


@pytest.mark.parametrize('part', [0.5, 0.8, 0.95, 0.999])
@pytest.mark.parametrize('size', [0, 20_000], ids=['short', 'over several pages'])
def test_a_truncated_sqlite3_file_is_refused(size, part, messages, tmp_path, refused):
    some = [
        dataclasses.replace(one, data=one.data + bytes([number % 256]) * size)
        for number, one in enumerate(messages)
    ][: 150 if size else None]
    path = write(tmp_path / 'bag', some, StoragePlugin.SQLITE3)
    file = next(path.glob('*.db3'))
    os.truncate(file, int(part * file.stat().st_size))
    for salvage in (False, True):
        refused('truncated_damaged_complete', Bag, file, salvage=salvage)


@pytest.mark.parametrize('size', [50, 2000, 4096, 20_000])
def test_a_sqlite3_file_that_ends_before_its_messages_is_one_sentence(size, sqlite_file, refused):
    os.truncate(sqlite_file, size)
    refused('truncated_damaged_complete', Bag, sqlite_file, salvage=True)


@pytest.mark.parametrize('content', [b'\xff', b'\0'], ids=['ones', 'zeros'])
def test_a_sqlite3_file_with_a_damaged_page_is_refused(content, sqlite_file, refused):
    overwrite(sqlite_file, sqlite_file.stat().st_size // 8192 * 4096, content * 4096)
    refused('truncated_damaged_complete', Bag, sqlite_file, salvage=True)


def test_nothing_can_be_had_of_an_empty_file(tmp_path, refused):
    (tmp_path / 'empty.mcap').touch()
    refused('truncated_damaged', Bag, tmp_path / 'empty.mcap', salvage=True)


@pytest.mark.parametrize('name', ['text.mcap', 'text.db3'])
@pytest.mark.parametrize('salvage', [True, False])
def test_a_text_is_no_damaged_bag(name, salvage, tmp_path, refused):
    (tmp_path / name).write_text('rubbish\n')
    refused('neither_mcap_nor', Bag, tmp_path / name, salvage=salvage)
