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
from typing import Any

from ballscrew_monitor.recordings.tables import heads
from ballscrew_monitor.recordings.tables.cells import Array, Cells, empties, Reading
from ballscrew_monitor.recordings.tables.dates import start_in_head
from ballscrew_monitor.recordings.tables.marks import Marks
from ballscrew_monitor.recordings.tables.quantities import Layout, ORDERS, OTHER_SIGN
from ballscrew_monitor.recordings.tables.signs import decide, Decision, Signs, THOUSAND
from ballscrew_monitor.recordings.tables.sources import Source, source_of
from ballscrew_monitor.recordings.words import counted, listed, short, Shown, shown_progress
import numpy as np
from numpy.typing import NDArray
import polars as pl
from surrogate.files import InputError

SHORT = 0.05  # of the rows, at most, that may be left out as they hold too few cells
GERMAN = 'dmy'  # order of dates that points part beside a decimal comma
PIECE, MOST_ROWS = 2048, 150_000  # rows of a piece of a sample, and of all of its pieces
WORD, ROW = r'^\s*"?[\[(]?\p{L}', '\0row'


class Sample:
    """Pieces of the rows of a table at even distances, all of the rows if they are few."""

    def __init__(self) -> None:
        """Begin with no row."""
        self._every, self._number, self._rows = 1, 0, 0
        self._pieces: list[tuple[int, dict[str, pl.Series]]] = []

    def add(self, block: pl.DataFrame) -> None:
        """Take every so many pieces of a block, and fewer as the table is longer."""
        for piece in block.iter_slices(PIECE):
            if self._number % self._every == 0:
                # A slice would keep the whole block in memory.
                columns = {one.name: pl.Series(one.to_list(), dtype=one.dtype) for one in piece}
                self._pieces.append((self._number, columns))
                self._rows += piece.height
            self._number += 1
            if self._rows > MOST_ROWS:
                self._every *= 2
                self._pieces = [one for one in self._pieces if one[0] % self._every == 0]
                self._rows = sum(len(next(iter(columns.values()))) for _, columns in self._pieces)

    def texts(self, name: str) -> pl.Series:
        """Return the cells of a column that were read as texts."""
        held = [columns[name] for _, columns in self._pieces]
        texts = [cells for cells in held if cells.dtype == pl.String]
        return pl.concat(texts) if texts else pl.Series(dtype=pl.String)

    def numbers(self, name: str, reading: Reading) -> Array:
        """Return the numbers of a column."""
        pieces = [reading.numbers(columns[name]) for _, columns in self._pieces]
        return np.concatenate(pieces) if pieces else np.zeros(0)


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class Table:
    """
    Chosen columns of a log that was looked through: how each is read, by name.

    `notes` says in a sentence each what could not be read; `left_out` says why of columns;
    `doubts` says of numbers what else they may be, by the decimal sign that they would have then,
    and of dates by the word `order`; `decision` is the decimal sign of the table; `sample` spans
    it.

    """

    path: Path
    readings: dict[str, Reading]
    rows: int
    notes: tuple[str, ...]
    left_out: Mapping[str, str]
    doubts: Mapping[str, str]
    decision: Decision
    source: Source
    sample: Sample

    @property
    def first_row(self) -> int:
        """Return the row of the file in which the first cells stand."""
        return self.source.head.first

    def blocks(self, names: Collection[str] | None = None) -> Iterator[dict[str, Array]]:
        """Yield columns (None: all) in blocks of rows, NaN where there is no number, times [s]."""
        chosen = list(self.readings if names is None else names)
        for block in self.source.blocks(chosen, self._types(chosen)):
            yield {name: self.readings[name].numbers(block[name]) for name in chosen}

    def blocks_with_holes(
        self, names: Collection[str], hollow: str = ''
    ) -> Iterator[tuple[dict[str, Array], NDArray[np.bool_] | None]]:
        """Yield blocks as `blocks` does, and in which rows the column `hollow` has no sample."""
        read = list(dict.fromkeys([*names, *filter(None, [hollow])]))
        for block in self.source.blocks(read, self._types(read)):
            numbers = {name: self.readings[name].numbers(block[name]) for name in names}
            yield numbers, empties(block[hollow]) if hollow else None

    def _types(self, names: Collection[str]) -> dict[str, Any]:
        """Return the types of those columns whose cells are all plain numbers."""
        return {name: kind for name in names if (kind := self.readings[name].plain) is not None}

    def sampled(self, name: str) -> Array:
        """Return a column in rows that span the table, in pieces of rows in a row."""
        return self.sample.numbers(name, self.readings[name])

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


def open_table(
    log: Path | Source,
    names: Collection[str],
    *,
    layout: Layout | None = None,
    decimal: str = '',
    order: str = '',
    optional: Collection[str] = (),
    marks: Mapping[str, Marks] | None = None,
    shown: Shown = shown_progress,
) -> Table:
    """
    Look through the columns `names` of a log by the `marks` of some, and show how far that is.

    Raises InputError when one is missing, holds no number, or holds numbers that may be others
    unless the `decimal` sign is stated; an `optional` one without a number is left out.

    """
    source = log if isinstance(log, Source) else source_of(log, layout)
    of_marks = [one.column for each in (marks or {}).values() for one in each.held]
    _check_names(source, [*names, *of_marks], layout)
    source = source.marked(marks or {})
    table = look_through(
        source, names, decimal=decimal, order=order, optional=optional, shown=shown
    )
    for doubt in table.doubts.values():
        raise InputError(doubt)
    return table


def look_through(
    source: Source,
    names: Collection[str],
    *,
    decimal: str = '',
    order: str = '',
    optional: Collection[str] = (),
    shown: Shown = shown_progress,
) -> Table:
    """Look through columns that a table holds, as `open_table` does, but keep the doubts."""
    left_out: dict[str, str] = {}
    columns = {
        name: Cells(
            source.path,
            name,
            first_row=source.head.first,
            order=order,
            none=source.none.get(name, ()),
        )
        for name in names
    }
    rows, types, sample = 0, dict[str, Any](), Sample()
    with shown(source.rows, 'rows looked through') as show:
        for block in source.blocks(list(columns), types):
            _check_names_within(source, block, source.head.first + rows)
            for name, cells in columns.items():
                if name in left_out:
                    continue
                with _left_out(name, left_out, optional):
                    cells.add(block[name])
                    types[name] = cells.plain
                if name in left_out or types[name] is None:
                    types.pop(name, None)
            sample.add(block)
            rows += block.height
            show(rows / source.rows)
    if not rows:
        raise InputError(f'log {source.path} holds no row, at least two are needed')
    short_rows = _short_rows(source, rows)
    decision = _decision(source, columns, decimal)
    shown_order = order or _order(source, columns)
    may_be_german = decision.sign == ',' and not shown_order
    german = [one for one in columns.values() if may_be_german and one.is_dotted]
    shown_order = GERMAN if german else shown_order
    readings: dict[str, Reading] = {}
    doubts: dict[str, str] = {}
    for name, cells in columns.items():
        if name in left_out:
            continue
        with _left_out(name, left_out, optional):
            if name in source.numeric:
                readings[name] = cells.reading('.', shown_order)
                continue
            readings[name] = cells.reading(decision.sign, shown_order)
            for sign, doubt in decision.doubt(cells.where, cells.signs).items():
                doubts.setdefault(sign, doubt)
            if fault := cells.signs.fault(sample.texts(name), decision.sign):
                doubts.setdefault('.', f'{cells.where} {fault}')
            if doubt := cells.doubt(shown_order):
                doubts.setdefault('order', doubt)
    return Table(
        path=source.path,
        readings=readings,
        rows=rows,
        notes=(
            *source.notes,
            *short_rows,
            *(one.note for one in readings.values() if one.note),
            *(one.decided for name, one in columns.items() if name in readings and one.decided),
            *_decided(source, columns, decision),
            *(
                f'{one.where} holds dates of {ORDERS[GERMAN]}: points part them, and the comma is '
                'decimal'
                for one in german
            ),
        ),
        left_out=left_out,
        doubts=doubts,
        decision=decision,
        source=source,
        sample=sample,
    )


def _check_names_within(source: Source, block: pl.DataFrame, first: int) -> None:
    """Raise InputError for a row of other names or units, below which columns hold others."""
    if len(block.columns) < 2 or any(kind != pl.String for kind in block.dtypes):
        return  # a word in a single column is a cell without a number
    words = block.with_row_index(ROW).filter(
        pl.all_horizontal(pl.all().exclude(ROW).str.contains(WORD))
    )
    for row, *cells in words.iter_rows():
        if heads.are_other_names(cells, block.columns):
            raise InputError(
                f'log {source.path}: row {first + row} names or measures its columns otherwise '
                f'than the head, {listed(cells)}: split the log there'
            )


def _short_rows(source: Source, rows: int) -> list[str]:
    """Return in a sentence how many rows hold other numbers of cells; raises for too many."""
    short, names = source.short, len(source.head.names)
    if not short.count:
        return []
    which = {0: 'fewer', short.count: 'more'}.get(short.longer, 'fewer or more')
    words = (
        f'log {source.path}: {counted(short.count, "row")} of {rows} with {which} cells than the '
        f'{names} columns, the first is row {short.first} with {short.cells}'
    )
    if short.count > max(1, SHORT * rows):
        if short.longer and short.cells > names:
            raise InputError(f'log {source.path}: {source.head.surplus(short.first, short.cells)}')
        raise InputError(f'{words}: write an empty cell where a column has no value')
    return [f'{words}; left out']


def _decided(source: Source, columns: Mapping[str, Cells], decision: Decision) -> list[str]:
    """Return in a sentence by what numbers are read that could be others, if there are any."""
    cells = [
        one.signs.doubtful
        for name, one in columns.items()
        if one.signs.doubtful and name not in source.numeric
    ]
    if not cells or not decision.words:
        return []
    sign, cell = next(iter(cells[0].items()))
    number = cell.number(decimal=sign == decision.sign, sign=sign)
    return [f'log {source.path}: {decision.words}: {cell.words} is {number}']


def _order(source: Source, columns: Mapping[str, Cells]) -> str:
    """Return the order that dates of the log or its head show, else nothing."""
    orders = {cells.order for cells in columns.values()} or {''}
    start = start_in_head(source.head).moments
    orders |= {*start} if len(start) == 1 else set()
    orders.discard('')
    return orders.pop() if len(orders) == 1 else ''


def _decision(source: Source, columns: Mapping[str, Cells], stated: str) -> Decision:
    """
    Return the decimal sign of a table; columns that are not read are asked where others doubt.

    True numbers of a workbook tell nothing about texts.

    """
    head = source.head
    if 'decimal' in head.properties and not stated:
        text = head.properties['decimal'].text.strip()
        stated = text if text in OTHER_SIGN else {'comma': ',', 'point': '.'}.get(text.lower(), '')
    signs = {name: cells.signs for name, cells in columns.items() if name not in source.numeric}
    decision = decide(signs, stated, _usual(source, signs))
    if decision.proofs or stated or not any(one.doubtful for one in signs.values()):
        return decision
    first = source.first_rows()
    for name in source.names():
        if name not in {*columns, *source.numeric} and first[name].dtype == pl.String:
            cells = Cells(source.path, name, first_row=head.first)
            cells.add(first[name])
            numbers = [one.good for one in cells.numbers]
            signs |= {name: cells.signs} if 2 * max(numbers, default=0) > cells.count else {}
    return decide(signs, stated, _usual(source, signs))


def _usual(source: Source, signs: Mapping[str, Signs]) -> str:
    """
    Return the sign that is decimal where no cell proves it, empty where that is not known.

    Between commas it is the point, if whole numbers above 999 stand without one. In a column of
    5.400 beside 60 it may part thousands, as no rule of decimals leaves the zeros out.

    """
    parted = any(one.may_part for one in signs.values())
    plain = any(one.most_whole >= THOUSAND for one in signs.values())
    is_usual = source.head.separator == ',' and plain and not parted
    return '.' if is_usual or source.is_pointed else ''


def _check_names(source: Source, names: Collection[str], layout: Layout | None) -> None:
    """Raise InputError for a column that a log does not hold, with what may be meant."""
    held = source.names()
    for name in names:
        if name not in held:
            hints = [
                f'{short(near)} may be meant'
                for near in difflib.get_close_matches(name, held, n=1)
            ]
            if layout is not None and name in source_of(source.path, sheet=source.sheet).names():
                hints.append('it is found without `skip` and `header_rows` in the map')
            if not source.head.named:
                hints.append('no line names them')
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
