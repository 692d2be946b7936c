# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
A node that is killed at any moment, again and again: nothing is lost or counted twice.

As a program this file runs nodes without ROS, a process each, and kills them.

"""

import collections
import contextlib
import itertools
import json
import os
from pathlib import Path
import random
import signal
import subprocess
import sys
import types

from ballscrew_monitor.core.conversions import SECOND
from ballscrew_monitor.core.inputs import InputSample, Source
from ballscrew_monitor.core.state import NOT_ENDED, NOT_SHELVED, RESTARTED
from ballscrew_monitor.judge.kept import AxisRecord
from ballscrew_monitor.judge.monitor import Monitor
from ballscrew_monitor.judge.records import Memory
from ballscrew_monitor.node.alarm import Alarm
from ballscrew_monitor.node.kept_axes import KeptAxes, PERIOD
from ballscrew_monitor.node.restart_state import RestartState
from ballscrew_monitor.node.state_database import read_entries
from ballscrew_monitor.node.state_records import by_key, Corrections
import pytest
from surrogate.files import InputError

STEP = SECOND // 10
FAST, SLOW = 40.0, 10.0  # [rad/s] inside the zone and outside
KILLS = 40
MOST_LOST = 5 * SECOND


def nothing(*args, **kwargs):
    """Stand for what a test has no use for."""


class Machine:
    """An axis, its clock and its node, which is started again and again."""

    def __init__(self, core, folder):
        self.core, self.folder = core, folder
        self.stamp = 1000 * SECOND
        self.said, self.stations = [], {}
        now = types.SimpleNamespace(now=lambda: types.SimpleNamespace(nanoseconds=self.stamp))
        logger = types.SimpleNamespace(info=self.said.append, warning=self.said.append)
        self.node = types.SimpleNamespace(
            get_clock=lambda: now, get_logger=lambda: logger, create_timer=self.take_timer
        )

    def take_corrections(self, *, late):
        kept = self.state.recall(Corrections('x'), late=late)
        return f'{kept.surface} late' if late else kept.surface

    def take_timer(self, period, look, clock):
        self.look = look

    def start(self):
        self.state = RestartState(self.folder, limit=200_000)
        self.state.start = nothing
        self.retention = KeptAxes(
            self.node, self.state, self.stations, self.said.append, clock=None, catch_up=nothing
        )
        surface = self.core.surface(rcs=lambda speed, load: 0.5 if speed < 20.0 else 0.0)
        limits = self.core.limits(raise_delay=0, clear_delay=0)
        self.monitor = Monitor(surface, self.core.monitor(surface, limits).settings)
        axis = types.SimpleNamespace(name='x', monitor=self.monitor)
        publisher = types.SimpleNamespace(publish=nothing)
        self.alarm = Alarm(self.node, axis, publisher, self.retention, nothing)
        self.stations['x'] = types.SimpleNamespace(
            name='x',
            axis=axis,
            alarm=self.alarm,
            guarded=lambda place, call, *args: call(*args),
            restore=self.take_corrections,
            end_shelving=self.alarm.end_shelving,
        )
        self.retention.restore()

    def move(self, speed):
        """Take a sample, and let the thread that writes have its turn."""
        self.stamp += STEP
        for source, value in ((Source.LOAD, -1000.0), (Source.SPEED, speed)):
            sample = InputSample(source=source, value=value, stamp=self.stamp)
            row = self.monitor.update(sample)
        if row is not None and row.edge:
            self.alarm.follow(row, {})
        if self.stamp % SECOND == 0:
            self.look()
        self.state.work(self.stamp / SECOND)

    @property
    def running_time(self):
        return self.monitor.memory.running_time


def live(machine, pipe):
    """Move for ever; tell stamp [ns], running time [ns] and how much of it is on the disk [ns]."""
    machine.start()
    # Only a power cut would need it, and the disk is slow.
    machine.state._database._database.execute('PRAGMA synchronous = OFF')
    os.write(pipe, b'0 %d 0\n' % machine.running_time)
    for speed in itertools.cycle([FAST] * 7 + [SLOW] * 6):
        machine.move(speed)
        record = machine.state._latest[AxisRecord, 'x']
        written = 0 if machine.state._changed else record.read_memory().running_time
        os.write(pipe, b'%d %d %d\n' % (machine.stamp, machine.running_time, written))


def life(machine):
    """Run a node in a process, kill it somewhere, and return all lines that it has told."""
    reading, writing = os.pipe()
    child = os.fork()
    if not child:
        try:
            live(machine, writing)
        finally:
            os._exit(1)
    os.close(writing)
    wanted = random.randrange(200)
    with open(reading) as pipe:
        lines = list(itertools.islice(pipe, wanted))
        os.kill(child, signal.SIGKILL)
        lines += [line for line in pipe if line.endswith('\n')]
    assert os.waitpid(child, 0)[1] == signal.SIGKILL
    return [[int(number) for number in line.split()] for line in lines]


def ended_by_a_restart(folder):
    """Return the events in the log that a kill has hit; it keeps the newest entries alone."""
    with contextlib.suppress(InputError):  # killed before there was a file
        entries = [entry.record() for entry in read_entries(Path(folder))]
        return [one['event'] for one in entries if one.get('ending') == RESTARTED.text]
    return []


def kill(folder):
    """Kill a node again and again, and print what each one has told and has in its log."""
    sys.path.insert(0, str(Path(__file__).parents[1]))
    import conftest

    conftest.take_constants(pytest.MonkeyPatch())
    random.seed(1)
    core = types.SimpleNamespace(
        surface=conftest.ConstantSurface,
        limits=conftest.make_limits,
        monitor=conftest.make_monitor,
    )
    machine = Machine(core, folder)
    for _ in range(KILLS):
        lines = life(machine)
        machine.stamp = max([machine.stamp, *(stamp for stamp, *_ in lines)]) + STEP
        print(json.dumps([lines, ended_by_a_restart(folder)]))


def test_nothing_is_lost_or_counted_twice(core, tmp_path):
    folder = tmp_path / 'state'
    killed = subprocess.run(
        [sys.executable, __file__, folder], stdout=subprocess.PIPE, check=True, text=True
    )
    kept = known = 0
    restarted = set()
    for lines, found in map(json.loads, killed.stdout.splitlines()):
        restarted |= {*found}
        if not lines:
            continue
        (_, first, _), *_ = lines
        # What was on the disk is there again, and that was nearly all.
        assert kept <= first <= known + STEP
        assert known - first < MOST_LOST
        known = lines[-1][1]
        kept = max([kept, *(written for _, _, written in lines)])
    machine = Machine(core, folder)
    machine.start()
    machine.retention.state.close()
    entries = [entry.record() for entry in read_entries(folder)]
    begun, ended = (
        collections.Counter(one['event'] for one in entries if one['kind'] == kind)
        for kind in ('event_begin', 'event_end')
    )
    assert max(begun.values()) == max(ended.values()) == 1
    # The oldest entries are gone, and what is left of them has no hole.
    first, last = min(begun), max(begun)
    assert 1 < first < last - 50
    assert set(begun) == set(range(first, last + 1)) == set(ended) - {first - 1}
    assert len(restarted) > 3


@pytest.fixture(name='machine')
def make_machine(core, tmp_path):
    machine = Machine(core, tmp_path / 'state')
    machine.start()
    yield machine
    machine.state.close()


def test_the_sums_are_written_in_time(machine):
    """With the pause of the thread no more is lost than is promised."""
    known = 0
    for _ in range(200):
        machine.move(FAST)
        rows = machine.state._database._database.execute('SELECT memory FROM axes')
        known = json.loads(rows.fetchone()[0])['running_time']
        assert machine.running_time - known <= MOST_LOST
    assert known > (20 - 2 * PERIOD) * SECOND


def test_an_event_and_its_number_are_one_commit(machine, monkeypatch):
    taken = []
    monkeypatch.setattr(machine.state, 'keep', lambda *given: taken.append(given))
    machine.move(SLOW)
    machine.move(FAST)
    machine.alarm.acknowledge()
    machine.alarm.reset_totals()
    memories = [record.read_memory() for record, _ in taken]
    told = [
        (entry.kind, memory.event_number, memory.event_active)
        for memory, (_, entry) in zip(memories, taken, strict=True)
    ]
    assert told == [
        ('event_begin', 1, True),
        ('event_end', 1, False),
        ('acknowledge', 1, False),
        ('reset_totals', 1, False),
    ]


def test_what_an_earlier_node_left_is_taken_up_late(machine):
    memory = Memory(running_time=7 * SECOND, event_number=41, event_active=True)
    before = AxisRecord.of('x', memory, NOT_ENDED, NOT_SHELVED, 0)
    machine.move(SLOW)
    machine.move(SLOW)
    assert machine.monitor.memory.event_number == 1
    machine.state._found = by_key([Corrections('x', 'abc')])
    machine.look()
    assert machine.monitor.memory.event_number == 1
    assert machine.running_time == STEP
    assert 'axis x: abc late' in machine.said
    machine.state._found = by_key([before])
    machine.look()
    assert machine.monitor.memory.event_number == 42
    assert machine.running_time == 7 * SECOND + STEP
    assert machine.said[-1] == ['x']


def test_what_is_wrong_is_logged_once(machine):
    machine.state.damage.append('a file is damaged')
    machine.said.clear()
    for _ in range(2):
        machine.look()
    machine.state.forget_problems()
    machine.look()
    assert machine.said == ['state_dir: a file is damaged', 'state_dir: all is kept again']


if __name__ == '__main__':
    kill(Path(sys.argv[1]))
