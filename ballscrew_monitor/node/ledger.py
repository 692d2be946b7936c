# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
What is to be written down, and when: the judgement never waits for a disk.

Lines of the log and memories are handed in from the thread that judges and written by another.
What cannot be written stays here, and is tried again until it can.

"""

from collections import deque
from collections.abc import Callable, Iterator, Mapping
import contextlib
import functools
import math
import threading
import time

from ballscrew_monitor.core.memory import Memory
from ballscrew_monitor.node.event_log import EventLog
from ballscrew_monitor.node.memory_store import MemoryStore
from ballscrew_monitor.node.state_folder import StateFolder

LINES = 0.02  # [s] shortest time between two writes of the log
MEMORIES = 1.0  # [s] shortest time between two writes of the memories, and after a failure
MOST_LINES = 10_000  # waiting while nothing can be written; the oldest are dropped


class Ledger:
    """Takes lines and memories, and writes them when they are due."""

    def __init__(self, folder: StateFolder) -> None:
        """Write into a `folder`."""
        self.wake = threading.Event()
        self._folder = folder
        self._log = EventLog(folder)
        self._store = MemoryStore(folder)
        self._pending = threading.Lock()  # what waits
        self._disk = threading.Lock()  # the files
        self._lines: deque[str] = deque(maxlen=MOST_LINES)
        self._memories: dict[str, Memory] = {}
        self._lines_at = self._memories_at = -math.inf
        self._problems = ['', '']  # of the lines and of the memories

    @property
    def problem(self) -> str:
        """Return why what waits cannot be written, empty if it can."""
        return next(filter(None, self._problems), '')

    def note(self, line: str) -> None:
        """Append a line to the log soon."""
        with self._pending:
            self._lines.append(line)
        self.wake.set()

    def remember(self, axis: str, memory: Memory) -> None:
        """Keep the memory of an axis soon, unless a later one comes first."""
        with self._pending:
            self._memories[axis] = memory
        self.wake.set()

    def waiting(self, axis: str) -> Memory | None:
        """Return the memory of an axis that is not on the disk yet, if there is one."""
        with self._pending:
            return self._memories.get(axis)

    def work(self, now: float) -> float | None:
        """Write what is due at `now` [s]; return when to come again [s], None: when there is."""
        memories = bool(self._memories) and now >= self._memories_at
        lines = memories or now >= self._lines_at  # no memory knows of more than the log
        if lines or memories:
            self._write(lines=lines, memories=memories)
            pause = MEMORIES if self.problem else LINES
            self._lines_at = now + pause if lines else self._lines_at
            self._memories_at = now + MEMORIES if memories else self._memories_at
        times = [self._lines_at] * bool(self._lines) + [self._memories_at] * bool(self._memories)
        return min(times) if times else None

    def flush(self) -> str:
        """Write all that waits; return why that failed, or nothing."""
        self._write(lines=True, memories=True)
        return self.problem

    @contextlib.contextmanager
    def at_rest(self) -> Iterator[None]:
        """Hold all writing while the files are looked at."""
        with self._disk:
            yield

    def _write(self, *, lines: bool, memories: bool) -> None:
        with self._disk:
            # Taken before the lines: what they know of has been noted by then.
            taken = self._waiting() if memories else {}
            if lines and self._lines:
                self._problems[0] = self._write_lines()
            if taken:
                self._problems[1] = self._write_memories(taken)

    def _waiting(self) -> dict[str, Memory]:
        with self._pending:
            return dict(self._memories)

    def _write_lines(self) -> str:
        with self._pending:
            lines = list(self._lines)
            self._lines.clear()
        problem = _tried(lambda: self._log.append(lines))
        if problem:
            with self._pending:
                self._lines = deque([*lines, *self._lines], maxlen=MOST_LINES)
        return problem

    def _write_memories(self, memories: Mapping[str, Memory]) -> str:
        for axis, memory in memories.items():
            problem = _tried(functools.partial(self._store.save, axis, memory))
            if problem:
                return problem
            with self._pending:
                if self._memories.get(axis) is memory:
                    del self._memories[axis]
        return ''


def _tried(write: Callable[[], str]) -> str:
    """Write; return why that failed, or nothing."""
    try:
        return write()
    except Exception as error:  # noqa: BLE001 the thread must live, and what waits must stay
        return f'what is to be kept cannot be written, {type(error).__name__}: {error}'


class Scribe(threading.Thread):
    """Works off a ledger until it is stopped."""

    def __init__(self, ledger: Ledger) -> None:
        """Begin with a `ledger`; a process that ends does not wait for it."""
        super().__init__(name='scribe', daemon=True)
        self._ledger = ledger
        self._stopped = threading.Event()

    def run(self) -> None:
        """Write what is due, and sleep."""
        wake = self._ledger.wake
        while not self._stopped.is_set():
            wake.clear()
            now = time.monotonic()
            again = self._ledger.work(now)
            if again is None:
                wake.wait()
            else:  # a line of the log may come that is due before
                self._stopped.wait(min(again - now, LINES))

    def stop(self) -> None:
        """End after the write that is under way."""
        self._stopped.set()
        self._ledger.wake.set()
        if self.is_alive():
            self.join()
