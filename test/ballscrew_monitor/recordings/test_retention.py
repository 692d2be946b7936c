# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Retention: the recordings that are kept, and those that make room."""

import errno
import json
import os

from ballscrew_monitor.core.conversions import SECOND
from ballscrew_monitor.recordings.bag import Bag
from ballscrew_monitor.recordings.bulk.chunks import chunk_indexes
from ballscrew_monitor.recordings.bulk.events import blank, Notes
from ballscrew_monitor.recordings.event_messages import events_of, read
from ballscrew_monitor.recordings.frames import EVENTS, Frame, FrameKind
from ballscrew_monitor.recordings.recover import recover
from ballscrew_monitor.recordings.retention import KeepSettings, Retention
import numpy as np
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


TOPICS = {3: ('/a', 'std_msgs/msg/Float64'), 4: ('/b', 'std_msgs/msg/Float64'), 5: ('/e', EVENTS)}


def topic(number, offer='SENSOR'):
    name, kind = TOPICS[number]
    stated = {'name': name, 'type': kind, 'offer': offer}
    return Frame(FrameKind.TOPIC, topic=number, body=json.dumps(stated).encode())


def retention_in(folder, **changes):
    return Retention(folder, KeepSettings(**(SETTINGS | changes)))


def message(second, body=DATA, number=3):
    """Return a message that is taken at a second, one a second; its number is the second."""
    time = EPOCH + round(second * SECOND)
    return Frame(FrameKind.MESSAGE, number, time, time + 7, round(second), body)


def snapshots(second, kind=FrameKind.BEGIN):
    return Frame(kind, 5, EPOCH + second * SECOND, body=json.dumps([f'at {second}']).encode())


def turn(second, count=1):
    """Return the frame of events at a second."""
    stamps = EPOCH + round(second * SECOND) + np.arange(count)
    events = blank(count, stamp=stamps, arrival=stamps, steady=second)
    return Frame(FrameKind.EVENTS, 5, int(stamps[-1]), body=events.tobytes())


def begun(retention, now=0.0):
    """Announce the topics, and let a recording begin."""
    retention.take(topic(3), now)
    retention.take(topic(5), now)
    retention.take(snapshots(round(now)), now)


def feed(retention, seconds, triggers=(), every=2):
    """Give a message each second, before that of some triggers and snapshots."""
    retention.take(topic(3), 0.0)
    retention.take(topic(5), 0.0)
    for second in seconds:
        if second in triggers:
            retention.take(Frame(FrameKind.TRIGGER, log_time=EPOCH), float(second))
        if second % every == 0:
            retention.take(snapshots(second), float(second))
        retention.take(message(second), float(second))
        retention.take(turn(second), float(second))


def seconds_in(folder):
    return {
        path.name: [(one.log_time - EPOCH) // SECOND for one in Bag(path).messages(['/a'])]
        for path in sorted(folder.glob('*'))
    }


def assert_begin_at_snapshots(folder):
    """Hold that each recording begins with snapshots, and has each message of events after."""
    for path in folder.glob('2023*'):
        first, *rest = [read(one.data) for one in Bag(path).as_written(['/e'])]
        assert first.snapshots
        assert [one.number for one in rest] == [first.number + 1 + at for at in range(len(rest))]


def test_always_is_everything_in_recordings_of_limited_length(tmp_path):
    retention = retention_in(tmp_path)
    feed(retention, range(25))
    retention.close()
    assert seconds_in(tmp_path) == {
        '20231114T221320Z': [*range(10)],
        '20231114T221330Z': [*range(10, 20)],
        '20231114T221340Z': [*range(20, 25)],
    }
    assert_begin_at_snapshots(tmp_path)
    one = next(Bag(tmp_path / '20231114T221320Z').messages(['/a']))
    assert (one.topic, one.data, one.publish_time - one.log_time) == ('/a', DATA, 7)
    assert retention.problem == ''


@pytest.mark.parametrize(
    ('changes', 'count', 'triggers', 'expected'),
    [
        ({'largest': 1200.0}, 9, (), [[*range(4)], [*range(4, 8)], [8]]),
        ({'always': False}, 40, (8, 10, 30), [[*range(2, 12)], [*range(24, 32)]]),
        ({'always': False}, 40, (20, 25), [[*range(14, 22)], [*range(20, 28)]]),
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
    assert_begin_at_snapshots(folder)


def test_events_are_on_the_disk_within_a_second_in_chunks_of_their_own(tmp_path):
    """The writer is not closed: what a kill would leave is read."""
    retention = retention_in(tmp_path)
    begun(retention)
    for number in range(30):
        retention.take(turn(0.1 * number, 3), 0.1 * number)
        retention.take(message(0.1 * number), 0.1 * number)
    (file,) = tmp_path.glob('*/*.active')
    recover(file)
    (path,) = tmp_path.iterdir()
    bag = Bag(path)
    messages = [read(one.data) for one in bag.as_written(['/e'])]
    stamps = events_of(messages, Notes())['stamp'] - EPOCH
    assert len(stamps) >= 3 * 20
    assert sorted(stamps) == stamps.tolist()
    with path.joinpath(bag.files[0].name).open('rb') as stream:
        chunks, channels = chunk_indexes(stream, ['/a', '/e'])
    kinds = [{channels[one] for one in chunk.message_index_offsets} for chunk in chunks]
    assert {'/a'} in kinds
    assert all(len(kind) == 1 for kind in kinds)
    retention.close()


def test_what_comes_before_snapshots_belongs_to_no_recording(tmp_path):
    retention = retention_in(tmp_path)
    retention.take(topic(3), 0.0)
    retention.take(topic(5), 0.0)
    retention.take(message(0), 0.0)
    retention.take(turn(0), 0.0)
    retention.take(snapshots(0, FrameKind.SNAPSHOT), 0.5)
    assert not any(tmp_path.iterdir())
    begun(retention, 1.0)
    retention.take(message(2), 2.0)
    retention.close()
    assert [*seconds_in(tmp_path).values()] == [[2]]


def test_the_oldest_recordings_make_room_and_nothing_else_does(tmp_path):
    (tmp_path / 'mine').mkdir()
    (tmp_path / 'mine' / 'notes.mcap').write_bytes(bytes(5000))
    (tmp_path / '20200101T000000Z').mkdir()
    (tmp_path / '20200101T000000Z' / 'mine.txt').write_text('kept')
    retention = retention_in(tmp_path, largest=2e4, total=8e4)
    begun(retention)
    for second in range(200):
        if second % 5 == 0:
            retention.take(snapshots(second), 0.01 * second)
        retention.take(message(second, os.urandom(2000)), 0.01 * second)
    retention.close()
    assert (tmp_path / 'mine' / 'notes.mcap').exists()
    assert (tmp_path / '20200101T000000Z' / 'mine.txt').exists()
    sizes = [
        sum(file.stat().st_size for file in path.iterdir())
        for path in tmp_path.iterdir()
        if path.name.startswith('2023')
    ]
    assert len(sizes) == 4
    assert sum(sizes) <= 8e4
    newest = max(path.name for path in tmp_path.iterdir() if path.name.startswith('2023'))
    assert seconds_in_last(tmp_path / newest) == 199


def seconds_in_last(path):
    return [(one.log_time - EPOCH) // SECOND for one in Bag(path).messages(['/a', '/b'])][-1]


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
    begun(retention, 12.0)
    assert retention.problem == ''
    retention.take(message(12), 12.0)
    retention.close()
    assert seconds_in_last(tmp_path / '20231114T221332Z') == 12


@pytest.mark.parametrize('always', [True, False])
def test_a_topic_that_comes_later_is_recorded_too(tmp_path, always):
    retention = retention_in(tmp_path, always=always)
    feed(retention, range(3), triggers=(2,), every=10)
    retention.take(topic(4, 'LATCHED'), 3.0)
    retention.take(message(3, number=4), 3.0)
    retention.close()
    (path,) = tmp_path.iterdir()
    assert [one.topic for one in Bag(path).messages(['/a', '/b'])] == ['/a'] * 3 + ['/b']


def test_a_topic_announced_while_nothing_is_written_is_known_later(tmp_path, monkeypatch):
    retention = retention_in(tmp_path)

    def refuse(*unused):
        raise OSError(errno.ENOSPC, 'No space left on device')

    with monkeypatch.context() as context:
        context.setattr(retention, '_write', refuse)
        feed(retention, [0])
    retention.take(topic(4, 'LATCHED'), 1.0)
    retention.take(snapshots(20), 20.0)
    retention.take(message(20, number=4), 20.0)
    retention.close()
    assert retention.problem == ''
    assert seconds_in_last(tmp_path / '20231114T221340Z') == 20
