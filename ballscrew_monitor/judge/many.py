# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Many events of one axis judged at once: the step of `step`, compiled."""

from collections.abc import Callable, Iterator
import functools
from typing import Any, NamedTuple

from ballscrew_monitor.core.advice import Criterion, Nearest, nearest
from ballscrew_monitor.core.state import NOT_ENDED
from ballscrew_monitor.judge.monitor import Monitor
from ballscrew_monitor.judge.records import EVENT, Memory, Row, Settings
from ballscrew_monitor.judge.slopes import SlopeRing
from ballscrew_monitor.judge.step import step_many
from ballscrew_monitor.judge.zone import ACTIVE
import numpy as np
from numpy.typing import NDArray
from surrogate.surface import Found, look_up_many, shipped_surface, Surface
from surrogate.surface.compiled import compiled
from surrogate.surface.records import as_array, dtype_of, from_array

MEMORY, ROW = dtype_of(Memory), dtype_of(Row)
AT_ONCE = 16384
"""Events that are judged in one go."""
MOST_MEMORIES = 2048
"""Rows in one go of which the memory is kept."""


class Judged(NamedTuple):
    """
    Rows, the places of their events, and the memory after some of them.

    Memories are those of `told`, places among the rows. The next one overwrites the rows.

    """

    rows: NDArray[Any]
    places: NDArray[np.int64]
    memories: NDArray[Any]
    told: NDArray[np.intp]


@functools.cache
def compiled_step() -> Callable[..., tuple[int, int, int]]:
    """Return `step_many` compiled; raises ImportError without numba."""
    return compiled(step_many)


@functools.cache
def compiled_nearest() -> Nearest:
    """Return the scan for advice compiled; raises ImportError without numba."""
    entry, room = compiled(nearest), np.zeros(1, dtype=dtype_of(Found))

    def scan(surface: Surface, criterion: Criterion, here: float, speeds: list[float]) -> float:
        tables = surface.array_tables
        return float(entry(tables, criterion, float(here), np.array(speeds), room))

    return scan


class ManyJudge:
    """
    Judges arrays of events in the place of a monitor.

    It remembers for the monitor until somebody asks that for its memory.

    """

    def __init__(self, monitor: Monitor, at_once: int = AT_ONCE) -> None:
        """Judge `at_once` events in one go."""
        self._monitor, self._at_once = monitor, at_once
        self._rows = np.empty(at_once, dtype=ROW)
        self._places = np.empty(at_once, dtype=np.int64)
        self._memories = np.empty(min(MOST_MEMORIES, at_once), dtype=MEMORY)
        self._arrays: tuple[NDArray[Any], ...] = ()  # memory and slopes
        self._settings: Any = None  # in force, and as an array
        self._numbers: Any = None
        self._last = np.zeros(1, MEMORY)[0]  # at the last look for a leap
        self._event = 0  # number of the last one

    def _give_back(self) -> None:
        """Let the monitor remember what is remembered here."""
        memory, speeds, positions = self._arrays
        self._monitor.memory = from_array(Memory, memory[0])
        self._monitor.speeds = from_array(SlopeRing, speeds[0])
        self._monitor.positions = from_array(SlopeRing, positions[0])

    def judge(self, events: NDArray[Any], *, states: bool = False) -> Iterator[Judged]:
        """
        Judge events, an array of EVENT.

        The memory comes of each row of which a state is published if `states` are wanted, else of
        the rows that begin or end an excursion.

        """
        monitor = self._monitor
        if not monitor.is_lent(self._give_back):
            memory = monitor.memory
            parts = memory, monitor.speeds, monitor.positions
            self._arrays = tuple(as_array(part) for part in parts)
            self._event, self._last = memory.event_number, self._arrays[0][0].copy()
            monitor.lend(self._give_back)
        if monitor.numbers is not self._settings:
            self._settings, self._numbers = monitor.numbers, as_array(monitor.numbers)
        tables, at = monitor.surface.array_tables, 0
        while at < len(events):
            end = at + self._at_once
            some = events[at:end]
            taken, count, told = compiled_step()(
                tables,
                self._numbers,
                *self._arrays,
                some,
                self._rows,
                self._places,
                self._memories,
                states,
            )
            rows, places = self._rows[:count], self._places
            which = np.flatnonzero(rows['published'] if states else rows['edge'])
            yield Judged(rows, places[:count] + at, self._memories[:told], which)
            at += taken

    def told(self, judged: Judged) -> Iterator[tuple[int, Row]]:
        """Yield those rows of which the memory is known; the monitor remembers it meanwhile."""
        monitor = self._monitor
        try:
            for at, memory in zip(judged.told.tolist(), judged.memories, strict=True):
                shown = from_array(Memory, memory)
                monitor.show(shown)
                if shown.event_number != self._event:
                    self._event, monitor.ending = shown.event_number, NOT_ENDED
                monitor.moved = self._moved_to(memory)
                yield at, from_array(Row, judged.rows[at])
        finally:
            monitor.lend(self._give_back)
            monitor.moved = self._moved_to(self._arrays[0][0])

    def _moved_to(self, memory: Any) -> int:
        """Return by how much the begin of an excursion has moved since the last look [ns]."""
        before, self._last = self._last, memory.copy()
        same = before['event_active'] and before['event_number'] == memory['event_number']
        # Of a step of the node's clock its own event tells.
        if not same or before['clock_step']:
            return 0
        return int(memory['event_start'][ACTIVE] - before['event_start'][ACTIVE])


def prepare() -> None:
    """Compile the step and the lookup, so that the first recording does not wait for them."""
    surface = Surface.load(shipped_surface())
    parts = (as_array(kind()) for kind in (Settings, Memory, SlopeRing, SlopeRing))
    events, rows, places, memories = (np.empty(0, kind) for kind in (EVENT, ROW, np.int64, MEMORY))
    compiled_step()(surface.array_tables, *parts, events, rows, places, memories, False)
    look_up_many(surface, *np.empty((3, 0)))
