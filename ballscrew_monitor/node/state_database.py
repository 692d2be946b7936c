# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Database of what outlives the node: `state.sqlite3` in a directory for one node alone.

What is written at a time is one transaction and is on the disk when `write` returns. Others read
meanwhile. A database that is damaged or of another version is renamed, and an empty one takes its
place.

"""

from collections.abc import Iterable
import contextlib
import fcntl
import itertools
import os
from pathlib import Path
import sqlite3
from typing import Any

from ballscrew_monitor.core import sqlite_file
from ballscrew_monitor.core.memory import AxisRecord, read_record, TYPES
from ballscrew_monitor.node.state_records import by_key, Corrections, Entry, Record, Records
from surrogate.files import InputError

FILE = 'state.sqlite3'
VERSION = 1
UNWRITABLE = 'cannot be written'
IN_USE = 'is in use by another node of this name'
CHUNK = 500  # entries that are appended at a time
SQL = {int: 'INTEGER', bool: 'INTEGER', float: 'REAL', str: 'TEXT'}
TABLES = f"""
CREATE TABLE axes ({', '.join(f'"{name}" {SQL[kind]}' for name, kind in TYPES.items())},
    PRIMARY KEY (axis));
CREATE TABLE corrections (axis TEXT PRIMARY KEY, surface TEXT, solves TEXT);
CREATE TABLE events (number INTEGER PRIMARY KEY, time TEXT, stamp_ns INTEGER, axis TEXT,
    kind TEXT, facts TEXT);
PRAGMA user_version = {VERSION}
"""
READ: dict[str, Any] = {'axes': read_record, 'corrections': Corrections.read}
TABLE_OF = {AxisRecord: 'axes', Corrections: 'corrections'}


class StateDatabase:
    """The database in a `folder`, with its journal smaller than a `limit` [B]."""

    def __init__(self, folder: Path, limit: int, *, damage: list[str]) -> None:
        """Open nothing yet; sentences on damage that is found go to `damage`."""
        self.folder, self.limit = folder, limit
        self._damage = damage
        self._file = folder / FILE
        self._lock = -1
        self._database: Any = None

    @property
    def is_open(self) -> bool:
        """Tell whether the database is open, and still there."""
        return self._database is not None and self._file.exists()

    def load(self) -> Records:
        """
        Take the directory for this node alone, and return what it holds besides the event log.

        Raises InputError while another node has it, OSError and sqlite3.Error if nothing can be
        had of it now.

        """
        self._take()
        self.disconnect()
        try:
            return self._load()
        except sqlite_file.BAD as error:
            if sqlite_file.is_passing(error):
                raise
            numbers = self._last_numbers()
            self.disconnect()
            self._damage.append(sqlite_file.set_file_aside(self._file, error))
        self._load()
        self.write([], numbers)
        return by_key(numbers)

    def write(self, entries: Iterable[Entry], records: Iterable[Record]) -> None:
        """
        Append entries to the event log and replace records, all or nothing.

        Raises InputError at the limit, sqlite3.Error and OSError.

        """
        if not sqlite_file.has_room(self._database, self._file, self.limit):
            raise InputError(at_limit(self.folder, self.limit))
        with self._database as database:
            database.execute('BEGIN IMMEDIATE')
            _write(database, entries, records, sqlite_file.SHARE * self.limit)

    def disconnect(self) -> None:
        """Let go of the file, but not of the directory."""
        sqlite_file.let_go(self._database)
        self._database = None

    def close(self) -> None:
        """Leave one whole file, which anybody can read, and let another node have it."""
        sqlite_file.let_go(self._database, alone=True)
        self._database = None
        if self._lock >= 0:
            os.close(self._lock)
        self._lock = -1

    def _take(self) -> None:
        if self._lock >= 0:
            return
        self.folder.mkdir(parents=True, exist_ok=True)
        lock = os.open(self.folder / 'lock', os.O_RDWR | os.O_CREAT | os.O_CLOEXEC, 0o644)
        try:
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError as error:
            os.close(lock)
            if isinstance(error, BlockingIOError):
                raise InputError(f'{self.folder} {IN_USE}') from None
            raise
        self._lock = lock

    def _load(self) -> Records:
        """Return what the file holds; raises ValueError or KeyError for what no node has left."""
        database = self._database = sqlite_file.connected(self._file, self.limit)
        if sqlite_file.is_empty(database, VERSION):
            with database:
                database.execute('BEGIN IMMEDIATE')
                for statement in TABLES.split(';'):
                    database.execute(statement)
        if (
            sqlite_file.size_of(self._file) > sqlite_file.SHARE * self.limit
        ):  # a limit of before was larger
            _make_room(database, sqlite_file.SHARE * self.limit)
            database.executescript('VACUUM; PRAGMA wal_checkpoint(TRUNCATE)')
        return by_key(
            read(row)
            for table, read in READ.items()
            for row in database.execute(f'SELECT * FROM {table}')
        )

    def _last_numbers(self) -> list[Record]:
        """Return records with the numbers of the last events, as far as they can be read."""
        found: list[Record] = []
        with contextlib.suppress(sqlite3.Error, ValueError, TypeError, AttributeError):
            for row in self._database.execute('SELECT axis, event FROM axes'):
                blank = AxisRecord(axis=str(row['axis'])).row()
                found.append(read_record(blank | {'event': row['event']}))
        return found


def read_entries(folder: Path) -> list[Entry]:
    """
    Return the event log in a folder, whether or not its node runs.

    Raises InputError if there is none, or none that can be read.

    """
    with sqlite_file.opened_to_read(folder, FILE, VERSION) as database:
        database.text_factory = _text
        # At once: somebody who reads on and on keeps the journal from being cleared.
        rows = database.execute('SELECT * FROM events ORDER BY number').fetchall()
        return [Entry(*(_plain(one) for one in row[1:])) for row in rows]


def _text(raw: bytes) -> str:
    """Return a text; of a damaged one every byte that is no letter is shown as its number."""
    return raw.decode('utf-8', 'backslashreplace')


def _plain(value: Any) -> Any:
    """Return what a damaged file may hold in place of a text or an integer as one."""
    return value if value is None or isinstance(value, int | str) else str(value)


def at_limit(folder: Path, limit: int) -> str:
    """Return that there is no room below the `limit` [B] of a folder."""
    return f'{folder} is at its state_limit of {limit / 1e6:g} MB'


def _write(
    database: sqlite3.Connection, entries: Iterable[Entry], records: Iterable[Record], limit: float
) -> None:
    """Write what no transaction has to be begun for; old entries go, up to the `limit` [B]."""
    waiting = iter(entries)
    while chunk := list(itertools.islice(waiting, CHUNK)):
        _make_room(database, limit - sum(len(str(one)) for one in chunk))
        database.executemany('INSERT INTO events VALUES (NULL, ?, ?, ?, ?, ?)', chunk)
    for record in records:
        row = record.row()
        values = ', '.join(f':{name}' for name in row)
        database.execute(f'INSERT OR REPLACE INTO {TABLE_OF[type(record)]} VALUES ({values})', row)


def _make_room(database: sqlite3.Connection, limit: float) -> None:
    """Remove the oldest entries until the database is within a `limit` [B]."""
    while database.execute(sqlite_file.USED).fetchone()[0] > limit:
        ((first, last),) = database.execute('SELECT min(number), max(number) FROM events')
        if first is None:
            return
        database.execute('DELETE FROM events WHERE number <= ?', (first + (last - first) // 16,))
