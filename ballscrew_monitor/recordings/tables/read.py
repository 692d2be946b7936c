# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Numbers out of a table, in blocks of rows: a log may be larger than memory.

A log is looked through once to learn how its cells are numbers. A cell without a number is NaN and
counted; what cannot be read at all is one sentence in an InputError.

"""

from collections.abc import Collection, Iterator, Mapping
import contextlib
import dataclasses
import difflib
from pathlib import Path

from ballscrew_monitor.recordings.tables.cells import Array, Cells, Reading
from ballscrew_monitor.recordings.tables.quantities import Layout, OTHER_SIGN
from ballscrew_monitor.recordings.tables.sources import layout_of, Source, source_of
from ballscrew_monitor.recordings.words import listed, short, Shown, shown_progress
import numpy as np
import polars as pl
from surrogate.files import InputError

SURE_BETWEEN = ('', ',')
"""Separators of cells whose sign is decimal if the log does not show the other one."""


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class Table:
    """
    Chosen columns of a log that was looked through: how each is read, by name.

    `notes` says in a sentence each what could not be read; `left_out` says why of columns;
    `doubts` says of numbers what else they may be, by the decimal sign that they would have then.

    """

    path: Path
    readings: dict[str, Reading]
    rows: int
    notes: tuple[str, ...]
    left_out: Mapping[str, str]
    doubts: Mapping[str, str]
    _source: Source

    @property
    def first_row(self) -> int:
        """Return the row of the file in which the first cells stand."""
        return self._source.first

    def blocks(self, names: Collection[str] | None = None) -> Iterator[dict[str, Array]]:
        """Yield columns (None: all) in blocks of rows, NaN where there is no number, times [s]."""
        chosen = list(self.readings if names is None else names)
        for block in self._source.blocks(chosen):
            yield {name: self.readings[name].numbers(block[name]) for name in chosen}

    def head(self, most: int) -> dict[str, Array]:
        """Return all columns, `most` of their rows."""
        blocks, rows = [], 0
        for block in self.blocks() if self.readings else ():
            blocks.append(block)
            rows += len(next(iter(block.values())))
            if rows >= most:
                break
        return {
            name: np.concatenate([block[name] for block in blocks])[:most]
            for name in self.readings
        }


def column_names(path: Path, layout: Layout | None = None) -> list[str]:
    """Return the names of all columns of a log; raises InputError when it is no table."""
    return source_of(path, layout).names()


def open_table(
    path: Path,
    names: Collection[str],
    *,
    layout: Layout | None = None,
    decimal: str = '',
    optional: Collection[str] = (),
    shown: Shown = shown_progress,
) -> Table:
    """
    Look through the columns `names` of a log, and show how far that is.

    Raises InputError when one is missing, holds no number, or holds numbers that may be others
    unless the `decimal` sign is stated; an `optional` one without a number is left out.

    """
    source = source_of(path, layout)
    _check_names(source, names, layout or Layout())
    table = look_through(source, names, decimal=decimal, optional=optional, shown=shown)
    for doubt in table.doubts.values():
        raise InputError(doubt)
    return table


def look_through(
    source: Source,
    names: Collection[str],
    *,
    decimal: str = '',
    optional: Collection[str] = (),
    shown: Shown = shown_progress,
) -> Table:
    """Look through columns that a table holds, as `open_table` does, but keep the doubts."""
    left_out: dict[str, str] = {}
    found = {name: _cells(source, name, decimal) for name in names}
    rows = 0
    with shown(source.rows, 'rows looked through') as show:
        for block in source.blocks(list(found)):
            for name, cells in found.items():
                if name in left_out:
                    continue
                with _left_out(name, left_out, optional):
                    cells.add(block[name])
            rows += block.height
            show(rows / source.rows)
    if not rows:
        raise InputError(f'log {source.path} holds no row, at least two are needed')
    readings: dict[str, Reading] = {}
    for name, cells in found.items():
        if name in left_out:
            continue
        with _left_out(name, left_out, optional):
            readings[name] = cells.reading()
    return Table(
        path=source.path,
        readings=readings,
        rows=rows,
        notes=tuple(one.note for one in readings.values() if one.note),
        left_out=left_out,
        doubts={} if decimal else _doubts(source, found),
        _source=source,
    )


def _cells(source: Source, name: str, decimal: str = '') -> Cells:
    return Cells(source.path, name, source.separator, first_row=source.first, decimal=decimal)


def _doubts(source: Source, found: Mapping[str, Cells]) -> dict[str, str]:
    """
    Return what numbers may be others, as columns of the log differ in their sign or show none.

    Cells of a workbook are numbers, and those between commas have a decimal point.

    """
    if not any(cells.signs.doubtful for cells in found.values()):
        return {}
    others = {name: _cells(source, name) for name in source.names() if name not in found}
    head = source.head()
    for name, cells in others.items():
        if head[name].dtype == pl.String:
            cells.add(head[name])
    every = others | dict(found)
    elsewhere = {
        sign: f'{cell} of column {short(repr(name))}'
        for name, cells in every.items()
        for sign, cell in cells.signs.seen.items()
    }
    clear = [
        sign
        for sign in OTHER_SIGN
        if source.separator in SURE_BETWEEN
        or any(cells.signs.shows(sign) for cells in every.values())
    ]
    doubts: dict[str, str] = {}
    for cells in found.values():
        for sign, doubt in cells.signs.doubts(elsewhere, clear).items():
            doubts.setdefault(sign, f'{cells.where} {doubt}')
    return doubts


def _check_names(source: Source, names: Collection[str], layout: Layout) -> None:
    """Raise InputError for a column that a log does not hold, with what may be meant."""
    held = source.names()
    for name in names:
        if name not in held:
            hints = [
                f'{short(near)} may be meant'
                for near in difflib.get_close_matches(name, held, n=1)
            ]
            if (found := layout_of(source.path)) != layout:
                hints.append(
                    'the names look to stand elsewhere: write '
                    f'`skip: {found.skip}` and `header_rows: {found.header_rows}` in the map'
                )
            raise InputError(
                f'log {source.path}: column {short(repr(name))} is missing, the log holds '
                f'{"; ".join([listed(held), *hints])}'
            )


@contextlib.contextmanager
def _left_out(name: str, left_out: dict[str, str], optional: Collection[str]) -> Iterator[None]:
    """Take down why an optional column cannot be read."""
    try:
        yield
    except InputError as error:
        if name not in optional:
            raise
        left_out[name] = str(error)
