# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Stores: dataclasses as rows of an SQLite file that one thread writes and anybody reads.

A table has the fields of a dataclass as its columns. What is written at a time is one transaction
and is on the disk when it returns. A write-ahead log lets others read meanwhile; where it cannot
work, or nobody else may read, there is a rollback journal. A file that is damaged, of another
version or with other tables is renamed, and an empty one takes its place.

"""

from collections.abc import Callable, Iterable, Iterator, Mapping
import contextlib
import dataclasses
import enum
import functools
import math
import os
from pathlib import Path
import sqlite3
import struct
import typing
from typing import Any, TypeVar

from surrogate.files import InputError

PARTS = ('', '-wal', '-shm', '-journal')  # of a file, by the names that SQLite gives
DAMAGED = 'is damaged'
OTHER_VERSION = 'is of another version'
BUSY = 1.0  # [s] to wait for somebody who reads
SHARE = 0.75  # of a limit for the database, the rest is for its journal
NETWORK = {'9p', 'afs', 'ceph', 'cifs', 'fuse.sshfs', 'lustre', 'nfs', 'nfs4', 'smb3', 'vboxsf'}
USED = """
SELECT (page_count - freelist_count) * page_size
    FROM pragma_page_count, pragma_freelist_count, pragma_page_size
"""
"""Bytes of the pages in use."""
BAD = (sqlite3.DatabaseError, ValueError, KeyError, TypeError)
"""What a file raises that nobody has left; `is_passing` tells what only cannot be had now."""
SQL: dict[Any, str] = {
    **{int: 'INTEGER', bool: 'INTEGER', float: 'REAL', str: 'TEXT', str | None: 'TEXT'},
    tuple[float, ...]: 'BLOB',
}
MAY_BE_NAN = {'may_be_nan': True}
"""Metadata of a field that may be unknown; a field whose default is NaN needs none."""
Loaded = TypeVar('Loaded')


@dataclasses.dataclass(frozen=True, kw_only=True)
class Table:
    """
    A table whose rows are records of one `kind`, a dataclass.

    NaN is NULL, an enum its number, a named tuple a column for each part. Columns `beside` the
    fields come first; `key` tells rows apart, a column of integers numbers them by itself;
    `without` are fields that are not kept. `check` raises ValueError, KeyError or TypeError for
    a record that nobody has written.

    """

    name: str
    kind: Any
    key: str = ''
    index: str = ''
    beside: Mapping[str, Any] = dataclasses.field(default_factory=dict)
    without: tuple[str, ...] = ()
    check: Callable[[Any], object] = lambda record: None

    @functools.cached_property
    def fields(self) -> dict[str, Any]:
        """Return the types of the fields that are kept."""
        hints = typing.get_type_hints(self.kind)
        names = (field.name for field in dataclasses.fields(self.kind))
        return {name: hints[name] for name in names if name not in self.without}

    @functools.cached_property
    def columns(self) -> dict[str, str]:
        """Return the columns with their types in SQL."""
        columns = {name: SQL[kind] for name, kind in self.beside.items()}
        for name, kind in self.fields.items():
            if hasattr(kind, '_fields'):
                columns |= {f'{name}_{part}': 'INTEGER' for part in kind._fields}
            else:
                columns[name] = SQL.get(kind, 'INTEGER')
        return columns

    @property
    def schema(self) -> list[str]:
        """Return the statements that make the table."""
        parts = [f'"{name}" {kind}' for name, kind in self.columns.items()]
        parts += [f'PRIMARY KEY ("{self.key}")'] if self.key else []
        statements = [f'CREATE TABLE {self.name} ({", ".join(parts)})']
        if self.index:
            statements.append(f'CREATE INDEX {self.name}_of ON {self.name} ({self.index})')
        return statements

    def row(self, record: Any, **beside: Any) -> dict[str, Any]:
        """Return a record as a row; columns `beside` it are NULL unless given."""
        row = dict.fromkeys(self.beside) | beside
        for name, kind in self.fields.items():
            value = getattr(record, name)
            if hasattr(kind, '_fields'):
                row |= {f'{name}_{part}': number for part, number in value._asdict().items()}
            elif isinstance(value, tuple):
                row[name] = struct.pack(f'<{len(value)}d', *value)
            elif isinstance(value, bool | enum.IntEnum):
                row[name] = int(value)
            else:
                row[name] = None if value != value else value
        return row

    def read(self, row: sqlite3.Row | Mapping[str, Any]) -> Any:
        """Return the record of a row; raises ValueError, KeyError or TypeError without one."""
        # A row looks for a name from column to column.
        cells = row if isinstance(row, dict) else dict(zip(row.keys(), row, strict=True))
        values = {name: self._value(name, kind, cells) for name, kind in self.fields.items()}
        record = self.kind(**values)
        self.check(record)
        return record

    def _value(self, name: str, kind: Any, cells: Mapping[str, Any]) -> Any:
        if hasattr(kind, '_fields'):
            columns = [f'{name}_{part}' for part in kind._fields]
            return kind(*(_cell(column, int, cells[column]) for column in columns))
        value = cells[name]
        if kind is float and name in self._unknown and (value is None or type(value) is float):
            return math.nan if value is None else value
        if kind == tuple[float, ...] and type(value) is bytes and len(value) % 8 == 0:
            return struct.unpack(f'<{len(value) // 8}d', value)
        if isinstance(kind, type) and issubclass(kind, enum.IntEnum):
            return kind(_cell(name, int, value))
        return _cell(name, kind, value)

    @functools.cached_property
    def _unknown(self) -> set[str]:
        fields = dataclasses.fields(self.kind)
        return {
            field.name
            for field in fields
            if field.default != field.default or field.metadata.get('may_be_nan')
        }


def _cell(name: str, kind: Any, value: Any) -> Any:
    """Return a value of a kind; raises ValueError for another, or a text with damaged letters."""
    if kind is bool and type(value) is int and value in (0, 1):
        return bool(value)
    if kind == (str | None) and value is None:
        return None
    if kind in (str, str | None) and type(value) is str:
        value.encode()
        return value
    if type(value) is kind and (kind is not float or math.isfinite(value)):
        return value
    raise ValueError(f'{name} is {value!r}')


def plain_text(value: Any) -> Any:
    """Return a text; of a damaged one every byte that is no letter is shown as its number."""
    if isinstance(value, str):
        return value.encode('utf-8', 'surrogateescape').decode('utf-8', 'backslashreplace')
    return value


class Store:
    """Tables in a file, with its journal smaller than a `limit` [B]; one thread at a time."""

    def __init__(
        self, file: Path, tables: Iterable[Table], *, version: int, limit: int, alone: bool = False
    ) -> None:
        """Open nothing yet; what is opened `alone` nobody else can open meanwhile."""
        self.file, self.limit = file, limit
        self._tables, self._version, self._alone = tuple(tables), version, alone
        self._database: Any = None
        self._identity: tuple[int, int] | None = None

    @property
    def is_open(self) -> bool:
        """Return True if the file is open, and still there: not gone, and no other one."""
        return self._database is not None and identity(self.file) == self._identity

    @property
    def database(self) -> sqlite3.Connection:
        """Return the connection, for what tables do not say."""
        if self._database is None:
            raise sqlite3.OperationalError(f'{self.file} is not open')
        return self._database

    def connect(self) -> None:
        """
        Open the file, made where there is none.

        Raises OSError and sqlite3.Error, and ValueError for what nobody has left.

        """
        self.let_go()
        self.file.parent.mkdir(parents=True, exist_ok=True)
        database = connected(self.file, self.limit, alone=self._alone)
        self.use(database)
        self._identity = identity(self.file)
        if is_empty(database, self._version):
            statements = [line for table in self._tables for line in table.schema]
            with database:
                database.execute('BEGIN IMMEDIATE')
                for statement in (*statements, f'PRAGMA user_version = {self._version}'):
                    database.execute(statement)
        check_tables(database, self._tables)

    def use(self, database: sqlite3.Connection) -> None:
        """Take a connection; a letter that is damaged stays as it is, and hides no other row."""
        database.row_factory = sqlite3.Row
        database.text_factory = lambda raw: raw.decode('utf-8', 'surrogateescape')
        self._database = database

    def recovered(
        self, read: Callable[[], Loaded], rescue: Callable[[], Any] = lambda: None
    ) -> tuple[Loaded, str]:
        """
        Open the file; return what is read of it, and a sentence on what was set aside.

        What can be had of a bad file is the business of `rescue`. Raises as `connect` does if the
        file only cannot be had now.

        """
        try:
            self.connect()
            return read(), ''
        except BAD as error:
            if is_passing(error):
                self.let_go()
                raise
            rescue()
            self.let_go()
            sentence = set_file_aside(self.file, error)
        self.connect()
        return read(), sentence

    @contextlib.contextmanager
    def transaction(self) -> Iterator[sqlite3.Connection]:
        """Write all that is written in the block, or nothing."""
        with self.database as database:
            database.execute('BEGIN IMMEDIATE')
            yield database

    def put(self, table: Table, records: Iterable[Any], **beside: Any) -> int:
        """Insert records, in place of those with their keys; return the number of the last."""
        names = ', '.join(f'"{name}"' for name in table.columns)
        values = ', '.join(f':{name}' for name in table.columns)
        statement = f'INSERT OR REPLACE INTO {table.name} ({names}) VALUES ({values})'
        last = 0
        for record in records:
            cursor = self.database.execute(statement, table.row(record, **beside))
            last = int(cursor.lastrowid or 0)
        return last

    def rows(self, table: Table, which: str = '', values: Iterable[Any] = ()) -> list[Any]:
        """Return rows of a table; `which` is what follows its name in SQL."""
        statement = f'SELECT * FROM {table.name} {which}'
        return self.database.execute(statement, tuple(values)).fetchall()

    @property
    def used(self) -> int:
        """Return how much is in use [B]."""
        return int(self.database.execute(USED).fetchone()[0])

    @property
    def has_room(self) -> bool:
        """Return True if the journal can take more: its part of the limit."""
        journal = self.file.with_name(f'{self.file.name}-wal')
        if size_of(journal) <= (1.0 - SHARE) * self.limit:
            return True
        # Somebody reads, and it could not begin again.
        self.database.execute('PRAGMA wal_checkpoint(TRUNCATE)').fetchall()
        return not size_of(journal)

    def shrink(self) -> None:
        """Give what is not in use back to the disk."""
        self.database.executescript('VACUUM; PRAGMA wal_checkpoint(TRUNCATE)')

    def let_go(self) -> None:
        """Close the file as it is."""
        database, self._database = self._database, None
        if database is not None:
            with contextlib.suppress(sqlite3.Error):
                database.close()

    def close(self) -> None:
        """Leave one whole file, which anybody can read."""
        if self._database is not None:
            with contextlib.suppress(sqlite3.Error):
                self._database.execute('PRAGMA journal_mode = DELETE')
        self.let_go()


def identity(file: Path | int) -> tuple[int, int] | None:
    """Return what tells a file, by path or descriptor, from every other; None: there is none."""
    try:
        status = os.stat(file)
    except OSError:
        return None
    return status.st_dev, status.st_ino


def connected(file: Path, limit: int, *, alone: bool = False) -> sqlite3.Connection:
    """
    Return a connection with a write-ahead log, or with what works in its place.

    The journal is kept to a part of the `limit` [B]. Raises sqlite3.Error and OSError.

    """
    if not alone and not on_network(file.parent):
        with contextlib.suppress(sqlite3.OperationalError):
            return _set_up(file, limit // 16, 'journal_mode = WAL', 'locking_mode = NORMAL')
    # Who is alone can read the write-ahead log of before without shared memory.
    settings = ['locking_mode = EXCLUSIVE', 'journal_mode = TRUNCATE']
    settings += [] if alone else ['locking_mode = NORMAL']
    return _set_up(file, limit // 16, *settings)


def _set_up(file: Path, size: int, *journal: str) -> sqlite3.Connection:
    database = sqlite3.connect(file, timeout=BUSY, isolation_level=None, check_same_thread=False)
    settings = (
        *('synchronous = FULL', 'temp_store = MEMORY'),
        *(f'journal_size_limit = {size}', f'wal_autocheckpoint = {max(1, size // 4096)}'),
    )
    try:
        for setting in (*journal, *settings):
            database.execute(f'PRAGMA {setting}').fetchall()
        database.executescript('BEGIN IMMEDIATE; ROLLBACK')  # tries the journal
    except sqlite3.Error:
        database.close()
        raise
    return database


class OtherVersion(ValueError):
    """A database is of a version that is not known."""


def is_empty(database: sqlite3.Connection, version: int) -> bool:
    """Return True if a database has no table; raises ValueError for what nobody has left."""
    ((version_on_file,),) = database.execute('PRAGMA user_version')
    ((tables,),) = database.execute('SELECT count(*) FROM sqlite_master')
    if version_on_file != version and (version_on_file or tables):
        raise OtherVersion(f'{OTHER_VERSION} ({version_on_file}, known is {version})')
    ((fault,),) = database.execute('PRAGMA quick_check(1)')
    if fault != 'ok':
        raise ValueError(fault.splitlines()[-1])
    return not tables


def check_tables(database: sqlite3.Connection, tables: Iterable[Table]) -> None:
    """Raise ValueError if a table is missing or has other columns."""
    for table in tables:
        info = database.execute(f'PRAGMA table_info({table.name})').fetchall()
        if not info:
            raise ValueError(f'no such table: {table.name}')
        if {column[1]: column[2] for column in info} != table.columns:
            raise ValueError(f'table {table.name} has other columns')


def readable(table: Table, rows: Iterable[Any]) -> list[tuple[Any, Any]]:
    """Return rows with their records, those that have one."""
    pairs = []
    for row in rows:
        with contextlib.suppress(ValueError, KeyError, TypeError):
            pairs.append((row, table.read(row)))
    return pairs


def set_file_aside(file: Path, why: Exception) -> str:
    """Rename a database with the journal that belongs to it; return a sentence that says so."""
    for part in PARTS:
        source = file.with_name(file.name + part)
        aside = file.with_name(f'{file.name}.aside{part}')
        aside.unlink(missing_ok=True)
        if source.exists():
            source.replace(aside)
    reason = str(why) if isinstance(why, OtherVersion) else f'{DAMAGED} ({why})'
    return f'{file} {reason}, moved to {file.name}.aside'


@contextlib.contextmanager
def opened_to_read(
    folder: Path, name: str, tables: Iterable[Table], version: int
) -> Iterator[Store]:
    """
    Yield a store that is only read, whether or not a node has the file.

    Raises InputError if there is none, or none that can be read.

    """
    file, tables = folder / name, tuple(tables)
    if not file.is_file():
        raise InputError(f'{folder} has no {name}: name the state_dir of a node')
    try:
        place = f'{file.absolute().as_uri()}?mode=ro'
        with contextlib.closing(sqlite3.connect(place, uri=True, timeout=BUSY)) as database:
            (version_on_file,) = database.execute('PRAGMA user_version').fetchone()
            if version_on_file != version:
                raise InputError(f'{file} {OTHER_VERSION} ({version_on_file}, known is {version})')
            try:
                check_tables(database, tables)
            except ValueError as error:
                raise InputError(f'{file} {DAMAGED} ({error})') from None
            store = Store(file, tables, version=version, limit=0)
            store.use(database)
            yield store
    except sqlite3.Error as error:
        raise InputError(f'{file} cannot be read, {error}') from None


def on_network(folder: Path, mounts: Path = Path('/proc/self/mountinfo')) -> bool:
    """Return True if a folder is on a file system that other machines may share."""
    device = folder.stat().st_dev
    number = f'{os.major(device)}:{os.minor(device)}'
    with contextlib.suppress(OSError):
        lines = [line.partition(' - ') for line in mounts.read_text().splitlines()]
        kinds = {right.split()[0] for left, _, right in lines if left.split()[2] == number}
        return bool(kinds & NETWORK)
    return False


def is_passing(error: Exception) -> bool:
    """Return True if a file is as it should be, and only cannot be had now."""
    code = getattr(error, 'sqlite_errorcode', sqlite3.SQLITE_ERROR) & 0xFF
    return isinstance(error, sqlite3.OperationalError) and code != sqlite3.SQLITE_ERROR


def size_of(file: Path) -> int:
    """Return the size of a file [B], 0 where there is none."""
    with contextlib.suppress(FileNotFoundError):
        return file.stat().st_size
    return 0
