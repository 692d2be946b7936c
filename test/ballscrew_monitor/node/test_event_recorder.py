# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The process that records gets events as they are judged, and is started again if it is lost."""

from types import SimpleNamespace

from ballscrew_monitor.core.conversions import SECOND
from ballscrew_monitor.core.fields import OtherJoints
from ballscrew_monitor.core.inputs import InputSample, Refusal, Source, Why
from ballscrew_monitor.judge.monitor import fill
from ballscrew_monitor.judge.records import Event
from ballscrew_monitor.node.event_recorder import EventRecorder, LONGEST_RESTART, RESTART
from ballscrew_monitor.recordings.bulk.events import joined
from ballscrew_monitor.recordings.frames import BEGIN
import pytest
from surrogate.surface.records import as_array

STEP = SECOND // 10


class Bench:
    """A recorder whose process is lost when a test says so, on a steady clock of its own."""

    def __init__(self):
        self.now, self.started = 0, []
        self.recorder = EventRecorder('/judge_events', self._start)

    def _start(self):
        process = SimpleNamespace(lost=False, problem='', close=lambda: None)
        process.put = process.flush = lambda *frame: True
        self.started.append(process)
        return process

    def run(self, duration):
        """Let time go on [ns]."""
        end = self.now + duration
        while self.now < end:
            self.now += STEP
            self.recorder.due(self.now, 1)

    def lose(self):
        """Lose the process; return after which time [ns] it was started again."""
        self.started[-1].lost = True
        count, begin = len(self.started), self.now
        while len(self.started) == count:
            self.run(STEP)
        return self.now - begin - STEP


def test_a_process_that_is_lost_again_and_again_is_started_again_ever_later():
    bench = Bench()
    waits = [bench.lose() for _ in range(7)]
    assert waits == [min(RESTART << turn, LONGEST_RESTART) for turn in range(7)]


@pytest.mark.parametrize(('well', 'wait'), [(LONGEST_RESTART, RESTART), (SECOND, 8 * RESTART)])
def test_after_a_process_has_run_well_the_wait_is_short_again(well, wait):
    bench = Bench()
    for _ in range(3):
        bench.lose()
    bench.run(well)
    assert bench.lose() == wait


def test_an_array_of_events_is_recorded_as_they_are_one_by_one():
    """Those of an axis of which there is no snapshot are left out."""
    named = OtherJoints('velocity', 'x', ('z',))
    events = [
        ('x', InputSample(source=Source.SPEED, value=-0.0, stamp=SECOND, arrival=9, lost=None)),
        ('nowhere', InputSample(source=Source.LOAD, value=1.0, stamp=SECOND)),
        ('y', Refusal(source=Source.SPEED, why=Why.OTHER_JOINTS, joints=named, arrival=7)),
        ('y', Refusal(source=Source.LOAD, why=Why.FUTURE, first=3.0, second=0.5, arrival=8)),
    ]
    records = [Event() for _ in events]
    for record, (_, event) in zip(records, events, strict=True):
        fill(record, event)
    turn = joined([as_array(record) for record in records])
    put = {'each': [], 'many': []}
    for way, frames in put.items():
        bench = Bench()
        bench.started[0].put = lambda frame, frames=frames: frames.append(frame) or True
        bench.recorder.snapshot({'x': {}, 'y': {}}, BEGIN, 1)
        if way == 'each':
            some = [(SimpleNamespace(name=name), event) for name, event in events]
            bench.recorder.take(some, 5, 6)
        else:
            axes = [name for name, _ in events]
            bench.recorder.take_many(turn, axes, {2: named}, 5, 6)
    assert put['many'] == put['each']
    assert any(frame.body.startswith(as_array(records[0]).tobytes()[:4]) for frame in put['each'])
