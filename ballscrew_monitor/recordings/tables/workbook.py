# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
A sheet of a workbook (xlsx) as texts; what it comes to is known before it is read.

It is the sheet that a map names, else the first with rows of numbers, which holds a table.

The reader makes a rectangle of all cells, the empty ones too, so that one cell far off fills the
memory. What the sheet says of its size may be wrong: the references of the cells tell it. It reads
in a process of its own, which may use so much memory and no more.

"""

from collections.abc import Iterator, Mapping, Sequence
import contextlib
import csv
import dataclasses
import importlib
from pathlib import Path
import re
import sys
from typing import Any, IO
from xml.parsers import expat
import zipfile
import zlib

from ballscrew_monitor.recordings.tables.apart import frame_apart
from ballscrew_monitor.recordings.tables.cell_kinds import column_number, with_kinds
from ballscrew_monitor.recordings.tables.cells import readable
from ballscrew_monitor.recordings.tables.heads import find_head, holds_numbers, Line
from ballscrew_monitor.recordings.tables.names import axis_of_all
from ballscrew_monitor.recordings.words import listed, short
import polars as pl
from surrogate.files import InputError, limits

CELL_SIZE = limits.XLSX_CELL
LOOKED_AT = 2000  # rows of a sheet that tell whether it holds a table
FEWEST = (20, 3)  # rows of numbers of a table, if not those of any sheet
UNPACKABLE = (zipfile.BadZipFile, zlib.error, NotImplementedError, RuntimeError, EOFError, OSError)
ANOTHER = 'a sheet before it has rows of numbers'
OF_DAY = r'^(1899-12-31|19(?:00|04)-0[12]-\d\d) (\d\d)(:.*)$'
"""Time of a day with the date that a sheet adds to it: hours count from the first of these."""
DAYS = ('1899-12-31', '1904-01-01')
FROM_1904 = re.compile(rb'<(?:\w+:)?workbookPr\b[^>]*\bdate1904\s*=\s*["\'](?:1|true)')
SHEET = b'sheetData'  # the element that holds the cells
CELL = re.compile(rb'[<:]c[\s/>]')
BARE_FORMULA = re.compile(rb'</f>\s*(?:<v>\s*</v>|<v\s*/>)?\s*</c>')
HIDDEN = re.compile(rb'<(?:\w+:)?row\b[^>]*\bhidden="(?:1|true)"')
COLUMN, ROW = '[A-Za-z]{1,7}', '[0-9]{1,19}'
PLAIN_CELL = re.compile(f'<c r="({COLUMN})({ROW})"'.encode())
SIZES = CELL_SIZE // 8  # of a sheet unpacked: a cell is written in eight bytes and more
VALUES = ('v', 'is')  # elements that hold the value of a cell


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class Sheet:
    """
    A sheet: its name, its cells, and why each other sheet of its workbook is not read.

    `more_rows` are those of the others that have its names, `hidden` those of all that nobody
    sees, `numeric` the numbers of columns without a text that may be a number. Days of its
    workbook count from 1904 if it is `from_1904`, else from 1900.

    """

    name: str
    cells: pl.DataFrame
    others: Mapping[str, str]
    more_rows: int = 0
    numeric: Sequence[int] = ()
    hidden: int = 0
    from_1904: bool = False


def read_sheet(path: Path, name: str = '') -> Sheet:
    """Return a sheet of a workbook; raises InputError, ImportError without its reader."""
    importlib.import_module('fastexcel')  # it is optional
    hidden = _check_size(path)
    cells, facts = frame_apart(path, f'{__name__}:write_cells', sheet=name)
    return Sheet(cells=cells, hidden=hidden, from_1904=_counts_from_1904(path), **facts)


def write_cells(inputs: Mapping[str, str]) -> dict[str, Any]:
    """Write the cells of a sheet of the workbook `path` to `target`; raises InputError."""
    path, stated = inputs['path'], inputs['sheet']
    with readable(f'log {path} cannot be read', Exception):
        names = importlib.import_module('fastexcel').read_excel(path).sheet_names
    if not names:
        raise InputError(f'log {path} lists no sheet, the workbook is damaged: save it as CSV')
    if stated and stated not in names:
        raise InputError(f'log {path}: sheet {short(repr(stated))} is missing, {_held(names)}')
    only = stated or (names[0] if len(names) == 1 else '')
    tried = [(only, 0)] if only else [(name, fewest) for fewest in FEWEST for name in names]
    others = dict.fromkeys(names, f'`sheet` in the map names {stated}' if stated else ANOTHER)
    for name, fewest in tried:
        cells = _texts(path, name)
        if only or (cells.width > 1 and holds_numbers(lines_of(cells), fewest)):
            cells, numeric = with_kinds(path, names.index(name), cells)
            cells.write_ipc(inputs['target'])
            del others[name]
            of_axis = [other for other in others if axis_of_all(other) == axis_of_all(name)]
            more = sum(_rows_alike(cells, path, other) for other in of_axis)
            return {'name': name, 'others': others, 'more_rows': more, 'numeric': numeric}
        others[name] = f'it has fewer than {fewest} rows of numbers'
    raise InputError(f'log {path}: no sheet has rows of numbers, {_held(names)}')


def _rows_alike(cells: pl.DataFrame, path: str, name: str) -> int:
    """Return the rows of another sheet if its columns have the names of a table, else 0."""
    with contextlib.suppress(InputError, csv.Error, ValueError):
        head, others = find_head(lines_of(cells)), _texts(path, name)
        other = find_head(lines_of(others))
        if head.named and {*head.names} <= {*other.names}:
            return max(others.height - other.first + 1, 0)
    return 0


def lines_of(cells: pl.DataFrame) -> list[Line]:
    """Return the first rows of a sheet."""
    return [
        Line(raw='', row=number + 1, cells=tuple(cell or '' for cell in row))
        for number, row in enumerate(cells.head(LOOKED_AT).iter_rows())
    ]


def _held(names: Sequence[str]) -> str:
    return f'the workbook holds {listed(names)}: name one by `sheet` in the map'


def _texts(path: str, name: str) -> pl.DataFrame:
    """Return the cells of a sheet as texts; raises InputError."""
    with readable(f'log {path} cannot be read', Exception):
        cells = pl.read_excel(
            path,
            sheet_name=name,
            engine='calamine',
            has_header=False,
            infer_schema_length=0,
            drop_empty_rows=False,
            drop_empty_cols=False,
        )
        return cells.select([*map(_hours, cells.columns)])


def _hours(name: str) -> pl.Expr:
    """Return a column without the dates that a sheet adds to times: a day later is 24 h more."""
    cells = pl.col(name).cast(pl.String)
    date, hours, rest = (cells.str.extract(OF_DAY, group + 1) for group in range(3))
    first, later = (pl.lit(day).str.to_date() for day in DAYS)
    day = date.str.to_date(strict=False)
    days = (day - pl.when(day < later).then(first).otherwise(later)).dt.total_days()
    of_day = (24 * days + hours.cast(pl.Int64)).cast(pl.String).str.zfill(2) + rest
    return of_day.fill_null(cells).alias(name)


def _check_size(path: Path) -> int:
    """
    Return how many rows of a workbook are hidden.

    Raises InputError if it comes to more than is allowed, whatever it says of itself.

    """
    failure = f'log {path} cannot be read'
    with readable(failure, *UNPACKABLE), zipfile.ZipFile(path) as archive:
        sheets = _sheets(path, archive)
        if not sheets:  # the reader takes other workbooks, too
            raise InputError(f'{failure}: it holds no sheet of xlsx')
        hidden = 0
        for part, size in sheets:
            most = min(max(size * SIZES, limits.SPARSE), limits.MEMORY)
            hidden += _check_cells(path, archive, part, most)
    return hidden


def holds_formulas_alone(path: Path) -> bool:
    """Return True if cells of a workbook, which was read before, hold formulas without a value."""
    with zipfile.ZipFile(path) as archive:
        for part in archive.infolist():
            with archive.open(part) as stream:
                if any(map(BARE_FORMULA.search, _whole_tags(stream))):
                    return True
    return False


def _counts_from_1904(path: Path) -> bool:
    """Return True if days of a workbook, which was read before, count from 1904."""
    with zipfile.ZipFile(path) as archive:
        parts = [part for part in archive.namelist() if part.lower() == 'xl/workbook.xml']
        return any(FROM_1904.search(archive.open(part).read(limits.MEGA)) for part in parts)


def _sheets(path: Path, archive: zipfile.ZipFile) -> list[tuple[zipfile.ZipInfo, int]]:
    """Return the parts that hold cells, and their sizes [B], after all parts were unpacked."""
    most, unpacked = min(limits.most_unpacked(path.stat().st_size), limits.WORKBOOK), 0
    sheets = []
    for part in archive.infolist():
        part.file_size = sys.maxsize  # it is read to its end, whatever it says
        begin, is_sheet, tail = unpacked, False, b''
        with archive.open(part) as stream:
            while block := stream.read(limits.MEGA):
                unpacked += len(block)
                if unpacked > most:
                    raise InputError(
                        f'log {path} comes to more than {most // limits.MEGA} MB when it is '
                        'unpacked: save its sheet as CSV'
                    )
                text = tail + block
                is_sheet |= SHEET in text
                tail = text[slice(-len(SHEET), None)]
        if is_sheet:
            sheets.append((part, unpacked - begin))
    return sheets


def _check_cells(path: Path, archive: zipfile.ZipFile, part: zipfile.ZipInfo, most: int) -> int:
    """
    Return how many rows of a sheet are hidden.

    Raises InputError if the rectangle around its cells comes to more than `most` [bytes].

    """
    hidden = 0

    def counted(texts: Iterator[bytes]) -> Iterator[bytes]:
        nonlocal hidden
        for text in texts:
            hidden += len(HIDDEN.findall(text))
            yield text

    try:
        with archive.open(part) as stream:
            cells = _plain_cells(counted(_whole_tags(stream)))
        if cells is None or CELL_SIZE * cells.count > most:
            hidden = 0
            with archive.open(part) as stream:
                cells = _cells(counted(_whole_tags(stream)))
    except (expat.ExpatError, ValueError) as error:
        raise InputError(f'log {path} cannot be read, {short(part.filename)}: {error}') from None
    if CELL_SIZE * cells.count > most:
        come_to, allowed = CELL_SIZE * cells.count / limits.MEGA, most / limits.MEGA
        raise InputError(
            f'log {path}: the cells of {short(part.filename)} lie within {cells.height} rows and '
            f'{cells.width} columns, which come to {come_to:.0f} MB at {CELL_SIZE} bytes for a '
            f'cell, allowed are {allowed:.0f} MB: clear the cells far off, or save the sheet as '
            'CSV'
        )
    return hidden


def _whole_tags(stream: IO[bytes]) -> Iterator[bytes]:
    """Yield blocks that end before a tag; raises ValueError where none begins for long."""
    rest = b''
    while block := stream.read(limits.MEGA):
        text = rest + block
        cut = max(text.rfind(b'<'), 0)
        if len(text) - cut > limits.LINE:
            raise ValueError(f'a tag has more than {limits.LINE // limits.MEGA} MB')
        yield text[:cut]
        rest = text[cut:]
    yield rest


class _Extent:
    """Rows and columns between the first and the last of some cells."""

    def __init__(self) -> None:
        self._rows: set[int] = set()
        self._columns: set[int] = set()

    def add(self, rows: set[int], columns: set[int]) -> None:
        self._rows = _ends(self._rows | rows)
        self._columns = _ends(self._columns | columns)

    @property
    def height(self) -> int:
        return max(self._rows) - min(self._rows) + 1 if self._rows else 0

    @property
    def width(self) -> int:
        return max(self._columns) - min(self._columns) + 1 if self._columns else 0

    @property
    def count(self) -> int:
        return self.height * self.width


def _ends(numbers: set[int]) -> set[int]:
    return {min(numbers), max(numbers)} if numbers else numbers


def _plain_cells(texts: Iterator[bytes]) -> _Extent | None:
    """Return the extent of all cells, empty ones too; None if one has no reference as usual."""
    extent = _Extent()
    for text in texts:
        references = PLAIN_CELL.findall(text)
        if len(references) != len(CELL.findall(text)):
            return None
        if references:
            letters, digits = map(set, zip(*references))
            extent.add(
                {int(one) for one in digits}, {column_number(one.decode()) for one in letters}
            )
    return extent


def _cells(texts: Iterator[bytes]) -> _Extent:
    """Return the extent of the cells with a value; raises ExpatError and ValueError."""
    reader = _CellReader()
    for text in texts:
        reader.parser.Parse(text, False)
    reader.parser.Parse(b'', True)
    return reader.extent


class _CellReader:
    """Follows the cells of a sheet; one without a reference comes after the one before."""

    def __init__(self) -> None:
        self.extent, self.parser = _Extent(), expat.ParserCreate()
        self.parser.StartElementHandler = self._begin
        self.parser.EndElementHandler = self._end
        self.parser.CharacterDataHandler = self._take
        self.parser.StartDoctypeDeclHandler = self._refuse
        self._row = self._column = 0
        self._place = 0, 0
        self._is_value = False

    def _begin(self, name: str, attributes: dict[str, str]) -> None:
        kind = name.rpartition(':')[2]
        if kind == 'row':
            self._row, self._column = _row(attributes.get('r', str(self._row + 1))), 0
        elif kind == 'c':
            row, self._column = self._row, self._column + 1
            if 'r' in attributes:
                match = re.fullmatch(f'({COLUMN})({ROW})', attributes['r'])  # such as B7
                if not match:
                    raise ValueError(f'a cell is called {short(attributes["r"])}')
                row, self._column = int(match[2]), column_number(match[1])
            self._place = row, self._column
        self._is_value = self._is_value or kind in VALUES

    def _end(self, name: str) -> None:
        if name.rpartition(':')[2] in VALUES:
            self._is_value = False

    def _take(self, text: str) -> None:
        if self._is_value:
            row, column = self._place
            self.extent.add({row}, {column})

    def _refuse(self, *words: object) -> None:
        raise ValueError('it states a type of document')


def _row(text: str) -> int:
    if not re.fullmatch(ROW, text):
        raise ValueError(f'a row is numbered {short(text)}')
    return int(text)
