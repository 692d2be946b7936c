# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The messages of a turn as an array: the events that they give one by one, in the same order."""

import math
import random
import types

from ballscrew_monitor.core.conversions import SECOND
from ballscrew_monitor.core.inputs import ordered, Why
from ballscrew_monitor.judge.monitor import fill
from ballscrew_monitor.judge.records import EVENT, Event, REFUSAL
from ballscrew_monitor.node.intake import _events
from ballscrew_monitor.node.sources import LossCounter, Reading
from ballscrew_monitor.node.topic import Arrival, Topic, UNREAD
from ballscrew_monitor.node.turn import TurnReader
from ballscrew_monitor.settings.axis import build_axis
from ballscrew_monitor.settings.parameters import defaults
from geometry_msgs.msg import WrenchStamped
import numpy as np
import pytest
from rclpy.serialization import serialize_message
from sensor_msgs.msg import JointState
from surrogate.surface.records import as_array

NOW = 1_000 * SECOND
SHARED = '/joint_states'


def make_axis(name):
    values = defaults([name]) | {
        f'{name}.speed.topic': SHARED,
        f'{name}.speed.field': f'velocity[{name}]',
        f'{name}.load.topic': f'/{name}/load',
    }
    return build_axis(name, values)


class Inputs:
    """Two axes whose speeds share a topic, and messages to them."""

    def __init__(self, publishers=1):
        self.axes = [make_axis(name) for name in 'xy']
        self.topics = {}
        for axis in self.axes:
            for source in axis.inputs:
                topic = self.topics.setdefault(source.topic, self._topic(source, publishers))
                topic.readers.append((axis, source))

    @staticmethod
    def _topic(source, publishers):
        loss = LossCounter()
        loss.match(publishers)
        subscription = types.SimpleNamespace(raw=True, msg_type=source.message_type)
        return Topic(name=source.topic, readers=[], loss=loss, subscription=subscription)

    def heard(self, name, message, now=NOW, lost=0, number=1):
        data = message if isinstance(message, bytes) else serialize_message(message)
        return Arrival(now, UNREAD, number, self.topics[name], data), now, lost

    def one_by_one(self, heard, reading):
        """Return what one message says, and count of which inputs it gives samples."""
        events = _events(*heard, reading)
        for axis, event in events:
            heard[0].topic.count((axis.name, event.source), heard[0].number, heard[1])
        return events

    def turn(self, heard, reading):
        reader = TurnReader(self.axes, lambda one: self.one_by_one(one, reading))
        return reader.turn(heard, reading)


def stamped(message, stamp):
    message.header.stamp.sec, message.header.stamp.nanosec = divmod(stamp, SECOND)
    return message


def joints(stamp=NOW, **speeds):
    return stamped(JointState(name=[*speeds], velocity=[*speeds.values()]), stamp)


def load(force, stamp=NOW):
    message = stamped(WrenchStamped(), stamp)
    message.wrench.force.x = force
    return message


def random_messages(inputs, seed):
    """Return messages with all that may be wrong with one."""
    draw = random.Random(seed)
    heard = []
    for number in range(1, 200):
        now = draw.choice([NOW, NOW + number * 1000, 0])
        stamp = draw.choice([now, now - 1000 * draw.randrange(5), 0, NOW, NOW + 9 * SECOND])
        stamp = draw.choice([stamp] * 20 + [-SECOND, NOW + 10**17])
        value = draw.choice([1.5, -0.0, draw.uniform(-200.0, 200.0), math.nan, math.inf, 5e-324])
        message = draw.choice(
            [
                joints(stamp, x=value, y=2.0),
                joints(stamp, x=value),
                joints(stamp, z=value, y=value),
                stamped(JointState(name=['x', 'y'], velocity=[]), stamp),
                b'\0\1\0\0',
                load(value, stamp),
                load(value, stamp),
            ]
        )
        is_load = isinstance(message, WrenchStamped)
        name = draw.choice(['/x/load', '/y/load']) if is_load else SHARED
        lost = draw.choice([0, 0, 3, None])
        heard.append(inputs.heard(name, message, now, lost, draw.choice([number, 0])))
    return heard


def records_of(events):
    """Return events as an array, the numbers of their axes, and the joints that they name."""
    records = np.zeros(len(events), EVENT)
    for at, (_, event) in enumerate(events):
        record = Event()
        fill(record, event)
        records[at] = as_array(record)[0]
    named = {at: getattr(event, 'joints', None) for at, (_, event) in enumerate(events)}
    named = {at: one for at, one in named.items() if one is not None}
    return records, ['xy'.index(axis.name) for axis, _ in events], named


@pytest.mark.parametrize('ahead', [0, 10 * SECOND])
@pytest.mark.parametrize('publishers', [1, 2])
@pytest.mark.parametrize('seed', range(3))
def test_events_are_those_of_the_messages_one_by_one(seed, publishers, ahead):
    inputs, others = Inputs(publishers), Inputs(publishers)
    several = frozenset({('x', source.source) for source in inputs.axes[0].inputs})
    reading = Reading(ahead, several if publishers > 1 else frozenset())
    turn = inputs.turn(random_messages(inputs, seed), reading)
    messages = random_messages(others, seed)
    events = ordered([event for one in messages for event in others.one_by_one(one, reading)])
    records, numbers, named = records_of(events)
    assert turn.events.tobytes() == records.tobytes()
    assert turn.numbers.tolist() == numbers
    assert turn.joints == named
    assert {int(why) for why in records['why'][records['kind'] == REFUSAL]} >= {
        Why.OTHER_JOINTS,
        Why.NOT_A_NUMBER,
        Why.TOO_SHORT,
        Why.NEGATIVE,
        Why.NOT_DECODED,
    }
    for name, topic in inputs.topics.items():
        other = others.topics[name].sources
        assert {key: one.several for key, one in topic.sources.items()} == {
            key: one.several for key, one in other.items()
        }


def test_each_axis_has_its_events_and_the_joints_that_these_name():
    inputs = Inputs()
    heard = [
        inputs.heard(SHARED, joints(x=1.0, y=2.0)),
        inputs.heard('/y/load', load(3.0)),
        inputs.heard(SHARED, joints(NOW + 1, z=1.0)),
        inputs.heard(SHARED, joints(NOW + 2, x=4.0)),
    ]
    first, second = inputs.turn(heard, Reading()).by_axis()
    assert (first.axis, second.axis) == tuple(inputs.axes)
    assert first.events['value'][[0, 2]].tolist() == [1.0, 4.0]
    assert second.events['value'][:2].tolist() == [3.0, 2.0]  # the speed last
    assert {at: one.names for at, one in first.joints.items()} == {1: ('z',)}
    assert {at: one.names for at, one in second.joints.items()} == {2: ('z',), 3: ('x',)}


def test_nothing_comes_of_messages_that_the_program_fails_at():
    inputs = Inputs(publishers=2)
    turn = TurnReader(inputs.axes, lambda one: []).turn(
        [inputs.heard('/x/load', load(1.0))], Reading()
    )
    assert len(turn.events) == 0
    assert turn.by_axis() == []
