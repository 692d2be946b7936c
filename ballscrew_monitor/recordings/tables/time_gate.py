# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
The gate of the times of a table: in which runs they rise, and what no recording does.

A row that is earlier than one before it came late if the time is back within a few rows. If it is
not, the time begins again there: another run was appended, or a clock was set back for winter. One
that is set on for summer leaves out the hour after a full one in the night to a Sunday.

"""

from collections import Counter
from collections.abc import Mapping, Sequence
import dataclasses
import datetime
import math

from ballscrew_monitor.recordings.tables.estimates import Array, DAY, RARE, SHORTEST
from ballscrew_monitor.recordings.words import counted
import numpy as np
from numpy.typing import NDArray

RowNumbers = NDArray[np.int64]
RATE = 1e5  # [Hz] no table has more rows in a second
LONGEST = 10 * 365.25 * DAY  # [s] that a recording may last
AGAIN = 10  # rows that rise, all earlier than one before them: more than a few that came late
WINDOW = 512  # rows that are looked at together where some come late
LATE = 0.1  # of the rows of a wall clock that may be earlier than one before them
SHARED = 0.05  # of the rows that may have the time of the row before
REGULAR = 0.8  # of the usual number of rows that share a time
UNEVEN = 0.1  # standard deviation of the rows that share a time over their mean
MOST = 0.9  # of the times that are shared by the usual number
HOUR = 3600.0  # [s]
HALF_DAY = 12 * HOUR  # after which a clock without AM and PM begins again
OF_A_CLOCK = (DAY, HALF_DAY)  # after which times of day may begin again [s]
LACKING = 100  # rows, at most, that may lack where a clock begins again
CLOSE = 10.0  # [s] by which the step of a clock may miss an hour
SUMMER = (3, 9, 10)  # months in which clocks are set on, in the north and in the south
SUNDAY = 6
NIGHT = 4  # o'clock, before which that is
FEWEST = 20  # rows of a run, on average, of more than a few
FEWEST_FALLS = 2  # more are no runs of a few rows
FEW_RISES = 0.01  # of the falls of a table with the newest row first, as at midnights
RUNS = 1000  # more runs than any logger appends
INSTEAD = 'state time.rate_Hz instead of time.column in the map'


@dataclasses.dataclass(kw_only=True, slots=True)
class Run:
    """Rows whose time rises: the first in the file, their number, the first and last time [s]."""

    row: int
    rows: int
    begin: float
    end: float
    shift: float = 0.0  # [s] of a clock that was set
    last: int = 0


class Occurrences:
    """Steps of a kind between rows: their number, and of the first its times [s] and its row."""

    def __init__(self) -> None:
        """Begin with none."""
        self.count = self.row = 0
        self.before = self.time = math.nan

    def add(self, holds: NDArray[np.bool_], steps: Array, times: Array, rows: RowNumbers) -> None:
        """Count those of further steps [s] that are of the kind, which lead to times and rows."""
        if holds.any() and not self.count:
            at = int(holds.argmax())
            self.time, self.row = float(times[at]), int(rows[at])
            self.before = self.time - float(steps[at])
        self.count += int(holds.sum())

    @property
    def words(self) -> str:
        """Return the first of them."""
        return f'row {self.row} has {self.time:.12g} s after {self.before:.12g} s'


class Shares:
    """Numbers of rows that share a time, of times between which none falls."""

    def __init__(self) -> None:
        """Begin with no row."""
        self.counts: Counter[int] = Counter()
        self._rows, self._whole = 0, False  # those that have the last time

    def add(self, equal: NDArray[np.bool_], falls: NDArray[np.bool_], rows: int) -> None:
        """Count further rows by which steps to them are equal, and which fall."""
        joined = rows - len(equal)  # 1 for the first row of all
        begins = np.append(np.zeros(joined, np.int64), np.flatnonzero(~equal) + joined)
        if not len(begins):
            self._rows += rows
            return
        cut = np.append(np.ones(joined, np.bool_), falls[~equal])  # of a run, maybe
        shares = np.diff(begins, append=rows)
        if self._whole and not cut[0]:
            self.counts[self._rows + int(begins[0])] += 1
        inner = shares[:-1][~cut[:-1] & ~cut[1:]]
        self.counts.update({round(one): n for one, n in _counts(inner)})
        self._rows, self._whole = int(shares[-1]), not cut[-1]


class TimeGate:
    """Times of the rows of a table, looked through in the order of the file."""

    def __init__(self, *, wall: bool = False, wraps: Sequence[float] = ()) -> None:
        """
        Begin with no row; a clock on the `wall` may be set back or on by an hour.

        It may begin again after one of `wraps` [s], if few rows lack there at most.

        """
        self._wall, self._wraps = wall, wraps
        self.runs: list[Run] = []
        self.clocks: list[tuple[int, float]] = []  # row from which a clock was set, by minus [s]
        self.count = self.late = 0
        self._equal, self._falls, self._shares = Occurrences(), Occurrences(), Shares()
        self._unordered = False
        self._within = 0  # runs that begin in the second in which the one before ends
        self._pending: list[tuple[float, int]] = []  # late rows at the end
        self._before = 0.0  # time of the row before them [s]
        self._latest_hour = 0.0  # [s] of a day
        self._half = 0  # row in which a clock of 12 hours begins again
        self._last = np.zeros(0)
        self._steps: Counter[float] = Counter()
        self._least, self._most = (math.inf, 0), (-math.inf, 0)

    def add(self, times: Array, rows: RowNumbers) -> None:
        """Take further times [s], all known, with their rows in the file."""
        if not len(times):
            return
        for at in (int(times.argmin()), int(times.argmax())):
            moment = float(times[at]), int(rows[at])
            self._least = min(self._least, moment, key=lambda one: one[0])
            self._most = max(self._most, moment, key=lambda one: one[0])
        if HALF_DAY in self._wraps:
            self._latest_hour = max(self._latest_hour, float(np.mod(times, DAY).max()))
        cuts = self._set_on(times)
        self._add_steps(times, rows)
        self.count += len(times)
        if not self._unordered and len(self.runs) <= RUNS:
            for number, cut in enumerate([0, *cuts]):
                part = slice(cut, [*cuts, len(times)][number])
                if number and not self._pending:
                    self.runs[-1].shift -= HOUR
                    self.clocks.append((int(rows[cut]), -HOUR))
                rise = cut < part.stop and self._goes_on(times[part])
                width = max(part.stop - cut, 1) if rise else WINDOW
                for begin in range(cut, part.stop, width):
                    piece = slice(begin, min(begin + width, part.stop))
                    self._follow(times[piece], rows[piece])

    def _set_on(self, times: Array) -> list[int]:
        """Return the places in a block before which a clock was set on by an hour."""
        if not self._wall:
            return []
        last = self._last if len(self._last) else times[:1]
        before = np.concatenate([last, times[:-1]])
        leaps = (times - before >= HOUR) & (times - before <= HOUR + CLOSE)
        return [at for at in np.flatnonzero(leaps).tolist() if _is_set_on(before[at], times[at])]

    def _add_steps(self, times: Array, rows: RowNumbers) -> None:
        """Count the steps between rows, and how many share each time."""
        with np.errstate(over='ignore', invalid='ignore'):
            steps = np.diff(times, prepend=self._last)
        equal, falls, rising = steps == 0.0, steps < 0.0, steps[steps > 0.0]
        later = slice(len(times) - len(steps), None)  # all but the first row of all
        self._equal.add(equal, steps, times[later], rows[later])
        self._falls.add(falls, steps, times[later], rows[later])
        self._shares.add(equal, falls, len(times))
        if len(self._steps) < 4 * WINDOW:
            rounded = np.array([float(f'{step:.3g}') for step in rising[:WINDOW]])
            self._steps.update(dict(_counts(rounded)))
        self._last = times[-1:]

    def _goes_on(self, times: Array) -> bool:
        """Return True if all times rise after those before them."""
        run = self.runs[-1] if self.runs and not self._pending else None
        rises = bool((times[1:] >= times[:-1]).all())
        return run is not None and rises and bool(times[0] + run.shift >= run.end)

    def _follow(self, times: Array, rows: RowNumbers) -> None:
        """Follow the runs through a few rows."""
        at = 0
        if not self.runs:
            self.runs.append(_run(times[0], rows[0]))
        while at < len(times):
            run = self.runs[-1]
            moved = times[at:] + run.shift
            if self._pending:
                at += self._follow_late(moved, rows[at:])
                continue
            late = moved < np.maximum.accumulate(np.append(run.end, moved))[:-1]
            ready = int(late.argmax()) if late.any() else len(late)
            if ready:
                run.end = max(run.end, float(moved[:ready].max()))
                run.rows, run.last = run.rows + ready, int(rows[at + ready - 1])
                self._before = float(moved[ready - 1])
            at += ready
            if at < len(times):
                self._pending.append((float(moved[ready]), int(rows[at])))
                at += 1

    def _follow_late(self, moved: Array, rows: RowNumbers) -> int:
        """Take rows after a late one; return how many."""
        run = self.runs[-1]
        up = moved >= run.end
        most = AGAIN - len(self._pending)
        taken = min(int(up.argmax()) if up.any() else len(up), most)
        self._pending += zip(moved[:taken].tolist(), rows[:taken].tolist(), strict=True)
        if len(self._pending) >= AGAIN:
            self._begin_again()
        elif taken < min(len(up), most):  # they were late
            self._settle()
        return taken

    def _settle(self) -> None:
        """Count the rows that wait as late ones of the last run."""
        self.late += len(self._pending)
        self.runs[-1].rows += len(self._pending)
        self._pending = []

    def _begin_again(self) -> None:
        """Let the rows that wait begin a run, or go on by a clock that was set back."""
        run, (first, row) = self.runs[-1], self._pending[0]
        steps = np.diff([time for time, _ in self._pending])
        self._unordered |= 2 * int((steps < 0.0).sum()) > len(steps)
        fall, step = self._before - first, self.step
        is_hour = self._wall and HOUR - CLOSE <= fall <= HOUR and abs(first - run.begin) > CLOSE
        missed = (
            wrap
            for wrap in self._wraps
            if 0.0 < wrap - fall < max(1.5 * step, min(LACKING * step, wrap / LACKING))
            and (wrap != HALF_DAY or self._latest_hour < HALF_DAY + HOUR)
        )
        if back := HOUR if is_hour else next(missed, 0.0):
            self._half = self._half or row * (back == HALF_DAY)
            run.shift += back
            self.clocks.append((row, back))
            run.rows += len(self._pending)
            run.end = max(run.end, max(time for time, _ in self._pending) + back)
        else:
            self._within += self._wall and math.floor(first) == math.floor(self._before)
            self.runs.append(_run(first - run.shift, row))
            self.runs[-1].rows = len(self._pending)
            self.runs[-1].end = max(time for time, _ in self._pending) - run.shift
        self.runs[-1].last = self._pending[-1][1]
        self._pending = []

    def finish(self) -> None:
        """Take the end of the file for that of the last run: few rows may be one, too."""
        if self._pending:
            times = np.array([time for time, _ in self._pending])
            again = times[0] <= self.runs[-1].begin and (np.diff(times) >= 0.0).all()
            self._unordered |= 2 * len(times) > self.count and not again
            if again and len(times) > 1:
                self._begin_again()
            else:
                self._settle()

    @property
    def falls(self) -> bool:
        """Return True if the newest row stands first: times fall, and next to none rises."""
        falls = self._falls.count
        rising = self.count - 1 - self._equal.count - falls
        return falls > FEWEST_FALLS and rising <= FEW_RISES * falls

    @property
    def limits(self) -> tuple[float, float]:
        """Return the least and the most time [s]."""
        return self._least[0], self._most[0]

    def shifts(self, offsets: Sequence[float]) -> dict[int, float]:
        """Return what is added to the times from some rows on [s], by the offset of each run."""
        by_row: dict[int, float] = {}
        for run, shift in zip(self.runs, offsets, strict=True):
            if shift:
                by_row[run.row] = shift
            for row, back in self.clocks:
                if run.row < row <= run.last:
                    by_row[row] = shift = shift + back
        return by_row

    def words(self) -> list[str]:
        """Return in a sentence each the runs, and where a clock was set back or on."""
        sentences = [
            f'the clock is set on by an hour in row {row}: times go on there without it'
            if back < 0.0
            else f'the clock is set back by an hour in row {row}: times go on there'
            if back == HOUR
            else f'the clock begins again after {back:.10g} s in row {row}: times go on there'
            for row, back in self.clocks
        ]
        if len(self.runs) > 1:
            listed = [
                f'rows {run.row} to {run.last} ({run.end - run.begin:.4g} s)' for run in self.runs
            ]
            shown = listed if len(listed) <= AGAIN else [*listed[:AGAIN], '...']
            sentences.append(
                f'time begins again {counted(len(self.runs) - 1, "time")}: {len(self.runs)} runs '
                f'are each judged apart, {", ".join(shown)}'
            )
        return sentences

    @property
    def shared(self) -> float:
        """Return the part of the rows that have the time of the row before [-], if not a few."""
        equal = self._equal.count
        return equal / (self.count - 1) if equal >= AGAIN else 0.0

    def usual_share(self) -> tuple[float, float]:
        """Return how many rows share each time and the step [s] to the next; 0 if irregular."""
        shares, step = self._shares.counts, self.step
        usual, times = _median(shares), sum(shares.values())
        near = {
            count: n
            for count, n in shares.items()
            if abs(count - usual) <= max(1.0, (1.0 - REGULAR) * usual)
        }
        even = {one: n for one, n in self._steps.items() if abs(one / step - 1.0) < 0.5}
        steps = sum(even.values())
        all_near = sum(near.values())
        if times < 2 or all_near < MOST * times or steps < MOST * sum(self._steps.values()):
            return 0, 0.0
        mean = sum(count * n for count, n in near.items()) / all_near
        variance = sum((count - mean) ** 2 * n for count, n in near.items()) / all_near
        if variance > (UNEVEN * mean) ** 2:  # such as stamps that were rounded
            return 0, 0.0
        return mean, sum(one * n for one, n in even.items()) / steps

    @property
    def step(self) -> float:
        """Return the usual step between times that differ [s], NaN where there is none."""
        return _median(self._steps)

    def fault(self) -> tuple[str, str]:
        """Return what no recording of a motion does, and the key that decides; else empty."""
        spread = self.shared > SHARED and self.usual_share()[0] > 1
        shared = self.fault_of_shared() if self.shared > SHARED and not spread else ('', '')
        faults = (self.fault_of_order(), shared, self.fault_of_rate(spread), self.fault_of_span())
        return next(filter(any, faults), ('', ''))

    def fault_of_order(self) -> tuple[str, str]:
        """Return the fault of times that do not rise, or begin again all the time."""
        fall = self._falls
        if self.falls:
            return (
                f'it falls from row to row, the newest row stands first: {fall.words}',
                'turn the order of the rows round',
            )
        if self._unordered or len(self.runs) > RUNS:
            return f'it does not rise: {fall.words}', INSTEAD
        if self._half and self._most[0] > DAY:  # midnight is no fall where dates go on
            return (
                f'it falls by 12 h in row {self._half}, as times of a clock of 12 hours do that '
                'lack AM and PM',
                f'write these, or hours of up to 23, or {INSTEAD}',
            )
        back = self._within + self.late * (self._wall and self.late > LATE * self.count)
        if back > 1:
            return (
                f'it goes back within a second {back} times, first in row '
                f'{fall.row}, as milliseconds do that are written without leading '
                'zeros',
                INSTEAD,
            )
        runs = len(self.runs)
        if runs > AGAIN and self.count < FEWEST * runs:
            return (
                f'it begins again {runs - 1} times, each {self.count / runs:.3g} rows, as a '
                f'counter does that overflows: first in row {self.runs[1].row}',
                INSTEAD,
            )
        return '', ''

    def fault_of_shared(self) -> tuple[str, str]:
        """Return the fault of times that rows share."""
        return (
            f'{self.shared:.0%} of the rows have the time of the row before, without a rule, such '
            f'as row {self._equal.row} with {self._equal.time:.12g} s',
            f'name a finer time, or {INSTEAD}',
        )

    def fault_of_rate(self, spread: bool = False) -> tuple[str, str]:
        """Return the fault of rows that follow each other too fast or too slowly."""
        if not self._steps:
            return '', ''
        step = self.step / (max(self.usual_share()[0], 1) if spread else 1)
        if not SHORTEST <= step <= 1.0 / RARE:
            return (
                f'its rows are {step:.3g} s apart, {1.0 / step:.3g} in a second, allowed are '
                f'{RARE:g} to {RATE:.0f}',
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


def run_offsets(gates: Sequence[TimeGate], gap: float) -> tuple[list[float], list[float]]:
    """
    Return the offset of each run [s], and the begins that these give all runs but the first.

    Runs lie a `gap` [s] apart, or a little more. The gates are those of columns that have the same
    runs, each with its own times. Offsets are whole seconds: in each run, ticks and states are due
    as if it were alone.

    """
    offsets, begins, end = [0.0], list[float](), -math.inf
    for number, parts in enumerate(zip(*(gate.runs for gate in gates), strict=True)):
        if number:
            begin = min(run.begin for run in parts)
            offsets.append(float(math.ceil(end + gap - begin)))
            begins.append(begin + offsets[-1])
        end = max(run.end for run in parts) + offsets[-1]
    return offsets, begins


def _is_set_on(before: float, after: float) -> bool:
    """Return True if dated times [s] of neighbours leave out the hour that a summer takes."""
    hour = before // HOUR * HOUR + HOUR  # that was to come
    if before < DAY * 365 or not 0.0 <= after - hour - HOUR <= CLOSE:
        return False
    left_out = datetime.datetime.fromtimestamp(hour, datetime.UTC)
    is_night = left_out.weekday() == SUNDAY and left_out.hour < NIGHT
    return is_night and left_out.month in SUMMER


def _run(time: float, row: int) -> Run:
    return Run(row=int(row), rows=0, begin=float(time), end=float(time), last=int(row))


def _median(counts: Mapping[float, int] | Mapping[int, int]) -> float:
    """Return the median of values, each as often as it is counted; NaN of none."""
    values = sorted(counts)
    sums = np.cumsum([counts[value] for value in values])  # type: ignore[index]
    return float(values[int(np.searchsorted(sums, sums[-1] / 2))]) if values else math.nan


def _counts(values: NDArray[np.generic]) -> list[tuple[float, int]]:
    different, counts = np.unique(values, return_counts=True)
    return list(zip(different.tolist(), counts.tolist(), strict=True))
