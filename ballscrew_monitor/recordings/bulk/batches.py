# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
The messages of a bag in batches that fit into memory, in the order of their log times.

A batch holds all messages up to a log time; those of one topic stand together.

"""

from collections.abc import Collection, Iterator, Sequence
import contextlib
import dataclasses
import itertools
import operator
from typing import BinaryIO

from ballscrew_monitor.core.conversions import seconds
from ballscrew_monitor.recordings.bag import Bag, Message
from ballscrew_monitor.recordings.bag_files import ZSTD
from ballscrew_monitor.recordings.bulk.chunks import (
    chunk_places,
    ChunkDamage,
    Found,
    LATEST,
    Place,
    read_chunk,
)
from ballscrew_monitor.recordings.bulk.decode import Messages
from ballscrew_monitor.recordings.storages import damage_is_input, McapStorage
import numpy as np
from surrogate.files import InputError

BATCH = 4 * 1024 * 1024  # [bytes] of chunks that are looked at together
MESSAGES = 16384  # of a bag without chunks that are looked at together
PLACES = 32  # bits for the place of a message in its chunk
END = 2**63 - 1


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class Batch:
    """Messages by topic; nothing logged before `until` [ns] comes later; `done` of the bag [-]."""

    topics: dict[str, Messages]
    until: int
    done: float


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class _Chunk:
    """A chunk, the rank that orders messages of equal log time, and where it is read."""

    place: Place
    rank: int
    storage: McapStorage
    stream: BinaryIO
    channels: dict[int, str]


def batches(bag: Bag, topics: Collection[str], *, as_written: bool = False) -> Iterator[Batch]:
    """
    Yield the messages of `topics`, by log time or in the order in which they were written.

    Raises InputError for a damaged bag, unless its intact part is to be salvaged; then the
    file that holds a damaged chunk has a note on it.

    """
    with contextlib.ExitStack() as stack:
        chunks = _chunks(stack, bag, topics)
        if chunks is None:
            messages = bag.as_written(topics) if as_written else bag.messages(topics)
            yield from _by_message(bag, messages)
        elif as_written:
            yield from _by_chunk(sorted(chunks, key=operator.attrgetter('rank')))
        else:
            yield from _by_chunk(chunks)


def _chunks(stack: contextlib.ExitStack, bag: Bag, topics: Collection[str]) -> list[_Chunk] | None:
    """Return the chunks of all files by their first times, None if one is not read by chunks."""
    found: list[_Chunk] = []
    for storage in bag.storages:
        if not isinstance(storage, McapStorage) or not storage.has_summary:
            return None
        with damage_is_input(storage.file):
            stream = stack.enter_context(storage.file.open('rb'))
            places, channels = chunk_places(stream, topics)
            if channels and (not places or _is_packed(stream, places[0])):
                return None
        found += [
            _Chunk(place=place, rank=rank, storage=storage, stream=stream, channels=channels)
            for rank, place in enumerate(sorted(places, key=lambda each: each.offset), len(found))
        ]
    return sorted(found, key=lambda each: (each.place.first, each.rank))


def _is_packed(stream: BinaryIO, place: Place) -> bool:
    """Tell whether the messages of a chunk are compressed each by itself."""
    try:
        found = read_chunk(stream, place)
    except ChunkDamage:
        return False
    return any(found.data.startswith(ZSTD, begin) for begin in found.begin.tolist())


def _by_chunk(chunks: Sequence[_Chunk]) -> Iterator[Batch]:
    waiting: list[tuple[_Chunk, Found]] = []
    size = 0
    for number, chunk in enumerate(chunks, 1):
        try:
            found = read_chunk(chunk.stream, chunk.place)
        except ChunkDamage as damage:
            _note(chunk, damage)
        else:
            waiting.append((chunk, found))
            size += len(found.data)
        if size >= BATCH or number == len(chunks):
            until = END if number == len(chunks) else chunks[number].place.first
            yield Batch(topics=_topics(waiting), until=until, done=number / len(chunks))
            waiting, size = [], 0


def _note(chunk: _Chunk, damage: ChunkDamage) -> None:
    """Note a damaged chunk; raise InputError unless the rest is to be salvaged."""
    place, storage = chunk.place, chunk.storage
    text = (
        f'bag {storage.file} is truncated or damaged: {seconds(place.last - place.first):.3g} s '
        f'of data in the chunk at byte {place.offset} cannot be read ({damage})'
    )
    if not storage.salvage:
        raise InputError(text)
    if text not in storage.note:  # whoever reads the file again finds the same
        storage.note = f'{storage.note}; {text}' if storage.note else text


def _topics(waiting: Sequence[tuple[_Chunk, Found]]) -> dict[str, Messages]:
    """Return the messages of some chunks by topic."""
    if not waiting:
        return {}
    ends = itertools.accumulate(len(found.data) for _, found in waiting)
    shifts = [0, *ends][:-1]
    data = b''.join(found.data for _, found in waiting)
    names: dict[str, int] = {}
    topic, begin, size, log_time, place, sequence = zip(
        *(
            (
                _numbers_of(found.channel, chunk.channels, names),
                found.begin + shift,
                found.size,
                found.log_time,
                (chunk.rank << PLACES) + found.begin,
                found.sequence,
            )
            for (chunk, found), shift in zip(waiting, shifts, strict=True)
        )
    )
    numbers = np.concatenate(topic)
    everything = Messages(
        data=data,
        begin=np.concatenate(begin),
        size=np.concatenate(size),
        log_time=np.concatenate(log_time),
        place=np.concatenate(place),
        sequence=np.concatenate(sequence),
    )
    return {name: everything.some(np.flatnonzero(numbers == at)) for name, at in names.items()}


def _numbers_of(
    channel: np.ndarray, channels: dict[int, str], names: dict[str, int]
) -> np.ndarray:
    """Return the number of the topic of each message, -1 for a topic that is not wanted."""
    numbers = np.full(65536, -1)
    for number, name in channels.items():
        numbers[number] = names.setdefault(name, len(names))
    return numbers[channel]


def _by_message(bag: Bag, messages: Iterator[Message]) -> Iterator[Batch]:
    """Yield the messages of a bag that has no chunks, as its reader gives them."""
    span = max(bag.end_time - bag.start_time, 1)
    first = 0
    while part := list(itertools.islice(messages, MESSAGES)):
        found: dict[str, list[int]] = {}
        for at, message in enumerate(part):
            found.setdefault(message.topic, []).append(at)
        size = np.array([len(message.data) for message in part])
        everything = Messages(
            data=b''.join(message.data for message in part),
            begin=np.cumsum(size) - size,
            size=size,
            log_time=np.array([min(message.log_time, LATEST) for message in part]),
            place=np.arange(first, first + len(part)),
            sequence=np.array([message.sequence for message in part]),
        )
        first += len(part)
        until = part[-1].log_time
        yield Batch(
            topics={name: everything.some(np.array(at)) for name, at in found.items()},
            until=until,
            done=(until - bag.start_time) / span,
        )
    yield Batch(topics={}, until=END, done=1.0)
