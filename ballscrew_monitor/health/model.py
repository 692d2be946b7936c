# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
What the surface in use says at comparable points, and at other temperatures, preloads and films.

Friction torques are those of the screw, positive against the motion, NaN outside the surface.

"""

from collections.abc import Sequence
import math

from ballscrew_monitor.health.companions import Companions
from ballscrew_monitor.health.lubrication import opposed
from ballscrew_monitor.health.points import surface_id
from ballscrew_monitor.health.records import ComparablePoint
import numpy as np
from numpy.typing import NDArray
from surrogate.surface import Surface
from surrogate.units import TURN

Array = NDArray[np.float64]
FILM_EXPONENT = 0.67
"""Exponent of the speed in the film of a point contact, Hamrock and Dowson (1977) [-]."""


class Model:
    """A surface asked at the means of points, each place once."""

    def __init__(self, surface: Surface, companions: Companions | None = None) -> None:
        """Ask `surface`; `companions` know other preloads."""
        self.surface, self.companions = surface, companions
        self._known: dict[tuple[float, float, float], tuple[float, float]] = {}

    def friction(self, speed: float, load: float, temperature: float) -> float:
        """Return the friction torque [N m] at |w| [rad/s], opposing load [N] and [K]."""
        return self._look_up(speed, load, temperature)[0]

    def residual(self, point: ComparablePoint) -> float:
        """Return the measured less the modelled friction torque of a point [N m]."""
        if point.surface == surface_id(self.surface) and math.isfinite(point.residual):
            return math.copysign(1.0, point.speed) * point.residual
        return self.measured(point) - self.friction(*self.place(point))

    def measured(self, point: ComparablePoint) -> float:
        """Return the measured friction torque of a point [N m]: the rest moves the load."""
        against = math.copysign(1.0, point.speed) * point.motor_torque
        return against - self.ideal(point)

    def ideal(self, point: ComparablePoint) -> float:
        """Return the torque of a screw without friction that moves the load of a point [N m]."""
        return opposed(point) * self.surface.lead / TURN

    def place(self, point: ComparablePoint) -> tuple[float, float, float]:
        """Return |w| [rad/s], opposing load [N] and temperature [K] of a point."""
        return abs(point.speed), opposed(point), point.temperature

    def warmer(self, points: Sequence[ComparablePoint], shift: float) -> Array:
        """Return the change of friction [N m] where the oil is warmer by `shift` [K]."""
        low, high = self.surface.temperature_range
        return np.array(
            [
                self.friction(speed, load, min(max(heat + shift, low), high))
                - self.friction(speed, load, heat)
                for speed, load, heat in map(self.place, points)
            ]
        )

    def starved(self, points: Sequence[ComparablePoint], factor: float) -> Array:
        """
        Return the change of friction [N m] where the film is `factor` of the flooded one [-].

        Asperities carry what they carry at the slower speed of such a film. The friction of the
        share that they take over is that of the slowest speed of the surface.

        """
        return np.array([self._starved(*self.place(one), factor) for one in points])

    def _starved(self, speed: float, load: float, heat: float, factor: float) -> float:
        slowest = self.surface.speed_range[0]
        thin = max(speed * factor ** (1.0 / FILM_EXPONENT), slowest)
        friction, share = self._look_up(speed, load, heat)
        _, more = self._look_up(thin, load, heat)
        rubbing, whole = self._look_up(slowest, load, heat)
        if not whole > share:
            return 0.0
        return (more - share) / (whole - share) * (rubbing - friction)

    def relieved(self, points: Sequence[ComparablePoint], share: float) -> Array:
        """Return the change of friction [N m] at a `share` of the preload [-], NaN unknown."""
        if self.companions is None:
            return np.full(len(points), np.nan)
        places = [self.place(one) for one in points]
        ratios = [self.companions.friction_ratio(*place, share) for place in places]
        return np.array([self.friction(*at) * (r - 1.0) for at, r in zip(places, ratios)])

    def _look_up(self, speed: float, load: float, heat: float) -> tuple[float, float]:
        """Return friction torque [N m] and RCS [-]."""
        key = speed, load, heat
        if key not in self._known:
            found = self.surface.lookup(*key)
            self._known[key] = float(found.friction_torque), float(found.rcs)
        return self._known[key]
