# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Cells that hold more than a number: a unit, as `12.3 mm/s`, or a length of time, as T#1s500ms.

Such a column becomes one of plain numbers, whose name states the unit. A sample of its cells
decides; a cell of another unit behind it is no number.

"""

from collections.abc import Callable, Iterator, Mapping, Sequence
import re
from typing import Any

from ballscrew_monitor.recordings.tables.cells import Read, TypesBut
from ballscrew_monitor.recordings.tables.names import read_name
from ballscrew_monitor.recordings.tables.unit_names import (
    BRACKETS,
    is_unit,
    unit_and_scale,
    unit_of,
)
from ballscrew_monitor.recordings.words import listed, short
import polars as pl

PlainColumn = tuple[str, Callable[[pl.Series], pl.Series]]
"""The new name of a column whose cells are made plain, and what makes them so."""
AMOUNT = re.compile(
    r"(?P<number>[-+\u2212\u2013]?\s*[.,]?\d(?:[\d.,  '’]*[\d.,])?(?:e[-+]?\d+)?)\s*"
    r'(?P<unit>[%°a-zµμ][^\d:=#]*(?:/[^\d:=#]+)?)',
    re.I,
)
"""A number and its unit."""
_SPAN = (
    r'^\s*(?P<sign>-?)(?P<mark>L?T(?:IME)?#|P(?=[T\d]))?'
    r'(?P<parts>(?:T?[\d.,]+\s*(?:days?|d|hours?|hrs?|hr|h|minutes?|min|msec|ms|m|seconds?|sec|s|'
    r'usec|us|µs|μs|ns)[\s_,]*)+)(?P<clock>\+?\d+:\d\d:\d\d(?:[.,]\d+)?)?\s*$'
)
SPAN = re.compile(_SPAN, re.I)
"""A length of time by IEC 61131 or ISO 8601, in days and hours, or in words of units."""
_PARTS = {
    'd(?:ays?)?': 86400.0,
    'h(?:r|rs|ours?)?': 3600.0,
    'm(?:in(?:utes?)?)?': 60.0,
    's(?:ec(?:onds?)?)?': 1.0,
    'ms(?:ec)?': 1e-3,
    '(?:u|µ|μ)s(?:ec)?': 1e-6,
    'ns': 1e-9,
}
"""Spellings of the parts of a span, each with its length [s]."""
_CLOCK = r'(\d+):(\d\d):(\d\d(?:[.,]\d+)?)\s*$'
TYPED = re.compile(r'\s*L?(?:TOD|DT|D|TIME_OF_DAY|DATE_AND_TIME|DATE)#(?P<time>\d.*)', re.I)
"""A time of day or date as IEC 61131 types it."""
CLOCK = re.compile(r'\s*(?:\d{1,4}[-./]\d{1,2}[-./]\d{1,4}[ T])?\d\d:\d\d:\d\d:(?P<part>\d\d)\s*')
"""A time whose last part after a colon has two digits."""
FRAMES = 60  # in a second, at most: a larger number counts hundredths
SAMPLE = 60  # cells by which a column is known


def is_amount(cell: str) -> bool:
    """Return True if a cell is a number with a unit, or a length of time."""
    match = AMOUNT.fullmatch(cell)
    return bool(match and is_unit(match['unit'])) or bool(SPAN.match(cell) or TYPED.match(cell))


def plain_columns(columns: Mapping[str, Sequence[str]]) -> dict[str, PlainColumn]:
    """
    Return the columns whose cells are to be made plain, by some of their cells.

    Raises ValueError where cells are in several units, or in another than the name states, or end
    with parts of a second that may be frames.

    """
    plain = {}
    for name, cells in columns.items():
        filled = [cell for cell in cells if any(map(str.isdigit, cell))]
        if column := _plain_column(name, filled[:: max(len(filled) // SAMPLE, 1)]):
            plain[name] = column
    return plain


def _plain_column(name: str, cells: Sequence[str]) -> PlainColumn | None:
    if not cells or not any(letter.isalpha() or letter in ':%°' for letter in cells[-1]):
        return None
    if all(map(TYPED.fullmatch, cells)):
        return name, lambda texts: texts.str.replace(r'^[^#]*#', '')
    clocks = [match for cell in cells if (match := CLOCK.fullmatch(cell))]
    if len(clocks) == len(cells):
        return _of_hundredths(name, cells, [int(match['part']) for match in clocks])
    amounts = [match for cell in cells if (match := AMOUNT.fullmatch(cell))]
    units = {match['unit'].strip() for match in amounts}
    if len(amounts) == len(cells) and all(map(is_unit, units)) and len(units) == 1:
        return _of_unit(name, units.pop())
    spans = [match for cell in cells if (match := SPAN.match(cell))]
    marked = all(match['mark'] or match['clock'] for match in spans)
    if len(spans) == len(cells) and (marked or read_name(name).kind in ('time', '')):
        return _with_unit(name, 's'), _seconds
    if len(amounts) == len(cells) and all(map(is_unit, units)):
        raise ValueError(
            f'the cells of column {short(repr(name))} are in {listed(sorted(units))}: give all of '
            'them in one unit'
        )
    return None


def _of_hundredths(name: str, cells: Sequence[str], parts: Sequence[int]) -> PlainColumn:
    """Return a column of times by its cells and their last parts, two digits behind a colon."""
    if max(parts) < FRAMES:
        raise ValueError(
            f'the cells of column {short(repr(name))}, such as {short(cells[-1])}, end with a '
            'part behind a third colon that may be frames, hundredths or, behind days, seconds: '
            'write hours:minutes:seconds with decimals'
        )
    return name, lambda texts: texts.str.replace(r':(\d\d)\s*$', '.$1')


def _of_unit(name: str, unit: str) -> PlainColumn | None:
    """Return a column in a unit of its cells; None for such as its quantity has not."""
    kind = read_name(name if BRACKETS.search(name) else _with_unit(name, unit)).kind
    kind = kind or read_name(name).kind
    of_name, of_cells = unit_and_scale(name, kind), unit_and_scale(f'[{unit}]', kind)
    if kind and not of_cells[0]:
        return None
    if kind and of_name[0] and of_name != of_cells:
        raise ValueError(
            f'the name of column {short(repr(name))} states another unit than its cells, which '
            f'are in {short(unit)}: take the wrong one out'
        )
    named = name if of_name[0] or BRACKETS.search(name) else _with_unit(name, unit)
    pattern = rf'\s*{re.escape(unit)}\s*$'
    return named, lambda texts: texts.str.replace(pattern, '')


def _with_unit(name: str, unit: str) -> str:
    return name if unit_of(name, 'time') == unit else f'{name} [{unit}]'


def _seconds(texts: pl.Series) -> pl.Series:
    """Return lengths of time [s], null for other texts."""
    total = pl.lit(0.0)
    for spelling, length in _PARTS.items():
        part = pl.col('text').str.extract(rf'(?i)([\d.,]+)\s*{spelling}(?:[^\p{{L}}]|$)')
        total += length * part.str.replace(',', '.').cast(pl.Float64, strict=False).fill_null(0.0)
    for group, length in ((1, 3600.0), (2, 60.0), (3, 1.0)):
        part = pl.col('text').str.extract(_CLOCK, group).str.replace(',', '.')
        total += length * part.cast(pl.Float64, strict=False).fill_null(0.0)
    whole = rf'(?i){_SPAN}'.replace('(?=[T\\d])', '').replace('(?P<', '(?<')
    negative = pl.when(pl.col('text').str.contains(r'^\s*-')).then(-1.0).otherwise(1.0)
    spans = pl.when(pl.col('text').str.contains(whole)).then(negative * total)
    return pl.DataFrame({'text': texts}).select(spans.alias(texts.name)).to_series()


def plainly(read: Read, columns: Mapping[str, PlainColumn]) -> Read:
    """Return what reads a table as `read` does, some of its columns plain and by new names."""
    held = {new: name for name, (new, _) in columns.items()}

    def read_plain(names: list[str], types: Mapping[str, Any]) -> Iterator[pl.DataFrame]:
        every = [held.get(name, name) for name in names]
        for block in read(every, TypesBut(types, held)):
            yield block.select(
                columns[held[name]][1](block[held[name]]).alias(name)
                if name in held and block[held[name]].dtype == pl.String
                else block[held.get(name, name)].alias(name)
                for name in names
            )

    return read_plain
