# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Messages out of the pages of a sqlite3 file that is not whole.

The tree over the pages is of no use there: its upper pages may be those that are lost. So each
page is looked at by itself; one that is a leaf of the table `messages` holds rows of id, topic,
time and data, and data that are long go on in further pages. The format of pages and rows is that
of https://www.sqlite.org/fileformat.html, sections 1.6 and 2.1.

"""

from collections.abc import Iterator
from pathlib import Path
import struct
from typing import BinaryIO

HEADER = 100  # [bytes] of a file
LEAF = 0x0D  # a page of rows begins so
CELLS = 8  # [bytes] before the places of the rows of a page
INTEGERS = {1: 1, 2: 2, 3: 3, 4: 4, 5: 6, 6: 8, 8: 0, 9: 0}  # [bytes] by the type of a value
NO_ROW = (IndexError, ValueError, struct.error, EOFError)


def whole_messages(file: Path) -> Iterator[tuple[int, int, bytes]]:
    """Yield topic number, time [ns] and data of each message that is whole, as written."""
    with file.open('rb') as stream:
        pages = _Pages(stream)
        for number in range(2, pages.count + 1):  # the first one is that of the schema
            page = pages.read(number)
            if page[0] == LEAF:
                yield from _rows(pages, page)


def ends_with_a_page(file: Path) -> bool:
    """Tell whether a file is made of whole pages."""
    with file.open('rb') as stream:
        return not _Pages(stream).surplus


class _Pages:
    """The whole pages of a file, counted from 1; `surplus` bytes come after them."""

    def __init__(self, stream: BinaryIO) -> None:
        header = stream.read(HEADER)
        size = int.from_bytes(header[16:18], 'big')
        self.size = 65536 if size == 1 else max(size, 512)
        self.usable = self.size - (header[20] if len(header) == HEADER else 0)
        self.count, self.surplus = divmod(stream.seek(0, 2), self.size)
        self._stream = stream

    def read(self, number: int) -> bytes:
        """Return a page; raises EOFError where there is none."""
        if not 1 <= number <= self.count:
            raise EOFError
        self._stream.seek((number - 1) * self.size)
        return self._stream.read(self.size)


def _rows(pages: _Pages, page: bytes) -> Iterator[tuple[int, int, bytes]]:
    """Yield the messages of a page; what is no whole one is passed over."""
    (count,) = struct.unpack_from('>H', page, 3)
    for number in range(min(count, (pages.usable - CELLS) // 2)):
        try:
            (place,) = struct.unpack_from('>H', page, CELLS + 2 * number)
            yield _message(_payload(pages, page, place))
        except NO_ROW:
            continue


def _payload(pages: _Pages, page: bytes, place: int) -> bytes:
    """Return the bytes of the row at a place of a page, those of further pages included."""
    length, place = _varint(page, place)
    _, place = _varint(page, place)  # the number of the row
    if length > pages.count * pages.size:  # damaged: pages might lead in a circle
        raise EOFError
    local = _local(length, pages.usable)
    end = place + local
    found = bytearray(page[place:end])
    if local < length:
        (following,) = struct.unpack_from('>I', page, end)
        while len(found) < length:
            page = pages.read(following)
            (following,) = struct.unpack_from('>I', page)
            end = min(pages.usable, 4 + length - len(found))
            found += page[4:end]
    if len(found) != length:
        raise EOFError
    return bytes(found)


def _local(length: int, usable: int) -> int:
    """Return how many bytes of a row are in its page itself."""
    most = usable - 35
    if length <= most:
        return length
    least = (usable - 12) * 32 // 255 - 23
    local = least + (length - least) % (usable - 4)
    return local if local <= most else least


def _message(row: bytes) -> tuple[int, int, bytes]:
    """Return topic, time and data of a row; raises ValueError when it is of another table."""
    end, place = _varint(row, 0)
    kinds = []
    while place < end:
        kind, place = _varint(row, place)
        kinds.append(kind)
    if len(kinds) != 4 or kinds[0] or kinds[3] < 12 or kinds[3] % 2:
        raise ValueError
    topic, place = _integer(row, end, kinds[1])
    time, place = _integer(row, place, kinds[2])
    if len(row) - place != (kinds[3] - 12) // 2:
        raise ValueError
    return topic, time, row[place:]


def _integer(row: bytes, place: int, kind: int) -> tuple[int, int]:
    """Return an integer of a row, and where the next value begins."""
    if kind not in INTEGERS:
        raise ValueError
    end = place + INTEGERS[kind]
    return (1 if kind == 9 else int.from_bytes(row[place:end], 'big', signed=True)), end


def _varint(data: bytes, place: int) -> tuple[int, int]:
    """Return an integer of one to nine bytes, and where the next one begins."""
    value = 0
    for number in range(8):
        byte = data[place + number]
        value = value << 7 | byte & 0x7F
        if byte < 0x80:
            return value, place + number + 1
    return value << 8 | data[place + 8], place + 9
