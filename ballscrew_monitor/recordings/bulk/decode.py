# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Events out of the serialised messages of a topic, many at once.

What the layout of the type does not reach is decoded one by one, as the node does it. A message
that does not decode is counted and named.

"""

from collections.abc import Iterable
import contextlib
import itertools
import math
from typing import Any

from ballscrew_monitor.core.conversions import SECOND, seconds
from ballscrew_monitor.core.fields import OtherJoints, TooShort
from ballscrew_monitor.core.inputs import Input, short_text, StampSource, Why, YEAR
from ballscrew_monitor.judge.monitor import EARLIEST, LATEST
from ballscrew_monitor.judge.records import NOT_KNOWN, REFUSAL
from ballscrew_monitor.messages.reasons import joint_reason, slow_reason
from ballscrew_monitor.recordings.bag import Bag, Message
from ballscrew_monitor.recordings.bulk.chunks import Messages
from ballscrew_monitor.recordings.bulk.events import BLANK, blank, event_of, Events, joined, Notes
from ballscrew_monitor.recordings.bulk.layout import Layout, NoLayout, Outcome
from ballscrew_monitor.settings.axis import Axis
from ballscrew_monitor.settings.parameters import absolute
import numpy as np
from numpy.typing import NDArray
from rclpy.serialization import deserialize_message

# What deserialising is known to raise; that of the middleware is a RuntimeError.
UNDECODABLE = (RuntimeError, ValueError, MemoryError, OverflowError)
SEEN = 100  # messages of a topic that tell what it holds


def decode(bag: Bag, message: Message, message_type: Any) -> Any:
    """Return a decoded message, None for one that does not decode, which `bag` counts."""
    decoded = _decoded(message, message_type)
    if decoded is None:
        reason = 'it is truncated, or of another type' if message.data else 'it is empty'
        bag.refuse(message, reason)
    return decoded


def _decoded(message: Message, message_type: Any) -> Any:
    try:
        return deserialize_message(message.data, message_type) if message.data else None
    except UNDECODABLE:
        return None


def silence(bag: Bag, axis: Axis) -> str:
    """Return why nothing of `axis` could be judged of `bag`, as far as its messages tell."""
    reasons = [_fault(bag, axis, source) for source in axis.inputs]
    return '; '.join(filter(None, reasons))


def _fault(bag: Bag, axis: Axis, source: Input) -> str:
    """Return what is wrong with an input of an axis, nothing if it has samples often enough."""
    name = source.source.name.lower()
    parameter = f'{axis.name}.{name}'
    absent = _absence(bag, source)
    if isinstance(absent, OtherJoints):
        return joint_reason(absent, parameter)
    if absent is not None:
        return short_text(absent)
    times = [
        message.log_time
        for message in itertools.islice(bag.messages([absolute(source.topic)]), SEEN)
    ]
    gaps = sorted(after - before for before, after in itertools.pairwise(times))
    gap = gaps[len(gaps) // 2] if gaps else 0
    if gap <= axis.monitor.settings.timeouts[source.source]:
        return ''
    return f'{name} {slow_reason(seconds(gap), parameter)}'


def named_instead(bag: Bag, source: Input) -> str:
    """Return which joints the messages of an input name instead of its own, if they do."""
    absent = _absence(bag, source)
    if not isinstance(absent, OtherJoints):
        return ''
    return f'; they name {", ".join(absent.names) or "no joints"} and no joint {absent.joint}'


def _absence(bag: Bag, source: Input) -> OtherJoints | TooShort | None:
    """Return what the first messages of the topic of an input hold together, if not its field."""
    readings: list[OtherJoints | TooShort] = []
    for message in bag.messages([absolute(source.topic)]):
        decoded = _decoded(message, source.message_type)
        if decoded is not None:
            reading = source.read_field(decoded)
            if isinstance(reading, float):
                return None
            readings.append(reading)
        if len(readings) == SEEN:
            break
    first = readings[0] if readings else None
    if not isinstance(first, OtherJoints):
        return first
    names = {
        name for reading in readings if isinstance(reading, OtherJoints) for name in reading.names
    }
    return OtherJoints(first.array, first.joint, tuple(sorted(names)))


Reader = tuple[int, Axis, Input]
"""The number of an axis, the axis, and an input of it."""


def readers_by_topic(axes: Iterable[Axis]) -> dict[str, list[Reader]]:
    """Return the inputs of axes by the full name of their topic."""
    readers: dict[str, list[Reader]] = {}
    for number, axis in enumerate(axes):
        for source in axis.inputs:
            readers.setdefault(absolute(source.topic), []).append((number, axis, source))
    return readers


class TopicDecoder:
    """Decodes the messages of one topic for all inputs that read it."""

    def __init__(self, bag: Bag, readers: list[Reader], notes: Notes) -> None:
        """Lay out the messages; `bag` counts what does not decode, `notes` keep what is named."""
        self._bag, self._readers, self._notes = bag, readers, notes
        self._topic = absolute(readers[0][2].topic)
        self._type = readers[0][2].message_type
        self._named: dict[Any, int] = {}
        self._layouts: list[Layout] | None = None
        with contextlib.suppress(NoLayout):
            self._layouts = [Layout(source) for _, _, source in readers]
        if self._layouts is None:
            bag.remark(f'the messages of {self._topic} are decoded one by one, which is slow')

    def events(self, messages: Messages) -> Events:
        """Return what the messages say, in any order."""
        if self._layouts is None:
            return self._one_by_one(messages)
        begin, size = messages.begin, messages.size
        walked = [layout.walk(messages.data, begin, size) for layout in self._layouts]
        readable = np.ones(len(messages), dtype=bool)
        for each in walked:
            readable &= each['outcome'] != Outcome.UNREADABLE
        if not readable.all():
            parts = [self._one_by_one(messages.some(~readable))]
            messages, walked = messages.some(readable), [each[readable] for each in walked]
        else:
            parts = []
        for reader, layout, each in zip(self._readers, self._layouts, walked, strict=True):
            parts.append(self._read(messages, reader, layout, each))
        return joined(parts)

    def _read(self, messages: Messages, reader: Reader, layout: Layout, walked: Any) -> Events:
        """Return what one input reads, refused for the same reasons as by `Input.read`."""
        number, axis, source = reader
        now, outcome = messages.log_time, walked['outcome']
        with np.errstate(invalid='ignore', over='ignore'):
            raw = layout.numbers(walked)
            value = raw * source.scaling.factor + source.scaling.shift
        stamp = walked['seconds'] * SECOND + walked['nanoseconds']
        events = blank(
            len(messages),
            axis=number,
            source=source.source,
            log_time=now,
            place=messages.place,
            stamp=np.clip(np.where(stamp == 0, now, stamp), EARLIEST, LATEST),
            arrival=np.clip(np.where(now == 0, stamp, now), EARLIEST, LATEST),
            value=value,
            stamp_source=np.where(stamp != 0, StampSource.HEADER, StampSource.RECEIVE),
        )
        limit = axis.max_future
        early = (now != 0) & (stamp - now > limit)
        others = outcome == Outcome.OTHER_JOINTS
        for which, why, first, second in (
            (~np.isfinite(value), Why.NOT_A_NUMBER, raw, math.nan),
            (early, Why.FUTURE, seconds(stamp - now), seconds(limit)),
            (early & (stamp - now > YEAR), Why.OTHER_CLOCK, seconds(stamp - now), seconds(limit)),
            (stamp < 0, Why.NEGATIVE, math.nan, math.nan),
            (outcome == Outcome.TOO_SHORT, Why.TOO_SHORT, walked['bits'], layout.array),
            (others, Why.OTHER_JOINTS, math.nan, math.nan),
        ):
            refuse(events, which, why, first, second)
        for at in np.flatnonzero(others).tolist():
            names = slice(int(walked['names_begin'][at]), int(walked['names_end'][at]))
            events['note'][at] = self._note(messages, at, messages.data[names], source)
        return events

    def _note(self, messages: Messages, at: int, names: bytes, source: Input) -> int:
        """Return the number of the joints that a message names, decoded when they first come."""
        key = source.source, source.field, names
        if key not in self._named:
            absent = source.read_field(deserialize_message(messages.content(at), self._type))
            assert isinstance(absent, OtherJoints)
            number = self._notes.number(absent)
            if number == NOT_KNOWN:
                return number
            self._named[key] = number
        return self._named[key]

    def _one_by_one(self, messages: Messages, readers: list[Reader] | None = None) -> Events:
        events: list[Events] = []
        for at in range(len(messages)):
            now, place = int(messages.log_time[at]), int(messages.place[at])
            message = Message(
                topic=self._topic, data=messages.content(at), log_time=now, publish_time=now
            )
            decoded = decode(self._bag, message, self._type)
            for number, axis, source in readers or self._readers:
                limit = axis.max_future
                read = source.read(decoded, now=now, max_future=limit)
                events.append(event_of(read, self._notes, axis=number, log_time=now, place=place))
        return joined(events)


def refuse(events: Events, which: NDArray[np.bool_], why: Why, first: Any, second: Any) -> None:
    """Turn some events into refusals with two numbers, each an array or one for all."""
    if not which.any():
        return
    blank_of = BLANK[0]
    for name in ('value', 'stamp_source'):
        events[name][which] = blank_of[name]
    events['kind'][which], events['why'][which] = REFUSAL, int(why)
    events['stamp'][which] = np.clip(events['log_time'][which], EARLIEST, LATEST)
    events['arrival'][which] = events['stamp'][which]
    events['first'][which] = np.broadcast_to(first, which.shape)[which]
    events['second'][which] = second
