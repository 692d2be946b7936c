# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Cells of a table as numbers: in which form they are, by all cells of a column, block by block.

Numbers, times and durations of Parquet are read by their type. Texts are numbers with a decimal
point, numbers with a decimal comma, times of ISO 8601 or of the German form, or parts of these.

"""

from collections.abc import Callable, Iterator
import contextlib
import dataclasses
import functools
import math
from pathlib import Path
import re
from typing import Any

from ballscrew_monitor.core.conversions import SECOND
from ballscrew_monitor.recordings.tables import signs
from ballscrew_monitor.recordings.tables.quantities import OTHER_SIGN
from ballscrew_monitor.recordings.words import short
import numpy as np
from numpy.typing import NDArray
import polars as pl
from polars.exceptions import PolarsError
from surrogate.files import InputError

Array = NDArray[np.float64]
Form = Callable[[pl.Series], pl.Series]
"""Makes cells numbers, null where one is not a number."""
ENDS = (KeyboardInterrupt, SystemExit, GeneratorExit)


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class Reading:
    """How the cells of a column are numbers, the least and the most of them, what is not."""

    form: Form
    extremes: Array
    note: str

    @property
    def is_time(self) -> bool:
        """Tell whether the cells are times by their form or type, hence [s]."""
        return self.form in (_seconds, *_TIMES)

    def numbers(self, cells: pl.Series) -> Array:
        """Return cells as numbers, NaN where one is not a number."""
        return _finite(self.form, cells)


@dataclasses.dataclass(kw_only=True, slots=True)
class _Count:
    """What a form has made of the cells so far."""

    form: Form
    good: int = 0
    bad: int = 0
    first: str = ''  # of those that are no number, and its row
    least: float = math.inf
    most: float = -math.inf

    def add(self, cells: pl.Series, row: int) -> bool:
        """Count cells from `row` on; tell if all are numbers."""
        return self.take(_finite(self.form, cells), cells, row)

    def take(self, numbers: Array, cells: pl.Series, row: int) -> bool:
        """Count the numbers that the form makes of cells from `row` on, as `add` does."""
        bad = np.isnan(numbers)
        missing = int(bad.sum())
        if missing:
            self._miss(cells, int(bad.argmax()), missing, row)
            numbers = numbers[~bad]
        self.good += len(numbers)
        self.least = float(np.min(numbers, initial=self.least))
        self.most = float(np.max(numbers, initial=self.most))
        return not missing

    def pass_over(self, cells: pl.Series, row: int) -> None:
        """Count cells from `row` on as no numbers, without a look at them."""
        self._miss(cells, 0, len(cells), row)

    def _miss(self, cells: pl.Series, at: int, missing: int, row: int) -> None:
        if not self.bad:
            what = 'nothing' if cells[at] is None else short(repr(cells[at]))
            self.first = f'{what} in row {row + at}'
        self.bad += missing


class Cells:
    """The cells of one column, looked through in the order of their rows."""

    def __init__(
        self, path: Path, name: str, separator: str, *, first_row: int = 1, decimal: str = ''
    ) -> None:
        """
        Begin with the column `name` of the log at `path`, whose cells have a separator.

        The first of them stands in the row `first_row` of the file; `decimal` is the sign that the
        map states, for a column in which no cell shows the other one.

        """
        self._separator, self._decimal = separator, decimal
        self.where = f'log {path}: column {short(repr(name))}'
        self._row = self._first_row = first_row
        self._first: Any = None
        self.signs = signs.Signs()
        self._type: pl.DataType = pl.Null()
        self._counts: list[_Count] = []

    def add(self, cells: pl.Series) -> None:
        """Look through the next cells; raises InputError when their type is that of no number."""
        if self._row == self._first_row:
            self._first, self._type = cells[0], cells.dtype
            self._counts = [_Count(form=form) for form in self._forms()]
        with readable(f'{self.where} of {self._type} cannot be read as numbers'):
            self._count(cells)
        self._row += len(cells)

    def reading(self) -> Reading:
        """Return how the column is read; raises InputError when it holds no number."""
        chosen = self._chosen()
        if not chosen.good:
            raise InputError(
                f'{self.where} holds no number, but {short(repr(self._first))} in row '
                f'{self._first_row}'
            )
        note = (
            f'{self.where} holds {chosen.bad} cells without a number, the first is '
            f'{chosen.first}; they count as unknown'
        )
        extremes = np.array([chosen.least, chosen.most])
        return Reading(
            form=chosen.form,
            extremes=extremes if chosen.least <= chosen.most else np.full(2, math.nan),
            note=note if chosen.bad else '',
        )

    def _forms(self) -> tuple[Form, ...]:
        if self._type == pl.String:
            return (*_NUMBERS[self._decimal], *_TIMES)
        if self._type.is_temporal():
            return (_seconds,)
        if self._type.is_numeric():
            return (_plain,)
        raise InputError(f'{self.where} holds {self._type}, it must hold numbers')

    def _count(self, cells: pl.Series) -> None:
        """Count what each form makes of cells; what reads all of them leaves none to others."""
        if len(self._counts) == 1:
            self._counts[0].add(cells, self._row)
            return
        points, commas, *times = self._counts
        # A text is a number or a time of one form: the kind of most cells so far is tried first.
        kinds = [[points, commas], *([one] for one in times)]
        read = False
        for kind in sorted(kinds, key=lambda kind: -max(one.good for one in kind)):
            if read:
                for one in kind:
                    one.pass_over(cells, self._row)
            elif len(kind) > 1:
                read = self._count_numbers(cells, points, commas)
            else:
                read = kind[0].add(cells, self._row)

    def _count_numbers(self, cells: pl.Series, points: _Count, commas: _Count) -> bool:
        """Count cells as numbers with a point and with a comma; return True if one reads all."""
        numbers, commaed = _finite(_points, cells), np.zeros(len(cells), np.bool_)
        unread = np.isnan(numbers)
        if unread.any():  # only a cell without a number with a point may have a comma
            commaed = unread & _holds(cells, ',')
            if commaed.any():
                numbers = _finite(_points, _with_points(cells))
                unread = np.isnan(numbers)
        pointed = functools.cache(lambda: _holds(cells, '.'))
        self.signs.look(cells, {'.': pointed, ',': lambda: commaed}, unread, self._row)
        if self._decimal:
            read = points.add(cells, self._row)
            return commas.add(cells, self._row) or read
        read = points.take(np.where(commaed, math.nan, numbers), cells, self._row)
        thousands = self._separator == ',' and points.good  # which a comma may part there
        if not thousands:
            read |= commas.take(np.where(pointed(), math.nan, numbers), cells, self._row)
        return read

    def _chosen(self) -> _Count:
        """
        Return the form in which a column is read: the one that leaves the fewest without a number.

        Where commas separate the cells, one within a cell may part thousands too: it is a decimal
        mark only if no cell is a number as is. A sign that the map states counts unless a cell
        shows the other one.

        """
        if len(self._counts) == 1:
            return self._counts[0]
        points, commas, *times = self._counts
        if self._decimal:
            other = self.signs.shows(OTHER_SIGN[self._decimal])
            points = commas = points if (self._decimal == '.') != other else commas
        elif self._separator == ',' and points.good:
            commas = points
        return max(points, commas, *times, key=lambda one: one.good)


def _finite(form: Form, cells: pl.Series) -> Array:
    """Return cells as numbers, NaN where a form makes none or no finite one of them."""
    numbers = form(cells).to_numpy()  # NaN for null
    known = np.isfinite(numbers)
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
    return texts.str.strip_chars().cast(pl.Float64, strict=False)


def _commas(texts: pl.Series) -> pl.Series:
    """Return texts as numbers with a decimal comma; one with a point becomes null."""
    return _points(_with_points(texts.set(pl.Series(_holds(texts, '.')), None)))


def _with_points(texts: pl.Series) -> pl.Series:
    return texts.str.replace(',', '.', literal=True)


def _holds(texts: pl.Series, mark: str) -> NDArray[np.bool_]:
    """Return which texts hold a mark."""
    return texts.str.contains(mark, literal=True).fill_null(False).to_numpy()


def _grouped(sign: str, plain: Form) -> Form:
    """Return a form of numbers with a decimal sign, whose thousands the other one may part."""
    part = OTHER_SIGN[sign]
    pattern = rf'{signs.thousands(part, "+")}(?:{re.escape(sign)}\d*)?'

    def form(texts: pl.Series) -> pl.Series:
        without = texts.str.replace_all(part, '', literal=True)
        return plain(without.zip_with(pl.Series(signs.are(texts, pattern)), texts))

    return form


_NUMBERS = {
    '': (_points, _commas),
    '.': (_grouped('.', _points), _commas),
    ',': (_points, _grouped(',', _commas)),
}
"""Forms with a decimal point and with a comma, by the sign that the map states."""


def _made(parsed: Callable[[pl.Series], pl.Series]) -> Form:
    """Return what makes texts times [s] by what parses them with a decimal point."""

    def made(texts: pl.Series) -> pl.Series:
        plain = texts.str.strip_chars().str.replace(',', '.', literal=True)
        return _seconds(parsed(plain.str.replace('T', ' ', literal=True).str.strip_suffix('Z')))

    return made


def _clock(form: str) -> Form:
    """Return what makes texts of a form of date and time those of the universal clock [s]."""
    return _made(lambda texts: texts.str.to_datetime(form, time_unit='ns', strict=False))


def _day(form: str) -> Form:
    """Return what makes texts of a form of a date its begin by the universal clock [s]."""
    return _made(lambda texts: texts.str.to_date(form, strict=False))


_OF_DAY = '%H:%M:%S%.f'
_TIMES = (
    *(_clock(f'{day} {_OF_DAY}') for day in ('%Y-%m-%d', '%d.%m.%Y', '%Y/%m/%d')),
    _clock(f'%Y-%m-%d {_OF_DAY}%z'),
    _made(lambda texts: texts.str.to_time(_OF_DAY, strict=False)),
    *map(_day, ('%Y-%m-%d', '%d.%m.%Y', '%Y/%m/%d')),
)


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
