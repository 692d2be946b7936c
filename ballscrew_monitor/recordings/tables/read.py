# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Numbers out of a CSV or Parquet file, in blocks of rows: a log may be larger than memory.

A log is looked through once to learn how its cells are numbers. A cell without a number is NaN and
counted; what cannot be read at all is one sentence in an InputError.

"""

from collections.abc import Collection, Iterator
import contextlib
import dataclasses
from pathlib import Path
import re

from ballscrew_monitor.recordings.tables.cells import Array, Cells, first_line, Reading, UNREADABLE
from ballscrew_monitor.recordings.words import Shown, shown_progress
import numpy as np
import polars as pl
from surrogate import limits
from surrogate.files import InputError

SEPARATORS = (',', ';', '\t', '|')
COMMENT = '#'
QUOTED = re.compile('"[^"]*"')
HEAD = 65536  # [bytes] of a file that tell what it is
BLOCK = 32768  # rows that are read at a time
NUMBER = 8  # [bytes] of a cell


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class _Source:
    """A table as it stands in a file, the separator of its cells if it has one, rows about."""

    path: Path
    frame: pl.LazyFrame
    separator: str
    rows: int

    def names(self) -> list[str]:
        with _readable(self.path):
            return self.frame.collect_schema().names()

    def blocks(self, names: Collection[str]) -> Iterator[pl.DataFrame]:
        """Yield the columns `names` in blocks of rows; none is empty."""
        with _readable(self.path):
            batches = self.frame.select(list(names)).collect_batches(chunk_size=BLOCK, lazy=True)
            for batch in batches:
                yield from batch.iter_slices(BLOCK) if batch.height else ()


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
    _source: _Source

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


def column_names(path: Path) -> list[str]:
    """Return the names of all columns of a log; raises InputError when it is no table."""
    return _source(path).names()


def open_table(
    path: Path, names: Collection[str], *, strict: bool = True, shown: Shown = shown_progress
) -> Table:
    """
    Look through the columns `names` of a log, and show how far that is.

    Raises InputError when one is missing, or holds no number; unless `strict` such a one is left
    out with a note.

    """
    source = _source(path)
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


def _source(path: Path) -> _Source:
    """Return the table in a file, its cells as they stand; raises InputError without one."""
    try:
        with path.open('rb') as stream:
            head = stream.read(HEAD)
        size = path.stat().st_size
    except OSError as error:
        raise InputError(f'log {path} cannot be read: {error.strerror}') from None
    if not head.strip():
        raise InputError(f'log {path} is empty, it must be a CSV or Parquet file')
    if head.startswith(b'PAR1'):
        frame = pl.scan_parquet(path)
        with _readable(path):
            rows = int(frame.select(pl.len()).collect().item())
            columns = len(frame.collect_schema())
        _check_columns(path, columns)
        if NUMBER * rows * columns > max(limits.PACKING * size, limits.CHUNK):
            raise InputError(
                f'log {path} of {size} bytes holds {rows} rows of {columns} columns, allowed are '
                f'{limits.PACKING} times its size'
            )
        return _Source(path=path, frame=frame, separator='', rows=max(rows, 1))
    if b'\0' in head:
        raise InputError(f'log {path} is no text, it must be a CSV or Parquet file')
    _check_lines(path)
    header = _header(path)
    separator = max(SEPARATORS, key=header.count)
    _check_columns(path, header.count(separator) + 1)
    frame = pl.scan_csv(
        path,
        separator=separator,
        infer_schema=False,
        encoding='utf8-lossy',
        comment_prefix=COMMENT,
        truncate_ragged_lines=True,
    )
    lines = max(head.count(b'\n'), 1) * size // len(head)
    return _Source(path=path, frame=frame, separator=separator, rows=lines)


def _check_columns(path: Path, count: int) -> None:
    if count > limits.COLUMNS:
        raise InputError(f'log {path} has {count} columns, allowed are {limits.COLUMNS}')


def _check_lines(path: Path) -> None:
    """Raise InputError if a line is longer than allowed, those within quotes counted as one."""
    length, quoted = 0, False  # of the line so far [bytes]
    with path.open('rb') as stream:
        while block := stream.read(limits.MEGA):
            first, last = _line_ends(block, quoted)
            length += len(block) if first < 0 else first
            if length > limits.LINE:
                raise InputError(
                    f'log {path} has a line of more than {limits.LINE // limits.MEGA} MB, a table '
                    'has shorter ones'
                )
            if first >= 0:
                length = len(block) - last - 1
            quoted ^= block.count(b'"') % 2 == 1


def _line_ends(block: bytes, quoted: bool) -> tuple[int, int]:
    """Return where the first and the last line end that do so outside of quotes, -1 if none."""
    if b'"' not in block:
        return (-1, -1) if quoted else (block.find(b'\n'), block.rfind(b'\n'))
    letters = np.frombuffer(block, np.uint8)
    inside = (np.cumsum(letters == ord('"')) + quoted) % 2
    ends = np.flatnonzero((letters == ord('\n')) & (inside == 0))
    return (int(ends[0]), int(ends[-1])) if len(ends) else (-1, -1)


def _header(path: Path) -> str:
    """Return the first line that is no comment, without what is quoted in it; empty if none."""
    with path.open('rb') as stream:
        while line := stream.readline(limits.LINE).decode('utf-8-sig', 'replace'):
            if line.strip() and not line.startswith(COMMENT):
                return QUOTED.sub('', line.splitlines()[0])
    return ''


@contextlib.contextmanager
def _readable(path: Path) -> Iterator[None]:
    """Raise InputError for whatever the reader of tables raises."""
    try:
        yield
    except UNREADABLE as error:
        raise InputError(f'log {path} cannot be read: {first_line(error)}') from None
