# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The rows of a table in the order of their times, with stamps, in blocks."""

from collections.abc import Callable, Collection, Iterable, Iterator, Sequence
import dataclasses
import math

from ballscrew_monitor.core.conversions import SECOND, TIME_UNITS
from ballscrew_monitor.recordings.tables.cells import Array
from ballscrew_monitor.recordings.tables.estimates import is_of_a_day, Midnights
from ballscrew_monitor.recordings.tables.mapping import Column, TableMap
from ballscrew_monitor.recordings.tables.read import Table
from ballscrew_monitor.recordings.tables.sources import BLOCK
from ballscrew_monitor.recordings.tables.time_gate import TimeGate
from ballscrew_monitor.recordings.words import short, Shown, shown_progress
import numpy as np
from numpy.typing import NDArray
from surrogate.files import InputError

Stamps = NDArray[np.int64]

LATEST = (1 << 31) * SECOND  # [ns] a stamp holds no later time
WIDTH = 1e-4  # relative, of a bin
LARGEST = 1e19  # [ns] more than any stamp
HUGE_GAP = 100  # times the usual time between rows
_BINS = 2 + math.ceil(math.log(LARGEST) / math.log1p(WIDTH))


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class Rows:
    """Rows that follow each other: their stamps [ns], and the columns of the log by name."""

    stamps: Stamps
    columns: dict[str, Array]

    def __getitem__(self, part: slice | NDArray[np.intp]) -> 'Rows':
        """Return some of the rows."""
        columns = {name: values[part] for name, values in self.columns.items()}
        return Rows(stamps=self.stamps[part], columns=columns)


def joined(parts: Sequence[Rows]) -> Rows:
    """Return all rows of `parts`, one part after the other."""
    columns = {
        name: np.concatenate([part.columns[name] for part in parts]) for name in parts[0].columns
    }
    return Rows(stamps=np.concatenate([part.stamps for part in parts]), columns=columns)


def _sorted(parts: Sequence[Rows]) -> Rows:
    """Return all rows of `parts` by their stamps; those of equal stamp stay as they came."""
    rows = joined(parts)
    return rows[np.argsort(rows.stamps, kind='stable')]


def _in_order(blocks: Iterable[Rows], late: int) -> Iterator[Rows]:
    """Yield rows by their stamps, of which none comes more than `late` [ns] after a later one."""
    held: list[Rows] = []  # each in order, as they came
    latest = 0  # [ns]
    for rows in blocks:
        held.append(_sorted([rows]))
        latest = max(latest, int(held[-1].stamps[-1]))
        ready, held = _parted(held, latest - late)
        yield from _cut(_sorted(ready)) if ready else ()
    yield from _cut(_sorted(held)) if held else ()


def _parted(blocks: Iterable[Rows], stamp: int) -> tuple[list[Rows], list[Rows]]:
    """Return the rows of blocks before a stamp [ns], and the others."""
    before, others = [], []
    for rows in blocks:
        ready = int(np.searchsorted(rows.stamps, stamp)) if rows.stamps[0] < stamp else 0
        before += [rows[:ready]] if ready else []
        others += [rows[ready:]] if ready < len(rows.stamps) else []
    return before, others


def _cut(rows: Rows) -> Iterator[Rows]:
    for begin in range(0, len(rows.stamps), BLOCK):
        end = begin + BLOCK
        yield rows[begin:end]


class Times:
    """
    The times of a table, looked through once: which rows have one, and whether they rise.

    `count` rows have one. Rows out of order are sorted: as many wait in memory as are between the
    one that comes the latest and its place.

    """

    def __init__(self, table: Table, mapping: TableMap, shown: Shown = shown_progress) -> None:
        """Look through the times; raises InputError when they give no stamps."""
        self._table, self._mapping = table, mapping
        self.count = self._back = 0
        self._begin, self._end, self._late = math.inf, -math.inf, 0.0
        self._last = np.zeros(0)
        self._steps = Steps()
        gate = self._look(shown)
        if self.count < 2:
            raise InputError(
                f'log {table.path} holds {self.count} rows with a time, at least two are needed'
            )
        self._check()
        if time := mapping.time:
            self._check_gate(gate, time.name)
        if self._back:
            self._steps = Steps()
            with shown(table.rows, 'rows put in order') as show:
                for rows in self.rows(show):
                    self._steps.add((rows.stamps - self.begin).astype(np.float64))

    @property
    def begin(self) -> int:
        """Return the stamp of the first row [ns]."""
        return int(self._stamps(np.array([self._begin]))[0])

    @property
    def end(self) -> int:
        """Return the stamp of the last row [ns]."""
        return int(self._stamps(np.array([self._end]))[0])

    @property
    def usual_period(self) -> float:
        """Return the time between rows [s] that half of them keep."""
        return self._steps.median / SECOND

    def notes(self) -> list[str]:
        """Return what is odd about the times, a sentence each."""
        found, log = [], f'log {self._table.path}:'
        if left_out := self._table.rows - self.count:
            found.append(f'{log} {left_out} rows without a time are left out')
        if self._back:
            found.append(
                f'{log} {self._back} rows are earlier than the row before, they were sorted'
            )
        if gaps := self._steps.gaps():
            which = 'gap is' if gaps == 1 else 'gaps are'
            found.append(
                f'{log} {gaps} {which} longer than {HUGE_GAP} rows, the longest is '
                f'{self._steps.longest / SECOND:.4g} s, after row '
                f'{self._steps.longest_row + self._table.first_row - 1}; nothing is judged in them'
            )
        return found

    def rows(self, show: Callable[[float], None] = lambda share: None) -> Iterator[Rows]:
        """Yield the rows that have a time in the order of it, in blocks; show how far it is."""
        if not self._back:
            return self._as_written(show)
        coarse = float(np.spacing(max(abs(self._begin), abs(self._end))))
        return _in_order(self._as_written(show), math.ceil((self._late + 4 * coarse) * SECOND))

    def _as_written(self, show: Callable[[float], None]) -> Iterator[Rows]:
        row, midnights = 0, self._midnights()
        for columns in self._table.blocks():
            times = self._times(columns, row, midnights)
            row += len(times)
            show(row / self._table.rows)
            known = np.isfinite(times)
            if not known.all():
                times = times[known]
                columns = {name: values[known] for name, values in columns.items()}
            if len(times):
                yield Rows(stamps=self._stamps(times), columns=columns)

    def _look(self, shown: Shown) -> TimeGate:
        """Look through the times of all rows."""
        names, gate = self._mapping.time_columns, TimeGate()
        with shown(self._table.rows, 'times looked through') as show:
            for row, times, _ in self._told(names or list(self._table.readings)[:1]):
                known = np.isfinite(times)
                self._count(times[known])
                gate.add(times[known], row + np.flatnonzero(known))
                show((row + len(times) - self._table.first_row) / self._table.rows)
        return gate

    def _told(self, names: Collection[str]) -> Iterator[tuple[int, Array, dict[str, Array]]]:
        """Yield the row in the file of the first of a block, its times [s], and its columns."""
        row, midnights = 0, self._midnights()
        for block in self._table.blocks(names):
            times = self._times(block, row, midnights)
            yield row + self._table.first_row, times, block
            row += len(times)

    def _check_gate(self, gate: TimeGate, name: str) -> None:
        """
        Raise InputError if times are such as no recording has.

        The span is that of all rows. What the times of the rows do one by one is refused only of
        those of the motion.

        """
        if not any(gate.fault()):
            return
        motion = [
            (axis.columns.get('speed') or axis.columns['position']).name
            for axis in self._mapping.axes
        ]
        of_motion = TimeGate()  # a slower signal may have rows of its own
        for row, times, block in self._told([*self._mapping.time_columns, *motion]):
            moves = np.any([np.isfinite(block[name]) for name in motion], axis=0)
            known = np.isfinite(times) & moves
            of_motion.add(times[known], row + np.flatnonzero(known))
        steps, span = of_motion.fault_of_steps(), gate.fault_of_span()
        fault, mend = steps if any(steps) else span
        if fault:
            where = f'log {self._table.path}: column {short(repr(name))}'
            raise InputError(f'{where}: {fault}: {mend}')

    def _count(self, times: Array) -> None:
        """Count further times, all known."""
        if not len(times):
            return
        before = np.concatenate([self._last, times])
        latest = np.maximum.accumulate(np.maximum(times, self._end))
        with np.errstate(over='ignore'):  # what gives no stamp is refused afterwards
            self._back += int((np.diff(before) < 0.0).sum())
            self._begin = min(self._begin, float(times.min()))
            self._late = max(self._late, float((latest - times).max()))
            self._end = float(latest[-1])
            self._steps.add(np.clip(self._nanoseconds(times), -LARGEST, LARGEST))
        self.count += len(times)
        self._last = times[-1:]

    def _midnights(self) -> Midnights | None:
        """Return what makes times of a day go on, None where the log has others, or dates."""
        time = self._mapping.time
        if time is None or self._mapping.date:
            return None
        reading = self._table.readings[time.name]
        return Midnights() if reading.is_time and is_of_a_day(reading.extremes) else None

    def _times(self, columns: dict[str, Array], row: int, midnights: Midnights | None) -> Array:
        """Return the times of rows from `row` on [s], as the log counts them."""
        time = self._mapping.time
        if time is None:
            count = len(next(iter(columns.values())))
            return np.arange(row, row + count) / self._mapping.rate
        days = columns[self._mapping.date] if self._mapping.date else 0.0
        told = columns[time.name] if midnights is None else midnights.passed(columns[time.name])
        return days + line(told, time, TIME_UNITS[time.unit])

    def _nanoseconds(self, times: Array) -> Array:
        """Return times [ns] since the first of them, or since 1970 where the log tells it."""
        begin = 0.0 if self._mapping.epoch is None else self._begin
        return np.asarray(np.round((times - begin) * SECOND))

    def _stamps(self, times: Array) -> Stamps:
        return self._nanoseconds(times).astype(np.int64) + (self._mapping.epoch or 0)

    def _check(self) -> None:
        """Raise InputError unless the first and the last time give stamps."""
        shift = self._mapping.epoch
        first = self._begin if shift is None else 0.0
        last = self._end if shift is None else self._end - self._begin
        if last * SECOND + (shift or 0) >= LATEST or first * SECOND + (shift or 0) <= 0:
            raise InputError(
                f'log {self._table.path}: its times are {self._begin:g} to {self._end:g} s, which '
                'give no stamps after 1970 and before 2038: correct time.unit, or state a '
                'time.epoch'
            )


def line(values: Array, column: Column, factor: float) -> Array:
    """Return a column by its scale and offset, times a factor to SI."""
    return (values * column.scale + column.offset) * factor


class Steps:
    """Times between rows, told block by block; a median is right but for the width of a bin."""

    def __init__(self) -> None:
        """Begin with no row."""
        self._counts = np.zeros(_BINS, np.int64)
        self._sums = np.zeros(_BINS)
        self._last = np.zeros(0)
        self._rows = 0
        self.longest, self.longest_row = 0.0, 0  # [ns], of the row before it

    def add(self, stamps: Array) -> None:
        """Count the steps to and between the next rows, of stamps [ns]."""
        steps = np.diff(np.concatenate([self._last, stamps]))
        if len(steps):
            bins = _bins(steps)
            np.add.at(self._counts, bins, 1)
            np.add.at(self._sums, bins, steps)
            at = int(steps.argmax())
            if steps[at] > self.longest:
                self.longest = float(steps[at])
                self.longest_row = max(self._rows, 1) + at
        self._rows += len(stamps)
        self._last = stamps[-1:]

    @property
    def median(self) -> float:
        """Return the time between rows [ns] that half of them keep; needs two rows."""
        total = int(self._counts.sum())
        middle = np.searchsorted(
            np.cumsum(self._counts), [(total - 1) // 2, total // 2], side='right'
        )
        return float(np.mean(self._sums[middle] / self._counts[middle]))

    def gaps(self) -> int:
        """Return how many steps are huge beside the usual one."""
        means = self._sums / np.maximum(self._counts, 1)
        usual = self.median
        return int(self._counts[means > HUGE_GAP * usual].sum()) if usual > 0 else 0


def _bins(steps: Array) -> np.ndarray[tuple[int, ...], np.dtype[np.int64]]:
    """Return the bin of each step; the first is that of steps below 1 ns."""
    places = np.log(np.clip(steps, 1.0, LARGEST)) / math.log1p(WIDTH)
    return np.where(steps < 1.0, 0, 1 + places).astype(np.int64)
