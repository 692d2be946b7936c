# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
The nearest speed at which the warning of a point would clear, where the process leaves it free.

No load is ever advised: the process sets it, and more of it costs life with its third power. To be
just optimal is not enough: the advised speed keeps the hysteresis, or whoever follows the advice
would be warned for ever. The surface is scanned along the speed with load and temperature kept,
and the border of the nearest good stretch is bisected. A stretch narrower than the scan can be
missed. This takes some hundred lookups, so it is done once for an event, and only when the advice
is asked for: the state that raises the warning is not to wait for it. The scan is in the subset of
Python that also compiles.

"""

from collections.abc import Callable
import math
from typing import Any, NamedTuple

from ballscrew_monitor.core.conversions import Direction, opposing_load, rounded, signed
from ballscrew_monitor.core.judgement import efficiency_to_clear, Limits, rcs_to_clear
from surrogate.surface import Found, look_up, Surface, Validity
from surrogate.units import RPM

SCAN_POINTS = 64
HALVINGS = 20
NAN = math.nan
VALID = int(Validity.VALID)


def speed_advice(target_speed: float) -> str:
    """Return in words to run at a speed [rad/s], by its amount; empty if it is NaN."""
    if not math.isfinite(target_speed):
        return ''
    return f'at this load run at {rounded(abs(target_speed) / RPM)} rev/min'


class Criterion(NamedTuple):
    """
    When a speed [rad/s] is good: its RCS is below, its efficiency at least a number [-].

    The load [N] opposes the motion; temperature [K]. The efficiency is left out under `light_load`
    [N].

    """

    load: float
    temperature: float
    rcs: float
    efficiency: float
    light_load: float


Nearest = Callable[[Surface, Criterion, float, list[float]], float]
"""Return of `nearest` on a surface, with a criterion, from a speed, by the ascending `speeds`."""


def interpreted(surface: Surface, criterion: Criterion, here: float, speeds: list[float]) -> float:
    """Return the good speed nearest to `here` by scan and bisection; NaN if there is none."""
    return nearest(surface.tables, criterion, here, speeds, [Found()])


def advised_speed(
    surface: Surface,
    limits: Limits,
    *,
    speed: float,
    axial_load: float,
    temperature: float,
    direction: Direction,
    nearest: Nearest = interpreted,
) -> float:
    """
    Return the nearest speed [rad/s] that clears at the point of an event, NaN for none.

    Speed [rad/s], axial load [N], temperature [K], machine frame. The process must leave the axis
    free in its speed.

    """
    slowest, fastest = surface.speed_range
    slowest = max(slowest, limits.standstill_speed)
    if not slowest < fastest:
        return NAN
    ratio = fastest / slowest
    grid = (slowest * ratio ** (i / (SCAN_POINTS - 1)) for i in range(SCAN_POINTS))
    speeds = [min(speed, fastest) for speed in grid]
    criterion = Criterion(
        load=float(opposing_load(axial_load, direction)),
        temperature=float(temperature),
        rcs=float(rcs_to_clear(limits)),
        efficiency=float(efficiency_to_clear(limits)),
        light_load=float(limits.light_load),
    )
    return signed(nearest(surface, criterion, abs(speed), speeds), direction)


def nearest(tables: Any, criterion: Criterion, here: float, speeds: Any, room: Any) -> float:
    """Return what `Nearest` does, on `tables`; `room` holds one record of `Found`."""
    answer = room[0]
    if _is_good(tables, criterion, here, answer):
        return here
    below = _first(tables, criterion, here, speeds, -1, answer)
    above = _first(tables, criterion, here, speeds, 1, answer)
    if math.isnan(below) or abs(above - here) < abs(below - here):
        return above
    return below


def _first(
    tables: Any, criterion: Criterion, here: float, speeds: Any, step: int, answer: Any
) -> float:
    """Return the good end of the first border beyond `here`, which is not good; NaN for none."""
    bad = here
    for count in range(len(speeds)):
        good = speeds[count] if step > 0 else speeds[len(speeds) - 1 - count]
        if not (good - here) * step > 0.0:
            continue
        if _is_good(tables, criterion, good, answer):
            for _ in range(HALVINGS):
                middle = 0.5 * (bad + good)
                if _is_good(tables, criterion, middle, answer):
                    good = middle
                else:
                    bad = middle
            return float(good)
        bad = good
    return NAN


def _is_good(tables: Any, criterion: Criterion, speed: float, answer: Any) -> bool:
    """Return True if the warning clears at a speed."""
    if look_up(tables, speed, criterion.load, criterion.temperature, answer) != VALID:
        return False
    if math.isnan(answer.rcs + answer.efficiency):
        return False
    light = abs(criterion.load) < criterion.light_load
    fit = light or answer.efficiency >= criterion.efficiency
    return bool(answer.rcs < criterion.rcs and fit)
