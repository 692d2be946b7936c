# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Entries out of the serialised messages of a topic, those of equal layout at once.

What has no layout, and whatever is to be refused, is decoded one by one as the node does it.

"""

from collections.abc import Iterable

from ballscrew_monitor.core.fields import OtherJoints
from ballscrew_monitor.core.inputs import Input, InputSample, Refusal, Why
from ballscrew_monitor.recordings.bag import Bag, Message
from ballscrew_monitor.recordings.bulk.chunks import Messages
from ballscrew_monitor.recordings.bulk.entries import Entries, entries_of, joined, Kind, made, Told
from ballscrew_monitor.recordings.bulk.layout import Layout, NoLayout, reads_alike
from ballscrew_monitor.recordings.decoding import decode, UNDECODABLE
from ballscrew_monitor.settings.axis import Axis
from ballscrew_monitor.settings.topics import absolute
import numpy as np
from rclpy.serialization import deserialize_message

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

    def __init__(self, bag: Bag, readers: list[Reader]) -> None:
        """Begin without a layout; `bag` counts what does not decode."""
        self._bag, self._readers = bag, readers
        self._topic = absolute(readers[0][2].topic)
        self._type = readers[0][2].message_type
        self._layouts: list[Layout] = []

    def entries(self, messages: Messages) -> Entries:
        """Return what the messages say, in any order."""
        parts: list[Entries] = []
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

    def _read(self, layout: Layout, messages: Messages) -> list[Entries]:
        parts = []
        for number, axis, source in self._readers:
            found = layout.find(source)
            if isinstance(found, int):
                parts += self._samples(layout, messages, found, (number, axis, source))
            elif isinstance(found, OtherJoints):
                now = messages.log_time
                times = {'log_time': now, 'stamp': now, 'arrival': now}
                whose = {'place': messages.place, 'axis': number, 'source': source.source}
                kind = Kind.OTHER_JOINTS
                parts.append(made(len(messages), kind=kind, **times, **whose, note=found))
            else:
                parts.append(self._one_by_one(messages, [(number, axis, source)]))
        return parts

    def _samples(
        self, layout: Layout, messages: Messages, place: int, reader: Reader
    ) -> list[Entries]:
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
        bad = ~np.isfinite(value) | (stamp < 0) | ((now != 0) & (stamp - now > axis.max_future))
        samples = made(
            len(messages),
            log_time=now,
            place=messages.place,
            axis=number,
            source=source.source,
            kind=Kind.SAMPLE,
            stamp=np.where(stamp == 0, now, stamp),
            arrival=np.where(now == 0, stamp, now),
            value=value,
            header=stamp != 0,
        )
        if not bad.any():
            return [samples]
        return [samples.take(~bad), self._one_by_one(messages.some(bad), [reader])]

    def _one_by_one(self, messages: Messages, readers: list[Reader] | None = None) -> Entries:
        told: list[Told] = []
        for at in range(len(messages)):
            now, place = int(messages.log_time[at]), int(messages.place[at])
            message = Message(
                topic=self._topic, data=messages.content(at), log_time=now, publish_time=now
            )
            decoded, why = decode(self._bag, message, self._type)
            for number, axis, source in readers or self._readers:
                event: InputSample | Refusal
                if decoded is None:
                    event = Refusal(
                        source=source.source, why=Why.NOT_DECODED, text=why, arrival=now
                    )
                else:
                    event = source.read(decoded, now=now, max_future=axis.max_future)
                told.append((event, now, place, number))
        return entries_of(told)
