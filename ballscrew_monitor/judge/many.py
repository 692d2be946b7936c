# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Many events of one axis judged at once: the step of `step`, compiled."""

from collections.abc import Callable, Iterator
import functools
from typing import Any, NamedTuple

from ballscrew_monitor.core.advice import Criterion, Nearest, nearest
from ballscrew_monitor.judge.monitor import Monitor
from ballscrew_monitor.judge.records import EVENT, Memory, Row, Settings
from ballscrew_monitor.judge.slopes import SlopeRing
from ballscrew_monitor.judge.step import step_many
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
    """Judges arrays of events in the place of a monitor."""

    def __init__(self, monitor: Monitor) -> None:
        self._monitor = monitor
        monitor.nearest = compiled_nearest()
        self._rows = np.empty(AT_ONCE, dtype=ROW)
        self._places = np.empty(AT_ONCE, dtype=np.int64)
        self._tables = monitor.surface.array_tables
        parts = (monitor.numbers, monitor.memory, monitor.speeds, monitor.positions)
        self._arrays = tuple(as_array(part) for part in parts)

    def give_back(self) -> None:
        """Let the monitor remember what is remembered here."""
        _, memory, speeds, positions = self._arrays
        self._monitor.memory = from_array(Memory, memory[0])
        self._monitor.speeds = from_array(SlopeRing, speeds[0])
        self._monitor.positions = from_array(SlopeRing, positions[0])

    def judge(self, events: NDArray[Any], *, states: bool = False) -> Iterator[Judged]:
        """
        Judge events, an array of EVENT.

        The memory comes of each row of which a state is published if `states` are wanted, else of
        the rows that begin or end an excursion.

        """
        memories = np.empty(MOST_MEMORIES if states else 64, dtype=MEMORY)
        at = 0
        while at < len(events):
            end = at + AT_ONCE
            some = events[at:end]
            taken, count, told = compiled_step()(
                self._tables, *self._arrays, some, self._rows, self._places, memories, states
            )
            rows, places = self._rows[:count], self._places
            which = np.flatnonzero(rows['published'] if states else rows['edge'])
            yield Judged(rows, places[:count] + at, memories[:told], which)
            at += taken


def prepare() -> None:
    """Compile the step and the lookup, so that the first recording does not wait for them."""
    surface = Surface.load(shipped_surface())
    parts = (as_array(kind()) for kind in (Settings, Memory, SlopeRing, SlopeRing))
    events, rows, places, memories = (np.empty(0, kind) for kind in (EVENT, ROW, np.int64, MEMORY))
    compiled_step()(surface.array_tables, *parts, events, rows, places, memories, False)
    look_up_many(surface, *np.empty((3, 0)))
