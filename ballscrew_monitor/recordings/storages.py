# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
The files that a bag is made of, above all those of MCAP: topics, time span and messages of each.

A damaged file is refused. An MCAP file that has lost its end is read up to there if that is asked
for, and `note` says how much it was.

"""

from collections import Counter
from collections.abc import Collection, Generator, Iterable, Iterator, Mapping
import contextlib
import dataclasses
import heapq
import math
import operator
from pathlib import Path
from typing import Any, BinaryIO

from ballscrew_monitor.recordings.bag_files import MAGIC, ZSTD
from ballscrew_monitor.recordings.bulk.chunks import (
    chunk_indexes,
    ChunkDamage,
    Messages,
    read_chunk,
)
from ballscrew_monitor.recordings.mcap_records import (
    DAMAGE,
    NoSummary,
    read_summary,
    RecordDamage,
    whole_records,
)
from ballscrew_monitor.recordings.unpacking import Unpackable, unpacked
from mcap.records import Channel, ChunkIndex, Schema
from mcap.records import Message as McapMessage
from surrogate.files import InputError, limits

MCAP = next(magic for magic, kind in MAGIC.items() if kind == 'mcap')
REORDER = 1_000_000_000  # [ns] log time over which messages of different chunks may be mixed
OBJECT = 250  # [bytes] about, of a message besides its data


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
    """One file of a bag."""

    def __init__(self, file: Path) -> None:
        """Read the topics; raises InputError if the file is damaged."""
        self.file = file
        self.topics: dict[str, TopicInfo] = {}
        self.span = (0, 0)
        self.note = ''
        self._read_topics()

    def messages(self, wanted: Collection[str], *, as_written: bool = False) -> Stream:
        """
        Yield the messages of the topics `wanted` by log time; raises InputError on damage.

        Those of the recording of a node are wanted `as_written`.

        """
        raise NotImplementedError

    def _read_topics(self) -> None:
        """Read what the file says of its topics; raises InputError on damage."""
        raise NotImplementedError

    def _remark(self, text: str) -> None:
        if text not in self.note:  # whoever reads the file again finds the same
            self.note = f'{self.note}; {text}' if self.note else text


class McapStorage(Storage):
    """One MCAP file; with `salvage` one whose end is lost is read as far as it is whole."""

    def __init__(self, file: Path, *, salvage: bool = False) -> None:
        """Read the topics; raises InputError if nothing can be had of the file."""
        self._schemas: dict[int, Schema] = {}
        self._channels: dict[int, Channel] = {}
        self.is_indexed = True
        with damage_is_input(file), file.open('rb') as stream:
            if not MCAP.startswith(stream.read(len(MCAP))):  # an empty file is cut short
                raise InputError(
                    f'bag {file} is neither an MCAP nor a sqlite3 file by its first bytes'
                )
        try:
            super().__init__(file)
        except InputError:
            if not salvage:
                raise
            lost = self._read_through()
            begin, end = self.span
            count = sum(info.count for info in self.topics.values())
            self.note = (
                f'bag {self.file} is truncated or damaged: used are the {count} messages '
                f'of {(end - begin) * 1e-9:.1f} s that are whole{lost and f", {lost}"}'
            )
            if not self.topics:
                raise

    def messages(self, wanted: Collection[str], *, as_written: bool = False) -> Stream:
        """Yield the messages, see `Storage`; what the file counts otherwise is noted."""
        read = self._indexed if self.is_indexed else self._whole
        counts: Counter[str] = Counter()
        for message in read(wanted, reorder=not as_written):
            counts[message.topic] += 1
            yield message
        self.compare(wanted, counts)

    def compare(self, wanted: Collection[str], counts: Mapping[str, int]) -> None:
        """Note of which topics another number of messages was read than the file counts."""
        for topic in sorted(self.topics.keys() & set(wanted)):
            count, stated = counts.get(topic, 0), self.topics[topic].count
            if count != stated and self.is_indexed:
                self._remark(
                    f'bag {self.file}: it counts {stated} messages of {topic}, {count} were read'
                )

    def chunk(self, stream: BinaryIO, place: ChunkIndex) -> Messages:
        """Return the messages of a chunk; raises InputError if it is damaged."""
        try:
            return read_chunk(stream, place)
        except ChunkDamage as damage:
            span = (place.message_end_time - place.message_start_time) * 1e-9
            where = f'{span:.3g} s of data in the chunk at byte {place.chunk_start_offset}'
            raise InputError(self._damaged(f'{where} cannot be read ({damage})')) from None

    def _damaged(self, what: str) -> str:
        return (
            f'bag {self.file} is truncated or damaged: {what}, '
            f'mcap recover {self.file} -o NEW.mcap copies what is whole'
        )

    def _indexed(self, wanted: Collection[str], *, reorder: bool) -> Iterator[Message]:
        with damage_is_input(self.file), self.file.open('rb') as stream:
            places, channels = chunk_indexes(stream, wanted)
            if not places:
                yield from self._whole(wanted, reorder=reorder)
                return
            if not reorder:
                places.sort(key=operator.attrgetter('chunk_start_offset'))
                for place in places:
                    yield from (message for _, message in self._of_chunk(stream, place, channels))
                return
            waiting = _Waiting()
            for place in sorted(places, key=operator.attrgetter('message_start_time')):
                yield from waiting.before(place.message_start_time)
                for order, message in self._of_chunk(stream, place, channels):
                    waiting.add(message, (place.chunk_start_offset, order))
            yield from waiting.before(math.inf)

    def _of_chunk(
        self, stream: BinaryIO, place: ChunkIndex, channels: Mapping[int, str]
    ) -> Iterator[tuple[int, Message]]:
        """Yield the messages of a chunk that are of some channels, each with its place there."""
        chunk = self.chunk(stream, place)
        for at in range(len(chunk)):
            topic = channels.get(int(chunk.channel[at]))
            if topic is not None:
                yield (
                    at,
                    Message(
                        topic=topic,
                        data=chunk.content(at),
                        log_time=int(chunk.log_time[at]),
                        publish_time=chunk.publish_time(at),
                        sequence=int(chunk.sequence[at]),
                    ),
                )

    def _read_topics(self) -> None:
        with damage_is_input(self.file), self.file.open('rb') as stream:
            try:
                summary = read_summary(stream)
            except NoSummary:
                if lost := self._read_through():
                    raise InputError(self._damaged(lost)) from None
                return
        statistics = summary.statistics
        assert statistics is not None
        self._schemas, self._channels = summary.schemas, summary.channels
        counts: Counter[str] = Counter()
        for number, channel in summary.channels.items():
            counts[channel.topic] += statistics.channel_message_counts.get(number, 0)
        self._take_topics(counts)
        self.span = (statistics.message_start_time, statistics.message_end_time)

    def _read_through(self) -> str:
        """Take topics and time span from the messages themselves; return what is lost, if any."""
        self.is_indexed = False
        counts: Counter[str] = Counter()
        begin = end = 0
        lost = ''
        try:
            for message in self._written():
                begin = min(begin, message.log_time) if counts else message.log_time
                end = max(end, message.log_time)
                counts[message.topic] += 1
        except RecordDamage as damage:
            lost = damage.lost
        self._take_topics(counts)
        self.span = (begin, end)
        return lost

    def _take_topics(self, counts: Counter[str]) -> None:
        for channel in self._channels.values():
            schema = self._schemas.get(channel.schema_id)
            self.topics[channel.topic] = TopicInfo(
                type_name=schema.name if schema else '',
                encoding=channel.message_encoding,
                count=counts[channel.topic],
            )

    def _whole(self, wanted: Collection[str], *, reorder: bool) -> Iterator[Message]:
        """Yield the messages of a file that is read from its begin, by log time if wanted so."""
        if reorder:
            yield from by_log_time(self._whole(wanted, reorder=False))
            return
        try:
            yield from (message for message in self._written() if message.topic in wanted)
        except RecordDamage as damage:
            if self.is_indexed:
                raise InputError(self._damaged(str(damage))) from None

    def _written(self) -> Iterator[Message]:
        """Yield all messages in the order of the file; raises RecordDamage."""
        for record in whole_records(self.file):
            if isinstance(record, Schema):
                self._schemas[record.id] = record
            elif isinstance(record, Channel):
                self._channels[record.id] = record
            elif isinstance(record, McapMessage) and record.channel_id in self._channels:
                yield _message(self._channels[record.channel_id], record)


class _Waiting:
    """Messages that wait for earlier ones, as far as they fit into memory."""

    def __init__(self) -> None:
        self._held: list[tuple[int, Any, Message]] = []
        self._size = 0

    def add(self, message: Message, order: Any) -> None:
        """Hold a message; those of equal log time come by their order, no two have the same."""
        heapq.heappush(self._held, (message.log_time, order, message))
        self._size += len(message.data) + OBJECT

    def before(self, time: float) -> Iterator[Message]:
        """Yield the messages before a time [ns], and what is too much to be held."""
        while self._held and (self._held[0][0] < time or self._size > limits.WAITING):
            *_, message = heapq.heappop(self._held)
            self._size -= len(message.data) + OBJECT
            yield message


def whole(message: Message) -> Message:
    """Return a message, unpacked if it was packed alone; what cannot be does not decode."""
    if message.data[:4] != ZSTD:  # no serialised message begins so: its first byte is zero
        return message
    try:
        return dataclasses.replace(message, data=unpacked(message.data))
    except Unpackable:
        return message


def by_log_time(messages: Iterable[Message]) -> Iterator[Message]:
    """Yield messages by log time, as far as they are not mixed over more than `REORDER`."""
    waiting = _Waiting()
    for number, message in enumerate(messages):
        waiting.add(message, number)
        yield from waiting.before(message.log_time - REORDER)
    yield from waiting.before(math.inf)


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
