# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
The held level of many rows: from one change to the next, not from row to row.

What `judgement.hold` does sample by sample. An unbroken run of samples is where one begins and how
long it has lasted; the level changes at the first row whose run is long enough.

"""

import dataclasses
import enum

from ballscrew_monitor.core.judgement import Hold, Level, Limits, UnbrokenRun
import numpy as np
from numpy.typing import NDArray

Rows = NDArray[np.intp]
Times = NDArray[np.int64]


class Sign(enum.IntEnum):
    """What the verdict of a row does to the level."""

    NONE = 0
    OPTIMAL = 1
    CLEAR = 2
    OUTSIDE = 3


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class Runs:
    """
    Rows of one kind, and the stamp [ns] at which the unbroken run of each began.

    `first` is the place in `rows` of the first row of the run, -1 for a run from before.

    """

    rows: Rows
    start: Times
    first: Rows


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class Levels:
    """The level of each row, the rows at which it changed, the runs outside, and the memory."""

    level: NDArray[np.uint8]
    changes: list[tuple[int, Level]]
    outside: Runs
    memory: Hold


def held_levels(
    stamp: Times,
    sign: NDArray[np.uint8],
    period: Times,
    memory: Hold,
    limits: Limits,
    *,
    max_gap: int,
) -> Levels:
    """
    Return the levels of rows with these stamps [ns] and signs, after what `memory` tells.

    A hole of more than `max_gap` [ns], and of more than the `period` [ns] of a slow input, breaks
    a run outside.

    """
    outside = _runs_outside(stamp, sign, np.maximum(period, max_gap), memory.raising)
    clear = _unbroken(stamp, sign == Sign.CLEAR, max_gap, memory.clearing)
    inside = (sign == Sign.OPTIMAL) | (sign == Sign.CLEAR)
    optimal = _unbroken(stamp, inside, max_gap, memory.clearing)
    ripe = {
        Level.WARN: _ripe(stamp, outside, limits.raise_delay),
        Level.OK: _ripe(stamp, clear, limits.clear_delay),
        Level.UNKNOWN: _ripe(stamp, optimal, limits.clear_delay),
    }
    changes = _changes(memory.level, ripe)
    rows = [row for row, _ in changes]
    held = np.array([memory.level, *(level for _, level in changes)], dtype=np.uint8)
    at = np.searchsorted(rows, np.arange(len(stamp)), 'right') if rows else 0
    last = changes[-1][1] if changes else memory.level
    return Levels(
        level=np.broadcast_to(held[at], stamp.shape),
        changes=changes,
        outside=outside,
        memory=Hold(
            level=last,
            since=int(stamp[rows[-1]]) if rows else memory.since,
            raising=None if last is Level.WARN else _raising(stamp, sign, outside, memory),
            clearing=_clearing(stamp, last, clear if last is Level.WARN else optimal, memory),
        ),
    )


def _runs_outside(
    stamp: Times, sign: NDArray[np.uint8], gap: Times, before: UnbrokenRun | None
) -> Runs:
    """Return the runs outside: what cannot be judged does not break them."""
    known = np.flatnonzero(sign)
    places = np.flatnonzero(sign[known] == Sign.OUTSIDE)
    rows, previous = known[places], known[places - 1]
    broken = (sign[previous] != Sign.OUTSIDE) | (stamp[rows] - stamp[previous] > gap[rows])
    return _runs(stamp, rows, broken, places[:1] == 0, gap, before)


def _unbroken(
    stamp: Times, which: NDArray[np.bool_], max_gap: int, before: UnbrokenRun | None
) -> Runs:
    """Return the runs of neighbouring rows."""
    rows = np.flatnonzero(which)
    broken = ~which[rows - 1] | (stamp[rows] - stamp[rows - 1] > max_gap)
    return _runs(stamp, rows, broken, rows[:1] == 0, np.full(len(stamp), max_gap), before)


def _runs(
    stamp: Times,
    rows: Rows,
    broken: NDArray[np.bool_],
    at_once: NDArray[np.bool_],
    gap: Times,
    before: UnbrokenRun | None,
) -> Runs:
    """Return runs by where they are broken; that from `before` goes on `at_once` or never."""
    start = 0 if before is None else before.start
    if at_once.any():
        broken[0] = before is None or stamp[rows[0]] - before.last > gap[rows[0]]
    first = np.maximum.accumulate(np.where(broken, np.arange(len(rows)), -1))
    return Runs(rows=rows, start=np.where(first < 0, start, stamp[rows[first]]), first=first)


def _ripe(stamp: Times, runs: Runs, delay: int) -> Rows:
    """Return the rows whose run has lasted for a delay [ns]."""
    return runs.rows[stamp[runs.rows] - runs.start >= delay]


def _changes(level: Level, ripe: dict[Level, Rows]) -> list[tuple[int, Level]]:
    """Return the rows at which the level changes, and to what."""
    changes: list[tuple[int, Level]] = []
    row = -1
    while True:
        found = [(_next(ripe[Level.WARN], row), Level.WARN)] if level is not Level.WARN else []
        if level is Level.WARN:
            found = [(_next(ripe[Level.OK], row), Level.OK)]
        if level is Level.UNKNOWN:
            found.append((_next(ripe[Level.UNKNOWN], row), Level.OK))
        nearest = min((each for each in found if each[0] >= 0), default=None)
        if nearest is None:
            return changes
        row, level = nearest
        changes.append(nearest)


def _next(rows: Rows, after: int) -> int:
    """Return the first of some rows after one, -1 if there is none."""
    at = np.searchsorted(rows, after, 'right')
    return int(rows[at]) if at < len(rows) else -1


def _raising(
    stamp: Times, sign: NDArray[np.uint8], outside: Runs, memory: Hold
) -> UnbrokenRun | None:
    """Return the run outside that goes on after the last row."""
    known = np.flatnonzero(sign)
    if not len(known):
        return memory.raising
    if sign[known[-1]] != Sign.OUTSIDE:
        return None
    return UnbrokenRun(start=int(outside.start[-1]), last=int(stamp[known[-1]]))


def _clearing(stamp: Times, level: Level, runs: Runs, memory: Hold) -> UnbrokenRun | None:
    """Return the run towards OK that goes on after the last row."""
    if not len(stamp):
        return memory.clearing
    if level is Level.OK or not len(runs.rows) or runs.rows[-1] != len(stamp) - 1:
        return None
    return UnbrokenRun(start=int(runs.start[-1]), last=int(stamp[-1]))
