# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""What a monitor gives to be kept, and how it goes on with it."""

import dataclasses
import math

from ballscrew_monitor.core.conversions import SECOND
from ballscrew_monitor.core.inputs import InputSample, Source
from ballscrew_monitor.core.judgement import Code, Finding, Level, Severity
from ballscrew_monitor.core.memory import (
    after_restart,
    AxisRecord,
    Memory,
    memory_of,
    read_record,
    record_of,
    RESTARTED,
)
from ballscrew_monitor.core.monitor import Monitor
from ballscrew_monitor.core.shelving import NOT_SHELVED, Shelving
from ballscrew_monitor.core.state import Event
from ballscrew_monitor.core.tally import Totals
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


def test_an_event_that_was_interrupted_is_over():
    active = dataclasses.replace(KEPT, event=dataclasses.replace(KEPT.event, active=True))
    memory = after_restart(active)
    assert memory.event == dataclasses.replace(KEPT.event, ending=RESTARTED)
    assert (memory.totals, memory.shelving) == (KEPT.totals, KEPT.shelving)
    assert after_restart(KEPT) is KEPT


RICH = Memory(
    totals=Totals(running_time=2**60 + 1, outside_time=3, angle=0.1 + 0.2, energy_lost=1e-9),
    event=Event(
        number=7,
        active=True,
        stamp=20,
        start=10,
        worst_value=1 / 3,
        cause=Finding(code=Code.RCS_HIGH, severity=Severity.WARN, value=0.5, limit=0.25, text='t'),
    ),
    shelving=Shelving(until=30, reason='Nut für Montag bestellt'),
)


@pytest.mark.parametrize('memory', [RICH, KEPT, Memory()])
def test_a_record_holds_all_of_a_memory_bit_for_bit(memory):
    record = record_of('x', memory)
    assert record.axis == 'x'
    assert repr(memory_of(record)) == repr(memory)
    assert repr(read_record(record.row())) == repr(record)


def test_a_record_of_nothing_is_that_of_a_memory_of_nothing():
    assert repr(AxisRecord(axis='x')) == repr(record_of('x', Memory()))


@pytest.mark.parametrize(
    ('name', 'value'),
    [
        ('running_time_ns', -1),
        ('running_time_ns', 1.5),
        ('running_time_ns', True),
        ('running_time_ns', None),
        ('angle_rad', None),
        ('angle_rad', math.inf),
        ('energy_lost_J', -1.0),
        ('energy_lost_J', 'much'),
        ('event', 2**32),
        ('cause', 'BAD_LUCK'),
        ('severity', None),
        ('until_ns', 'tomorrow'),
        ('reason', None),
    ],
)
def test_a_row_that_no_node_has_written_is_refused(name, value):
    with pytest.raises((ValueError, KeyError, TypeError)):
        read_record(record_of('x', RICH).row() | {name: value})
