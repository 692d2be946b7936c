# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Store of what outlives the node: `state.sqlite3` in a directory for one node alone.

Totals and corrections of each axis, and the event log, whose oldest entries go at the limit.

"""

from collections.abc import Iterable
import contextlib
import fcntl
import functools
import itertools
import os
from pathlib import Path
import sqlite3
from typing import Any

from ballscrew_monitor.judge.kept import AxisRecord
from ballscrew_monitor.node.state_records import (
    AXES,
    by_key,
    CORRECTIONS,
    Entry,
    EVENTS,
    Record,
    Records,
    TABLES,
)
from surrogate.files import InputError
from surrogate.files.store import identity, opened_to_read, plain_text, SHARE, size_of, Store

FILE, LOCK = 'state.sqlite3', 'lock'
VERSION = 1
UNWRITABLE = 'cannot be written'
IN_USE = 'is in use by another node of this name'
LOST = 'was removed or replaced while the node ran: sums and warnings go on, logs begin again'
CHUNK = 500  # entries that are appended at a time


class StateDatabase(Store):
    """The store in a `folder`, whose files are smaller than a `limit` [B]."""

    def __init__(self, folder: Path, limit: int, *, damage: list[str]) -> None:
        """Open nothing yet; sentences on damage that is found go to `damage`."""
        super().__init__(folder / FILE, TABLES.values(), version=VERSION, limit=limit)
        self.folder = folder
        self._damage = damage
        self._lock = -1

    @property
    def is_open(self) -> bool:
        """Return True if the file is open, and the directory still that of this node."""
        return self._is_locked and super().is_open

    @property
    def is_lost(self) -> bool:
        """Return True if the directory, or what is in it, was removed or replaced."""
        return self._lock >= 0 and self._database is not None and not self.is_open

    @property
    def _is_locked(self) -> bool:
        return self._lock >= 0 and identity(self._lock) == identity(self.folder / LOCK)

    def load(self) -> Records:
        """
        Take the directory for this node alone, and return what it holds besides the event log.

        Raises InputError while another node has it, OSError and sqlite3.Error if nothing can be
        had of it now.

        """
        if not self._is_locked:
            if self._lock >= 0:
                self._damage.append(f'{self.folder} {LOST}')
                self._unlock()
            self.folder.mkdir(parents=True, exist_ok=True)
            lock = os.open(self.folder / LOCK, os.O_RDWR | os.O_CREAT | os.O_CLOEXEC, 0o644)
            try:
                fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
            except OSError as error:
                os.close(lock)
                if isinstance(error, BlockingIOError):
                    raise InputError(f'{self.folder} {IN_USE}') from None
                raise
            self._lock = lock
        numbers: list[AxisRecord] = []
        rescue = functools.partial(self._last_numbers, numbers)
        records, sentence = self.recovered(self._records, rescue)
        if not sentence:
            return records
        self._damage.append(sentence)
        self.write([], numbers)
        return by_key(numbers)

    def write(self, entries: Iterable[Entry], records: Iterable[Record]) -> None:
        """
        Append entries to the event log and replace records, all or nothing.

        Raises InputError at the limit, sqlite3.Error and OSError.

        """
        if not self.has_room:
            raise InputError(at_limit(self.folder, self.limit))
        waiting = iter(entries)
        with self.transaction():
            while chunk := list(itertools.islice(waiting, CHUNK)):
                self._make_room(sum(len(str(entry)) for entry in chunk))
                self.put(EVENTS, chunk)
            for record in records:
                self.put(TABLES[type(record)], [record])

    def close(self) -> None:
        """Leave one whole file, which anybody can read, and let another node have it."""
        super().close()
        self._unlock()

    def _unlock(self) -> None:
        if self._lock >= 0:
            os.close(self._lock)
        self._lock = -1

    def _records(self) -> Records:
        if size_of(self.file) > SHARE * self.limit:  # a limit of before was larger
            self._make_room()
            self.shrink()
        return by_key(table.read(row) for table in (AXES, CORRECTIONS) for row in self.rows(table))

    def _last_numbers(self, numbers: list[AxisRecord]) -> None:
        """Add records with the numbers of the last events, as far as they can be read."""
        with contextlib.suppress(sqlite3.Error, ValueError, TypeError):
            for row in self.database.execute('SELECT axis, event FROM axes'):
                blank = AxisRecord(axis=str(row['axis']))
                numbers.append(AXES.read(AXES.row(blank) | {'event': row['event']}))

    def _make_room(self, needed: int = 0) -> None:
        """Remove the oldest entries until there is room for what is `needed` [B]."""
        while self.used > SHARE * self.limit - needed:
            ((first, last),) = self.database.execute('SELECT min(number), max(number) FROM events')
            if first is None:
                return
            until = first + (last - first) // 16
            self.database.execute('DELETE FROM events WHERE number <= ?', (until,))


def read_entries(folder: Path) -> list[Entry]:
    """
    Return the event log in a folder, whether or not its node runs.

    Raises InputError if there is none, or none that can be read.

    """
    with opened_to_read(folder, FILE, [EVENTS], VERSION) as store:
        # At once: somebody who reads on and on keeps the journal from being cleared.
        rows = store.rows(EVENTS, 'ORDER BY number')
        return [Entry(*(_shown(cell) for cell in row[1:])) for row in rows]


def _shown(cell: Any) -> Any:
    """Return what a damaged file may hold in place of a text or an integer as one."""
    return plain_text(cell) if cell is None or isinstance(cell, int | str) else str(cell)


def at_limit(folder: Path, limit: int) -> str:
    """Return that there is no room below the `limit` [B] of a folder."""
    return f'{folder} is at its state_limit of {limit / 1e6:g} MB'
