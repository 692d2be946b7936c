# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
A full solve beside what the surface says of the same point: how far apart, and what follows.

A result may correct a surface only where it is known better than the surface: its own standard
error must not exceed the error that the surface states there, interpolation and law together. That
of the RCS must be known, that of the efficiency never is. Where an axis dwells and the surface
cannot tell inside from outside is a place for a full solve. Time is an argument [ns], the stamps
of the states.

"""

from collections.abc import Iterable
import dataclasses
import math
import types
from typing import Any

from ballscrew_monitor.core.conversions import SECOND
from ballscrew_monitor.core.judgement import Limits, PointValidity
from ballscrew_monitor.judge.point import opposing_load, set_answer, set_words
from ballscrew_monitor.judge.records import LIGHT_LOAD, Row, Settings, STANDSTILL
from surrogate.surface import Correction, Found, look_up_rest, Surface

NAN = math.nan
JUDGED = ('efficiency', 'rcs')
"""What the zone is judged by, and so what a surface is corrected for."""
TOLD = ('tier', 'inputs')
"""What the solver needs to know of a surface."""
STAY = 30 * SECOND
"""Shortest stay that counts as dwelling [ns]."""
PAUSE = 600 * SECOND
"""Shortest time between two solves of one axis [ns]."""
SAME = 0.02
"""Largest change of speed and load, over their amounts, that counts as staying [-]."""


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


Solve = Correction | KeptSolve
"""A full solve that has corrected a surface, or did so in an earlier run of the node."""


def answer(row: Row, surface: Surface, *, rcs_limit: float) -> Row:
    """Return what a surface says of the point of a row; the limit [-] names the contact state."""
    answered = dataclasses.replace(row)
    set_answer(surface.tables, Settings(rcs=rcs_limit), answered)
    look_up_rest(surface.tables, opposing_load(answered), answered)
    return answered


def with_numbers(row: Row, full: Found, *, rcs_limit: float) -> Row:
    """Return a row of the same point with the numbers of a full solve."""
    numbers = {field.name: getattr(full, field.name) for field in dataclasses.fields(Found)}
    solved = dataclasses.replace(row, **numbers)
    set_words(Settings(rcs=rcs_limit), solved)
    return solved


def solved_at(row: Row) -> SolvedAt:
    """Return the place on the surface of the point of a row."""
    return SolvedAt(
        speed=abs(row.speed), opposing_load=opposing_load(row), temperature=row.temperature
    )


def compare(full: Found, surface: Found) -> tuple[dict[str, float], bool]:
    """
    Hold a full solve against the answer of the surface.

    Returns full solve less surface [-], NaN where either is unknown, and whether both are within
    what is stated.

    """
    if surface.validity != PointValidity.VALID:
        return dict.fromkeys(JUDGED, NAN), False
    differences = {name: getattr(full, name) - getattr(surface, name) for name in JUDGED}
    within = all(
        abs(difference) <= stated_error(surface, name) + known(getattr(full, f'{name}_stderr'))
        for name, difference in differences.items()
    )
    return differences, within


def stated_error(surface: Found, name: str) -> float:
    """Return the error that a surface states [-]: interpolation, and law where it is known."""
    error: float = getattr(surface, f'{name}_error')
    return error + known(getattr(surface, f'{name}_stderr'))


def objection(full: Found, answer: Found, surface: Surface) -> str:
    """Return why a full solve may not correct a surface with this answer; empty if it may."""
    if surface.tier != 'full':
        return f'a surface of the {surface.tier.replace("_", "-")} tier is not corrected'
    if answer.validity != PointValidity.VALID:
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
    for solve in kept:
        surface = surface.with_correction(solve, types.SimpleNamespace(**solve.solved))
    return surface


def request_of(surface: Surface, row: Row) -> dict[str, Any]:
    """Return what is asked of the solver: the surface and the point of a row."""
    header = {name: surface.header[name] for name in TOLD if name in surface.header}
    return {'header': header, 'point': dataclasses.asdict(solved_at(row))}


def known(number: float) -> float:
    """Return a number, 0 for one that is not known."""
    return 0.0 if math.isnan(number) else number


class Dwell:
    """Tells when a solve is worth its time."""

    def __init__(self) -> None:
        self._since, self._place = 0, (math.nan, math.nan)  # speed [rad/s], axial load [N]
        self._asked: int | None = None

    def update(self, row: Row, limits: Limits) -> bool:
        """Take a row; return True if its point should be solved."""
        stamp, place = row.stamp, (row.speed, row.axial_load)
        if stamp < self._since or not _is_near(place, self._place):
            self._since, self._place = stamp, place
        rested = self._asked is None or not 0 <= stamp - self._asked < PAUSE
        due = rested and stamp - self._since >= STAY and is_uncertain(row, limits)
        if due:
            self._asked = stamp
        return due


def is_uncertain(row: Row, limits: Limits) -> bool:
    """Return True if the stated error of the surface, or its spread, reaches a limit."""
    if row.validity != PointValidity.VALID or row.corrected or row.gates & STANDSTILL:
        return False
    return any(
        abs(getattr(row, name) - getattr(limits, name))
        <= max(stated_error(row, name), known(getattr(row, f'{name}_std')))
        for name in (JUDGED[1:] if row.gates & LIGHT_LOAD else JUDGED)
    )


def _is_near(place: tuple[float, float], other: tuple[float, float]) -> bool:
    return all(abs(here - there) <= SAME * abs(there) for here, there in zip(place, other))
