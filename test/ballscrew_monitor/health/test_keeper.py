# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The keeper: what waits is written once, and a baseline is learned or named by a request."""

import contextlib
import sqlite3

from ballscrew_monitor.health.assess import HealthSettings
from ballscrew_monitor.health.baseline import LEARNED
from ballscrew_monitor.health.collect import Collected
from ballscrew_monitor.health.keeper import HealthKeeper
from ballscrew_monitor.health.records import Condition, SpectrumBin
from ballscrew_monitor.health.rows import DAY
from ballscrew_monitor.health.store import HealthStore
import pytest

HOUR = 3600.0


@pytest.fixture(name='kept')
def make_kept(tmp_path, motion, surface, usual_limits):
    with contextlib.closing(HealthStore(tmp_path)) as store:
        store.load()
        yield Kept(store, motion, surface, usual_limits)


class Kept:
    """A keeper of axis x with days of motion."""

    def __init__(self, store, motion, surface, limits):
        self.store, self.motion, self.surface = store, motion, surface
        self.settings = HealthSettings(limits=limits)
        self.keeper, self.today = HealthKeeper('x', store), motion.today

    def day(self, day, *, hours=1.0, today=None):
        """Gather thirty stretches of a day in both directions, and the motion that it had."""
        start = day * DAY + DAY // 2
        stretches = [
            self.motion.stretch(start=start + number, motor_torque=way * 0.9, speed=way * 50.0)
            for number in range(15)
            for way in (1, -1)
        ]
        one = SpectrumBin(
            first_day=day, load_band=1, axial_load=500.0, angle=9.0, speed=50.0, time=hours * HOUR
        )
        self.keeper.gather(Collected(stretches, [one]), today or day)

    def days(self, *days):
        for day in days:
            self.day(day)
            self.keeper.keep(day)

    def health(self, today=None):
        now = (today or self.today) * DAY + 5
        return self.keeper.assess(now, self.surface, self.settings)

    def name(self, **changes):
        asked = {'begin': 0, 'end': 0, 'running_in': 0.0, 'reason': 'oil', 'screw': 's'}
        return self.keeper.name_baseline(self.today * DAY + 7, **asked | changes)


def test_what_is_gathered_is_written_once(kept):
    kept.day(kept.today)
    assert kept.store.read('x').cells == ()
    kept.keeper.keep(kept.today)
    kept.keeper.keep(kept.today)
    found = kept.store.read('x')
    assert [one.stretches for one in found.cells] == [15, 15]
    assert [one.time for one in found.spectrum] == [HOUR]
    kept.day(kept.today)
    kept.keeper.keep(kept.today)
    found = kept.store.read('x')
    assert [one.stretches for one in found.cells] == [30, 30]
    assert [one.time for one in found.spectrum] == [2 * HOUR]


def test_what_cannot_be_written_waits(kept):
    kept.day(kept.today)
    with contextlib.closing(sqlite3.connect(kept.store.file, isolation_level=None)) as holder:
        holder.execute('BEGIN EXCLUSIVE')
        with pytest.raises(sqlite3.OperationalError, match='locked'):
            kept.keeper.keep(kept.today)
    kept.keeper.keep(kept.today)
    assert [one.stretches for one in kept.store.read('x').cells] == [15, 15]


def test_a_clock_that_leaps_is_a_note_and_nothing_counts(kept, says):
    kept.day(kept.today - 365, today=kept.today)
    kept.keeper.keep(kept.today)
    assert kept.store.read('x') == ((), (), (), ())
    assert kept.health().notes[-1] == says('leap')
    assert says('leap') not in kept.health().notes


def test_a_baseline_is_learned_over_the_first_logs(kept):
    days = range(kept.today - 55, kept.today + 1, 5)
    kept.days(*days[:4])
    assert kept.health(days[3]).baseline is None
    kept.days(*days[4:])
    health = kept.health()
    assert (health.condition, health.baseline.reason) == (Condition.NORMAL, LEARNED)
    assert health.baseline.begin == days[0] * DAY
    assert health.quantity('drag change').value == pytest.approx(0.0, abs=1e-6)


def test_a_baseline_that_is_named_is_learned_from_then_on(kept):
    kept.days(*range(kept.today - 77, kept.today, 7))
    assert kept.health().baseline is not None
    assert kept.name(reason='new screw', running_in=HOUR) == 'the baseline is learned from now on'
    health = kept.health()
    assert (health.condition, health.baseline) == (Condition.UNKNOWN, None)
    later = range(kept.today + 7, kept.today + 84, 7)
    kept.days(*later)
    found = kept.health(later[-1]).baseline
    assert (found.reason, found.named_at) == ('new screw', kept.today * DAY + 7)
    assert found.begin == later[1] * DAY


def test_a_baseline_is_that_of_the_logs_between_two_times(kept, refused):
    days = range(kept.today - 77, kept.today + 1, 7)
    kept.days(*days)
    begin, end = days[2] * DAY, days[6] * DAY
    assert kept.name(begin=begin, end=end) == 'named the baseline'
    baseline = kept.health().baseline
    assert (baseline.begin, baseline.end, baseline.reason) == (begin, end, 'oil')
    refused('no_reason', kept.name, reason=' ')
    refused('running_in', kept.name, running_in=-1.0)
    refused('no_number', kept.name, running_in=float('nan'))
    refused('ends_first', kept.name, begin=end, end=begin)
    refused('too_few', kept.name, begin=1, end=DAY)
    assert kept.health().baseline == baseline
