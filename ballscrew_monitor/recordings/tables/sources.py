# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Tables as they stand in files: CSV, Parquet or a sheet of xlsx, one frame of cells for each.

A CSV may be of UTF-8, UTF-16 with a mark, or one byte for a letter, and its lines may end by a
line feed, a carriage return or both. All is bounded before it is read.

"""

from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
import contextlib
import csv
import dataclasses
import functools
import io
import itertools
import math
from pathlib import Path
from typing import Any, BinaryIO

from ballscrew_monitor.recordings.tables import heads
from ballscrew_monitor.recordings.tables.cells import first_line, readable
from ballscrew_monitor.recordings.tables.quantities import Layout
from ballscrew_monitor.recordings.tables.workbook import first_sheet
from ballscrew_monitor.recordings.words import short
import numpy as np
from numpy.typing import NDArray
import polars as pl
from surrogate import limits
from surrogate.child import result_apart
from surrogate.files import InputError

HEAD = 65536  # [bytes] of a file that tell what it is
LINES = 200  # of a table that tell where its names stand
SHORT = 4096  # [bytes] of a block, in which a line usually ends
BLOCK = 32768  # rows that are read at a time
PART = 4 * limits.MEGA  # [bytes] of a text that are read at a time
ZIP, PARQUET = b'PK\3\4', b'PAR1'
WIDE_MARKS = (b'\xff\xfe', b'\xfe\xff')
NARROW_MARK = b'\xef\xbb\xbf'
CODINGS = ('utf-8', 'cp1252', 'latin-1')
"""Codings of a line, the first that fits; the last fits always."""


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class Source:
    """
    A table as it stands in a file: the separator of its cells if it has one, rows about.

    Its first cells stand in the row `first` of the file; lines that begin with # do not count.
    The columns that are read may come to `most` [bytes]: those at rest take next to no room in a
    file of Parquet, so that all of them together tell nothing.
    `parts` reads some columns of a text part by part.

    """

    path: Path
    frame: pl.LazyFrame
    separator: str
    rows: int
    first: int = 1
    most: float = math.inf
    parts: Callable[[list[str]], Iterator[pl.DataFrame]] | None = None

    def names(self) -> list[str]:
        """Return the names of all columns."""
        with readable(f'log {self.path} cannot be read'):
            return self.frame.collect_schema().names()

    def head(self) -> pl.DataFrame:
        """Return the first rows of all columns; raises InputError."""
        with readable(f'log {self.path} cannot be read'):
            return self.frame.head(LINES).collect()

    def blocks(self, names: Collection[str]) -> Iterator[pl.DataFrame]:
        """Yield the columns `names` in blocks of rows; none is empty. Raises InputError."""
        come_to = limits.PARQUET_CELL * self.rows * len(names)
        if come_to > self.most:
            raise InputError(
                f'log {self.path}: {len(names)} columns of {self.rows} rows come to '
                f'{come_to / limits.MEGA:.0f} MB, allowed are {limits.PACKING} times the size of '
                'the file'
            )
        with readable(f'log {self.path} cannot be read'):
            chosen = self.frame.select(list(names))
            batches = chosen.collect_batches(chunk_size=BLOCK, lazy=True)
            for batch in self.parts(list(names)) if self.parts else batches:
                yield from batch.iter_slices(BLOCK) if batch.height else ()


def source_of(path: Path, layout: Layout | None = None) -> Source:
    """Return the table in a file, its cells as they stand; raises InputError without one."""
    head = _head_of(path)
    if head.startswith(PARQUET):
        return _parquet(path)
    if head.startswith(ZIP):
        return _sheet(path, layout)
    return _text(path, layout, _Text.of(path, head))


def layout_of(path: Path) -> Layout:
    """Return where the names of the columns seem to stand in a file."""
    head = _head_of(path)
    if head.startswith(PARQUET):
        return Layout()
    if head.startswith(ZIP):
        return heads.found_layout(_rows_of(_cells_of_sheet(path)))
    return _Text.of(path, head).layout()


def _head_of(path: Path) -> bytes:
    try:
        with path.open('rb') as stream:
            head = stream.read(HEAD)
    except OSError as error:
        raise InputError(f'log {path} cannot be read: {error.strerror}') from None
    if not head.strip():
        raise InputError(f'log {path} is empty, it must be a CSV, Parquet or xlsx file')
    return head


def _parquet(path: Path) -> Source:
    rows, names = _shape_of_parquet(path)
    _check_columns(path, len(names))
    most = max(limits.most_unpacked(path.stat().st_size), limits.WORKBOOK)
    named = pl.scan_parquet(path).rename(dict(zip(names, heads.unlike(names))))
    return Source(path=path, frame=named, separator='', rows=max(rows, 1), most=most)


def _shape_of_parquet(path: Path) -> tuple[int, list[str]]:
    """Return rows and names of columns; a long footer may nest so deep that its reader dies."""
    inputs, failure = {'path': str(path)}, f'log {path} cannot be read'
    with path.open('rb') as stream:
        stream.seek(max(path.stat().st_size - len(PARQUET) - 4, 0))
        length = int.from_bytes(stream.read(4), 'little')
    if length > limits.FOOTER:
        task = f'{__name__}:parquet_shape'
        shape = result_apart(task, inputs, memory=limits.MEMORY, failure=failure)
    else:
        shape = parquet_shape(inputs)
    return shape['rows'], shape['names']


def parquet_shape(inputs: Mapping[str, str]) -> dict[str, Any]:
    """Return rows and names of columns of the Parquet file `path`; raises InputError."""
    with readable(f'log {inputs["path"]} cannot be read', Exception):
        frame = pl.scan_parquet(inputs['path'])
        rows = int(frame.select(pl.len()).collect().item())
        schema = frame.collect_schema()
    for name, kind in schema.items():
        if not _is_within(limits.DEPTH, kind):
            raise InputError(
                f'log {inputs["path"]}: column {short(repr(name))} nests deeper than '
                f'{limits.DEPTH}, it must hold numbers: leave it out of the file'
            )
    return {'rows': rows, 'names': schema.names()}


def _is_within(depth: int, kind: Any) -> bool:
    """Return True if a type nests no deeper than a depth."""
    kinds = [kind]
    for _ in range(depth + 1):
        if not kinds:
            return True
        kinds = [inner for kind in kinds for inner in _inner(kind)]
    return not kinds


def _inner(kind: Any) -> list[Any]:
    if isinstance(kind, pl.Struct):
        return [field.dtype for field in kind.fields]
    return [kind.inner] if isinstance(kind, pl.List | pl.Array) else []


def _sheet(path: Path, layout: Layout | None) -> Source:
    """Return the first sheet of a workbook; raises ImportError without its reader."""
    cells = _cells_of_sheet(path)
    found = layout or Layout()
    begin, end = found.skip, found.skip + found.header_rows
    if cells.height < end:
        raise InputError(f'log {path} has {cells.height} rows, none of them names its columns')
    names = heads.names_of(_rows_of(cells[begin:end]))
    frame = cells[end:].rename(dict(zip(cells.columns, names)))
    return Source(
        path=path, frame=frame.lazy(), separator='', rows=max(frame.height, 1), first=end + 1
    )


def _cells_of_sheet(path: Path) -> pl.DataFrame:
    cells = first_sheet(path)
    _check_columns(path, cells.width)
    return cells


def _rows_of(cells: pl.DataFrame) -> list[list[str]]:
    return [[cell or '' for cell in row] for row in cells.head(LINES).iter_rows()]


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class _Text:
    """A CSV file, or its content where that had to be decoded; and what ends its lines."""

    path: Path
    content: bytes | None
    line_end: str
    lines_about: int

    @classmethod
    def of(cls, path: Path, head: bytes) -> '_Text':
        content, size = None, path.stat().st_size
        if head.startswith(WIDE_MARKS):
            content = _narrow(path, size)
            head, size = content[:HEAD], len(content)
        if b'\0' in head:
            raise InputError(f'log {path} is no text, it must be a CSV, Parquet or xlsx file')
        line_end = '\n' if b'\n' in head or b'\r' not in head else '\r'
        lines = max(head.count(line_end.encode()), 1) * size // len(head)
        return cls(path=path, content=content, line_end=line_end, lines_about=max(lines, 1))

    def stream(self) -> BinaryIO:
        return self.path.open('rb') if self.content is None else io.BytesIO(self.content)

    def layout(self) -> Layout:
        """Return where the names of the columns seem to stand."""
        with self.lines() as lines:
            return heads.found_in_lines(_first_of(lines))

    @contextlib.contextmanager
    def lines(self) -> Iterator[Iterator[str]]:
        """Give its lines."""
        with self.stream() as stream:
            if stream.read(len(NARROW_MARK)) != NARROW_MARK:
                stream.seek(0)
            # First a letter for each byte, so that no byte is a fault.
            text = io.TextIOWrapper(stream, CODINGS[-1], newline=self.line_end)
            yield map(_decoded, _bounded(self.path, text))


def _bounded(path: Path, text: io.TextIOWrapper) -> Iterator[str]:
    """Yield the lines of a text; raises InputError for one that is longer than allowed."""
    while line := text.readline(limits.LINE + 1):
        if len(line) > limits.LINE:
            raise _too_long(path)
        yield line


def _first_of(lines: Iterator[str]) -> list[str]:
    """Return the lines that tell what a table is, up to the length of one."""
    first, size = list[str](), 0
    for line in itertools.islice(lines, LINES):
        size += len(line)
        if first and size > limits.LINE:
            break
        first.append(line)
    return first


def _too_long(path: Path) -> InputError:
    return InputError(
        f'log {path} has a line of more than {limits.LINE // limits.MEGA} MB, a table has '
        'shorter ones'
    )


def _narrow(path: Path, size: int) -> bytes:
    """Return a text of UTF-16 in UTF-8; raises InputError."""
    if size > limits.WORKBOOK:
        raise InputError(
            f'log {path} of UTF-16 has more than {limits.WORKBOOK // limits.MEGA} MB: save it as '
            'UTF-8'
        )
    try:
        return path.read_bytes().decode('utf-16').encode()
    except UnicodeError as error:
        raise InputError(f'log {path} cannot be read as UTF-16: {first_line(error)}') from None


def _text(path: Path, layout: Layout | None, text: _Text) -> Source:
    with text.stream() as stream:
        plain, comments = _look_at_lines(path, stream, text.line_end.encode())
    found = layout or Layout()
    with text.lines() as lines:
        head = _named(path, lines, found)
    _check_columns(path, len(head.names))
    options: dict[str, Any] = {
        'separator': head.separator,
        # What it holds none of is not looked for, which takes as long as the cells themselves.
        'encoding': 'utf8' if plain else 'utf8-lossy',
        'comment_prefix': heads.COMMENT if comments else None,
        'truncate_ragged_lines': True,
        'eol_char': text.line_end,
        'infer_schema': False,
        'raise_if_empty': False,
    }
    first = {'skip_lines': head.lines, 'skip_rows_after_header': found.header_rows - 1}

    def scanned(content: Path | bytes, **more: Any) -> pl.LazyFrame:
        renamed = functools.partial(_renamed, head.names)
        return pl.scan_csv(content, with_column_names=renamed, **options, **more)

    def parts(names: list[str]) -> Iterator[pl.DataFrame]:
        # Names for as many columns stand before each part but the first.
        line = head.separator.join(map(str, range(len(source.names())))) + text.line_end
        with text.stream() as stream:
            layout_of_part = first
            for part in _parts(stream, text.line_end.encode(), line.encode(), head.first):
                yield scanned(part, **layout_of_part).select(names).collect()
                layout_of_part = {}

    source = Source(
        path=path,
        frame=scanned(path if text.content is None else text.content, **first),
        separator=head.separator,
        rows=text.lines_about,
        first=head.first,
        parts=parts,
    )
    return source


def _parts(stream: BinaryIO, line_end: bytes, line: bytes, first: int) -> Iterator[bytes]:
    """
    Yield a text in parts that end with a line, and begin with another one from the second on.

    The first has as many lines as the row `first`. Of a whole text, polars would read much ahead.

    """
    held, quoted, block, lines = [b''], False, stream.read(PART), 0
    while block:
        following = stream.read(PART)
        end = _line_ends(block, line_end, quoted)[1] + 1 if following else len(block)
        quoted ^= _is_odd(block)
        if lines < first:
            lines += block.count(line_end)
        if end and (lines >= first or not following):
            yield b''.join([*held, memoryview(block)[:end]])
            held = [line, block[end:]]
        else:
            held.append(block)
        block = following


def _is_odd(block: bytes) -> bool:
    """Return True if a text has an odd number of quotes."""
    return b'"' in block and block.count(b'"') % 2 == 1


def _renamed(names: Sequence[str], held: Sequence[str]) -> list[str]:
    """Return `names` for columns, and for those beyond what they are called there."""
    count, most = len(names), len(held)
    return [*names[:most], *held[count:]]


def _named(path: Path, lines: Iterator[str], layout: Layout) -> heads.Head:
    try:
        return heads.read_head(lines, layout)
    except (csv.Error, ValueError) as error:
        raise InputError(f'log {path} cannot be read: {first_line(error)}') from None


def _decoded(line: str) -> str:
    """Return a line of which each letter is a byte in the first coding that fits."""
    for coding in CODINGS[:-1]:
        with contextlib.suppress(UnicodeError):
            return line.encode(CODINGS[-1]).decode(coding)
    return line


def _check_columns(path: Path, count: int) -> None:
    if count > limits.COLUMNS:
        raise InputError(f'log {path} has {count} columns, allowed are {limits.COLUMNS}')


def _look_at_lines(path: Path, stream: BinaryIO, line_end: bytes) -> tuple[bool, bool]:
    """
    Return whether a text is of ASCII alone, and whether it may hold comments.

    Raises InputError if a line is longer than allowed, those within quotes counted as one.

    """
    length, quoted = 0, False  # of the line so far [bytes]
    plain, comments = True, False
    while block := stream.read(limits.MEGA):
        plain &= block.isascii()
        comments |= heads.COMMENT.encode() in block
        first, last = _line_ends(block, line_end, quoted)
        length += len(block) if first < 0 else first
        if length > limits.LINE:
            raise _too_long(path)
        if first >= 0:
            length = len(block) - last - 1
        quoted ^= _is_odd(block)
    return plain, comments


def _line_ends(block: bytes, line_end: bytes, quoted: bool) -> tuple[int, int]:
    """Return where the first and the last line end that do so outside of quotes, -1 if none."""
    if b'"' not in block:
        return (-1, -1) if quoted else (block.find(line_end), block.rfind(line_end))
    for size in (SHORT, len(block)):  # of most blocks a little at both ends tells it
        rest = max(len(block) - size, 0)
        first = _outside(block[:size], line_end, quoted)
        last = _outside(block[rest:], line_end, quoted ^ (block[:rest].count(b'"') % 2 == 1))
        if len(first) and len(last):
            return int(first[0]), rest + int(last[-1])
    return -1, -1


def _outside(block: bytes, line_end: bytes, quoted: bool) -> NDArray[np.intp]:
    """Return where lines end outside of quotes."""
    letters = np.frombuffer(block, np.uint8)
    inside = (np.cumsum(letters == ord('"')) + quoted) % 2
    return np.flatnonzero((letters == ord(line_end)) & (inside == 0))
