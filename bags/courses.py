# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Courses of a quantity over time in closed form: straight lines between corners, and steps.

So the time at which a quantity passes a limit is known without looking at any sample.

"""

import bisect
from collections.abc import Iterator
import dataclasses
import itertools

Corners = tuple[tuple[float, float], ...]


@dataclasses.dataclass(frozen=True, slots=True)
class Course:
    """Straight lines between corners, each a time [s] and a value; level before and after."""

    corners: Corners

    def at(self, time: float) -> float:
        """Return the value at `time` [s]."""
        place = bisect.bisect_right(self.corners, time, key=lambda corner: corner[0])
        if place in (0, len(self.corners)):
            return self.corners[0 if place == 0 else -1][1]
        (begin, low), (end, high) = self.corners[place - 1], self.corners[place]
        return low + (high - low) * (time - begin) / (end - begin)

    def passes(self, value: float) -> tuple[float, ...]:
        """Return the times [s] at which it passes `value`, in order."""
        return tuple(
            begin + (end - begin) * (value - low) / (high - low)
            for (begin, low), (end, high) in itertools.pairwise(self.corners)
            if (low < value) is not (high < value)
        )

    def pass_between(self, first: float, second: float, number: int = 0) -> tuple[float, float]:
        """Return when its pass of a `number` goes through one value and through another [s]."""
        times = (self.passes(first)[number], self.passes(second)[number])
        return min(times), max(times)


@dataclasses.dataclass(frozen=True, slots=True)
class Steps:
    """A value that leaps at stated times [s]; zero before the first."""

    corners: Corners = ()

    def at(self, time: float) -> float:
        """Return the value at `time` [s]."""
        place = bisect.bisect_right(self.corners, time, key=lambda corner: corner[0])
        return self.corners[place - 1][1] if place else 0.0


def constant(value: float) -> Course:
    """Return a course that never changes."""
    return Course(((0.0, value),))


def moves(*targets: tuple[float, float], ramp: float) -> Course:
    """
    Return a course from zero through targets, each a time [s] and a value.

    At each time the value begins to go to its target along a ramp of the duration `ramp` [s].

    """
    return Course(tuple(_ramps(targets, ramp)))


def _ramps(targets: tuple[tuple[float, float], ...], ramp: float) -> Iterator[tuple[float, float]]:
    here = 0.0
    for time, target in targets:
        yield time, here
        yield time + ramp, target
        here = target
