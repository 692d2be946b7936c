# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""A recording of a node gives the states of the node again, bit for bit, wherever it begins."""

import contextlib
import dataclasses
import itertools
import json
from pathlib import Path
import random
import re
import shutil
import types

from ballscrew_monitor.core.conversions import SECOND
from ballscrew_monitor.core.full_point import SolvedAt
from ballscrew_monitor.core.inputs import InputSample, Source
from ballscrew_monitor.judge import dump
from ballscrew_monitor.judge.records import MEMORY_VERSION
from ballscrew_monitor.node import journal
from ballscrew_monitor.node.intake import _events, ordered
from ballscrew_monitor.node.journal import Journal
from ballscrew_monitor.node.sources import Reading
from ballscrew_monitor.node.topic import Arrival
from ballscrew_monitor.recordings.axis_run import TimedState
from ballscrew_monitor.recordings.bag import Bag
from ballscrew_monitor.recordings.log_facts import values_for
from ballscrew_monitor.recordings.own_recording import (
    is_as_recorded,
    journal_of,
    OTHER_VERSION,
    recorded_values,
)
from ballscrew_monitor.recordings.replay import replay, replay_parts
from ballscrew_monitor.recordings.retention import KeepSettings, Retention
from ballscrew_monitor.report.inputs_seen import inputs_seen
from ballscrew_monitor.report.judging import judge_log
from ballscrew_monitor.report.parameters import LogParameters
from ballscrew_monitor.settings import parameters
from ballscrew_monitor.settings.axis import build_axis
from geometry_msgs.msg import WrenchStamped
from hypothesis import example, given
from hypothesis import strategies as st
import pytest
from rclpy.serialization import deserialize_message, serialize_message
from sensor_msgs.msg import JointState
from std_msgs.msg import String
from surrogate.files import InputError
from surrogate.surface import FIELDS

BEGIN = 1_700_000_000 * SECOND
TOPICS = {'speed': '/mill/joint_states', 'load': '/mill/axial_load'}
ALWAYS = KeepSettings(always=True, before=60.0, after=10.0, longest=1e9, largest=1e9, total=1e12)


class KeptFrames:
    """Stands for the process that records: it keeps the frames at once."""

    problem, lost = '', False

    def __init__(self, folder, settings=ALWAYS):
        self.retention = Retention(folder, settings)
        self.now = 0.0
        self.room = True

    def put(self, frame):
        if self.room:
            self.retention.take(frame, self.now)
        return self.room

    def flush(self):
        return self.room

    def close(self):
        self.retention.close()


class SmallNode:
    """Does with two axes what the node does with messages and ticks, and says states."""

    def __init__(self, folder, settings=ALWAYS, *, now=BEGIN, **changes):
        self.values = parameters.defaults(['x', 'z']) | {
            'x.publish_period': 0.0,
            'z.publish_period': 0.25,
            'z.limits.raise_delay': 0.0,
            'x.limits.raise_delay': 0.0,
            'x.limits.clear_delay': 0.1,
            **changes,
        }
        self.axes = {name: build_axis(name, self.values) for name in ('x', 'z')}
        self.process = KeptFrames(folder, settings)
        self.journal = Journal('/mill/ballscrew_monitor/journal', lambda: self.process)
        self.said = []
        self.now, self.reading = now, Reading()
        self.describe('begin')

    def describe(self, because, names=('x', 'z')):
        for name in names:
            self.journal.describe(self.axes[name], self.values, TOPICS, because, self.now)

    def hear(self, *messages, lost=0):
        """Take a burst of pairs of an input and a message."""
        batch = []
        for source, message in messages:
            readers = [
                (axis, one)
                for axis in self.axes.values()
                for one in axis.inputs
                if one.source.name.lower() == source
            ]
            data = serialize_message(message)
            topic = types.SimpleNamespace(
                name=TOPICS[source], readers=readers, type_name=readers[0][1].type_name
            )
            message = deserialize_message(data, type(message))
            batch.append((Arrival(self.now + 5, message, 0, topic, data), self.now, lost))
        self.journal.read(self.reading, self.now)
        self.journal.hear(batch)
        events = [event for one in batch for event in _events(*one, self.reading)]
        for axis, event in ordered(events):
            self.publish(axis, axis.monitor.update(event))

    def tick(self):
        grid = self.now - self.now % (SECOND // 10)
        self.journal.tick(grid, self.now)
        for axis in self.axes.values():
            self.publish(axis, axis.monitor.tick(grid))
        self.process.now = (self.now - BEGIN) / SECOND
        self.describe('time', self.journal.due(self.axes, self.now - BEGIN, self.now))

    def publish(self, axis, state):
        if state is not None:
            self.said.append(repr(state))
            if state.event is not None:
                self.journal.trigger(self.now)

    def close(self):
        self.journal.close()


def joints(stamp, x, z):
    message = JointState(name=['x_axis', 'z_axis'], velocity=[float(x), float(z)])
    message.header.stamp.sec, message.header.stamp.nanosec = divmod(stamp, SECOND)
    return 'speed', message


def force(stamp, value):
    message = WrenchStamped()
    message.wrench.force.x = float(value)
    message.header.stamp.sec, message.header.stamp.nanosec = divmod(stamp, SECOND)
    return 'load', message


def live(node, *, seconds, seed=1, begin=BEGIN):
    """Let a node hear a machine that works, stands, hurries and stutters; 50 messages a second."""
    draw = random.Random(seed)
    speeds = {'x': 60.0, 'z': 3.0}
    for step in range(50 * seconds):
        node.now = begin + step * SECOND // 50
        if draw.random() < 0.02:
            speeds = {axis: draw.choice([0.0, 3.0, -30.0, 90.0, 400.0]) for axis in speeds}
        stamp = node.now - draw.choice([0, 0, 0, 3_000_000, SECOND // 2])
        burst = [joints(stamp, *speeds.values()), force(stamp, draw.choice([-800, 900, 1e5]))]
        draw.shuffle(burst)
        if draw.random() < 0.95:
            node.hear(*burst[: draw.choice([1, 2, 2])], lost=draw.choice([0] * 9 + [2, None]))
        if step % 5 == 0:
            node.tick()


def again(bag):
    """Return the states of a replay as text, and what it says of the notes of the node."""
    parts = replay_parts(bag, recorded_values(bag))
    states = [repr(part.state) for part in parts if isinstance(part, TimedState)]
    return states, ' '.join(bag.remarks)


def bag_in(folder):
    (path,) = folder.iterdir()
    return Bag(path)


def masked(states):
    """Return states without the addresses of the surfaces, which differ between two replays."""
    return [re.sub('surface=<[^>]*>', '', state) for state in states]


def assert_given_again(node, folder):
    """Close a node, and hold a replay of its recording against what it said."""
    node.close()
    states, said = again(bag_in(folder))
    assert masked(states) == masked(node.said)
    assert 'agrees with all' in said


def test_a_step_of_the_clock_comes_again(tmp_path):
    """It is left out of an event before the next messages are heard."""
    node, step = SmallNode(tmp_path), 3600 * SECOND
    live(node, seconds=12, seed=3)
    for number in range(100):
        node.now = BEGIN + 12 * SECOND + number * SECOND // 50
        node.hear(force(node.now, 900), joints(node.now, 3.0, 3.0))
    events = {name: axis.monitor.event for name, axis in node.axes.items()}
    assert all(event.active for event in events.values())
    for name, axis in node.axes.items():
        first = InputSample(source=Source.SPEED, value=0.0, stamp=node.now + step)
        assert axis.monitor.leave_out(step, first)
        node.describe('clock', [name])
    live(node, seconds=12, seed=4, begin=node.now + step + SECOND // 50)
    for name, axis in node.axes.items():
        assert axis.monitor.event.number >= events[name].number
    assert_given_again(node, tmp_path)


def test_every_state_comes_again_bit_for_bit_and_is_proven(tmp_path):
    node = SmallNode(tmp_path)
    live(node, seconds=35)
    node.close()
    bag = bag_in(tmp_path)
    assert journal_of(bag) == '/mill/ballscrew_monitor/journal'
    states, said = again(bag)
    assert masked(states) == masked(node.said)
    assert len(states) > 1000
    assert sum('event=Event' in state for state in states) == 10
    assert said.endswith('agrees with all 8 notes of the node')


@pytest.mark.parametrize('one_source', [True, False])
def test_what_is_refused_of_several_publishers_and_how_far_stamps_may_lead_is_followed(
    tmp_path, one_source
):
    node = SmallNode(tmp_path, **{'x.one_source': one_source})
    several = frozenset({('x', Source.SPEED), ('z', Source.LOAD)})
    for seed, reading in enumerate(
        (Reading(), Reading(ahead=SECOND // 2), Reading(SECOND, several), Reading())
    ):
        node.reading = reading
        live(node, seconds=3, seed=seed, begin=node.now)
        stamp = node.now + SECOND // 4  # allowed with a lead alone
        node.hear(joints(stamp, 50.0, 60.0), force(stamp, 800.0))
    assert_given_again(node, tmp_path)


def test_a_recording_begins_when_simulated_time_does(tmp_path):
    node = SmallNode(tmp_path, now=0)
    node.hear(joints(BEGIN, 60.0, 3.0), force(BEGIN, -800.0))
    node.tick()
    live(node, seconds=25)
    node.close()
    bag = bag_in(tmp_path)
    assert bag.path.name == '20231114T221320Z'
    assert bag.start_time == BEGIN
    states, said = again(bag)
    assert masked(states) == masked(node.said)[slice(-len(states), None)]
    assert len(states) > 500
    assert 'agrees with all' in said


def test_changes_of_parameters_and_acknowledgements_are_followed(tmp_path):
    node = SmallNode(tmp_path)
    live(node, seconds=5)
    node.values = node.values | {'x.limits.efficiency': 0.95, 'x.publish_period': 0.5}
    node.axes['x'].adapt(node.values)
    node.describe('parameters', ['x'])
    live(node, seconds=5, begin=BEGIN + 5 * SECOND, seed=2)
    for axis in node.axes.values():
        axis.monitor.acknowledge(node.now)
        axis.monitor.reset_totals()
    node.describe('acknowledge')
    live(node, seconds=12, begin=BEGIN + 10 * SECOND, seed=3)
    assert_given_again(node, tmp_path)


def test_a_recording_around_events_begins_where_an_axis_is_described(tmp_path):
    settings = dataclasses.replace(ALWAYS, always=False, before=25.0, after=3.0)
    node = SmallNode(tmp_path, settings, **{'z.limits.raise_delay': 30.0, 'x.limits.rcs': 0.9})
    live(node, seconds=60)
    node.close()
    for path in sorted(tmp_path.iterdir()):
        states, said = again(Bag(path))
        assert states
        assert 'differs' not in said
        assert '\n'.join(masked(states)) in '\n'.join(masked(node.said))


def test_after_a_hole_an_axis_begins_where_it_is_described_again(tmp_path):
    node = SmallNode(tmp_path)
    live(node, seconds=3)
    before = len(node.said)
    node.process.room = False
    live(node, seconds=3, begin=BEGIN + 3 * SECOND, seed=4)
    missed = len(node.said)
    assert node.journal.problem == 'the recording has a hole'
    node.process.room = True
    node.tick()
    resumed = len(node.said)
    live(node, seconds=3, begin=BEGIN + 6 * SECOND, seed=5)
    node.close()
    assert node.journal.problem == ''
    states, said = again(bag_in(tmp_path))
    assert missed > before
    assert masked(states) == masked(node.said[:before] + node.said[resumed:])
    assert 'differs' not in said


def test_a_surface_that_is_not_that_of_the_recording_is_refused(tmp_path, refused):
    node = SmallNode(tmp_path)
    node.axes['x'].surface = types.SimpleNamespace(base_sha256='f' * 64, corrections=())
    node.describe('reload_surface', ['x'])
    node.close()
    refused('surface_ffffffffffffffff', again, bag_in(tmp_path))


def test_corrections_of_the_surface_are_taken_up(tmp_path):
    node = SmallNode(tmp_path)
    axis = node.axes['x']
    where = SolvedAt(speed=61.0, opposing_load=900.0, temperature=315.0)
    numbers = axis.surface.lookup(where.speed, where.opposing_load, where.temperature)
    better = types.SimpleNamespace(
        **{name: getattr(numbers, name) for name in FIELDS}
        | {'friction_torque': 1.05 * numbers.friction_torque}
    )
    axis.use_surface(axis.surface.with_correction(where, better), node.values)
    node.describe('surface', ['x'])
    live(node, seconds=12)
    assert_given_again(node, tmp_path)


def test_a_replay_that_differs_is_refuted(tmp_path, says):
    node = SmallNode(tmp_path)
    live(node, seconds=2)
    node.axes['x'].monitor.reset_totals()  # and nobody is told
    live(node, seconds=12, begin=BEGIN + 2 * SECOND)
    node.close()
    _, said = again(bag_in(tmp_path))
    assert says('differs_from_what') in said


def test_a_replay_takes_the_parameters_of_the_recording_and_follows_it(tmp_path):
    node = SmallNode(tmp_path)
    live(node, seconds=12)
    node.axes['x'].monitor.acknowledge(node.now)
    node.describe('acknowledge', ['x'])
    live(node, seconds=12, begin=BEGIN + 12 * SECOND, seed=2)
    node.close()
    bag = bag_in(tmp_path)
    chosen = values_for(bag, None, Path('none'))
    values = chosen.values
    assert values['axes'] == ['x', 'z']
    assert values['x.speed.topic'] == TOPICS['speed']
    assert chosen.origin == f'those that the node recorded in {bag.path}'
    states = list(replay(bag, values))
    assert len(states) == len(node.said)
    *blocks, x, z = replay_parts(bag, values, states=False)
    for name, outcome in (('x', x), ('z', z)):
        monitor = node.axes[name].monitor
        assert (outcome.axis, outcome.judged) == (name, monitor.memory.judged)
        assert outcome.totals == monitor.kept.totals
        assert len(outcome.events) == monitor.event.number
        assert sum(len(one.rows) for one in blocks if one.axis == name) == outcome.rows
    assert not any(one.active for one in x.events[:-1])
    expected = ['the replay is what the node judged: it agrees with all 6 notes of the node']
    assert bag.notes == expected
    log = judge_log(bag_in(tmp_path), LogParameters(values=values, origin='own'))
    assert all(case.numbered for case in log.axes)
    lost = {one.source: one.lost for one in node.axes['x'].monitor.input_status(node.now)}
    told = {one.source: one.lost for one in inputs_seen(log.axes[0]) if one.place}
    assert told == {source: lost[source] for source in told}
    assert any(told.values())


@pytest.mark.parametrize(('module', 'name'), [(journal, 'VERSION'), (dump, 'MEMORY_VERSION')])
def test_a_recording_of_another_version_is_an_ordinary_bag(tmp_path, monkeypatch, module, name):
    with monkeypatch.context() as other:
        other.setattr(module, name, 1 if name == 'VERSION' else MEMORY_VERSION + 1)
        node = SmallNode(tmp_path)
        live(node, seconds=12)
        node.close()
    bag = bag_in(tmp_path)
    values = recorded_values(bag)
    assert not is_as_recorded(bag, values)
    *_, outcome, _ = replay_parts(bag, values, states=False)
    assert outcome.judged > 100
    assert bag.notes == [OTHER_VERSION]


def test_with_other_parameters_it_is_a_bag_like_any_other(tmp_path):
    node = SmallNode(tmp_path)
    live(node, seconds=12)
    node.close()
    bag = bag_in(tmp_path)
    values = recorded_values(bag) | {'x.limits.efficiency': 0.5}
    *_, outcome, _ = replay_parts(bag, values, states=False)
    assert outcome.judged > 100
    assert bag.notes == []


GONE = object()
OTHERS = [GONE, None, 'a text', -1, 2**70, 1e300, True, [], {}, [[]], {'a': 1}]


@pytest.fixture(scope='module')
def rewritten(tmp_path_factory, copy_bag):
    """Return the function that gives a recording of which one entry has one value changed."""
    folder = tmp_path_factory.mktemp('node')
    node = SmallNode(folder)
    live(node, seconds=1)
    node.close()
    bag = bag_in(folder)
    journal = journal_of(bag)
    entries = [
        json.loads(deserialize_message(one.data, String).data) for one in bag.messages([journal])
    ]

    def rewrite(number, part, other):
        entry = json.loads(json.dumps(entries[number % len(entries)]))
        places = places_in(entry)
        mapping, key = places[part % len(places)]
        mapping.pop(key)
        if other is not GONE:
            mapping[key] = other
        count = itertools.count()

        def data_of(message):
            if message.topic == journal and next(count) == number % len(entries):
                return serialize_message(String(data=json.dumps(entry)))
            return message.data

        return copy_bag(bag, tmp_path_factory.mktemp('changed'), data_of)

    return rewrite


def places_in(entry):
    """Return every mapping of an entry with a key of it, those within others too."""
    below = [place for one in entry.values() if isinstance(one, dict) for place in places_in(one)]
    return [*((entry, key) for key in entry), *below]


@example(number=40, part=180, other=GONE)  # what is remembered of an axis, or a part of it
@given(number=st.integers(0, 50), part=st.integers(0, 999), other=st.sampled_from(OTHERS))
def test_an_entry_with_another_value_is_replayed_or_refused(number, part, other, rewritten):
    bag = rewritten(number, part, other)
    with contextlib.suppress(InputError):
        values = recorded_values(bag)
        is_as_recorded(bag, values)
        list(replay_parts(bag, values))
    shutil.rmtree(bag.path)
