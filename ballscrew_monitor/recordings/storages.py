# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
The files that a bag is made of, above all those of MCAP: topics, time span and messages of each.

A damaged file is refused, or salvaged when that is asked for: its intact part is read, and `note`
says how much it was.

"""

from collections import Counter
from collections.abc import Collection, Generator, Iterable, Iterator
import contextlib
import dataclasses
import heapq
import itertools
from pathlib import Path

from ballscrew_monitor.recordings.bag_files import MAGIC
from ballscrew_monitor.recordings.recover import DAMAGE, damaged_chunks, whole_records
from mcap.exceptions import McapError
from mcap.reader import make_reader
from mcap.records import Channel, Schema
from mcap.records import Message as McapMessage
from surrogate.files import InputError

MCAP = next(magic for magic, kind in MAGIC.items() if kind == 'mcap')
REORDER = 1_000_000_000  # [ns] log time over which messages of different chunks may be mixed


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class Message:
    """One serialised message; times [ns]."""

    topic: str
    data: bytes
    log_time: int
    publish_time: int
    sequence: int = 0


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class TopicInfo:
    """Type, encoding and number of messages of one topic."""

    type_name: str
    encoding: str
    count: int


Stream = Generator[Message, None, None]


class Storage:
    """One file of a bag; `salvage` takes the intact part of a damaged one."""

    def __init__(self, file: Path, *, salvage: bool = False) -> None:
        """Read the topics; raises InputError when nothing can be had of the file."""
        self.file, self.salvage = file, salvage
        self.topics: dict[str, TopicInfo] = {}
        self.span = (0, 0)
        self.note = ''
        self.is_indexed = True
        try:
            self._read_topics()
        except InputError:
            if not salvage or not file.is_file():
                raise
            self.is_indexed = False
            self._read_whole()
            if not self.topics:
                raise

    def messages(self, wanted: Collection[str], *, as_written: bool = False) -> Stream:
        """
        Yield the messages of the topics `wanted` by log time; raises InputError on damage.

        Those of the recording of a node are wanted `as_written`.

        """
        raise NotImplementedError

    def _read_topics(self) -> None:
        """Read what the file says of its topics; raises InputError on damage."""
        raise NotImplementedError

    def _read_whole(self) -> None:
        """Read all that is whole once, for topics, span and the note."""
        raise NotImplementedError

    def _counted(self, messages: Iterable[Message]) -> Counter[str]:
        """Count the messages that are whole by topic, and take down their span in the note."""
        counts: Counter[str] = Counter()
        begin = end = 0
        for message in messages:
            begin = min(begin, message.log_time) if counts else message.log_time
            end = max(end, message.log_time)
            counts[message.topic] += 1
        if counts:
            self.span = (begin, end)
            self.note = (
                f'bag {self.file} is truncated or damaged: used are the {counts.total()} messages '
                f'of {(end - begin) * 1e-9:.1f} s that are whole'
            )
        return counts


class McapStorage(Storage):
    """One MCAP file."""

    def __init__(self, file: Path, *, salvage: bool = False) -> None:
        """Read the topics; raises InputError when nothing can be had of the file."""
        self._schemas: dict[int, Schema] = {}
        self._channels: dict[int, Channel] = {}  # a damaged chunk may have named them
        self._lost: frozenset[int] = frozenset()  # where damaged chunks begin [bytes]
        with damage_is_input(file), file.open('rb') as stream:
            if not MCAP.startswith(stream.read(len(MCAP))):  # an empty file is cut short
                raise InputError(
                    f'bag {file} is neither an MCAP nor a sqlite3 file by its first bytes'
                )
        super().__init__(file, salvage=salvage)

    def messages(self, wanted: Collection[str], *, as_written: bool = False) -> Stream:
        """Yield the messages, see `Storage`; what has been salvaged meanwhile is noted."""
        reorder = not as_written
        if not self.is_indexed:
            yield from self._whole(wanted, reorder=reorder)
            return
        count = 0
        try:
            for message in self._indexed(wanted, reorder=reorder):
                yield message
                count += 1
        except InputError as error:
            if not self.salvage:
                raise
            self.note = f'{error}; its intact part is used'
            self._lost = damaged_chunks(self.file)
            # A file without chunks has no index to go on by.
            rest = self._indexed if self._lost else self._whole
            # What came before the damage comes first here too.
            yield from itertools.islice(rest(wanted, reorder=reorder), count, None)

    def _indexed(self, wanted: Collection[str], *, reorder: bool) -> Iterator[Message]:
        with damage_is_input(self.file), self.file.open('rb') as stream:
            reader = make_reader(stream, validate_crcs=True)
            if self._lost:
                summary = reader.get_summary()
                assert summary is not None  # there is one where chunks are known
                whole = [
                    one
                    for one in summary.chunk_indexes
                    if one.chunk_start_offset not in self._lost
                ]
                if not whole:
                    return
                summary.chunk_indexes = whole
            for _, channel, message in reader.iter_messages(
                topics=list(wanted), log_time_order=reorder
            ):
                yield _message(channel, message)

    def _read_topics(self) -> None:
        with damage_is_input(self.file), self.file.open('rb') as stream:
            summary = make_reader(stream, validate_crcs=True).get_summary()
            if summary is None or summary.statistics is None:
                raise McapError('it has no summary')
        statistics = summary.statistics
        self._schemas, self._channels = summary.schemas, summary.channels
        counts: Counter[str] = Counter()
        for number, channel in summary.channels.items():
            counts[channel.topic] += statistics.channel_message_counts.get(number, 0)
        self._take_topics(counts)
        self.span = (statistics.message_start_time, statistics.message_end_time)

    def _read_whole(self) -> None:
        self._take_topics(self._counted(self._written()))

    def _take_topics(self, counts: Counter[str]) -> None:
        """Take the topics of all channels, with the number of the messages of each."""
        for channel in self._channels.values():
            schema = self._schemas.get(channel.schema_id)
            self.topics[channel.topic] = TopicInfo(
                type_name=schema.name if schema else '',
                encoding=channel.message_encoding,
                count=counts[channel.topic],
            )

    def _whole(self, wanted: Collection[str], *, reorder: bool) -> Iterator[Message]:
        """Yield the messages of whole chunks by log time, as far as chunks do not overlap more."""
        found = (one for one in self._written() if one.topic in wanted)
        return by_log_time(found) if reorder else found

    def _written(self) -> Iterator[Message]:
        """Yield all messages of whole chunks in the order of the file."""
        for record in whole_records(self.file):
            if isinstance(record, Schema):
                self._schemas[record.id] = record
            elif isinstance(record, Channel):
                self._channels[record.id] = record
            elif isinstance(record, McapMessage) and record.channel_id in self._channels:
                yield _message(self._channels[record.channel_id], record)


def by_log_time(messages: Iterable[Message]) -> Iterator[Message]:
    """Yield messages by log time, as far as they are not mixed over more than `REORDER`."""
    waiting: list[tuple[int, int, Message]] = []
    for number, message in enumerate(messages):
        heapq.heappush(waiting, (message.log_time, number, message))
        while message.log_time - waiting[0][0] > REORDER:
            yield heapq.heappop(waiting)[2]
    while waiting:
        yield heapq.heappop(waiting)[2]


def _message(channel: Channel, message: McapMessage) -> Message:
    return Message(
        topic=channel.topic,
        data=message.data,
        log_time=message.log_time,
        publish_time=message.publish_time,
        sequence=message.sequence,
    )


@contextlib.contextmanager
def damage_is_input(file: Path) -> Iterator[None]:
    """Raise InputError for whatever an MCAP reader may raise for a file that is not whole."""
    try:
        yield
    except InputError:
        raise
    except OSError as error:
        raise InputError(f'bag {file} cannot be read: {error.strerror}') from None
    except DAMAGE as error:
        reason = ' '.join(str(error).split()) or type(error).__name__
        raise InputError(
            f'bag {file} is truncated or damaged, it must be a complete MCAP file ({reason})'
        ) from None
