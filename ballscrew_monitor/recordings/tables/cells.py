# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Cells of a table as numbers: in which form they are, by all cells of a column, block by block.

Numbers, times and durations of Parquet are read by their type. Texts are numbers with a decimal
point, numbers with a decimal comma, or times of one of the forms of `clocks`.

"""

from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
import contextlib
import dataclasses
import math
from pathlib import Path
import re
from typing import Any
import zlib

from ballscrew_monitor.core.conversions import SECOND
from ballscrew_monitor.recordings.tables import signs
from ballscrew_monitor.recordings.tables.clocks import (
    either_date,
    moments_of,
    order_in_name,
    SAMPLE,
    time_forms,
    TimeForm,
)
from ballscrew_monitor.recordings.tables.quantities import DAY, ORDERS, OTHER_SIGN
from ballscrew_monitor.recordings.words import counted, short
import numpy as np
from numpy.typing import NDArray
import polars as pl
from polars.exceptions import PolarsError
from surrogate.files import InputError

Array = NDArray[np.float64]
Form = Callable[[pl.Series], pl.Series]
"""Makes cells numbers, null where one is not a number."""
Read = Callable[[list[str], Mapping[str, Any]], Iterator[pl.DataFrame]]
"""Reads some columns of a table part by part, those of a text by the types of plain numbers."""
FOLLOWS, LEAPS = 60.0, 27.0 * DAY
"""
Steps [s] of rows that follow each other through midnight, and of those in another order of dates.

The next day is one of the next month or year there, and at least that of the next but 27.

"""
ENDS = (KeyboardInterrupt, SystemExit, GeneratorExit)


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class Reading:
    """
    How the cells of a column are numbers, the least and the most of them, and what is not.

    Empty cells are no samples: `holes` are their number and a checksum of their rows. What else is
    no number is unknown, and the note counts it, as are the numbers that stand for `none`. Texts
    that are all plain numbers have a type, by which they are read at once, `plain`.

    """

    form: Form
    extremes: Array
    holes: tuple[int, int]
    note: str
    plain: Any = None
    none: Sequence[float] = ()

    @property
    def is_time(self) -> bool:
        """Return True if the cells are times by their form or type, hence [s]."""
        return self.form is _seconds or isinstance(self.form, TimeForm)

    @property
    def is_zoned(self) -> bool:
        """Return True if the zone of the times is written or that of the universal clock."""
        return not isinstance(self.form, TimeForm) or self.form.zoned

    def numbers(self, cells: pl.Series) -> Array:
        """Return cells as numbers, NaN where one is not a number."""
        return _finite(_plain if cells.dtype.is_numeric() else self.form, cells, self.none)


@dataclasses.dataclass(kw_only=True, slots=True)
class _Count:
    """What a form has made of the cells so far."""

    form: Form
    none: Sequence[float] = ()
    good: int = 0
    bad: int = 0
    first: str = ''  # of those that are no number, and its row
    least: float = math.inf
    most: float = -math.inf
    last: float = math.nan  # of the dates of an order, as their sum
    total: float = 0.0
    leap: float = 0.0  # the widest between two cells

    def add(self, cells: pl.Series, row: int) -> bool:
        """Count cells from `row` on; return True if all that is written is a number."""
        return self.take(_finite(self.form, cells, self.none), cells, row)

    def take(self, numbers: Array, cells: pl.Series, row: int) -> bool:
        """Count the numbers that the form makes of cells from `row` on, as `add` does."""
        bad = np.isnan(numbers)
        if not bad.any():
            self._good(numbers)
            return True
        self._good(numbers[~bad])
        bad &= ~empties(cells)
        self._miss(cells, bad, row)
        return not bad.any()

    def pass_over(self, cells: pl.Series, row: int, *, filled: bool = False) -> None:
        """Count cells from `row` on as no numbers, without a look at them; none is empty."""
        self._miss(cells, np.full(len(cells), True) if filled else ~empties(cells), row)

    def _good(self, numbers: Array) -> None:
        self.good += len(numbers)
        self.least = float(np.min(numbers, initial=self.least))
        self.most = float(np.max(numbers, initial=self.most))
        if self.order and len(numbers):
            steps = np.abs(np.diff(numbers, prepend=self.last))
            self.leap, self.last = float(np.nanmax(steps, initial=self.leap)), float(numbers[-1])
            self.total += float(np.sum(numbers))

    @property
    def order(self) -> str:
        """Return the order of the dates of a form, empty where there is no other one."""
        return self.form.order if isinstance(self.form, TimeForm) else ''

    def _miss(self, cells: pl.Series, bad: NDArray[np.bool_], row: int) -> None:
        missing = int(bad.sum())
        if missing and not self.bad:
            at = int(bad.argmax())
            self.first = f'{short(repr(cells[at]))} in row {row + at}'
        self.bad += missing


class Cells:
    """The cells of one column, looked through in the order of their rows."""

    def __init__(
        self,
        path: Path,
        name: str,
        *,
        first_row: int = 1,
        order: str = '',
        none: Sequence[float] = (),
    ) -> None:
        """
        Begin with the column `name` of the log at `path`.

        The first of its cells stands in the row `first_row` of the file; `order` is that of
        dates, where it is known; the numbers `none` stand for no value.

        """
        self.where = f'log {path}: column {short(repr(name))}'
        self._row = self._first_row = first_row
        self._order, self._none, self._named = order, none, order_in_name(name)
        self._first: Any = None
        self.signs = signs.Signs()
        self._type: pl.DataType = pl.Null()
        self._kinds: list[list[_Count]] = []
        self.count, self._holes = 0, (0, 0)
        self._looks = 3

    def add(self, cells: pl.Series) -> None:
        """Look through the next cells; raises InputError when their type is that of no number."""
        if not self._kinds:
            self._first, self._type = cells[0], cells.dtype
        with readable(f'{self.where} of {self._type} cannot be read as numbers'):
            if not self._kinds:
                self._kinds = [
                    [_Count(form=form, none=self._none) for form in kind]
                    for kind in self._forms(cells)
                ]
            if cells.dtype == self._type:
                self._count(cells)
                first = cells.head(SAMPLE)
                if cells.null_count() or (cells.dtype == pl.String and (first == '').any()):
                    places = np.flatnonzero(empties(cells)) + self._row
                    count, check = self._holes
                    self._holes = count + len(places), zlib.crc32(places.tobytes(), check)
            else:
                self._count_typed(cells)
        self._row += len(cells)
        self.count += len(cells)

    def _count_typed(self, cells: pl.Series) -> None:
        """Count cells that were read by the type that is `plain`."""
        points, commas = self._kinds[0]
        numbers = _finite(_plain, cells, self._none)
        points.take(numbers, cells, self._row)
        if cells.dtype == pl.Float64:
            commas.pass_over(cells, self._row, filled=True)
        else:
            commas.take(numbers, cells, self._row)

    @property
    def plain(self) -> Any:
        """Return the type of texts that all are plain numbers, None where some are not."""
        if self._type != pl.String or len(self._kinds) != 1:
            return None
        points, commas = self._kinds[0]
        if points.good != self.count or self.signs.shows(','):
            return None
        if self.signs.shows('.'):
            return pl.Float64
        return pl.Int64 if commas.good == self.count and not self.signs.doubtful else None

    def reading(self, sign: str = '', order: str = '') -> Reading:
        """
        Return how the column is read in a table of a decimal sign, and an order of its dates.

        Raises InputError when it holds no number.

        """
        chosen = self._chosen(sign, order or self.order)
        if not chosen.good:
            raise InputError(
                f'{self.where} holds no number, but {short(repr(self._first))} in row '
                f'{self._first_row}'
            )
        note = (
            f'{self.where} holds {counted(chosen.bad, "cell")} without a number, the first is '
            f'{chosen.first}; they count as unknown'
        )
        extremes = np.array([chosen.least, chosen.most])
        return Reading(
            form=chosen.form,
            extremes=extremes if chosen.least <= chosen.most else np.full(2, math.nan),
            holes=self._holes,
            note=note if chosen.bad else '',
            plain=self.plain,
            none=self._none,
        )

    @property
    def numbers(self) -> list[_Count]:
        """Return what numbers of each decimal sign were made of the cells."""
        return [one for kind in self._kinds for one in kind if one.form in _NUMBERS.values()]

    @property
    def order(self) -> str:
        """Return the order of year, month and day that the dates show, empty if they show none."""
        dates, _ = self._dates()
        return dates[0].order if len(dates) == 1 else ''

    def doubt(self, order: str = '') -> str:
        """Return in words what else its dates may be, empty if they or an order make it clear."""
        dates, _ = self._dates()
        if len(dates) < 2 or order in [one.order for one in dates]:
            return ''
        of_first = {form.order: moment for moment, form in moments_of(str(self._first))}
        moments = {one.order: of_first.get(one.order, one.least) for one in dates}
        return (
            f'{self.where} holds {short(repr(self._first))} in row {self._first_row}, which is '
            f'{either_date(moments)}, as every date of the log may be: state it in the map'
        )

    @property
    def is_dotted(self) -> bool:
        """Return True if points part its dates, which may be of several orders."""
        dates, _ = self._dates()
        return len(dates) > 1 and all('%m.' in getattr(one.form, 'pattern', '') for one in dates)

    @property
    def decided(self) -> str:
        """Return in words why its dates are of an order, empty where no other one is possible."""
        dates, why = self._dates()
        return f'{self.where} holds dates of {ORDERS[dates[0].order]}: {why}' if why else ''

    def _dates(self) -> tuple[list[_Count], str]:
        """Return the forms in which all dates can be read, and what chose the only one."""
        chosen = self._chosen()
        kind = next((kind for kind in self._kinds if chosen in kind), [chosen])
        dates = [one for one in kind if one.order and one.good == chosen.good > 0]
        if len({(one.least, one.most, one.last, one.total) for one in dates}) < 2:
            return [chosen], ''
        if named := [one for one in dates if one.order == self._named]:
            return named, 'its name says so'
        near = [one for one in dates if one.leap < FOLLOWS]
        if len(near) == 1 and all(one.leap > LEAPS for one in dates if one is not near[0]):
            return near, 'the rows follow each other in no other order'
        return dates, ''

    def _forms(self, cells: pl.Series) -> list[tuple[Form, ...]]:
        if self._type == pl.String:
            numbers = tuple(_NUMBERS.values())
            plain = cells.head(SAMPLE)
            if not plain.null_count() and not np.isnan(_finite(_points, plain)).any():
                return [numbers]
            forms = [
                tuple(form for form in kind if form.order == self._order) or kind
                for kind in time_forms(cells)
            ]
            return [numbers, *forms]
        if self._type.is_temporal():
            return [(_seconds,)]
        if self._type.is_numeric():
            return [(_plain,)]
        raise InputError(f'{self.where} holds {self._type}, it must hold numbers')

    def _count(self, cells: pl.Series) -> None:
        """Count what each form makes of cells; what reads all of them leaves none to others."""
        # A text is a number or a time of one form: the kind of most cells so far is tried first.
        read = False
        for kind in sorted(self._kinds, key=lambda kind: -max(one.good for one in kind)):
            if read:
                for one in kind:
                    one.pass_over(cells, self._row)
            elif kind[0].form is _NUMBERS['.']:
                read = self._count_numbers(cells, *kind)
            else:
                read = max([one.add(cells, self._row) for one in kind])
        if not read and len(self._kinds) == 1 and self._looks:
            self._look_for_times(cells)

    def _look_for_times(self, cells: pl.Series) -> None:
        """Let cells that are no numbers be times, of which there was none so far."""
        self._looks -= 1
        before = max(one.good + one.bad for one in self._kinds[0]) - len(cells)
        for kind in self._forms(cells)[1:] if cells.dtype == pl.String else ():
            counts = [_Count(form=form, bad=before) for form in kind]
            for one in counts:
                one.first = f'{short(repr(self._first))} in row {self._first_row}' * (before > 0)
                one.add(cells, self._row)
            self._kinds.append(counts)

    def _count_numbers(self, cells: pl.Series, points: _Count, commas: _Count) -> bool:
        """Count cells as numbers with a point and with a comma; return True if one reads all."""
        numbers = _finite(_points, cells, self._none)
        pointed = _holds(cells, '.')
        if not self.signs.shows('.') and not pointed.all():
            whole = np.where(np.isfinite(numbers), np.abs(numbers), -math.inf)[~pointed]
            self.signs.most_whole = max(self.signs.most_whole, float(whole.max()))
        if np.isfinite(numbers).all():  # none of them holds a comma
            read = points.take(numbers, cells, self._row)
            if not pointed.any():
                return commas.take(numbers, cells, self._row)
            if not self.signs.shows('.'):
                self._look(cells, pointed)
            if self.signs.shows('.') and not self.signs.shows(','):
                commas.take(np.where(pointed, math.nan, numbers), cells, self._row)
            else:
                commas.add(cells, self._row)
            return read
        self._look(cells, pointed | _holds(cells, ','))
        read = points.add(cells, self._row)
        return commas.add(cells, self._row) or read

    def _look(self, cells: pl.Series, holding: NDArray[np.bool_]) -> None:
        if holding.all():
            self.signs.look(cells, self._row)
        elif holding.any():
            first = int(holding.argmax())
            self.signs.look(cells.set(pl.Series(~holding), None)[first:], self._row + first)

    def _chosen(self, sign: str = '', order: str = '') -> _Count:
        """
        Return the form in which a column is read: the one that leaves the fewest without a number.

        Numbers have the decimal sign that cells of the column show, else that of the table.

        """
        if not self._kinds:
            return _Count(form=_points)
        counts = [
            max(kind, key=lambda one: (one.good, one.order == order)) for kind in self._kinds
        ]
        if self._kinds[0][0].form is _NUMBERS['.']:
            own = [each for each in OTHER_SIGN if self.signs.shows(each)]
            decided = own[0] if len(own) == 1 else sign
            if decided:
                counts[0] = self._kinds[0][list(_NUMBERS).index(decided)]
        return max(counts, key=lambda one: one.good)


def _finite(form: Form, cells: pl.Series, none: Sequence[float] = ()) -> Array:
    """Return cells as numbers, NaN where a form makes none of them, or one that is not known."""
    numbers = form(cells).to_numpy()  # NaN for null
    known = np.isfinite(numbers)
    if none:
        known &= ~np.isin(numbers, none)
    return numbers if known.all() else np.where(known, numbers, math.nan)


def _plain(numbers: pl.Series) -> pl.Series:
    return numbers.cast(pl.Float64)


def _seconds(times: pl.Series) -> pl.Series:
    """Return times and durations of whatever unit in [s]."""
    if times.dtype != pl.Time:  # which is counted in nanoseconds, whatever wrote it
        spans = isinstance(times.dtype, pl.Duration)
        times = times.cast(pl.Duration('ns') if spans else pl.Datetime('ns'))
    return times.cast(pl.Int64).cast(pl.Float64) / SECOND


def _points(texts: pl.Series) -> pl.Series:
    plain = texts.cast(pl.Float64, strict=False)
    if plain.null_count() == texts.null_count():  # blanks around numbers are rare, and cost
        return plain
    return signs.with_plain_sign(texts).cast(pl.Float64, strict=False)


def _holds(texts: pl.Series, mark: str) -> NDArray[np.bool_]:
    """Return which texts hold a mark."""
    return texts.str.contains(mark, literal=True).fill_null(False).to_numpy()


def empties(cells: pl.Series) -> NDArray[np.bool_]:
    """Return which cells hold nothing, or blanks alone: these are no samples."""
    if cells.dtype != pl.String:
        return cells.is_null().to_numpy()
    return ((cells.str.strip_chars() == '') | cells.is_null()).fill_null(True).to_numpy()


def _grouped(sign: str) -> Form:
    """Return the form of numbers with a decimal sign, whose thousands another one may part."""
    pattern, other = signs.grouped(sign), OTHER_SIGN[sign]
    between = rf'{signs.MARKS}|{re.escape(other)}'

    def form(texts: pl.Series) -> pl.Series:
        if sign == '.' or not _holds(texts, '.').any():  # few cells hold more than plain numbers
            pointed = texts if sign == '.' else texts.str.replace(',', '.', literal=True)
            numbers = pointed.cast(pl.Float64, strict=False)
            if numbers.null_count() == texts.null_count():
                return numbers
        texts = signs.with_plain_sign(texts)
        if _holds(texts, other).any() or texts.str.contains(rf'\d{signs.MARKS}\d').any():
            parted = pl.Series(signs.are(texts, pattern))
            texts = texts.str.replace_all(between, '').zip_with(parted, texts)
        if sign == '.':
            return texts.cast(pl.Float64, strict=False)
        pointed = texts.set(pl.Series(_holds(texts, '.')), None)
        return pointed.str.replace(',', '.', literal=True).cast(pl.Float64, strict=False)

    return form


_NUMBERS = {sign: _grouped(sign) for sign in OTHER_SIGN}
"""Forms of numbers by their decimal sign."""


class TypesBut(Mapping[str, Any]):
    """Types of columns, which change while a table is read, but for columns that are made."""

    def __init__(self, types: Mapping[str, Any], made: Collection[str]) -> None:
        """Leave out the types of columns of some names."""
        self._types, self._made = types, made

    def __getitem__(self, name: str) -> Any:
        return self._types[name]

    def __iter__(self) -> Iterator[str]:
        return (name for name in self._types if name not in self._made)

    def __len__(self) -> int:
        return sum(1 for _ in self)


class Unreadable(ValueError):
    """What a reader finds wrong with a file, in the words of its kind."""


@contextlib.contextmanager
def readable(failure: str, *kinds: type[Exception]) -> Iterator[None]:
    """
    Raise InputError, `failure` and why, for what the readers of tables raise: errors and panics.

    A panic of a reader is no Exception, and each package has its own kind. `kinds` are errors that
    count besides those of polars.

    """
    try:
        yield
    except BaseException as error:
        is_panic = not isinstance(error, (Exception, *ENDS))
        if not is_panic and not isinstance(error, (PolarsError, *kinds)):
            raise
        raise InputError(f'{failure}: {first_line(error)}') from None


def first_line(error: BaseException) -> str:
    """Return the first line of what an error says."""
    return next(iter(str(error).splitlines()), type(error).__name__)
