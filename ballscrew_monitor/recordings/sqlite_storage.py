# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
The sqlite3 files that a bag is made of: topics, time span and messages of each.

A damaged file is refused, or salvaged when that is asked for: then what is whole is read, and
`note` says how much it was.

"""

from collections import Counter
from collections.abc import Collection, Generator, Iterator
import contextlib
from pathlib import Path
from typing import Any

from ballscrew_monitor.recordings.sqlite_pages import ends_with_a_page, whole_messages
from ballscrew_monitor.recordings.storages import by_log_time, Message, salvage_note, TopicInfo
from surrogate.files import InputError


class SqliteStorage:
    """One sqlite3 file of rosbag2; `salvage` takes what is whole of a damaged one."""

    def __init__(self, file: Path, *, salvage: bool = False) -> None:
        """Read the topics; raises InputError when nothing can be had of the file."""
        self.file, self.salvage = file, salvage
        self.topics: dict[str, TopicInfo] = {}
        self.span = (0, 0)
        self.note = ''
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
        last = -1
        try:
            for message in () if self.note else self._indexed(wanted):
                yield message
                last = message.log_time
        except InputError as error:
            if not self.salvage:
                raise
            self.note = f'{error}; what is whole of it is used'
        if self.note:
            whole = by_log_time(self._whole())
            yield from (one for one in whole if one.log_time > last and one.topic in wanted)

    def _read_topics(self) -> None:
        with self._opened() as reader:
            self.topics = {
                connection.topic: TopicInfo(
                    type_name=connection.msgtype,
                    encoding=connection.ext.serialization_format,
                    count=connection.msgcount,
                )
                for connection in reader.connections
            }
            self.span = (reader.start_time, reader.end_time - 1) if reader.duration else (0, 0)

    def _indexed(self, wanted: Collection[str]) -> Iterator[Message]:
        with self._opened() as reader:
            chosen = [one for one in reader.connections if one.topic in wanted]
            # An empty choice means all to this reader.
            for connection, time, data in reader.messages(chosen) if chosen else ():
                yield Message(topic=connection.topic, data=data, log_time=time, publish_time=time)

    def _read_whole(self) -> bool:
        """Read all that is whole once, for topics, span and the note; tell if there is some."""
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
        for number, time, data in whole_messages(self.file) if topics else ():
            if number in topics:
                yield Message(topic=topics[number][0], data=data, log_time=time, publish_time=time)

    def _topic_rows(self) -> dict[int, tuple[str, str, str]]:
        """Return name, type and encoding of the topics by number, none of a file without."""
        import apsw

        flags = apsw.SQLITE_OPEN_READONLY | apsw.SQLITE_OPEN_URI
        try:
            with contextlib.closing(
                apsw.Connection(f'{self.file.resolve().as_uri()}?immutable=1', flags=flags)
            ) as database:
                # Or a file that is shorter than it says is not opened at all.
                database.execute('PRAGMA writable_schema=ON')
                rows = database.execute('SELECT id, name, type, serialization_format FROM topics')
                return {number: (name, kind, form) for number, name, kind, form in rows}
        except apsw.Error:
            return {}

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
