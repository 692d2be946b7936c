# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Error in speed of the limit of RCS on a surface.

Measured at random points that lie on the limit by the lookup: what the solver of its tier finds
there instead, over the slope of RCS, is a change of the logarithm of the speed.

"""

from collections.abc import Callable, Iterator
import math
import random

from scipy.optimize import brentq
from surrogate.builder.tiers import solve_point
from surrogate.surface import Surface
from surrogate.surface.aims import RCS_LIMIT
from surrogate.surface.file import SurfaceData

STEP = 0.01
"""Change of the logarithm of the speed over which the slope of RCS is taken [-]."""
TRIES = 20
"""Loads and temperatures that are tried per point: not all have a limit within the speeds."""
INSIDE = 1e-9
"""Distance from the ends of the speed range, as a logarithm [-]."""


Place = tuple[float, float, float]
"""Speed [rad/s], load [N] and temperature [K]."""


def limit_errors(
    data: SurfaceData, points: int, seed: int, has_time: Callable[[], bool]
) -> Iterator[tuple[Place, float]]:
    """
    Yield points on the limit by the lookup, and how far off it is, as long as `has_time` says so.

    Up to `points` random ones. The error is the logarithm of its speed by the lookup over that by
    the solver [-], NaN where the solver has no solution.

    """
    surface, drawn = Surface(data), random.Random(seed)
    for _ in range(points):
        if not has_time():
            return
        for _ in range(TRIES):
            load = drawn.uniform(*surface.load_range)
            temperature = drawn.uniform(*surface.temperature_range)
            speed = limit_speed(surface, load, temperature)
            if speed is not None:
                break
        else:
            return
        place = speed, load, temperature
        yield place, limit_error(surface, place, solve_point(data.header, *place).rcs)


def limit_speed(surface: Surface, load: float, temperature: float) -> float | None:
    """
    Return the speed [rad/s] at which RCS falls through its limit, at a load [N] and temperature.

    None where it does not well inside the speeds of the surface, or an answer is missing there.

    """

    def above(log_speed: float) -> float:
        return surface.lookup(math.exp(log_speed), load, temperature).rcs - RCS_LIMIT

    low, high = (math.log(speed) for speed in surface.speed_range)
    low, high = low + INSIDE, high - INSIDE
    if not above(low) > 0 > above(high):
        return None
    try:
        root = float(brentq(above, low, high))
    except ValueError:  # a masked node on the way, whose lookup is NaN
        return None
    inside = low < root - STEP and root + STEP < high
    return math.exp(root) if inside and above(root - STEP) > above(root + STEP) else None


def limit_error(surface: Surface, place: Place, rcs: float) -> float:
    """Return the error [-] at a place on the limit where the solver finds `rcs` [-]."""
    speed, load, temperature = place
    slow, fast = (
        surface.lookup(speed * math.exp(side * STEP), load, temperature).rcs for side in (-1, 1)
    )
    return (rcs - RCS_LIMIT) / (fast - slow) * 2 * STEP
