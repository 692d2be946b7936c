# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The replay without DDS: order, ticks, and the sentences for bags it cannot judge."""

import itertools
from pathlib import Path

from ballscrew_monitor.core.fields import stamp_of
from ballscrew_monitor.core.inputs import InputState
from ballscrew_monitor.recordings.bag import Bag
from ballscrew_monitor.recordings.bag_writer import BagWriter, Offer, Topic
from ballscrew_monitor.recordings.bulk.decode import silence
from ballscrew_monitor.recordings.bulk.order import LONGEST_HOLE
from ballscrew_monitor.recordings.replay import replay, speed_messages
from ballscrew_monitor.settings import parameters
from ballscrew_monitor.settings.axis import build_axis
from geometry_msgs.msg import WrenchStamped
import pytest
from rclpy.serialization import serialize_message
from sensor_msgs.msg import JointState
from surrogate.files import InputError

CONFIG = Path(__file__).resolve().parents[3] / 'config' / 'nominal_cycle.yaml'
SECOND = 10**9
BEGIN = 100 * SECOND


@pytest.fixture
def values():
    return parameters.read_file(CONFIG)


def speed_message(stamp, speed, *, joint='x_axis'):
    message = JointState(name=[joint], velocity=[speed])
    message.header.stamp.sec, message.header.stamp.nanosec = divmod(stamp, SECOND)
    return '/joint_states', message


def load_message(stamp, load):
    message = WrenchStamped()
    message.wrench.force.x = load
    message.header.stamp.sec, message.header.stamp.nanosec = divmod(stamp, SECOND)
    return '/axial_load', message


def write(directory, *timed):
    with BagWriter(directory, 'bag') as writer:
        for name, kind in (
            ('/joint_states', 'sensor_msgs/msg/JointState'),
            ('/axial_load', 'geometry_msgs/msg/WrenchStamped'),
        ):
            writer.add_topic(Topic(name=name, type_name=kind, offer=Offer.SENSOR))
        for log_time, (topic, message) in timed:
            writer.write(
                topic, serialize_message(message), log_time=log_time, publish_time=log_time
            )
    return Bag(directory)


def every_state():
    return parameters.defaults(['x']) | {'x.publish_period': 0.0}


def judged(bag, **changes):
    values = every_state() | changes
    return [
        (stamp_of(state), state.point.speed, state.point.axial_load, state.judged)
        for state, _ in replay(bag, values)
    ]


def test_samples_are_taken_by_stamp_and_the_load_before_the_speed(tmp_path):
    times = [BEGIN + 10_000_000 * number for number in range(3)]
    bag = write(
        tmp_path,
        # Arrival: the speed before the load of the same stamp, and the second pair last.
        (times[0], speed_message(times[0], 10.0)),
        (times[0] + 1, load_message(times[0], -1.0)),
        (times[2], speed_message(times[2], 30.0)),
        (times[2] + 1, load_message(times[2], -3.0)),
        (times[2] + 2, speed_message(times[1], 20.0)),
        (times[2] + 3, load_message(times[1], -2.0)),
    )
    expected = [(times[0], 10.0, -1.0, 1), (times[1], 20.0, -2.0, 2), (times[2], 30.0, -3.0, 3)]
    assert judged(bag) == expected


def test_the_end_of_the_data_is_seen_on_the_grid_of_ticks(tmp_path):
    begin = BEGIN + 30_000_000
    bag = write(
        tmp_path,
        (begin, load_message(begin, -1000.0)),
        (begin, speed_message(begin, 100.0)),
        (begin + SECOND, load_message(begin + SECOND, -1000.0)),
    )
    states = [(stamp_of(state), state.inputs[0].state) for state, _ in replay(bag, every_state())]
    # The speed is stale after 0.5 s: ticks from 0.6 s after the second on, every 0.1 s.
    ticks = [BEGIN + 100_000_000 * number for number in range(6, 11)]
    assert states == [(begin, InputState.OK), *((tick, InputState.STALE) for tick in ticks)]


def test_stamps_on_another_clock_do_not_move_the_ticks(tmp_path):
    times = [BEGIN + 10_000_000 * number for number in range(40)]
    bag = write(
        tmp_path,
        *((time, load_message(time, -1000.0)) for time in times),
        *(
            (time, speed_message(10**9 if number == 20 else time, 100.0))
            for number, time in enumerate(times)
        ),
    )
    states = [stamp_of(state) for state, _ in replay(bag, every_state())]
    assert sorted(states) == [10**9, *times[:20], *times[21:]]


@pytest.mark.parametrize('far', [1, 10**19])
def test_a_hole_is_not_filled_with_ticks_for_ever(tmp_path, far):
    bag = write(
        tmp_path,
        (BEGIN, load_message(BEGIN, -1000.0)),
        (BEGIN, speed_message(BEGIN, 100.0)),
        (far, load_message(BEGIN, -1000.0)),
    )
    states = [stamp_of(state) for state, _ in replay(bag, every_state())]
    assert BEGIN in states
    assert len(states) <= 1 + LONGEST_HOLE // 100_000_000


def test_the_same_bag_gives_the_same_states_one_for_each_sample_of_the_speed(short_bag, values):
    def run():
        return [str(state) for state, _ in replay(Bag(short_bag), values)]

    assert run() == run()
    bag = Bag(short_bag)
    counts = [state.judged for state, _ in replay(bag, values)]
    assert counts == list(range(1, bag.topics['/joint_states'].count + 1))


def test_events_come_with_the_state_that_begins_or_ends_them(nominal_bag, values):
    edges = [
        (event.event_id, event.active, stamp_of(event) == stamp_of(state))
        for state, event in replay(Bag(nominal_bag), values)
        if event is not None
    ]
    assert edges == [
        (number, active, True) for number, active in itertools.product((1, 2, 3), (True, False))
    ]


def test_a_bag_without_a_needed_topic_is_refused(tmp_path, values, refused):
    bag = write(tmp_path, (BEGIN, speed_message(BEGIN, 1.0)), (BEGIN, load_message(BEGIN, 1.0)))
    with refused('topic_oil_temperature'):
        next(replay(bag, values))


def test_messages_of_other_joints_are_not_counted(tmp_path):
    values = parameters.defaults(['x'])
    bag = write(
        tmp_path,
        (BEGIN, speed_message(BEGIN, 1.0)),
        (BEGIN + 1, speed_message(BEGIN + 1, 1.0, joint='y_axis')),
    )
    assert speed_messages(bag, [build_axis('x', values)]) == {'x': 1}


def test_an_empty_type_is_that_of_the_bag(tmp_path, refused):
    messages = [(BEGIN, load_message(BEGIN, 1.0)), (BEGIN + 1, speed_message(BEGIN + 1, 1.0))]
    bag = write(tmp_path, *messages)
    assert repr(judged(bag, **{'x.speed.type': '', 'x.load.type': ''})) == repr(judged(bag))
    refused('topic_nope_any', judged, bag, **{'x.speed.type': '', 'x.speed.topic': 'nope'})


@pytest.mark.parametrize(
    'damage',
    [lambda data: b'', lambda data: data[:21], lambda data: data[:4] + b'\xff' * len(data)],
    ids=['empty', 'truncated', 'garbage'],
)
def test_what_does_not_decode_is_refused_and_the_rest_judged(damage, copy_bag, tmp_path, says):
    times = [BEGIN + 10_000_000 * number for number in range(5)]
    bag = write(
        tmp_path / 'whole',
        *((time, load_message(time, -1000.0)) for time in times),
        *((time, speed_message(time, 100.0)) for time in times),
    )
    speed = 'sensor_msgs/msg/JointState'

    def damaged(message):
        bad = message.log_time in times[2:4] and message.topic == '/joint_states'
        return damage(message.data) if bad else message.data

    bad = copy_bag(bag, tmp_path / 'bad', damaged)
    states = [state for state, _ in replay(bad, every_state())]
    assert states[-1].judged == 3
    assert states[-1].inputs[0].dropped == 2
    assert bad.refused['/joint_states'][0] == 2
    text = bad.notes[0]
    assert says('message_joint_states_0', speed=speed) in text
    assert text.endswith('; 2 such messages were refused')
    assert speed_messages(bad, [build_axis('x', every_state())]) == {'x': 3}


def test_the_joints_that_are_there_are_named_instead_of_a_wrong_one(tmp_path, says):
    bag = write(
        tmp_path,
        (BEGIN, load_message(BEGIN, -1000.0)),
        (BEGIN, speed_message(BEGIN, 100.0, joint='b')),
        (BEGIN + 1, speed_message(BEGIN, 100.0, joint='a')),
    )
    axis = build_axis('x', every_state())
    nothing = 'no message of /joint_states holds the speed of axis x'
    with pytest.raises(InputError, match=f'{nothing}.*they name a, b and no joint x_axis'):
        speed_messages(bag, [axis])
    assert says('name_b_joint') in silence(bag, axis)


def test_an_input_that_is_slower_than_its_timeout_is_named(tmp_path, says):
    times = [BEGIN + 2 * SECOND * number for number in range(5)]
    bag = write(
        tmp_path,
        *((time, load_message(time, -1000.0)) for time in times),
        *((time, speed_message(time, 100.0)) for time in times),
    )
    text = silence(bag, build_axis('x', every_state()))
    assert says('load_comes_less') in text
    fast = every_state() | {'x.speed.timeout': 5.0, 'x.load.timeout': 5.0}
    assert silence(bag, build_axis('x', fast)) == ''


def test_two_axes_come_in_the_order_of_their_samples(tmp_path):
    times = [BEGIN + 10_000_000 * number for number in range(5)]
    both = {'axes': ['x', 'y']}
    names = parameters.defaults(['x', 'y']) | both | {'y.publish_period': 0.0}
    bag = write(
        tmp_path,
        *((time, load_message(time, -1000.0)) for time in times),
        *((time + 1, speed_message(time, 100.0)) for time in times),
        *((time + 2, speed_message(time, 50.0, joint='y_axis')) for time in times),
    )
    found = [
        (stamp_of(state), state.axis)
        for state, _ in replay(bag, names | {'x.publish_period': 0.0})
    ]
    assert found == [(time, axis) for time in times for axis in ('x', 'y')]
