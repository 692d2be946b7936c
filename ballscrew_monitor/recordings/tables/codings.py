# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Codings of a text: UTF-8, UTF-16 and UTF-32 with a mark or without, one byte for a letter, gzip.

A wide or packed text is decoded in memory, so that its size is bounded.

"""

import codecs
import contextlib
import gzip
from pathlib import Path
import re
import zlib

from ballscrew_monitor.recordings.tables.cells import first_line
from ballscrew_monitor.recordings.tables.names import KINDS
from ballscrew_monitor.recordings.tables.unit_names import words_of
from surrogate.files import InputError, limits

GZIP = b'\x1f\x8b'
MARKS = {
    b'\xff\xfe\0\0': 'utf-32',
    b'\0\0\xfe\xff': 'utf-32',
    b'\xff\xfe': 'utf-16',
    b'\xfe\xff': 'utf-16',
}
"""Marks of a coding, the longer ones first."""
SHAPES = {
    'utf-32-le': re.compile(rb'(?:[^\0]\0\0\0){4,}'),
    'utf-32-be': re.compile(rb'(?:\0\0\0[^\0]){4,}'),
    'utf-16-le': re.compile(rb'(?:[^\0]\0){8,}'),
    'utf-16-be': re.compile(rb'(?:\0[^\0]){8,}'),
}
"""How the first letters of a text without a mark look, most of which are of ASCII."""
NARROW, BYTES = ('cp1252', 'cp1250'), 'latin-1'
"""Codings of one byte for a letter: of the west and the middle of Europe, and of any byte."""
WORDS = frozenset[str]().union(*KINDS.values())
"""Words of quantities."""
NUL = b'\0'
TAIL = 4096  # [bytes] at the end of a file in which NULs may begin


def wide_coding(head: bytes) -> str:
    """Return the coding of a text whose letters take two or four bytes, empty for any other."""
    marked = next((coding for mark, coding in MARKS.items() if head.startswith(mark)), '')
    shaped = (coding for coding, shape in SHAPES.items() if shape.match(head))
    return marked or next(shaped, '')


def text_of(content: bytes) -> str:
    """Return a text in its coding; a letter that is cut off at its end is left out."""
    if coding := wide_coding(content):
        return content[: len(content) // 4 * 4].decode(coding, errors='replace')
    with contextlib.suppress(UnicodeDecodeError):
        return codecs.getincrementaldecoder('utf-8-sig')().decode(content)
    lines, coding = content.splitlines(keepends=True), narrow_coding(content)
    return ''.join(line_of(line, coding) for line in lines).removeprefix('\ufeff')


def narrow_coding(content: bytes) -> str:
    """
    Return the coding of the lines that are not of UTF-8, empty if there are none.

    Of those for the west and the middle of Europe it is that with more words of quantities.

    """
    others = b''.join(line for line in content.splitlines(keepends=True) if not _fits(line))

    def known(coding: str) -> int:
        return len({*words_of(others.decode(coding, 'replace'))} & WORDS)

    return max(NARROW, key=known) if others else ''


def line_of(line: bytes, coding: str) -> str:
    """Return a line of UTF-8, or else of a coding if it fits."""
    for each in ('utf-8', coding or BYTES):
        with contextlib.suppress(UnicodeError):
            return line.decode(each)
    return line.decode(BYTES)


def _fits(line: bytes) -> bool:
    try:
        line.decode()
    except UnicodeDecodeError:
        return False
    return True


def decoded(path: Path, head: bytes) -> bytes | None:
    """Return a text in UTF-8 by its first bytes, None if it can be read as it is."""
    if head.startswith(GZIP):
        content = unpacked(path)
        coding = wide_coding(content)
        return _narrow(path, content, coding) if coding else content.rstrip(NUL)
    if coding := wide_coding(head):
        _check_size(path, f'of {coding.upper()[:6]}', 'save it as UTF-8')
        return _narrow(path, path.read_bytes(), coding)
    with path.open('rb') as stream:
        stream.seek(max(path.stat().st_size - TAIL, 0))
        ends_with_nul = stream.read().endswith(NUL)
    if ends_with_nul:
        _check_size(path, 'with NULs behind its end', 'cut these off')
        return path.read_bytes().rstrip(NUL)
    return None


def unpacked(path: Path, size: int = 0) -> bytes:
    """Return what is packed in a file by gzip, `size` bytes of it at least if it holds so much."""
    most = min(limits.most_unpacked(path.stat().st_size), limits.WORKBOOK)
    parts, length = [], 0
    try:
        with gzip.open(path) as stream:
            while length <= most and (part := stream.read(limits.MEGA)):
                parts.append(part)
                length += len(part)
                if size and length >= size:
                    return b''.join(parts)[:size]
    except EOFError:
        raise InputError(f'log {path} is cut off within what gzip packed: pack it again') from None
    except (zlib.error, gzip.BadGzipFile) as error:
        raise InputError(f'log {path} cannot be unpacked by gzip: {first_line(error)}') from None
    if length > most:
        raise InputError(
            f'log {path} comes to more than {most // limits.MEGA} MB when it is unpacked: unpack '
            'it before'
        )
    return b''.join(parts)


def _narrow(path: Path, content: bytes, coding: str) -> bytes:
    """Return a text of a coding in UTF-8; raises InputError."""
    try:
        return content.decode(coding).rstrip('\0').encode()
    except UnicodeError as error:
        name = coding.upper()[:6]
        raise InputError(f'log {path} cannot be read as {name}: {first_line(error)}') from None


def _check_size(path: Path, what: str, cure: str) -> None:
    if path.stat().st_size > limits.WORKBOOK:
        raise InputError(
            f'log {path} {what} has more than {limits.WORKBOOK // limits.MEGA} MB: {cure}'
        )
