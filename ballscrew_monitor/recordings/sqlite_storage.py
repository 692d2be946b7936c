# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
The sqlite3 files that a bag is made of, and the messages in the pages of one that is not whole.

The tree over the pages is of no use there: its upper pages may be those that are lost. So each
page is looked at by itself; one that is a leaf of the table `messages` holds rows of id, topic,
time and data, and data that are long go on in further pages. The format of pages and rows is that
of https://www.sqlite.org/fileformat.html, sections 1.6 and 2.1.

A recorder that was killed, or one that still runs, leaves a journal beside its file. SQLite works
it into a copy of both: nothing is written beside a bag.

"""

from collections.abc import Collection, Iterator
import contextlib
from pathlib import Path
import shutil
import sqlite3
import struct
from typing import BinaryIO

from ballscrew_monitor.recordings import storages
from ballscrew_monitor.recordings.storages import Message, Storage, TopicInfo
from ballscrew_monitor.recordings.unpacking import scratch_folder
import numpy as np
from numpy.typing import NDArray
from surrogate import limits
from surrogate.files import InputError
from surrogate.store import size_of

HEADER = 100  # [bytes] of a file
LEAF = 0x0D  # a page of rows begins so
CELLS = 8  # [bytes] before the places of the rows of a page
INTEGERS = {1: 1, 2: 2, 3: 3, 4: 4, 5: 6, 6: 8, 8: 0, 9: 0}  # [bytes] by the type of a value
MESSAGES = f"""
SELECT topic_id, timestamp, data FROM messages
    WHERE typeof(topic_id) = 'integer' AND typeof(timestamp) = 'integer'
    AND typeof(data) = 'blob' AND length(data) <= {limits.MESSAGE}
"""
"""Rows that are messages, of whatever topic."""
ORDER = 'ORDER BY timestamp, id'
COUNTS = (
    f'SELECT topic_id, count(*), min(timestamp), max(timestamp) FROM ({MESSAGES})'
    ' GROUP BY topic_id'
)
TOPICS = """
SELECT id, name, type, serialization_format FROM topics
    WHERE typeof(id) = 'integer' AND typeof(name) = 'text' AND typeof(type) = 'text'
    AND typeof(serialization_format) = 'text'
"""
TABLES = (
    "SELECT name, sql FROM sqlite_master WHERE type = 'table' AND name IN ('topics', 'messages')"
)
NO_ROW = (IndexError, ValueError, struct.error, EOFError)
DAMAGE = (sqlite3.Error, OSError, UnicodeDecodeError, MemoryError)
LOG, ROLLBACK = '-wal', '-journal'  # endings of the journals of SQLite
LOG_HEADER, FRAME_HEADER = 32, 24  # [bytes] of a write-ahead log, and before each page in it
ROLLBACK_MAGIC = bytes.fromhex('d9d505f920a163d7')


class SqliteStorage(Storage):
    """One sqlite3 file of rosbag2."""

    _strays: frozenset[int] = frozenset()  # places of rows with a garbled time

    def __init__(self, file: Path, *, salvage: bool = False) -> None:
        """Read the topics; raises InputError when nothing can be had of the file."""
        self._source, remarks = file, list[str]()
        if journals := _journals(file):
            try:
                self._source, remarks = _merged(file, journals, scratch_folder(self))
            except InputError as error:
                if not salvage:
                    raise
                names = ' and '.join(path.name for path in journals)
                remarks = [f'{error}; {names} is left out']
        super().__init__(file, salvage=salvage)
        for remark in remarks:
            self._remark(remark)

    def messages(self, wanted: Collection[str], *, as_written: bool = False) -> storages.Stream:
        """Yield the messages, see `Storage`; they were written by log time, too."""
        found = self._indexed(wanted) if self.is_indexed else storages.by_log_time(self._whole())
        yield from (one for one in found if one.topic in wanted)

    def _read_topics(self) -> None:
        with self._opened() as database:
            if self.salvage:  # rows and index must agree: damage may look like a message
                ((fault,),) = database.execute('PRAGMA integrity_check(1)')
                if fault != 'ok':
                    raise sqlite3.DatabaseError(fault)
            names = dict.fromkeys(('topics', 'messages'), 0)
            for name, text in database.execute(TABLES):
                names[name] += text.upper().startswith('CREATE TABLE')
            if not all(names.values()):
                raise sqlite3.DatabaseError(f'no table of {", ".join(names)}')
            found = {number: rest for number, *rest in database.execute(COUNTS)}
            ((total,),) = database.execute('SELECT count(*) FROM messages')
        known = {number: row for number, row in self._topic_rows().items() if number in found}
        self._take(found, known)
        self._lost(total - sum(found[number][0] for number in known), total)

    def _take(self, found: dict[int, list[int]], known: dict[int, tuple[str, str, str]]) -> None:
        """Take the topics, and the span of the messages that are of one."""
        for number, (name, kind, form) in self._topic_rows().items():
            count = found[number][0] if number in known else 0
            self.topics[name] = TopicInfo(type_name=kind, encoding=form, count=count)
        times = [time for number in known for time in found[number][1:]]
        if times:
            self.span = (min(times), max(times))

    def _lost(self, count: int, total: int) -> None:
        if count:
            self.note = (
                f'bag {self.file}: {count} of its {total} rows are of an unknown topic or hold no '
                'message: they are left out'
            )

    def _indexed(self, wanted: Collection[str]) -> Iterator[Message]:
        topics = {
            number: name for number, (name, *_) in self._topic_rows().items() if name in wanted
        }
        marks = ', '.join('?' for _ in topics)
        with self._opened() as database:
            rows = database.execute(f'{MESSAGES} AND topic_id IN ({marks}) {ORDER}', [*topics])
            for number, time, data in rows:
                yield Message(topic=topics[number], data=data, log_time=time, publish_time=time)

    def _read_whole(self) -> None:
        rows = [row[:2] for row in whole_messages(self._source)]
        self._strays = strays(np.array(rows, dtype=np.float64).reshape(-1, 2))
        counts = self._counted(self._whole())
        self.topics = {
            name: TopicInfo(type_name=type_name, encoding=encoding, count=counts[name])
            for name, type_name, encoding in self._topic_rows().values()
            if counts[name]
        }

    def _whole(self) -> Iterator[Message]:
        """Yield the messages that are whole, as written."""
        topics = self._topic_rows()
        for place, (number, time, data) in enumerate(
            whole_messages(self._source) if topics else ()
        ):
            if number in topics and place not in self._strays:
                yield Message(topic=topics[number][0], data=data, log_time=time, publish_time=time)

    def _topic_rows(self) -> dict[int, tuple[str, str, str]]:
        """Return name, type and encoding of the topics by number, none of a file without."""
        try:
            with self._database() as database:
                # Or a file that is shorter than it says is not opened at all.
                database.execute('PRAGMA writable_schema=ON')
                return {
                    number: (name, kind, form)
                    for number, name, kind, form in database.execute(TOPICS)
                }
        except DAMAGE:
            return {}

    def _database(self) -> contextlib.closing[sqlite3.Connection]:
        name = f'{self._source.resolve().as_uri()}?mode=ro&immutable=1'
        return contextlib.closing(sqlite3.connect(name, uri=True, check_same_thread=False))

    @contextlib.contextmanager
    def _opened(self) -> Iterator[sqlite3.Connection]:
        try:
            # A page that the file ends in would be read as zeros.
            if not ends_with_a_page(self._source):
                raise sqlite3.DatabaseError('it ends within a page')
            with self._database() as database:
                yield database
        except DAMAGE as error:
            raise _damaged(self.file, error) from None


def _damaged(file: Path, error: BaseException) -> InputError:
    reason = ' '.join(str(error).split()) or type(error).__name__
    return InputError(
        f'bag {file} is truncated or damaged, it must be a complete sqlite3 file of rosbag2 '
        f'({reason})'
    )


def _journals(file: Path) -> list[Path]:
    """Return the journals beside a file that are not empty."""
    place = file.resolve()  # where SQLite puts them
    beside = [place.with_name(place.name + ending) for ending in (LOG, ROLLBACK)]
    return [path for path in beside if size_of(path)]


def _merged(file: Path, journals: list[Path], folder: Path) -> tuple[Path, list[str]]:
    """
    Return a copy of a file in `folder` with its journals worked in, and what they leave out.

    Raises InputError if they cannot be copied, or if SQLite cannot read them.

    """
    copy = _copied(file, journals, folder)
    log, rollback = (copy.with_name(copy.name + ending) for ending in (LOG, ROLLBACK))
    written, remarks = _written_pages(log), _rolled_back(file, rollback)
    try:
        with contextlib.closing(sqlite3.connect(copy, isolation_level=None)) as database:
            database.execute('SELECT count(*) FROM sqlite_master').fetchall()  # rolls back
            ((_, used, done),) = database.execute('PRAGMA wal_checkpoint')
        if used != done:
            raise sqlite3.DatabaseError(f'{used - done} of {used} pages of {log.name} are lost')
    except DAMAGE as error:
        raise _damaged(file, error) from None
    if written > max(used, 0):
        remarks.append(
            f'bag {file}: pages of {log.name} are damaged or of a transaction that was not '
            'finished: they are left out, and the messages in them'
        )
    return copy, remarks


def _copied(file: Path, journals: list[Path], folder: Path) -> Path:
    parts, before = [file.resolve(), *journals], file.stat().st_mtime_ns
    size, free = sum(map(size_of, parts)), shutil.disk_usage(folder).free
    if 2 * size > free:
        raise InputError(
            f'bag {file} is read from a copy with its journal of {size / limits.MEGA:.0f} MB, '
            f'allowed is half of the free disk, {free / 2 / limits.MEGA:.0f} MB'
        )
    copies = [folder / path.name for path in parts]
    with storages.damage_is_input(file):
        for path, copy in zip(parts, copies, strict=True):
            shutil.copyfile(path, copy)
        if file.stat().st_mtime_ns != before:  # the log is of another state of the file
            raise InputError(f'bag {file} is being written, it can be read once that has ended')
    return copies[0]


def _written_pages(log: Path) -> int:
    """Return how many pages a write-ahead log holds since it was begun, those not in use too."""
    size = size_of(log)
    if size <= LOG_HEADER:
        return 0
    with log.open('rb') as stream:
        header = stream.read(LOG_HEADER)
        step = FRAME_HEADER + int.from_bytes(header[8:12], 'big')
        count, place = 0, LOG_HEADER
        while place < size:
            stream.seek(place)
            if stream.read(FRAME_HEADER)[8:16] != header[16:24]:  # the numbers of its begin
                break
            count, place = count + 1, place + step
    return max(count, 1)  # one without any is damaged


def _rolled_back(file: Path, rollback: Path) -> list[str]:
    """Return what is to be said of a rollback journal, nothing unless its transaction is open."""
    if not size_of(rollback):
        return []
    with rollback.open('rb') as stream:
        head = stream.read(len(ROLLBACK_MAGIC))
    if head == ROLLBACK_MAGIC:
        return [
            f'bag {file}: {rollback.name} holds a transaction that was not finished: it is rolled '
            'back, its messages are left out'
        ]
    if not head[0]:  # a transaction that was finished
        return []
    return [
        f'bag {file}: {rollback.name} is damaged: messages of a transaction that was not finished '
        'may be among the others'
    ]


def strays(rows: NDArray[np.float64]) -> frozenset[int]:
    """
    Return the places of rows, of topic number and time [ns], whose time is out of place.

    A clock may be set, so that a time is believed if it lies between those before and after, by
    `REORDER` at most. Those are times of the same topic, at its ends of any.

    """
    found = _outside(rows[:, 1])
    for number in np.unique(rows[:, 0]):
        places = np.flatnonzero(rows[:, 0] == number)
        found[places[1:-1]] = _outside(rows[places, 1])[1:-1]
    return frozenset(np.flatnonzero(found).tolist())


def _outside(times: NDArray[np.float64]) -> NDArray[np.bool_]:
    """Tell which times are outside of their neighbours; the first and the last count as inside."""
    found = np.zeros(len(times), dtype=np.bool_)
    low, high = np.minimum(times[:-2], times[2:]), np.maximum(times[:-2], times[2:])
    found[1:-1] = (times[1:-1] < low - storages.REORDER) | (times[1:-1] > high + storages.REORDER)
    return found


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
    # Damaged: pages might lead in a circle.
    if length > min(pages.count * pages.size, limits.MESSAGE):
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
