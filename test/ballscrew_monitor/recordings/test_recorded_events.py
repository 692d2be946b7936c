# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""A recording of a node gives the states of the node again, bit for bit, wherever it begins."""

import contextlib
import dataclasses
import json
from pathlib import Path
import random
import shutil
import tempfile
import types

from ballscrew_monitor.core.conversions import SECOND
from ballscrew_monitor.core.fields import OtherJoints
from ballscrew_monitor.core.inputs import ordered, Source
from ballscrew_monitor.core.judgement import EventEnd, Level
from ballscrew_monitor.core.state import Ending, Shelving
from ballscrew_monitor.judge.full_point import SolvedAt
from ballscrew_monitor.judge.kept import AxisRecord
from ballscrew_monitor.judge.records import EVENT, EVENTS_VERSION, Memory, MEMORY_VERSION
from ballscrew_monitor.messages.state_messages import empty_state, fill_state, fill_totals
from ballscrew_monitor.node.event_recorder import axis_snapshot, EventRecorder
from ballscrew_monitor.node.intake import _events
from ballscrew_monitor.node.sources import Reading
from ballscrew_monitor.node.topic import Arrival
from ballscrew_monitor.recordings import event_messages
from ballscrew_monitor.recordings.axis_run import TimedState
from ballscrew_monitor.recordings.bag import Bag
from ballscrew_monitor.recordings.bulk import batches
from ballscrew_monitor.recordings.event_messages import packed, read
from ballscrew_monitor.recordings.log_facts import values_for
from ballscrew_monitor.recordings.recorded_events import (
    DROPPED,
    events_topic,
    FRESH,
    judged_by_events,
    OTHERS,
    recorded_values,
)
from ballscrew_monitor.recordings.recover import recover
from ballscrew_monitor.recordings.replay import replay, replay_parts
from ballscrew_monitor.recordings.retention import KeepSettings, Retention
from ballscrew_monitor.report.inputs_seen import inputs_seen
from ballscrew_monitor.report.judging import judge_log
from ballscrew_monitor.report.log_report import report_log
from ballscrew_monitor.report.parameters import LogParameters
from ballscrew_monitor.settings import parameters
from ballscrew_monitor.settings.axis import build_axis
from ballscrew_msgs.msg import Totals
from geometry_msgs.msg import WrenchStamped
from hypothesis import example, given, settings
from hypothesis import strategies as st
import numpy as np
import polars as pl
import pytest
from rclpy.serialization import deserialize_message, serialize_message
from sensor_msgs.msg import JointState
from surrogate.files import InputError
from surrogate.surface import FIELDS

BEGIN = 1_700_000_000 * SECOND
TOPICS = {'speed': '/mill/joint_states', 'load': '/mill/axial_load'}
EVENTS = '/mill/ballscrew_monitor/judge_events'
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

    def __init__(self, folder, settings=ALWAYS, *, now=BEGIN, raw=True, **changes):
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
        self.recorder = EventRecorder(EVENTS, lambda: self.process, raw=raw)
        self.said, self.edges = [], 0
        self.snapshots = []  # how much was said before each
        self.now, self.reading = now, Reading()
        self.stepped = 0  # by how much the clock was set [ns]
        self.snapshot('begin')

    @property
    def steady(self):
        return self.now - self.stepped - BEGIN

    def set_clock(self, step):
        due, self.now = self.now, self.now + step
        self.stepped += step
        self.recorder.set_clock(due, self.now, self.steady)
        for axis in self.axes.values():
            axis.monitor.set_clock(due, self.now)

    def snapshot(self, because, names=('x', 'z')):
        found = {name: axis_snapshot(self.axes[name], self.values, TOPICS) for name in names}
        self.recorder.snapshot(found, because, self.now)
        self.snapshots.append(len(self.said))

    def hear(self, *messages, lost=0):
        """Take a turn of pairs of an input and a message."""
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
        turn = ordered([event for one in batch for event in _events(*one, self.reading)])
        self.recorder.hear(batch)
        self.recorder.take(turn, self.now, self.steady)
        for axis, event in turn:
            self.publish(axis, axis.monitor.update(event))

    def tick(self):
        grid = self.now - self.now % (SECOND // 10)
        self.recorder.tick(grid, self.now, self.steady)
        for axis in self.axes.values():
            self.publish(axis, axis.monitor.tick(grid))
        self.process.now = self.steady / SECOND
        if because := self.recorder.due(self.steady, self.now):
            self.snapshot(because)

    def publish(self, axis, row):
        if row is not None:
            message = empty_state(axis.name)
            fill_state(message, row, axis.monitor)
            self.said.append(repr(message))
            if row.edge:
                self.edges += 1
                self.recorder.trigger(self.now)

    def close(self):
        self.recorder.close()


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
    """Return the states of a replay with the parameters of the node as text."""
    parts = replay_parts(bag, recorded_values(bag))
    return [repr(part.state) for part in parts if isinstance(part, TimedState)]


def bag_in(folder):
    (path,) = folder.iterdir()
    return Bag(path)


def messages_of(bag):
    return [read(one.data) for one in bag.as_written([EVENTS])]


def assert_given_again(node, folder):
    """Close a node, and hold a replay of its recording against what it said."""
    node.close()
    bag = bag_in(folder)
    assert again(bag) == node.said
    assert bag.remarks == []


def run_at(node, speed, *, seconds, begin):
    """Let a node hear a machine that runs at a speed [rad/s]: 3 is too slow, 90 is not."""
    for number in range(50 * seconds):
        node.now = begin + number * SECOND // 50
        node.hear(force(node.now, 900), joints(node.now, speed, speed))


@pytest.mark.parametrize('hours', [1, -1, 8760])
def test_a_step_of_the_clock_comes_again(tmp_path, hours):
    """It is an event: no snapshot tells of it, and a fresh memory leaves it out as well."""
    node = SmallNode(tmp_path)
    live(node, seconds=2, seed=3)
    run_at(node, 3.0, seconds=2, begin=BEGIN + 2 * SECOND)
    assert all(axis.monitor.memory.event_active for axis in node.axes.values())
    node.set_clock(hours * 3600 * SECOND)
    run_at(node, 3.0, seconds=2, begin=node.now + SECOND // 50)
    assert all(axis.monitor.memory.event_active for axis in node.axes.values())
    run_at(node, 90.0, seconds=4, begin=node.now + SECOND // 50)
    assert node.edges == 4
    assert len(node.snapshots) == 1
    assert_given_again(node, tmp_path)
    bag = bag_in(tmp_path)
    values = recorded_values(bag) | {'x.limits.hysteresis': 0.03}
    lengths = [event.duration for _, event in replay(bag, values) if event and not event.active]
    assert 4.0 < max(lengths) < 10.0
    assert min(lengths) > 0.0


@pytest.mark.parametrize('raw', [True, False])
def test_every_state_comes_again_bit_for_bit(tmp_path, raw):
    node = SmallNode(tmp_path, raw=raw)
    live(node, seconds=21)
    node.close()
    bag = bag_in(tmp_path)
    assert events_topic(bag) == EVENTS
    assert bag.topics.keys() == {EVENTS, *(TOPICS.values() if raw else ())}
    states = again(bag)
    assert states == node.said
    assert len(states) > 600
    assert node.edges == 7
    assert bag.remarks == []
    snapshots = [one for one in messages_of(bag) if one.snapshots]
    assert [one.number for one in messages_of(bag)] == [*range(len(messages_of(bag)))]
    assert len(snapshots) == 3  # at the begin and every ten seconds


def test_a_replay_unpacks_the_chunks_of_events_alone(tmp_path, monkeypatch):
    """The messages of the inputs lie in other chunks, of which none is looked at."""
    node = SmallNode(tmp_path)
    live(node, seconds=12)
    node.close()
    bag, seen = bag_in(tmp_path), set()
    real = batches.read_chunk

    def watched(stream, place):
        found = real(stream, place)
        seen.update(found.channel.tolist())
        return found

    monkeypatch.setattr(batches, 'read_chunk', watched)
    list(replay_parts(bag, recorded_values(bag), states=False))
    assert len(seen) == 1


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
    live(node, seconds=12)
    node.close()
    bag = bag_in(tmp_path)
    assert bag.path.name == '20231114T221320Z'
    assert bag.start_time == BEGIN
    states = again(bag)
    assert states == node.said[slice(-len(states), None)]
    assert len(states) > 250


def test_changes_of_parameters_and_acknowledgements_are_followed(tmp_path):
    node = SmallNode(tmp_path)
    live(node, seconds=5)
    node.values = node.values | {'x.limits.efficiency': 0.95, 'x.publish_period': 0.5}
    node.axes['x'].adapt(node.values)
    node.snapshot('parameters', ['x'])
    live(node, seconds=5, begin=BEGIN + 5 * SECOND, seed=2)
    for axis in node.axes.values():
        axis.monitor.acknowledge(node.now)
        axis.monitor.reset_totals()
    node.snapshot('acknowledge')
    live(node, seconds=12, begin=BEGIN + 10 * SECOND, seed=3)
    assert_given_again(node, tmp_path)


def test_a_recording_around_events_begins_at_snapshots(tmp_path):
    around = dataclasses.replace(ALWAYS, always=False, before=15.0, after=3.0)
    wide = {f'{axis}.limits.efficiency': 0.01 for axis in 'xz'}
    wide |= {f'{axis}.limits.rcs': 0.999 for axis in 'xz'}
    node = SmallNode(tmp_path, around, **wide)
    live(node, seconds=27)
    assert node.edges == 0
    node.values = node.values | {'x.limits.efficiency': 0.9, 'x.limits.rcs': 0.01}
    node.axes['x'].adapt(node.values)
    node.snapshot('parameters', ['x'])
    live(node, seconds=6, begin=BEGIN + 27 * SECOND, seed=2)
    node.close()
    path, *_ = sorted(tmp_path.iterdir())
    states = again(Bag(path))
    assert 15.0 <= (BEGIN + 27 * SECOND - Bag(path).start_time) / SECOND < 27.0
    assert node.edges > 0
    assert any(f'level={int(Level.WARN)}' in state for state in states)
    assert '\n'.join(states) in '\n'.join(node.said)


def test_recordings_of_limited_length_follow_each_other_without_a_gap(tmp_path):
    node = SmallNode(tmp_path, dataclasses.replace(ALWAYS, longest=10.0))
    live(node, seconds=25)
    node.close()
    paths = sorted(tmp_path.iterdir())
    assert len(paths) == 3
    assert all(Bag(path).duration <= 10.0 for path in paths)
    assert [state for path in paths for state in again(Bag(path))] == node.said


def test_what_is_kept_late_is_followed(tmp_path):
    node = SmallNode(tmp_path)
    live(node, seconds=3)
    memory = Memory(running_time=7 * SECOND, angle=3.0, since=5, event_number=41, event_stamp=3)
    memory.event_start[0] = 2
    known = Shelving(until=BEGIN + 600 * SECOND, reason='known')
    stopped = Ending(EventEnd.STOPPED, reason='long ago')
    record = AxisRecord.of('z', memory, stopped, known, BEGIN)
    node.axes['z'].monitor.take_up(record, node.now)
    node.snapshot('kept', ['z'])
    live(node, seconds=12, begin=BEGIN + 3 * SECOND, seed=2)
    assert_given_again(node, tmp_path)


def test_after_a_hole_the_replay_goes_on_at_the_next_snapshots(tmp_path):
    node = SmallNode(tmp_path)
    live(node, seconds=3)
    before = len(node.said)
    node.process.room = False
    live(node, seconds=3, begin=BEGIN + 3 * SECOND, seed=4)
    missed = len(node.said)
    assert node.recorder.problem == 'the recording has a hole'
    node.process.room = True
    node.tick()
    resumed = len(node.said)
    live(node, seconds=3, begin=BEGIN + 6 * SECOND, seed=5)
    node.close()
    assert node.recorder.problem == ''
    bag = bag_in(tmp_path)
    assert again(bag) == node.said[:before] + node.said[resumed:]
    assert missed > before
    assert bag.remarks == [DROPPED]


def test_after_a_lost_message_the_replay_goes_on_at_the_next_snapshots(tmp_path, copy_bag, says):
    node = SmallNode(tmp_path / 'whole')
    live(node, seconds=13)
    node.close()
    whole = bag_in(tmp_path / 'whole')
    gone = next(one.number for one in messages_of(whole) if one.number > 3 and not one.snapshots)

    def without(message):
        is_gone = message.topic == EVENTS and read(message.data).number == gone
        return None if is_gone else message.data

    bag = copy_bag(whole, tmp_path / 'part', without)
    states, said = again(bag), node.said
    assert bag.remarks == [says('messages_lost', number=gone + 1)]
    cut = next(at for at, (one, other) in enumerate(zip(states, said)) if one != other)
    assert states[cut:] == said[slice(cut - len(states), None)]
    assert 0 < cut < len(states) < len(said)


def test_a_surface_that_is_not_that_of_the_recording_is_refused(tmp_path, refused):
    node = SmallNode(tmp_path)
    node.axes['x'].surface = types.SimpleNamespace(base_sha256='f' * 64, corrections=())
    node.snapshot('reload_surface', ['x'])
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
    node.snapshot('surface', ['x'])
    live(node, seconds=12)
    assert_given_again(node, tmp_path)


def test_a_replay_takes_the_parameters_of_the_recording_and_follows_it(tmp_path):
    node = SmallNode(tmp_path)
    live(node, seconds=5)
    node.axes['x'].monitor.acknowledge(node.now)
    node.snapshot('acknowledge', ['x'])
    live(node, seconds=8, begin=BEGIN + 5 * SECOND, seed=2)
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
        said = Totals()
        fill_totals(said, monitor.memory)
        assert outcome.totals == said
        assert len(outcome.events) == monitor.memory.event_number
        assert sum(len(one.rows) for one in blocks if one.axis == name) == outcome.rows
    assert not any(one.active for one in x.events[:-1])
    assert bag.notes == []
    log = judge_log(bag_in(tmp_path), LogParameters(values=values, origin='own'))
    assert all(case.numbered for case in log.axes)
    lost = {one.source: one.lost for one in node.axes['x'].monitor.input_status(node.now)}
    told = {one.source: one.lost for one in inputs_seen(log.axes[0]) if one.place}
    assert told == {source: lost[source] for source in told}
    assert any(told.values())


def recorded(folder, **changes):
    """Return a recording of some seconds, and the node that made it."""
    node = SmallNode(folder, **changes)
    live(node, seconds=12)
    node.close()
    return bag_in(folder), node


@pytest.fixture(scope='module')
def both(tmp_path_factory):
    """Return what opens a recording with the messages of the inputs or without, and its node."""
    made = {}
    for raw in (True, False):
        bag, node = recorded(tmp_path_factory.mktemp('recorded'), raw=raw)
        made[raw] = bag.path, node
    return lambda raw: (Bag(made[raw][0]), made[raw][1])


def test_memory_of_another_version_begins_fresh(tmp_path, monkeypatch):
    other = MEMORY_VERSION + 1
    with monkeypatch.context() as patched:
        patched.setattr(event_messages, 'MEMORY_VERSION', other)
        node = SmallNode(tmp_path)
        for axis in node.axes.values():
            axis.monitor.memory.judged = 500
        node.snapshot('time')
        live(node, seconds=12)
        node.close()
    bag = bag_in(tmp_path)
    *_, outcome, _ = replay_parts(bag, recorded_values(bag), states=False)
    assert outcome.judged == node.axes['x'].monitor.memory.judged - 500
    assert bag.notes == [FRESH.format(other, MEMORY_VERSION)]


@pytest.mark.parametrize('raw', [True, False])
def test_events_of_another_version_need_the_messages_of_the_inputs(
    tmp_path, monkeypatch, says, refused, raw
):
    with monkeypatch.context() as patched:
        patched.setattr(event_messages, 'EVENTS_VERSION', EVENTS_VERSION + 1)
        bag, _ = recorded(tmp_path, raw=raw)
    values = recorded_values(bag)
    if not raw:
        refused('of_version_refused', replay_parts, bag, values)
        return
    assert not judged_by_events(bag, values)
    *_, outcome, _ = replay_parts(bag, values, states=False)
    assert outcome.judged > 100
    assert bag.notes == [says('of_version_raw')]


@pytest.mark.parametrize('raw', [True, False])
def test_other_limits_judge_the_events_with_a_fresh_memory(both, raw):
    bag, node = both(raw)
    values = recorded_values(bag) | {'x.limits.efficiency': 0.5}
    assert judged_by_events(bag, values)
    *_, outcome, _ = replay_parts(bag, values, states=False)
    assert outcome.judged == node.axes['x'].monitor.memory.judged
    assert outcome.limits.efficiency == 0.5
    assert bag.notes == [OTHERS]


@pytest.mark.parametrize(
    ('change', 'instead', 'refusal'),
    [
        ({'x.load.scale': 2.0}, 'reads_scale', 'refused_scale'),
        ({'z.speed.field': 'velocity[x_axis]'}, 'reads_field', 'refused_field'),
        ({'x.handedness': 'left'}, 'reads_handedness', 'refused_handedness'),
        ({'x.max_future': 1.0}, 'reads_max_future', 'refused_max_future'),
        ({'tick_period': 0.2}, 'reads_tick_period', 'refused_tick_period'),
    ],
)
def test_other_readings_need_the_messages_of_the_inputs(
    both, change, instead, refusal, says, refused
):
    bag, _ = both(raw=True)
    *_, outcome, _ = replay_parts(bag, recorded_values(bag) | change, states=False)
    assert outcome.judged > 100
    assert bag.notes == [says(instead)]
    bag, _ = both(raw=False)
    with refused(refusal):
        replay_parts(bag, recorded_values(bag) | change, states=False)


def test_a_part_of_the_axes_is_judged_alone(both):
    bag, node = both(raw=True)
    values = {name: one for name, one in recorded_values(bag).items() if not name.startswith('x.')}
    *_, outcome = replay_parts(bag, values | {'axes': ['z']}, states=False)
    assert outcome.judged == node.axes['z'].monitor.memory.judged


def test_other_joints_and_several_kinds_of_notes_come_again(tmp_path):
    node = SmallNode(tmp_path)
    live(node, seconds=2)
    for number in range(30):
        node.now += SECOND // 50
        message = JointState(name=[f'joint_{number % 3}'], velocity=[1.0])
        message.header.stamp.sec, message.header.stamp.nanosec = divmod(node.now, SECOND)
        node.hear(('speed', message))
        if number % 5 == 0:
            node.tick()
    named = {one.source: one.joints for one in node.axes['x'].monitor.input_status(node.now)}
    expected = OtherJoints('velocity', 'x_axis', ('joint_0', 'joint_1', 'joint_2'))
    assert named[Source.SPEED] == expected
    live(node, seconds=1, begin=node.now)
    assert_given_again(node, tmp_path)


@settings(max_examples=settings.default.max_examples // 2)
@given(share=st.floats(0.0, 1.0))
def test_a_file_that_is_cut_at_any_byte_gives_the_first_states_again(share, whole):
    data, said = whole
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / 'a.mcap.active'
        file.write_bytes(data[: int(share * len(data))])
        try:
            recover(file)
            states = again(Bag(Path(folder) / 'a.mcap'))
        except InputError:  # not even the first snapshots are whole
            states = []
    assert states == said[: len(states)]
    assert len(states) >= int(0.9 * share * len(said)) - 150  # a second of both axes, about


@pytest.fixture(scope='module')
def whole(both):
    """Return the bytes of a recording, and what its node said."""
    bag, node = both(raw=True)
    return bag.files[0].read_bytes(), node.said


@settings(max_examples=settings.default.max_examples // 10)
@given(seed=st.integers(0, 2**32 - 1), raw=st.booleans())
def test_cut_at_any_snapshots_the_rest_is_judged_the_same(seed, raw, copy_bag):
    with tempfile.TemporaryDirectory() as folder:
        node = SmallNode(Path(folder) / 'whole', raw=raw)
        live(node, seconds=21, seed=seed)
        node.close()
        bag, said = bag_in(Path(folder) / 'whole'), node.said
        begins = [one.number for one in messages_of(bag) if one.snapshots]
        assert len(begins) == 3
        for begin, before in zip(begins, node.snapshots, strict=True):

            def rest(message, begin=begin):
                is_before = message.topic == EVENTS and read(message.data).number < begin
                return None if is_before else message.data

            part = copy_bag(bag, Path(folder) / f'from_{begin}', rest)
            assert again(part) == said[before:]
            assert part.remarks == []


def test_the_report_of_a_recording_without_messages_of_inputs_has_the_same_rows(both, tmp_path):
    rows = {}
    for raw in (True, False):
        bag, _ = both(raw)
        made = tmp_path / f'report_{raw}'
        report_log(bag, made, LogParameters(values=recorded_values(bag), origin='own'))
        rows[raw] = pl.read_parquet(made / 'states.parquet')
        assert Bag(made / 'judged').topics['/ballscrew_monitor/x/state'].count > 100
    assert rows[True].equals(rows[False], null_equal=True)


GONE = object()
VALUES = [GONE, None, 'a text', -1, 2**70, 1e300, True, [], {}, [[]], {'a': 1}]


@pytest.fixture(scope='module')
def rewritten(tmp_path_factory, copy_bag):
    """Return what gives a recording whose first snapshot of an axis has one value changed."""
    folder = tmp_path_factory.mktemp('node')
    node = SmallNode(folder)
    live(node, seconds=1)
    node.close()
    bag = bag_in(folder)
    first = next(one for one in messages_of(bag) if one.snapshots)

    def rewrite(number, part, other):
        entries = [json.loads(text) for text in first.snapshots]
        places = places_in(entries[number])
        mapping, key = places[part % len(places)]
        mapping.pop(key)
        if other is not GONE:
            mapping[key] = other
        texts = [json.dumps(one) for one in entries]
        data = packed(first.number, np.empty(0, EVENT), {}, texts)

        def data_of(message):
            is_first = message.topic == EVENTS and read(message.data).number == first.number
            return data if is_first else message.data

        return copy_bag(bag, tmp_path_factory.mktemp('changed'), data_of)

    return rewrite


def places_in(entry):
    """Return every mapping of an entry with a key of it, those within others too."""
    below = [place for one in entry.values() if isinstance(one, dict) for place in places_in(one)]
    return [*((entry, key) for key in entry), *below]


@example(number=0, part=180, other=GONE)
@given(number=st.integers(0, 1), part=st.integers(0, 999), other=st.sampled_from(VALUES))
def test_a_snapshot_with_another_value_is_replayed_or_refused(number, part, other, rewritten):
    bag = rewritten(number, part, other)
    with contextlib.suppress(InputError):
        values = recorded_values(bag)
        list(replay_parts(bag, values))
    shutil.rmtree(bag.path)
