# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
A surface over speed and opposing load around a run, on a grid at one oil temperature.

Speeds are logarithmic and begin where judging does: contact sets in at a hundredth of the highest
speed.

"""

import dataclasses
import math

from ballscrew_monitor.core.conversions import kelvin
from ballscrew_monitor.core.judgement import Limits
import numpy as np
from numpy.typing import NDArray
from surrogate.surface import look_up_many, Surface
from surrogate.units import RPM

Array = NDArray[np.float64]

SPEEDS, LOADS = 120, 181  # points of the grid
NAMES = ('efficiency', 'rcs', 'film_ratio')


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class Field:
    """
    Surface on a grid: speed [rev/min] and opposing load [N]; NaN where it says nothing.

    Least and largest limit of RCS in speed over that here [-].

    """

    speed: Array
    load: Array
    efficiency: Array
    rcs: Array
    film_ratio: Array
    band: tuple[float, float]

    def is_optimal(self, limits: Limits) -> NDArray[np.bool_]:
        """Return True where limits are kept."""
        return is_optimal(self.load[:, None], self.rcs, self.efficiency, limits)

    def judged_efficiency(self, light_load: float) -> Array:
        """Return the efficiency [-] without its valley about no load; a light load [N]."""
        return np.where(np.abs(self.load)[:, None] < 0.2 * light_load, math.nan, self.efficiency)

    def middles(self) -> 'Field':
        """Return the numbers amid each four points of the grid."""
        means = {}
        for name in NAMES:
            of = getattr(self, name)
            means[name] = 0.25 * (of[1:, 1:] + of[1:, :-1] + of[:-1, 1:] + of[:-1, :-1])
        return Field(
            speed=np.sqrt(self.speed[1:] * self.speed[:-1]),
            load=0.5 * (self.load[1:] + self.load[:-1]),
            band=self.band,
            **means,
        )


def is_optimal(load: Array, rcs: Array, efficiency: Array, limits: Limits) -> NDArray[np.bool_]:
    """
    Return True where limits are kept; below the light load only RCS counts.

    Opposing load [N]; RCS and efficiency [-].

    """
    light = np.abs(load) < limits.light_load
    return (rcs < limits.rcs) & (light | (efficiency >= limits.efficiency))


def sample(
    surface: Surface,
    temperature: float,
    *,
    speeds: tuple[float, float],
    loads: tuple[float, float],
) -> Field:
    """Return a surface at a temperature [degC] between speeds [rad/s] and opposing loads [N]."""
    speed, load = np.geomspace(*speeds, SPEEDS), np.linspace(*loads, LOADS)
    across, along = (each.ravel() for each in np.meshgrid(speed, load))
    heats = np.full(across.size, kelvin(temperature))
    answers = look_up_many(surface, across, along, heats)
    shaped = {name: answers[name].reshape(LOADS, SPEEDS) for name in NAMES}
    return Field(speed=speed / RPM, load=load, band=surface.onset_band, **shaped)


def judged_speeds(surface: Surface, standstill: float) -> tuple[float, float]:
    """Return the speeds that are judged [rad/s], or all of the surface where none is."""
    slowest, fastest = surface.speed_range
    judged = max(slowest, standstill)
    return (judged if judged < fastest else slowest), fastest


def loads_around(
    surface: Surface, low: float, high: float, *, light_load: float
) -> tuple[float, float]:
    """Return opposing loads about those of a run [N], NaN without any, and the light load [N]."""
    reach = 1.5 * light_load
    low, high = min(low, -reach), max(high, reach)
    if math.isnan(low + high):
        low, high = -reach, reach
    margin = 0.06 * (high - low)
    return max(low - margin, surface.load_range[0]), min(high + margin, surface.load_range[1])


def map_temperatures(low: float, mean: float, high: float) -> tuple[float, list[float]]:
    """Return the temperature of a map, and others whose border is to be drawn [degC]."""
    middle = round(mean)
    return float(middle), [degrees for degrees in (low, high) if abs(degrees - middle) > 2]
