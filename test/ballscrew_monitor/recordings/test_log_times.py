# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Log times of 0 are not believed where a bag tells better."""

import dataclasses
from pathlib import Path

from ballscrew_monitor.core.conversions import SECOND
from ballscrew_monitor.recordings.bag import Bag
from ballscrew_monitor.recordings.mcap_file import message_definition
from ballscrew_monitor.recordings.player import shifted
from ballscrew_monitor.recordings.replay import replay
from ballscrew_monitor.recordings.storages import Message
from ballscrew_monitor.settings.parameters import read_file
from geometry_msgs.msg import WrenchStamped
from mcap.writer import Writer
import pytest
from rclpy.serialization import serialize_message
from rosbags.rosbag2 import StoragePlugin
from rosbags.rosbag2 import Writer as RosbagWriter
from rosbags.typesys import get_typestore, Stores
from sensor_msgs.msg import JointState, Temperature
from std_msgs.msg import Float64
import zstandard

ROOT = Path(__file__).resolve().parents[3]
TYPES = {
    '/joint_states': JointState,
    '/axial_load': WrenchStamped,
    '/oil_temperature': Temperature,
}
NEAR = 0.05  # [s] by which stamps and log times of a bag differ at most
ZEROS = {
    'start': lambda at, count: at < 30,
    'middle': lambda at, count: count // 3 <= at < count // 2,
    'end': lambda at, count: at > count - 40,
    'scattered': lambda at, count: at % 7 == 3,
    'nearly_all': lambda at, count: at != count // 2,
    'all': lambda at, count: True,
}


def kind_of(message_class):
    package, _, _ = message_class.__module__.partition('.')
    return f'{package}/msg/{message_class.__name__}'


def in_mcap(folder, messages, types=TYPES):
    """Write messages in the order given by the stock writer of MCAP."""
    path = folder / 'bag.mcap'
    with path.open('wb') as stream:
        writer = Writer(stream, chunk_size=8000)
        writer.start('ros2', 'test')
        numbers = {}
        for topic, kind in ((topic, kind_of(one)) for topic, one in types.items()):
            schema = writer.register_schema(kind, 'ros2msg', message_definition(kind).encode())
            numbers[topic] = writer.register_channel(topic, 'cdr', schema)
        for one in messages:
            writer.add_message(numbers[one.topic], one.log_time, one.data, one.publish_time)
        writer.finish()
    return path


def in_sqlite(folder, messages):
    store, path = get_typestore(Stores.ROS2_JAZZY), folder / 'bag'
    with RosbagWriter(path, version=9, storage_plugin=StoragePlugin.SQLITE3) as writer:
        known = {
            topic: writer.add_connection(topic, kind_of(one), typestore=store)
            for topic, one in TYPES.items()
        }
        for one in messages:
            writer.write(known[one.topic], one.log_time, one.data)
    return path


def packed_alone(folder, messages):
    packed = [dataclasses.replace(one, data=zstandard.compress(one.data)) for one in messages]
    return in_mcap(folder, packed)


def in_two_files(folder, messages):
    half = len(messages) // 2
    for number, part in enumerate((messages[:half], messages[half:])):
        (folder / 'parts').mkdir(exist_ok=True)
        in_mcap(folder, part).rename(folder / 'parts' / f'part_{number}.mcap')
    return folder / 'parts'


@pytest.mark.parametrize('write', [in_mcap, in_sqlite, packed_alone, in_two_files])
@pytest.mark.parametrize('where', ZEROS)
def test_log_times_of_zero_give_way_to_stamps(short_bag, tmp_path, says, where, write):
    messages = list(Bag(short_bag).messages())
    count = len(messages)
    zeroed = [
        dataclasses.replace(one, log_time=0) if ZEROS[where](at, count) else one
        for at, one in enumerate(messages)
    ]
    path = write(tmp_path, zeroed)
    bag = Bag(path)
    zeros = sum(one.log_time == 0 for one in zeroed)
    assert bag.notes == [says('not_believed', bag=path, zeros=zeros, count=count)]
    assert bag.duration == pytest.approx(Bag(short_bag).duration, abs=2 * NEAR)
    read = list(bag.messages())
    times = [one.log_time for one in read]
    assert times == sorted(times)
    assert (times[0], times[-1]) == (bag.start_time, bag.end_time)
    before = {(one.topic, one.data): one.log_time for one in messages}
    late = [abs(one.log_time - before[one.topic, one.data]) for one in read]
    assert len(read) == count
    assert max(late) < NEAR * SECOND
    assert [one.data for one in bag.as_written()] == [one.data for one in messages]


@pytest.mark.parametrize('where', ['start', 'middle', 'all'])
def test_a_bag_with_log_times_of_zero_is_judged_as_far_as_without(short_bag, tmp_path, where):
    values = read_file(ROOT / 'config' / 'nominal_cycle.yaml')
    messages = list(Bag(short_bag).messages())
    zeroed = [
        dataclasses.replace(one, log_time=0) if ZEROS[where](at, len(messages)) else one
        for at, one in enumerate(messages)
    ]
    states, sound = (
        [state for state, _ in replay(Bag(path), values)]
        for path in (in_mcap(tmp_path, zeroed), short_bag)
    )
    assert len(states) == pytest.approx(len(sound), abs=3)
    last, usual = ({one.zone for one in every[-20:]} for every in (states, sound))
    assert last == usual


@pytest.mark.parametrize('write', [in_mcap, in_sqlite, in_two_files])
@pytest.mark.parametrize('where', ['start', 'middle', 'scattered'])
@pytest.mark.parametrize('early', [1, 90 * SECOND, 300 * 86400 * SECOND])
def test_log_times_near_zero_give_way_to_stamps(short_bag, tmp_path, says, where, write, early):
    """A computer without a clock of its own begins at 1970, or when it was built."""
    messages = list(Bag(short_bag).messages())
    begin, count = messages[0].log_time, len(messages)
    wrong = [
        dataclasses.replace(one, log_time=one.log_time - begin + early)
        if ZEROS[where](at, count)
        else one
        for at, one in enumerate(messages)
    ]
    path = write(tmp_path, wrong)
    bag = Bag(path)
    number = sum(one.log_time < begin for one in wrong)
    assert bag.notes == [says('near_zero', bag=path, wrong=number, count=count)]
    assert bag.duration == pytest.approx(Bag(short_bag).duration, abs=2 * NEAR)
    before = {(one.topic, one.data): one.log_time for one in messages}
    late = [abs(one.log_time - before[one.topic, one.data]) for one in bag.messages()]
    assert len(late) == count
    assert max(late) < NEAR * SECOND


@pytest.mark.parametrize('early', [5 * SECOND, 946_684_800 * SECOND])
def test_a_bag_whose_clock_was_set_with_its_stamps_is_refused(tmp_path, refused, early):
    """A clock that begins at 1970 or 2000 stamps so as well."""
    times = [early, early + SECOND, 1_767_600_000 * SECOND]
    path = without_stamps(tmp_path, [(time, time) for time in times])
    with refused('ten_years', bag=path, first=early // SECOND):
        Bag(path)


def test_ten_years_are_allowed(tmp_path):
    times = [SECOND, round(10 * 365.25 * 86400) * SECOND + SECOND]
    path = without_stamps(tmp_path, [(time, time) for time in times])
    assert [one.log_time for one in Bag(path).messages()] == times


def test_a_time_of_zero_is_right_where_simulated_time_begins(short_bag, tmp_path):
    begin = Bag(short_bag).start_time
    messages = [
        dataclasses.replace(
            one,
            log_time=one.log_time - begin,
            data=bytes(shifted(one.data, TYPES[one.topic], -begin)),
        )
        for one in Bag(short_bag).messages()
    ]
    bag = Bag(in_mcap(tmp_path, messages))
    assert not bag.notes
    assert [one.log_time for one in bag.messages()] == [one.log_time for one in messages]


def without_stamps(folder, times):
    """Write messages that hold no stamp, by log and publish times [ns]."""
    messages = [
        Message(
            topic='/a',
            data=serialize_message(Float64(data=float(at))),
            log_time=log_time,
            publish_time=publish_time,
        )
        for at, (log_time, publish_time) in enumerate(times)
    ]
    return in_mcap(folder, messages, {'/a': Float64})


def test_without_stamps_the_times_of_publishing_count(tmp_path):
    path = without_stamps(tmp_path, [(0, 7 * SECOND), (0, 8 * SECOND), (9 * SECOND, 9 * SECOND)])
    assert [one.log_time for one in Bag(path).messages()] == [7 * SECOND, 8 * SECOND, 9 * SECOND]


def test_a_message_without_any_time_comes_with_the_one_before(tmp_path):
    path = without_stamps(tmp_path, [(0, 0), (8 * SECOND, 0), (0, 0), (9 * SECOND, 0)])
    times = [one.log_time for one in Bag(path).messages()]
    assert times == [8 * SECOND, 8 * SECOND, 8 * SECOND, 9 * SECOND]


def test_a_bag_without_any_time_is_refused(tmp_path, refused):
    path = without_stamps(tmp_path, [(0, 0)] * 3)
    with refused('no_time', bag=path):
        Bag(path)
