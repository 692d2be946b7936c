# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Log times that go back in the order in which messages were written: two runs in one bag.

By log time such runs would be sorted into each other. A little disorder is that of several threads
of a recorder.

"""

from collections.abc import Collection, Iterator

from ballscrew_monitor.core.conversions import seconds
from ballscrew_monitor.judge.step import BACKWARD_JUMP
from ballscrew_monitor.recordings.bag import Bag
from ballscrew_monitor.recordings.bulk.batches import PLACES
from ballscrew_monitor.recordings.bulk.chunks import Integers, Messages
from ballscrew_monitor.recordings.storages import McapStorage
from ballscrew_monitor.recordings.words import counted
import numpy as np
from surrogate.files import InputError


class WrittenTimes:
    """The stretches of rising log times of each topic, in chunks that come in whatever order."""

    def __init__(self) -> None:
        """Begin with no message."""
        self._stretches: dict[str, list[tuple[int, int, int, int]]] = {}

    def add(self, topic: str, messages: Messages) -> None:
        """Take further messages of a topic, those of a chunk together."""
        order = np.argsort(messages.place)
        places, times = messages.place[order], messages.log_time[order]
        borders = np.flatnonzero(np.diff(places >> PLACES)) + 1
        held = self._stretches.setdefault(topic, [])
        for place, part in zip(np.split(places, borders), np.split(times, borders), strict=True):
            while len(part):
                end = _end(part)
                held.append((int(place[0]), int(part[:end].min()), int(part[:end].max()), end))
                place, part = place[end:], part[end:]

    def falls(self) -> Iterator[tuple[str, int, int]]:
        """Yield where the log times of a topic go back: to which from which of them [ns]."""
        for topic, held in self._stretches.items():
            course = _Course()
            for _, first, last, count in sorted(held):
                if fall := course.fall(first, last, count):
                    yield topic, *fall


class _Course:
    """The log times of a topic so far [ns]; a single message that lies back is no run."""

    def __init__(self) -> None:
        self._latest = 0
        self._single: tuple[int, int] | None = None

    def fall(self, first: int, last: int, count: int = 1) -> tuple[int, int] | None:
        """Take a rising stretch; return where times go back with it: to which from which [ns]."""
        if self._latest - first <= BACKWARD_JUMP:
            self._latest, self._single = max(self._latest, last), None
        elif self._single is None and count == 1:
            self._single = first, self._latest
        else:
            span, self._latest, self._single = self._single or (first, self._latest), last, None
            return span
        return None


def _end(times: Integers) -> int:
    """Return where log times first go back or leap [ns], how many they are if they do not."""
    most = np.maximum.accumulate(times)
    apart = (most - times > BACKWARD_JUMP) | (np.diff(most, prepend=times[0]) > BACKWARD_JUMP)
    return int(apart.argmax()) if apart.any() else len(times)


def check_rising(bag: Bag, times: WrittenTimes, topics: Collection[str]) -> None:
    """Raise InputError if log times go back; `times` has those of a bag that is read by chunks."""
    falls = [*times.falls()]
    if not all(
        isinstance(storage, McapStorage) and storage.is_indexed for storage in bag.storages
    ):
        courses: dict[str, _Course] = {}
        for message in bag.as_written(topics):
            course = courses.setdefault(message.topic, _Course())
            if fall := course.fall(message.log_time, message.log_time):
                falls.append((message.topic, *fall))
    if falls:
        topic, to, latest = falls[0]
        count = sum(name == topic for name, *_ in falls)
        back, after = seconds(latest - to), seconds(latest - bag.start_time)
        raise InputError(
            f'bag {bag.path}: the log times of {topic} go back {counted(count, "time")}, '
            f'first by {back:.4g} s after {after:.4g} s: its runs cannot be told apart, record '
            'each in a bag of its own'
        )
