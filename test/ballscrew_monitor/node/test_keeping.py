# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""A node that is killed between any two calls to the system, a hundred times over."""

import collections
import contextlib
import io
import itertools
import json
import os
import random
import types

from ballscrew_monitor.core.conversions import SECOND
from ballscrew_monitor.core.inputs import InputSample, Source
from ballscrew_monitor.judge.monitor import Monitor
from ballscrew_monitor.node.alarm import Alarm
from ballscrew_monitor.node.axis_publisher import AxisPublisher
from ballscrew_monitor.node.correction_store import CorrectionStore
from ballscrew_monitor.node.keeping import Keeping
from ballscrew_monitor.node.ledger import Scribe
from ballscrew_monitor.node.state_folder import StateFolder

STEP = SECOND // 10
CALLS = ('open', 'fsync', 'rename', 'replace', 'unlink', 'chmod', 'write')
FAST, SLOW = 40.0, 10.0  # [rad/s] inside the zone and outside


class Killed(BaseException):
    """What a process does not live to see."""


class Reaper:
    """Kills before one of the next calls to the system, and lets none through after that."""

    def __init__(self, monkeypatch):
        self.left = None
        self.locks = []
        for module, name in [*((os, name) for name in CALLS), (io, 'open')]:
            monkeypatch.setattr(module, name, self.guarded(getattr(module, name), name))

    def guarded(self, call, name):
        def guard(*args, **kwargs):
            if self.left is not None:
                self.left -= 1
                if self.left < 0:
                    if name == 'fsync' and self.left == -1:
                        tear(*args)
                    raise Killed
            if name == 'fsync':  # nobody pulls the plug
                return None
            result = call(*args, **kwargs)
            if name == 'open' and str(args[0]).endswith('lock'):
                self.locks.append(result)
            return result

        return guard

    def bury(self):
        """Give back the locks, as the system does for a process that is gone."""
        self.left = None
        for number in self.locks:
            os.close(number)
        self.locks.clear()


def tear(number):
    """Take the last bytes from a file that is not on the disk yet."""
    os.ftruncate(number, max(0, os.fstat(number).st_size - random.randrange(200)))


def nothing(*args, **kwargs):
    """Stand for what a test has no use for."""


class Machine:
    """The clock of the node and the way of the axis, which outlive every node."""

    def __init__(self, core, folder):
        self.core, self.folder = core, folder
        self.stamp = 1000 * SECOND
        self.steady = 0.0
        now = types.SimpleNamespace(now=lambda: types.SimpleNamespace(nanoseconds=self.stamp))
        logger = types.SimpleNamespace(info=nothing, warning=nothing)
        self.node = types.SimpleNamespace(get_clock=lambda: now, get_logger=lambda: logger)

    def start(self):
        """Start the node."""
        self.keeping = Keeping(self.node, StateFolder(self.folder, limit=200_000))
        surface = self.core.surface(rcs=lambda speed, load: 0.5 if speed < 20.0 else 0.0)
        limits = self.core.limits(raise_delay=0, clear_delay=0)
        settings = self.core.monitor(surface, limits).settings
        self.monitor = Monitor(surface, settings, self.keeping.recall('x'))
        axis = types.SimpleNamespace(name='x', monitor=self.monitor)
        publisher = types.SimpleNamespace(publish=nothing)
        self.alarm = Alarm(self.node, axis, publisher, self.keeping, nothing)

    def move(self, speed):
        """Take a sample, and let the thread that writes have its turn."""
        self.stamp += STEP
        self.steady += STEP / SECOND
        for source, value in ((Source.LOAD, -1000.0), (Source.SPEED, speed)):
            sample = InputSample(source=source, value=value, stamp=self.stamp)
            state = self.monitor.update(sample)
        if state is not None and state.event is not None:
            self.alarm.follow(state)
        if self.stamp % (5 * SECOND) == 0:
            self.alarm.remember()
        self.keeping._ledger.work(self.steady)

    @property
    def running_time(self):
        """Return what the monitor knows [ns]."""
        return self.monitor.memory.totals.running_time

    @property
    def on_the_disk(self):
        """Return what has been written of it [ns], 0 while it is not known."""
        if self.keeping._ledger.waiting('x') is not None:
            return 0
        return self.keeping._remembered['x']['totals']['running_time_ns']


def test_corrections_that_cannot_be_kept_are_told(tmp_path):
    folder = StateFolder(tmp_path, limit=20)
    keeping = Keeping(None, folder)
    surface = types.SimpleNamespace(base_sha256='abc', corrections=[])
    publisher = types.SimpleNamespace(
        name='x', surface=surface, _store=CorrectionStore(folder), _keeping=keeping
    )
    full = f'{tmp_path} is at its state_limit of 2e-05 MB'
    assert AxisPublisher._save(publisher) == full
    assert keeping.problem == f'corrections of x are not kept, {full}'
    folder.limit = 1000
    assert AxisPublisher._save(publisher) == keeping.problem == ''
    folder.close()


def lines_of(folder):
    """Return the whole lines of the log, and how many are torn."""
    whole, torn = [], 0
    for path in [*sorted(folder.glob('events.*.jsonl')), folder / 'events.jsonl']:
        for line in path.read_text().splitlines():
            try:
                whole.append(json.loads(line))
            except ValueError:
                torn += 1
    return whole, torn


def test_nothing_is_lost_or_counted_twice(core, tmp_path, monkeypatch):
    random.seed(1)
    monkeypatch.setattr(Scribe, 'start', nothing)
    machine, reaper = Machine(core, tmp_path), Reaper(monkeypatch)
    kept = known = 0
    for _ in range(100):
        with contextlib.suppress(Killed):
            reaper.left = random.randrange(100)
            machine.start()
            # What was on the disk is there again, and that was nearly all.
            assert kept <= machine.running_time <= known + STEP
            assert known - machine.running_time <= 6 * SECOND
            for speed in itertools.cycle([FAST] * 7 + [SLOW] * 6):
                machine.move(speed)
                kept, known = max(kept, machine.on_the_disk), machine.running_time
        reaper.bury()
    machine.start()
    machine.keeping.flush()
    lines, torn = lines_of(tmp_path)
    assert torn > 0
    begun, ended = (
        collections.Counter(line['event'] for line in lines if line['kind'] == kind)
        for kind in ('event_begin', 'event_end')
    )
    assert max(begun.values()) == max(ended.values()) == 1
    # The log has been rotated, and what is left of it has no hole.
    first, last = min(begun), max(begun)
    assert 1 < first < last - 50
    assert set(begun) == set(range(first, last + 1)) == set(ended) - {first - 1}
    assert sum('restart' in line.get('ending', '') for line in lines) > 10
    left = {path.name for path in tmp_path.iterdir() if not path.match('events.*')}
    assert left == {'lock', 'x.memory.json'}
    reaper.bury()
