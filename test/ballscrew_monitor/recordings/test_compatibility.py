# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Bags open with mcap, rosbags and mcap-ros2-support: every value, schema and name."""

import json
import math
from pathlib import Path
import re

from ballscrew_monitor.core.cdr import serialized
from ballscrew_monitor.core.fields import message_class, stamp_of
from ballscrew_monitor.recordings.bag import Bag
from ballscrew_monitor.recordings.bag_writer import BagWriter
from ballscrew_monitor.recordings.recorder import recorded_topics
from ballscrew_monitor.recordings.replay import replay
from ballscrew_monitor.settings.parameters import read_file
from mcap.reader import make_reader
from mcap_ros2.decoder import DecoderFactory
import pytest
from rclpy.serialization import deserialize_message
from rosbags.highlevel import AnyReader
from rosbags.typesys import get_types_from_msg
import yaml

ROOT = Path(__file__).resolve().parents[3]
LAYOUT = ROOT / 'config' / 'layouts' / 'foxglove_axis_x.json'
STATE, EVENT = '/ballscrew_monitor/x/state', '/ballscrew_monitor/x/out_of_zone'
VALUES = read_file(ROOT / 'config' / 'nominal_cycle.yaml')
TOPICS = recorded_topics(VALUES)


@pytest.fixture(scope='module', params=['filled', 'replayed'])
def written(request, filled, tmp_path_factory):
    """Return a bag of every type, each field filled or what a replay says, and its messages."""
    directory = tmp_path_factory.mktemp(request.param)
    made = _made(filled) if request.param == 'filled' else _replayed(request)
    with BagWriter(directory, 'cycle') as writer:
        for topic in TOPICS:
            writer.add_topic(topic)
        for number, (topic, data) in enumerate(made):
            writer.write(topic, data, log_time=1000 + 10 * number, publish_time=1000)
    kinds = {topic.name: message_class(topic.type_name) for topic in TOPICS}
    return directory, [(topic, deserialize_message(data, kinds[topic])) for topic, data in made]


def _made(filled):
    """Return two messages of each topic, serialised, one of them without a value."""
    return [
        (topic.name, serialized(message))
        for topic in TOPICS
        for kind in [message_class(topic.type_name)]
        for message in (filled(kind), kind())
    ]


def _replayed(request):
    """Return the inputs of the short bag, and each third of the states with all events."""
    bag = Bag(request.getfixturevalue('short_bag'))
    made = [(message.topic, message.data) for message in bag.messages()]
    for number, (state, event) in enumerate(replay(bag, VALUES)):
        if number % 3 == 0:
            made.append((STATE, serialized(state)))
        if event is not None:
            made.append((EVENT, serialized(event)))
    return made


def read_by_mcap(directory):
    with (directory / 'cycle.mcap').open('rb') as stream:
        found = make_reader(stream, validate_crcs=True).iter_messages(log_time_order=False)
        return [(channel.topic, message.data) for _, channel, message in found]


def read_by_mcap_ros2(directory):
    with (directory / 'cycle.mcap').open('rb') as stream:
        reader = make_reader(stream, decoder_factories=[DecoderFactory()])
        return [
            (channel.topic, message) for _, channel, _, message in reader.iter_decoded_messages()
        ]


def read_by_rosbags(directory):
    with AnyReader([directory]) as reader:
        return [
            (connection.topic, reader.deserialize(data, connection.msgtype))
            for connection, _, data in reader.messages()
        ]


def plain(part, like):
    """Return a part of a message of any library as plain data, in the form of one of ROS."""
    if hasattr(like, 'get_fields_and_field_types'):
        names = like.get_fields_and_field_types()
        return {name: plain(getattr(part, name), getattr(like, name)) for name in names}
    if isinstance(like, bytes):  # an octet, which may be a number
        return part[0] if isinstance(part, bytes) else int(part)
    if isinstance(like, str | bool):
        return part
    if hasattr(like, '__len__'):
        assert len(part) == len(like)
        return [plain(one, other) for one, other in zip(part, like)]
    return 'nan' if math.isnan(part) else part


@pytest.mark.parametrize('read', [read_by_mcap_ros2, read_by_rosbags])
def test_every_value_is_read_as_it_was_written(written, read):
    directory, messages = written
    found = read(directory)
    assert [topic for topic, _ in found] == [topic for topic, _ in messages]
    for (topic, message), (_, wanted) in zip(found, messages):
        assert plain(message, wanted) == plain(wanted, wanted), topic


def test_every_byte_is_read_as_it_was_written_and_the_metadata_is_of_version_9(written):
    directory, messages = written
    for (topic, data), (wanted, message) in zip(read_by_mcap(directory), messages, strict=True):
        assert (topic, data) == (wanted, serialized(message))
    text = (written[0] / 'metadata.yaml').read_text()
    assert yaml.safe_load(text)['rosbag2_bagfile_information']['version'] == 9
    assert not re.search(r'[&*]id\d', text)


def test_rosbags_finds_all_of_a_topic_and_a_schema_holds_every_type_inside(written):
    directory, messages = written
    with AnyReader([directory]) as reader:
        counts = {topic: info.msgcount for topic, info in reader.topics.items() if info.msgcount}
        offers = {one.topic: one.ext.offered_qos_profiles for one in reader.connections}
        kinds = {one.topic: one.msgtype for one in reader.connections}
        assert reader.start_time == 1000
        assert reader.message_count == len(messages)
    assert kinds == {topic.name: topic.type_name for topic in TOPICS}
    assert all(counts[topic] == [name for name, _ in messages].count(topic) for topic in counts)
    assert offers[EVENT][0].durability.name == 'TRANSIENT_LOCAL'
    with (written[0] / 'cycle.mcap').open('rb') as stream:
        schemas = make_reader(stream).get_summary().schemas.values()
    assert {schema.name for schema in schemas} == {topic.type_name for topic in TOPICS}
    for schema in schemas:
        assert schema.encoding == 'ros2msg'
        types = get_types_from_msg(schema.data.decode(), schema.name)
        assert set(inside(types, schema.name)) == set(types)


def inside(types, name):
    """Return a type and all in it, by the definitions at hand; KeyError for one without."""
    fields = re.findall(r"'(\w+/msg/\w+)'", repr(types[name][1]))
    return {name}.union(*(inside(types, field) for field in fields))


@pytest.mark.parametrize('read', [read_by_mcap_ros2, read_by_rosbags])
def test_the_curves_of_the_layouts_are_numbers_over_a_growing_time(written, read):
    directory, messages = written
    states = [message for topic, message in read(directory) if topic == STATE]
    wanted = [message for topic, message in messages if topic == STATE]
    for path in re.findall(rf'"{STATE}\.([\w.]+)"', LAYOUT.read_text()):
        expected = [number(state, path) for state in wanted]
        assert [number(state, path) for state in states] == expected
    assert [stamp_of(state) for state in states] == [stamp_of(state) for state in wanted]


def number(message, path):
    """Return the number at a path of names, a NaN as text."""
    for name in path.split('.'):
        message = getattr(message, name)
    return 'nan' if math.isnan(message) else float(message)


def test_the_layouts_name_topics_that_are_recorded():
    panels = json.loads(LAYOUT.read_text())['configById'].values()
    paths = [path['value'] for panel in panels for path in panel.get('paths', [])]
    assert paths
    assert {path.partition('.')[0] for path in paths} <= {topic.name for topic in TOPICS}
