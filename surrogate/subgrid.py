# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Waves that a grid is too coarse for, as a higher film floor.

Short waves stand up even where the load presses the surfaces into each other: they hold open a
mean gap, which the dry contact tells. Solved with their oil they move the onset of contact as a
floor would that is higher by `CARRIED` of that gap: part of it is flattened by the film pressure.

"""

from dataclasses import replace
import math

import numpy as np
from surrogate.ehl import Condition, ContactLubricant, Settings, solve_contact
from surrogate.ehl.case import make_case
from surrogate.geometry import Contact
from surrogate.parameters import InputError
from surrogate.roughness import FractalSurface

CARRIED = 0.3
"""Rise of the floor over the mean dry gap, fitted to resolved ensembles (docs/onset.md) [-]."""
NODES_PER_WAVE, LARGEST_GRID = 6, 1025
"""Nodes per shortest wave of a dry solve [-], and most along a side."""
DRY_FLOOR = 1e-9
"""Floor of a dry solve, taken off its gap again [m]."""
INNER = 0.5
"""Part of the semi-axes within which the gap is averaged [-]: the pressure is nearly even."""
ANY_OIL = ContactLubricant(viscosity=0.1, pressure_viscosity=2e-8)
"""Oil of a contact at rest, where none of it is left."""


def without_short_waves(surface: FractalSurface, shortest: float) -> FractalSurface:
    """Return the surface less its waves shorter than `shortest` [m]; plane and scale stay."""
    length = 2 * math.pi / np.hypot(surface.wave_number_x, surface.wave_number_y)
    kept = length > shortest * (1 - 1e-9)
    if not kept.any():
        raise InputError(
            f'shortest wave on the grid is {1e6 * shortest:g} um, allowed is the longest of the '
            f'surface ({1e6 * length.max():g} um) at most'
        )
    names = ('amplitude', 'wave_number_x', 'wave_number_y', 'phase')
    return replace(surface, **{name: getattr(surface, name)[kept] for name in names})


def dry_gap(contact: Contact, load: float, surface: FractalSurface) -> float:
    """Return the mean gap [m] amid the dry contact under a load [N]; NaN if not converged."""
    settings = Settings(film_floor=DRY_FLOOR, error_estimate=False)
    condition = Condition(load=load, entrainment_speed=0.0)
    case = make_case(contact, ANY_OIL, condition, settings, surface.heights)
    inlet, outlet, side = (case.semi_axis_x * edge for edge in case.domain)
    nx, ny = (_nodes(width / surface.shortest_wavelength) for width in (outlet - inlet, 2 * side))
    found = solve_contact(
        contact,
        ANY_OIL,
        condition,
        roughness=surface.heights,
        settings=replace(settings, nx=max(nx, 129), ny=ny),
    )
    if not found.converged:
        return math.nan
    x, y = found.x[:, None] / found.semi_axis_x, found.y[None, :] / found.semi_axis_y
    return float(found.film[x**2 + y**2 < INNER**2].mean()) - DRY_FLOOR


def _nodes(waves: float) -> int:
    return min(2 * math.ceil(NODES_PER_WAVE * waves / 2) + 1, LARGEST_GRID)


def subgrid_floor(
    contact: Contact, load: float, surface: FractalSurface, shortest: float
) -> float:
    """
    Return by how much [m] waves shorter than `shortest` [m] raise the floor under a load [N].

    `CARRIED` times the gap that the whole surface holds open dry, less that of the longer waves.
    Zero when there is no such wave; NaN if a dry contact did not converge.

    """
    if surface.shortest_wavelength > shortest * (1 - 1e-9):
        return 0.0
    kept = without_short_waves(surface, shortest)
    return CARRIED * (dry_gap(contact, load, surface) - dry_gap(contact, load, kept))
