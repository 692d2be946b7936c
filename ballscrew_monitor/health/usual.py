# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Usual warnings of an axis: those of a kind, speed and load that its baseline already had.

A place is a band of speed, a band of load and a direction. In its baseline the axis moved steadily
at a place; where the surface says that this motion breaks a limit, a warning for the same reason
at this place is usual.

"""

from collections.abc import Sequence
import math

from ballscrew_monitor.core.judgement import Code, Limits
from ballscrew_monitor.health.bands import load_band, speed_band
from ballscrew_monitor.health.lubrication import looked_up, opposed
from ballscrew_monitor.health.records import Baseline, Cell, Health, UsualWarning
from surrogate.surface import Surface, Validity


def usual_warnings(
    points: Sequence[Cell], baseline: Baseline | None, surface: Surface, limits: Limits
) -> tuple[UsualWarning, ...]:
    """Return the warnings that the motion of a baseline would give; none without a baseline."""
    if baseline is None:
        return ()
    known = {
        UsualWarning(code, cell.speed_band, cell.load_band, cell.direction)
        for cell in points
        if baseline.begin <= cell.start < baseline.end
        for code in _broken(cell, surface, limits)
    }
    return tuple(sorted(known))


def _broken(cell: Cell, surface: Surface, limits: Limits) -> list[Code]:
    point = looked_up(surface, cell)
    if point.validity is not Validity.VALID:
        return []
    codes = [Code.RCS_HIGH] if point.rcs >= limits.rcs else []
    if abs(opposed(cell)) >= limits.light_load and point.efficiency < limits.efficiency:
        codes.append(Code.EFFICIENCY_LOW)
    return codes


def is_usual(health: Health, code: Code, *, speed: float, axial_load: float) -> bool:
    """Return True if a baseline already had a warning, by speed [rad/s] and axial load [N]."""
    return warning_at(code, speed=speed, axial_load=axial_load) in health.usual_warnings


def warning_at(code: Code, *, speed: float, axial_load: float) -> UsualWarning | None:
    """Return kind and place of a warning at a speed [rad/s] and a load [N]; None: not known."""
    if not speed or not math.isfinite(speed + axial_load):
        return None
    way = 1 if speed > 0.0 else -1
    return UsualWarning(code, speed_band(abs(speed)), load_band(axial_load), way)
