# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Recordings by a node of any scenario give its states again, bit for bit."""

import itertools
from pathlib import Path
import random
import types

from ballscrew_monitor.core.conversions import nanoseconds, SECOND
from ballscrew_monitor.core.inputs import ordered
from ballscrew_monitor.messages.state_messages import empty_state, fill_state
from ballscrew_monitor.node.event_recorder import axis_snapshot, EventRecorder
from ballscrew_monitor.node.topic import Arrival
from ballscrew_monitor.recordings.axis_run import TimedState
from ballscrew_monitor.recordings.bag import Bag
from ballscrew_monitor.recordings.recorded_events import recorded_values
from ballscrew_monitor.recordings.replay import replay_parts
from ballscrew_monitor.recordings.retention import KeepSettings, Retention
from ballscrew_monitor.settings.axis import build_axis
from ballscrew_monitor.settings.parameters import absolute, input_topics, read_file
import pytest
from rclpy.serialization import deserialize_message
from scenario import generate, PARAMETERS
from scenarios import SCENARIOS

NOMINAL = Path(__file__).resolve().parents[2] / 'config' / 'nominal_cycle.yaml'
ALWAYS = KeepSettings(always=True, before=60, after=10, longest=1e9, largest=1e9, total=1e12)
AXIS = 'x'
HOLE = 5 * SECOND  # [ns] of a silence that is filled with ticks


class Frames(list):
    """Stands for the process that records: its frames are kept at the end."""

    problem, lost = '', False

    def __init__(self, folder):
        super().__init__()
        self.folder = folder

    def put(self, frame):
        self.append(frame)
        return True

    def flush(self):
        return True

    def close(self):
        retention = Retention(self.folder, ALWAYS)
        for frame in self:
            retention.take(frame, 0.0)
        retention.close()


class Listener:
    """Does with a bag what the node does with messages that come in bursts, and records it."""

    def __init__(self, bag, values, folder):
        self.axis = build_axis(AXIS, values)
        self.values, self.said = values, []
        self.readers = {absolute(one.topic): one for one in self.axis.inputs}
        self.recorder = EventRecorder('/ballscrew_monitor/judge_events', lambda: Frames(folder))
        self.snapshot('begin', bag.start_time)

    def snapshot(self, because, now):
        topics = {one.source.name.lower(): topic for topic, one in self.readers.items()}
        found = {AXIS: axis_snapshot(self.axis, self.values, topics)}
        self.recorder.snapshot(found, because, now)

    def hear(self, messages):
        heard = [
            (
                self.arrival(message),
                message.log_time,
                random.Random(message.log_time).choice([0, 1]),
            )
            for message in messages
        ]
        events = [
            (
                self.axis,
                self.readers[one.topic.name].read(
                    one.message, now=now, max_future=self.axis.max_future, lost=lost
                ),
            )
            for one, now, lost in heard
        ]
        turn = ordered(events)
        self.recorder.hear(heard)
        self.recorder.take(turn, heard[-1][1], heard[-1][1])
        for axis, event in turn:
            self.publish(axis.monitor.update(event))

    def arrival(self, message):
        reader = self.readers[message.topic]
        topic = types.SimpleNamespace(name=message.topic, type_name=reader.type_name)
        decoded = deserialize_message(message.data, reader.message_type)
        return Arrival(message.log_time, decoded, 0, topic, message.data)

    def tick(self, grid):
        self.recorder.tick(grid, grid, grid)
        self.publish(self.axis.monitor.tick(grid))
        if because := self.recorder.due(grid, grid):
            self.snapshot(because, grid)

    def publish(self, row):
        if row is not None:
            message = empty_state(AXIS)
            fill_state(message, row, self.axis.monitor)
            self.said.append(repr(message))


def bursts(messages, draw):
    """Yield messages in bursts of one to six, as a busy machine hands them over."""
    messages = iter(messages)
    while burst := list(itertools.islice(messages, draw.randint(1, 6))):
        yield burst


def listen(bag, values, folder):
    """Return what was said of a bag while it was recorded into a folder."""
    listener, period = Listener(bag, values, folder), nanoseconds(values['tick_period'])
    grid = -(-bag.start_time // period) * period
    for burst in bursts(bag.messages(input_topics(values)), random.Random(7)):
        now = burst[-1].log_time
        for due in range(grid, min(now, grid + HOLE), period):
            listener.tick(due)
        grid = max(grid, -(-now // period) * period)
        listener.hear(burst)
    listener.recorder.close()
    return listener.said


def again(folder):
    """Return what a replay of the recording says, and what is said of it."""
    (path,) = folder.iterdir()
    bag = Bag(path)
    parts = replay_parts(bag, recorded_values(bag))
    said = [repr(part.state) for part in parts if isinstance(part, TimedState)]
    return said, bag.remarks


@pytest.fixture(params=['nominal_cycle', *SCENARIOS])
def scenario(request, tmp_path, nominal_bag):
    """Return a bag and the parameters to judge it with."""
    if request.param == 'nominal_cycle':
        return Bag(nominal_bag), read_file(NOMINAL)
    generate(SCENARIOS[request.param](), tmp_path / 'bag')
    return Bag(tmp_path / 'bag'), read_file(tmp_path / 'bag' / PARAMETERS)


def test_a_recording_of_the_scenario_gives_its_states_again(scenario, tmp_path):
    said = listen(*scenario, tmp_path / 'recordings')
    replayed, remarks = again(tmp_path / 'recordings')
    assert replayed == said
    assert len(said) > 50
    assert remarks == []
