# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The events of all axes of a recording, as one array of `judge.records.Event`."""

from collections.abc import Sequence
from typing import Any

from ballscrew_monitor.core.fields import OtherJoints
from ballscrew_monitor.core.inputs import InputSample, Refusal, Source
from ballscrew_monitor.judge.monitor import fill
from ballscrew_monitor.judge.records import ALL_AXES, EVENT, Event, NOT_KNOWN, TICK
import numpy as np
from numpy.typing import NDArray
from surrogate.surface.records import as_array

Events = NDArray[Any]
"""An array of EVENT."""
TICK_SOURCE = max(Source) + 1
"""Place of a tick among the sources: after the samples of equal stamp."""
MOST_NAMED = 4096
"""Kinds of messages about other joints that are told apart in a recording."""
BLANK = as_array(Event())


class Notes:
    """The joints that messages about others name, which events refer to by number."""

    def __init__(self) -> None:
        self._numbers: dict[OtherJoints, int] = {}
        self._joints: list[OtherJoints] = []

    def number(self, joints: OtherJoints | None) -> int:
        """Return the number of some joints, NOT_KNOWN for none or one kind too many."""
        if joints is None or (joints not in self._numbers and len(self._joints) == MOST_NAMED):
            return NOT_KNOWN
        if joints not in self._numbers:
            self._numbers[joints] = len(self._joints)
            self._joints.append(joints)
        return self._numbers[joints]

    def named(self, numbers: NDArray[np.int64]) -> list[OtherJoints]:
        """Return the joints of some numbers, each once, in the order in which they come first."""
        return [self._joints[number] for number in dict.fromkeys(numbers.tolist()) if number >= 0]


def blank(count: int, **columns: Any) -> Events:
    """Return `count` events of these columns, arrays or one value for all; the rest is unset."""
    events = np.repeat(BLANK, count)
    for name, values in columns.items():
        events[name] = values
    return events


def event_of(
    read: InputSample | Refusal, notes: Notes, *, axis: int, log_time: int, place: int
) -> Events:
    """Return what an axis reads of a message at a place of its recording; times [ns]."""
    event = Event(axis=axis, stamp=log_time, log_time=log_time, place=place)
    fill(event, read)
    if isinstance(read, Refusal):
        event.note = notes.number(read.joints)
    return as_array(event)


def joined(parts: Sequence[Events]) -> Events:
    """Return all events of `parts`, one part after the other."""
    parts = [part for part in parts if len(part)] or [np.empty(0, EVENT)]
    return (
        parts[0] if len(parts) == 1 else np.concatenate([_raw(part) for part in parts]).view(EVENT)
    )


def some(events: Events, which: NDArray[Any]) -> Events:
    """Return some of the events by their places, or by what is true of them."""
    return _raw(events)[which].view(EVENT)


def repeated(events: Events, count: int) -> Events:
    """Return events `count` times, one after the other."""
    return np.tile(_raw(events), count).view(EVENT)


def inserted(events: Events, at: NDArray[np.intp], others: Events) -> Events:
    """Return events with others before those at some places, which rise."""
    return np.insert(_raw(events), at, _raw(others)).view(EVENT)


def _raw(events: Events) -> NDArray[Any]:
    """Return events as bytes, which numpy copies at once, and fields one after the other."""
    return events.view(np.dtype((np.void, EVENT.itemsize)))


def ticks(stamps: Any, *, place: int, axis: Any = ALL_AXES, kind: int = TICK) -> Events:
    """Return ticks at some stamps [ns], or begins of runs, which are of all axes alike."""
    times = {'log_time': stamps, 'stamp': stamps, 'arrival': stamps}
    return blank(len(stamps), kind=kind, source=TICK_SOURCE, axis=axis, place=place, **times)


def places_of_axis(events: Events, number: int) -> NDArray[np.intp]:
    """Return the places of the events of an axis, ticks of all axes among them."""
    return np.flatnonzero((events['axis'] == number) | (events['axis'] == ALL_AXES))
