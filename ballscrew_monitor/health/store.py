# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Store of health: `health.sqlite3` in the directory of a node.

Cells of days, spectrum and baselines of every axis, so that a node that is killed loses at most
what it had not written. The directory belongs to the node by the lock of its state.

"""

from collections.abc import Iterable
import math
from pathlib import Path
import threading
from typing import Any

from ballscrew_monitor.health.bands import period_of
from ballscrew_monitor.health.records import Baseline, Cell, KeptHealth, SpectrumBin
from ballscrew_monitor.health.spectrum import merged_bins
from ballscrew_monitor.health.summary import aged, by_place
from surrogate.files import InputError
from surrogate.files.store import opened_to_read, readable, SHARE, Store, Table

FILE = 'health.sqlite3'
VERSION = 1
LIMIT = 20_000_000  # size [B] that the history of one axis may have
MOST_BASELINES = 20  # of an axis that are kept, the newest ones


def _check_cell(cell: Cell) -> None:
    numbers = cell.speed, cell.axial_load, cell.temperature, cell.motor_torque
    if cell.days < 1 or cell.stretches < 0 or abs(cell.direction) > 1 or math.inf in numbers:
        raise ValueError(f'a cell of {cell.stretches} stretches')


def _check_bin(part: SpectrumBin) -> None:
    if part.time <= 0.0 or not all(time >= 0.0 for time in part.wear_time):
        raise ValueError(f'a bin of {part.time} s')


AXIS, DAYS = {'axis': str}, 'axis, first_day'
CELLS = Table(name='cells', kind=Cell, beside=AXIS, index=DAYS, check=_check_cell)
SPECTRUM = Table(name='spectrum', kind=SpectrumBin, beside=AXIS, index=DAYS, check=_check_bin)
BASELINES = Table(name='baselines', kind=Baseline, beside={'number': int, **AXIS}, key='number')
TABLES = (CELLS, SPECTRUM, BASELINES)
OLDEST = """
SELECT axis, min(first_day), max(first_day), count(*) AS places FROM cells
    GROUP BY axis ORDER BY places DESC LIMIT 1
"""
"""The axis with the most cells, and its days."""
OLD_BASELINES = """
SELECT number FROM baselines WHERE axis = ? ORDER BY number DESC LIMIT -1 OFFSET ?
"""


class HealthStore(Store):
    """The health of the axes of one node, in a `folder`."""

    def __init__(self, folder: Path, *, limit: int = LIMIT) -> None:
        """Open nothing yet; an axis may have a `limit` [B]."""
        super().__init__(folder / FILE, TABLES, version=VERSION, limit=limit)
        self.lock = threading.RLock()  # for threads that share the store

    def load(self) -> list[str]:
        """
        Open the file, made where there is none; return sentences on what was set aside.

        Raises OSError and sqlite3.Error if it cannot be had now.

        """
        _, sentence = self.recovered(lambda: None)
        return [sentence] if sentence else []

    def read(self, axis: str) -> KeptHealth:
        """Return what is kept of an axis; sqlite3.Error if it cannot be had."""
        return _read(self, axis)

    def add(
        self, axis: str, cells: Iterable[Cell] = (), spectrum: Iterable[SpectrumBin] = ()
    ) -> None:
        """
        Add cells and bins to those of their periods, all or nothing.

        Raises InputError while somebody who reads keeps the journal from being cleared, and
        sqlite3.Error.

        """
        if not self.has_room:
            raise InputError(f'{self.file} takes no more: somebody has been reading it for long')
        cells, spectrum = list(cells), list(spectrum)
        with self.transaction():
            held, bins = (
                self._take_periods(table, axis, [(part.first_day, part.days) for part in records])
                for table, records in ((CELLS, cells), (SPECTRUM, spectrum))
            )
            self.put(CELLS, by_place([*held, *cells]).values(), axis=axis)
            self.put(SPECTRUM, merged_bins([*bins, *spectrum]), axis=axis)
            self._make_room()

    def keep_baseline(self, axis: str, baseline: Baseline) -> None:
        """Add a baseline, which is the one in force from now on."""
        with self.transaction() as database:
            self.put(BASELINES, [baseline], axis=axis)
            for (gone,) in database.execute(OLD_BASELINES, (axis, MOST_BASELINES)).fetchall():
                database.execute('DELETE FROM baselines WHERE number = ?', (gone,))

    def age(self, axis: str, today: int) -> list[str]:
        """Merge older days of an axis, `today` in days since 1970; return what is to be said."""
        with self.transaction():
            cells, notes = aged(self._take_ageing(CELLS, axis, today), today)
            bins = merged_bins(self._take_ageing(SPECTRUM, axis, today), today)
            self.put(CELLS, cells, axis=axis)
            self.put(SPECTRUM, bins, axis=axis)
        return notes

    def _take_ageing(self, table: Table, axis: str, today: int) -> list[Any]:
        """Take the records of the periods that age changes out of a table, and those to come."""
        days = f'SELECT DISTINCT first_day, days FROM {table.name} WHERE'
        rows = self.database.execute(f'{days} axis = ?', (axis,))
        periods = {(first, days) for first, days in rows}
        aim = {period: period_of(*period, today) for period in periods}
        changed = {period for period in periods if aim[period] != period}
        changed |= {aim[period] for period in changed}
        changed |= {period for period in periods if period[0] > today}
        return self._take_periods(table, axis, changed)

    def _take_periods(
        self, table: Table, axis: str, periods: Iterable[tuple[int, int]]
    ) -> list[Any]:
        """Take the records of periods, first days and lengths, out of a table."""
        which = 'WHERE axis = ? AND first_day = ? AND days = ?'
        rows: list[Any] = []
        for period in sorted(set(periods)):
            rows += self.rows(table, which, (axis, *period))
            self.database.execute(f'DELETE FROM {table.name} {which}', (axis, *period))
        return [record for _, record in readable(table, rows)]

    def _make_room(self) -> None:
        """Remove the oldest cells until the database is within the limit of its axes."""
        axes = self.database.execute('SELECT count(DISTINCT axis) FROM cells').fetchone()[0]
        while self.used > SHARE * self.limit * max(axes, 1):
            oldest = self.database.execute(OLDEST).fetchone()
            if oldest is None:
                return
            axis, first, last, _ = oldest
            until = first + (last - first) // 16
            for table in (CELLS, SPECTRUM):
                statement = f'DELETE FROM {table.name} WHERE axis = ? AND first_day <= ?'
                self.database.execute(statement, (axis, until))


def read_health(folder: Path) -> dict[str, KeptHealth]:
    """
    Return what a folder keeps of every axis, whether or not its node runs.

    Raises InputError if there is nothing, or nothing that can be read.

    """
    with opened_to_read(folder, FILE, TABLES, VERSION) as store:
        axes = store.database.execute(
            'SELECT axis FROM cells UNION SELECT axis FROM spectrum ORDER BY axis'
        ).fetchall()
        return {axis: _read(store, axis) for (axis,) in axes}


def _read(store: Store, axis: str) -> KeptHealth:
    """Return what can be read of an axis, and how many rows cannot."""
    parts: list[list[Any]] = []
    bad = 0
    for table in TABLES:
        order = 'number' if table is BASELINES else 'first_day, rowid'
        rows = store.rows(table, f'WHERE axis = ? ORDER BY {order}', (axis,))
        parts.append([record for _, record in readable(table, rows)])
        bad += len(rows) - len(parts[-1])
    note = f'{store.file}: {bad} rows of axis {axis} cannot be read, they do not count'
    cells, spectrum, baselines = map(tuple, parts)
    return KeptHealth(cells, spectrum, baselines, (note,) if bad else ())
