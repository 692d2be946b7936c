# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
The messages of one turn as an array of events in the order of judging.

The numbers of all messages are taken in one go, by compiled code where there is numba; a message
that gives no plain sample is read by itself. So the events are those that the messages give one by
one.

"""

from collections.abc import Callable, Mapping, Sequence
from typing import Any, NamedTuple

from ballscrew_monitor.core.fields import OtherJoints
from ballscrew_monitor.core.inputs import Input, InputSample, Refusal, Source, StampSource
from ballscrew_monitor.judge.monitor import EARLIEST, fill, LATEST
from ballscrew_monitor.judge.records import Event, NOT_KNOWN, REFUSAL, SAMPLE
from ballscrew_monitor.node.burst import Burst
from ballscrew_monitor.node.event_recorder import AxisEvent, Heard
from ballscrew_monitor.node.sources import InputName, NO_NUMBER, Reading
from ballscrew_monitor.node.topic import Topic
from ballscrew_monitor.recordings.bulk.events import blank, Events, joined, some
from ballscrew_monitor.recordings.bulk.layout import Layout
from ballscrew_monitor.recordings.bulk.ways import Ways
from ballscrew_monitor.settings.axis import Axis
import numpy as np
from numpy.typing import NDArray
from surrogate.surface.records import as_array


class AxisTurn(NamedTuple):
    """The events of one axis in a turn, and the joints that some name, by places in `events`."""

    axis: Axis
    events: Events
    joints: dict[int, OtherJoints]

    def hear_joints(self, end: int) -> None:
        """Keep the joints that events before a place name since the last good sample."""
        monitor = self.axis.monitor
        named: dict[Source, list[OtherJoints]] = {}
        for place, joints in self.joints.items():
            if place < end:
                named.setdefault(Source(self.events['source'][place]), []).append(joints)
        for source, heard in named.items():
            others = monitor.memory.others[source]
            good = max(len(heard) - others, 0)
            since = heard[good:]
            monitor.joints.hear_many(source, since, all_since=others <= len(heard))


class Turn(NamedTuple):
    """Events, for each the number of its axis among `axes`, and the joints that some name."""

    axes: Sequence[Axis]
    events: Events
    numbers: NDArray[np.int64]
    joints: Mapping[int, OtherJoints]

    def by_axis(self) -> list[AxisTurn]:
        """Return the events of each axis that has any."""
        order = np.argsort(self.numbers, kind='stable')
        numbers, events = self.numbers[order], some(self.events, order)
        begins = np.flatnonzero(np.diff(numbers, prepend=-1)).tolist()
        turns = []
        for begin, end in zip(begins, [*begins[1:], len(order)]):
            joints = {
                at: self.joints[place]
                for at, place in enumerate(order[begin:end].tolist() if self.joints else ())
                if place in self.joints
            }
            turns.append(AxisTurn(self.axes[numbers[begin]], events[begin:end], joints))
        return turns


Slot = tuple[Axis, Input, Layout]
"""An input that is read in a turn, and the way to its number."""


class _Slots:
    """The inputs that are read in turns of some topics, those of a topic in a row."""

    def __init__(self, topics: Sequence[Topic], several: frozenset[InputName]) -> None:
        by_topic = [_slots_of(topic, several) for topic in topics]
        self.slots = [slot for slots in by_topic for slot in slots]
        self.counts = np.array([len(slots) for slots in by_topic], np.intp)
        self.begins = np.cumsum(self.counts) - self.counts
        self.source = np.array([source.source for _, source, _ in self.slots], np.int64)
        scalings = [source.scaling for _, source, _ in self.slots]
        self.factor = np.array([scaling.factor for scaling in scalings], np.float64)
        self.shift = np.array([scaling.shift for scaling in scalings], np.float64)
        self.ways = Ways([layout for _, _, layout in self.slots])
        for topic, slots in zip(topics, by_topic):
            for axis, source, _ in slots:  # of one publisher, whatever its numbers are
                topic.count((axis.name, source.source), NO_NUMBER, 0)


class _Plain(NamedTuple):
    """Numbers of slots in messages, the stamps of these, their arrivals, and losses before."""

    message: NDArray[np.intp]
    slot: NDArray[np.intp]
    number: NDArray[np.float64]
    stamp: NDArray[np.int64]
    now: NDArray[np.int64]
    lost: NDArray[np.int64]
    most_ahead: NDArray[np.int64]  # of `now`, for a stamp


class TurnReader:
    """Reads the messages of turns for some axes."""

    def __init__(self, axes: Sequence[Axis], read: Callable[[Heard], list[AxisEvent]]) -> None:
        """`read` returns what one message says."""
        self._axes, self._read = axes, read
        self._numbers = {axis.name: number for number, axis in enumerate(axes)}
        self._known: tuple[Any, ...] = ()  # of the slots
        self._slots = _Slots([], frozenset())

    def turn(self, burst: Burst, reading: Reading) -> Turn:
        """Return the events of messages in the order of judging."""
        slots = self._slots_of(burst.topics, reading.several)
        plain, odd = _find(burst, slots, reading.ahead)
        events = _samples(plain, slots)
        for at in np.flatnonzero(events['kind'] == REFUSAL).tolist():
            _, slot, value, stamp, now, missing, most_ahead = (part[at].item() for part in plain)
            lost, source = None if missing == NOT_KNOWN else missing, slots.slots[slot][1]
            events[at] = _record(
                source.sample(value, stamp, now=now, max_future=most_ahead, lost=lost)
            )
        axes = np.array([self._numbers[axis.name] for axis, *_ in slots.slots], np.int64)
        numbers, joints = axes[plain.slot], dict[int, OtherJoints]()
        if len(odd):  # messages that are read by themselves
            read = [
                (at, axis, event)
                for at in odd.tolist()
                for axis, event in self._read(burst.heard(at))
            ]
            joints = {
                at: event.joints
                for at, (_, _, event) in enumerate(read, len(events))
                if isinstance(event, Refusal) and event.joints is not None
            }
            events = joined([events, *(_record(event) for _, _, event in read)])
            others = np.array([self._numbers[axis.name] for _, axis, _ in read], np.int64)
            numbers = np.concatenate((numbers, others))
            places = np.array([at for at, _, _ in read], np.intp)
            in_turn = np.argsort(np.concatenate((plain.message, places)), kind='stable')
            events, numbers = some(events, in_turn), numbers[in_turn]
            joints = _moved(joints, in_turn)
        order = _order(events)
        return Turn(self._axes, some(events, order), numbers[order], _moved(joints, order))

    def _slots_of(self, topics: Sequence[Topic], several: frozenset[InputName]) -> _Slots:
        """Return the slots of topics, those of before while nothing has changed."""
        known = (
            several,
            *((topic.name, len(topic.readers), topic.loss.publishers > 1) for topic in topics),
        )
        if known != self._known:
            self._known, self._slots = known, _Slots(topics, several)
        return self._slots


def _find(burst: Burst, slots: _Slots, ahead: int) -> tuple[_Plain, NDArray[np.intp]]:
    """Return what the messages have at the slots, but for odd ones, which come beside it."""
    counts = slots.counts[burst.topic]
    message = np.repeat(np.arange(len(counts)), counts)
    within = np.arange(len(message)) - np.repeat(np.cumsum(counts) - counts, counts)
    slot = slots.begins[burst.topic[message]] + within
    is_plain, number, stamp = slots.ways.walk(burst.data, burst.place[message], slot)
    most_ahead = np.array([axis.max_future + ahead for axis, *_ in slots.slots], np.int64)
    plain = _Plain(
        message=message,
        slot=slot,
        number=number,
        stamp=stamp,
        now=burst.now[message],
        lost=burst.lost[message],
        most_ahead=most_ahead[slot],
    )
    is_odd = counts == 0
    is_odd[message[~is_plain]] = True
    odd = np.flatnonzero(is_odd)
    if len(odd):
        kept = ~is_odd[message]
        plain = _Plain(*(column[kept] for column in plain))
    return plain, odd


def _samples(plain: _Plain, slots: _Slots) -> Events:
    """Return the samples of plain messages; what gives none is a REFUSAL without its reason."""
    _, slot, number, stamp, now, lost, most_ahead = plain
    with np.errstate(invalid='ignore', over='ignore'):
        value = number * slots.factor[slot] + slots.shift[slot]
    early = (now != 0) & (stamp - now > most_ahead)
    return blank(
        len(slot),
        kind=np.where(~np.isfinite(value) | (stamp < 0) | early, REFUSAL, SAMPLE),
        source=slots.source[slot],
        stamp=np.clip(np.where(stamp == 0, now, stamp), EARLIEST, LATEST),
        arrival=np.clip(np.where(now == 0, stamp, now), EARLIEST, LATEST),
        lost=lost,
        value=value,
        stamp_source=np.where(stamp == 0, StampSource.RECEIVE, StampSource.HEADER),
    )


def _record(event: InputSample | Refusal) -> Events:
    record = Event()
    fill(record, event)
    return as_array(record)


def _slots_of(topic: Topic, several: frozenset[InputName]) -> list[Slot]:
    """Return a slot for each reader of a topic; none if its messages are read by themselves."""
    slots: list[Slot] = []
    for reader, (axis, source) in enumerate(topic.readers):
        field = topic.field(reader) if topic.subscription.raw else None
        if field is None or topic.loss.publishers > 1 or (axis.name, source.source) in several:
            return []
        slots.append((axis, source, field.layout))
    return slots


def _moved(joints: Mapping[int, OtherJoints], order: NDArray[np.intp]) -> dict[int, OtherJoints]:
    """Return joints by the places at which their events stand in an order."""
    places = np.argsort(order).tolist() if joints else ()
    return {places[at]: named for at, named in joints.items()}


def _order(events: Events) -> NDArray[np.intp]:
    """Return the places of events in the order of judging, see `ordered` of `core.inputs`."""
    _, first, group = np.unique(events['stamp'], return_index=True, return_inverse=True)
    return np.lexsort((events['source'], first[group]))
