# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Numbers out of a CSV or Parquet file.

A cell without a number is NaN and counted; what cannot be read at all is one sentence in an
InputError.

"""

from collections.abc import Collection
import dataclasses
from pathlib import Path

from ballscrew_monitor.core.conversions import SECOND
import numpy as np
from numpy.typing import NDArray
import polars as pl
from polars.exceptions import PolarsError
from surrogate.files import InputError

Array = NDArray[np.float64]

SEPARATORS = (',', ';', '\t', '|')
COMMENT = '#'
HEAD = 65536  # [bytes] of a file that tell what it is
UNREADABLE = (PolarsError, pl.exceptions.PanicException)


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class Table:
    """
    Chosen columns of a log by name, NaN where there is no number, times of day as [s].

    `notes` says in a sentence each what could not be read.

    """

    path: Path
    columns: dict[str, Array]
    rows: int
    notes: tuple[str, ...]


def column_names(path: Path) -> list[str]:
    """Return the names of all columns of a log; raises InputError when it is no table."""
    return _names(path, _frame(path)[0])


def read_table(path: Path, names: Collection[str], *, strict: bool = True) -> Table:
    """
    Return the columns `names` of a log.

    Raises InputError when one is missing, or holds no number; unless `strict` such a one is left
    out with a note.

    """
    frame, separator = _frame(path)
    held = _names(path, frame)
    for name in names:
        if name not in held:
            raise InputError(
                f'log {path}: column {name!r} is missing, the log holds {", ".join(held)}'
            )
    try:
        data = frame.select(list(dict.fromkeys(names))).collect()
    except UNREADABLE as error:
        raise InputError(f'log {path} cannot be read: {_first_line(error)}') from None
    if not data.height:
        raise InputError(f'log {path} holds no row, at least two are needed')
    notes: list[str] = []
    columns: dict[str, Array] = {}
    for name in data.columns:
        try:
            columns[name] = _numbers(path, data[name], separator, notes)
        except InputError as error:
            if strict:
                raise
            notes.append(f'{error}; it is left out')
    return Table(path=path, columns=columns, rows=data.height, notes=tuple(notes))


def _numbers(path: Path, column: pl.Series, separator: str, notes: list[str]) -> Array:
    """Return a column as numbers, NaN where there is none; add a note about those."""
    try:
        numbers = _converted(column, separator)
    except UNREADABLE as error:
        raise InputError(
            f'log {path}: column {column.name!r} of {column.dtype} cannot be read as numbers: '
            f'{_first_line(error)}'
        ) from None
    if numbers is None:
        raise InputError(
            f'log {path}: column {column.name!r} holds {column.dtype}, it must hold numbers'
        )
    bad = numbers.is_null()
    if bad.all():
        raise InputError(f'log {path}: column {column.name!r} holds no number, but {column[0]!r}')
    if bad.any():
        row = bad.arg_max()
        value = column[row] if row is not None else None
        what = 'nothing' if value is None else repr(value)
        notes.append(
            f'log {path}: column {column.name!r} holds {int(bad.sum())} cells without a number, '
            f'the first is {what} in row {(row or 0) + 1}; they count as unknown'
        )
    return np.asarray(numbers.fill_null(float('nan')).to_numpy(), dtype=np.float64)


def _converted(column: pl.Series, separator: str) -> pl.Series | None:
    """Return a column as numbers, times and durations in [s]; None if its type is neither."""
    if column.dtype == pl.String:
        return _parsed(column, separator)
    if column.dtype.is_temporal():
        if column.dtype != pl.Time:  # which is counted in nanoseconds, whatever wrote it
            spans = isinstance(column.dtype, pl.Duration)
            column = column.cast(pl.Duration('ns') if spans else pl.Datetime('ns'))
        return column.cast(pl.Int64).cast(pl.Float64) / SECOND
    return column.cast(pl.Float64) if column.dtype.is_numeric() else None


def _parsed(texts: pl.Series, separator: str) -> pl.Series:
    """
    Return texts as numbers, or as times in [s] if they are no numbers but those.

    The decimal mark is the one that leaves fewer cells without a number. Where commas separate the
    cells, one within a cell may part thousands too: it counts only if no cell is a number as is.

    """
    stripped = texts.str.strip_chars()
    numbers = stripped.cast(pl.Float64, strict=False)
    commas = _decimal_commas(stripped)
    if commas.null_count() < numbers.null_count() and (
        separator != ',' or numbers.null_count() == len(numbers)
    ):
        return commas
    return numbers if numbers.null_count() < len(numbers) else _times(stripped)


def _decimal_commas(texts: pl.Series) -> pl.Series:
    """Return texts as numbers with a decimal comma; one with a point is none."""
    plain = texts.set(texts.str.contains('.', literal=True), None)
    return plain.str.replace(',', '.', literal=True).cast(pl.Float64, strict=False)


def _times(texts: pl.Series) -> pl.Series:
    """Return texts of the form of ISO 8601 as times of the universal clock [s]."""
    plain = texts.str.replace('T', ' ', literal=True).str.strip_suffix('Z')
    for form in ('%Y-%m-%d %H:%M:%S%.f', '%Y-%m-%d %H:%M:%S%.f%z'):
        found = plain.str.to_datetime(form, time_unit='ns', strict=False)
        if found.null_count() < len(found):
            return found.dt.epoch('ns').cast(pl.Float64) / SECOND
    return pl.Series(texts.name, [None] * len(texts), dtype=pl.Float64)


def _frame(path: Path) -> tuple[pl.LazyFrame, str]:
    """
    Return the table in a file, its cells as they stand, and their separator if it has one.

    Raises InputError when the file is no table.

    """
    try:
        with path.open('rb') as stream:
            head = stream.read(HEAD)
    except OSError as error:
        raise InputError(f'log {path} cannot be read: {error.strerror}') from None
    if not head.strip():
        raise InputError(f'log {path} is empty, it must be a CSV or Parquet file')
    if head.startswith(b'PAR1'):
        return pl.scan_parquet(path), ''
    if b'\0' in head:
        raise InputError(f'log {path} is no text, it must be a CSV or Parquet file')
    separator = max(SEPARATORS, key=_header(head).count)
    frame = pl.scan_csv(
        path,
        separator=separator,
        infer_schema=False,
        encoding='utf8-lossy',
        comment_prefix=COMMENT,
        truncate_ragged_lines=True,
    )
    return frame, separator


def _header(head: bytes) -> str:
    """Return the first line that is no comment, of what a file begins with; empty if none."""
    lines = head.decode('utf-8', 'replace').splitlines()
    return next((line for line in lines if line.strip() and not line.startswith(COMMENT)), '')


def _names(path: Path, frame: pl.LazyFrame) -> list[str]:
    try:
        return frame.collect_schema().names()
    except UNREADABLE as error:
        raise InputError(f'log {path} cannot be read: {_first_line(error)}') from None


def _first_line(error: BaseException) -> str:
    return next(iter(str(error).splitlines()), type(error).__name__)
