# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The rows of a table in the order of their times, with stamps, in blocks."""

from collections.abc import Callable, Collection, Iterable, Iterator, Sequence
import dataclasses
import math
from typing import Any

from ballscrew_monitor.core.conversions import SECOND
from ballscrew_monitor.recordings.tables.amounts import leap_on
from ballscrew_monitor.recordings.tables.cells import Array
from ballscrew_monitor.recordings.tables.estimates import is_of_a_day, Midnights
from ballscrew_monitor.recordings.tables.even_rows import behind, Block, even_rows, EvenRows, rest
from ballscrew_monitor.recordings.tables.mapping import Column, TableMap
from ballscrew_monitor.recordings.tables.other_tables import (
    FEW_HOLES,
    other_table,
    rows_above,
    TAIL,
    TAKE_OUT,
)
from ballscrew_monitor.recordings.tables.quantities import DAY, SCALES, SINCE_1904
from ballscrew_monitor.recordings.tables.read import Table
from ballscrew_monitor.recordings.tables.sources import BLOCK
from ballscrew_monitor.recordings.tables.time_gate import (
    INSTEAD,
    OF_A_CLOCK,
    REGULAR,
    SHARED,
    TimeGate,
)
from ballscrew_monitor.recordings.words import counted, short, Shown
import numpy as np
from numpy.typing import NDArray
from surrogate.files import InputError

Stamps = NDArray[np.int64]

LATEST = (1 << 31) * SECOND  # [ns] a stamp holds no later time
WIDTH = 1e-4  # relative, of a bin
LARGEST = 1e19  # [ns] more than any stamp
HELD = 1.5  # times the usual time between rows, after which a value that holds is repeated
MOST_HELD = 1_000_000  # repeated rows in a gap: in a longer one nothing is known
SHOWING = 100_000  # of the first rows, which show whether a position has a slope
COUNTERS = (2**32, 2**31)  # units of time after which a whole number of 32 bits begins again
HUGE_GAP = 100  # times the usual time between rows
SILENT, MOSTLY = 10, 0.9  # samples in a row that miss, of a group with one in most rows
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


def in_step(streams: Sequence[Iterator[Rows]]) -> Iterator[list[Rows]]:
    """Yield the rows of several streams, each in order, in lists of those up to one stamp."""
    held = [next(stream, None) for stream in streams]
    ended = [one is None for one in held]
    while not all(ended):
        latest = [
            int(rows.stamps[-1])
            for rows, done in zip(held, ended, strict=True)
            if not done and rows is not None
        ]
        until, ready = min(latest), []
        for number, rows in enumerate(held):
            if rows is None:
                continue
            count = int(np.searchsorted(rows.stamps, until))
            ready.append((number, rows[:count]))
            held[number] = rows[count:]
            if not ended[number] and rows.stamps[-1] == until:
                more = next(streams[number], None)
                ended[number] = more is None
                held[number] = joined([rows[count:], *([] if more is None else [more])])
        if any(len(rows.stamps) for _, rows in ready):
            yield [rows for _, rows in ready]
    yield [rows for rows in held if rows is not None]


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class Group:
    """
    Columns that share their times: their names, and those of the time, that of a date after it.

    `hollow` is a column in whose empty cells the others have none either, of `holes` rows; then
    there is no sample of the group. `is_motion` says whether it holds a speed or position, `hold`
    whether its values stay until the next ones.

    """

    columns: tuple[str, ...]
    time_columns: tuple[str, ...]
    hollow: str = ''
    holes: int = 0
    is_motion: bool = True
    hold: bool = False


def groups_of(table: Table, mapping: TableMap) -> list[Group]:
    """Return the columns that are read in groups of one time and the same empty cells."""
    motion = {
        column.name
        for axis in mapping.axes
        for kind, column in axis.columns.items()
        if kind in ('speed', 'position')
    }
    by_key: dict[tuple[str, tuple[int, int], bool], list[str]] = {}
    main = mapping.time.name if mapping.time else ''
    for axis in mapping.axes:
        for column in axis.columns.values():
            holes = table.readings[column.name].holes
            key = (column.time or main, holes, bool(column.hold))
            by_key.setdefault(key, []).append(column.name)
    groups = [
        Group(
            columns=tuple(dict.fromkeys(names)),
            time_columns=tuple(filter(None, (time, mapping.date if time == main else ''))),
            hollow=names[0] if holes[0] else '',
            holes=holes[0],
            is_motion=bool(motion & set(names)),
            hold=hold,
        )
        for (time, holes, hold), names in by_key.items()
    ]
    return sorted(groups, key=lambda group: not group.is_motion)


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class Spread:
    """Rows that share each stamp, spread over the time to the next one: usual number and step."""

    usual: float
    step: float  # [s]

    @classmethod
    def of(cls, gate: TimeGate) -> 'Spread | None':
        """Return how rows are spread, None where they do not share stamps regularly."""
        usual, step = gate.usual_share()
        return cls(usual=usual, step=step) if usual > 1 else None

    @property
    def words(self) -> str:
        """Return what was done."""
        return (
            f'{self.usual:.4g} rows share each time, {self.step:.4g} s apart: they were spread, '
            f'{self.usual / self.step:.4g} rows in a second'
        )

    def blocks(self, blocks: Iterable[Block]) -> Iterator[Block]:
        """Yield blocks with their times spread; the rows of the last one wait for the next."""
        held: Block | None = None
        first = True
        for block in blocks:
            row, times, columns = block if held is None else behind(held, block)
            ready = int(np.flatnonzero(np.append(True, times != times[-1]))[-1])
            if ready:
                spread = self._spread(times[:ready], float(times[ready]), first=first)
                yield row, spread, {name: values[:ready] for name, values in columns.items()}
                first = not self._follows(times[ready] - times[ready - 1])
            held = rest((row, times, columns), ready)
        if held is not None:
            yield held[0], self._spread(held[1], math.inf, first=first), held[2]

    def _follows(self, step: Any) -> Any:
        """Return where a time follows the one before without a gap."""
        return (step > 0.0) & (step < 1.5 * self.step)

    def _spread(self, times: Array, following: float, *, first: bool) -> Array:
        """Return times spread between those that rows share, the next of which is `following`."""
        begins = np.flatnonzero(np.diff(times, prepend=math.nan) != 0.0)
        counts = np.diff(begins, append=len(times))
        steps = np.diff(times[begins], append=following)
        last = ~self._follows(steps)  # of a run, or before a gap: some of its rows are missing
        first_ones = np.append(first, last[:-1])
        steps = np.where(last, self.step, steps)
        places = np.arange(len(times)) - np.repeat(begins, counts)
        whole = np.maximum(counts, self.usual)
        cut = last | first_ones | (counts < REGULAR * self.usual)
        full = np.where(cut, whole, counts)
        late = np.where(first_ones, full - counts, 0.0)
        each = steps / full
        return np.asarray(times + np.repeat(each, counts) * (places + np.repeat(late, counts)))


class Times:
    """
    The times of the rows of one group of columns, looked through once.

    `count` rows have one. Rows out of order are sorted: as many wait in memory as are between the
    one that comes the latest and its place. A time that begins again is that of another run, and
    rows that share a stamp are spread over the time up to the next. `promised` are the rows that
    should have a sample: an empty cell is one that is missing only where many follow each other.

    """

    def __init__(self, table: Table, mapping: TableMap, group: Group, shown: Shown) -> None:
        """Look through the times; raises InputError when they give no stamps."""
        self.group, self._table, self._mapping = group, table, mapping
        time = table.readings[group.time_columns[0]] if mapping.time else None
        # A clock on the wall may be set back.
        wall = time is not None and time.is_time and not time.is_zoned
        wraps = OF_A_CLOCK if time and time.is_time else _wraps(mapping.time)
        self.gate, self._course = TimeGate(wall=wall, wraps=wraps), Course()
        silence = Silence()
        self._spread: Spread | None = None
        self._even: EvenRows | None = None
        self._tail = np.zeros(0)
        with shown(table.rows, 'times looked through') as show:
            names = group.time_columns or list(group.columns)[:1]
            for row, every, _, holes in self._timed(names):
                times = _samples(every, holes)
                known = np.isfinite(times)
                rows = row + np.flatnonzero(known)
                self.gate.add(times[known], rows)
                self._course.add(times[known])
                self._tail = np.append(self._tail, times)[-TAIL:]
                if group.holes:
                    silence.add(times, every, row)
                show((row + len(times) - table.first_row) / table.rows)
        self.gate.finish()
        self.count, self._shown = self.gate.count, shown
        if self.count < 2 and group.is_motion:
            raise InputError(
                f'log {table.path} holds {self.count} rows with a time, at least two are needed'
            )
        if self.count:
            self._check(*self.gate.limits)
        if mapping.time:
            self._check_gate()
        self._shifts = dict[int, float]()
        short = min(table.source.short.count, group.holes)
        self.promised = table.rows - group.holes + short + silence.samples(self.gate.step)

    def look_at_slope(self, name: str, counted: Callable[[Array], Array]) -> None:
        """
        Take rows as even if the slope of a position shows that they are, whose turns are counted.

        Raises InputError where their times are not known.

        """
        rows, parts = 0, []
        for _, times, columns in self._spread_out([*self.group.time_columns, name]):
            parts.append((times, columns[name]))
            rows += len(times)
            if rows > SHOWING:
                break
        times, places = (np.concatenate(each) for each in zip(*parts, strict=True))
        try:
            self._even = even_rows(times, counted(places))
        except ValueError as error:
            raise InputError(
                f'log {self._table.path}: {short(name)} has no slope that is a speed: {error}: '
                f'name a column of the speed, or {INSTEAD} where rows are even'
            ) from None

    def check_ways(self, name: str, counted: Callable[[Array], Array]) -> None:
        """Raise InputError if a position leaps on in motion, as where rows without times miss."""
        rows = 0
        for row, times, columns in self._spread_out([name]):
            places = counted(columns[name])
            if at := leap_on(places):
                raise InputError(
                    f'log {self._table.path}: {short(name)} goes on by '
                    f'{places[at] - places[at - 1]:.4g} in row {row + at}, far more than beside '
                    'it, as where rows are missing, and no time tells how many: split the log '
                    'there'
                )
            rows += len(times)
            if rows > SHOWING:
                break

    def place(
        self, offsets: Sequence[float], motion: 'Times', run_begins: Sequence[float]
    ) -> None:
        """
        Place the runs by their offsets [s], which are those of the runs of a `motion`.

        All but the first then begin at times [s], before which there is a pause.

        Few slow samples do not show where runs begin: these follow the motion. Slow samples with
        more runs than a motion that has one stay as they are.

        Then the steps between rows are known, and how late the latest row comes.

        """
        runs, clocks = len(self.gate.runs), len(motion.gate.clocks)
        has_time_of = self.group.time_columns == motion.group.time_columns
        is_told = len(self.gate.clocks) == clocks or not has_time_of
        if len(offsets) == runs and is_told:
            self._shifts = self.gate.shifts(offsets)
        elif len(offsets) > runs or not is_told:
            self._shifts, self.gate.late = motion.gate.shifts(offsets), 0
            self.gate.runs, self.gate.clocks = self.gate.runs[:1], []
        else:
            self.gate.runs = self.gate.runs[:1]
        self._run_begins = np.array(run_begins)
        if self._shifts or self._spread or self._even or self.group.hold:  # else they stay
            self._course, self.count = Course(run_begins), 0
            columns = self.group.time_columns or list(self.group.columns)[:1]
            for _, times, _ in self._placed(columns):
                self._course.add(times)
                self.count += len(times)
        self._late, self._steps = self._course.late, self._course.steps
        self._begin = self.first = self._course.begin
        self.last = self._course.end

    def since(self, begin: float) -> None:
        """Let stamps count from the first time of the log [s]; raises InputError for others."""
        self._begin = begin
        self._check(begin, self.last)
        if self._late:
            self._steps = Steps()
            with self._shown(self._table.rows, 'rows put in order') as show:
                for rows in self.rows(show):
                    runs = np.searchsorted(self._stamps(self._run_begins), rows.stamps, 'right')
                    self._steps.add((rows.stamps - self.begin).astype(np.float64), runs)

    @property
    def begin(self) -> int:
        """Return the stamp of the first row of the log [ns]."""
        return self.stamps([self._begin])[0]

    @property
    def end(self) -> int:
        """Return the stamp of the last row [ns]."""
        return self.stamps([self.last])[0]

    def stamps(self, times: Sequence[float]) -> list[int]:
        """Return times [s] as stamps [ns]."""
        return [int(stamp) for stamp in self._stamps(np.array(times))]

    @property
    def usual_period(self) -> float:
        """Return the time between rows [s] that half of them keep."""
        return self._steps.median / SECOND

    @property
    def mean_period(self) -> float:
        """Return the time between rows [s] without gaps, whose stamps may be rounded."""
        return self._steps.mean / SECOND

    def notes(self) -> list[str]:
        """Return what is odd about the times, a sentence each."""
        sentences, log = [], f'log {self._table.path}:'
        if self._is_from_1904:
            sentences.append(f'{log} its workbook counts days from 1904, by which they are read')
        if left_out := self._table.rows - self.gate.count - self.group.holes:
            sentences.append(f'{log} {left_out} rows without a time are left out')
        if self.gate.late:
            sentences.append(
                f'{log} {self.gate.late} rows are earlier than the row before, they were sorted'
            )
        sentences += [f'{log} {self._spread.words}'] if self._spread else []
        sentences += [f'{log} {self._even.words}'] if self._even else []
        sentences += [f'{log} {one}' for one in self.gate.words()]
        if self._is_of_a_day and (days := int(self.gate.limits[1] // DAY)):
            midnights = counted(days, 'midnight')
            sentences.append(f'{log} its times of day have no date and go on through {midnights}')
        if self.count < 2:
            return sentences
        if gaps := self._steps.gaps():
            which = 'gap is' if gaps == 1 else 'gaps are'
            sentences.append(
                f'{log} {gaps} {which} longer than {HUGE_GAP} rows, the longest is '
                f'{self._steps.longest / SECOND:.4g} s, after row '
                f'{self._steps.longest_row + self._table.first_row - 1}; nothing is judged in them'
            )
        return sentences

    def rows(self, show: Callable[[float], None] = lambda share: None) -> Iterator[Rows]:
        """Yield the rows that have a time in the order of it, in blocks; show how far it is."""
        if not self._late:
            return self._as_written(show)
        coarse = float(np.spacing(max(abs(self.first), abs(self.last))))
        return _in_order(self._as_written(show), math.ceil((self._late + 4 * coarse) * SECOND))

    def _as_written(self, show: Callable[[float], None]) -> Iterator[Rows]:
        names = list(dict.fromkeys([*self.group.time_columns, *self.group.columns]))
        for row, times, columns in self._placed(names):
            show((row + len(times) - self._table.first_row) / self._table.rows)
            yield Rows(stamps=self._stamps(times), columns=columns)

    def _placed(self, names: Collection[str]) -> Iterator[Block]:
        """Yield blocks as `_sampled` does, with known times alone, in their runs and spread."""
        blocks = self._spread_out(names)
        blocks = self._even.blocks(blocks) if self._even else blocks
        yield from self._held(blocks) if self.group.hold else blocks

    def _spread_out(self, names: Collection[str]) -> Iterator[Block]:
        blocks = self._known(names)
        return self._spread.blocks(blocks) if self._spread else blocks

    def _held(self, blocks: Iterable[Block]) -> Iterator[Block]:
        """Yield blocks in which the rows before gaps within a run are repeated."""
        last = np.zeros(0), dict[str, Array]()
        usual = self.gate.step
        for row, times, columns in blocks:
            every = np.append(last[0], times)
            steps = np.diff(every)
            runs = np.searchsorted(self._run_begins, every, 'right')
            counts = np.where(steps > HELD * usual, np.ceil(steps / usual - 0.5) - 1, 0)
            counts = np.where((counts > MOST_HELD) | (np.diff(runs) > 0), 0, counts).astype(int)
            counts = np.append(counts, 0)
            each = np.arange(counts.sum()) - np.repeat(np.cumsum(counts) - counts, counts) + 1
            at = np.append(np.arange(len(every)), np.repeat(np.arange(len(every)), counts))
            late = np.append(np.zeros(len(every)), each * usual)
            known = len(last[0])
            order = np.argsort(every[at] + late, kind='stable')[known:]
            values = {
                name: np.append(last[1].get(name, np.zeros(0)), column)[at][order]
                for name, column in columns.items()
            }
            yield row, (every[at] + late)[order], values
            last = times[-1:], {name: column[-1:] for name, column in columns.items()}

    def _known(self, names: Collection[str]) -> Iterator[Block]:
        starts = np.array(sorted(self._shifts), dtype=np.int64)
        shifts = np.array([0.0, *(self._shifts[one] for one in starts.tolist())])
        for row, times, columns in self._sampled(names):
            known = np.isfinite(times)
            if len(starts):
                rows = row + np.arange(len(times))
                times = times + shifts[np.searchsorted(starts, rows, 'right')]
            if not known.all():
                times = times[known]
                columns = {name: values[known] for name, values in columns.items()}
            if len(times):
                yield row, times, columns

    @property
    def _is_of_a_day(self) -> bool:
        """Return True if times are of a day that no date tells apart, so that they go on."""
        if self._mapping.time is None or self._mapping.date:
            return False
        reading = self._table.readings[self.group.time_columns[0]]
        return reading.is_time and is_of_a_day(reading.extremes)

    def _sampled(self, names: Collection[str]) -> Iterator[Block]:
        """Yield the row in the file of the first of a block, its times [s], and its columns."""
        for row, times, block, holes in self._timed(names):
            yield row, _samples(times, holes), block

    def _timed(
        self, names: Collection[str]
    ) -> Iterator[tuple[int, Array, dict[str, Array], NDArray[np.bool_] | None]]:
        """Yield blocks as `_sampled` does, with all times, and which rows have no sample."""
        row, midnights = 0, Midnights() if self._is_of_a_day else None
        for block, holes in self._table.blocks_with_holes(names, self.group.hollow):
            times = self._times(block, row, midnights)
            yield row + self._table.first_row, times, block, holes
            row += len(times)

    @property
    def _is_from_1904(self) -> bool:
        time = self._mapping.time
        is_day = time is not None and time.unit == 'spreadsheet_days'
        return is_day and self._table.source.from_1904

    def _check_gate(self) -> None:
        """Raise InputError if times are such as no recording has; a slow signal refuses none."""
        if self.gate.shared > SHARED:
            self._spread = Spread.of(self.gate)
        fault = self.gate.fault() if self.group.is_motion else self.gate.fault_of_span()
        where = f'log {self._table.path}: column {short(repr(self.group.time_columns[0]))}'
        if any(fault):
            raise InputError(f'{where}: {fault[0]}: {fault[1]}')
        few = self.group.holes <= FEW_HOLES * self._table.rows
        if self.group.is_motion and few and not self.group.hold:
            row = self._table.first_row + self._table.rows - len(self._tail)
            other = rows_above(self.gate.runs, self.gate.step)
            if other := other or other_table(self._tail, row, self.gate.step):
                raise InputError(f'{where}: {other}: {TAKE_OUT}')

    def _times(self, columns: dict[str, Array], row: int, midnights: Midnights | None) -> Array:
        """Return the times of rows from `row` on [s], as the log counts them."""
        time = self._mapping.time
        if time is None:
            count = len(next(iter(columns.values())))
            return np.arange(row, row + count) / self._mapping.rate
        days = columns[self._mapping.date] if self._mapping.date else 0.0
        cells = columns[self.group.time_columns[0]]
        factor, shift = SCALES[time.unit]
        shift += DAY * SINCE_1904 if self._is_from_1904 else 0.0
        times = cells if midnights is None else midnights.passed(cells)
        return days + line(times, time, factor) + shift

    def _stamps(self, times: Array) -> Stamps:
        """Return times [s] as stamps, from the first on, or from 1970 where the log tells it."""
        begin = 0.0 if self._mapping.epoch is None else self._begin
        nanoseconds = np.asarray(np.round((times - begin) * SECOND))
        return nanoseconds.astype(np.int64) + (self._mapping.epoch or 0)

    def _check(self, begin: float, end: float) -> None:
        """Raise InputError unless the first and the last time [s] give stamps."""
        shift = self._mapping.epoch
        first, last = (begin, end) if shift is None else (0.0, end - begin)
        if last * SECOND + (shift or 0) >= LATEST or first * SECOND + (shift or 0) <= 0:
            raise InputError(
                f'log {self._table.path}: its times are {begin:g} to {end:g} s, which give no '
                'stamps after 1970 and before 2038: correct time.unit, or state a time.epoch'
            )


def _samples(times: Array, holes: NDArray[np.bool_] | None) -> Array:
    """Return times [s], NaN where there is no sample."""
    return times if holes is None else np.where(holes, math.nan, times)


class Silence:
    """
    Where a group has no sample for long while the rows of the log go on, also at its ends.

    Few rows are long for a group that has a sample in most of them.

    """

    def __init__(self) -> None:
        """Begin with no sample."""
        self._counts = np.zeros(HUGE_GAP + 1, np.int64)  # of the rows from sample to sample
        self._long: list[tuple[int, float]] = []
        self._rows, self._held = np.zeros((2, 0)), np.zeros((2, 0))
        """Times [s] and rows in the file of the first and last of all, and of those of samples."""

    def add(self, times: Array, every: Array, row: int) -> None:
        """Take rows from `row` on, the times of samples [s] and of all, NaN where none is."""
        samples, rows = (
            np.array([one[known], row + known])
            for one, known in ((one, np.flatnonzero(np.isfinite(one))) for one in (times, every))
        )
        rest, steps = np.diff(np.append(self._held[:, -1:], samples, axis=1))
        counted = np.minimum(steps, HUGE_GAP).astype(np.int64)
        self._counts += np.bincount(counted, minlength=HUGE_GAP + 1)
        long = steps > self._least
        self._long += zip(steps[long].tolist(), rest[long].tolist(), strict=True)
        self._rows, self._held = (
            np.append(before, one, axis=1)[:, [0, -1]] if one.size else before
            for before, one in ((self._rows, rows), (self._held, samples))
        )

    @property
    def _least(self) -> int:
        """Return how many samples are missing at least."""
        return SILENT if self._counts[1] >= MOSTLY * self._counts.sum() else HUGE_GAP

    def samples(self, step: float) -> int:
        """Return how many samples are missing, of which one usually comes after a `step` [s]."""
        half = max(int(np.searchsorted(np.cumsum(self._counts), self._counts.sum() / 2)), 1)
        silent = [(rows - half, rest - step) for rows, rest in self._long]
        if self._held.size:
            ends = (self._held - self._rows) * (1, -1)
            silent += zip(ends[1].tolist(), ends[0].tolist(), strict=True)
        missing = (round(min(rows / half, rest / step)) for rows, rest in silent if step > 0.0)
        return sum(one for one in missing if one >= self._least)


class Course:
    """Times [s] in the order of their rows: extent, steps between rows, and the latest row."""

    def __init__(self, run_begins: Sequence[float] = ()) -> None:
        """Begin with no row; steps to the begins of further runs [s] are pauses."""
        self.begin, self.end = math.inf, -math.inf
        self.late = 0.0  # by which a row comes after a later one
        self._run_begins = np.array(run_begins)
        self.steps = Steps()

    def add(self, times: Array) -> None:
        """Take further times."""
        if not len(times):
            return
        latest = np.maximum.accumulate(np.maximum(times, self.end))
        self.begin = min(self.begin, float(times.min()))
        with np.errstate(over='ignore'):  # what gives no stamp is refused afterwards
            self.late = max(self.late, float((latest - times).max()))
            self.end = float(latest[-1])
            stamps = np.clip((times - self.begin) * SECOND, -LARGEST, LARGEST)
            self.steps.add(stamps, np.searchsorted(self._run_begins, times, 'right'))


def _wraps(time: Column | None) -> list[float]:
    """Return after which times [s] the numbers of a time may begin again and go on."""
    if time is None:
        return []
    unit = abs(time.scale) * SCALES[time.unit][0]
    return [DAY, *(unit * count for count in COUNTERS)]


def line(values: Array, column: Column, factor: float) -> Array:
    """Return a column by its scale and offset, times a factor to SI."""
    return (values * column.scale + column.offset) * factor


class Steps:
    """Times between rows, told block by block; a median is right but for the width of a bin."""

    def __init__(self) -> None:
        """Begin with no row."""
        self._counts = np.zeros(_BINS, np.int64)
        self._sums = np.zeros(_BINS)
        self._last, self._last_run = np.zeros(0), np.zeros(0, np.int64)
        self._rows = 0
        self.longest, self.longest_row = 0.0, 0  # [ns], of the row before it

    def add(self, stamps: Array, runs: NDArray[np.int64] | None = None) -> None:
        """Count the steps to and between the next rows of a run [-], of stamps [ns]."""
        steps = np.diff(np.concatenate([self._last, stamps]))
        if runs is not None:
            steps[np.diff(np.concatenate([self._last_run, runs])) != 0] = -1.0
            self._last_run = runs[-1:]
        within = steps[steps >= 0.0]
        if len(within):
            bins = _bins(within)
            np.add.at(self._counts, bins, 1)
            np.add.at(self._sums, bins, within)
            at = int(steps.argmax())
            if steps[at] > self.longest:
                self.longest = float(steps[at])
                self.longest_row = max(self._rows, 1) + at
        self._rows += len(stamps)
        self._last = stamps[-1:]

    @property
    def median(self) -> float:
        """Return the time between rows [ns] that half of them keep, 0 without two of a run."""
        total = int(self._counts.sum())
        if not total:
            return 0.0
        middle = np.searchsorted(
            np.cumsum(self._counts), [(total - 1) // 2, total // 2], side='right'
        )
        return float(np.mean(self._sums[middle] / self._counts[middle]))

    @property
    def mean(self) -> float:
        """Return the mean time between rows [ns] without those above three of the usual one."""
        within = (self._counts > 0) & (self._sums <= 3.0 * self.median * self._counts)
        counts = int(self._counts[within].sum())
        return float(self._sums[within].sum()) / counts if counts else 0.0

    def gaps(self) -> int:
        """Return how many steps are huge beside the usual one."""
        means = self._sums / np.maximum(self._counts, 1)
        usual = self.median
        return int(self._counts[means > HUGE_GAP * usual].sum()) if usual > 0 else 0


def _bins(steps: Array) -> np.ndarray[tuple[int, ...], np.dtype[np.int64]]:
    """Return the bin of each step; the first is that of steps below 1 ns."""
    places = np.log(np.clip(steps, 1.0, LARGEST)) / math.log1p(WIDTH)
    return np.where(steps < 1.0, 0, 1 + places).astype(np.int64)
