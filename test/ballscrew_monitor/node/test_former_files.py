# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Files of the former format: taken over once, and never lost."""

import json

from ballscrew_monitor.core.memory import AxisRecord, memory_of
from ballscrew_monitor.node.former_files import PLACE
from ballscrew_monitor.node.restart_state import RestartState
from ballscrew_monitor.node.state_database import read_entries
from ballscrew_monitor.node.state_records import Corrections
import pytest

EVENT = {
    'event': 7,
    'stamp_ns': 20,
    'start_ns': 10,
    'worst_value': 0.5,
    'cause': 'RCS_HIGH',
    'severity': 'WARN',
    'value': 0.5,
    'limit': None,
    'unit': '-',
    'text': 'contact',
}
TIMES = ('running', 'unjudged', 'boundary', 'mixed', 'hydrodynamic', 'optimal', 'outside')
TOTALS = {f'{name}_time_ns': number for number, name in enumerate(TIMES, 2**60)}
MEMORY = {
    'version': 1,
    'totals': TOTALS | {'since_ns': 5, 'angle_rad': 0.1 + 0.2, 'energy_lost_J': 1e-9},
    'event': EVENT | {'active': True, 'ending': ''},
    'shelving': {'until_ns': 30, 'reason': 'Nut für Montag bestellt'},
}
POINT = {'speed_rad_s': 0.1 + 0.2, 'opposing_load_N': -1e3, 'temperature_K': 313.15}
CORRECTIONS = {'version': 1, 'surface': 'abc', 'corrections': [POINT | {'solved': {'rcs': 1 / 3}}]}
START = {
    'time': '2026-11-23T12:00:00.000+00:00',
    'stamp_ns': 1,
    'axis': None,
    'kind': 'node_start',
}
FILES = {
    'x.memory.json': json.dumps(MEMORY),
    'x.corrections.json': json.dumps(CORRECTIONS),
    'events.000002.jsonl': json.dumps(START | {'stamp_ns': 2}) + '\n',
    'events.000010.jsonl': json.dumps(START | {'stamp_ns': 10}) + '\n',
    'events.jsonl': json.dumps(START | {'stamp_ns': 20}) + '\n{"time": "2026-1\n[1]\n',
}
BLANK = AxisRecord(axis='x')


def logged(kind, number, ending=''):
    facts = EVENT | {'event': number, 'ending': ending, 'duration_s': 1.0, 'advice': ''}
    return json.dumps(START | facts | {'axis': 'x', 'kind': kind, 'stamp_ns': 99}) + '\n'


@pytest.fixture(name='start')
def make_start(tmp_path):
    opened = []

    def start(**changes):
        for name, content in (FILES | changes).items():
            (tmp_path / name).write_text(content)
        opened.append(RestartState(tmp_path))
        return opened[-1]

    yield start
    for state in opened:
        state.close()


def test_all_is_taken_over_bit_for_bit_and_set_aside(start, tmp_path):
    own = {'events.old.jsonl': 'my own', '.x.memory.ab12.json': 'half'}
    state = start(**own)
    memory = memory_of(state.recall(BLANK))
    assert (memory.totals.running_time, memory.totals.outside_time) == (2**60, 2**60 + 6)
    assert (memory.totals.angle, memory.totals.energy_lost) == (0.1 + 0.2, 1e-9)
    assert (memory.event.number, memory.event.active, memory.event.worst_value) == (7, True, 0.5)
    assert (memory.shelving.until, memory.shelving.reason) == (30, 'Nut für Montag bestellt')
    kept = state.recall(Corrections('x'))
    (solve,) = kept.read_solves()
    assert (kept.surface, solve.speed, solve.solved) == ('abc', 0.1 + 0.2, {'rcs': 1 / 3})
    expected = [START | {'stamp_ns': stamp} for stamp in (2, 10, 20)]
    assert [one.record() for one in read_entries(tmp_path)] == expected
    place = tmp_path / PLACE
    said = f'the database replaces 5 files, which are now in {place}'
    assert (state.notices, state.problem) == ([said], '')
    assert {path.name: path.read_text() for path in place.iterdir()} == FILES
    assert {name: (tmp_path / name).read_text() for name in own} == own


@pytest.mark.parametrize(
    ('lines', 'number', 'active'),
    [
        ([], 7, True),
        ([('event_begin', 6), ('event_end', 6)], 7, True),
        ([('event_begin', 7)], 7, True),
        ([('event_end', 7)], 7, False),
        ([('event_end', 7), ('event_begin', 8)], 8, True),
        ([('event_begin', 8), ('event_end', 8)], 8, False),
    ],
)
def test_the_log_may_know_of_a_later_event(start, lines, number, active):
    record = start(**{'events.jsonl': ''.join(logged(*one) for one in lines)}).recall(BLANK)
    assert (record.event, record.active) == (number, active)
    assert record.running_time_ns == 2**60


def test_a_log_alone_tells_the_number_of_the_last_event(start):
    state = start(**{'x.memory.json': '', 'events.jsonl': logged('event_end', 4)})
    assert (state.recall(BLANK).event, state.recall(BLANK).running_time_ns) == (4, 0)


@pytest.mark.parametrize(
    'content', ['', '{}', '{"version": 2}', json.dumps(MEMORY | {'totals': 3}), '[1']
)
def test_a_damaged_file_is_told_and_costs_no_other(start, tmp_path, content):
    state = start(**{'x.memory.json': content})
    assert state.problem.startswith(f'{tmp_path / "x.memory.json"} is damaged (')
    assert state.problem.endswith('), and not taken over')
    assert state.recall(BLANK).event == 0
    assert state.recall(Corrections('x')).surface == 'abc'
    assert (tmp_path / PLACE / 'x.memory.json').read_text() == content


def test_they_are_taken_over_once_and_never_overwritten(start, tmp_path):
    first = start()
    assert first.recall(BLANK).event == 7
    first.keep(AxisRecord(axis='x', event=8))
    first.close()
    second = start()
    assert second.recall(BLANK).event == 8
    assert len(read_entries(tmp_path)) == 3
    assert len(list((tmp_path / PLACE).iterdir())) == 2 * len(FILES)
