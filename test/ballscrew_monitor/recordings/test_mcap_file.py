# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The MCAP file that is written: byte by byte that of the writer of the package `mcap`."""

import io
import re

from ballscrew_monitor.recordings.mcap_file import (
    McapFile,
    MESSAGE,
    message_definition,
    MESSAGE_FIELDS,
    SEPARATOR,
    type_hash,
)
from mcap.reader import make_reader
from mcap.writer import CompressionType, Writer
import numpy as np
import pytest
from surrogate.files import InputError

CHUNK_SIZE = 4096
RNG = np.random.default_rng(1)
COUNT = 500
NUMBERS = RNG.integers(1, 4, COUNT)
TIMES = np.sort(RNG.integers(10**18, 10**18 + 10**9, COUNT))
CONTENTS = [RNG.bytes(int(size)) for size in RNG.integers(0, 300, COUNT)]
SEQUENCE = np.arange(COUNT)
TOPICS = ('/a', '/b', '/c')


def theirs(compress, *, count=COUNT):
    stream = io.BytesIO()
    writer = Writer(
        stream,
        chunk_size=CHUNK_SIZE,
        compression=CompressionType.ZSTD if compress else CompressionType.NONE,
    )
    writer.start(profile='ros2', library='ballscrew_monitor')
    writer.add_metadata('before', {'a': 'b', 'ü': 'ö'})
    for topic in TOPICS:
        schema = writer.register_schema(name='Kind', encoding='ros2msg', data=bytes(800))
        writer.register_channel(topic, 'cdr', schema, {'of': topic})
    for number, time, content, sequence in list(zip(NUMBERS, TIMES, CONTENTS, SEQUENCE))[:count]:
        writer.add_message(int(number), int(time), content, int(time), int(sequence))
    writer.add_metadata('behind', {})
    writer.finish()
    return stream.getvalue()


def ours(compress, add):
    stream = io.BytesIO()
    file = McapFile(stream, chunk_size=CHUNK_SIZE, compress=compress)
    file.add_metadata('before', {'a': 'b', 'ü': 'ö'})
    for topic in TOPICS:
        file.add_channel(topic=topic, kind='Kind', definition=bytes(800), metadata={'of': topic})
    add(file)
    file.add_metadata('behind', {})
    file.finish()
    return stream.getvalue()


def one_by_one(file, part=slice(None)):
    for number, time, content, sequence in zip(
        NUMBERS[part], TIMES[part], CONTENTS[part], SEQUENCE[part]
    ):
        file.add_message(
            int(number),
            content,
            log_time=int(time),
            publish_time=int(time),
            sequence=int(sequence),
        )


def at_once(file, part=slice(None)):
    sizes = np.array([len(content) for content in CONTENTS])
    begins = np.cumsum(sizes) - sizes
    told = {'log_time': TIMES[part], 'sequence': SEQUENCE[part]}
    file.add_messages(NUMBERS[part], b''.join(CONTENTS), begins[part], sizes[part], **told)


def taking_turns(file):
    for begin in range(0, COUNT, 70):
        one_by_one(file, slice(begin, begin + 35))
        at_once(file, slice(begin + 35, begin + 70))


def test_both_ways_know_one_layout_and_a_file_without_a_message():
    assert MESSAGE_FIELDS.itemsize == MESSAGE.size
    assert ours(True, lambda file: None) == theirs(True, count=0)


@pytest.mark.parametrize('compress', [True, False])
@pytest.mark.parametrize('add', [one_by_one, at_once, taking_turns])
def test_each_way_gives_the_bytes_of_the_package(add, compress):
    assert ours(compress, add) == theirs(compress)


def test_it_reads_back():
    reader = make_reader(io.BytesIO(ours(True, at_once)), validate_crcs=True)
    found = [(channel.topic, one.data) for _, channel, one in reader.iter_messages()]
    assert len(found) == COUNT
    expected = sorted((TOPICS[number - 1], content) for number, content in zip(NUMBERS, CONTENTS))
    assert sorted(found) == expected
    statistics = reader.get_summary().statistics
    wanted = {number: int((NUMBERS == number).sum()) for number in (1, 2, 3)}
    assert statistics.channel_message_counts == wanted


def test_dependencies_follow_the_definition_once_with_their_names():
    parts = message_definition('sensor_msgs/msg/JointState').split(f'{SEPARATOR}\n')
    assert 'float64[] velocity' in parts[0]
    expected = ['MSG: builtin_interfaces/Time', 'MSG: std_msgs/Header']
    assert [part.splitlines()[0] for part in parts[1:]] == expected
    assert all(part.endswith('\n') for part in parts)
    text = message_definition('ballscrew_msgs/msg/BallScrewState')
    names = re.findall('^MSG: (.*)$', text, flags=re.MULTILINE)
    assert len(names) == len(set(names))
    assert {'ballscrew_msgs/PointResult', 'builtin_interfaces/Time'} <= set(names)


def test_the_hash_is_that_of_the_generated_description():
    # Published for ROS 2 Jazzy: std_msgs/msg/Header.
    expected = 'RIHS01_f49fb3ae2cf070f793645ff749683ac6b06203e41c891e17701b1cb597ce6a01'
    assert type_hash('std_msgs/msg/Header') == expected


@pytest.mark.parametrize('name', ['std_msgs/msg/Nothing', 'Header', 'no_msgs/msg/Header'])
def test_an_unknown_type_is_one_sentence(name):
    with pytest.raises(InputError, match=f'message type .?{name}'):
        type_hash(name)
