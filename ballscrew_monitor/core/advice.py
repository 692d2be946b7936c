# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
The nearest speed and load at which the warning of a point would clear.

To be just optimal is not enough: the advised point keeps the hysteresis, or whoever follows the
advice would be warned for ever. The surface is scanned along one axis at a time with the other
two quantities kept, and the border of the nearest good stretch is bisected. A stretch narrower
than the scan can be missed. This takes a few hundred lookups, so it is done once for an event, and
only when the advice is asked for: the state that raises the warning is not to wait for it. The
scan is in the subset of Python that also compiles.

"""

from collections.abc import Callable
import dataclasses
import functools
import math
from typing import Any, NamedTuple

from ballscrew_monitor.core.conversions import opposing_load, rounded, signed
from ballscrew_monitor.core.estimate import MachinePoint, opposing_load_of
from ballscrew_monitor.core.judgement import efficiency_to_clear, Limits, rcs_to_clear
from surrogate.surface import Found, look_up, Surface, Validity
from surrogate.units import RPM

SCAN_POINTS = 64
HALVINGS = 20
NAN = math.nan
VALID = int(Validity.VALID)
SURELY, PERHAPS = 'surely', 'perhaps'
"""How sure it is that asperities carry."""


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class Advice:
    """
    Nearest good speed [rad/s] and load [N], machine frame, NaN if there is none.

    Whether asperities `carry` surely or perhaps, empty where they do not or that is not known.

    """

    target_speed: float = NAN
    target_load: float = NAN
    carry: str = ''

    @property
    def text(self) -> str:
        """Return the advice as a sentence, empty if there is none."""
        parts = []
        if math.isfinite(self.target_speed):
            parts.append(f'at this load run at {rounded(self.target_speed / RPM)} rev/min')
        if math.isfinite(self.target_load):
            parts.append(f'at this speed load with {self.target_load:.4g} N')
        doubt = f'; asperities {self.carry} carry here' if parts and self.carry else ''
        return ' or '.join(parts) + doubt


class Criterion(NamedTuple):
    """
    When a place along one axis is good: its RCS is below, its efficiency at least a number [-].

    Places are speeds [rad/s] at the load `other` [N] if `along_speed`, else loads at that speed;
    temperature [K]. The efficiency is left out under `light_load` [N].

    """

    along_speed: bool
    other: float
    temperature: float
    rcs: float
    efficiency: float
    light_load: float


Nearest = Callable[[Surface, Criterion, float, list[float]], float]
"""Return of `nearest` on a surface, with a criterion, from a place, by the ascending `places`."""


def interpreted(surface: Surface, criterion: Criterion, here: float, places: list[float]) -> float:
    """Return the good place nearest to `here` by scan and bisection; NaN if there is none."""
    return nearest(surface.tables, criterion, here, places, [Found()])


@dataclasses.dataclass(frozen=True, kw_only=True)
class Advisor:
    """What an event was raised by, and the advice on it, worked out when first asked for."""

    point: MachinePoint
    surface: Surface
    limits: Limits
    nearest: Nearest = dataclasses.field(default=interpreted, compare=False, repr=False)

    @functools.cached_property
    def advice(self) -> Advice:
        """Return the nearest speed and load that clear at the point, its direction kept."""
        speed, load = self._speed(), self._load()
        return Advice(target_speed=speed, target_load=load, carry=self._carry())

    def _carry(self) -> str:
        """Say whether RCS passes its limit wherever in both bands of the surface that may lie."""
        surface, point = self.surface, self.point
        least = min(*surface.limit_band, *surface.numerical_band)
        place = opposing_load_of(point), point.temperature
        here = surface.lookup(abs(point.speed), *place).rcs
        if math.isnan(least) or not here >= self.limits.rcs:
            return ''
        sure = surface.lookup(abs(point.speed) / least, *place).rcs >= self.limits.rcs
        return SURELY if sure else PERHAPS

    def _speed(self) -> float:
        """Return the nearest screw speed [rad/s] that clears at this load; NaN for none."""
        point = self.point
        slowest, fastest = self.surface.speed_range
        slowest = max(slowest, self.limits.standstill_speed)
        if not slowest < fastest:
            return NAN
        ratio = fastest / slowest
        grid = (slowest * ratio ** (i / (SCAN_POINTS - 1)) for i in range(SCAN_POINTS))
        places = [min(speed, fastest) for speed in grid]
        criterion = self._criterion(opposing_load_of(point), along_speed=True)
        found = self.nearest(self.surface, criterion, abs(point.speed), places)
        return signed(found, point.direction)

    def _load(self) -> float:
        """
        Return the nearest axial load [N] that clears at this speed; NaN if there is none.

        A load under the light limit is advised only where the load is that light already: to
        leave the efficiency unjudged is no improvement.

        """
        point = self.point
        low, high = self.surface.load_range
        places = [low + (high - low) * i / (SCAN_POINTS - 1) for i in range(SCAN_POINTS)]
        criterion = self._criterion(abs(point.speed), along_speed=False)
        if not abs(point.axial_load) < self.limits.light_load:
            criterion = criterion._replace(light_load=0.0)
        found = self.nearest(self.surface, criterion, opposing_load_of(point), places)
        return opposing_load(found, point.direction)  # its own inverse

    def _criterion(self, other: float, *, along_speed: bool) -> Criterion:
        return Criterion(
            along_speed=along_speed,
            other=float(other),
            temperature=float(self.point.temperature),
            rcs=float(rcs_to_clear(self.limits)),
            efficiency=float(efficiency_to_clear(self.limits)),
            light_load=float(self.limits.light_load),
        )


def nearest(tables: Any, criterion: Criterion, here: float, places: Any, room: Any) -> float:
    """Return what `Nearest` does, on `tables`; `room` holds one record of `Found`."""
    found = room[0]
    if _is_good(tables, criterion, here, found):
        return here
    below = _first(tables, criterion, here, places, -1, found)
    above = _first(tables, criterion, here, places, 1, found)
    if math.isnan(below) or abs(above - here) < abs(below - here):
        return above
    return below


def _first(
    tables: Any, criterion: Criterion, here: float, places: Any, step: int, found: Any
) -> float:
    """Return the good end of the first border beyond `here`, which is not good; NaN for none."""
    bad = here
    for count in range(len(places)):
        good = places[count] if step > 0 else places[len(places) - 1 - count]
        if not (good - here) * step > 0.0:
            continue
        if _is_good(tables, criterion, good, found):
            for _ in range(HALVINGS):
                middle = 0.5 * (bad + good)
                if _is_good(tables, criterion, middle, found):
                    good = middle
                else:
                    bad = middle
            return float(good)
        bad = good
    return NAN


def _is_good(tables: Any, criterion: Criterion, place: float, found: Any) -> bool:
    """Tell whether the warning clears at a place."""
    speed, load = place, criterion.other
    if not criterion.along_speed:
        speed, load = load, speed
    if look_up(tables, speed, load, criterion.temperature, found) != VALID:
        return False
    if math.isnan(found.rcs + found.efficiency):
        return False
    light = abs(load) < criterion.light_load
    fit = light or found.efficiency >= criterion.efficiency
    return bool(found.rcs < criterion.rcs and fit)
