# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The gate of the times of a table: what no recording does, with the rows of the file."""

import math

from ballscrew_monitor.recordings.tables.estimates import Array, DAY
import numpy as np
from numpy.typing import NDArray

RowNumbers = NDArray[np.int64]
Moment = tuple[float, int]
"""A time [s] and its row in the file."""

RATE = 1e5  # [Hz] no table has more rows in a second
SHORTEST = 0.95 / RATE  # [s] between rows: a stored time since 1970 is only near the true one
LONGEST = 10 * 365.25 * DAY  # [s] that a recording may last
AGAIN = 10  # rows that rise, all earlier than one before them: more than a few that came late
INSTEAD = 'state time.rate_Hz instead of time.column in the map'


class TimeGate:
    """Times of the rows of a table, looked through in the order of the file."""

    def __init__(self) -> None:
        """Begin with no row."""
        self._least, self._most = (math.inf, 0), (-math.inf, 0)
        self._times, self._rows = np.zeros(0), np.zeros(0, np.int64)  # of the last row
        self._steps = self._equal = self._fast = 0
        self._first_equal: tuple[Moment, Moment] | None = None
        self._first_fast: tuple[Moment, Moment] | None = None
        self._again: tuple[Moment, Moment] | None = None
        self._streak = 0  # rows that rise up to the last one, all late
        self._fall: tuple[Moment, Moment] | None = None  # that the streak began with
        self._first_fall: tuple[Moment, Moment] | None = None
        self._rising, self._caught_up = 0, False

    def add(self, times: Array, rows: RowNumbers) -> None:
        """Take further times [s], all known, with their rows in the file."""
        if not len(times):
            return
        joined = np.concatenate([self._times, times]), np.concatenate([self._rows, rows])
        before = np.concatenate([[self._most[0]], times])[:-1]
        with np.errstate(over='ignore'):  # a time too large for a stamp is refused elsewhere
            self._add_steps(*joined)
        self._add_late(*joined, times < np.maximum.accumulate(before))
        for at in (int(times.argmin()), int(times.argmax())):
            moment = float(times[at]), int(rows[at])
            self._least = min(self._least, moment, key=lambda one: one[0])
            self._most = max(self._most, moment, key=lambda one: one[0])
        self._times, self._rows = times[-1:], rows[-1:]

    def _add_steps(self, times: Array, rows: RowNumbers) -> None:
        """Count the steps between rows, and those that are too short."""
        steps = np.abs(np.diff(times))
        equal, fast = steps == 0.0, (steps > 0.0) & (steps < SHORTEST)
        self._steps += len(steps)
        self._equal += int(equal.sum())
        self._fast += int(fast.sum())
        if self._first_equal is None and equal.any():
            self._first_equal = _pair(times, rows, int(equal.argmax()))
        if self._first_fast is None and fast.any():
            self._first_fast = _pair(times, rows, int(fast.argmax()))

    def _add_late(self, times: Array, rows: RowNumbers, late: NDArray[np.bool_]) -> None:
        """Follow rows that rise though they are late; `times` may begin with the row before."""
        carried = len(times) - len(late)
        rising = times[1:] >= times[:-1]
        self._rising += int(rising.sum())
        if not late.any():
            self._streak = 0
            self._caught_up |= self._first_fall is not None
            return
        rising = rising if carried else np.append(False, rising)
        follows = late & np.append(self._streak > 0, late[:-1]) & rising
        places = np.arange(len(late))
        begins = np.maximum.accumulate(np.where(late & ~follows, places, -self._streak))
        lengths = np.where(late, places - begins + 1, 0)
        for at in (int((lengths >= AGAIN).argmax()), len(late) - 1):
            if lengths[at] and begins[at] >= 0:
                self._fall = _pair(times, rows, int(begins[at]) + carried - 1)
            if self._again is None and lengths[at] >= AGAIN:
                self._again = self._fall
        self._streak = int(lengths[-1])
        first = 0
        if self._first_fall is None:
            first = int(late.argmax())
            self._first_fall = _pair(times, rows, first + carried - 1)
        self._caught_up |= self._first_fall is not None and not late[first:].all()

    def fault(self) -> tuple[str, str]:
        """Return what no recording does, and the key that decides; empty if all is well."""
        fault = self.fault_of_steps()
        return fault if any(fault) else self.fault_of_span()

    def fault_of_steps(self) -> tuple[str, str]:
        """Return a fault of the times as they follow each other, as `fault` does."""
        if 2 * self._equal > self._steps and self._first_equal:
            (time, row), (_, later) = self._first_equal
            return (
                f'most rows have the time of the row before, such as rows {row} and {later} with '
                f'{time:.12g} s',
                f'name a finer time, or {INSTEAD}',
            )
        never = not self._caught_up and 2 * self._rising > self._steps
        if again := self._again or (self._first_fall if never else None):
            (time, row), (earlier, later) = again
            return (
                f'time begins again in row {later}, with {earlier:.12g} s after {time:.12g} s in '
                f'row {row}',
                f'split the log there, or {INSTEAD}',
            )
        if 2 * (self._equal + self._fast) > self._steps and self._first_fast:
            (time, row), (other, later) = self._first_fast
            step = abs(other - time)
            return (
                f'rows {row} and {later} are {step:.3g} s apart, {1.0 / step:.3g} rows in a '
                f'second, allowed are {RATE:.0f}',
                f'correct time.unit or time.scale, or {INSTEAD}',
            )
        return '', ''

    def fault_of_span(self) -> tuple[str, str]:
        """Return the fault of a span that is too long, as `fault` does."""
        (least, row), (most, later) = self._least, self._most
        if most - least > LONGEST:
            return (
                f'times go from {least:.12g} s in row {row} to {most:.12g} s in row {later}, more '
                'than ten years',
                'correct time.unit in the map, or leave such rows out',
            )
        return '', ''


def _pair(times: Array, rows: RowNumbers, at: int) -> tuple[Moment, Moment]:
    """Return a row and the next one."""
    return (float(times[at]), int(rows[at])), (float(times[at + 1]), int(rows[at + 1]))
