# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
A full solve beside what the surface says of the same point: how far apart, and what follows.

A result may correct a surface only where it is known better than the surface: its own standard
error must not exceed the error that the surface states there, interpolation and law together. That
of the RCS must be known, that of the efficiency never is.

"""

from collections.abc import Iterable
import dataclasses
import math
import types
from typing import Any, Protocol

from ballscrew_monitor.core.conversions import opposing_load
from ballscrew_monitor.core.estimate import MachinePoint
from surrogate.surface import Found, HasOperatingPoint, Surface

NAN = math.nan
JUDGED = ('efficiency', 'rcs')
"""What the zone is judged by, and so what a surface is corrected for."""
MODEL = 'full'
TOLD = ('tier', 'inputs', 'law')
"""What the solver needs to know of a surface."""


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class Comparison:
    """Full solve less surface [-], NaN where either is unknown, and whether that was stated."""

    efficiency: float = NAN
    rcs: float = NAN
    within_stated_error: bool = False


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class SolvedAt:
    """Where a full solve was made: screw speed [rad/s], opposing load [N], temperature [K]."""

    speed: float
    opposing_load: float
    temperature: float


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class KeptSolve(SolvedAt):
    """A full solve that corrects a surface: where it was made, and the fields solved [SI]."""

    solved: dict[str, float]


class Solve(HasOperatingPoint, Protocol):
    """A full solve that has corrected a surface, or did so in an earlier run of the node."""

    @property
    def solved(self) -> dict[str, float]:
        """Return the fields that were solved [SI]."""


def solved_at(point: MachinePoint) -> SolvedAt:
    """Return the place on the surface of a point in the machine frame."""
    return SolvedAt(
        speed=abs(point.speed),
        opposing_load=opposing_load(point.axial_load, point.direction),
        temperature=point.temperature,
    )


def compare(full: Found, surface: Found | None) -> Comparison:
    """Hold a full solve against the surface; None: the surface has no answer."""
    if surface is None:
        return Comparison()
    differences = {name: getattr(full, name) - getattr(surface, name) for name in JUDGED}
    within = all(
        abs(difference) <= stated_error(surface, name) + known(getattr(full, f'{name}_stderr'))
        for name, difference in differences.items()
    )
    return Comparison(**differences, within_stated_error=within)


def stated_error(surface: Found, name: str) -> float:
    """Return the error that a surface states [-]: interpolation, and law where it is known."""
    error: float = getattr(surface, f'{name}_error')
    return error + known(getattr(surface, f'{name}_stderr'))


def objection(full: Found, answer: Found | None, surface: Surface) -> str:
    """Return why a full solve may not correct a surface with this answer; empty if it may."""
    if surface.tier != MODEL:
        return f'a surface of the {surface.tier.replace("_", "-")} tier is not corrected'
    if answer is None:
        return 'the surface has no answer at this point'
    if math.isnan(full.rcs_stderr):
        return 'the standard error of the result (rcs) is not known'
    for name in JUDGED:
        own, stated = known(getattr(full, f'{name}_stderr')), stated_error(answer, name)
        if own > stated:
            return (
                f'the standard error of the result ({name} {own:.2g}) is above the error that '
                f'the surface states there ({stated:.2g})'
            )
    return ''


def corrected(surface: Surface, kept: Iterable[Solve]) -> Surface:
    """Return a surface with the corrections of another of the same content."""
    for one in kept:
        surface = surface.with_correction(one, types.SimpleNamespace(**one.solved))
    return surface


def request_of(surface: Surface, point: MachinePoint) -> dict[str, Any]:
    """Return what is asked of the solver: the surface and the point."""
    header = {name: surface.header[name] for name in TOLD if name in surface.header}
    return {'header': header, 'point': dataclasses.asdict(solved_at(point))}


def known(number: float) -> float:
    """Return a number, 0 for one that is not known."""
    return 0.0 if math.isnan(number) else number
