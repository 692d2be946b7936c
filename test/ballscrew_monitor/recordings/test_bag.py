# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Reading bags, above all those that are not as they should be."""

import json
from pathlib import Path
import shlex
import shutil
import subprocess
import sys

from ballscrew_monitor.recordings.bag import Bag
from ballscrew_monitor.recordings.bag_writer import BagWriter, Offer, Topic
from ballscrew_monitor.recordings.mcap_file import message_definition
from ballscrew_monitor.recordings.opener import opened_log
from ballscrew_monitor.recordings.recover import recover
from mcap.writer import IndexType, Writer
from mcap_ros2.writer import Writer as RosWriter
import pytest
from rclpy.serialization import deserialize_message
from rosbags.rosbag1 import Writer as OldWriter
from rosbags.typesys import get_typestore, Stores
from std_msgs.msg import Float64, Header
from surrogate.files import InputError
import yaml

DEADLINE = 600.0  # [s] which only ends a hang

TYPES = {
    '/joint_states': 'sensor_msgs/msg/JointState',
    '/axial_load': 'geometry_msgs/msg/WrenchStamped',
}
EVERY = TYPES | {'/oil_temperature': 'sensor_msgs/msg/Temperature'}
OF_MCAP = {'storage_identifier': 'mcap'}


@pytest.fixture
def copy(short_bag, tmp_path):
    return shutil.copytree(short_bag, tmp_path / 'copy')


def sentence(action):
    with pytest.raises(InputError) as caught:
        action()
    text = str(caught.value)
    assert '\n' not in text
    assert text
    return text


def test_messages_come_by_log_time_of_the_topics_that_are_chosen(short_bag):
    bag = Bag(short_bag)
    messages = list(bag.messages())
    times = [message.log_time for message in messages]
    assert times == sorted(times)
    assert (times[0], times[-1]) == (bag.start_time, bag.end_time)
    assert len(messages) == sum(info.count for info in bag.topics.values())
    assert bag.duration == pytest.approx(3.0, abs=0.02)
    bag = Bag(short_bag / 'short.mcap')
    assert {message.topic for message in bag.messages(['/axial_load'])} == {'/axial_load'}
    bag.require(TYPES)
    list(bag.messages())


def test_two_files_are_one_bag(short_bag, tmp_path):
    for name in ('one.mcap', 'two.mcap'):
        shutil.copy(short_bag / 'short.mcap', tmp_path / name)
    bag = Bag(tmp_path)
    assert bag.topics['/joint_states'].count == 2 * Bag(short_bag).topics['/joint_states'].count
    times = [message.log_time for message in bag.messages()]
    assert times == sorted(times)


def test_topics_that_are_missing_or_of_another_type_are_named(short_bag, says):
    bag = Bag(short_bag)
    text = sentence(lambda: bag.require({'/load': 'std_msgs/msg/Float64'}))
    assert text.endswith(says('topic_load_std_msgs'))
    text = sentence(lambda: bag.require({'/axial_load': 'std_msgs/msg/Float64'}))
    assert says('geometry_msgs_msg') in text


def test_a_topic_or_a_bag_without_messages_is_named(tmp_path):
    with BagWriter(tmp_path, 'bag') as writer:
        for name in ('/a', '/b'):
            writer.add_topic(Topic(name=name, type_name='std_msgs/msg/Header', offer=Offer.SENSOR))
        writer.write('/a', bytes(20), log_time=1, publish_time=1)
    text = sentence(lambda: Bag(tmp_path).require({'/b': 'std_msgs/msg/Header'}))
    assert 'topic /b holds no message' in text
    BagWriter(tmp_path, 'bag').close()
    assert 'holds no message' in sentence(lambda: Bag(tmp_path))


def test_no_bag_at_all(tmp_path):
    assert 'does not exist' in sentence(lambda: Bag(tmp_path / 'nothing'))
    assert 'holds no MCAP file' in sentence(lambda: Bag(tmp_path))
    (tmp_path / 'run.mcap.active').touch()
    assert 'only the unfinished run.mcap.active' in sentence(lambda: Bag(tmp_path))


@pytest.mark.parametrize('part', [0.0, 1e-4, 0.01, 0.3, 0.9, 0.9999])
def test_a_truncated_file_is_refused_when_it_is_opened(copy, part):
    path = copy / 'short.mcap'
    data = path.read_bytes()
    path.write_bytes(data[: int(part * len(data))])
    assert 'is truncated or damaged' in sentence(lambda: Bag(copy))


@pytest.mark.parametrize('part', [0.05, 0.2, 0.4])
def test_damage_inside_is_found_when_it_is_read(copy, part):
    path = copy / 'short.mcap'
    data = bytearray(path.read_bytes())
    data[int(part * len(data))] ^= 0x55
    path.write_bytes(data)
    assert 'is truncated or damaged' in sentence(lambda: list(Bag(copy).messages()))


@pytest.mark.parametrize(
    ('content', 'expected'),
    [
        ('][', 'is not a rosbag2 metadata file'),
        ('a: 1', 'is not a rosbag2 metadata file'),
        ({'storage_identifier': 'x', 'relative_file_paths': []}, 'must be mcap or sqlite3'),
        ({'storage_identifier': 'mcap'}, 'is not a rosbag2 metadata file'),
        (OF_MCAP | {'relative_file_paths': ['a'], 'compression_format': 'lz4'}, 'must be zstd'),
        (OF_MCAP | {'relative_file_paths': ['x.mcap']}, 'x.mcap, which is'),
        (OF_MCAP | {'relative_file_paths': []}, 'holds no MCAP file'),
    ],
)
def test_bad_metadata_is_one_sentence(copy, content, expected):
    if isinstance(content, dict):
        content = yaml.safe_dump({'rosbag2_bagfile_information': content})
    (copy / 'metadata.yaml').write_text(content)
    assert expected in sentence(lambda: Bag(copy))


def stated(copy, counts):
    """State other counts of messages, by topic, in the metadata of a bag."""
    topics = [
        {'topic_metadata': {'name': name}, 'message_count': count}
        for name, count in counts.items()
    ]
    content = OF_MCAP | {'relative_file_paths': ['short.mcap']}
    content['topics_with_message_count'] = topics
    text = yaml.safe_dump({'rosbag2_bagfile_information': content})
    (copy / 'metadata.yaml').write_text(text)


def test_metadata_that_count_other_messages_than_the_files_are_told(copy, says):
    counts = {name: info.count for name, info in Bag(copy).topics.items()}
    stated(copy, counts)
    assert not Bag(copy).notes
    stated(copy, counts | {'/axial_load': 1000, '/gone': 7})
    held = counts['/axial_load']
    for salvage in (False, True):
        bag = Bag(copy, salvage=salvage)
        assert bag.notes == [says('counts_other', bag=copy, held=held)]
        assert len(list(bag.messages(['/axial_load']))) == held
    stated(copy, counts | {f'/{number}': 1 for number in range(7)})
    assert says('counts_of_more') in Bag(copy).notes[0]


@pytest.mark.parametrize('topics', [None, 'a', 5, ['a'], [{'message_count': 5}], [None]])
def test_metadata_may_count_nothing(copy, topics):
    content = OF_MCAP | {'relative_file_paths': ['short.mcap']}
    content['topics_with_message_count'] = topics
    text = yaml.safe_dump({'rosbag2_bagfile_information': content})
    (copy / 'metadata.yaml').write_text(text)
    assert not Bag(copy).notes


def test_a_topic_whose_schema_is_missing_is_named(tmp_path, says):
    path = tmp_path / 'bag.mcap'
    with path.open('wb') as stream:
        writer = Writer(stream)
        writer.start()
        channel = writer.register_channel(topic='/a', message_encoding='cdr', schema_id=0)
        writer.add_message(channel, log_time=1, data=b'', publish_time=1)
        writer.finish()
    text = sentence(lambda: Bag(path).require({'/a': 'std_msgs/msg/Header'}))
    assert text.endswith(says('topic_states_type'))


@pytest.mark.parametrize(
    'stated',
    [
        *({'storage_identifier': kind} for kind in ('', None, 'MCAP', 'sqlite3', 'rosbag_v2', 7)),
        {},
        {'storage_identifier': 'mcap', 'compression_format': 'ZSTD', 'compression_mode': 'NONE'},
        {'storage_identifier': 'mcap', 'compression_format': 'lz4', 'compression_mode': ''},
    ],
)
@pytest.mark.parametrize(
    'place',
    ['short.mcap', 'bag/short.mcap', '.\\short.mcap', 'logs\\bag\\short.mcap']
    + ['C:\\logs\\short.mcap', '\\\\server\\logs\\short.mcap'],
)
def test_the_first_bytes_of_a_file_tell_its_storage_and_its_name_where_it_is(
    short_bag, copy, stated, place
):
    content = stated | {'relative_file_paths': [place]}
    text = yaml.safe_dump({'rosbag2_bagfile_information': content})
    (copy / 'metadata.yaml').write_text(text)
    bag = Bag(copy)
    assert bag.types == Bag(short_bag).types
    assert not bag.notes
    assert len(list(bag.messages())) == len(list(Bag(short_bag).messages()))


PLAIN = {'index_types': IndexType.NONE, 'use_statistics': False, 'use_summary_offsets': False}
LEFT_OUT = {
    'all': PLAIN | {'repeat_channels': False, 'repeat_schemas': False},
    'all_without_chunks': PLAIN
    | {'repeat_channels': False, 'repeat_schemas': False, 'use_chunking': False},
    'statistics': PLAIN,
    'statistics_alone': {'use_statistics': False},
    'channels': {'repeat_channels': False},
    'schemas': {'repeat_schemas': False},
    'channels_and_schemas': {'repeat_channels': False, 'repeat_schemas': False},
}


def written_by_mcap(short_bag, path, **options):
    """Write the messages of a bag by the stock writer, with parts of the summary left out."""
    messages = list(Bag(short_bag).messages())
    with path.open('wb') as stream:
        writer = Writer(stream, chunk_size=5000, **options)
        writer.start('ros2', 'test')
        numbers = {}
        for topic, kind in EVERY.items():
            schema = writer.register_schema(kind, 'ros2msg', message_definition(kind).encode())
            numbers[topic] = writer.register_channel(topic, 'cdr', schema)
        for one in messages:
            writer.add_message(numbers[one.topic], one.log_time, one.data, one.publish_time)
        writer.finish()
    return messages


@pytest.mark.parametrize('salvage', [False, True])
@pytest.mark.parametrize('name', LEFT_OUT)
def test_a_file_may_leave_out_its_summary(short_bag, tmp_path, name, salvage):
    path = tmp_path / 'bag.mcap'
    messages = written_by_mcap(short_bag, path, **LEFT_OUT[name])
    bag = Bag(path, salvage=salvage)
    bag.require(TYPES)
    assert [(one.topic, one.log_time, one.data) for one in bag.messages()] == [
        (one.topic, one.log_time, one.data) for one in messages
    ]
    assert (bag.start_time, bag.end_time) == (messages[0].log_time, messages[-1].log_time)
    assert not bag.notes


@pytest.mark.parametrize('share', [0.2, 0.5, 0.7])
def test_damage_to_a_file_without_a_summary_is_told(short_bag, tmp_path, share):
    path = tmp_path / 'bag.mcap'
    written_by_mcap(short_bag, path, **LEFT_OUT['all'])
    data = bytearray(path.read_bytes())
    data[int(share * len(data))] ^= 0x55
    path.write_bytes(data)
    assert 'is truncated or damaged' in sentence(lambda: Bag(path))
    assert 'is truncated or damaged' in Bag(path, salvage=True).notes[0]


@pytest.mark.parametrize('encoding', ['json', 'protobuf', 'ros1'])
def test_messages_of_another_encoding_are_named_with_the_way_to_convert_them(
    tmp_path, says, encoding
):
    path = tmp_path / 'bag.mcap'
    with path.open('wb') as stream:
        writer = Writer(stream)
        writer.start()
        schema = writer.register_schema('sensor_msgs/JointState', 'jsonschema', b'{}')
        channel = writer.register_channel('/joint_states', encoding, schema)
        writer.add_message(channel, log_time=1, data=b'{}', publish_time=1)
        writer.finish()
    expected = says('by_writer' if encoding != 'ros1' else 'by_rosbags', encoding=encoding)
    assert sentence(lambda: Bag(path)).endswith(expected)
    text = sentence(lambda: recover(path))
    assert text.endswith(expected)
    assert not [one for one in tmp_path.iterdir() if one != path]


def test_the_stated_writer_makes_a_bag_of_json(tmp_path):
    values = json.loads('{"data": 0.25}')
    path = tmp_path / 'bag.mcap'
    with path.open('wb') as stream:
        writer = RosWriter(stream)
        kind = writer.register_msgdef('std_msgs/msg/Float64', 'float64 data')
        writer.write_message('/a', kind, values, log_time=5, publish_time=5)
        writer.finish()
    (message,) = Bag(path).messages()
    assert deserialize_message(message.data, Float64).data == values['data']


@pytest.mark.parametrize('in_folder', [False, True])
def test_a_bag_of_ros_1_is_converted_as_its_refusal_says(tmp_path, in_folder):
    store, path = get_typestore(Stores.ROS1_NOETIC), tmp_path / 'the log.bag'
    header = store.types['std_msgs/msg/Header']
    with OldWriter(path) as writer:
        known = writer.add_connection('/a', header.__msgtype__, typestore=store)
        for number in range(1, 4):
            stamp = store.types['builtin_interfaces/msg/Time'](sec=number, nanosec=0)
            one = header(seq=number, stamp=stamp, frame_id='x')
            data = store.serialize_ros1(one, header.__msgtype__)
            writer.write(known, number * 10**9, data)
    text = sentence(lambda: opened_log(tmp_path if in_folder else path))
    assert text == sentence(lambda: recover(path))
    command = shlex.split(text.partition(': ')[2].partition(' does so')[0])
    command[0] = str(Path(sys.executable).with_name(command[0]))
    subprocess.run(command, check=True, timeout=DEADLINE)
    bag = Bag(path.with_suffix(''))
    stamps = [deserialize_message(one.data, Header).stamp.sec for one in bag.messages()]
    assert stamps == [1, 2, 3]
