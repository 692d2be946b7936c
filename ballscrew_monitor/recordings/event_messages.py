# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Events as a message of plain arrays, `ballscrew_msgs/msg/JudgeEvents`, and back.

The process that records knows no ROS, and a replay reads thousands of events at once: so the
message is laid out here as little-endian CDR. Its first four fields are the same in every version.

"""

from collections.abc import Mapping, Sequence
import dataclasses
import json
import struct
from typing import Any

from ballscrew_monitor.core.fields import OtherJoints
from ballscrew_monitor.core.inputs import Source, StampSource, Why
from ballscrew_monitor.judge.monitor import EARLIEST, LATEST
from ballscrew_monitor.judge.records import (
    ALL_AXES,
    EVENT,
    EVENTS_VERSION,
    MEMORY_VERSION,
    NOT_KNOWN,
    REFUSAL,
    SAMPLE,
    STEP,
    TICK,
)
from ballscrew_monitor.recordings.bulk.events import blank, Events, Notes, TICK_SOURCE
import numpy as np
from numpy.typing import NDArray
from surrogate.files import InputError
from surrogate.files.limits import read_json

ENCAPSULATION = b'\0\1\0\0'  # little-endian CDR
HEAD = struct.Struct('<IIQ')  # versions of events and memory, number of the message
COUNT = struct.Struct('<I')
EACH = ('kind', 'axis', 'source', 'stamp', 'arrival')
OF_SAMPLE, OF_REFUSAL = ('value', 'stamp_source'), ('why', 'first', 'second')
"""Fields of an event that the message holds of each, of samples and of refusals."""
ARRAYS: dict[str, np.dtype[Any]] = {
    **{name: EVENT[name] for name in EACH},
    **{'turn_events': np.dtype(np.uint32), 'turn_steady': np.dtype(np.int64)},
    **{'lost_place': np.dtype(np.uint32), 'lost': EVENT['lost']},
    **{name: EVENT[name] for name in (*OF_SAMPLE, *OF_REFUSAL, 'note')},
}
"""The arrays of the message in their order."""
EMPTY = {kind: np.empty(0, kind) for kind in ARRAYS.values()}
ALLOWED = {
    'kind': (SAMPLE, STEP),
    'source': (0, TICK_SOURCE),
    'stamp_source': (0, max(StampSource)),
    'why': (0, max(Why)),
    'stamp': (EARLIEST, LATEST),
    'arrival': (EARLIEST, LATEST),
    'lost': (NOT_KNOWN, 2**62),
}
"""What numbers may be, by the names of arrays."""


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class EventMessage:
    """
    A message of a recording: its versions, its number, snapshots as JSON, and where events begin.

    `body` is the message without its first four bytes, `place` [bytes] that of the first array.

    """

    events_version: int
    memory_version: int
    number: int
    snapshots: tuple[str, ...]
    body: memoryview
    place: int


def packed(
    number: int, events: Events, texts: Mapping[int, str], snapshots: Sequence[str] = ()
) -> bytes:
    """Return the message of this number; `texts` are the notes of the events by their numbers."""
    data = _Writer(HEAD.pack(EVENTS_VERSION, MEMORY_VERSION, number))
    data.put_texts(snapshots)
    for name in EACH:
        data.put(events[name])
    turns = np.flatnonzero(np.diff(events['steady'], prepend=events['steady'][:1] - 1))
    data.put(np.diff(turns, append=len(events)).astype(np.uint32))
    data.put(events['steady'][turns])
    lost = np.flatnonzero(events['lost'])
    data.put(lost.astype(np.uint32))
    data.put(events['lost'][lost])
    sample, refusal = events['kind'] == SAMPLE, events['kind'] == REFUSAL
    for name in OF_SAMPLE:
        data.put(events[name][sample])
    for name in OF_REFUSAL:
        data.put(events[name][refusal])
    named = events['note'][refusal]
    numbers = [note for note in dict.fromkeys(named.tolist()) if note in texts]
    places = {note: place for place, note in enumerate(numbers)}
    data.put(np.array([places.get(note, NOT_KNOWN) for note in named.tolist()], np.int16))
    data.put_texts([texts[note] for note in numbers])
    return ENCAPSULATION + bytes(data.data)


def read(data: bytes) -> EventMessage:
    """Return what a message of any version begins with; raises InputError for a damaged one."""
    try:
        if data[: len(ENCAPSULATION)] != ENCAPSULATION:
            raise ValueError('it is not little-endian CDR')
        body = memoryview(data)[slice(len(ENCAPSULATION), None)]
        events_version, memory_version, number = HEAD.unpack_from(body)
        reader = _Reader(body, HEAD.size)
        snapshots = tuple(reader.texts())
    except (ValueError, struct.error) as error:
        raise InputError(f'a message of events is damaged: {error}') from None
    return EventMessage(
        events_version=events_version,
        memory_version=memory_version,
        number=number,
        snapshots=snapshots,
        body=body,
        place=reader.place,
    )


def note_text(joints: OtherJoints) -> str:
    """Return joints as a message has them."""
    return json.dumps([joints.array, joints.joint, *joints.names], separators=(',', ':'))


def events_of(messages: Sequence[EventMessage], notes: Notes) -> Events:
    """
    Return the events of messages in their order; `notes` keep the joints that they refer to.

    Raises InputError for what no node has written.

    """
    try:
        return _events([_arrays(message) for message in messages], notes)
    except (ValueError, TypeError, IndexError, struct.error) as error:
        if len(messages) == 1:
            number = messages[0].number
            raise InputError(f'message {number} of events is damaged: {error}') from None
    for message in messages:  # to name the one that is
        events_of([message], notes)
    raise InputError('messages of events are damaged')


def _arrays(message: EventMessage) -> tuple[dict[str, NDArray[Any]], list[str]]:
    """Return the arrays of a message by name, and the texts of its notes."""
    reader = _Reader(message.body, message.place)
    arrays = reader.arrays(ARRAYS)
    count, places = len(arrays['kind']), arrays['lost_place']
    if int(arrays['turn_events'].sum()) != count or places.size and int(places.max()) >= count:
        raise ValueError('its turns or losses are not those of its events')
    return arrays, reader.texts()


def _events(parts: Sequence[tuple[dict[str, NDArray[Any]], list[str]]], notes: Notes) -> Events:
    if not parts:
        return blank(0)
    column = {name: np.concatenate([arrays[name] for arrays, _ in parts]) for name in ARRAYS}
    _check(column)
    kind = column['kind']
    events = blank(len(kind), **{name: column[name] for name in EACH}, log_time=column['arrival'])
    events['steady'] = np.repeat(column['turn_steady'], column['turn_events'])
    counts = [len(arrays['kind']) for arrays, _ in parts]
    losses = [len(arrays['lost']) for arrays, _ in parts]
    shift = np.repeat(np.cumsum([0, *counts[:-1]]), losses)
    events['lost'][column['lost_place'] + shift] = column['lost']
    sample = np.flatnonzero(kind == SAMPLE)
    for name in OF_SAMPLE:
        events[name][sample] = column[name]
    refusal = np.flatnonzero(kind == REFUSAL)
    for name in OF_REFUSAL:
        events[name][refusal] = column[name]
    events['note'][refusal] = np.concatenate([_notes(*part, notes) for part in parts])
    tick = np.flatnonzero(kind == TICK)
    events['log_time'][tick] = events['stamp'][tick]
    return events


def _notes(
    arrays: Mapping[str, NDArray[Any]], texts: Sequence[str], notes: Notes
) -> NDArray[np.int16]:
    """Return the notes of the refusals of a message by the numbers that `notes` give them."""
    numbers = [notes.number(OtherJoints(*_joints(text))) for text in texts]
    return np.array([*numbers, NOT_KNOWN], np.int16)[arrays['note']]


def _joints(text: str) -> tuple[str, str, tuple[str, ...]]:
    array, joint, *names = read_json(text)
    if not all(isinstance(name, str) for name in (array, joint, *names)):
        raise ValueError('a note names no joints')
    return array, joint, tuple(names)


def _check(column: Mapping[str, NDArray[Any]]) -> None:
    """Raise ValueError for numbers that the step would take for places or times."""
    for name, (low, high) in ALLOWED.items():
        values = column[name]
        if values.size and not low <= int(values.min()) <= int(values.max()) <= high:
            raise ValueError(f'{name} is from {values.min()} to {values.max()}')
    has_input = (column['kind'] == SAMPLE) | (column['kind'] == REFUSAL)
    if ((column['source'] > max(Source)) == has_input).any():
        raise ValueError('an event that is no tick has the source of one')
    if ((column['axis'] == ALL_AXES) & has_input).any():
        raise ValueError('a sample is of all axes')


class _Writer:
    """Arrays and texts one after the other, each number at a multiple of its size."""

    def __init__(self, head: bytes) -> None:
        self.data = bytearray(head)

    def _align(self, size: int) -> None:
        self.data += bytes(-len(self.data) % size)

    def put(self, values: NDArray[Any]) -> None:
        self._align(COUNT.size)
        self.data += COUNT.pack(len(values))
        if len(values):
            self._align(values.itemsize)
            self.data += np.ascontiguousarray(values).tobytes()

    def put_texts(self, texts: Sequence[str]) -> None:
        self._align(COUNT.size)
        self.data += COUNT.pack(len(texts))
        for text in texts:
            raw = text.encode() + b'\0'
            self._align(COUNT.size)
            self.data += COUNT.pack(len(raw)) + raw


class _Reader:
    """Reads what `_Writer` writes; raises ValueError for what ends too soon."""

    def __init__(self, data: memoryview, place: int) -> None:
        self._data, self.place = data, place

    def _count(self) -> int:
        self.place += -self.place % COUNT.size
        (count,) = COUNT.unpack_from(self._data, self.place)
        self.place += COUNT.size
        if count > len(self._data) - self.place:
            raise ValueError('it is cut off')
        return int(count)

    def arrays(self, kinds: Mapping[str, np.dtype[Any]]) -> dict[str, NDArray[Any]]:
        """Return the next arrays by their names, each of a kind."""
        columns, data, place, unpack = {}, self._data, self.place, COUNT.unpack_from
        for name, kind in kinds.items():
            place += -place % COUNT.size
            (count,) = unpack(data, place)
            place += COUNT.size
            if not count:
                columns[name] = EMPTY[kind]
                continue
            place += -place % kind.itemsize
            columns[name] = np.frombuffer(data, kind, count, place)
            place += count * kind.itemsize
        self.place = place
        return columns

    def texts(self) -> list[str]:
        texts = []
        for _ in range(self._count()):
            length = self._count()
            begin, end = self.place, self.place + length
            texts.append(bytes(self._data[slice(begin, end - 1)]).decode())
            self.place = end
        return texts
