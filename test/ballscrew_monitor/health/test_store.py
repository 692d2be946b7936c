# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The store: what is written is found, ten years are small, and no kill takes the baseline."""

import contextlib
import dataclasses
import math
from pathlib import Path
import sqlite3
import subprocess
import sys

from ballscrew_monitor.health import store as stores
from ballscrew_monitor.health.bands import period_of
from ballscrew_monitor.health.records import Baseline, LoadSource, SpectrumBin
from ballscrew_monitor.health.spectrum import merged_bins
from ballscrew_monitor.health.store import FILE, HealthStore, LIMIT, read_health
from ballscrew_monitor.health.summary import aged, by_place
from hypothesis import given
from hypothesis import strategies as st
import pytest
from surrogate.files import InputError
from surrogate.files.store import Store

YEARS = 10
PLACES = {1: 60, 7: 120, 28: 240}
KILLED = """
import dataclasses, pathlib, sys
from ballscrew_monitor.health.store import HealthStore, read_health
store = HealthStore(pathlib.Path(sys.argv[1]))
store.load()
cell = store.read('x').cells[0]
for number in range(10**6):
    cells = [dataclasses.replace(cell, load_band=load, stretches=1) for load in range(50, 90)]
    store.add('x', cells)
    print(number, flush=True)
"""
"""A process that adds a stretch to forty cells at a time."""


@pytest.fixture(name='make')
def make_store(tmp_path):
    with contextlib.ExitStack() as stack:

        def make(folder=tmp_path, **changes):
            store = HealthStore(folder, **changes)
            stack.callback(store.close)
            store.said = store.load()
            return store

        yield make


@pytest.fixture(name='baseline')
def made_baseline(motion):
    return Baseline(begin=1, end=2, reason='oil', named_at=3, screw='s')


def a_bin(day, **changes):
    values = {'load_band': -2, 'axial_load': -80.5, 'angle': 3.0, 'speed': 1.5, 'time': 2.0}
    return SpectrumBin(**{'first_day': day, 'wear_time': (0.5, 1.5)} | values | changes)


def spoil(folder, *statements):
    with contextlib.closing(sqlite3.connect(folder / FILE, isolation_level=None)) as database:
        for statement in statements:
            database.execute(statement)


def test_what_is_written_is_found_again(make, motion, baseline, tmp_path):
    points = [
        motion.cell(temperature_measured=False, first_day=motion.today - 3, days=7),
        motion.cell(),
        motion.cell(load_source=int(LoadSource.FREE), duration=0.1 + 0.2),
    ]
    bins = [a_bin(3, load_band=99, axial_load=math.nan), a_bin(motion.today, energy_measured=7.0)]
    store = make()
    assert store.said == []
    store.add('x', points, bins)
    store.keep_baseline('x', baseline)
    store.add('y', points)
    store.keep_baseline('y', dataclasses.replace(baseline, reason='screw'))
    store.keep_baseline('x', dataclasses.replace(baseline, reason='grease'))
    found = read_health(tmp_path)  # while it is open
    assert list(found) == ['x', 'y']
    store.close()
    assert {path.name for path in tmp_path.iterdir()} == {FILE}
    for kept in (found['x'], make().read('x')):
        assert repr(kept.cells) == repr(tuple(points))
        assert repr(kept.spectrum) == repr(tuple(bins))
        assert [one.reason for one in kept.baselines] == ['oil', 'grease']
        assert kept.baselines[0] == baseline
        assert kept.notes == ()
    assert make().read('z').baselines == ()


@given(st.data())
def test_every_record_of_health_comes_back_from_its_row(data):
    """Whatever is gathered; of a zero SQLite keeps no sign."""
    numbers = st.integers(1, 2**31)
    values = {
        int: numbers,
        bool: st.booleans(),
        float: st.floats(min_value=1e-300, allow_infinity=False, allow_nan=False),
        str: st.text(max_size=5),
        tuple[float, ...]: st.lists(st.floats(0.0, 1e9), max_size=9).map(tuple),
    }
    unknown = values[float] | st.just(math.nan)
    named = dict.fromkeys(('axial_load', 'energy_measured', 'energy_expected'), unknown)
    for table in stores.TABLES:
        parts = {name: values[kind] for name, kind in table.fields.items()}
        if table is not stores.BASELINES:
            parts |= {name: one for name, one in named.items() if name in parts}
        if table is stores.CELLS:
            parts['direction'] = st.sampled_from([-1, 0, 1])
        record = data.draw(st.builds(table.kind, **parts))
        with contextlib.closing(sqlite3.connect(':memory:')) as database:
            store = Store(Path('none'), [table], version=1, limit=0)
            store.use(database)
            for statement in table.schema:
                database.execute(statement)
            store.put(table, [record], axis='x')
            (row,) = store.rows(table)
            assert repr(table.read(row)) == repr(record)


def test_what_is_added_is_pooled_with_its_period_and_others_stand(make, motion):
    store, today = make(), motion.today
    before = [motion.cell(first_day=today - 1), motion.cell(load_band=3), motion.cell()]
    store.add('x', before, [a_bin(today), a_bin(today - 1)])
    store.add('x', [motion.cell(stretches=9)], [a_bin(today, angle=5.0)])
    kept = store.read('x')
    assert by_place(kept.cells) == by_place([*before, motion.cell(stretches=9)])
    assert sum(one.stretches for one in kept.cells) == 4 + 4 + 4 + 9
    assert {one.angle for one in kept.spectrum} == {3.0, 3.0 + 5.0}


def test_ageing_is_that_of_the_records_and_leaves_the_baselines(make, motion, baseline):
    store, today = make(), motion.today
    points = [motion.cell(first_day=today - age) for age in range(0, 1000, 3)]
    bins = [a_bin(today - age) for age in range(0, 1000, 3)]
    ahead = motion.cell(first_day=today + 400)
    store.add('x', [*points, ahead], bins)
    store.keep_baseline('x', baseline)
    (note,) = store.age('x', today)
    assert note.startswith('1 cells from ')
    kept = store.read('x')
    expected = (*aged(points, today)[0], ahead)
    assert sorted(kept.cells, key=repr) == sorted(expected, key=repr)
    assert sorted(kept.spectrum, key=repr) == sorted(merged_bins(bins, today), key=repr)
    assert kept.baselines[-1] == baseline
    assert sum(one.stretches for one in kept.cells) == 4 * (len(points) + 1)
    assert store.age('x', today) == [note]


def test_the_newest_baselines_are_kept(make, baseline, monkeypatch):
    monkeypatch.setattr(stores, 'MOST_BASELINES', 3)
    store = make()
    for number in range(5):
        store.keep_baseline('x', dataclasses.replace(baseline, named_at=number))
    kept = store.read('x')
    assert [one.named_at for one in kept.baselines] == [2, 3, 4]
    assert kept.cells == ()


def test_ten_years_of_a_busy_axis_are_below_the_limit(make, motion, tmp_path):
    """Sixty places a day, more in a week and a month, and fourteen bins of load in each."""
    store, end = make(), motion.today
    periods = {period_of(day, 1, end) for day in range(end - 365 * YEARS, end)}
    points = [
        motion.cell(
            first_day=first,
            days=days,
            load_band=number,
            motor_torque=0.1 / (1 + number),
            duration=0.3 / (1 + number),
        )
        for first, days in periods
        for number in range(PLACES[days])
    ]
    bins = [
        a_bin(first, days=days, load_band=band, angle=0.1 * first, wear_time=(0.1,) * 9)
        for first, days in periods
        for band in range(14)
    ]
    store.add('x', points, bins)
    store.age('x', end)
    assert len(store.read('x').cells) == len(points) > 40_000
    store.close()
    assert (tmp_path / FILE).stat().st_size < LIMIT / 2


def test_the_oldest_go_where_the_limit_is_reached_and_the_baseline_stays(
    make, motion, baseline, tmp_path
):
    limit = 400_000
    store = make(limit=limit)
    store.keep_baseline('x', baseline)
    for day in range(motion.today - 100, motion.today):
        made = [motion.cell(first_day=day, load_band=one) for one in range(60)]
        store.add('x', made, [a_bin(day)])
    store.close()
    assert (tmp_path / FILE).stat().st_size <= limit
    kept = read_health(tmp_path)['x']
    days = sorted({one.first_day for one in kept.cells})
    assert days == list(range(days[0], motion.today))
    assert motion.today - 100 < days[0] < motion.today - 20
    assert min(one.first_day for one in kept.spectrum) == days[0]
    assert kept.baselines[-1] == baseline


def test_a_killed_process_leaves_a_commit_and_the_baseline(make, motion, baseline, tmp_path):
    """After any number of writes, and within the one that comes next."""
    store = make()
    store.add('x', [motion.cell()])
    store.keep_baseline('x', baseline)
    store.close()
    for writes in (1, 2, 5, 9):
        process = subprocess.Popen(
            [sys.executable, '-c', KILLED, str(tmp_path)], stdout=subprocess.PIPE, text=True
        )
        with process:
            for _ in range(writes):
                last = int(process.stdout.readline())
            process.kill()
        store = make()
        kept = store.read('x')
        store.close()
        assert store.said == []
        assert kept.baselines[-1] == baseline
        (stretches,) = {one.stretches for one in kept.cells if one.load_band >= 50}
        assert (len(kept.cells), stretches > last) == (41, True)


@pytest.mark.parametrize(
    ('statement', 'why'),
    [
        ('PRAGMA user_version = 7', 'is of another version (7, known is 1)'),
        ('DROP TABLE spectrum', 'is damaged (no such table: spectrum)'),
        ('ALTER TABLE cells DROP COLUMN days', 'is damaged (table cells has other columns)'),
    ],
)
def test_what_no_node_has_left_is_kept_aside(make, motion, tmp_path, statement, why):
    store = make()
    store.add('x', [motion.cell()])
    store.close()
    spoil(tmp_path, statement)
    again = make()
    assert again.said == [f'{tmp_path / FILE} {why}, moved to {FILE}.aside']
    assert again.read('x').cells == ()
    again.add('x', [motion.cell()])
    with contextlib.closing(sqlite3.connect(tmp_path / f'{FILE}.aside')) as aside:
        assert aside.execute('SELECT count(*) FROM cells').fetchone() == (1,)


def test_a_damaged_file_is_kept_aside_and_who_reads_is_told(make, motion, tmp_path, refused):
    refused('no_store', read_health, tmp_path)
    store = make()
    store.add('x', [motion.cell()] * 1)
    store.close()
    spoil(tmp_path, 'PRAGMA user_version = 7')
    refused('another_version', read_health, tmp_path)
    (tmp_path / FILE).write_bytes(b'no database' * 1000)
    refused('not_a_database', read_health, tmp_path)
    again = make()
    assert 'is damaged (' in again.said[0]
    assert (tmp_path / f'{FILE}.aside').exists()
    assert again.read('x') == ((), (), (), ())


def test_rows_that_cannot_be_read_are_counted_and_the_others_stand(
    make, motion, baseline, tmp_path, says
):
    store = make()
    points = [motion.cell(first_day=motion.today - age) for age in range(5)]
    store.add('x', points, [a_bin(1), a_bin(2)])
    store.keep_baseline('x', baseline)
    store.close()
    spoil(
        tmp_path,
        f'UPDATE cells SET stretches = -1 WHERE first_day = {motion.today}',
        f"UPDATE cells SET speed = 'fast' WHERE first_day = {motion.today - 1}",
        "UPDATE spectrum SET wear_time = x'00' WHERE first_day = 2",
    )
    kept = make().read('x')
    assert by_place(kept.cells) == by_place(points[2:])
    assert kept.spectrum == (a_bin(1),)
    assert kept.baselines[-1] == baseline
    assert kept.notes == (says('bad_rows', place=tmp_path / FILE),)


def test_a_damaged_text_hides_no_other_row(make, motion, baseline, tmp_path):
    store = make()
    points = [motion.cell(first_day=motion.today - age) for age in range(3)]
    store.add('x', points, [a_bin(1)])
    store.keep_baseline('x', baseline)
    store.close()
    spoil(
        tmp_path,
        f"UPDATE cells SET speed = CAST(x'61e5' AS TEXT) WHERE first_day = {motion.today - 1}",
        "UPDATE baselines SET screw = CAST(x'61e5' AS TEXT)",
    )
    store = make()
    assert store.said == []
    for kept in (store.read('x'), read_health(tmp_path)['x']):
        assert by_place(kept.cells) == by_place([points[0], points[2]])
        assert (kept.baselines, len(kept.spectrum)) == ((), 1)
        assert '2 rows of axis x cannot be read' in kept.notes[0]


@pytest.mark.parametrize(
    ('column', 'value'),
    [
        ('duration', 'NULL'),
        ('motor_torque', '9e999'),
        ('direction', '2'),
        ('temperature_measured', '2'),
        ('days', '0'),
        ('start', 'NULL'),
    ],
)
def test_a_column_with_what_nobody_writes_spoils_its_row(make, motion, tmp_path, column, value):
    store = make()
    store.add('x', [motion.cell()])
    store.close()
    spoil(tmp_path, f'UPDATE cells SET {column} = {value}')
    assert make().read('x').cells == ()


def test_a_passing_failure_sets_nothing_aside(make, motion, tmp_path):
    store = make()
    store.add('x', [motion.cell()])
    store.close()
    with contextlib.closing(sqlite3.connect(tmp_path / FILE, isolation_level=None)) as holder:
        holder.execute('BEGIN EXCLUSIVE')
        with pytest.raises(sqlite3.OperationalError, match='locked'):
            make()
    assert by_place(make().read('x').cells) == by_place([motion.cell()])


def test_somebody_who_reads_without_an_end_does_not_let_the_journal_grow(
    make, motion, tmp_path, refused
):
    limit = 400_000
    store = make(limit=limit)
    many = [motion.cell(load_band=one) for one in range(60)]
    store.add('x', many)
    with contextlib.closing(sqlite3.connect(tmp_path / FILE, isolation_level=None)) as reader:
        reader.execute('BEGIN')
        reader.execute('SELECT count(*) FROM cells').fetchall()
        with contextlib.suppress(InputError):
            for _ in range(1000):
                store.add('x', many)
        refused('takes_no_more', store.add, 'x', many)
    store.add('x', many)
    assert (tmp_path / f'{FILE}-wal').stat().st_size < limit / 2


def test_a_store_is_open_until_it_is_closed_or_removed(make, tmp_path):
    store = make()
    assert store.is_open
    (tmp_path / FILE).unlink()
    assert not store.is_open
    assert not HealthStore(tmp_path).is_open
