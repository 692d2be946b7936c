# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
The sqlite3 files that a bag is made of: topics, time span and messages of each.

A damaged file is refused, or salvaged when that is asked for: then its intact part is read, and
`note` says how much it was.

"""

from collections import Counter
from collections.abc import Collection, Generator, Iterator
import contextlib
from pathlib import Path
from typing import Any

from ballscrew_monitor.recordings.sqlite_pages import ends_with_a_page, whole_messages
from ballscrew_monitor.recordings.storages import (
    by_log_time,
    Message,
    REORDER,
    salvage_note,
    TopicInfo,
)
import numpy as np
from numpy.typing import NDArray
from surrogate.files import InputError


class SqliteStorage:
    """One sqlite3 file of rosbag2; `salvage` takes the intact part of a damaged one."""

    def __init__(self, file: Path, *, salvage: bool = False) -> None:
        """Read the topics; raises InputError when nothing can be had of the file."""
        self.file, self.salvage = file, salvage
        self.topics: dict[str, TopicInfo] = {}
        self.span = (0, 0)
        self.note = ''
        self._strays: frozenset[int] = frozenset()  # places of rows with a garbled time
        try:
            self._read_topics()
        except InputError:
            if not salvage or not self._read_whole():
                raise

    def messages(
        self, wanted: Collection[str], *, as_written: bool = False
    ) -> Generator[Message, None, None]:
        """
        Yield the messages of the topics `wanted` by log time; raises InputError on damage.

        They were written in that order too.

        """
        found = by_log_time(self._whole()) if self.note else self._indexed(wanted)
        yield from (one for one in found if one.topic in wanted)

    def _read_topics(self) -> None:
        with self._opened() as reader:
            if self.salvage:
                self._check()
            self.topics = {
                connection.topic: TopicInfo(
                    type_name=connection.msgtype,
                    encoding=connection.ext.serialization_format,
                    count=connection.msgcount,
                )
                for connection in reader.connections
            }
            self.span = (reader.start_time, reader.end_time - 1) if reader.duration else (0, 0)

    def _check(self) -> None:
        """Raise apsw.Error unless rows and index agree: damage may look like a message."""
        import apsw

        with self._database() as database:
            ((fault,),) = database.execute('PRAGMA integrity_check(1)')
        if fault != 'ok':
            raise apsw.CorruptError(fault)

    def _indexed(self, wanted: Collection[str]) -> Iterator[Message]:
        with self._opened() as reader:
            chosen = [one for one in reader.connections if one.topic in wanted]
            # An empty choice means all to this reader.
            for connection, time, data in reader.messages(chosen) if chosen else ():
                yield Message(topic=connection.topic, data=data, log_time=time, publish_time=time)

    def _read_whole(self) -> bool:
        """Read all that is whole once, for topics, span and the note; tell if there is some."""
        rows = [row[:2] for row in whole_messages(self.file)]
        self._strays = strays(np.array(rows, dtype=np.float64).reshape(-1, 2))
        counts: Counter[str] = Counter()
        begin = end = 0
        for message in self._whole():
            begin = min(begin, message.log_time) if counts else message.log_time
            end = max(end, message.log_time)
            counts[message.topic] += 1
        self.topics = {
            name: TopicInfo(type_name=type_name, encoding=encoding, count=counts[name])
            for name, type_name, encoding in self._topic_rows().values()
            if counts[name]
        }
        self.span = (begin, end)
        self.note = salvage_note(self.file, counts.total(), self.span) if counts else ''
        return bool(counts)

    def _whole(self) -> Iterator[Message]:
        """Yield the messages that are whole, as written."""
        topics = self._topic_rows()
        for place, (number, time, data) in enumerate(whole_messages(self.file) if topics else ()):
            if number in topics and place not in self._strays:
                yield Message(topic=topics[number][0], data=data, log_time=time, publish_time=time)

    def _topic_rows(self) -> dict[int, tuple[str, str, str]]:
        """Return name, type and encoding of the topics by number, none of a file without."""
        import apsw

        try:
            with self._database() as database:
                # Or a file that is shorter than it says is not opened at all.
                database.execute('PRAGMA writable_schema=ON')
                rows = database.execute('SELECT id, name, type, serialization_format FROM topics')
                return {number: (name, kind, form) for number, name, kind, form in rows}
        except apsw.Error:
            return {}

    def _database(self) -> contextlib.closing[Any]:
        import apsw

        flags = apsw.SQLITE_OPEN_READONLY | apsw.SQLITE_OPEN_URI
        name = f'{self.file.resolve().as_uri()}?immutable=1'
        return contextlib.closing(apsw.Connection(name, flags=flags))

    @contextlib.contextmanager
    def _opened(self) -> Iterator[Any]:
        import apsw
        from rosbags.rosbag2 import Reader, ReaderError

        try:
            # A page that the file ends in would be read as zeros.
            if not ends_with_a_page(self.file):
                raise ReaderError('it ends within a page')
            with Reader(self.file) as reader:
                yield reader
        except (ReaderError, apsw.Error, OSError) as error:
            reason = ' '.join(str(error).split())
            raise InputError(
                f'bag {self.file} is truncated or damaged, it must be a complete sqlite3 file of '
                f'rosbag2 ({reason})'
            ) from None


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
    found[1:-1] = (times[1:-1] < low - REORDER) | (times[1:-1] > high + REORDER)
    return found
