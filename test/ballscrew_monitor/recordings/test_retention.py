# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Retention: the recordings that are kept, and those that make room."""

import errno
import json
import os

from ballscrew_monitor.core.conversions import SECOND
from ballscrew_monitor.recordings.bag import Bag
from ballscrew_monitor.recordings.frames import Frame, FrameKind
from ballscrew_monitor.recordings.retention import KeepSettings, Retention
import pytest
from rclpy.serialization import serialize_message
from std_msgs.msg import Float64

EPOCH = 1_700_000_000 * SECOND
SETTINGS = {
    'always': True,
    'before': 5.0,
    'after': 2.0,
    'longest': 10.0,
    'largest': 1e6,
    'total': 1e9,
}
DATA = serialize_message(Float64(data=1.0))


def topic(number, name, offer='SENSOR'):
    stated = {'name': name, 'type': 'std_msgs/msg/Float64', 'offer': offer}
    return Frame(FrameKind.TOPIC, topic=number, body=json.dumps(stated).encode())


def retention_in(folder, **changes):
    return Retention(folder, KeepSettings(**(SETTINGS | changes)))


def message(second, body=DATA):
    """Return a message that is taken at a second, one a second; its number is the second."""
    time = EPOCH + second * SECOND
    return Frame(FrameKind.MESSAGE, 3, time, time + 7, second, body)


def feed(retention, seconds, triggers=()):
    """Give a message each second, and triggers just before those of some seconds."""
    retention.take(topic(3, '/a'), 0.0)
    for second in seconds:
        if second in triggers:
            retention.take(Frame(FrameKind.TRIGGER, log_time=EPOCH), float(second))
        retention.take(message(second), float(second))


def seconds_in(folder):
    return {
        path.name: [(one.log_time - EPOCH) // SECOND for one in Bag(path).messages()]
        for path in sorted(folder.glob('*'))
    }


def test_always_is_everything_in_recordings_of_limited_length(tmp_path):
    retention = retention_in(tmp_path)
    feed(retention, range(25))
    retention.close()
    assert seconds_in(tmp_path) == {
        '20231114T221320Z': [*range(10)],
        '20231114T221330Z': [*range(10, 20)],
        '20231114T221340Z': [*range(20, 25)],
    }
    one = next(Bag(tmp_path / '20231114T221320Z').messages())
    assert (one.topic, one.data, one.publish_time - one.log_time) == ('/a', DATA, 7)
    assert retention.problem == ''


@pytest.mark.parametrize(
    ('changes', 'count', 'triggers', 'expected'),
    [
        ({'largest': 4.0 * len(DATA)}, 9, (), [[*range(4)], [*range(4, 8)], [8]]),
        ({'always': False}, 40, (8, 10, 30), [[*range(2, 13)], [*range(24, 33)]]),
        ({'always': False}, 40, (20, 25), [[*range(14, 23)], [*range(19, 28)]]),
        ({'always': False}, 40, (), []),
    ],
    ids=['large enough is finished', 'around each event', 'one soon after another', 'no event'],
)
def test_the_messages_of_each_recording(tmp_path, changes, count, triggers, expected):
    """Around events, the seconds before and after each are kept, and without one nothing is."""
    folder = tmp_path / 'some'
    retention = retention_in(folder, **changes)
    feed(retention, range(count), triggers)
    retention.close()
    assert folder.exists() == bool(expected)
    assert [*seconds_in(folder).values()] == expected


def test_the_oldest_recordings_make_room_and_nothing_else_does(tmp_path):
    (tmp_path / 'mine').mkdir()
    (tmp_path / 'mine' / 'notes.mcap').write_bytes(bytes(5000))
    (tmp_path / '20200101T000000Z').mkdir()
    (tmp_path / '20200101T000000Z' / 'mine.txt').write_text('kept')
    retention = retention_in(tmp_path, largest=2e4, total=8e4)
    retention.take(topic(3, '/a'), 0.0)
    for second in range(200):
        retention.take(message(second, os.urandom(2000)), 0.01 * second)
    retention.close()
    assert (tmp_path / 'mine' / 'notes.mcap').exists()
    assert (tmp_path / '20200101T000000Z' / 'mine.txt').exists()
    sizes = [
        sum(file.stat().st_size for file in path.iterdir())
        for path in tmp_path.iterdir()
        if path.name.startswith('2023')
    ]
    assert len(sizes) == 3
    assert sum(sizes) <= 8e4
    newest = max(path.name for path in tmp_path.iterdir() if path.name.startswith('2023'))
    assert seconds_in_last(tmp_path / newest) == 199


def seconds_in_last(path):
    return [(one.log_time - EPOCH) // SECOND for one in Bag(path).messages()][-1]


def test_two_recordings_of_one_second_have_two_names(tmp_path):
    for _ in range(2):
        retention = retention_in(tmp_path)
        feed(retention, [0])
        retention.close()
    assert [*seconds_in(tmp_path)] == ['20231114T221320Z', '20231114T221320Z_2']


def test_a_full_disk_is_told_and_tried_again(tmp_path, monkeypatch, says):
    retention = retention_in(tmp_path)
    feed(retention, [0])

    def full(*unused, **also):
        raise OSError(errno.ENOSPC, 'No space left on device')

    with monkeypatch.context() as context:
        context.setattr(type(retention._writer), 'write', full)
        retention.take(message(1), 1.0)
        assert retention.problem == says('nothing_recorded_space', tmp_path=tmp_path)
    retention.take(message(5), 5.0)
    assert retention.problem
    retention.take(message(12), 12.0)
    assert retention.problem == ''
    retention.close()
    assert seconds_in_last(tmp_path / '20231114T221332Z') == 12


@pytest.mark.parametrize('always', [True, False])
def test_a_topic_that_comes_later_is_recorded_too(tmp_path, always):
    retention = retention_in(tmp_path, always=always)
    feed(retention, range(3), triggers=(2,))
    retention.take(topic(4, '/b', 'LATCHED'), 3.0)
    retention.take(Frame(FrameKind.MESSAGE, 4, EPOCH + 3 * SECOND, 0, 0, DATA), 3.0)
    retention.close()
    (path,) = tmp_path.iterdir()
    assert [one.topic for one in Bag(path).messages()] == ['/a'] * 3 + ['/b']


def test_a_topic_announced_while_nothing_is_written_is_known_later(tmp_path, monkeypatch):
    retention = retention_in(tmp_path)

    def refuse(*unused):
        raise OSError(errno.ENOSPC, 'No space left on device')

    with monkeypatch.context() as context:
        context.setattr(retention, '_write', refuse)
        feed(retention, [0])
    retention.take(topic(4, '/b', 'LATCHED'), 1.0)
    retention.take(Frame(FrameKind.MESSAGE, 4, EPOCH + 20 * SECOND, 0, 0, DATA), 20.0)
    retention.close()
    assert retention.problem == ''
    assert seconds_in_last(tmp_path / '20231114T221340Z') == 20
