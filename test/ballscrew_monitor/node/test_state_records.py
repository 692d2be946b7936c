# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Records of what outlives the node: what an entry says, and corrections bit for bit."""

import contextlib
import json
from pathlib import Path
import sqlite3
import types

from ballscrew_monitor.core.conversions import SECOND
from ballscrew_monitor.core.fault_codes import Fault
from ballscrew_monitor.core.judgement import EventEnd
from ballscrew_monitor.core.state import NOT_ENDED
from ballscrew_monitor.judge.records import Memory
from ballscrew_monitor.node.state_records import (
    CORRECTIONS,
    Corrections,
    Entry,
    entry_of,
    event_facts,
    Kind,
    TABLES,
)
from hypothesis import given
from hypothesis import strategies as st
import pytest
from surrogate.files.store import Store

SOLVE = types.SimpleNamespace(
    speed=0.1 + 0.2, opposing_load=-1e3, temperature=313.15, solved={'rcs': 1 / 3}
)


def test_an_entry_says_what_when_where_and_why():
    memory = Memory(event_number=4, event_stamp=3 * SECOND, event_start=[SECOND, 0])
    facts = event_facts(memory, NOT_ENDED)
    record = entry_of(Kind.EVENT_END, 'x', memory.event_stamp, facts).record()
    assert list(record)[:5] == ['time', 'stamp_ns', 'axis', 'kind', 'event']
    assert record['time'].endswith('+00:00')
    assert (record['stamp_ns'], record['axis']) == (3 * SECOND, 'x')
    assert (record['kind'], record['event'], record['duration_s']) == ('event_end', 4, 2.0)
    assert (record['cause'], record['code']) == ('UNKNOWN', Fault.CAUSE_UNKNOWN)
    assert (record['value'], record['limit']) == (None, None)


@pytest.mark.parametrize('facts', [None, '{"event":', '[1]', '3'])
def test_an_entry_with_damaged_facts_keeps_the_rest(facts, says):
    record = Entry('now', 5, 'x', 'shelve', facts).record()
    assert record.pop('text') == says('damaged')
    assert record == {'time': 'now', 'stamp_ns': 5, 'axis': 'x', 'kind': 'shelve'}


def test_corrections_come_back_bit_for_bit_and_say_their_units():
    kept = Corrections.of('x', 'abc', [SOLVE])
    (solve,) = CORRECTIONS.read(CORRECTIONS.row(kept)).read_solves()
    assert (kept.axis, kept.surface) == ('x', 'abc')
    assert all(getattr(solve, name) == value for name, value in vars(SOLVE).items())
    (row,) = json.loads(kept.solves)
    assert set(row) == {'speed_rad_s', 'opposing_load_N', 'temperature_K', 'solved'}
    assert Corrections('x').read_solves() == []


@pytest.mark.parametrize('solves', ['', '[1', '3', '[{}]', '[{"speed_rad_s": "fast"}]'])
def test_what_is_no_correction_is_refused(solves):
    with pytest.raises((ValueError, KeyError, TypeError)):
        CORRECTIONS.read({'axis': 'x', 'surface': 'abc', 'solves': solves})


@given(st.data())
def test_every_record_of_the_state_comes_back_from_its_row(data):
    """Whatever a node may write; of a zero SQLite keeps no sign."""
    numbers = st.integers(0, 2**63 - 1)
    values = {
        int: numbers,
        bool: st.booleans(),
        float: st.floats(min_value=0.0, allow_infinity=False),
        str: st.text(max_size=5),
        str | None: st.none() | st.text(max_size=5),
    }
    named = {
        'event': st.integers(0, 2**32 - 1),
        'memory': st.builds('{{"running_time": {}}}'.format, numbers),
        'ending': st.sampled_from([end.name for end in EventEnd]),
        'usual': st.lists(numbers).map(json.dumps),
        'solves': st.just(Corrections.of('x', 'abc', [SOLVE]).solves),
    }
    for table in TABLES.values():
        parts = {name: named.get(name, values[kind]) for name, kind in table.fields.items()}
        record = data.draw(st.builds(table.kind, **parts))
        with contextlib.closing(sqlite3.connect(':memory:')) as database:
            store = Store(Path('none'), [table], version=1, limit=0)
            store.use(database)
            for statement in table.schema:
                database.execute(statement)
            store.put(table, [record])
            (row,) = store.rows(table)
            assert repr(table.read(row)) == repr(record)
