# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Kinds of the cells of a sheet: its reader makes texts of all, and nothing of errors.

An error such as #N/A is an unknown value, where an empty cell is no sample. A cell that is shown
as 52 % holds 0.52. A text that may be a number has the decimal sign of whoever wrote it, a true
number has none.

"""

from collections.abc import Collection, Iterator
import dataclasses
from pathlib import Path
import posixpath
import re
import sys
import zipfile

from ballscrew_monitor.recordings.tables.cells import readable
from ballscrew_monitor.recordings.tables.signs import signless
import polars as pl
from surrogate.files import InputError

TAG = re.compile(
    rb'<(?:\w+:)?(?:(row)|c)(?=[\s/>])(?: r="([A-Za-z]*)(\d+)")?([^>]*?)(/?)>(\s*</)?'
)
"""The beginning of a row, or of a cell; one that is empty, or ends at once, has no value."""
REFERENCE = re.compile(rb'\br\s*=\s*["\']([A-Za-z]*)(\d+)["\']')
KIND = re.compile(rb'\bt\s*=\s*["\'](s|str|inlineStr|e)["\']')
STYLE = re.compile(rb'\bs\s*=\s*["\'](\d+)["\']')
VALUE = re.compile(rb'<(?:\w+:)?v\b[^>]*>([^<]*)<')
BOOK, RELATIONS, STYLES = 'xl/workbook.xml', 'xl/_rels/workbook.xml.rels', 'xl/styles.xml'
STRINGS = 'xl/sharedstrings.xml'
NOT_SHARED = re.compile(rb'\bt\s*=\s*["\'](?:e|str|inlineStr)["\']')
SIGN = re.compile(rb'\d[.,]|[.,]\d')
"""Cells of a sheet that are errors or texts by themselves, and signs in texts that it shares."""
SHEET = re.compile(rb'<(?:\w+:)?sheet\s[^>]*?\w+:id\s*=\s*["\']([^"\']*)["\']')
RELATION = re.compile(rb'<(?:\w+:)?Relationship\s([^>]*)>')
FORMAT = re.compile(rb'<(?:\w+:)?numFmt\s([^>]*)>')
CELL_FORMATS = re.compile(rb'<(?:\w+:)?cellXfs\b.*?</(?:\w+:)?cellXfs>', re.S)
CELL_FORMAT = re.compile(rb'<(?:\w+:)?xf\b[^>]*?\bnumFmtId\s*=\s*["\'](\d+)["\']')
PERCENT = {9, 10}
"""Numbers of the formats 0% and 0.00%, which no workbook states."""
LITERAL = re.compile(rb'&quot;.*?&quot;|"[^"]*"|\\.|_.')
"""Parts of a format that are shown as they stand, or are blanks."""
MAY_BE_NUMBER = r'^[^\p{L}]*\d[^\p{L}]*[.,][^\p{L}]*$|^[^\p{L}]*[.,]\d[^\p{L}]*$'
LETTERS = 26


@dataclasses.dataclass(kw_only=True, slots=True)
class _Kinds:
    """Rows of the texts, errors and shares of a sheet by their columns; its first row, column."""

    texts: dict[int, list[int]] = dataclasses.field(default_factory=dict)
    errors: dict[int, dict[int, str]] = dataclasses.field(default_factory=dict)
    shares: dict[int, list[int]] = dataclasses.field(default_factory=dict)
    first: list[int] = dataclasses.field(default_factory=lambda: [sys.maxsize] * 2)
    last: list[int] = dataclasses.field(default_factory=lambda: [0, 0])


def with_kinds(path: str, number: int, cells: pl.DataFrame) -> tuple[pl.DataFrame, list[int]]:
    """
    Return a sheet with its errors and per cents, and the columns whose numbers are true ones.

    The sheet is that of a `number` in its workbook, from 0 on. Raises InputError where cells
    cannot be told apart.

    """
    with readable(f'log {path} cannot be read', Exception), zipfile.ZipFile(Path(path)) as archive:
        kinds = _kinds(archive, number)
    origin = kinds.first
    shape = tuple(max(last - one, -1) + 1 for one, last in zip(origin, kinds.last, strict=True))
    if shape != cells.shape and (kinds.errors or kinds.shares):
        raise InputError(
            f'log {path}: its errors or per cents stand in a sheet of {shape[0]} rows and '
            f'{shape[1]} columns, its reader finds {cells.height} and {cells.width}: save the '
            'sheet as CSV'
        )
    columns, numeric = [], []
    for at, column in enumerate(cells):
        place = at + origin[1]
        rows = [row - origin[0] for row in kinds.texts.get(place, ())]
        rows = [row for row in rows if 0 <= row < cells.height]
        texts = column.gather(rows)
        if texts.str.contains(MAY_BE_NUMBER).any():
            column = _signless(column, rows)
        else:
            numeric.append(at)
        shares = [row - origin[0] for row in kinds.shares.get(place, ())]
        errors = {row - origin[0]: told for row, told in kinds.errors.get(place, {}).items()}
        if shares:
            column = column.scatter(shares, _percent(column.gather(shares)))
        if errors:
            column = column.scatter([*errors], [*errors.values()])
        columns.append(column)
    return pl.DataFrame(columns), numeric


def _signless(column: pl.Series, texts: list[int]) -> pl.Series:
    """Return the cells of a column, those but of some rows without decimal signs."""
    others = column.clone().scatter(texts, [None] * len(texts))
    rows = others.str.contains(r'^-?\d+\.\d+$').fill_null(False).arg_true()
    return column.scatter(rows, [signless(float(cell)) for cell in column.gather(rows)])


def _percent(cells: pl.Series) -> pl.Series:
    """Return numbers as they are shown, 52 % for 0.52, and other cells as they stand."""
    numbers = cells.cast(pl.Float64, strict=False)
    shown = [None if one is None else f'{100.0 * one:.15g} %' for one in numbers]
    return pl.Series(shown, dtype=pl.String).fill_null(cells)


def _kinds(archive: zipfile.ZipFile, number: int) -> _Kinds:
    """Return which cells of a sheet are texts, errors and shares."""
    kinds, shares = _Kinds(), _shares(archive)
    text = archive.read(_part(archive, number))
    strings = _part_called(archive, STRINGS)
    if not shares and not NOT_SHARED.search(text) and not SIGN.search(strings):
        return kinds  # its cells are true numbers, dates and words
    known: dict[bytes, str] = {}
    first_row, first_column = kinds.first
    last_row, last_column = kinds.last
    for row, column, told, end in _cells(text):
        first_row, last_row = min(first_row, row), max(last_row, row)
        first_column, last_column = min(first_column, column), max(last_column, column)
        kind = known.get(told)
        if kind is None:
            kind = known[told] = _kind(told, shares)
        if kind == 'error':
            value = VALUE.match(text, end)
            shown = value[1].decode(errors='replace') if value else '#ERROR'
            kinds.errors.setdefault(column, {})[row] = shown
        elif kind == 'text':
            kinds.texts.setdefault(column, []).append(row)
        elif kind:
            kinds.shares.setdefault(column, []).append(row)
    kinds.first, kinds.last = [first_row, first_column], [last_row, last_column]
    return kinds


def _kind(told: bytes, shares: Collection[int]) -> str:
    """Return the kind of a cell by its attributes, empty for a number that is shown as it is."""
    kind, style = KIND.search(told), STYLE.search(told)
    if kind:
        return 'error' if kind[1] == b'e' else 'text'
    return 'share' if style and int(style[1]) in shares else ''


def _cells(text: bytes) -> Iterator[tuple[int, int, bytes, int]]:
    """
    Yield row, column, attributes and where the value begins, of each cell that has one.

    A cell without a reference follows the one before.

    """
    row = column = 0
    columns: dict[bytes, int] = {}
    for match in TAG.finditer(text):
        is_row, letters, digits, told, empty, bare = match.groups()
        if not digits and (place := REFERENCE.search(told)):
            letters, digits = place.groups()
            told = told.replace(place[0], b'')
        if is_row:
            row, column = int(digits) if digits else row + 1, 0
            continue
        column += 1
        if digits:
            row = int(digits)
            column = columns.get(letters) or columns.setdefault(
                letters, column_number(letters.decode())
            )
        if not empty and not bare:
            yield row, column, told, match.end()


def column_number(letters: str) -> int:
    """Return the number of a column, that of A is 1."""
    number = 0
    for letter in letters.upper():
        number = LETTERS * number + ord(letter) - ord('A') + 1
    return number


def _part(archive: zipfile.ZipFile, number: int) -> str:
    """Return the name of the part that holds the cells of a sheet, by its number from 0 on."""
    names = {name.lower(): name for name in archive.namelist()}
    identity = SHEET.findall(archive.read(names[BOOK]))[number]
    for relation in RELATION.findall(archive.read(names[RELATIONS])):
        if _attribute(b'Id', relation) == identity:
            target = _attribute(b'Target', relation).decode()
            return names[posixpath.normpath(posixpath.join('/xl', target)).lower().strip('/')]
    raise KeyError(identity.decode())


def _part_called(archive: zipfile.ZipFile, name: str) -> bytes:
    """Return a part of a workbook that it need not have, by its name in small letters."""
    names = {one.lower(): one for one in archive.namelist()}
    return archive.read(names[name]) if name in names else b''


def _shares(archive: zipfile.ZipFile) -> set[int]:
    """Return the numbers of the styles that show a number in per cent."""
    text = _part_called(archive, STYLES)
    formats = PERCENT | {
        int(_attribute(b'numFmtId', told))
        for told in FORMAT.findall(text)
        if b'%' in LITERAL.sub(b'', _attribute(b'formatCode', told))
    }
    styles = CELL_FORMAT.findall(b''.join(CELL_FORMATS.findall(text)))
    return {at for at, number in enumerate(styles) if int(number) in formats}


def _attribute(name: bytes, told: bytes) -> bytes:
    match = re.search(rb'\b%s\s*=\s*(?:"([^"]*)"|\'([^\']*)\')' % name, told)
    return (match[1] or match[2] or b'') if match else b''
