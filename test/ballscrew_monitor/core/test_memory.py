# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""What a monitor gives to be kept, and how it goes on with it."""

import dataclasses

from ballscrew_monitor.core.conversions import SECOND
from ballscrew_monitor.core.inputs import InputSample, Source
from ballscrew_monitor.core.judgement import Level
from ballscrew_monitor.core.memory import after_restart, Memory, RESTARTED
from ballscrew_monitor.core.shelving import NOT_SHELVED, Shelving
from ballscrew_monitor.core.state import Event
from ballscrew_monitor.core.tally import Totals
from ballscrew_monitor.judge.monitor import Monitor
import pytest

START = 1000 * SECOND
STEP = SECOND // 100
KEPT = Memory(
    totals=Totals(running_time=5 * SECOND, optimal_time=5 * SECOND, angle=7.5, since=SECOND),
    event=Event(number=7, stamp=20, start=10),
    shelving=Shelving(until=START + 10 * SECOND, reason='nut is ordered'),
)


def feed(monitor, speed, count, *, start=START):
    """Feed samples; return the states."""
    states = []
    for number in range(count):
        stamp = start + number * STEP
        monitor.update(InputSample(source=Source.LOAD, value=-1000.0, stamp=stamp))
        states.append(monitor.update(InputSample(source=Source.SPEED, value=speed, stamp=stamp)))
    return states


def slow_is_bad(core, memory):
    """Return a monitor that warns at once below 20 rad/s."""
    surface = core.surface(rcs=lambda speed, load: 0.5 if speed < 20.0 else 0.0)
    made = core.monitor(surface, core.limits(raise_delay=0, clear_delay=0))
    return Monitor(surface, made.settings, memory)


def test_a_monitor_goes_on_where_another_one_ended(core):
    monitor = slow_is_bad(core, KEPT)
    assert monitor.memory == KEPT
    states = feed(monitor, 10.0, 2)
    assert states[0].event.number == 8
    assert states[-1].totals.running_time == 5 * SECOND + STEP
    assert states[-1].totals.since == SECOND
    assert states[-1].shelving == KEPT.shelving
    assert states[-1].level is Level.WARN
    kept = monitor.memory.event
    assert (kept.active, kept.stamp) == (True, START + STEP)


def test_what_was_added_up_before_a_late_memory_counts_too(core):
    monitor = slow_is_bad(core, Memory())
    feed(monitor, 10.0, 3)
    monitor.take_up(KEPT)
    assert (monitor.event.number, monitor.event.active) == (8, True)
    assert monitor.memory.totals.running_time == 5 * SECOND + 2 * STEP
    assert monitor.shelving == KEPT.shelving


def test_a_shelved_warning_is_judged_and_counted_as_ever(core):
    shelved, plain = (slow_is_bad(core, memory) for memory in (KEPT, Memory()))
    for one, other in zip(feed(shelved, 10.0, 20), feed(plain, 10.0, 20), strict=True):
        assert (one.level, one.verdict, one.judged) == (other.level, other.verdict, other.judged)
    late = START + 10 * SECOND
    assert feed(shelved, 10.0, 1, start=late)[0].shelving is NOT_SHELVED


def event(number, active=False):
    return Event(number=number, active=active, stamp=number * SECOND)


@pytest.mark.parametrize(
    ('kept', 'logged', 'number', 'ending'),
    [
        (event(0), event(0), 0, ''),
        (event(3), event(3), 3, ''),
        (event(3, active=True), event(3, active=True), 3, RESTARTED),
        (event(3, active=True), event(3), 3, ''),  # killed before the end was remembered
        (event(3), event(3, active=True), 3, ''),  # the log could not be written
        (event(3), event(4, active=True), 4, RESTARTED),  # killed before it was remembered
        (event(3), event(5), 5, ''),
        (event(3, active=True), event(0), 3, RESTARTED),  # there is no log
        (event(3, active=True), event(2, active=True), 3, RESTARTED),
    ],
)
def test_an_event_that_was_interrupted_is_over(kept, logged, number, ending):
    memory = after_restart(dataclasses.replace(KEPT, event=kept), logged)
    assert memory.event == Event(number=number, stamp=number * SECOND, ending=ending)
    assert memory.totals == KEPT.totals
