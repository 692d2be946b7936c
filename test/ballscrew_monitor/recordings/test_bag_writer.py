# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The bag that is written: layout of rosbag2, growth, and what a crash leaves."""

import contextlib
import shutil
import struct

from ballscrew_monitor.recordings.bag import Bag
from ballscrew_monitor.recordings.bag_writer import BagWriter, CHUNK_SIZE, Offer, Topic, whole_bag
from mcap.exceptions import EndOfFile
from mcap.reader import make_reader
from mcap.records import Message
from mcap.stream_reader import StreamReader
import numpy as np
import pytest
from surrogate.files import InputError
import yaml

HEADERS = Topic(name='/a', type_name='std_msgs/msg/Header', offer=Offer.SENSOR)
LATCHED = Topic(name='/b', type_name='std_msgs/msg/Header', offer=Offer.LATCHED)
DATA = bytes(100)


def write(writer, count, *, topic=HEADERS, begin=1000):
    writer.add_topic(topic)
    for number in range(count):
        writer.write(topic.name, DATA, log_time=begin + number, publish_time=begin + number - 1)


def information(folder):
    content = yaml.safe_load((folder / 'metadata.yaml').read_text())
    return content['rosbag2_bagfile_information']


def test_it_has_the_layout_of_rosbag2(tmp_path):
    with BagWriter(tmp_path, 'bag') as writer:
        write(writer, 3)
    with (tmp_path / 'bag.mcap').open('rb') as stream:
        reader = make_reader(stream, validate_crcs=True)
        assert reader.get_header().profile == 'ros2'
        [(schema, channel, message), *_] = reader.iter_messages()
    assert (schema.name, schema.encoding) == ('std_msgs/msg/Header', 'ros2msg')
    assert b'MSG: builtin_interfaces/Time' in schema.data
    assert (channel.topic, channel.message_encoding) == ('/a', 'cdr')
    assert channel.metadata['topic_type_hash'].startswith('RIHS01_f49f')
    [profile] = yaml.safe_load(channel.metadata['offered_qos_profiles'])
    assert (profile['reliability'], profile['depth']) == ('best_effort', 10)
    assert (message.log_time, message.publish_time, message.data) == (1000, 999, DATA)


def test_the_metadata_says_what_is_inside(tmp_path):
    with BagWriter(tmp_path, 'bag') as writer:
        write(writer, 3)
        write(writer, 1, topic=LATCHED, begin=500)
    info = information(tmp_path)
    assert (info['version'], info['storage_identifier']) == (9, 'mcap')
    assert info['relative_file_paths'] == ['bag.mcap']
    assert info['message_count'] == 4
    assert info['starting_time'] == {'nanoseconds_since_epoch': 500}
    assert info['duration'] == {'nanoseconds': 502}
    topics = {
        entry['topic_metadata']['name']: (
            entry['message_count'],
            entry['topic_metadata']['offered_qos_profiles'][0]['durability'],
        )
        for entry in info['topics_with_message_count']
    }
    assert topics == {'/a': (3, 'volatile'), '/b': (1, 'transient_local')}


def test_many_messages_count_as_each_does(tmp_path):
    times = np.array([700, 500, 900, 600])
    with BagWriter(tmp_path, 'bag') as writer:
        writer.add_topic(LATCHED)
        write(writer, 1)
        begins, sizes = np.array([4, 0, 7, 12]), np.array([3, 3, 5, 4])
        data = b'two-onethreefour'
        writer.write_many(['/b', '/a'], np.array([1, 1, 0, 1]), times, data, begins, sizes)
        assert writer.total == 5
    bag = Bag(tmp_path)
    assert (bag.topics['/a'].count, bag.topics['/b'].count) == (4, 1)
    found = [(one.topic, one.log_time, one.sequence, one.data) for one in bag.messages()]
    assert found == [
        ('/a', 500, 2, b'two'),
        ('/a', 600, 3, b'four'),
        ('/a', 700, 1, b'one'),
        ('/b', 900, 0, b'three'),
        ('/a', 1000, 0, DATA),
    ]
    info = information(tmp_path)
    assert info['message_count'] == 5
    assert info['starting_time'] == {'nanoseconds_since_epoch': 500}
    assert info['duration'] == {'nanoseconds': 500}


def test_it_gets_its_name_when_it_is_closed(tmp_path):
    writer = BagWriter(tmp_path / 'new' / 'out', 'bag')
    folder = tmp_path / 'new' / 'out'
    write(writer, 1)
    assert [path.name for path in folder.iterdir()] == ['bag.mcap.active']
    writer.close()
    writer.close()
    assert sorted(path.name for path in folder.iterdir()) == ['bag.mcap', 'metadata.yaml']
    assert Bag(folder).topics['/a'].count == 1


def test_an_older_bag_of_the_name_is_gone_from_the_start(tmp_path):
    BagWriter(tmp_path, 'bag').close()
    writer = BagWriter(tmp_path, 'bag')
    assert [path.name for path in tmp_path.iterdir()] == ['bag.mcap.active']
    writer.close()


def test_a_crash_costs_no_more_than_the_last_chunks(tmp_path, refused):
    writer = BagWriter(tmp_path, 'bag', compress=False)
    writer.add_topic(HEADERS)
    count = 10 * CHUNK_SIZE // len(DATA)
    write(writer, count)
    shutil.copy(tmp_path / 'bag.mcap.active', tmp_path / 'left.mcap')
    writer.close()
    with (tmp_path / 'left.mcap').open('rb') as stream:
        kept = read_unfinished(stream)
    assert kept >= 0.7 * count
    refused('left_mcap_truncated', Bag, tmp_path / 'left.mcap')


def read_unfinished(stream):
    """Return the number of messages in a file without an end."""
    kept = 0
    with contextlib.suppress(EndOfFile, struct.error):
        for record in StreamReader(stream).records:
            kept += isinstance(record, Message)
    return kept


def test_an_unknown_type_and_a_bad_directory_are_one_sentence(tmp_path, refused):
    with BagWriter(tmp_path, 'bag') as writer, pytest.raises(InputError, match='not installed'):
        writer.add_topic(Topic(name='/c', type_name='std_msgs/msg/No', offer=Offer.SENSOR))
    (tmp_path / 'file').write_text('')
    refused('cannot_written', BagWriter, tmp_path / 'file', 'bag')


def break_off(folder, error):
    with whole_bag(folder, 'bag') as writer:
        write(writer, 1)
        raise error


def test_a_whole_bag_is_there_when_it_is_complete_or_not_at_all(tmp_path, refused):
    folder = tmp_path / 'new' / 'bag'
    with pytest.raises(KeyboardInterrupt):
        break_off(folder, KeyboardInterrupt)
    assert not folder.parent.exists()
    with whole_bag(folder, 'bag') as writer:
        write(writer, 2)
        assert not folder.exists()
    assert [*folder.parent.iterdir()] == [folder]
    assert sorted(path.name for path in folder.iterdir()) == ['bag.mcap', 'metadata.yaml']
    assert Bag(folder).topics['/a'].count == 2
    (tmp_path / 'file').write_text('')
    for place in (tmp_path / 'file', tmp_path / 'file' / 'bag'):
        with refused('cannot_written'), whole_bag(place, 'bag'):
            raise AssertionError


def test_an_older_bag_and_what_is_beside_it_stay_until_the_next_is_whole(tmp_path, refused):
    (tmp_path / 'notes.txt').write_text('of the mill')
    for count in (2, 3):
        with whole_bag(tmp_path, 'bag') as writer:
            write(writer, count)
    refused('middle', break_off, tmp_path, ValueError('in the middle'))
    names = sorted(path.name for path in tmp_path.iterdir())
    assert names == ['bag.mcap', 'metadata.yaml', 'notes.txt']
    assert Bag(tmp_path).topics['/a'].count == 3
