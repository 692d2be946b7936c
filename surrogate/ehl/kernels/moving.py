# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Discrete Reynolds equation of a film whose roughness travels with it, compiled.

Wedge and squeeze are one derivative along the material column, u d(rho h)/dx + d(rho h)/dt. In a
step the columns move on by whole nodes, so that what arrives is known and the derivative is local:
nothing is smeared where the oil is too stiff to flow. Units and planes as in `reynolds`.

"""

import math

import numpy as np
from numpy.typing import NDArray
from surrogate.compiler import njit
from surrogate.ehl.kernels.reynolds import face_flow, limited_change

Array = NDArray[np.float64]
SMALL_SHEAR, LARGEST_SHEAR = 1e-3, 20.0
"""Shear stress over Eyring's below which oil is Newtonian, and up to which it thins [-]."""


@njit(cache=True, error_model='numpy')
def column_rows(
    film: Array,
    mass_before: Array,
    carried_before: Array,
    stride: int,
    carried: Array,
    residual: Array,
    by_pressure: Array,
    by_gap: Array,
) -> None:
    """
    Add D(rho h)/Dt dx/u along the material columns and its planes, in Hertz units [-].

    With G = m + (m - m_before)/2 and m = rho h it is (G - G_before)/`stride`: the backward
    difference of order 2 in the time of a step that moves the columns by so many nodes. At rest
    that is the upstream wedge of order 2. Its change is limited as there: in an inlet that the
    nodes hardly resolve, m falls by more than itself in a step. `mass_before`, `carried_before`
    are m and G of the step before, where the columns have come to; `carried` takes G. The first
    rows, where columns from outside the grid arrive, are of order 1.

    """
    nx, ny = carried.shape
    step = 1.0 / stride
    for i in range(nx):
        share = 0.5 if i > stride else 0.0
        for j in range(ny):
            here = film[0, i, j] * film[2, i, j]
            drop, in_here, _ = limited_change(here, mass_before[i, j])
            by_here = step * (1.0 - share * in_here)
            carried[i, j] = here - share * drop
            residual[i, j] += step * (carried[i, j] - carried_before[i, j])
            by_pressure[0, i, j] += by_here * film[1, i, j] * film[2, i, j]
            by_gap[0, i, j] += by_here * film[0, i, j] * film[6, i, j]


@njit(cache=True, error_model='numpy')
def thin_by_shear(pressure: Array, film: Array, along: float, across: float) -> None:
    """
    Let the pressure gradient thin the oil by its own shear, in planes 3 and 5 of a film [-].

    The flow of an Eyring fluid between plates is that of Newton's times sinh(S)/S for small S,
    S = (h/2) |grad p|/tau0, which `along` and `across` times h and a difference over two nodes
    make up. The factor has no derivative here.

    """
    nx, ny = pressure.shape
    for i in range(1, nx - 1):
        for j in range(1, ny - 1):
            slope_x = along * (pressure[i + 1, j] - pressure[i - 1, j])
            slope_y = across * (pressure[i, j + 1] - pressure[i, j - 1])
            shear = min(film[2, i, j] * math.hypot(slope_x, slope_y), LARGEST_SHEAR)
            if shear > SMALL_SHEAR:
                thinner = math.sinh(shear) / shear
                film[5, i, j] *= thinner
                film[3, i, j] -= math.log(thinner)


@njit(cache=True, error_model='numpy')
def dissipated(
    pressure: Array,
    film: Array,
    mobility: float,
    aspect: float,
    limited: bool,
    inlet: Array,
    periodic: bool,
) -> float:
    """Return the sum over all faces of the flux per density times the rise of pressure [-]."""
    nx, ny = pressure.shape
    first = 1 if periodic else 0
    total = 0.0
    for i in range(nx - 1):
        for j in range(1, ny - 1):
            before = pressure[i, j] if i > 0 else inlet[j] * pressure[1, j]
            rise = pressure[i + 1, j] - before
            flow = face_flow(film, i, j, i + 1, j, rise > 0.0, limited)[0]
            total += 2.0 * mobility * flow * rise * rise / (film[0, i, j] + film[0, i + 1, j])
        if i > 0:
            for j in range(first, ny - 1):
                rise = pressure[i, j + 1] - pressure[i, j]
                flow = face_flow(film, i, j, i, j + 1, limited, limited)[0]
                dense = 0.5 * (film[0, i, j] + film[0, i, j + 1])
                total += mobility * aspect * flow * rise * rise / dense
    return total
