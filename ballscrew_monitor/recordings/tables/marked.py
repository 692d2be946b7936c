# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Cells of columns by their marks: nan where not valid, with a minus if backward."""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Any

from ballscrew_monitor.recordings.tables.cells import empties, Read
from ballscrew_monitor.recordings.tables.marks import Mark, Marks, MOST, plain_cell
from ballscrew_monitor.recordings.tables.signs import MINUS, with_plain_sign
import polars as pl

FEW = 0.05  # of the cells that have a minus by noise


def marked(read: Read, marks: Mapping[str, Marks]) -> Read:
    """Return what reads the columns of a source as `read` does, by the marks of some of them."""

    def read_marked(names: list[str], types: Mapping[str, Any]) -> Iterator[pl.DataFrame]:
        chosen = {name: marks[name] for name in names if name in marks}
        columns = [mark.column for one in chosen.values() for mark in one.held]
        every = list(dict.fromkeys([*names, *columns]))
        for block in read(every, types):
            series = [_marked(block, name, one) for name, one in chosen.items()]
            yield block.with_columns(series).select(names)

    return read_marked


def _marked(block: pl.DataFrame, name: str, marks: Marks) -> pl.Series:
    cells = block[name]
    empty = pl.Series(empties(cells))
    if marks.backward:
        back = _holds(block, marks.backward) & ~empty
        if cells.dtype == pl.String:
            minus = '-' + with_plain_sign(cells).str.strip_prefix('-')
        else:
            minus = -cells.abs()
        cells = minus.zip_with(back, cells)
    if marks.valid:
        valid = _holds(block, marks.valid)
        unknown = 'nan' if cells.dtype == pl.String else float('nan')
        cells = cells if cells.dtype == pl.String else cells.cast(pl.Float64)
        cells = cells.zip_with(valid | empty, pl.Series([unknown], dtype=cells.dtype))
    return cells.alias(name)


def _holds(block: pl.DataFrame, mark: Mark) -> pl.Series:
    """Return in which rows the column of a mark holds one of its cells."""
    column, cells = block[mark.column], {*map(plain_cell, mark.cells)}
    chosen = [cell for cell in column.unique().to_list() if plain_cell(cell) in cells]
    return column.is_in(chosen).fill_null(False)


def look_at_marks(
    blocks: Iterable[pl.DataFrame], names: Sequence[str]
) -> tuple[set[str], dict[str, list[str]]]:
    """Return which columns have a sign, not by noise alone, and the different cells of each."""
    below, rows = dict.fromkeys(names, 0), 0
    cells: dict[str, set[str]] = {name: set() for name in names}
    for block in blocks:
        rows += block.height
        for name in names:
            column = block[name]
            if column.dtype == pl.String:
                negative = column.str.contains(rf'^\s*[{MINUS}]\s*[0.,]*[1-9]')
            else:
                negative = column < 0 if column.dtype.is_numeric() else pl.Series([False])
            below[name] += int(negative.fill_null(False).sum())
            if len(cells[name]) <= MOST:
                cells[name] |= {*map(_text, block[name].unique().to_list())} - {''}
    signed = {name for name, count in below.items() if count > FEW * rows}
    return signed, {name: sorted(held) for name, held in cells.items()}


def _text(cell: Any) -> str:
    return plain_cell(cell) if not isinstance(cell, str) else cell.strip()
