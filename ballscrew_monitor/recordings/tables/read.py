# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Numbers out of a table, in blocks of rows: a log may be larger than memory.

A log is looked through once to learn how its cells are numbers. A cell without a number is NaN and
counted; what cannot be read at all is one sentence in an InputError.

"""

from collections.abc import Collection, Iterator
import contextlib
import dataclasses
from pathlib import Path

from ballscrew_monitor.recordings.tables.cells import Array, Cells, Reading
from ballscrew_monitor.recordings.tables.quantities import Layout
from ballscrew_monitor.recordings.tables.sources import Source, source_of
from ballscrew_monitor.recordings.words import Shown, shown_progress
import numpy as np
from surrogate.files import InputError


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class Table:
    """
    Chosen columns of a log that was looked through: how each is read, by name.

    `notes` says in a sentence each what could not be read.

    """

    path: Path
    readings: dict[str, Reading]
    rows: int
    notes: tuple[str, ...]
    _source: Source

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
    strict: bool = True,
    shown: Shown = shown_progress,
) -> Table:
    """
    Look through the columns `names` of a log, and show how far that is.

    Raises InputError when one is missing, or holds no number; unless `strict` such a one is left
    out with a note.

    """
    source = source_of(path, layout)
    held = source.names()
    for name in names:
        if name not in held:
            raise InputError(
                f'log {path}: column {name!r} is missing, the log holds {", ".join(held)}'
            )
    notes: list[str] = []
    found = {name: Cells(path, name, source.separator) for name in names}
    rows = 0
    with shown(source.rows, 'rows looked through') as show:
        for block in source.blocks(list(found)):
            for name, cells in list(found.items()):
                with _left_out(name, found, notes, strict=strict):
                    cells.add(block[name])
            rows += block.height
            show(rows / source.rows)
    if not rows:
        raise InputError(f'log {path} holds no row, at least two are needed')
    readings: dict[str, Reading] = {}
    for name, cells in list(found.items()):
        with _left_out(name, found, notes, strict=strict):
            readings[name] = cells.reading()
            notes += [readings[name].note] if readings[name].note else []
    return Table(path=path, readings=readings, rows=rows, notes=tuple(notes), _source=source)


@contextlib.contextmanager
def _left_out(
    name: str, found: dict[str, Cells], notes: list[str], *, strict: bool
) -> Iterator[None]:
    """Leave out a column that cannot be read, with a note, unless that is an error."""
    try:
        yield
    except InputError as error:
        if strict:
            raise
        found.pop(name)
        notes.append(f'{error}; it is left out')
