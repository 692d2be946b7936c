# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Pull a surface to a full solve, inside a trust region around its point and nowhere else.

The pull fades over a bump B, 1 at the point and 0 with its slope at the edge of the trust region,
which never leaves the cell of the point, so the surface stays C1. What is stored as a logarithm is
shifted, other positive numbers are scaled, and of a share either it or what it lacks of 1 is
scaled: signs and ranges hold whatever the solve says. Needs neither numpy nor anything else.

"""

from collections.abc import Sequence
from dataclasses import dataclass
import hashlib
import math
from typing import Protocol

from surrogate.files import canonical_json
from surrogate.surface.fields import FIELDS, LOGARITHMIC, SHARES
from surrogate.surface.file import SurfaceError

TRUST_RADIUS = 0.5
"""Half width of the trust region along each axis, over the width of the cell [-]."""
NEAREST = 0.01
"""Least distance of a point from the faces of its cell, over the width of the cell [-]."""
Cell = tuple[int, int, int]
Fractions = tuple[float, float, float]


class HasOperatingPoint(Protocol):
    """Where a full solve was made: an operating point, or anything with these three."""

    @property
    def speed(self) -> float:
        """Screw speed of either sign [rad/s]."""

    @property
    def opposing_load(self) -> float:
        """Load, positive when it opposes the motion [N]."""

    @property
    def temperature(self) -> float:
        """Oil temperature [K]."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Correction:
    """
    One full solve that has pulled a surface.

    Speed [rad/s], opposing load [N], temperature [K]; `solved` holds the fields that were solved,
    SI; `cell` and `fractions` say where that is; `gains` and `shifts` are what the bump adds to a
    transformed value, gain times the value plus shift.

    """

    speed: float
    opposing_load: float
    temperature: float
    solved: dict[str, float]
    cell: Cell
    fractions: Fractions
    gains: tuple[float, ...]
    shifts: tuple[float, ...]


def solved_values(solution: object) -> dict[str, float]:
    """Return the fields that a solution has; raises SurfaceError when nothing was solved."""
    values = {name: float(getattr(solution, name, math.nan)) for name in FIELDS}
    known = {name: value for name, value in values.items() if not math.isnan(value)}
    if not getattr(solution, 'converged', True) or not known:
        status = getattr(solution, 'status', 'it has no numbers')
        raise SurfaceError(f'no correction by a solution that is not converged: {status}')
    for name, value in known.items():
        high = 1.0 if name in SHARES else math.inf
        sound = 0.0 <= value <= high if name in SHARES else 0.0 < value < high
        if not sound:
            allowed = '0 to 1' if name in SHARES else 'finite and above 0'
            raise SurfaceError(f'no correction: {name} is {value:g}, allowed is {allowed}')
    return known


def places_of(cell: Cell, fractions: Fractions, cells: Cell) -> list[tuple[Cell, Fractions]]:
    """
    Return the places of a point in the cells that it corrects, out of `cells` along each axis.

    One cell as a rule. A point on a node of temperature, as the default temperature often is,
    lies on the face of two cells, and both are pulled alike; the pull has no slope there.

    """
    *others, heat = fractions
    if NEAREST <= heat <= 1.0 - NEAREST:
        return [(cell, fractions)]
    lower = cell[2] - 1 if heat < 0.5 else cell[2]
    return [
        ((cell[0], cell[1], k), (others[0], others[1], end))
        for k, end in ((lower, 1.0), (lower + 1, 0.0))
        if 0 <= k < cells[2]
    ]


def make_correction(
    point: HasOperatingPoint,
    cell: Cell,
    fractions: Fractions,
    values: Sequence[float],
    solved: dict[str, float],
) -> Correction:
    """
    Return what pulls the transformed `values` that a surface has at a point to those `solved`.

    Raises SurfaceError for a point so near a face of speed or load that the pull would be a step.

    """
    edge = min(min(fraction, 1.0 - fraction) for fraction in fractions[:2])
    if edge < NEAREST:
        raise SurfaceError(
            f'no correction: the point lies at {100 * edge:.2g} % of the width of its cell from a '
            f'node of the surface, allowed is {100 * NEAREST:g} % or more (cells beyond it must '
            'not change)'
        )
    pulls = [_pull(name, value, solved.get(name)) for name, value in zip(FIELDS, values)]
    return Correction(
        speed=abs(point.speed),
        opposing_load=point.opposing_load,
        temperature=point.temperature,
        solved=solved,
        cell=cell,
        fractions=fractions,
        gains=tuple(gain for gain, _ in pulls),
        shifts=tuple(shift for _, shift in pulls),
    )


def _pull(name: str, value: float, target: float | None) -> tuple[float, float]:
    """Return gain and shift that turn a transformed value into the target."""
    if target is None:
        return 0.0, 0.0
    if name in LOGARITHMIC:
        return 0.0, math.log(target) - value
    if name in SHARES and target >= value and value < 1.0:
        gain = (1.0 - target) / (1.0 - value) - 1.0
        return gain, -gain
    return (target / value - 1.0, 0.0) if value > 0.0 else (0.0, target - value)


def corrected_hash(sha256: str, corrections: Sequence[Correction]) -> str:
    """Return the content hash of a surface of hash `sha256` with these corrections."""
    content = [
        [pull.speed, pull.opposing_load, pull.temperature, pull.solved, TRUST_RADIUS]
        for pull in corrections
    ]
    return hashlib.sha256(canonical_json([sha256, content])).hexdigest()
