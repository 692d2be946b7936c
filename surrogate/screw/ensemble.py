# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
What the draw of the roughness leaves uncertain: a point of the screw for many draws.

One draw is not a raceway. The result of a point is the mean over draws, its uncertainty their
standard deviation and, for the mean, the standard error.

"""

from dataclasses import dataclass, replace
import math

import numpy as np
from surrogate.files import InputError
from surrogate.parameters import Lubricant, OperatingPoint, Screw
from surrogate.screw.contacts import ScrewSettings
from surrogate.screw.solve import ScrewSolution, solve_screw

DRAWN_FIELDS = (
    'efficiency',
    'friction_torque',
    'driving_torque',
    'friction_coefficient',
    'rcs',
    'asperity_share',
)
"""Numbers of a screw solution that depend on the draw."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Spread:
    """Mean, standard deviation over draws and standard error of the mean, in the field's unit."""

    mean: float
    deviation: float
    error: float


@dataclass(frozen=True, kw_only=True, slots=True)
class EnsembleSolution:
    """
    One point over draws: the spread of each of `DRAWN_FIELDS`, and what each draw gave.

    Draws that did not converge are left out of the spreads, and counted.

    """

    spreads: dict[str, Spread]
    solutions: tuple[ScrewSolution, ...]
    failed: int


def solve_ensemble(
    screw: Screw,
    lubricant: Lubricant,
    point: OperatingPoint,
    draws: int,
    *,
    settings: ScrewSettings | None = None,
) -> EnsembleSolution:
    """
    Solve a point for `draws` draws, the first that of the settings.

    Raises InputError below 1, and for settings of smooth raceways, which have no draw.

    """
    if draws < 1:
        raise InputError(f'draws is {draws}, allowed is 1 or more')
    settings = settings or ScrewSettings()
    if settings.draw is None:
        raise InputError('draw is None, allowed is a number: smooth raceways have no draws')
    solutions = tuple(
        solve_screw(screw, lubricant, point, settings=replace(settings, draw=draw))
        for draw in range(settings.draw, settings.draw + draws)
    )
    solved = [found for found in solutions if found.converged]
    return EnsembleSolution(
        spreads={
            name: spread([getattr(found, name) for found in solved]) for name in DRAWN_FIELDS
        },
        solutions=solutions,
        failed=len(solutions) - len(solved),
    )


def spread(values: list[float]) -> Spread:
    """Return mean, deviation and error of values of one unit; NaN where too few are known."""
    if not values:
        return Spread(mean=math.nan, deviation=math.nan, error=math.nan)
    deviation = float(np.std(values, ddof=1)) if len(values) > 1 else math.nan
    return Spread(
        mean=float(np.mean(values)), deviation=deviation, error=deviation / math.sqrt(len(values))
    )
