# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
The surface fitted to one axis over its baseline: a factor, a warmth of the contacts, a wiper.

A baseline is a few weeks of one season, and what comes later is held against it at other
temperatures. A surface whose friction is 10 % off, or whose contacts are 4 K warmer than the oil,
would make a change of each season. The fit takes what can be seen of both from the baseline, and
its covariance is the doubt that is left.

"""

from collections.abc import Sequence
import dataclasses
from typing import Any

from ballscrew_monitor.health.lubrication import opposed
from ballscrew_monitor.health.records import ComparablePoint
import numpy as np
from numpy.typing import NDArray
from surrogate.surface import look_up_many, Surface
from surrogate.units import TURN

Array = NDArray[np.float64]
SEAL_SPEED = 5.0
"""Speed of the screw at which the excess of a wiper near standstill fades [rad/s]."""
EXPECTED = np.array([1.0, 0.03, 0.01, 2.0])
SPREAD = np.array([0.2, 0.1, 0.03, 4.0])
"""Expected values with their standard deviations: factor [-], drags [N m], warmth [K]."""
WORTH, LEAST = 0.02, 0.002
"""Uncertainty of a point: over its friction [-], and at least [N m]."""
ROUNDS = 5


@dataclasses.dataclass(frozen=True, slots=True)
class Calibration:
    """
    Values of factor [-], constant drag and drag near standstill [N m], warmth [K]; covariance.

    Friction = factor times that of the surface at contacts warmer than the oil by the warmth, plus
    both drags, the second times exp(-|w| / SEAL_SPEED).

    """

    values: tuple[float, ...] = (1.0, 0.0, 0.0, 0.0)
    covariance: tuple[tuple[float, ...], ...] = ((0.0,) * 4,) * 4

    def friction(self, surface: Surface, places: Array) -> Array:
        """Return the friction torque [N m] at rows of |w| [rad/s], opposing load [N] and [K]."""
        factor, *_ = self.values
        return np.asarray(factor * self.contacts(surface, places) + self.drag(places))

    def contacts(self, surface: Surface, places: Array, warmer: float = 0.0) -> Array:
        """Return the friction of the surface [N m] with contacts `warmer` still [K], no factor."""
        return np.array(self.found(surface, places, warmer)['friction_torque'])

    def found(self, surface: Surface, places: Array, warmer: float = 0.0) -> NDArray[Any]:
        """Return what a surface says of contacts `warmer` still [K], see `look_up_many`."""
        heats = self.heats(surface, places, warmer)
        return look_up_many(surface, places[:, 0], places[:, 1], heats)

    def heats(self, surface: Surface, places: Array, warmer: float = 0.0) -> Array:
        """Return the temperatures of contacts `warmer` still [K], within the surface."""
        return np.clip(places[:, 2] + self.values[3] + warmer, *surface.temperature_range)

    def drag(self, places: Array) -> Array:
        """Return what the wiper takes [N m]."""
        _, constant, seal, _ = self.values
        return np.asarray(constant + seal * np.exp(-places[:, 0] / SEAL_SPEED))

    def slopes(self, surface: Surface, places: Array) -> Array:
        """Return the derivatives of the friction by the four values, a row for each place."""
        here = self.contacts(surface, places)
        warmer = self.values[0] * (self.contacts(surface, places, 1.0) - here)
        fades = np.exp(-places[:, 0] / SEAL_SPEED)
        return np.stack([here, np.ones_like(here), fades, warmer], axis=1)


def calibrated(points: Sequence[ComparablePoint], surface: Surface) -> Calibration:
    """Return the calibration of a surface by the points of a baseline, by least squares."""
    places = places_of(points)
    signs = np.sign([one.speed for one in points])
    measured = signs * [one.motor_torque for one in points]
    measured = measured - places[:, 1] * surface.lead / TURN
    found = Calibration(tuple(EXPECTED))
    for _ in range(ROUNDS):
        slopes = found.slopes(surface, places)
        apart = measured - found.friction(surface, places)
        known = np.isfinite(slopes).all(axis=1) & np.isfinite(apart)
        slopes, apart = slopes[known], apart[known]
        sure = 1.0 / np.hypot(WORTH * measured[known], LEAST)
        weighed = slopes * sure[:, None]
        normal = weighed.T @ weighed + np.diag(SPREAD**-2.0)
        pull = weighed.T @ (apart * sure) - (np.array(found.values) - EXPECTED) / SPREAD**2
        values = np.array(found.values) + np.linalg.solve(normal, pull)
        birge = max(1.0, float(np.sum((apart * sure) ** 2)) / max(known.sum() - 4, 1))
        covariance = birge * np.linalg.inv(normal)
        found = Calibration(tuple(values.tolist()), tuple(map(tuple, covariance.tolist())))
    return found


def places_of(points: Sequence[ComparablePoint]) -> Array:
    """Return rows of |w| [rad/s], opposing load [N] and temperature [K]."""
    rows = [(abs(one.speed), opposed(one), one.temperature) for one in points]
    return np.array(rows, dtype=float).reshape(-1, 3)
