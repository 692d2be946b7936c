# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Heads of tables: lines before the names of the columns, and names in one line or two."""

from collections.abc import Iterator, Sequence
import csv
import dataclasses
import itertools
import re

from ballscrew_monitor.recordings.tables.quantities import column_name, Layout
from ballscrew_monitor.recordings.tables.unit_names import is_unit

SEPARATORS = (';', '\t', '|', ',')
"""What may part the cells; a comma may be a decimal mark as well, hence it is the last."""
COMMENT = '#'
QUOTED = re.compile('"[^"]*"')
NUMBER = re.compile(r'\s*[-+]?[.,]*\d[\d.,:eETZ +/-]*')
"""A number, date or time in whatever form."""
FULL = 0.5  # of the cells of the fullest row: emptier ones belong to no table


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class Head:
    """
    Names of the columns, how the cells are parted, and the lines before the names.

    The first cells stand in the row `first` of the file.

    """

    names: tuple[str, ...]
    separator: str
    lines: int
    first: int


def read_head(lines: Iterator[str], layout: Layout) -> Head:
    """Return the head of a text; raises csv.Error, and ValueError when no line names columns."""
    for number, line in enumerate(lines):
        if number >= layout.skip and line.strip() and not line.startswith(COMMENT):
            while line.count('"') % 2 and (more := next(lines, '')):
                line += more  # a name of several lines
            separator = _separator(line)
            rows = csv.reader(itertools.chain(line.splitlines(True), lines), delimiter=separator)
            names = names_of(list(itertools.islice(rows, layout.header_rows)))
            first = number + rows.line_num + 1
            return Head(names=names, separator=separator, lines=number, first=first)
    raise ValueError('no line names its columns')


def names_of(rows: Sequence[Sequence[str]]) -> tuple[str, ...]:
    """Return the names of columns that stand in one row, or in two with units or parts below."""
    below = rows[1] if len(rows) > 1 else ()
    more = (*below, *[''] * (len(rows[0]) - len(below)))
    return unlike([_joined(name, part) for name, part in zip(rows[0], more, strict=False)])


def unlike(names: Sequence[str]) -> tuple[str, ...]:
    """Return names of columns in one line each, of which no two are equal."""
    counts: dict[str, int] = {}
    made = []
    for name in map(column_name, names):
        count = counts[name] = counts.get(name, -1) + 1
        made.append(f'{name}_duplicated_{count - 1}' if count else name)
    return tuple(made)


def found_layout(rows: Sequence[Sequence[str]]) -> Layout:
    """Return where the names stand in the first rows of a table: above the first full numbers."""
    most = max((_filled(row) for row in rows), default=0)
    full = [number for number, row in enumerate(rows) if _filled(row) >= FULL * most]
    first = next((at for at, number in enumerate(full) if _is_of_numbers(rows[number])), 0)
    above = full[:first]
    if not above:
        return Layout()
    two = len(above) > 1 and _is_of_units(rows[above[-1]]) and above[-1] - above[-2] == 1
    names = above[-2] if two else above[-1]
    before = any(_filled(row) for row in rows[:names])
    return Layout(skip=names if before else 0, header_rows=1 + two)


def found_in_lines(lines: Sequence[str]) -> Layout:
    """Return where the names stand in the first lines of a text."""
    rows: list[list[str]] = []
    for separator in SEPARATORS:
        rows = [_cells(line, separator) for line in lines]
        if 2 * sum(len(row) > 1 for row in rows) > len(lines):
            break
    return found_layout(rows)


def _separator(line: str) -> str:
    """Return what parts the cells of a line, by what is not quoted in it; a comma if nothing."""
    return max(reversed(SEPARATORS), key=QUOTED.sub('', line).count)


def _cells(line: str, separator: str) -> list[str]:
    try:
        rows = [] if line.startswith(COMMENT) else list(csv.reader([line], delimiter=separator))
    except csv.Error:
        rows = []
    return rows[0] if rows else []


def _joined(name: str, below: str) -> str:
    part = below.strip()
    bare = is_unit(part) and part[0] not in '[('
    return f'{name} [{part}]' if bare else f'{name} {part}'


def _filled(row: Sequence[str]) -> int:
    return sum(bool(cell.strip()) for cell in row)


def _is_of_numbers(row: Sequence[str]) -> bool:
    return 2 * sum(bool(NUMBER.fullmatch(cell)) for cell in row) > _filled(row)


def _is_of_units(row: Sequence[str]) -> bool:
    return 2 * sum(is_unit(cell) for cell in row) >= _filled(row)
