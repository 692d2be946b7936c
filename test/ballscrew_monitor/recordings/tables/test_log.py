# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""A table as a log: its rows are judged as the messages of the bag that `import` writes."""

import dataclasses
from pathlib import Path
import tempfile
import tracemalloc

from ballscrew_monitor.core.conversions import SECOND
from ballscrew_monitor.judge import many
from ballscrew_monitor.recordings.bag import Bag
from ballscrew_monitor.recordings.log_facts import parameters_of
from ballscrew_monitor.recordings.replay import replay, replay_parts
from ballscrew_monitor.recordings.summary import AxisOutcome
from ballscrew_monitor.recordings.tables import doubts, sources, times
from ballscrew_monitor.recordings.tables import log as table_log
from ballscrew_monitor.recordings.tables.convert import convert
from ballscrew_monitor.recordings.tables.log import TableLog
from ballscrew_monitor.recordings.tables.mapping import make_map
from ballscrew_msgs.msg import OutOfZone
from hypothesis import example, given, settings
from hypothesis import strategies as st
import numpy as np
import polars as pl
import pytest
from surrogate.surface import Found

TIME = {'column': 't', 'unit': 'ms', 'epoch': '2000-01-01T00:00:00Z'}
BEGIN = 946_684_800 * SECOND  # [ns]
LOAD = {'column': 'F', 'unit': 'N', 'magnitude': False}
TORQUE = {'column': 'M', 'unit': 'N m', 'magnitude': False}
WARM = {'column': 'T', 'unit': 'degC'}
SPEED = {'column': 'v', 'unit': 'mm/s', 'magnitude': False, 'hold': False}
CURRENT = {'torque_constant_Nm_per_A': 0.2, 'efficiency': 0.9, 'load': {'from': 'current'}}
MAPS = [
    {'x': {'speed': SPEED, 'load': LOAD}},
    {'x': {'speed': SPEED, 'position': {'column': 'p', 'unit': 'mm'}, 'torque': TORQUE}},
    {
        'x': {'position': {'column': 'p', 'unit': 'mm'}, 'load': LOAD, 'temperature': WARM},
        'y': {
            'speed': SPEED,
            'current': {'column': 'M', 'unit': 'A', 'magnitude': False},
            **CURRENT,
        },
    },
    {
        'x': {
            'speed': SPEED,
            'torque': TORQUE,
            'load': {'from': 'motor_torque'},
            'torque_uncertainty_Nm': 0.02,
            'inertia_kg_m2': 1e-4,
        },
        'y': {
            'speed': SPEED | {'column': 'p', 'unit': 'rev/min'},
            'load': LOAD,
            'temperature': WARM,
        },
    },
]
"""Axes with all kinds of inputs: measured, derived, unknown, of rates of their own."""
OF_STATES = {field.name for field in dataclasses.fields(Found)} - set(
    'validity rcs film_ratio efficiency driving_torque friction_torque worst_contact'.split()
)
"""Numbers that are looked up for the row of a state alone, or say where a point lies."""


def map_of(axes):
    """Return a map of some axes."""
    known = {
        name: {'load': {'unknown': 'no sensor'}, 'lead_mm': 10.0} | axes[name] for name in axes
    }
    return make_map({'time': TIME, 'axes': known})


def judged(log, values):
    """Return the rows of each axis as bytes, column by column, and what it comes to."""
    blocks, outcomes = {}, []
    for part in replay_parts(log, values, states=False):
        if isinstance(part, AxisOutcome):
            outcomes.append(part)
        else:
            # The next rows overwrite them.
            blocks.setdefault(part.axis, []).append(part.rows.copy())
    rows = {axis: np.concatenate(parts) for axis, parts in blocks.items()}
    return {axis: compared(found) for axis, found in rows.items()}, outcomes


def compared(rows):
    """Return the columns of rows as bytes; some numbers are there only for published rows."""
    rows = rows.copy()
    for name in many.ROW.names:
        if name in OF_STATES:
            rows[name][~rows['published']] = 0
    return {name: rows[name].tobytes() for name in many.ROW.names}


def rows_and_outcome(log):
    """Return the rows of the only axis, and what it comes to; the next rows overwrite them."""
    parts = replay_parts(log, parameters_of(log), states=False)
    copies = [part if isinstance(part, AxisOutcome) else part.rows.copy() for part in parts]
    return np.concatenate(copies[:-1]), copies[-1]


def write(folder, columns):
    """Return a CSV of columns, without numbers where they are None."""
    path = Path(folder) / 'log.csv'
    pl.DataFrame(columns).write_csv(path)
    return path


STEP = st.sampled_from([0, 1, 10, 50, 400, 70_000])  # [ms]
CELL = st.none() | st.floats(-2000.0, 2000.0)
ROW = st.tuples(STEP, CELL, CELL, CELL, CELL, st.none() | st.floats(10.0, 70.0))
WHOLE = (10, 100.0, -500.0, 0.7, 3.0, 40.0)
MOVED = (10, 110.0, -400.0, 0.8, 4.0, None)
HOLE_AFTER_A_PLACE = [(50, *[None] * 5), (50, None, None, None, 0.0, None), (70_000, *[None] * 5)]
SLOWLY_WARM = [*[(1, *[None] * 5)] * 14, (1, *[None] * 4, 10.0), (400, *[None] * 4, 10.0)]


@given(
    axes=st.sampled_from(MAPS),
    rows=st.lists(ROW, max_size=60),
    block=st.sampled_from([1, 3, 1000]),
    events=st.sampled_from([1, 7, 100_000]),
)
@example(axes=MAPS[2], rows=[(0, *MOVED[1:])] * 9, block=3, events=7)
@example(axes=MAPS[1], rows=HOLE_AFTER_A_PLACE, block=1, events=1)
@settings(max_examples=settings.default.max_examples // 3)
def test_a_table_and_the_bag_of_it_are_judged_to_the_same_bits(axes, rows, block, events):
    """Steps are of zero and of more than a minute, and any cell may be empty."""
    rows = [WHOLE, MOVED, *rows, *[MOVED] * len(rows)]  # most times rise
    steps, speed, load, torque, position, warmth = zip(*rows)
    columns = {'t': np.cumsum(steps), 'v': speed, 'F': load, 'M': torque}
    columns |= {'p': position, 'T': warmth}
    with tempfile.TemporaryDirectory() as folder, pytest.MonkeyPatch.context() as patch:
        patch.setattr(doubts, 'fault_of_slope', lambda *_: '')  # places at random are no motion
        path = write(folder, columns)
        bag = Path(folder) / 'bag'
        convert(path, map_of(axes), bag)
        patch.setattr(sources, 'BLOCK', block)
        patch.setattr(table_log, 'AT_ONCE', events)
        log = TableLog(path, map_of(axes))
        bag = Bag(bag)
        values = parameters_of(log)
        assert values == parameters_of(bag)
        assert judged(log, values) == judged(bag, values)
        assert (log.start_time, log.end_time) == (bag.start_time, bag.end_time)


@pytest.mark.parametrize(
    'changes',
    [
        {'x.speed.field': 'velocity[0]', 'x.load.scale': -2.0},
        {'x.speed.field': 'velocity[w_axis]'},
        {'x.speed.field': 'position[x_axis]', 'x.speed.unit': 'rad'},
        {'x.torque.topic': 'joint_states', 'x.torque.field': 'effort[1]'},
        {'x.load.field': 'wrench.torque.z', 'x.load.topic': 'y/axial_load'},
        {'axes': ['y'], 'y.speed.field': 'velocity[x_axis]', 'y.load.topic': 'x/axial_load'},
    ],
)
def test_any_parameters_read_a_table_as_they_read_its_bag(tmp_path, changes):
    count = np.arange(60.0)
    columns = {'t': 20 * count, 'v': 90 * np.sin(count), 'p': count, 'F': 9 * count - 300}
    path = write(tmp_path, columns)
    mapping = map_of({axis: {'speed': SPEED, 'load': LOAD} for axis in 'xy'})
    convert(path, mapping, tmp_path / 'bag')
    log, bag = TableLog(path, mapping), Bag(tmp_path / 'bag')
    values = parameters_of(log)
    values |= {'x.torque.type': 'sensor_msgs/msg/JointState'} | changes
    assert judged(log, values) == judged(bag, values)
    states = [[str(state) for state, _ in replay(each, values)] for each in (log, bag)]
    assert states[0] == states[1]


def test_an_empty_cell_is_no_sample_and_the_last_load_stays(tmp_path):
    columns = {
        't': [0, 10, 20, 30],
        'v': [100.0, 100.0, None, 100.0],
        'F': [-5.0, None, -6.0, None],
    }
    log = TableLog(write(tmp_path, columns), map_of(MAPS[0]))
    rows, outcome = rows_and_outcome(log)
    at = ~rows['tick']
    assert (rows['stamp'][at] - BEGIN).tolist() == [0, 10_000_000, 30_000_000]
    assert rows['axial_load'][at].tolist() == [-5.0, -5.0, -6.0]
    assert not any(outcome.refused.values())


@pytest.mark.parametrize('block', [1, 2, 1000])
def test_rows_of_one_time_are_judged_with_the_last_load_of_them(tmp_path, block, monkeypatch):
    monkeypatch.setattr(sources, 'BLOCK', block)
    monkeypatch.setattr(table_log, 'AT_ONCE', 1)
    columns = {'t': [0, 10, 10, 10, 20, 30], 'v': [1.0, 2.0, 3.0, 4.0, 5.0, 6.0]}
    columns['F'] = [-1.0, -2.0, -3.0, -4.0, -5.0, -6.0]
    log = TableLog(write(tmp_path, columns), map_of(MAPS[0]))
    rows, _ = rows_and_outcome(log)
    assert rows['axial_load'][~rows['tick']].tolist() == [-1.0, -4.0, -4.0, -4.0, -5.0, -6.0]


def test_what_the_rows_say_of_the_map_is_known_once_they_are_read(tmp_path):
    count = np.arange(400) / 50.0
    columns = {'t': 20 * np.arange(400), 'v': 6.0 * np.sin(count), 'p': 1.0 - np.cos(count)}
    columns['M'] = 0.0 * count
    axis = MAPS[1]['x'] | {'position': {'column': 'p', 'unit': 'mm'}}
    log = TableLog(write(tmp_path, columns), map_of({'x': axis}))
    assert log.notes == []
    values = parameters_of(log)
    for _ in range(2):
        judged(log, values)
        (note,) = log.notes
        assert note.startswith('axis x: its position moves 0.1667 times as far')


def appended(columns, runs):
    """Return the columns of a log to which a logger appended runs, each with the same times."""
    return {name: list(cells) * runs for name, cells in columns.items()}


def by_run(log, values):
    """Return the rows of each run and axis, but for stamps and numbers of events."""
    found = {}
    for part in replay_parts(log, values, states=False):
        if not isinstance(part, AxisOutcome):
            found.setdefault((part.run, part.axis), []).append(part.rows.copy())
    ends = ('stamp', 'now', 'level_since', 'event_id')
    return {
        key: {
            name: column
            for name, column in compared(np.concatenate(parts)).items()
            if name not in ends
        }
        for key, parts in found.items()
    }


@given(
    axes=st.sampled_from(MAPS),
    rows=st.lists(ROW.filter(lambda row: 0 < row[0] < 1000), min_size=12, max_size=24),
    runs=st.integers(2, 3),
    block=st.sampled_from([7, 1000]),
)
@example(axes=MAPS[2], rows=SLOWLY_WARM, runs=2, block=7)
@settings(max_examples=settings.default.max_examples // 6)
def test_each_run_is_judged_as_if_it_were_alone(axes, rows, runs, block):
    """Its rows are bit for bit those of a log of this run, as a table and as the bag of it."""
    rows = [WHOLE, MOVED, *rows, *[MOVED] * len(rows)]
    steps, speed, load, torque, position, warmth = zip(*rows)
    columns = {'t': np.cumsum(steps), 'v': speed, 'F': load, 'M': torque}
    columns |= {'p': position, 'T': warmth}
    with tempfile.TemporaryDirectory() as folder, pytest.MonkeyPatch.context() as patch:
        patch.setattr(doubts, 'fault_of_slope', lambda *_: '')  # places at random are no motion
        patch.setattr(times, 'even_rows', lambda *_: None)
        patch.setattr(sources, 'BLOCK', block)
        alone = TableLog(write(folder, columns), map_of(axes))
        values = parameters_of(alone)
        wanted = by_run(alone, values)
        path = write(folder, appended(columns, runs))
        log, bag = TableLog(path, map_of(axes)), Path(folder) / 'bag'
        convert(path, map_of(axes), bag)
        assert parameters_of(log) == values
        found = by_run(log, values)
        assert found == {
            (run, axis): rows for run in range(runs) for (_, axis), rows in wanted.items()
        }
        assert by_run(Bag(bag), values) == found
        assert len(Bag(bag).run_borders) == runs - 1


def test_a_warning_ends_with_its_run_and_pauses_count_for_nothing(tmp_path):
    """Three runs of 3 s: 80, -40 and 10 mm/s on a lead of 10 mm are 39 revolutions."""
    count = np.arange(300)
    columns = {
        't': np.tile(10 * count, 3),
        'v': np.repeat([80.0, -40.0, 10.0], 300),
        'F': np.repeat([-300.0, 300.0, -300.0], 300),
    }
    log = TableLog(write(tmp_path, columns), map_of(MAPS[0]))
    rows, outcome = rows_and_outcome(log)
    summary = outcome.summary()
    assert [run.duration for run in summary.runs] == pytest.approx([2.99] * 3)
    assert summary.recorded == summary.running_time == pytest.approx(8.97)
    assert summary.revolutions == pytest.approx(8.97 / 3 * 13.0)
    assert [run.revolutions for run in summary.runs] == pytest.approx([23.92, 11.96, 2.99])
    assert [run.warnings for run in summary.runs] == [1, 1, 1]
    assert [event.run_ended for event in outcome.events] == [True, True, False]
    ends = [(event.start, event.end) for event in outcome.events]
    assert ends == [(run.first, run.last) for run in summary.runs]
    assert len(rows) == 900  # no tick lies in a pause
    messages = [event for _, event in replay(log, parameters_of(log)) if event is not None]
    over = [(event.event_id, event.advice) for event in messages if not event.active]
    assert over == [(1, 'the run ended'), (2, 'the run ended')]
    assert {event.ending for event in messages if not event.active} == {OutOfZone.ENDING_RUN_ENDED}
    said = '\n'.join(summary.lines())
    assert 'in motion   9.0 s of 9.0 s, 39 revolutions' in said
    assert 'runs        3, each judged apart' in said


def test_memory_does_not_grow_with_the_rows(tmp_path, monkeypatch):
    monkeypatch.setattr(sources, 'BLOCK', 1000)
    monkeypatch.setattr(table_log, 'AT_ONCE', 2000)
    peaks = []
    for count in (5_000, 5_000, 40_000):  # the first run makes what is made once
        path = tmp_path / f'{count}.parquet'
        time = np.arange(count)
        speed = 100.0 * np.sin(time / 500.0)
        pl.DataFrame({'t': time, 'v': speed, 'F': -speed}).write_parquet(path)
        tracemalloc.start()
        log = TableLog(path, map_of(MAPS[0]))
        for _ in replay_parts(log, parameters_of(log), states=False):
            pass
        peaks.append(tracemalloc.get_traced_memory()[1])
        tracemalloc.stop()
    assert peaks[2] - peaks[1] < 500_000  # 35 000 rows are 840 000 bytes, their events 5 million


def test_a_topic_of_which_a_load_was_worked_out_is_not_unread(tmp_path):
    path = tmp_path / 'log.csv'
    path.write_text('t,v,M\n' + ''.join(f'{n},5.0,\n{n + 5},,0.4\n' for n in range(0, 900, 10)))
    axis = {'speed': SPEED, 'torque': TORQUE, 'load': {'from': 'torque'}, 'lead_mm': 10.0}
    log = TableLog(path, make_map({'time': TIME, 'axes': {'x': axis}}))
    assert log.worked_out == {'/joint_states_2'} <= set(log.topics)
    read = axis | {'load': {'unknown': 'no sensor'}}
    assert not TableLog(path, make_map({'time': TIME, 'axes': {'x': read}})).worked_out
