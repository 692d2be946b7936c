# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Events out of the serialised messages of a topic, those of equal layout at once.

What has no layout, and whatever is to be refused, is decoded one by one as the node does it.
One that does not decode is counted and named.

"""

from collections.abc import Iterable, Sequence
import itertools
from typing import Any

from ballscrew_monitor.core.conversions import seconds
from ballscrew_monitor.core.fields import OtherJoints, TooShort
from ballscrew_monitor.core.inputs import Input, short_text, StampSource, Why
from ballscrew_monitor.judge.monitor import EARLIEST, LATEST
from ballscrew_monitor.judge.records import REFUSAL
from ballscrew_monitor.messages.reasons import joint_reason, slow_reason
from ballscrew_monitor.recordings.bag import Bag, Message
from ballscrew_monitor.recordings.bulk.chunks import Messages
from ballscrew_monitor.recordings.bulk.events import blank, event_of, Events, joined, Notes
from ballscrew_monitor.recordings.bulk.layout import Layout, NoLayout, reads_alike
from ballscrew_monitor.settings.axis import Axis
from ballscrew_monitor.settings.parameters import absolute
import numpy as np
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
    reasons = [_fault(bag, axis, one) for one in axis.inputs]
    return '; '.join(filter(None, reasons))


def _fault(bag: Bag, axis: Axis, one: Input) -> str:
    """Return what is wrong with an input of an axis, nothing if it has samples often enough."""
    name = one.source.name.lower()
    parameter = f'{axis.name}.{name}'
    absent = _absence(bag, one)
    if isinstance(absent, OtherJoints):
        return joint_reason(absent, parameter)
    if absent is not None:
        return short_text(absent)
    gap = _usual_gap(bag, absolute(one.topic))
    if gap <= axis.monitor.settings.timeouts[one.source]:
        return ''
    return f'{name} {slow_reason(seconds(gap), parameter)}'


def _usual_gap(bag: Bag, topic: str) -> int:
    """Return the time between two messages of a topic [ns] that half of the first keep."""
    times = [message.log_time for message in itertools.islice(bag.messages([topic]), SEEN)]
    gaps = sorted(after - before for before, after in itertools.pairwise(times))
    return gaps[len(gaps) // 2] if gaps else 0


def named_instead(bag: Bag, one: Input) -> str:
    """Return which joints the messages of an input name instead of its own, if they do."""
    absent = _absence(bag, one)
    if not isinstance(absent, OtherJoints):
        return ''
    return f'; they name {", ".join(absent.names) or "no joints"} and no joint {absent.joint}'


def _absence(bag: Bag, one: Input) -> OtherJoints | TooShort | None:
    """Return what the first messages of the topic of an input hold, if not its field."""
    readings: list[OtherJoints | TooShort] = []
    for message in bag.messages([absolute(one.topic)]):
        decoded = _decoded(message, one.message_type)
        if decoded is not None:
            reading = one.read_field(decoded)
            if isinstance(reading, float):
                return None
            readings.append(reading)
        if len(readings) == SEEN:
            break
    return _joined(readings) if readings else None


def _joined(readings: Sequence[OtherJoints | TooShort]) -> OtherJoints | TooShort:
    """Return one absence for all: the joints of all messages, or the first array."""
    first = readings[0]
    others = [one for one in readings if isinstance(one, OtherJoints)]
    if not isinstance(first, OtherJoints):
        return first
    names = sorted({name for one in others for name in one.names})
    return OtherJoints(first.array, first.joint, tuple(names))


MOST_LAYOUTS = 32  # of a topic; what is still different then is decoded one by one
NEW_LAYOUTS = 4  # that are looked for in a batch

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

    def __init__(self, bag: Bag, readers: list[Reader], notes: Notes, *, ahead: int = 0) -> None:
        """
        Begin without a layout; `bag` counts what does not decode, `notes` keep what is named.

        Stamps may be `ahead` [ns] of the clock beside what an axis allows.

        """
        self._bag, self._readers, self._notes = bag, readers, notes
        self._topic = absolute(readers[0][2].topic)
        self._type, self._ahead = readers[0][2].message_type, ahead
        self._layouts: list[Layout] = []

    def events(self, messages: Messages) -> Events:
        """Return what the messages say, in any order."""
        parts: list[Events] = []
        rest, tried, most = messages, 0, len(self._layouts) + NEW_LAYOUTS
        while len(rest) and tried < most:
            if tried == len(self._layouts) and not self._learn(rest.content(0)):
                break
            layout = self._layouts[tried]
            tried += 1
            fits = layout.fits(rest.data, rest.begin, rest.size)
            if fits.any():
                parts += self._read(layout, rest if fits.all() else rest.some(fits))
                rest = rest.some(~fits)
        return joined([*parts, self._one_by_one(rest)])

    def _learn(self, example: bytes) -> bool:
        """Take the layout of a message, if it has one that reads what the decoder reads."""
        if len(self._layouts) == MOST_LAYOUTS:
            return False
        try:
            layout = Layout(example, self._type)
            message = deserialize_message(example, self._type)
        except (NoLayout, *UNDECODABLE):
            return False
        if not all(reads_alike(layout, example, message, each) for _, _, each in self._readers):
            return False
        self._layouts.append(layout)
        return True

    def _read(self, layout: Layout, messages: Messages) -> list[Events]:
        parts = []
        for number, axis, source in self._readers:
            found = layout.find(source)
            if isinstance(found, int):
                parts += self._samples(layout, messages, found, (number, axis, source))
            elif isinstance(found, OtherJoints):
                now = messages.log_time
                others = self._blank(messages, number, source, stamp=now, arrival=now)
                others['kind'], others['why'] = REFUSAL, int(Why.OTHER_JOINTS)
                others['note'] = self._notes.number(found)
                parts.append(others)
            else:
                parts.append(self._one_by_one(messages, [(number, axis, source)]))
        return parts

    def _samples(
        self, layout: Layout, messages: Messages, place: int, reader: Reader
    ) -> list[Events]:
        """Return the samples of one input, and what is refused of them."""
        number, axis, source = reader
        now = messages.log_time
        scaling = source.scaling
        with np.errstate(invalid='ignore', over='ignore'):
            value = layout.numbers(messages.data, messages.begin, place)
            value = value * scaling.factor + scaling.shift
        stamp = np.zeros_like(now)
        if source.stamped:
            stamp = layout.stamps(messages.data, messages.begin)
        limit = axis.max_future + self._ahead
        bad = ~np.isfinite(value) | (stamp < 0) | ((now != 0) & (stamp - now > limit))
        samples = self._blank(
            messages,
            number,
            source,
            stamp=np.where(stamp == 0, now, stamp),
            arrival=np.where(now == 0, stamp, now),
            value=value,
            stamp_source=np.where(stamp != 0, StampSource.HEADER, StampSource.RECEIVE),
        )
        if not bad.any():
            return [samples]
        return [samples[~bad], self._one_by_one(messages.some(bad), [reader])]

    def _blank(self, messages: Messages, number: int, source: Input, **columns: Any) -> Events:
        """Return an event for each message, with its place and these columns."""
        for name in ('stamp', 'arrival'):
            columns[name] = np.clip(columns[name], EARLIEST, LATEST)
        return blank(
            len(messages),
            axis=number,
            source=source.source,
            log_time=messages.log_time,
            place=messages.place,
            **columns,
        )

    def _one_by_one(self, messages: Messages, readers: list[Reader] | None = None) -> Events:
        events: list[Events] = []
        for at in range(len(messages)):
            now, place = int(messages.log_time[at]), int(messages.place[at])
            message = Message(
                topic=self._topic, data=messages.content(at), log_time=now, publish_time=now
            )
            decoded = decode(self._bag, message, self._type)
            for number, axis, source in readers or self._readers:
                limit = axis.max_future + self._ahead
                read = source.read(decoded, now=now, max_future=limit)
                events.append(event_of(read, self._notes, axis=number, log_time=now, place=place))
        return joined(events)
