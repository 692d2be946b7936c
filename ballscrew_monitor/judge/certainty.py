# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Certainty of a verdict outside the zone: wherever in its band the limit of RCS may lie.

The band is a pair of factors on the speed of the limit. A point in which asperities carry too much
is surely outside if they also do at its speed over the least factor, else perhaps. Too low an
efficiency is surely so: it is that of the contacts and of an identified drag, and a typical drag
would lower it. The zone itself knows nothing of this.

"""

import enum
import math

from ballscrew_monitor.core.judgement import Limits, Zone
from ballscrew_monitor.judge.point import POSITIVE
from ballscrew_monitor.judge.records import LIGHT_LOAD
import numpy as np
from numpy.typing import NDArray
from surrogate.surface import look_up_many, Surface

Rows = NDArray[np.void]


class Outside(enum.Enum):
    """How surely a point is outside the zone; UNBANDED: outside, and the surface has no bands."""

    UNKNOWN = 'unknown'
    NOT = 'not'
    PERHAPS = 'perhaps'
    SURELY = 'surely'
    UNBANDED = 'unbanded'


def least_factor(surface: Surface) -> float:
    """Return the least factor of the band on the speed of the limit [-], NaN without a band."""
    return surface.onset_band[0]


def surely_outside(rows: Rows, surface: Surface, limits: Limits) -> NDArray[np.bool_]:
    """Return which of `rows`, an array of ROW, are surely outside on a surface with bands."""
    outside = rows['zone'] == Zone.OUTSIDE
    heavy = rows['gates'] & LIGHT_LOAD == 0
    sure: NDArray[np.bool_] = outside & heavy & (rows['efficiency'] < limits.efficiency)
    asked = np.flatnonzero(outside & ~sure)
    least = least_factor(surface)
    if len(asked) and math.isfinite(least):
        some = rows[asked]
        load = np.where(some['direction'] == POSITIVE, -1.0, 1.0) * some['axial_load']
        speed = np.abs(some['speed']) / least
        answers = look_up_many(surface, speed, load, some['temperature'])
        sure[asked] = answers['rcs'] >= limits.rcs
    return sure


def outside_of(
    zone: int,
    surface: Surface,
    *,
    rcs_limit: float,
    efficiency_limit: float,
    speed: float,
    load: float,
    temperature: float,
    efficiency: float,
) -> Outside:
    """
    Return how surely a point of a `zone` is outside.

    Speed [rad/s] by its amount, opposing load [N], temperature [K]; `efficiency` [-] is NaN where
    it is not judged.

    """
    if zone != Zone.OUTSIDE:
        return Outside.NOT if zone == Zone.OPTIMAL else Outside.UNKNOWN
    least = least_factor(surface)
    if efficiency < efficiency_limit:
        return Outside.SURELY
    if math.isnan(least):
        return Outside.UNBANDED
    rcs = surface.lookup(speed / least, load, temperature).rcs
    return Outside.SURELY if rcs >= rcs_limit else Outside.PERHAPS
