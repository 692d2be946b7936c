# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Baselines: of the first logs, after a service event, and of named days."""

from ballscrew_monitor.health.baseline import changed_screw, in_force, LEARNED, named
from ballscrew_monitor.health.records import Baseline
from ballscrew_monitor.health.rows import DAY
import pytest

FIRST, HOUR = 20_000, 3600.0


@pytest.fixture(name='logs')
def weekly_logs(motion):
    return [motion.cell(first_day=FIRST + 7 * week) for week in range(6)]


def test_without_an_event_the_baseline_is_that_of_the_first_days():
    found = in_force((), {}, 91.0)
    assert (found.reason, found.end - found.begin) == (LEARNED, 91 * DAY)


def test_an_event_begins_a_baseline_after_the_running_in():
    event = Baseline(begin=FIRST * DAY, end=0, reason='new screw', left_out=1.5 * HOUR)
    motion = {FIRST + day: HOUR for day in range(5)}
    assert in_force((event,), motion, 10.0).begin == (FIRST + 2) * DAY
    assert in_force((event,), {FIRST: HOUR}, 10.0).begin == (FIRST + 1) * DAY
    assert in_force((event,), {}, 10.0).begin == FIRST * DAY
    closed = Baseline(begin=1, end=2, reason='oil')
    assert in_force((event, closed), motion) is closed


def test_a_named_baseline_has_three_logs_at_least(logs, refused):
    named_at = {'reason': 'oil', 'named_at': 7}
    found = named(logs, FIRST * DAY, (FIRST + 15) * DAY, **named_at)
    assert (found.begin, found.end, found.reason) == (FIRST * DAY, (FIRST + 15) * DAY, 'oil')
    refused('too_few', named, logs, FIRST * DAY, (FIRST + 14) * DAY, **named_at)
    refused('no_reason', named, logs, 1, 2, reason=' ', named_at=7)
    refused('ends_first', named, logs, 2 * DAY, DAY, **named_at)


def test_another_screw_is_suspected_by_its_name_or_by_a_leap_everywhere(says):
    baseline = Baseline(begin=1, end=2, reason='x', screw='a')
    assert changed_screw(baseline, 'b', []) == says('another_sheet')
    assert changed_screw(baseline, 'a', [0.4, 0.6]) == says('leap')
    for changes in ([0.4, 0.1], [-0.4, 0.4], [0.5], []):
        assert changed_screw(baseline, 'a', changes) == ''
