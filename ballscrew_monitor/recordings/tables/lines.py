# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Lines of a table, and the signs that part their cells."""

from collections.abc import Sequence
import csv
import dataclasses
import re

from ballscrew_monitor.recordings.tables.layouts import SEPARATED

BLANKS = ' '
SEPARATORS = (';', '\t', '|', ',', BLANKS, '^', '~', '&', '\x1f', '\x1e')
"""What may part the cells; a comma may be a decimal sign as well, blanks stand in a date."""
NAMES_OF_SIGNS = ('semicolon', 'tab', 'bar', 'comma', 'blank', '^', '~', '&')
OTHER_SIGNS = ('::', ':', '!', '*', '$', '§', '¦', '\\')
"""What may part cells in a file that is not read so."""
FEWEST = 5  # lines that hold one of them as often each
TORN_TIME = r'(?<=\d:\d\d:\d\d);(?=\d{3}(?:;|\s*$))'
"""Semicolon before milliseconds, as Rockwell writes it, which parts cells as well."""
WHOLE = ':'
FIRST = 200  # lines that show whether times are torn


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class Line:
    """A row of a file as a text or as cells, and its number in the file."""

    raw: str
    row: int
    cells: tuple[str, ...] = ()


def separators_of(lines: Sequence[Line]) -> tuple[str, ...]:
    """Return the signs that may part the cells of lines, and the first that parts none."""
    if lines and lines[0].cells:
        return ('',)
    match = SEPARATED.match(lines[0].raw) if lines else None
    if match and match['sign'] in SEPARATORS:
        return (match['sign'],)
    text = '\n'.join(line.raw for line in lines)
    idle = [sign for sign in SEPARATORS if sign != BLANKS and sign not in text]
    return tuple(sign for sign in SEPARATORS if sign not in idle[1:])


def cells_of_line(line: Line, separator: str) -> list[str]:
    """Return the cells of a line without blanks around them."""
    if line.cells:
        return [cell.strip() for cell in line.cells]
    text = line.raw.strip('\r\n')
    if separator == BLANKS:
        return [cell.strip('"') for cell in re.findall(r'"[^"]*"|\S+', text)]
    if '"' not in text:
        return [cell.strip() for cell in text.split(separator)]
    try:
        rows = list(csv.reader([text], delimiter=separator, skipinitialspace=True))
    except csv.Error:
        if len(text) > csv.field_size_limit():
            raise
        return []
    return [cell.strip() for cell in rows[0]] if rows else []


def unread_separator(lines: Sequence[Line]) -> str:
    """Return the sign that seems to part the cells of lines where none that is read does so."""
    texts = [line.raw for line in lines if line.raw.strip()]
    for sign in OTHER_SIGNS if len(texts) >= FEWEST else ():
        counts = {text.count(sign) for text in texts}
        if len(counts) == 1 and counts != {0}:
            return sign
    return ''


def are_torn(lines: Sequence[str]) -> bool:
    """Return True if rows hold one cell more than their head, as their times are in two."""
    counts = [line.rstrip(';\r\n').count(';') for line in lines]
    times = [len(re.findall(TORN_TIME, line)) for line in lines]
    first = next((at for at, count in enumerate(times) if count), 0)
    if not first:
        return False
    most = max(range(first, len(lines)), key=lambda at: counts[at])
    return counts[most] - times[most] == max(counts[:first])


def whole_times(lines: list[str]) -> list[str]:
    """Return lines with whole times, where the first lines are torn."""
    return [re.sub(TORN_TIME, WHOLE, line) for line in lines] if are_torn(lines[:FIRST]) else lines
