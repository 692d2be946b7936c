# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Memory over a restart, as a record too."""

import dataclasses

from ballscrew_monitor.core.conversions import SECOND
from ballscrew_monitor.core.judgement import Code, Finding, Severity
from ballscrew_monitor.core.memory import (
    after_restart,
    AxisRecord,
    check_record,
    Memory,
    memory_of,
    record_of,
    RESTARTED,
)
from ballscrew_monitor.core.state import Event, Shelving, Totals
import pytest

START = 1000 * SECOND
KEPT = Memory(
    totals=Totals(running_time=5 * SECOND, optimal_time=5 * SECOND, angle=7.5, since=SECOND),
    event=Event(number=7, stamp=20, start=10),
    shelving=Shelving(until=START + 10 * SECOND, reason='nut is ordered'),
)


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
    check_record(record)


def test_a_record_of_nothing_is_that_of_a_memory_of_nothing():
    assert repr(AxisRecord(axis='x')) == repr(record_of('x', Memory()))


@pytest.mark.parametrize(
    ('name', 'value'),
    [
        ('running_time_ns', -1),
        ('energy_lost_J', -1.0),
        ('event', 2**32),
        ('cause', 'BAD_LUCK'),
        ('severity', 'MUCH'),
    ],
)
def test_a_record_that_no_node_has_written_is_refused(name, value):
    with pytest.raises((ValueError, KeyError)):
        check_record(dataclasses.replace(record_of('x', RICH), **{name: value}))
