# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""What an axis remembers, on the disk: bit for bit, or not at all."""

import json
import math

from ballscrew_monitor.core.judgement import Code, Finding, Severity
from ballscrew_monitor.core.memory import Memory, NOTHING
from ballscrew_monitor.core.shelving import Shelving
from ballscrew_monitor.core.state import Event
from ballscrew_monitor.core.tally import Totals
from ballscrew_monitor.node.memory_store import memory_record, MemoryStore, read_memory
from ballscrew_monitor.node.state_folder import StateFolder
import pytest
from surrogate.files import InputError, to_json

MEMORY = Memory(
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


@pytest.fixture(name='store')
def make_store(tmp_path):
    folder = StateFolder(tmp_path)
    yield MemoryStore(folder)
    folder.close()


def test_what_is_kept_comes_back_bit_for_bit(store):
    assert store.load('x') is NOTHING
    assert store.save('x', MEMORY) == ''
    assert store.load('x') == MEMORY
    assert store.load('y') is NOTHING


def test_an_axis_without_an_event_is_kept_too(store):
    store.save('x', NOTHING)
    kept = store.load('x')
    assert (kept.totals, kept.shelving, kept.event.number) == (NOTHING.totals, NOTHING.shelving, 0)
    assert math.isnan(kept.event.worst_value)


def test_the_file_says_its_units():
    record = memory_record(MEMORY)
    assert {'running_time_ns', 'since_ns', 'angle_rad', 'energy_lost_J'} <= set(record['totals'])
    assert {'stamp_ns', 'start_ns'} <= set(record['event'])
    assert record['shelving'] == {'until_ns': 30, 'reason': 'Nut für Montag bestellt'}


def spoiled(*path, value):
    """Return the record of a memory with one value changed, None: without it."""
    record = json.loads(json.dumps(to_json(memory_record(MEMORY))))
    part = record
    for name in path[:-1]:
        part = part[name]
    part[path[-1]] = value
    return record


@pytest.mark.parametrize(
    'record',
    [
        {},
        spoiled('totals', value=3),
        spoiled('totals', 'running_time_ns', value=-1),
        spoiled('totals', 'running_time_ns', value=1.5),
        spoiled('totals', 'running_time_ns', value=True),
        spoiled('totals', 'angle_rad', value=None),
        spoiled('totals', 'energy_lost_J', value=-1.0),
        spoiled('event', 'event', value=2**32),
        spoiled('event', 'cause', value='BAD_LUCK'),
        spoiled('shelving', 'until_ns', value='tomorrow'),
    ],
)
def test_a_damaged_file_is_set_aside_with_a_sentence(store, tmp_path, record):
    with pytest.raises((ValueError, KeyError, TypeError)):
        read_memory(record)
    path = tmp_path / 'x.memory.json'
    path.write_text(json.dumps({'version': 1, **record}))
    with pytest.raises(InputError, match='is damaged .*, moved to x.memory.damaged'):
        store.load('x')
    assert store.load('x') is NOTHING
