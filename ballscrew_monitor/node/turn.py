# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
The messages of one turn as an array of events in the order of judging.

The numbers of all messages are taken together; one that gives no plain sample is read by itself.
So the events are those that the messages give one by one.

"""

from collections.abc import Callable, Mapping, Sequence
from typing import NamedTuple

from ballscrew_monitor.core.fields import OtherJoints
from ballscrew_monitor.core.inputs import Input, InputSample, Refusal, Source, StampSource
from ballscrew_monitor.judge.monitor import EARLIEST, fill, LATEST
from ballscrew_monitor.judge.records import Event, NOT_KNOWN, REFUSAL, SAMPLE
from ballscrew_monitor.node.event_recorder import AxisEvent, Heard
from ballscrew_monitor.node.sources import Reading
from ballscrew_monitor.node.topic import Topic
from ballscrew_monitor.recordings.bulk.events import blank, Events, some
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
        turns = []
        for number in np.unique(self.numbers).tolist():
            places = np.flatnonzero(self.numbers == number)
            joints = {
                at: self.joints[place]
                for at, place in enumerate(places.tolist() if self.joints else ())
                if place in self.joints
            }
            turns.append(AxisTurn(self.axes[number], some(self.events, places), joints))
        return turns


class _Slot(NamedTuple):
    """An input that is read in a turn, what finds its number, and how far stamps may lead [ns]."""

    axis: Axis
    source: Input
    find: Callable[[bytes], tuple[float, int] | None]
    most_ahead: int


Found = tuple[int, float, int, int, int]
"""Number of a slot, number and stamp of a message, its arrival, messages lost before it."""
ODD = 0, 0.0, 0, 0, 0
"""What stands for an event of a message that is read by itself."""


class TurnReader:
    """Reads the messages of turns for some axes."""

    def __init__(self, axes: Sequence[Axis], read: Callable[[Heard], list[AxisEvent]]) -> None:
        """`read` returns what one message says."""
        self._axes, self._read = axes, read
        self._numbers = {axis.name: number for number, axis in enumerate(axes)}

    def turn(self, heard: Sequence[Heard], reading: Reading) -> Turn:
        """Return the events of messages in the order of judging."""
        slots: list[_Slot] = []
        topics: dict[str, range] = {}  # of the slots of each topic
        found: list[Found] = []
        odd: dict[int, AxisEvent] = {}
        for one in heard:
            arrival, now, lost = one
            mine = topics.get(arrival.topic.name)
            if mine is None:
                mine = topics[arrival.topic.name] = _open(arrival.topic, reading, slots)
                for slot in mine:
                    name = slots[slot].axis.name, slots[slot].source.source
                    arrival.topic.count(name, arrival.number, now)
            numbers = [slots[slot].find(arrival.data) for slot in mine]
            if not numbers or None in numbers:
                events = self._read(one)
                odd |= enumerate(events, len(found))
                found += [ODD] * len(events)
                continue
            missing = NOT_KNOWN if lost is None else lost
            for slot, number in zip(mine, numbers, strict=True):
                assert number is not None
                found.append((slot, *number, now, missing))
        return self._ordered(slots, found, odd)

    def _ordered(
        self, slots: Sequence[_Slot], found: Sequence[Found], odd: dict[int, AxisEvent]
    ) -> Turn:
        """Return the turn of what was found, but for the events at odd places."""
        events = _samples(slots, found) if slots and found else blank(len(found))
        for place in np.flatnonzero(events['kind'] == REFUSAL).tolist():
            odd[place] = slots[found[place][0]].axis, _read_again(slots, found[place])
        of_slots = [self._numbers[slot.axis.name] for slot in slots] or [0]
        numbers = np.array([of_slots[slot] for slot, *_ in found], np.int64)
        joints = {}
        for place, (axis, event) in odd.items():
            record = Event()
            fill(record, event)
            events[place], numbers[place] = as_array(record)[0], self._numbers[axis.name]
            if isinstance(event, Refusal) and event.joints is not None:
                joints[place] = event.joints
        order = _order(events)
        if joints:
            places = np.argsort(order)
            joints = {int(places[place]): one for place, one in joints.items()}
        return Turn(self._axes, some(events, order), numbers[order], joints)


def _samples(slots: Sequence[_Slot], found: Sequence[Found]) -> Events:
    """Return the samples of what was found; what gives none is a REFUSAL without its reason."""
    slot, number, stamp, now, lost = map(np.array, zip(*found))
    inputs = [(one.source.source, *_line(one), one.most_ahead) for one in slots]
    source, factor, shift, most_ahead = (np.array(column)[slot] for column in zip(*inputs))
    with np.errstate(invalid='ignore', over='ignore'):
        value = number * factor + shift
    early = (now != 0) & (stamp - now > most_ahead)
    return blank(
        len(found),
        kind=np.where(~np.isfinite(value) | (stamp < 0) | early, REFUSAL, SAMPLE),
        source=source,
        stamp=np.clip(np.where(stamp == 0, now, stamp), EARLIEST, LATEST),
        arrival=np.clip(np.where(now == 0, stamp, now), EARLIEST, LATEST),
        lost=lost,
        value=value,
        stamp_source=np.where(stamp == 0, StampSource.RECEIVE, StampSource.HEADER),
    )


def _line(slot: _Slot) -> tuple[float, float]:
    return slot.source.scaling.factor, slot.source.scaling.shift


def _read_again(slots: Sequence[_Slot], found: Found) -> InputSample | Refusal:
    """Return what an input makes of a number that gives no sample."""
    number, value, stamp, now, missing = found
    lost, slot = None if missing == NOT_KNOWN else missing, slots[number]
    return slot.source.sample(value, stamp, now=now, max_future=slot.most_ahead, lost=lost)


def _open(topic: Topic, reading: Reading, slots: list[_Slot]) -> range:
    """Add a slot for each reader of a topic; none if its messages are read by themselves."""
    begin, several = len(slots), topic.loss.publishers > 1
    for reader, (axis, source) in enumerate(topic.readers):
        field = topic.field(reader) if topic.subscription.raw else None
        if field is None or several or (axis.name, source.source) in reading.several:
            del slots[begin:]
            break
        slots.append(_Slot(axis, source, field.find, axis.max_future + reading.ahead))
    return range(begin, len(slots))


def _order(events: Events) -> NDArray[np.intp]:
    """Return the places of events in the order of judging, see `ordered` of `core.inputs`."""
    _, first, group = np.unique(events['stamp'], return_index=True, return_inverse=True)
    return np.lexsort((events['source'], first[group]))
