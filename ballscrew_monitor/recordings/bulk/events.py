# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
The stays outside the zone over a stretch, from where its level changed.

What `Excursions` does sample by sample.

"""

from collections.abc import Callable
import dataclasses

from ballscrew_monitor.core.advice import Advisor
from ballscrew_monitor.core.judgement import Code, Finding, Level
from ballscrew_monitor.core.remembered import Remembered
from ballscrew_monitor.core.state import Event
from ballscrew_monitor.recordings.bulk.estimates import Judgements
from ballscrew_monitor.recordings.bulk.levels import Levels, Sign
from ballscrew_monitor.recordings.columns import LIGHT_LOAD
import numpy as np
from numpy.typing import NDArray


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class Events:
    """The events that begin or end, by row; the last event and the one that may follow it."""

    edges: dict[int, Event]
    number: NDArray[np.uint32]
    event: Event
    pending: Event | None


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class _Outside:
    """The rows outside, with what is judged there."""

    stamp: NDArray[np.int64]
    judged: Judgements
    levels: Levels

    def worst(self, event: Event, begin: int, end: int) -> Event:
        """Return an event with its worst value up to the rows from `begin` to before `end`."""
        rows = self.levels.outside.rows
        rows = rows[slice(*np.searchsorted(rows, [begin, end]))]
        if event.cause.code is Code.RCS_HIGH:
            worst = float(self.judged.rcs[rows].max(initial=event.worst_value))
        else:
            judged = rows[self.judged.gates[rows] & LIGHT_LOAD == 0]
            worst = float(self.judged.efficiency[judged].min(initial=event.worst_value))
        return dataclasses.replace(event, worst_value=worst)


def follow(
    memory: Remembered,
    stamp: NDArray[np.int64],
    judged: Judgements,
    levels: Levels,
    *,
    advisor_at: Callable[[int], Advisor],
    finding_at: Callable[[int], Finding],
) -> Events:
    """Return the events of rows with these stamps [ns]."""
    outside = _Outside(stamp=stamp, judged=judged, levels=levels)
    event, edges, begins, row = memory.event, {}, [], 0
    for at, level in levels.changes:
        if level is Level.WARN:
            pending = _pending(memory, outside, at + 1, finding_at)
            assert pending is not None
            event = dataclasses.replace(
                pending,
                number=event.number + 1,
                active=True,
                stamp=int(stamp[at]),
                advisor=advisor_at(at),
            )
            begins.append(at)
        elif event.active:
            event = outside.worst(event, row, at)
            event = dataclasses.replace(event, active=False, stamp=int(stamp[at]))
        else:
            continue
        edges[at], row = event, at + 1
    if event.active:
        event = outside.worst(event, row, len(stamp))
    number = memory.event.number + np.searchsorted(begins, np.arange(len(stamp)), 'right')
    return Events(
        edges=edges,
        number=number.astype(np.uint32),
        event=event,
        pending=_last_pending(memory, outside, finding_at),
    )


def _last_pending(
    memory: Remembered, outside: _Outside, finding_at: Callable[[int], Finding]
) -> Event | None:
    """Return the event that may follow after the last row."""
    known = np.flatnonzero(outside.judged.sign)
    if not len(known):
        return memory.pending
    if outside.levels.memory.level is Level.WARN or outside.judged.sign[known[-1]] != Sign.OUTSIDE:
        return None
    return _pending(memory, outside, len(outside.stamp), finding_at)


def _pending(
    memory: Remembered, outside: _Outside, end: int, finding_at: Callable[[int], Finding]
) -> Event | None:
    """Return the event that the run outside before the row `end` may become."""
    runs = outside.levels.outside
    last = int(np.searchsorted(runs.rows, end)) - 1
    rows = runs.rows[slice(max(int(runs.first[last]), 0), last + 1)]
    # A run that goes on from before has its event, unless samples of its first stamp follow.
    first = rows[outside.stamp[rows] == runs.start[last]]
    if not len(first) and memory.pending is not None:
        return outside.worst(memory.pending, int(rows[0]), end)
    begin = int(first[-1] if len(first) else rows[0])
    finding = finding_at(begin)
    event = Event(start=int(outside.stamp[begin]), cause=finding, worst_value=finding.value)
    return outside.worst(event, begin, end)
