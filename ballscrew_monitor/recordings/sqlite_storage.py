# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
The sqlite3 files that a bag is made of; a damaged one is refused.

A recorder that was killed, or one that still runs, leaves a journal beside its file. SQLite works
it into a copy of both: nothing is written beside a bag.

"""

from collections.abc import Collection, Iterator
import contextlib
from pathlib import Path
import shutil
import sqlite3

from ballscrew_monitor.recordings import storages
from ballscrew_monitor.recordings.storages import Message, Storage, TopicInfo
from ballscrew_monitor.recordings.unpacking import scratch_folder
from surrogate.files import InputError, limits
from surrogate.files.store import size_of

HEADER = 100  # [bytes] of a file, with the size of its pages
MESSAGES = f"""
SELECT topic_id, timestamp, data FROM messages
    WHERE typeof(topic_id) = 'integer' AND typeof(timestamp) = 'integer'
    AND typeof(data) = 'blob' AND length(data) <= {limits.MESSAGE}
"""
"""Rows that are messages, of whatever topic."""
BY_LOG_TIME, AS_WRITTEN = 'ORDER BY timestamp, id', 'ORDER BY id'
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
DAMAGE = (sqlite3.Error, OSError, UnicodeDecodeError, MemoryError)
LOG, ROLLBACK = '-wal', '-journal'  # endings of the journals of SQLite
LOG_HEADER, FRAME_HEADER = 32, 24  # [bytes] of a write-ahead log, and before each page in it
ROLLBACK_MAGIC = bytes.fromhex('d9d505f920a163d7')


class SqliteStorage(Storage):
    """One sqlite3 file of rosbag2."""

    def __init__(self, file: Path) -> None:
        """Read the topics; raises InputError if the file is damaged."""
        self._source, remarks = file, list[str]()
        place = file.resolve()  # beside which SQLite puts its journals
        beside = [place.with_name(place.name + ending) for ending in (LOG, ROLLBACK)]
        if journals := [path for path in beside if size_of(path)]:
            self._source, remarks = _merged(file, journals, scratch_folder(self))
        super().__init__(file)
        for remark in remarks:
            self._remark(remark)

    def messages(self, wanted: Collection[str], *, as_written: bool = False) -> storages.Stream:
        """Yield the messages, see `Storage`."""
        topics = {
            number: name for number, (name, *_) in self._topic_rows().items() if name in wanted
        }
        marks = ', '.join('?' for _ in topics)
        order = AS_WRITTEN if as_written else BY_LOG_TIME
        with self._opened() as database:
            rows = database.execute(f'{MESSAGES} AND topic_id IN ({marks}) {order}', [*topics])
            for number, time, data in rows:
                yield Message(topic=topics[number], data=data, log_time=time, publish_time=time)

    def _read_topics(self) -> None:
        with self._opened() as database:
            # Rows and index must agree: damage may look like a message.
            ((fault,),) = database.execute('PRAGMA integrity_check(1)')
            if fault != 'ok':
                raise sqlite3.DatabaseError(fault)
            names = dict.fromkeys(('topics', 'messages'), 0)
            for name, text in database.execute(TABLES):
                names[name] += text.upper().startswith('CREATE TABLE')
            if not all(names.values()):
                raise sqlite3.DatabaseError(f'no table of {", ".join(names)}')
            counts = {number: rest for number, *rest in database.execute(COUNTS)}
            ((total,),) = database.execute('SELECT count(*) FROM messages')
        lost, times = total, list[int]()
        for number, (name, kind, form) in self._topic_rows().items():
            count, *span = counts.get(number, [0])
            self.topics[name] = TopicInfo(type_name=kind, encoding=form, count=count)
            lost, times = lost - count, times + span
        if times:
            self.span = (min(times), max(times))
        if lost:
            self.note = (
                f'bag {self.file}: {lost} of its {total} rows are of an unknown topic or hold no '
                'message: they are left out'
            )

    def _topic_rows(self) -> dict[int, tuple[str, str, str]]:
        """Return name, type and encoding of the topics by number."""
        with self._opened() as database:
            return {number: tuple(rest) for number, *rest in database.execute(TOPICS)}

    @contextlib.contextmanager
    def _opened(self) -> Iterator[sqlite3.Connection]:
        try:
            # A page that the file ends in would be read as zeros.
            if not ends_with_a_page(self._source):
                raise sqlite3.DatabaseError('it ends within a page')
            name = f'{self._source.resolve().as_uri()}?mode=ro&immutable=1'
            connection = sqlite3.connect(name, uri=True, check_same_thread=False)
            with contextlib.closing(connection) as database:
                yield database
        except DAMAGE as error:
            raise _damaged(self.file, error) from None


def _damaged(file: Path, error: BaseException) -> InputError:
    reason = ' '.join(str(error).split()) or type(error).__name__
    return InputError(
        f'bag {file} is truncated or damaged, it must be a complete sqlite3 file of rosbag2 '
        f'({reason}), sqlite3 {file} .recover prints what is whole as SQL for a new file'
    )


def _merged(file: Path, journals: list[Path], folder: Path) -> tuple[Path, list[str]]:
    """
    Return a copy of a file in `folder` with its journals worked in, and what they leave out.

    Raises InputError if they cannot be copied, or if SQLite cannot read them.

    """
    parts, before = [file.resolve(), *journals], file.stat().st_mtime_ns
    size, free = sum(map(size_of, parts)), shutil.disk_usage(folder).free
    if 2 * size > free:
        raise InputError(
            f'bag {file} is read from a copy with its journal of {size / limits.MEGA:.0f} MB, '
            f'allowed is half of the free disk, {free / 2 / limits.MEGA:.0f} MB'
        )
    copy = folder / parts[0].name
    with storages.damage_is_input(file):
        for path in parts:
            shutil.copyfile(path, folder / path.name)
        if file.stat().st_mtime_ns != before:  # the log is of another state of the file
            raise InputError(f'bag {file} is being written, it can be read once that has ended')
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


def ends_with_a_page(file: Path) -> bool:
    """Return True if a file is made of whole pages."""
    with file.open('rb') as stream:
        header = stream.read(HEADER)
        size = int.from_bytes(header[16:18], 'big')
        return stream.seek(0, 2) % (65536 if size == 1 else max(size, 512)) == 0
