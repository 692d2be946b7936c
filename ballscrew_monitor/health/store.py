# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Database of health: `health.sqlite3` in the directory of a node.

Points, spectrum and baselines of every axis. What is written at a time is one transaction, so that
a node that is killed loses at most what it had not written. Others read meanwhile. The directory
belongs to the node by the lock of its state.

"""

from collections.abc import Iterable
import contextlib
import dataclasses
from pathlib import Path
import sqlite3
import threading
from typing import Any

from ballscrew_monitor.core.sqlite_file import (
    BAD,
    connected,
    has_room,
    is_empty,
    is_passing,
    let_go,
    opened_to_read,
    set_file_aside,
    SHARE,
    USED,
)
from ballscrew_monitor.health.bands import period_of
from ballscrew_monitor.health.points import aged, by_place
from ballscrew_monitor.health.records import Baseline, ComparablePoint, SpectrumBin
from ballscrew_monitor.health.spectrum import merged_bins
from ballscrew_monitor.health.store_rows import (
    BASELINE_COLUMNS,
    baseline_of,
    baseline_row,
    bin_of,
    bin_row,
    KeptHealth,
    POINT_COLUMNS,
    point_of,
    point_row,
    SPECTRUM_COLUMNS,
)
from surrogate.files import InputError

FILE = 'health.sqlite3'
VERSION = 1
LIMIT = 20_000_000
"""Size [B] that the history of one axis may have."""
MOST_BASELINES = 20
"""Baselines of an axis that are kept, the newest ones."""
HISTORY = 0
"""Number that points of no baseline have in place of one."""
WHICH = {'points': f'baseline = {HISTORY} AND', 'spectrum': ''}
"""Tables of the history, and what tells its rows from those of baselines."""
READ: dict[str, Any] = {'points': point_of, 'spectrum': bin_of, 'baselines': baseline_of}
ORDERS = {'points': 'first_day, rowid', 'spectrum': 'first_day, rowid', 'baselines': 'number'}
DAYS = 'SELECT DISTINCT first_day, days '
TABLES = f"""
CREATE TABLE points (axis TEXT, baseline INTEGER, {POINT_COLUMNS});
CREATE INDEX points_of ON points (axis, baseline, first_day);
CREATE TABLE spectrum (axis TEXT, {SPECTRUM_COLUMNS});
CREATE INDEX spectrum_of ON spectrum (axis, first_day);
CREATE TABLE baselines (number INTEGER PRIMARY KEY, axis TEXT, {BASELINE_COLUMNS});
PRAGMA user_version = {VERSION}
"""
OLDEST = """
SELECT axis, min(first_day), max(first_day), count(*) AS places FROM points
    WHERE baseline = 0 GROUP BY axis ORDER BY places DESC LIMIT 1
"""
"""The axis with the most points, and its days."""
OLD_BASELINES = """
SELECT number FROM baselines WHERE axis = ? ORDER BY number DESC LIMIT -1 OFFSET ?
"""


class HealthStore:
    """The health of the axes of one node, in a `folder`."""

    def __init__(self, folder: Path, *, limit: int = LIMIT) -> None:
        """Open nothing yet; an axis may have a `limit` [B]."""
        self.file, self.limit = folder / FILE, limit
        self.lock = threading.RLock()  # for threads that share the store
        self._database: Any = None

    @property
    def is_open(self) -> bool:
        """Tell whether the file is open, and still there."""
        return self._database is not None and self.file.exists()

    def load(self) -> list[str]:
        """
        Open the file, made where there is none; return sentences on what was set aside.

        Raises OSError and sqlite3.Error if it cannot be had now.

        """
        self.close()
        self.file.parent.mkdir(parents=True, exist_ok=True)
        try:
            self._open()
        except BAD as error:
            if is_passing(error):
                raise
            self.close()
            said = set_file_aside(self.file, error)
            self._open()
            return [said]
        return []

    def read(self, axis: str) -> KeptHealth:
        """Return what is kept of an axis; sqlite3.Error if it cannot be had."""
        return _read(self._database, axis, str(self.file))

    def add(
        self,
        axis: str,
        points: Iterable[ComparablePoint] = (),
        spectrum: Iterable[SpectrumBin] = (),
    ) -> None:
        """
        Add points and bins to those of their periods, all or nothing.

        Raises InputError while somebody who reads keeps the journal from being cleared, and
        sqlite3.Error.

        """
        if not has_room(self._database, self.file, self.limit):
            raise InputError(f'{self.file} takes no more: somebody has been reading it for long')
        with self._database as database:
            database.execute('BEGIN IMMEDIATE')
            _add(database, axis, list(points), list(spectrum))
            self._make_room(database)

    def keep_baseline(self, axis: str, baseline: Baseline) -> None:
        """Add a baseline, which is the one in force from now on."""
        with self._database as database:
            database.execute('BEGIN IMMEDIATE')
            row = {'axis': axis, **baseline_row(baseline)}
            number = _insert(database, 'baselines', [row])
            _insert(database, 'points', _point_rows(axis, number, baseline.points))
            for (gone,) in database.execute(OLD_BASELINES, (axis, MOST_BASELINES)).fetchall():
                database.execute('DELETE FROM baselines WHERE number = ?', (gone,))
                database.execute('DELETE FROM points WHERE baseline = ?', (gone,))

    def age(self, axis: str, today: int) -> tuple[str, ...]:
        """Merge older days of an axis, `today` in days since 1970; return what is to be said."""
        with self._database as database:
            database.execute('BEGIN IMMEDIATE')
            found = aged(_taken(database, 'points', axis, today), today)
            bins = merged_bins(_taken(database, 'spectrum', axis, today), today)
            _insert(database, 'points', _point_rows(axis, HISTORY, found.points + found.future))
            _insert(database, 'spectrum', [{'axis': axis, **bin_row(one)} for one in bins])
        return found.notes

    def close(self) -> None:
        """Leave one file, which anybody can read."""
        let_go(self._database, alone=True)
        self._database = None

    def _open(self) -> None:
        database = self._database = connected(self.file, self.limit)
        if is_empty(database, VERSION):
            with database:
                database.execute('BEGIN IMMEDIATE')
                for statement in TABLES.split(';'):
                    database.execute(statement)
        for table in READ:
            database.execute(f'SELECT * FROM {table} LIMIT 1').fetchall()

    def _make_room(self, database: sqlite3.Connection) -> None:
        """Remove the oldest points until the database is within the limit of its axes."""
        axes = database.execute('SELECT count(DISTINCT axis) FROM points').fetchone()[0]
        limit = SHARE * self.limit * max(axes, 1)
        while database.execute(USED).fetchone()[0] > limit:
            oldest = database.execute(OLDEST).fetchone()
            if oldest is None:
                return
            axis, first, last, _ = oldest
            until = first + (last - first) // 16
            for table, which in WHICH.items():
                database.execute(
                    f'DELETE FROM {table} WHERE {which} axis = ? AND first_day <= ?', (axis, until)
                )


def read_health(folder: Path) -> dict[str, KeptHealth]:
    """
    Return what a folder keeps of every axis, whether or not its node runs.

    Raises InputError if there is nothing, or nothing that can be read.

    """
    with opened_to_read(folder, FILE, VERSION) as database:
        axes = database.execute(
            'SELECT axis FROM points UNION SELECT axis FROM spectrum ORDER BY axis'
        ).fetchall()
        return {axis: _read(database, axis, str(folder / FILE)) for (axis,) in axes}


def _read(database: sqlite3.Connection, axis: str, place: str) -> KeptHealth:
    """Return what can be read of an axis, and how many rows cannot."""
    points: dict[int, list[ComparablePoint]] = {}
    found = {
        table: database.execute(
            f'SELECT * FROM {table} WHERE axis = ? ORDER BY {order}', (axis,)
        ).fetchall()
        for table, order in ORDERS.items()
    }
    read = {table: _readable(READ[table], rows) for table, rows in found.items()}
    for row, point in read['points']:
        points.setdefault(row['baseline'], []).append(point)
    baselines = [
        dataclasses.replace(one, points=tuple(points.get(row['number'], ())))
        for row, one in read['baselines']
    ]
    bad = sum(len(found[table]) - len(read[table]) for table in found)
    return KeptHealth(
        points=tuple(points.get(HISTORY, ())),
        spectrum=tuple(one for _, one in read['spectrum']),
        baselines=tuple(baselines),
        notes=(f'{place}: {bad} rows of axis {axis} cannot be read, they do not count',)
        if bad
        else (),
    )


def _readable(read_row: Any, rows: Iterable[Any]) -> list[tuple[Any, Any]]:
    """Return rows with what they say, those that say something."""
    found = []
    for row in rows:
        with contextlib.suppress(ValueError, KeyError, TypeError):
            found.append((row, read_row(row)))
    return found


def _taken(database: sqlite3.Connection, table: str, axis: str, today: int) -> list[Any]:
    """Take the records of the periods that age changes out of a table, and those to come."""
    kept = f'FROM {table} WHERE {WHICH[table]} axis = ?'
    periods = {(one, days) for one, days in database.execute(DAYS + kept, (axis,)).fetchall()}
    aim = {period: period_of(*period, today) for period in periods}
    changed = {period for period in periods if aim[period] != period}
    changed |= {aim[period] for period in changed}
    changed |= {period for period in periods if period[0] > today}
    return _take_periods(database, table, axis, changed)


def _take_periods(
    database: sqlite3.Connection, table: str, axis: str, periods: Iterable[tuple[int, int]]
) -> list[Any]:
    """Take the records of periods, first days and lengths, out of a table."""
    kept = f'FROM {table} WHERE {WHICH[table]} axis = ? AND first_day = ? AND days = ?'
    rows: list[Any] = []
    for period in sorted(set(periods)):
        rows += database.execute(f'SELECT * {kept}', (axis, *period))
        database.execute(f'DELETE {kept}', (axis, *period))
    return [record for _, record in _readable(READ[table], rows)]


def _add(
    database: sqlite3.Connection,
    axis: str,
    points: list[ComparablePoint],
    spectrum: list[SpectrumBin],
) -> None:
    """Add to the periods of points and of bins, in a transaction that has begun."""
    held, bins = (
        _take_periods(database, table, axis, [(one.first_day, one.days) for one in records])
        for table, records in (('points', points), ('spectrum', spectrum))
    )
    pooled = by_place([*held, *points]).values()
    _insert(database, 'points', _point_rows(axis, HISTORY, pooled))
    merged = merged_bins([*bins, *spectrum])
    _insert(database, 'spectrum', [{'axis': axis, **bin_row(one)} for one in merged])


def _point_rows(axis: str, number: int, points: Iterable[ComparablePoint]) -> list[dict[str, Any]]:
    return [{'axis': axis, 'baseline': number, **point_row(one)} for one in points]


def _insert(database: sqlite3.Connection, table: str, rows: list[dict[str, Any]]) -> int:
    """Insert rows of one kind; return the number of the last one."""
    if not rows:
        return 0
    names = ', '.join(f'"{name}"' for name in rows[0])
    values = ', '.join(f':{name}' for name in rows[0])
    statement = f'INSERT OR REPLACE INTO {table} ({names}) VALUES ({values})'
    for row in rows[:-1]:
        database.execute(statement, row)
    return int(database.execute(statement, rows[-1]).lastrowid or 0)
