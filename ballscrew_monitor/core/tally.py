# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Sums over time: statistics of the current window, and totals since they were reset."""

import dataclasses
import math

from surrogate.units import TURN

NAN = math.nan


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class Extremes:
    """Smallest, mean and largest value, NaN when there was none."""

    low: float = NAN
    mean: float = NAN
    high: float = NAN


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class WindowStatistics:
    """Extremes since the last publication: [rad/s], [N], [-], [-], [-]."""

    count: int
    speed: Extremes
    axial_load: Extremes
    efficiency: Extremes
    rcs: Extremes
    film_ratio: Extremes


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class Totals:
    """
    Sums since they were reset.

    Times [ns] so that they add up exactly, angle [rad] of both directions counted up, energy_lost
    [J]; `since` is the stamp [ns] of their first sample, 0 before it.

    """

    running_time: int = 0
    unjudged_time: int = 0
    boundary_time: int = 0
    mixed_time: int = 0
    hydrodynamic_time: int = 0
    optimal_time: int = 0
    outside_time: int = 0
    angle: float = 0.0
    energy_lost: float = 0.0
    since: int = 0

    @property
    def revolutions(self) -> float:
        """Return the revolutions of the screw [-]."""
        return self.angle / TURN
