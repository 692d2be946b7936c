# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The process that records is started again when it is lost, ever later while that goes on."""

from types import SimpleNamespace

from ballscrew_monitor.core.conversions import SECOND
from ballscrew_monitor.node.event_recorder import EventRecorder, LONGEST_RESTART, RESTART
import pytest

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
