# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
A reference run: forth and back without load at one speed after another, from slow to fast.

Where the load is derived from the motor torque, the torque tells nothing of the friction, unless
the screw is known to move freely. Nobody cuts while the speeds climb this staircase in strokes, so
a run that does is free of process force, and its stretches count.

"""

from collections.abc import Iterable
import dataclasses
import math
from typing import NamedTuple

from ballscrew_monitor.core.conversions import SECOND
from ballscrew_monitor.health.records import LoadSource, Stretch
from surrogate.units import RPM, TURN

STAIRCASE = tuple(rpm * RPM for rpm in (10.0, 20.0, 50.0, 100.0, 200.0, 500.0))
"""Speeds of the steps [rad/s]."""
FEWEST_STEPS = 4
"""Steps, each in both directions, by which a run is known."""
NEAR = 0.05
"""Distance of a stretch from the speed of its step over that speed [-]."""
PAUSE = 60 * SECOND
"""Longest time between two stretches of a run [ns]."""
LEAST_TIME = 6.0
"""Time at each step in each direction [s]: several stretches, ramps left out."""


class Recogniser:
    """Holds back stretches that may belong to a run until that is known."""

    def __init__(self, free_load: float) -> None:
        """Begin with nothing; `free_load` [N, machine frame] acts in a run, as a weight may."""
        self._free_load = free_load
        self._held: list[Stretch] = []
        self._step = 0
        self._ways: set[int] = set()

    def take(self, stretches: Iterable[Stretch]) -> list[Stretch]:
        """Take stretches in their order; return those that are known to be in a run or not."""
        return [done for stretch in stretches for done in self._next(stretch)]

    def finish(self) -> list[Stretch]:
        """Return what was held back: there is no more to come."""
        known = self._step + (len(self._ways) == 2) >= FEWEST_STEPS
        held, self._held = self._held, []
        self._step, self._ways = 0, set()
        if not known:
            return held
        free = self._free_load
        return [
            dataclasses.replace(stretch, axial_load=free, load_source=LoadSource.FREE)
            if stretch.load_source == LoadSource.DERIVED
            else stretch
            for stretch in held
        ]

    def _next(self, stretch: Stretch) -> list[Stretch]:
        if stretch.speed == 0.0:
            return [stretch]
        if self._held and self._goes_on(stretch):
            self._held.append(stretch)
            return []
        done = self.finish()
        if _is_near(stretch, 0):
            self._held.append(stretch)
            self._ways = {_way(stretch)}
            return done
        return [*done, stretch]

    def _goes_on(self, stretch: Stretch) -> bool:
        """Return True if a stretch is of this step, or of the next once both ways are done."""
        last = self._held[-1]
        if not 0 <= stretch.start - last.start - last.duration * SECOND <= PAUSE:
            return False
        if _is_near(stretch, self._step):
            self._ways.add(_way(stretch))
            return True
        if len(self._ways) == 2 and _is_near(stretch, self._step + 1):
            self._step, self._ways = self._step + 1, {_way(stretch)}
            return True
        return False


def _is_near(stretch: Stretch, step: int) -> bool:
    return step < len(STAIRCASE) and math.isclose(
        abs(stretch.speed), STAIRCASE[step], rel_tol=NEAR
    )


def _way(stretch: Stretch) -> int:
    return 1 if stretch.speed > 0.0 else -1


class Step(NamedTuple):
    """Speed [rad/s], feed [m/s], strokes forth and back, and the time of all of them [s]."""

    speed: float
    feed: float
    strokes: int
    time: float


def planned(lead: float, travel: float) -> list[Step]:
    """Return the steps of a run of a screw with a `lead` [m] over a `travel` [m]."""
    return [_step(speed, speed * lead / TURN, travel) for speed in STAIRCASE]


def _step(speed: float, feed: float, travel: float) -> Step:
    strokes = max(1, math.ceil(LEAST_TIME * feed / travel))
    length = min(travel, LEAST_TIME * feed)
    return Step(speed, feed, strokes, 2.0 * strokes * length / feed)
