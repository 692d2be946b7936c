# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Record of an axis over a restart."""

import dataclasses
import json
import math

from ballscrew_monitor.core.judgement import EventEnd
from ballscrew_monitor.core.state import Ending, NOT_ENDED, NOT_SHELVED, RESTARTED, Shelving
from ballscrew_monitor.judge.kept import after_restart, AxisRecord
from ballscrew_monitor.judge.records import Memory
from ballscrew_monitor.judge.zone import ACTIVE, PENDING
import pytest

ADA = Ending(EventEnd.ACKNOWLEDGED, 'Ada', 'why')


def remembered(**changes):
    memory = Memory(running_time=5, regime_time=[0, 2, 3, 0], angle=7.5, since=4, stamp=30)
    memory.event_number, memory.event_stamp, memory.event_start[ACTIVE] = 7, 20, 10
    memory.event_start[PENDING] = 29
    return dataclasses.replace(memory, **changes)


def test_the_sums_the_last_event_and_the_shelving_come_back_and_nothing_else():
    memory = remembered(event_derived=[1, 0], event_worst=[0.25, 0.5])
    shelving = Shelving(until=99, reason='nut is ordered')
    record = AxisRecord.of('x', memory, ADA, shelving, 30, [3, 7])
    again = record.read_memory()
    kept = dataclasses.replace(memory, stamp=0, event_start=[10, 0], event_worst=[0.25, math.nan])
    assert repr(again) == repr(kept)
    assert (record.axis, record.event) == ('x', 7)
    assert (record.left_ns, record.reason) == (69, 'nut is ordered')
    assert (record.read_ending(), record.read_usual()) == (ADA, [3, 7])
    assert repr(AxisRecord('x').read_memory()) == repr(Memory())
    assert AxisRecord('x').read_ending() == NOT_ENDED


def test_an_event_that_was_interrupted_is_over_at_its_last_stamp():
    active = AxisRecord.of('x', remembered(event_active=True), NOT_ENDED, NOT_SHELVED, 0, [7])
    record = after_restart(active)
    over = remembered(event_stamp=30)
    assert record == AxisRecord.of('x', over, RESTARTED, NOT_SHELVED, 0, [7])
    assert after_restart(record) is record


@pytest.mark.parametrize(
    'changes',
    [
        {'running_time': -1},
        {'running_time': 1.0},
        {'energy_lost': -1.0},
        {'energy_lost': None},
        {'regime_time': [0, 0, 0]},
        {'zone_time': [0, 0, -1]},
        {'event_active': 1},
        {'event_code': 77},
        {'event_start': [1, 2]},
        {'judged': 3},
    ],
)
def test_a_memory_that_no_node_has_written_is_refused(changes):
    memory = json.dumps(changes)
    with pytest.raises((ValueError, KeyError, TypeError)):
        AxisRecord('x', memory=memory).check()


@pytest.mark.parametrize(
    'changes',
    [
        {'event': 2**32},
        {'event': -1},
        {'left_ns': -1},
        {'ending': 'LATE'},
        {'memory': '[1]'},
        {'usual': '[1.5]'},
        {'usual': '{}'},
    ],
)
def test_a_record_that_no_node_has_written_is_refused(changes):
    AxisRecord('x', event=2**32 - 1).check()
    with pytest.raises((ValueError, KeyError, TypeError)):
        AxisRecord('x', **changes).check()
