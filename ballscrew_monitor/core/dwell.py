# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Where an axis dwells and the surface cannot tell inside from outside: a place for a full solve.

Time is an argument [ns], the stamps of the states.

"""

import dataclasses

from ballscrew_monitor.core.conversions import SECOND
from ballscrew_monitor.core.estimate import MachinePoint, PointEstimate
from ballscrew_monitor.core.full_point import JUDGED, known, stated_error
from ballscrew_monitor.core.judgement import Gate, Limits, Verdict

LEAST = 30 * SECOND
"""Shortest stay that counts as dwelling [ns]."""
PAUSE = 600 * SECOND
"""Shortest time between two solves of one axis [ns]."""
SAME = 0.02
"""Largest change of speed and load, over their amounts, that counts as staying [-]."""


@dataclasses.dataclass(slots=True)
class Dwell:
    """Tells when a solve is worth its time."""

    _since: int = 0
    _point: MachinePoint | None = None
    _asked: int | None = None

    def update(
        self,
        stamp: int,
        point: MachinePoint,
        result: PointEstimate,
        verdict: Verdict,
        limits: Limits,
    ) -> bool:
        """Take a state; tell whether its point should be solved."""
        if self._point is None or stamp < self._since or not _is_near(point, self._point):
            self._since, self._point = stamp, point
        rested = self._asked is None or not 0 <= stamp - self._asked < PAUSE
        due = rested and stamp - self._since >= LEAST and is_uncertain(result, verdict, limits)
        if due:
            self._asked = stamp
        return due


def is_uncertain(result: PointEstimate, verdict: Verdict, limits: Limits) -> bool:
    """Tell whether the stated error of the surface, or its spread, reaches a limit of the zone."""
    numbers = result.numbers
    if numbers is None or numbers.corrected or Gate.STANDSTILL in verdict.gates:
        return False
    judged = JUDGED[1:] if Gate.LIGHT_LOAD in verdict.gates else JUDGED
    return any(
        abs(getattr(numbers, name) - getattr(limits, name))
        <= max(stated_error(numbers, name), known(getattr(numbers, f'{name}_std')))
        for name in judged
    )


def _is_near(point: MachinePoint, other: MachinePoint) -> bool:
    return all(
        abs(here - there) <= SAME * abs(there)
        for here, there in ((point.speed, other.speed), (point.axial_load, other.axial_load))
    )
