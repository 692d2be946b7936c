# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
The publishers of one topic, and those of one input, told apart by publication numbers.

The middleware tells how many publishers there are and which number each message has, and not whose
message it is. Every publisher numbers its messages upward.

"""

from collections import deque
from collections.abc import Sequence
from typing import NamedTuple

from ballscrew_monitor.core.inputs import Source
from ballscrew_monitor.judge.records import SHOWN

NO_NUMBER = 0
"""What a middleware without publication numbers says; the first real one is 1."""
InputName = tuple[str, Source]
"""An input, by its axis and what it measures."""
ENOUGH = 2  # numbers that fall back within SHOWN; a publisher that starts again gives one


class Reading(NamedTuple):
    """How messages are read: time [ns] by which stamps may lead, inputs of several publishers."""

    ahead: int = 0
    several: frozenset[InputName] = frozenset()


READING = Reading()
"""Nothing but what the parameters allow."""


class LossCounter:
    """Counts the gaps in the publication numbers of one topic, however many publishers it has."""

    def __init__(self) -> None:
        self._last: list[int] = []  # numbers, of each publisher that is known the last one
        self.publishers = 1

    def match(self, publishers: int) -> None:
        """Note how many publishers there are now; each of them is counted from the beginning."""
        self.publishers = publishers
        self._last.clear()

    def take(self, number: int) -> int | None:
        """
        Return how many messages were lost just before the one of this publication number.

        None when that is not known: there are no numbers, or the message may be the first one of
        its publisher. It is that of the publisher whose last number is next below. A number that
        falls back belongs to a publisher that has started again.

        """
        if number == NO_NUMBER:
            self._last.clear()
            return None
        below = max((last for last in self._last if last < number), default=NO_NUMBER)
        alike = self.publishers <= 1 or below == number - 1
        if below and (alike or len(self._last) == self.publishers):
            self._last[self._last.index(below)] = number
            return number - below - 1
        if len(self._last) >= max(self.publishers, 1):
            self._last.clear()
        self._last.append(number)
        return 0 if self.publishers <= 1 else None

    def take_many(self, numbers: Sequence[int]) -> list[int | None]:
        """Return the same for messages one after the other."""
        if self.publishers <= 1 and len(self._last) == 1:
            before = self._last + list(numbers)
            gaps = [number - last - 1 for last, number in zip(before, numbers)]
            if min(gaps, default=0) >= 0:
                self._last = before[-1:]
                return list(gaps)
        return [self.take(number) for number in numbers]


class SourceCounter:
    """Tells whether several publishers of a topic send one input."""

    def __init__(self) -> None:
        """Begin before the first sample; `several` None: not known."""
        self.several: bool | None = False
        self._last = NO_NUMBER
        self._falls: deque[int] = deque(maxlen=ENOUGH)  # when numbers fell back [ns]

    def take(self, number: int, publishers: int, now: int) -> None:
        """Take the publication number of a sample of the input, which arrived at `now` [ns]."""
        if publishers <= 1:
            self.several, self._last = False, NO_NUMBER
            self._falls.clear()
        elif number == NO_NUMBER:
            self.several = self.several or None
        else:
            if number <= self._last:
                self._falls.append(now)
            self._last = number
            passed = now - self._falls[0] if len(self._falls) == ENOUGH else -1
            self.several = 0 <= passed <= SHOWN
