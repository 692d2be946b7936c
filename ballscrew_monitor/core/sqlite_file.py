# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
SQLite files that one node writes and anybody reads: settings, checks, setting aside.

A write-ahead log lets others read meanwhile; where it cannot work there is a rollback journal. A
commit is on the disk when it returns.

"""

from collections.abc import Iterator
import contextlib
import os
from pathlib import Path
import sqlite3

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
"""What a file raises that no node has left; `is_passing` tells what only cannot be had now."""


def connected(file: Path, limit: int) -> sqlite3.Connection:
    """
    Return a connection with a write-ahead log, or with what works in its place.

    The journal is kept to a part of the `limit` [B]. Raises sqlite3.Error and OSError.

    """
    if not on_network(file.parent):
        with contextlib.suppress(sqlite3.OperationalError):
            return _set_up(file, limit // 16, 'journal_mode = WAL')
    # Who is alone can read the write-ahead log of before without shared memory.
    return _set_up(file, limit // 16, 'locking_mode = EXCLUSIVE', 'journal_mode = TRUNCATE')


def _set_up(file: Path, size: int, *journal: str) -> sqlite3.Connection:
    database = sqlite3.connect(file, timeout=BUSY, isolation_level=None, check_same_thread=False)
    settings = (
        *('locking_mode = NORMAL', 'synchronous = FULL', 'temp_store = MEMORY'),
        *(f'journal_size_limit = {size}', f'wal_autocheckpoint = {max(1, size // 4096)}'),
    )
    try:
        for setting in (*journal, *settings):
            database.execute(f'PRAGMA {setting}').fetchall()
        database.executescript('BEGIN IMMEDIATE; ROLLBACK')  # tries the journal
    except sqlite3.Error:
        database.close()
        raise
    database.row_factory = sqlite3.Row
    return database


def is_empty(database: sqlite3.Connection, version: int) -> bool:
    """Tell whether a database has no table; raises ValueError for what no node has left."""
    ((found,),) = database.execute('PRAGMA user_version')
    ((tables,),) = database.execute('SELECT count(*) FROM sqlite_master')
    if found != version and (found or tables):
        raise ValueError(f'{OTHER_VERSION} ({found}, known is {version})')
    ((fault,),) = database.execute('PRAGMA quick_check(1)')
    if fault != 'ok':
        raise ValueError(fault.splitlines()[-1])
    return not tables


def has_room(database: sqlite3.Connection, file: Path, limit: int) -> bool:
    """Tell whether the journal of a file can take more: its part of a `limit` [B]."""
    journal = file.with_name(f'{file.name}-wal')
    if size_of(journal) <= (1.0 - SHARE) * limit:
        return True
    # Somebody reads, and it could not begin again.
    database.execute('PRAGMA wal_checkpoint(TRUNCATE)').fetchall()
    return not size_of(journal)


def let_go(database: sqlite3.Connection | None, *, alone: bool = False) -> None:
    """Close a connection, if there is one; `alone` leaves one file, which anybody can read."""
    if database is None:
        return
    with contextlib.suppress(sqlite3.Error):
        if alone:
            database.execute('PRAGMA journal_mode = DELETE')
    with contextlib.suppress(sqlite3.Error):
        database.close()


def set_file_aside(file: Path, why: Exception) -> str:
    """Rename a database with the journal that belongs to it; return a sentence that says so."""
    for part in PARTS:
        one = file.with_name(file.name + part)
        aside = file.with_name(f'{file.name}.aside{part}')
        aside.unlink(missing_ok=True)
        if one.exists():
            one.replace(aside)
    what = str(why) if str(why).startswith(OTHER_VERSION) else f'{DAMAGED} ({why})'
    return f'{file} {what}, moved to {file.name}.aside'


@contextlib.contextmanager
def opened_to_read(folder: Path, name: str, version: int) -> Iterator[sqlite3.Connection]:
    """
    Yield a connection that only reads, whether or not a node has the file.

    Raises InputError if there is none, or none that can be read.

    """
    file = folder / name
    if not file.is_file():
        raise InputError(f'{folder} has no {name}: name the state_dir of a node')
    try:
        place = f'{file.absolute().as_uri()}?mode=ro'
        with contextlib.closing(sqlite3.connect(place, uri=True, timeout=BUSY)) as database:
            (found,) = database.execute('PRAGMA user_version').fetchone()
            if found != version:
                raise InputError(f'{file} {OTHER_VERSION} ({found}, known is {version})')
            database.row_factory = sqlite3.Row
            yield database
    except sqlite3.Error as error:
        raise InputError(f'{file} cannot be read, {error}') from None


def on_network(folder: Path, mounts: Path = Path('/proc/self/mountinfo')) -> bool:
    """Tell whether a folder is on a file system that other machines may share."""
    device = folder.stat().st_dev
    number = f'{os.major(device)}:{os.minor(device)}'
    with contextlib.suppress(OSError):
        lines = [line.partition(' - ') for line in mounts.read_text().splitlines()]
        kinds = {right.split()[0] for left, _, right in lines if left.split()[2] == number}
        return bool(kinds & NETWORK)
    return False


def is_passing(error: Exception) -> bool:
    """Tell whether a file is as it should be, and only cannot be had now."""
    code = getattr(error, 'sqlite_errorcode', sqlite3.SQLITE_ERROR) & 0xFF
    return isinstance(error, sqlite3.OperationalError) and code != sqlite3.SQLITE_ERROR


def size_of(file: Path) -> int:
    """Return the size of a file [B], 0 where there is none."""
    with contextlib.suppress(FileNotFoundError):
        return file.stat().st_size
    return 0
