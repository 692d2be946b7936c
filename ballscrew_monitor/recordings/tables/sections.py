# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Sections of a measurement file of LabVIEW, each of which has a head, names and rows of its own.

Sections of one head are runs of one table, whose times begin again. Others are no table.

"""

from collections.abc import Iterator, Sequence
import itertools
from pathlib import Path

from ballscrew_monitor.recordings.words import short
from surrogate.files import InputError

MARK = b'LabVIEW Measurement'
END_OF_HEAD, HEADS = '***End_of_Header***', 2
"""Line that ends a head of LabVIEW, and how many of them a file with one section has."""
OWN = frozenset({b'Date', b'Time', b'Samples'})
"""Fields of a head that are of its section alone."""
APART = 'save each section as a log'


def joined_sections(path: Path, content: bytes) -> tuple[bytes, int]:
    """
    Return a text with the head of its first section alone, and how many sections it has.

    Raises InputError where the heads differ in more than start and length, or its rows have no
    times, which would begin again.

    """
    lines, end_of_head = content.splitlines(keepends=True), END_OF_HEAD.encode()
    ends = [at for at, line in enumerate(lines) if line.startswith(end_of_head)]
    if len(ends) <= HEADS:
        return content, max(len(ends) - 1, 0)
    begins = [_begin(lines, end) for end in ends[1:]]
    first, *others = [
        {**_fields(lines[begin:end]), b'names': _cells(b''.join(lines[end:][1:2]))}
        for begin, end in zip(begins, ends[1:], strict=True)
    ]
    for end, head in zip(ends[2:], others, strict=True):
        for key in [key for key in {**first, **head} if first.get(key) != head.get(key)]:
            one, other = (_text(key, each) for each in (first, head))
            raise InputError(
                f'log {path}: the head of another section that ends in row {end + 1} states '
                f'{short(repr(other))}, and the first one {short(repr(one))}: {APART}'
            )
    if _fields(lines[: ends[0]]).get(b'X_Columns') == [b'No']:
        raise InputError(
            f'log {path}: it has {len(ends) - 1} sections without times (X_Columns is No), which '
            f'rows at equal distances would join: {APART}'
        )
    heads = zip(begins[1:], ends[2:], strict=True)
    left_out = set(itertools.chain(*(range(begin, end + 2) for begin, end in heads)))
    kept = (line for at, line in enumerate(lines) if at not in left_out)
    return b''.join(kept), len(ends) - 1


def _begin(lines: Sequence[bytes], end: int) -> int:
    """Return the first line of a head that ends in a line: rows begin with a number or a tab."""
    heads = (at for at in range(end - 1, -1, -1) if not lines[at].strip()[:1].isalpha())
    return next((at + 1 for at in heads if lines[at].strip()), 0)


def _cells(line: bytes) -> list[bytes]:
    return [cell.strip() for cell in line.replace(b',', b'\t').split(b'\t') if cell.strip()]


def _fields(lines: Sequence[bytes]) -> dict[bytes, list[bytes]]:
    """Return the fields of a head that another section of the same table has as well."""

    def fields() -> Iterator[tuple[bytes, list[bytes]]]:
        for key, *values in filter(None, map(_cells, lines)):
            if key not in OWN:
                yield key, values

    return dict(fields())


def _text(key: bytes, head: dict[bytes, list[bytes]]) -> str:
    return b' '.join([key, *head.get(key, [])]).decode('utf-8', errors='replace')
