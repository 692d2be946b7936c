# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
State over restarts: handed over by the thread that judges, written by one thread of its own.

All that waits is one transaction, so that the event log and the records of the axes always agree.
What cannot be written waits, and is tried again each second.

"""

from collections import deque
import math
import os
from pathlib import Path
import sqlite3
import threading
import time
from typing import TypeVar

from ballscrew_monitor.node.state_database import at_limit, StateDatabase, UNWRITABLE
from ballscrew_monitor.node.state_records import (
    by_key,
    Corrections,
    Entry,
    Record,
    Records,
    TABLES,
)
from surrogate.files import InputError

AUTO = 'auto'
PAUSE = 0.05  # [s] shortest time between two commits
RETRY = 1.0  # [s] after a failure
SILENT = 'does not answer'
GONE = 'was removed or replaced'
PATIENCE = 2.0  # [s] that a service, a correction or a transition waits for the disk
MOST_ENTRIES = 10_000  # waiting while nothing can be written; the oldest are dropped
SHARE = 4  # corrections have this part of the limit
Kept = TypeVar('Kept', bound=Record)


def state_directory(wanted: str, node_name: str) -> Path | None:
    """
    Return where a node of a full name keeps what outlives it, None: nowhere.

    `auto` is the place that the XDG base directory specification has for state.

    """
    if not wanted:
        return None
    if wanted != AUTO:
        return Path(wanted)
    home = os.environ.get('XDG_STATE_HOME') or Path.home() / '.local' / 'state'
    return Path(home, 'ballscrew_monitor', *node_name.strip('/').split('/'))


class RestartState:
    """What one node keeps in a `folder`, below a `limit` [B]; nothing without a folder."""

    def __init__(self, folder: Path | None, *, limit: int = 64_000_000) -> None:
        """Read what is there; before `start` only `flush` writes."""
        self.folder = folder
        self.limit = limit
        self.damage: list[str] = []  # sentences on what was set aside
        self._database: StateDatabase | None = None
        if folder is not None:
            self._database = StateDatabase(folder, limit, damage=self.damage)
        self._problem = ''
        self._refused: dict[str, str] = {}  # why the corrections of an axis are not kept
        self._lock = threading.Lock()  # of what waits
        self._entries: deque[Entry] = deque(maxlen=MOST_ENTRIES)
        self._changed: Records = {}
        self._latest: Records = {}  # written or not
        self._found: Records | None = None  # left by an earlier node and not recalled yet
        self._wake = threading.Event()
        self._asked: list[threading.Event] = []  # for all to be on the disk
        self._due = -math.inf
        self._stopped = False
        self._thread: threading.Thread | None = None
        self._write()

    @property
    def problem(self) -> str:
        """Return what is wrong with what is kept, empty if nothing is."""
        refused = [
            f'corrections of {axis} are not kept, {why}' for axis, why in self._refused.items()
        ]
        return '; '.join(filter(None, [self._problem, *self.damage, *refused]))

    @property
    def is_held(self) -> bool:
        """Return True if the folder is that of this node alone."""
        return self._database is not None and self._database.is_open

    def look(self) -> None:
        """Have all written again soon, if the folder or what is in it is no longer there."""
        if self._database is not None and self._database.is_lost:
            self._problem = f'{self.folder} {GONE}'
            self._wake.set()

    def forget_problems(self) -> None:
        """Say no more of what was set aside, nor of corrections that are gone."""
        self.damage.clear()
        self._refused.clear()

    def keep(self, record: Record | None, entry: Entry | None = None) -> None:
        """Keep a record soon, if it has changed, and append to the event log with it."""
        with self._lock:
            if entry is not None:
                self._entries.append(entry)
            if record is not None:
                ((key, _),) = by_key([record]).items()
                row, last = TABLES[key[0]].row, self._latest.get(key)
                if last is None or row(last) != row(record):
                    self._latest[key] = self._changed[key] = record
        self._wake.set()

    def keep_corrections(self, corrections: Corrections) -> str:
        """Keep corrections; return why that failed, or nothing."""
        if self.folder is None:
            return 'state_dir is empty'
        kept = self._latest | by_key([corrections])
        size = sum(len(record.solves) for (kind, _), record in kept.items() if kind is Corrections)
        if size * SHARE > self.limit:
            self._refused[corrections.axis] = at_limit(self.folder, self.limit)
            return self._refused[corrections.axis]
        self._refused.pop(corrections.axis, None)
        self.keep(corrections)
        return self.flush()

    def recall(self, blank: Kept, *, late: bool = False) -> Kept:
        """
        Return what is known in place of a `blank` record: what an earlier node left, once.

        Else what was kept last, unless the earlier node is asked about `late`.

        """
        key = (type(blank), blank.axis)
        with self._lock:
            record = self._found.pop(key, None) if self._found else None
            return record or (blank if late else self._latest.get(key, blank))

    def is_late(self, axis: str) -> bool:
        """Return True if an earlier node left something of an axis that is not recalled yet."""
        return any(axis == name for _, name in self._found or ())

    def flush(self) -> str:
        """Write all that waits, and wait for the disk; return why that failed, or nothing."""
        if self._thread is None:
            self._write()
            return self._problem
        done = threading.Event()
        with self._lock:
            self._asked.append(done)
        self._wake.set()
        if not done.wait(PATIENCE):
            self._problem = f'{self.folder} {SILENT}'  # until something is written
        return self._problem

    def start(self) -> None:
        """Let a thread write what comes; a process that ends does not wait for it."""
        if self._database is not None:
            self._thread = threading.Thread(target=self._run, name='restart_state', daemon=True)
            self._thread.start()

    def close(self) -> None:
        """Write all that waits, and let another node have the directory."""
        self.flush()
        self._stopped = True
        self._wake.set()
        thread, self._thread = self._thread, None
        if thread is not None:
            thread.join(PATIENCE)
        if self._database is not None and not (thread and thread.is_alive()):
            self._database.close()

    def work(self, now: float) -> float | None:
        """Write what is due at `now` [s]; return when to come again [s], None: when woken."""
        with self._lock:
            asked, self._asked = self._asked, []
        if asked or (self._is_waiting and now >= self._due):
            self._write()
            self._due = now + (RETRY if self._problem else PAUSE)
        for done in asked:
            done.set()
        return self._due if self._is_waiting else None

    @property
    def _is_waiting(self) -> bool:
        return bool(self._entries or self._changed or self._problem)

    def _run(self) -> None:
        while not self._stopped:
            self._wake.clear()
            again = self.work(time.monotonic())
            self._wake.wait(None if again is None else max(again - time.monotonic(), 0.0))

    def _write(self) -> None:
        database = self._database
        if database is None:
            return
        try:
            if self._stopped:
                raise InputError(f'{self.folder} is closed')
            if not database.is_open:
                self._open(database)
            entries, records = self._waiting()
            if entries or records:
                database.write(entries, records.values())
            written = set(map(id, entries))
            with self._lock:
                left = [entry for entry in self._entries if id(entry) not in written]
                self._entries = deque(left, maxlen=MOST_ENTRIES)
                for key, record in records.items():
                    if self._changed[key] is record:
                        del self._changed[key]
            self._problem = ''
        except InputError as error:
            self._problem = str(error)
        except Exception as error:  # noqa: BLE001 the thread must live, and what waits must stay
            database.let_go()  # what it left is read before all else
            known = error if isinstance(error, sqlite3.Error) else getattr(error, 'strerror', None)
            reason = known or f'{type(error).__name__}: {error}'
            self._problem = f'{self.folder} {UNWRITABLE}, {reason}'

    def _open(self, database: StateDatabase) -> None:
        records = database.load()
        with self._lock:
            self._found = records if self._found is None else self._found
            self._changed.update(self._latest)  # the file may be a new one

    def _waiting(self) -> tuple[list[Entry], Records]:
        """Return what is to be written; what an earlier node left is not replaced unseen."""
        with self._lock:
            held = self._found or {}
            records = {key: record for key, record in self._changed.items() if key not in held}
            return list(self._entries), records
