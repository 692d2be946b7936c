# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Rows that follow each other evenly though their stamps are rounded, or come early and late.

A slope over such stamps is no speed: at 400 Hz stamps of milliseconds are 2 and 3 ms apart. Where
the ways from row to row are even and the stamps are not, the rows are even, and their times are
the line through the stamps of a stretch.

"""

from collections.abc import Iterable, Iterator
import dataclasses
import math

from ballscrew_monitor.recordings.tables.cells import Array
import numpy as np
from numpy.typing import NDArray

Flags = NDArray[np.bool_]
Block = tuple[int, Array, dict[str, Array]]
"""The row in the file of the first of some rows, their times [s] and their columns."""

STRETCH = 64  # rows whose stamps together tell one time
SHORT = 16  # rows between which the usual step counts
LONG = 3.0  # times the usual step, from which on rows are missing
EVEN = 0.02  # part of the usual step by which those of even stamps differ
COUNTING = 0.41  # part of a step, up to which it is of so many rows
FEW = 0.002  # of the steps in motion
TINY = 1e-6  # part of a step, which is no time between rows
BETTER = 0.7  # of the roughness of slopes over others, which tells the times of rows
MISSING = 1.4  # times the way and the step beside, where a row is missing
UNEVEN = 0.1  # part of a step, from which on stamps disturb a slope more than noise may
BARELY = 0.05  # of the usual way from row to row
USUAL = 0.95  # quantile of ways from row to row
OFTEN = 0.05  # of the steps in motion
KEPT = 4 * STRETCH  # rows that begin the next block again
FEWEST = 16  # rows that tell


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class EvenRows:
    """Rows that are even: the `step` [s] of one, and whether longer steps count as several."""

    step: float
    counts: bool

    @property
    def words(self) -> str:
        """Return what was done."""
        return (
            f'rows follow each other evenly, {1.0 / self.step:.4g} in a second, and their stamps '
            'do not: for the slope of a position they are taken at even distances'
        )

    def times(self, stamps: Array) -> Array:
        """Return the times of rows by their stamps [s], in stretches without a gap."""
        cuts = np.flatnonzero(np.abs(np.diff(stamps)) > LONG * self.step) + 1
        return np.concatenate([self._line(part) for part in np.split(stamps, cuts)])

    def blocks(self, blocks: Iterable[Block]) -> Iterator[Block]:
        """Yield blocks with even times; the last rows of a block wait for the next."""
        stamps = np.zeros(0)
        held: Block | None = None
        for block in blocks:
            row, times, columns = block if held is None else behind(held, block)
            ready = max(len(times) - KEPT, 0) // STRETCH * STRETCH
            if ready:
                even = self.times(np.append(stamps, times))[slice(len(stamps), None)]
                yield row, even[:ready], {name: one[:ready] for name, one in columns.items()}
                stamps = np.append(stamps, times[:ready])[-KEPT:]
            held = rest((row, times, columns), ready)
        if held is not None and len(held[1]):
            even = self.times(np.append(stamps, held[1]))
            yield held[0], even[slice(len(stamps), None)], held[2]

    def places(self, stamps: Array) -> Array:
        """Return which row each is [-], those that miss counted, by stamps without a gap [s]."""
        steps = np.diff(stamps)
        passed = (
            np.maximum(np.round(steps / self.step), 1.0) if self.counts else np.ones(len(steps))
        )
        return np.append(0.0, np.cumsum(passed))

    def _line(self, stamps: Array) -> Array:
        """Return times [s] on a line through the means of stretches of stamps."""
        begin, places = stamps[0], self.places(stamps)
        ends = np.linspace(0, len(stamps), max(len(stamps) // STRETCH, 1) + 1).astype(int)
        counts = np.diff(ends)
        times = np.add.reduceat(stamps - begin, ends[:-1]) / counts
        middles = np.add.reduceat(places, ends[:-1]) / counts
        if len(times) > 1:
            slopes = np.diff(times) / np.diff(middles)
        else:
            slopes = np.array([self._slope(places, stamps - begin)])
        at = np.clip(np.searchsorted(middles, places) - 1, 0, len(slopes) - 1)
        return np.asarray(begin + times[at] + slopes[at] * (places - middles[at]))

    def _slope(self, places: Array, times: Array) -> float:
        """Return the step [s] of a few rows, the usual one if they are very few."""
        if len(places) < SHORT:
            return self.step
        places = places - places.mean()
        return float(places @ times) / float(places @ places)


def behind(held: Block, block: Block) -> Block:
    """Return a block behind the rows that wait for it."""
    columns = {name: np.append(held[2][name], one) for name, one in block[2].items()}
    return held[0], np.append(held[1], block[1]), columns


def rest(block: Block, ready: int) -> Block:
    """Return the rows of a block that wait, behind so many that are ready."""
    row, times, columns = block
    return row + ready, times[ready:], {name: one[ready:] for name, one in columns.items()}


def even_rows(stamps: Array, places: Array) -> EvenRows | None:
    """
    Return the even rows at which positions [-] were sampled, None where the stamps [s] say it.

    Raises ValueError where the slope is even over neither of both, or rows are missing that stamps
    so coarse do not tell.

    """
    known = np.isfinite(stamps) & np.isfinite(places)
    stamps, places = stamps[known], places[known]
    steps, moved = np.diff(stamps), np.diff(places)
    amounts = np.abs(moved)
    if (steps > 0.0).sum() < FEWEST or not amounts.any():
        return None
    usual_way = float(np.quantile(amounts[amounts > 0.0], USUAL))
    moving = (amounts > BARELY * usual_way) & (amounts < LONG * LONG * usual_way)
    maybe = [_rows(steps, counts=counts) for counts in (True, False)]
    passed = [np.diff(rows.places(stamps)) for rows in maybe]
    off = [np.abs(steps / rows.step - each) for rows, each in zip(maybe, passed, strict=True)]
    moving &= np.abs(steps) <= LONG * max(rows.step for rows in maybe)
    uneven = moving & (np.maximum(*off) > EVEN)
    if not uneven.any():
        return None
    pairs = moving[1:] & moving[:-1] & (uneven[1:] | uneven[:-1])
    spans = [each * rows.step for rows, each in zip(maybe, passed, strict=True)]
    spans.append(np.maximum(steps, TINY * maybe[1].step))
    changes = [np.abs(np.diff(moved / span))[pairs] for span in spans]
    jump = usual_way / maybe[1].step  # as which a larger one counts
    *by_rows, by_stamps = (float(np.minimum(each, jump).sum()) for each in changes)
    if float((off[0][moving] > COUNTING).mean()) > FEW:
        by_rows[0] = math.inf
    best = int(np.argmin(by_rows))
    if not _are_even(off[best][moving], by_rows[best], by_stamps):
        return None
    beside, long = np.maximum(amounts[:-2], amounts[2:]), steps / maybe[best].step > MISSING
    far = (amounts[1:-1] > MISSING * beside) & long[1:-1]
    if not maybe[best].counts and (far & moving[:-2] & moving[1:-1] & moving[2:]).any():
        raise ValueError('rows are missing, and the stamps of the others are too coarse')
    return maybe[best]


def _rows(steps: Array, *, counts: bool) -> EvenRows:
    """Return the rows of which the steps [s] between stamps are, or several of these if long."""
    usual = float(np.median(steps[steps > 0.0]))
    for _ in range(3):
        within = steps[(steps >= 0.0) & (steps < LONG * usual)]
        passed = np.maximum(np.round(within / usual), 1.0) if counts else np.ones(len(within))
        usual = float(within.sum() / passed.sum())
    return EvenRows(step=usual, counts=counts)


def _are_even(off: Array, by_rows: float, by_stamps: float) -> bool:
    """
    Return True if slopes are less rough over even rows than over stamps, so many steps off [-].

    Raises ValueError where they are as rough over either.

    """
    if not (off > EVEN).any():
        return False
    if by_rows < BETTER * by_stamps:
        return True
    if by_stamps < BETTER * by_rows or float((off > UNEVEN).mean()) < OFTEN:
        return False
    part = float(np.median(off[off > UNEVEN]))
    raise ValueError(
        f'its rows come early and late, by {part:.0%} of a step, and its slope is even over '
        'neither their stamps nor even distances'
    )
