# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The messages of a turn as an array: the events that they give one by one, in the same order."""

import dataclasses
import itertools
import math
import random
import struct
import types
from types import MappingProxyType

from ballscrew_monitor.core.conversions import SECOND
from ballscrew_monitor.core.inputs import ordered, Why
from ballscrew_monitor.judge.many import ManyJudge
from ballscrew_monitor.judge.monitor import fill
from ballscrew_monitor.judge.records import EVENT, Event, REFUSAL, Row, SAMPLE
from ballscrew_monitor.messages.state_messages import empty_state, fill_state
from ballscrew_monitor.node.axis_publisher import AxisPublisher
from ballscrew_monitor.node.burst import Burst
from ballscrew_monitor.node.freeze_frame import FreezeFrame
from ballscrew_monitor.node.intake import _events
from ballscrew_monitor.node.node import BallscrewMonitor
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
OF_EACH_ROW = (*Row.__slots__, 'validity', 'rcs', 'efficiency', 'friction_torque', 'film_ratio')
"""Fields that a row has whether it is published or not."""


DERIVED = {
    'x.load.source': 'motor_torque',
    'x.inertia': 1e-3,
    'x.torque.uncertainty': 0.05,
    'x.torque.topic': SHARED,
    'x.torque.field': 'effort[x]',
    'x.torque.type': 'sensor_msgs/msg/JointState',
}


def make_axis(name, more=MappingProxyType({})):
    values = defaults([name]) | {
        f'{name}.speed.topic': SHARED,
        f'{name}.speed.field': f'velocity[{name}]',
        f'{name}.load.topic': f'/{name}/load',
        f'{name}.limits.raise_delay': 0.1,
        f'{name}.limits.clear_delay': 0.1,
    }
    if more:
        values[f'{name}.load.topic'] = ''
    return build_axis(name, values | more)


class Inputs:
    """Two axes whose speeds share a topic, and messages to them."""

    def __init__(self, publishers=1, more=MappingProxyType({})):
        self.axes = [make_axis('x', more), make_axis('y')]
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

    def reader(self, reading):
        return TurnReader(self.axes, lambda one: self.one_by_one(one, reading))

    def turn(self, heard, reading):
        return self.reader(reading).turn(Burst.of(heard), reading)

    def events(self, heard, reading):
        """Return what the messages say one by one, in the order of judging."""
        return ordered([event for one in heard for event in self.one_by_one(one, reading)])


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


def same(turn, events):
    """Return the records of events, after it is found that a turn has the same."""
    records, numbers, named = records_of(events)
    assert turn.events.tobytes() == records.tobytes()
    assert turn.numbers.tolist() == numbers
    assert turn.joints == named
    return records


@pytest.mark.parametrize('ahead', [0, 10 * SECOND])
@pytest.mark.parametrize('publishers', [1, 2])
@pytest.mark.parametrize('seed', range(3))
def test_events_are_those_of_the_messages_one_by_one(seed, publishers, ahead):
    inputs, others = Inputs(publishers), Inputs(publishers)
    several = frozenset({('x', source.source) for source in inputs.axes[0].inputs})
    reading = Reading(ahead, several if publishers > 1 else frozenset())
    turn = inputs.turn(random_messages(inputs, seed), reading)
    messages = random_messages(others, seed)
    records = same(turn, others.events(messages, reading))
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


def damaged(data, draw):
    """Return the bytes of a message cut off, lengthened, changed, or of another encapsulation."""
    at = draw.randrange(len(data))
    after = at + 1
    return draw.choice(
        [
            data[:at],
            data + bytes(draw.randrange(1, 9)),
            data[:at] + bytes([draw.choice([0, 1, 0x7F, 0x80, 0xFF])]) + data[after:],
            bytes([0, draw.choice([0, 2, 3, 6, 7, 10]), 0, draw.randrange(4)]) + data[4:],
            data,
        ]
    )


@pytest.mark.parametrize('seed', range(3))
def test_damaged_messages_say_in_a_turn_what_they_say_one_by_one(seed):
    """Also those that stand before and after them in the turn."""
    inputs, others, draw = Inputs(), Inputs(), random.Random(seed)
    whole = {
        SHARED: serialize_message(joints(x=1.5, y=-2.5, longer_name=3.5)),
        '/x/load': serialize_message(load(-1000.0)),
    }
    messages = [(name, damaged(whole[name], draw)) for _ in range(300) for name in whole]
    messages.append((SHARED, b''))
    turn = inputs.turn([inputs.heard(*each) for each in messages], Reading())
    events = others.events([others.heard(*each) for each in messages], Reading())
    records = same(turn, events)
    assert {*records['kind'].tolist()} == {SAMPLE, REFUSAL}
    assert {Why.NOT_DECODED, Why.OTHER_JOINTS} <= {*records['why'].tolist()}


def big_endian(*speeds):
    """Return a JointState with joints x, y, ... as a machine of the other byte order sends it."""
    parts = bytearray()

    def put(code, *numbers):
        parts.extend(bytes(-len(parts) % struct.calcsize(f'>{code}')))
        parts.extend(struct.pack(f'>{len(numbers)}{code}', *numbers))

    put('I', *divmod(NOW, SECOND), 1)
    parts.append(0)  # frame_id
    put('I', len(speeds))
    for name in 'xyz'[: len(speeds)]:
        put('I', 2)
        parts.extend(name.encode() + b'\0')
    put('I', 0)  # positions
    put('I', len(speeds))
    put('d', *speeds)
    put('I', 0)  # efforts
    return bytes(4) + bytes(parts)


def test_both_byte_orders_and_orders_of_names_are_read_within_one_turn():
    inputs = Inputs()
    messages = [joints(x=1.0, y=2.0), joints(y=4.0, x=3.0), big_endian(5.0, 6.0)]
    messages += [joints(z=0.0, y=8.0, x=7.0), joints(x=9.0, y=10.0)]
    first, second = inputs.turn(
        [inputs.heard(SHARED, each) for each in messages], Reading()
    ).by_axis()
    assert first.events['value'].tolist() == [1.0, 3.0, 5.0, 7.0, 9.0]
    assert second.events['value'].tolist() == [2.0, 4.0, 6.0, 8.0, 10.0]


def test_slots_are_made_once_whichever_topics_have_messages():
    """In simulated time a turn has what came within one step of `/clock`."""
    inputs, made = Inputs(), set()
    reader = inputs.reader(Reading())
    messages = {SHARED: joints(x=1.0, y=2.0), '/x/load': load(3.0), '/y/load': load(4.0)}
    for names in itertools.permutations(messages):
        for count in range(1, 4):
            heard = [inputs.heard(name, messages[name]) for name in itertools.islice(names, count)]
            burst = Burst.of(heard, inputs.topics.values())
            turn = reader.turn(burst, Reading())
            assert repr(turn.events) == repr(inputs.turn(heard, Reading()).events)
            made.add(reader._slots)
    assert len(made) == 1


def test_a_reader_follows_what_changes_between_turns():
    """Publishers that come and go, a parameter, and an axis that begins to read a topic."""

    def several(inputs, publishers):
        inputs.topics[SHARED].loss.match(publishers)

    def more_future(inputs):
        for axis in inputs.axes:
            axis.monitor.settings = dataclasses.replace(
                axis.monitor.settings, max_future=60 * SECOND
            )

    def another_reader(inputs):
        y_load = inputs.topics['/y/load']
        y_load.readers.append((inputs.axes[0], y_load.readers[0][1]))

    changes = [
        lambda inputs: None,
        lambda inputs: several(inputs, 2),
        lambda inputs: several(inputs, 1),
        more_future,
        lambda inputs: several(inputs, 0),
        another_reader,
    ]
    inputs, others, counts = Inputs(), Inputs(), []
    reader = inputs.reader(Reading())
    for seed, change in enumerate(changes):
        for each in (inputs, others):
            change(each)
        turn = reader.turn(Burst.of(random_messages(inputs, seed)), Reading())
        same(turn, others.events(random_messages(others, seed), Reading()))
        why = turn.events['why'][turn.events['kind'] == REFUSAL]
        counts.append(int((why == Why.FUTURE).sum()))
        for name, topic in inputs.topics.items():
            found, wanted = (
                {key: counter.several for key, counter in one.sources.items()}
                for one in (topic, others.topics[name])
            )
            assert found == wanted
    assert min(counts[:3]) > 0
    assert max(counts[3:]) == 0


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
    burst = Burst.of([inputs.heard('/x/load', load(1.0))])
    turn = TurnReader(inputs.axes, lambda one: []).turn(burst, Reading())
    assert len(turn.events) == 0
    assert turn.by_axis() == []


class Spoken:
    """What a node does with the rows of an axis, with a node's own way to judge."""

    guarded = AxisPublisher.guarded

    def __init__(self, axis):
        self.axis, self.name, self.frame = axis, axis.name, FreezeFrame()
        self.many = ManyJudge(axis.monitor, 8)
        self.states, self.rows, self.leaps, self.log = [], [], [], []
        self.unspeakable = set()  # numbers of states that cannot be published
        self.defect, self.failed = '', False
        logger = types.SimpleNamespace(error=self.log.append)
        self._node = types.SimpleNamespace(get_logger=lambda: logger)
        self.may_note_leap = lambda: True
        self._healths = types.SimpleNamespace(
            take_many=lambda _, rows: self.rows.extend(rows[[*OF_EACH_ROW]].tolist())
        )
        self._kept = types.SimpleNamespace(note=lambda *_, by_s, **__: self.leaps.append(by_s))
        self._note_leap = lambda publisher: BallscrewMonitor._note_leap(self, publisher)

    def judge_each(self, event):
        BallscrewMonitor._judge_one(self, self, self.axis.monitor.update, event)
        if self.axis.monitor.row is not None:
            self.rows += as_array(self.axis.monitor.row)[[*OF_EACH_ROW]].tolist()

    def judge_many(self, turn):
        BallscrewMonitor._judge_many(self, self, turn)

    def _publish(self, publisher, row):
        if row is not None:
            state = empty_state(self.name)
            inputs = fill_state(state, row, self.axis.monitor)
            frame = self.frame.facts(row.stamp) if row.edge else {}
            ending = self.axis.monitor.ending
            self.states.append(repr((state, inputs, frame, ending)))
            if len(self.states) in self.unspeakable:
                raise ZeroDivisionError


def machine_turn(inputs, draw, number):
    """Return the messages of 20 ms of a machine that is slow at times, stops and goes wrong."""
    heard = []
    for at in range(4):
        now = NOW + (4 * number + at) * SECOND // 200
        stamp = now - 1000
        if number > 150:
            stamp += 10 * SECOND  # a leap of the source
        speed = 0.6 if number % 60 > 20 else 100.0
        message = joints(stamp, x=speed, y=speed)
        message.effort = [3.0, 3.0]
        odd = draw.random()
        if odd < 0.02:
            message.velocity[draw.randrange(2)] = math.nan
        elif odd < 0.04:
            message.name = ['z', 'y']
        for name in inputs.topics:
            if name != SHARED and draw.random() < 0.9:
                heard.append(inputs.heard(name, load(-1000.0, stamp), now, 0, 1))
        lost = draw.choice([0] * 20 + [2])
        if number % 70 < 55:  # a hole after that
            heard.append(inputs.heard(SHARED, message, now, lost, 1))
    return heard


@pytest.mark.parametrize('more', [MappingProxyType({}), DERIVED], ids=['measured', 'derived'])
def test_states_and_rows_are_the_same_judged_one_by_one_and_compiled(more):
    """With warnings, holes, refusals, other joints, a clock that is set, and stamps that leap."""
    ways = []
    for way in ('each', 'many'):
        inputs, draw = Inputs(more=more), random.Random(1)
        spoken = {axis.name: Spoken(axis) for axis in inputs.axes}
        reading = Reading(20 * SECOND)
        for number in range(200):
            heard = machine_turn(inputs, draw, number)
            if number in (40, 90):
                for axis in inputs.axes:
                    axis.monitor.set_clock(NOW + number * SECOND // 50, NOW + SECOND * 7)
            if way == 'many':
                for part in inputs.turn(heard, reading).by_axis():
                    spoken[part.axis.name].judge_many(part)
            else:
                for axis, event in inputs.events(heard, reading):
                    spoken[axis.name].judge_each(event)
        ways.append(spoken)
    each, many = ways
    for name, wanted in each.items():
        assert repr(many[name].states) == repr(wanted.states)
        assert repr(many[name].rows) == repr(wanted.rows)
        assert many[name].leaps == wanted.leaps
        left, right = (spoken[name].axis.monitor for spoken in ways)
        assert as_array(left.memory).tobytes() == as_array(right.memory).tobytes()
        assert left.memory.event_number > 1
    assert each['y'].leaps == [10.0]


def test_a_state_that_cannot_be_published_leaves_the_rest_of_its_turn():
    """The same is judged and said as where all states can be; the first failure is logged."""
    ways = []
    for unspeakable in (set(), {3, 20}):
        inputs = Inputs(more={'x.publish_period': 0.0, 'x.load.topic': '/x/load'})
        spoken, draw = Spoken(inputs.axes[0]), random.Random(2)
        spoken.unspeakable = unspeakable
        heard = [one for number in range(15, 30) for one in machine_turn(inputs, draw, number)]
        spoken.judge_many(inputs.turn(heard, Reading()).by_axis()[0])
        ways.append(spoken)
    sound, broken = ways
    assert len(sound.states) > 40
    assert broken.states == sound.states
    assert repr(broken.rows) == repr(sound.rows)
    assert broken.frame.facts(NOW + SECOND) == sound.frame.facts(NOW + SECOND)
    memories = [as_array(way.axis.monitor.memory).tobytes() for way in ways]
    assert memories[0] == memories[1]
    assert sound.log == []
    assert len(broken.log) == 1
    assert f'axis x: {broken.defect}' in broken.log[0]
