# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Temperatures of a full-tier surface: three that are solved, and nodes of the file between them.

At one mapped speed the product of viscosity and speed is the same at every temperature; what is
left of a temperature is the pressure-viscosity coefficient, a power of the viscosity. So fields at
a mapped speed follow the logarithm of the viscosity closely, and few temperatures are solved.

"""

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import KroghInterpolator
from surrogate.formulas.lubricant import lubricant_state
from surrogate.parameters import Lubricant

Array = NDArray[np.float64]

NARROW = 0.2
"""Change of the logarithm of the viscosity for which one solved temperature is enough [-]."""


def log_viscosity(lubricant: Lubricant, temperature: Array) -> Array:
    """Return the logarithm of the viscosity [Pa s] at temperatures [K]."""
    return np.asarray(np.log(lubricant_state(lubricant, temperature).viscosity))


def solved_temperatures(lubricant: Lubricant, ends: tuple[float, float]) -> Array:
    """
    Return the temperatures [K] to solve at: both ends and one between them; one if they are near.

    That between is the oil's reference where it lies well inside, else that of the mean logarithm
    of the viscosity.

    """
    reference = lubricant.reference_temperature
    cold, between, hot = log_viscosity(lubricant, np.array([ends[0], reference, ends[1]]))
    middle = _at_viscosity(lubricant, ends, 0.5 * (cold + hot))
    if cold - hot < NARROW:
        return np.array([middle])
    if ends[0] < reference < ends[1] and min(cold - between, between - hot) > 0.2 * (cold - hot):
        middle = reference
    return np.array([ends[0], middle, ends[1]])


def file_temperatures(
    lubricant: Lubricant, ends: tuple[float, float], solved: Array, count: int
) -> Array:
    """
    Return about `count` nodes [K] from end to end, even in the logarithm of the viscosity.

    Solved temperatures are among them, unless there is one, which is none.

    """
    if len(solved) == 1:
        return np.array(ends)
    cells = max(1, round((count - 1) / (len(solved) - 1)))
    nodes = [ends[0]]
    for low, high in zip(solved, solved[1:]):
        first, last = log_viscosity(lubricant, np.array([low, high]))
        steps = np.linspace(first, last, cells + 1)[1:-1]
        nodes += [_at_viscosity(lubricant, (low, high), float(step)) for step in steps] + [high]
    return np.array(nodes)


def _at_viscosity(lubricant: Lubricant, ends: tuple[float, float], wanted: float) -> float:
    """Return the temperature [K] between `ends` of the logarithm of a viscosity."""
    fine = np.linspace(*ends, 400)
    return float(np.interp(-wanted, -log_viscosity(lubricant, fine), fine))


def between(x: Array, values: Array, wanted: Array, *, smooth: bool) -> Array:
    """
    Return values over the last axis, known at `x`, at the `wanted` places.

    Smooth ones by the polynomial through all, others by straight lines, which keep shares between
    those of their neighbours.

    """
    if smooth:
        found = KroghInterpolator(x, np.moveaxis(values, -1, 0))(wanted)
        return np.moveaxis(np.asarray(found), 0, -1)
    place = np.clip(np.searchsorted(-x, -wanted, side='right') - 1, 0, max(len(x) - 2, 0))
    if len(x) == 1:
        return np.repeat(values, len(wanted), axis=-1)
    part = np.clip((wanted - x[place]) / (x[place + 1] - x[place]), 0.0, 1.0)
    return np.asarray(values[..., place] * (1 - part) + values[..., place + 1] * part)
