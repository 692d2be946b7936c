# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
The messages of a bag in batches that fit into memory, in the order of their log times.

A batch holds all messages up to a log time; those of one topic stand together.

"""

from collections import Counter
from collections.abc import Collection, Iterator, Sequence
import contextlib
import dataclasses
import functools
import itertools
import operator
from typing import BinaryIO

from ballscrew_monitor.recordings.bag import Bag, Message
from ballscrew_monitor.recordings.bag_files import ZSTD
from ballscrew_monitor.recordings.bulk import chunks as bulk_chunks
from ballscrew_monitor.recordings.bulk.chunks import ChunkDamage, Integers, Messages, read_chunk
from ballscrew_monitor.recordings.storages import damage_is_input, McapStorage
from mcap.records import ChunkIndex
import numpy as np
from surrogate.files import limits

BATCH = 1024 * 1024  # [bytes] of chunks that are looked at together
MESSAGES = 16384  # of a bag without chunks that are looked at together
PLACES = 32  # bits for the place of a message in its chunk
END = 2**63 - 1
ORDER = ('place', 'log_time')  # the last counts first


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class Batch:
    """Messages by topic; nothing logged before `until` [ns] comes later; `done` of the bag [-]."""

    topics: dict[str, Messages]
    until: int
    done: float

    def order(self) -> Integers:
        """Return the places of the messages, topic by topic, in the order of their log times."""
        messages = list(self.topics.values())
        if not messages:
            return np.arange(0)
        return np.lexsort(
            [np.concatenate([getattr(each, name) for each in messages]) for name in ORDER]
        )

    def messages(self) -> Iterator[Message]:
        """Yield the messages in the order of their log times, as published when logged."""
        every = [
            Message(topic=topic, data=data, log_time=time, publish_time=time, sequence=number)
            for topic, messages in self.topics.items()
            for data, time, number in zip(
                messages.contents(),
                messages.log_time.tolist(),
                messages.sequence.tolist(),
                strict=True,
            )
        ]
        yield from (every[at] for at in self.order().tolist())


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class _Chunk:
    """
    A chunk, the rank that orders messages of equal log time, and where it is read.

    `topics` are the numbers of the wanted topics by channel, -1 of any other one.

    """

    place: ChunkIndex
    rank: int
    storage: McapStorage
    stream: BinaryIO
    topics: Integers


@functools.singledispatch
def batches(bag: Bag, topics: Collection[str], *, as_written: bool = False) -> Iterator[Batch]:
    """
    Yield the messages of `topics`, by log time or in the order in which they were written.

    Raises InputError for a damaged chunk.

    """
    with contextlib.ExitStack() as stack:
        chunks = _chunks(stack, bag, topics)
        if chunks is None:
            messages = bag.as_written(topics) if as_written else bag.messages(topics)
            yield from _by_message(bag, messages, list(topics))
        elif as_written:
            yield from _by_chunk(sorted(chunks, key=operator.attrgetter('rank')), list(topics))
        else:
            yield from _by_chunk(chunks, list(topics))


def _chunks(stack: contextlib.ExitStack, bag: Bag, topics: Collection[str]) -> list[_Chunk] | None:
    """Return the chunks of all files by their first times, None if one is not read by chunks."""
    chunks: list[_Chunk] = []
    for storage in bag.storages:
        if not isinstance(storage, McapStorage) or not storage.is_indexed:
            return None
        with damage_is_input(storage.file):
            stream = stack.enter_context(storage.file.open('rb'))
            places, channels = bulk_chunks.chunk_indexes(stream, topics)
            packed = not places
            if channels and places:
                with contextlib.suppress(ChunkDamage):  # are messages compressed by themselves?
                    chunk = read_chunk(stream, places[0])
                    begins = chunk.begin.tolist()
                    packed = any(chunk.data.startswith(ZSTD, begin) for begin in begins)
            if channels and packed:
                return None
        places.sort(key=operator.attrgetter('chunk_start_offset'))
        numbers, names = np.full(65536, -1), list(topics)
        for channel, name in channels.items():
            numbers[channel] = names.index(name)
        chunks += [
            _Chunk(place=place, rank=rank, storage=storage, stream=stream, topics=numbers)
            for rank, place in enumerate(places, len(chunks))
        ]
    return sorted(chunks, key=lambda each: (each.place.message_start_time, each.rank))


def _by_chunk(chunks: Sequence[_Chunk], names: Sequence[str]) -> Iterator[Batch]:
    waiting: list[Messages] = []
    size = 0
    counts: dict[McapStorage, Counter[str]] = {}
    for number, chunk in enumerate(chunks, 1):
        messages = chunk.storage.chunk(chunk.stream, chunk.place)
        messages = dataclasses.replace(
            messages,
            channel=chunk.topics[messages.channel],
            place=(chunk.rank << PLACES) + messages.begin,  # in the bag
        )
        waiting.append(messages)
        size += len(messages.data)
        numbers = np.bincount(messages.channel[messages.channel >= 0], minlength=len(names))
        read = dict(zip(names, numbers.tolist(), strict=True))
        counts.setdefault(chunk.storage, Counter()).update(read)
        if size >= BATCH or number == len(chunks):
            until = END if number == len(chunks) else chunks[number].place.message_start_time
            yield Batch(topics=_by_topic(waiting, names), until=until, done=number / len(chunks))
            waiting, size = [], 0
    for storage, count in counts.items():
        storage.compare(names, count)


def _by_topic(parts: Sequence[Messages], names: Sequence[str]) -> dict[str, Messages]:
    """Return messages, as channels the numbers of their topics, by the names of these."""
    if not parts:
        return {}
    everything = bulk_chunks.joined(parts)
    return {
        name: everything.some(np.flatnonzero(everything.channel == number))
        for number, name in enumerate(names)
    }


def _by_message(bag: Bag, messages: Iterator[Message], names: Sequence[str]) -> Iterator[Batch]:
    """Yield the messages of a bag that has no chunks, as its reader gives them."""
    span = max(bag.end_time - bag.start_time, 1)
    first = 0
    while part := _part(messages):
        size = np.array([len(message.data) for message in part])
        block = Messages(
            data=b''.join(message.data for message in part),
            channel=np.array([names.index(message.topic) for message in part]),
            begin=np.cumsum(size) - size,
            size=size,
            log_time=np.array([min(message.log_time, bulk_chunks.LATEST) for message in part]),
            place=np.arange(first, first + len(part)),
            sequence=np.array([message.sequence for message in part]),
        )
        first += len(part)
        until = part[-1].log_time
        done = (until - bag.start_time) / span
        yield Batch(topics=_by_topic([block], names), until=until, done=done)
    yield Batch(topics={}, until=END, done=1.0)


def _part(messages: Iterator[Message]) -> list[Message]:
    part, size = list[Message](), 0
    for message in itertools.islice(messages, MESSAGES):
        part.append(message)
        size += len(message.data)
        if size > limits.WAITING:
            break
    return part
