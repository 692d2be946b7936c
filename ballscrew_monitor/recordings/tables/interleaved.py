# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Rows of several sources, by the column whose cells tell them apart."""

from collections.abc import Collection, Iterable, Sequence
import itertools

from ballscrew_monitor.recordings.tables.cells import Array
from ballscrew_monitor.recordings.tables.marked import look_at_marks
from ballscrew_monitor.recordings.tables.marks import MOST, plain_cell, tells_apart
from ballscrew_monitor.recordings.tables.names import base_of
from ballscrew_monitor.recordings.tables.sources import Source
from ballscrew_monitor.recordings.tables.unit_names import words_of
from ballscrew_monitor.recordings.words import listed, short
import numpy as np
import polars as pl

IN_TURN = 0.95  # of the rows, at least, differ from the other rows of their time
ROWS = 20_000  # that tell it
SHARED = 0.3  # of the rows, at least, share the time of the row before


def cells_of_sources(source: Source, used: Collection[str]) -> dict[str, list[str]]:
    """Return the cells of each column that names the axis or machine of its row, if not `used`."""
    held = [name for name in source.names() if name not in used]
    columns = [name for name in held if tells_apart(words_of(base_of(name)))]
    cells = look_at_marks(source.blocks(columns), columns)[1] if columns else {}
    return {column: each for column, each in cells.items() if len(each) <= MOST}


def of_several(column: str, cells: Sequence[str]) -> str:
    """Return what is wrong with rows of several axes or machines that a column tells apart."""
    return (
        f'its rows are of several axes or machines, which column {short(repr(column))} tells '
        f'apart: {listed(cells)}; save a log for each'
    )


def column_of_sources(
    blocks: Iterable[pl.DataFrame], names: Sequence[str], times: Array
) -> tuple[str, list[str]]:
    """
    Return the column that tells rows of one time [s] apart, or texts in turn, and its cells.

    A column of many different cells is a quantity of its own. Both are empty if there is none.

    """
    columns: dict[str, list[str]] = {name: [] for name in names}
    rows = 0
    for block in blocks:
        for name in [*columns]:
            columns[name] += map(plain_cell, block[name].head(ROWS - rows).to_list())
            if len({*columns[name]}) > MOST:
                del columns[name]
        rows += block.height
        if rows >= ROWS or not columns:
            break
    for name, cells in columns.items():
        if len({*cells} - {''}) > 1 and _tells_apart(cells, times[: len(cells)]):
            return name, sorted({*cells} - {''})
    return '', []


def _tells_apart(cells: Sequence[str], times: Array) -> bool:
    """Return True if cells of rows at times [s] do so; an empty one tells nothing."""
    filled = [at for at, cell in enumerate(cells[: len(times)]) if cell]
    cells, times = [cells[at] for at in filled], times[filled]
    if len(cells) < 2:
        return False
    changes = np.array([one != other for one, other in itertools.pairwise(cells)])
    of_texts = not any(letter.isdigit() for letter in cells[0])
    if of_texts and changes.mean() >= IN_TURN:
        return True
    shared = np.diff(times) == 0.0
    if shared.mean() < SHARED or changes[shared].mean() < IN_TURN:
        return False
    rows = {*zip(times.tolist(), cells, strict=True)}
    return len(rows) >= IN_TURN * len(cells)
