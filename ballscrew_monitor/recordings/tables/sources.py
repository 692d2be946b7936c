# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Tables as they stand in files: CSV, Parquet or a sheet of xlsx, one frame of cells for each.

A CSV may be of UTF-8, UTF-16, UTF-32 or one byte for a letter, or packed by gzip, and its lines
may end by a line feed, a carriage return or both. All is bounded before it is read.

"""

from collections.abc import Collection, Iterator, Mapping, Sequence
import contextlib
import csv
import dataclasses
import io
import math
from pathlib import Path
import re
from typing import Any, BinaryIO

from ballscrew_monitor.recordings.tables import codings, foreign, heads, json_layouts
from ballscrew_monitor.recordings.tables.cell_units import plain_columns, plainly
from ballscrew_monitor.recordings.tables.cells import empties, first_line, Read, readable
from ballscrew_monitor.recordings.tables.heads import Head, Line
from ballscrew_monitor.recordings.tables.joined_times import joined_time, joining
from ballscrew_monitor.recordings.tables.lines import (
    are_torn,
    NAMES_OF_SIGNS,
    TORN_TIME,
    unread_separator,
    WHOLE,
)
from ballscrew_monitor.recordings.tables.marked import marked
from ballscrew_monitor.recordings.tables.marks import Marks
from ballscrew_monitor.recordings.tables.quantities import Layout
from ballscrew_monitor.recordings.tables.sections import END_OF_HEAD, HEADS, joined_sections, MARK
from ballscrew_monitor.recordings.tables.workbook import holds_formulas_alone, lines_of, read_sheet
from ballscrew_monitor.recordings.words import counted, listed, short
import numpy as np
from numpy.typing import NDArray
import polars as pl
from polars.exceptions import PolarsError
from surrogate.files import InputError, limits
from surrogate.tasks.child import result_apart

HEAD = 65536  # [bytes] of a file that tell what it is
LINES = 2000  # of a table that tell where its numbers begin
FEWEST = 20  # rows of numbers of a log whose ending says nothing
SHORT = 4096  # [bytes] of a block, in which a line usually ends
BLOCK = 32768  # rows that are read at a time
PART = 4 * limits.MEGA  # [bytes] of a text that are read at a time
WINDOW = 2**18  # [bytes] of a part that are looked at a time
PANDAS_INDEX, TIME = '__index_level_0__', 'time'
"""What pandas calls a column of its index, and what that is where it holds moments."""
ZIP, PARQUET = b'PK\3\4', b'PAR1'
EDGES = re.compile(rb'^[ \t]+|[ \t]+(?=\r?$)', re.M)
SPACES = re.compile(rb'[ \t]+')
"""Blanks at the ends of lines, and between cells that they part."""
COMMENTS = ('comment', 'comments', 'kommentar', 'bemerkung', 'remark', 'remarks')
"""Names of a last column whose cells a row need not have."""
REMARK, LINE_FEED = re.compile(rb'^#(.*)$', re.M), b'\n'
NARROW_MARK = b'\xef\xbb\xbf'
LAST_WORDS = re.compile(rb'(?:(?<=\n)|(?<=\r))[\s*#=<>.-]*[A-Za-z][A-Za-z *#=<>.-]{0,40}\s*\Z')
"""A line at the end of a text that ends it by a word, as EOF, and is no row."""
AFTER_EMPTY = '"'
"""The last of the letters that may follow a sign before an empty cell: ends of lines, blanks."""
TRIES = (
    3  # parts of a text with cells that are not of their column's type, after which none has it
)
Types = Mapping[str, Any]
"""Types of columns of a text whose cells are known to be plain numbers."""


@dataclasses.dataclass(kw_only=True, slots=True)
class ShortRows:
    """
    Rows of other numbers of cells than a table has columns, the first of them and its cells.

    `longer` of them, of `count`, have more cells. A comment in the row `named`, 0 for none, names
    the columns again. `blanks` rows hold nothing at all, of which the first is `blank`.

    """

    named: int = 0
    blank: int = 0
    blanks: int = 0
    count: int = 0
    longer: int = 0
    first: int = 0
    cells: int = 0

    def left_out(
        self,
        rows: pl.DataFrame,
        widths: NDArray[np.int64],
        width: int,
        first: int,
        longer: NDArray[np.bool_],
    ) -> pl.DataFrame:
        """Return rows from `first` on, those of too few or more cells without any, and count."""
        if len(widths) != rows.height:
            return rows
        if blanks := int((widths == 0).sum()):
            self.blank = self.blank or first + int((widths == 0).argmax())
            self.blanks += blanks
        uneven = longer | ((widths > 0) & (widths < width))
        if not uneven.any():
            return rows
        if not self.count:
            at = int(uneven.argmax())
            self.first, self.cells = first + at, int(widths[at])
        self.count += int(uneven.sum())
        self.longer += int(longer.sum())
        return rows.select(pl.when(pl.Series(~uneven)).then(pl.all()))


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class Source:
    """
    A table as it stands in a file, what its head says, and its rows about.

    The columns that are read may come to `most` [bytes]: those at rest take next to no room in a
    file of Parquet, so that all of them together tell nothing. `read` reads some columns part by
    part, those of a text by their types where all cells of the part are of these. Of a workbook it
    is one `sheet`, whose days may count `from_1904`. `left_out` says why other sheets or arrays
    are not read, `more_rows` of which are of the same columns, `lengths` how many cells columns of
    groups hold, `arrays` how many those whose rows nothing but a time ties to others; `notes` say
    what is odd about it. Names of a source that `is_grouped` begin with that of a group. `none`
    are the numbers of columns that stand for no value, `short` the rows of too few cells since it
    began. The columns `numeric` hold true numbers, whose texts the reader has made; in a form that
    `is_pointed` by its rules, texts that show no decimal sign have a point.

    """

    path: Path
    head: Head
    rows: int
    read: Read
    most: float = math.inf
    sheet: str = ''
    from_1904: bool = False
    left_out: Mapping[str, str] = dataclasses.field(default_factory=dict)
    more_rows: int = 0
    lengths: Mapping[str, int] = dataclasses.field(default_factory=dict)
    arrays: Mapping[str, int | None] = dataclasses.field(default_factory=dict)
    notes: tuple[str, ...] = ()
    is_grouped: bool = False
    none: Mapping[str, Sequence[float]] = dataclasses.field(default_factory=dict)
    short: ShortRows = dataclasses.field(default_factory=ShortRows)
    numeric: frozenset[str] = frozenset()
    is_pointed: bool = False

    def names(self) -> list[str]:
        """Return the names of all columns."""
        return list(self.head.names)

    def marked(self, marks: Mapping[str, Marks]) -> 'Source':
        """Return it with the columns that are marked read by their marks."""
        none = {name: one.numbers_of_none for name, one in marks.items()}
        read = marked(self.read, marks) if marks else self.read
        return dataclasses.replace(self, read=read, none={**self.none, **none})

    def plain(self, cells: Mapping[str, Sequence[str]]) -> 'Source':
        """Return it with plain cells where some cells of a column show that they are none."""
        with _findable(self.path):
            columns = plain_columns(cells)
        if not columns:
            return self
        renamed = {name: new for name, (new, _) in columns.items()}
        arrays = {renamed.get(name, name): count for name, count in self.arrays.items()}
        head, read = self.head.renamed(renamed), plainly(self.read, columns)
        lengths = {renamed.get(name, name): count for name, count in self.lengths.items()}
        numeric = frozenset(renamed.get(name, name) for name in self.numeric)
        return dataclasses.replace(
            self, head=head, read=read, arrays=arrays, lengths=lengths, numeric=numeric
        )

    def joined(self) -> 'Source':
        """Return it with one column of times in the place of several with their parts."""

        def first_rows(names: list[str]) -> pl.DataFrame:
            with readable(f'log {self.path} cannot be read'):
                return next((part.head(LINES) for part in self.read(names, {})), pl.DataFrame())

        names = self.names()
        time = joined_time(names, first_rows)
        if not time.name:
            return self
        parts = set(time.columns.values())
        place = min(map(names.index, parts))
        left = [name for name in names if name not in parts]
        head = dataclasses.replace(self.head, names=(*left[:place], time.name, *left[place:]))
        return dataclasses.replace(self, head=head, read=joining(self.read, time))

    def unread(self, columns: Collection[str]) -> dict[str, str]:
        """Return why parts of the file are not read: also groups with none of the columns."""
        if not self.is_grouped:
            return dict(self.left_out)
        groups = {name: _group_of(name) for name in self.names()}
        others = {*groups.values()} - {'', *(groups[name] for name in columns)}
        why = 'the map names none of its columns'
        return {**self.left_out, **dict.fromkeys(sorted(others), why)}

    def rows_alike(self, columns: Collection[str]) -> int:
        """Return the rows of parts that are not read though they hold the same columns."""
        groups: dict[str, dict[str, int]] = {}
        for name, length in self.lengths.items():
            group = _group_of(name)
            groups.setdefault(group, {})[name.removeprefix(f'{group}.')] = length
        read = {_group_of(name) for name in columns}
        names = {name.removeprefix(f'{_group_of(name)}.') for name in columns}
        others = [held for group, held in groups.items() if group not in read]
        return self.more_rows + sum(max(one.values()) for one in others if names <= one.keys())

    def fault_of_length(self, column: str, time: str) -> str:
        """Return how a column is of another length than that of its time, empty if it is not."""
        count, rows = map(self.arrays.get, (column, time))
        if not count or not rows or count == rows:
            return ''
        return (
            f'column {short(repr(column))} holds {count} values and {short(repr(time))} {rows}, '
            'so that its samples are not at the same times'
        )

    def first_rows(self) -> pl.DataFrame:
        """Return the first rows of all columns; raises InputError."""
        with readable(f'log {self.path} cannot be read'):
            part = next(iter(self.read(self.names(), {})), None)
            return pl.DataFrame(schema=self.names()) if part is None else part.head(LINES)

    def blocks(self, names: Collection[str], types: Types | None = None) -> Iterator[pl.DataFrame]:
        """
        Yield the columns `names` in blocks of rows; none is empty. Raises InputError.

        Cells of a text are texts, or numbers of the `types`, which may change between two blocks.

        """
        come_to = limits.NUMBER_CELL * self.rows * len(names)
        if come_to > self.most:
            raise InputError(
                f'log {self.path}: {len(names)} columns of {self.rows} rows come to '
                f'{come_to / limits.MEGA:.0f} MB, allowed are {limits.PACKING} times the size of '
                'the file'
            )
        with readable(f'log {self.path} cannot be read'):
            for batch in self.read(list(names), {} if types is None else types):
                yield from batch.iter_slices(BLOCK) if batch.height else ()


def _group_of(name: str) -> str:
    """Return the group of a column, empty for none."""
    return name.partition(' [')[0].rpartition('.')[0]


def source_of(path: Path, layout: Layout | None = None, sheet: str = '') -> Source:
    """
    Return the table in a file, its cells as they stand; raises InputError without one.

    Of a workbook it is that in a `sheet`, or in the first sheet with a table.

    """
    return _source_of(path, layout, sheet).joined()


def _source_of(path: Path, layout: Layout | None, sheet: str) -> Source:
    head = _head_of(path)
    if head.startswith(codings.GZIP):
        packed = codings.unpacked(path, HEAD)
        if packed.startswith((PARQUET, ZIP)) or foreign.kind_of(packed):
            raise InputError(
                f'log {path} is packed by gzip, of which texts with rows of cells are read alone: '
                'unpack it before'
            )
    if head.startswith(PARQUET):
        return _parquet(path)
    if head.startswith(ZIP):
        return _sheet(path, layout, sheet)
    if kind := foreign.kind_of(head):
        signals = foreign.read_signals(path, kind)
        frame, is_grouped = signals.frame, foreign.KINDS[kind].is_grouped
        empty = signals.empty_rows
        _check_columns(path, frame.width)
        source = of_frame(path, frame.lazy(), signals.head(), frame.height, math.inf)
        lengths = [frame.height - column.null_count() for column in frame]
        source = dataclasses.replace(
            source,
            left_out=signals.left_out,
            more_rows=signals.more_rows,
            is_grouped=is_grouped,
            lengths=dict(zip(source.names(), lengths, strict=True)) if is_grouped else {},
            arrays=dict(zip(source.names(), map(signals.arrays.get, frame.columns), strict=True)),
            short=ShortRows(count=len(empty), first=empty[0]) if empty else ShortRows(),
            is_pointed=foreign.KINDS[kind].is_pointed,
        )
        texts = frame.head(LINES).select(pl.col(pl.String).fill_null('')).to_dict()
        cells = dict(zip(frame.columns, source.names(), strict=True))
        return source.plain({cells[name]: column.to_list() for name, column in texts.items()})
    return _text(path, layout, _Text.of(path, head))


def is_log(path: Path) -> bool:
    """
    Return True if a file begins with rows of numbers or signals, whatever its ending.

    JSON and XML are read, but a large or packed text is judged by the numbers that it begins with.

    """
    with contextlib.suppress(InputError):
        head = _head_of(path, limits.MEGA)
        is_packed = head.startswith(codings.GZIP)
        if is_packed:
            head = codings.unpacked(path, limits.MEGA)
        if head.startswith((PARQUET, ZIP)):
            return head.startswith(PARQUET)
        if kind := foreign.kind_of(head[:HEAD]):
            if kind in ('json', 'xml') and not is_packed and path.stat().st_size <= limits.TEXT:
                return _holds_signals(path, kind) or json_layouts.TRACE.encode() in head
            return foreign.holds_numbers(head, kind, FEWEST)
        if codings.wide_coding(head):
            head = codings.text_of(head).encode()
        text = _Text.of(path, head, head.rstrip(codings.NUL))
        return heads.holds_numbers(_first_lines(text)[0], FEWEST)
    return False


def _holds_signals(path: Path, kind: str) -> bool:
    """Return True if a file of a kind can be read and holds signals."""
    with contextlib.suppress(InputError):
        return bool(foreign.read_signals(path, kind).frame.width)
    return False


def of_frame(path: Path, frame: pl.LazyFrame, head: Head, rows: int, most: float) -> Source:
    """Return a table whose cells are in a frame that has a column for each name."""
    named = frame.rename(dict(zip(frame.collect_schema().names(), head.names)))

    def read(names: list[str], types: Types) -> Iterator[pl.DataFrame]:
        yield from named.select(names).collect_batches(chunk_size=BLOCK, lazy=True)

    return Source(path=path, head=head, rows=max(rows, 1), read=read, most=most)


def _head_of(path: Path, size: int = HEAD) -> bytes:
    try:
        with path.open('rb') as stream:
            head = stream.read(size)
    except OSError as error:
        raise InputError(f'log {path} cannot be read: {error.strerror}') from None
    _check_begin(path, head)
    return head


def _check_begin(path: Path, head: bytes) -> None:
    if not head.strip():
        raise InputError(f'log {path} is empty, it must be a table or a file of signals')


def _parquet(path: Path) -> Source:
    rows, names = _shape_of_parquet(path)
    _check_columns(path, len(names))
    most = max(limits.most_unpacked(path.stat().st_size), limits.WORKBOOK)
    frame = _flat(pl.scan_parquet(path))
    schema = frame.collect_schema()
    _check_columns(path, len(schema))
    timed = PANDAS_INDEX in schema and schema[PANDAS_INDEX].is_temporal()
    frame = frame.rename({PANDAS_INDEX: TIME} if timed and TIME not in schema else {})
    names = frame.collect_schema().names()
    head = Head(names=heads.unlike(names), separator='', begin=0, first=1)
    return of_frame(path, frame, head, rows, most)


def _flat(frame: pl.LazyFrame) -> pl.LazyFrame:
    """Return a frame with a column for each field of a structure, as `x.position`."""
    while any(isinstance(kind, pl.Struct) for kind in frame.collect_schema().values()):
        frame = frame.select(
            one
            for name, kind in frame.collect_schema().items()
            for one in (
                [
                    pl.col(name).struct.field(field.name).alias(f'{name}.{field.name}')
                    for field in kind.fields
                ]
                if isinstance(kind, pl.Struct)
                else [pl.col(name)]
            )
        )
    return frame


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


def _sheet(path: Path, layout: Layout | None, name: str) -> Source:
    """Return a sheet of a workbook; raises ImportError without its reader."""
    sheet = read_sheet(path, name)
    cells = sheet.cells
    _check_columns(path, cells.width)
    lines = lines_of(cells)
    with _findable(path):
        head = heads.find_head(lines, layout)
    before = head.first - 1
    frame = cells[before:].select(cells.columns[: len(head.names)])
    empty = [  # but for the first cell, from which a formula may count on
        name for name, column in zip(head.names, frame) if column.null_count() >= len(column) - 1
    ]
    if empty and holds_formulas_alone(path):
        raise InputError(
            f'log {path}: column {short(repr(empty[0]))} holds formulas without their values: '
            'open the workbook in a spreadsheet and save it, which works them out'
        )
    source = of_frame(path, frame.lazy(), head, frame.height, math.inf)
    rows = counted(sheet.hidden, 'row')
    are = 'is' if sheet.hidden == 1 else 'are'
    notes = [f'log {path}: {rows} of its sheets {are} hidden, and {are} read as all others are']
    source = dataclasses.replace(
        source,
        sheet=sheet.name,
        from_1904=sheet.from_1904,
        left_out=sheet.others,
        more_rows=sheet.more_rows,
        numeric=frozenset(head.names[at] for at in sheet.numeric if at < len(head.names)),
        notes=tuple(notes[: sheet.hidden]),
    )
    return source.plain(heads.cells_of(lines, head))


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class _Text:
    """A CSV file, or its content where that had to be decoded; and what ends its lines."""

    path: Path
    content: bytes | None
    line_end: str
    lines_about: int

    @classmethod
    def of(cls, path: Path, head: bytes, content: bytes | None = None) -> '_Text':
        content = codings.decoded(path, head) if content is None else content
        size = path.stat().st_size if content is None else len(content)
        head = head if content is None else content[:HEAD]
        _check_begin(path, head)
        if codings.NUL in head:
            raise InputError(f'log {path} is no text, it must be a table or a file of signals')
        line_end = '\n' if b'\n' in head or b'\r' not in head else '\r'
        lines = max(head.count(line_end.encode()), 1) * size // len(head)
        return cls(path=path, content=content, line_end=line_end, lines_about=max(lines, 1))

    def stream(self) -> BinaryIO:
        return self.path.open('rb') if self.content is None else io.BytesIO(self.content)

    def begin(self) -> int:
        """Return where the text begins [bytes], after a mark of its coding."""
        with self.stream() as stream:
            return len(NARROW_MARK) if stream.read(len(NARROW_MARK)) == NARROW_MARK else 0

    @contextlib.contextmanager
    def lines(self) -> Iterator[Iterator[str]]:
        """Give its lines, a letter for each byte."""
        with self.stream() as stream:
            stream.seek(self.begin())
            text = io.TextIOWrapper(stream, codings.BYTES, newline=self.line_end)
            yield _bounded(self.path, text)


def _bounded(path: Path, text: io.TextIOWrapper) -> Iterator[str]:
    """Yield the lines of a text; raises InputError for one that is longer than allowed."""
    while line := text.readline(limits.LINE + 1):
        if len(line) > limits.LINE:
            raise _too_long(path)
        yield line


def _too_long(path: Path) -> InputError:
    return InputError(
        f'log {path} has a line of more than {limits.LINE // limits.MEGA} MB, a table has '
        'shorter ones'
    )


def _text(path: Path, layout: Layout | None, text: _Text) -> Source:
    text, sections = _joined(path, text)
    lines, begins, coding = _first_lines(text)
    ends = [line.row for line in lines if line.raw.startswith(END_OF_HEAD)]
    if len(ends) > HEADS:
        raise _several_sections(path, ends[HEADS])
    if is_torn := are_torn([line.raw for line in lines]):
        lines = [Line(raw=re.sub(TORN_TIME, WHOLE, line.raw), row=line.row) for line in lines]
    head = _head_of_text(path, lines, layout)
    rows = _TextRows(text=text, head=head, begin=begins[head.begin], is_torn=is_torn)
    odd = {
        'its letters are not of UTF-8, they are read by {}': coding,
        'its {} sections have one head and are read as one table, whose rows count without the '
        'further heads': sections * (sections > 1),
        'a semicolon parts milliseconds as well as cells: it is read as part of the time': is_torn,
    }
    notes = [f'log {path}: {note.format(value)}' for note, value in odd.items() if value]
    source = Source(
        path=path,
        head=head,
        rows=text.lines_about,
        read=rows.read,
        short=rows.short,
        notes=tuple(notes),
    )
    return source.plain(heads.cells_of(lines, head))


def _head_of_text(path: Path, lines: Sequence[Line], layout: Layout | None) -> Head:
    """Return the head of a text; raises InputError without one or for too many columns."""
    widest = max((line.raw.count(sign) for line in lines for sign in ';\t|,'), default=0)
    _check_columns(path, widest + 1)
    with _findable(path):
        head = heads.find_head(lines, layout)
    _check_columns(path, len(head.names))
    names = max(head.begin - 1, 0)
    if len(head.names) == 1 and (sign := unread_separator(lines[names:])):
        raise InputError(
            f'log {path}: {sign} seems to part its cells, allowed are {listed(NAMES_OF_SIGNS)}: '
            'replace it by one of these'
        )
    return head


class _TextRows:
    """The rows of a text behind its head, read part by part; `short` are those of other widths."""

    def __init__(self, *, text: _Text, head: Head, begin: int, is_torn: bool) -> None:
        """Look at the lines of a text, whose rows `begin` at a byte; raises InputError."""
        self._text, self._head, self._begin, self._is_torn = text, head, begin, is_torn
        self._end, self._width, self.short = text.line_end.encode(), len(head.names), ShortRows()
        with text.stream() as stream:
            plain, comments = _look_at_lines(text.path, stream, self._end)
        # The last column may be one that most rows leave out.
        self._least = self._width - (head.names[-1].casefold() in COMMENTS)
        # Names for as many columns and one more, which must be empty, stand before each part.
        self._names = head.separator.join(map(str, range(self._width + 1))).encode() + self._end
        self._options: dict[str, Any] = {
            'separator': head.separator,
            # What it holds none of is not looked for, which takes as long as the cells themselves.
            'encoding': 'utf8' if plain else 'utf8-lossy',
            'comment_prefix': heads.COMMENT if comments else None,
            'truncate_ragged_lines': True,
            'eol_char': text.line_end,
            'infer_schema': False,
            'raise_if_empty': False,
        }

    def read(self, names: list[str], types: Types) -> Iterator[pl.DataFrame]:
        """Yield some columns, those that have one by their types, part by part."""
        places = {name: at for at, name in enumerate(self._head.names)}
        called = {str(at): self._head.names[at] for at in sorted({places[name] for name in names})}
        tries, row, self.short.count, self.short.longer = TRIES, self._head.first, 0, 0
        self.short.blanks = 0
        for content in self._parts():
            named = _named_again(self._text.path, content, row, self._head)
            self.short.named = self.short.named or named
            known = {str(places[name]): kind for name, kind in types.items() if tries}
            cells, is_typed = self._cells(content, row, [*map(int, called)], known)
            tries -= not is_typed
            row += cells.height
            yield cells.rename(called).select(names)

    def _parts(self) -> Iterator[bytes]:
        """Yield the rows in parts, with one blank where several part cells, and whole times."""
        blanks = self._head.separator == heads.BLANKS
        with self._text.stream() as stream:
            stream.seek(self._begin)
            for part in _without_last_words(_parts(stream, self._end), self._width):
                content = SPACES.sub(b' ', EDGES.sub(b'', part)) if blanks else part
                if self._is_torn:
                    content = re.sub(TORN_TIME.encode(), WHOLE.encode(), content, flags=re.M)
                yield content

    def _cells(
        self, content: bytes, row: int, columns: Sequence[int], types: Types
    ) -> tuple[pl.DataFrame, bool]:
        """Return the cells of rows from `row` on, and whether they are of the types."""
        separator, line_end = self._head.separator, self._text.line_end
        whole = any(
            _are_whole(content, separator, line_end, one) for one in {self._least, self._width}
        )
        named = self._names + content
        options = {**self._options, 'columns': [*columns, self._width]}
        typed = _typed(named, types, options) if whole else None
        cells = pl.read_csv(named, **options) if typed is None else typed
        surplus = ~empties(cells[str(self._width)])
        if not whole or surplus.any():
            widths = _widths(content, separator, line_end)
            if surplus.any() and len(widths) != cells.height:
                first = row + int(surplus.argmax())
                told = self._head.surplus(first, self._width + 1)
                raise InputError(f'log {self._text.path}: {told}')
            cells = self.short.left_out(cells, widths, self._least, row, surplus)
        return cells, typed is not None


def _joined(path: Path, text: _Text) -> tuple[_Text, int]:
    """Return a text of LabVIEW whose sections are joined if they may be, and their number."""
    with text.stream() as stream:
        begin = stream.read(HEAD).removeprefix(NARROW_MARK)
        size = stream.seek(0, io.SEEK_END)
        if not begin.startswith(MARK) or size > limits.TABLE:
            return text, 1
        stream.seek(0)
        content, sections = joined_sections(path, stream.read())
    return dataclasses.replace(text, content=content), sections


def _several_sections(path: Path, row: int) -> InputError:
    return InputError(
        f'log {path}: row {row} ends the head of another section, {END_OF_HEAD}, whose columns '
        'and start may be others: save each section as a log'
    )


def _named_again(path: Path, content: bytes, row: int, head: Head) -> int:
    """
    Return the row of the first comment before others that names the columns again, 0 for none.

    Raises InputError for a further head, or a comment of other names or units than its own.

    """
    if (at := content.find(END_OF_HEAD.encode())) >= 0:
        raise _several_sections(path, row + content.count(LINE_FEED, 0, at))
    found = 0
    for match in REMARK.finditer(content) if heads.COMMENT.encode() in content else ():
        cells = match[1].decode(errors='replace').strip().split(head.separator)
        if not len(cells) == len(head.names) > 1:
            continue
        place = row + content.count(LINE_FEED, 0, match.start())
        if heads.are_other_names(cells, head.names, is_remark=True):
            raise InputError(
                f'log {path}: row {place} names or measures its columns otherwise than the head, '
                f'{listed(cells)}: split the log there'
            )
        if heads.are_names_again(cells, head.names) and content[slice(match.end(), None)].strip():
            found = found or place
    return found


def _are_whole(content: bytes, separator: str, line_end: str, width: int) -> bool:
    """
    Return True if each row of a text has as many cells as a width.

    Where no cell looks empty, that many cells in all tell it: a longer row is refused. Of a single
    column each row is looked at, as no sign shows a blank one.

    """
    lines = content.count(line_end.encode()) + (not content.endswith(line_end.encode()))
    letters, count, is_empty = np.frombuffer(content, np.uint8), 0, width == 1
    for begin in range(0, len(letters), WINDOW):  # whose arrays stay in the cache
        part = letters[slice(begin, begin + WINDOW + 1)]
        signs, low = part == ord(separator), part <= ord(AFTER_EMPTY)
        count += int(np.count_nonzero(signs[:WINDOW]))
        is_empty |= bool((signs[:-1] & (signs[1:] | low[1:])).any())
    if count != (width - 1) * lines or not is_empty:
        return count == (width - 1) * lines
    return bool((_widths(content, separator, line_end) == width).all())


def _widths(content: bytes, separator: str, line_end: str) -> NDArray[np.int64]:
    """Return how many cells each row of a text holds, 0 of a blank one; comments are no rows."""
    letters = np.frombuffer(content, np.uint8)
    ends, signs = (np.flatnonzero(letters == ord(one)) for one in (line_end, separator))
    if b'"' in content:
        quotes = np.flatnonzero(letters == ord('"'))
        ends, signs = (one[np.searchsorted(quotes, one) % 2 == 0] for one in (ends, signs))
    ends = ends if content.endswith(line_end.encode()) else np.append(ends, len(letters))
    begins = np.append(0, ends[:-1] + 1)
    widths = np.diff(np.searchsorted(signs, ends), prepend=0) + 1
    blank = (ends == begins) | ((ends == begins + 1) & (letters[begins] == ord('\r')))
    return np.where(blank, 0, widths)[letters[begins] != ord(heads.COMMENT)]


def _typed(content: bytes, types: Types, options: Mapping[str, Any]) -> pl.DataFrame | None:
    """Return the cells of a text by types of columns, None if some cell is of another."""
    with contextlib.suppress(PolarsError):
        cells = pl.read_csv(content, schema_overrides=types, **options)
        columns = [cells[place] for place in types]
        if all(not one.null_count() and math.isfinite(one.sum()) for one in columns):
            return cells
    return None


def _first_lines(text: _Text) -> tuple[list[Line], list[int], str]:
    """Return the first lines of a text, quoted ones as one, where each begins, their coding."""
    lines, rows, begins, at, number = list[str](), list[int](), [], text.begin(), 0
    with text.lines() as stream:
        for line in stream:
            begin, row, at = at, number + 1, at + len(line)
            number += 1
            while line.count('"') % 2 and at <= limits.MEGA and (more := next(stream, '')):
                line, at, number = line + more, at + len(more), number + 1
            lines.append(line)
            rows.append(row)
            begins.append(begin)
            if len(lines) >= LINES or at > limits.MEGA:
                break
    written = [line.encode(codings.BYTES) for line in lines]
    coding = codings.narrow_coding(b''.join(written))
    read = (codings.line_of(line, coding) for line in written)
    return [Line(raw=raw, row=row) for raw, row in zip(read, rows)], [*begins, at], coding


@contextlib.contextmanager
def _findable(path: Path) -> Iterator[None]:
    try:
        yield
    except (csv.Error, ValueError) as error:
        raise InputError(f'log {path} cannot be read: {first_line(error)}') from None


def _parts(stream: BinaryIO, line_end: bytes) -> Iterator[bytes]:
    """Yield a text in parts that end with a line; of a whole one, polars would read much ahead."""
    held, quoted, block = [b''], False, stream.read(PART)
    while block:
        following = stream.read(PART)
        end = _line_ends(block, line_end, quoted)[1] + 1 if following else len(block)
        quoted ^= _is_odd(block)
        if end:
            yield b''.join([*held, memoryview(block)[:end]])
            held = [block[end:]]
        else:
            held.append(block)
        block = following


def _without_last_words(parts: Iterator[bytes], width: int) -> Iterator[bytes]:
    """Yield a text in parts, without a word that ends it instead of a row of several cells."""
    held = b''
    for part in parts:
        if held:
            yield held
        held = part
    cut = max(len(held) - SHORT, 0)
    if rows := held[:cut] + LAST_WORDS.sub(b'', held[cut:]) if width > 1 else held:
        yield rows


def _is_odd(block: bytes) -> bool:
    """Return True if a text has an odd number of quotes."""
    return b'"' in block and block.count(b'"') % 2 == 1


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
