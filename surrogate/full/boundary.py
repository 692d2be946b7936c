# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
How far off in speed a full-tier surface has the limit of RCS of the optimal zone.

Measured at points that lie on the limit by the lookup: what the solver finds there instead, over
the slope of RCS, is a change of the logarithm of the speed.

"""

from dataclasses import dataclass
import math

from scipy.optimize import brentq
from surrogate.surface import Surface
from surrogate.surface_diff import RCS_LIMIT

Point = tuple[float, float, float]
"""Speed [rad/s], load [N], temperature [K]."""
STEP = 0.01
"""Change of the logarithm of the speed over which the slope of RCS is taken [-]."""


@dataclass(frozen=True, kw_only=True, slots=True)
class BoundaryError:
    """
    Where on the limit [N, K], and how far off it is.

    The error is the logarithm of its speed by the lookup over that by the solver [-].

    """

    load: float
    temperature: float
    error: float


def boundary_speed(surface: Surface, load: float, temperature: float) -> float | None:
    """
    Return the speed [rad/s] of a load [N] and temperature [K] at the limit.

    None where RCS does not fall through the limit well inside the speeds of the surface.

    """

    def above(log_speed: float) -> float:
        return surface.lookup(math.exp(log_speed), load, temperature).rcs - RCS_LIMIT

    low, high = (math.log(speed) for speed in surface.speed_range)
    low, high = low + 1e-9, high - 1e-9
    if not above(low) > 0 > above(high):
        return None
    found = float(brentq(above, low, high))
    falls = low < found - STEP and found + STEP < high
    return math.exp(found) if falls and above(found - STEP) > above(found + STEP) else None


def boundary_error(surface: Surface, point: Point, rcs: float) -> BoundaryError:
    """Return the error at a point on the limit where the solver finds `rcs` [-]."""
    speed, load, temperature = point
    slow, fast = (
        surface.lookup(speed * math.exp(side * STEP), load, temperature).rcs for side in (-1, 1)
    )
    error = (rcs - RCS_LIMIT) / (fast - slow) * 2 * STEP
    return BoundaryError(load=load, temperature=temperature, error=error)
