# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
The nearest speed and load at which the warning of a point would clear.

To be just optimal is not enough: the advised point keeps the hysteresis, or whoever follows the
advice would be warned for ever. The surface is scanned along one axis at a time with the other
two quantities kept, and the border of the nearest good stretch is bisected. A stretch narrower
than the scan can be missed. This takes a few hundred lookups, so it is done once for an event, and
only when the advice is asked for: the state that raises the warning is not to wait for it.

"""

from collections.abc import Callable, Iterable
import dataclasses
import functools
import math

from ballscrew_monitor.core.conversions import axial_load, opposing_load, signed_speed
from ballscrew_monitor.core.estimate import MachinePoint
from ballscrew_monitor.core.judgement import clears, Limits
from surrogate.surface import Surface, Validity
from surrogate.units import RPM

SCAN_POINTS = 64
HALVINGS = 20
NAN = math.nan


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class Advice:
    """Nearest good speed [rad/s] and load [N], machine frame, NaN if there is none."""

    target_speed: float = NAN
    target_load: float = NAN

    @property
    def text(self) -> str:
        """Return the advice as a sentence, empty if there is none."""
        parts = []
        if math.isfinite(self.target_speed):
            turns = self.target_speed / RPM
            parts.append(
                f'at this load run at {self.target_speed:.4g} rad/s ({turns:.0f} rev/min)'
            )
        if math.isfinite(self.target_load):
            parts.append(f'at this speed load with {self.target_load:.4g} N')
        return ' or '.join(parts)


@dataclasses.dataclass(frozen=True, kw_only=True)
class Advisor:
    """What an event was raised by, and the advice on it, worked out when first asked for."""

    point: MachinePoint
    surface: Surface
    limits: Limits

    @functools.cached_property
    def advice(self) -> Advice:
        """Return the nearest speed and load that clear."""
        return advise(self.point, self.surface, self.limits)


def advise(point: MachinePoint, surface: Surface, limits: Limits) -> Advice:
    """Return the nearest speed and load that clear at `point`, its direction kept."""
    return Advice(
        target_speed=optimal_speed(point, surface, limits),
        target_load=optimal_load(point, surface, limits),
    )


def optimal_speed(point: MachinePoint, surface: Surface, limits: Limits) -> float:
    """Return the nearest screw speed [rad/s] that clears at this load; NaN if there is none."""
    slowest, fastest = surface.speed_range
    slowest = max(slowest, limits.standstill_speed)
    if not slowest < fastest:
        return NAN
    ratio = fastest / slowest
    grid = (slowest * ratio ** (i / (SCAN_POINTS - 1)) for i in range(SCAN_POINTS))

    light = _light(point.axial_load, limits)
    load = opposing_load(point.axial_load, point.direction)

    def good(speed: float) -> bool:
        return _good(speed, load, point.temperature, surface, limits, light=light)

    return signed_speed(
        _nearest(abs(point.speed), (min(s, fastest) for s in grid), good), point.direction
    )


def optimal_load(point: MachinePoint, surface: Surface, limits: Limits) -> float:
    """
    Return the nearest axial load [N] that clears at this speed; NaN if there is none.

    A load under the light limit is advised only where the load is that light already: to
    leave the efficiency unjudged is no improvement.

    """
    low, high = surface.load_range
    was_light = _light(point.axial_load, limits)
    grid = (low + (high - low) * i / (SCAN_POINTS - 1) for i in range(SCAN_POINTS))
    speed = abs(point.speed)

    def good(load: float) -> bool:
        light = was_light and _light(load, limits)
        return _good(speed, load, point.temperature, surface, limits, light=light)

    here = opposing_load(point.axial_load, point.direction)
    return axial_load(_nearest(here, grid, good), point.direction)


def _light(load: float, limits: Limits) -> bool:
    return abs(load) < limits.light_load


def _good(
    speed: float, load: float, temperature: float, surface: Surface, limits: Limits, *, light: bool
) -> bool:
    """Tell whether the warning clears at a speed [rad/s] and an opposing load [N]."""
    numbers = surface.lookup(speed, load, temperature)
    if numbers.validity != Validity.VALID or math.isnan(numbers.rcs + numbers.efficiency):
        return False
    return clears(numbers, limits, light=light)


def _nearest(here: float, grid: Iterable[float], is_good: Callable[[float], bool]) -> float:
    """Return the good place nearest to `here` by scan and bisection; NaN if there is none."""
    if is_good(here):
        return here
    places = sorted(grid)
    below = [here] + [place for place in reversed(places) if place < here]
    above = [here] + [place for place in places if place > here]
    found = [
        place for place in (_first(below, is_good), _first(above, is_good)) if place is not None
    ]
    return min(found, key=lambda place: abs(place - here), default=NAN)


def _first(places: list[float], is_good: Callable[[float], bool]) -> float | None:
    """Return the good end of the first border along `places`, the first of which is not."""
    for bad, good in zip(places, places[1:]):
        if is_good(good):
            for _ in range(HALVINGS):
                middle = 0.5 * (bad + good)
                bad, good = (bad, middle) if is_good(middle) else (middle, good)
            return good
    return None
