# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
One system on one grid: Reynolds' equation, contact and load, with all their derivatives.

Film: Reynolds' equation for pf with the film max(h, floor) everywhere; pf >= 0, F >= 0, pf F = 0.
Contact: pa >= 0, h >= floor, pa (h - floor) = 0. Load: the integral of pf + pa. Speed zero leaves
the film out.

"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from surrogate.ehl.grid import Grid, GridState
from surrogate.ehl.half_space import deform, repeat
from surrogate.ehl.kernels.moving import column_rows, thin_by_shear
from surrogate.ehl.kernels.reynolds import (
    clear_border,
    contact_set,
    film_properties,
    flow_rows,
    free_boundary_rows,
    reynolds_rows,
)

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]


@dataclass(frozen=True, kw_only=True, slots=True)
class Columns:
    """
    What the material columns bring to the nodes that they have reached, in Hertz units [-].

    rho h and the mass carried of the step before, and by how many nodes a step moves them; shear
    stress at the wall under a unit gradient of pressure and film, over Eyring's, 0 for an oil
    that shear does not thin.

    """

    mass: Array
    carried: Array
    stride: int
    shear: float = 0.0


@dataclass(frozen=True, kw_only=True, slots=True)
class GridProblem:
    """
    Equations on one grid, in Hertz units [-].

    Heights of the undeformed gap, film floor, load, pressed width along y; dry or not; mobility
    (flow factor over rho h^3/eta, times dx), the numbers of the fluid laws, order of the wedge (1
    to 2), logarithm of the viscosity over which a limited wedge fades to order 1, 0 where wedge
    and flow factors are not limited, pressure just outside the inlet over that inside per column;
    what moving columns bring, None where nothing moves.

    """

    heights: Array
    floor: float
    load: float
    width: float
    dry: bool
    mobility: float
    pressure_scale: float
    growth: float
    exponent: float
    density_gain: float
    order: float
    fading: float
    inlet: Array
    columns: Columns | None = None


@dataclass(slots=True)
class Evaluation:
    """Gap, sets, residual and its planes at a state, and how far it is from a solution [-]."""

    gap: Array
    contact: Mask
    cavitated: Mask
    residual: Array
    by_pressure: Array
    by_gap: Array
    sizes: Array
    flux_error: float
    load_rest: float
    gap_error: float


def evaluate(grid: Grid, problem: GridProblem, state: GridState) -> Evaluation:
    """Evaluate all equations at a state."""
    shape = grid.shape
    pressure = state.film_pressure
    gap = np.empty(shape)
    deform(grid.space, pressure + state.asperity_pressure, gap)
    gap += problem.heights + state.approach
    contact, cavitated = np.zeros(shape, bool), np.zeros(shape, bool)
    count = contact_set(
        state.asperity_pressure, gap, problem.floor, grid.stiffness, grid.symmetric, contact
    )
    if grid.periodic:
        repeat(contact)
    residual, by_pressure, by_gap, heights = film_rows(grid, problem, pressure, gap, contact)
    sizes = np.zeros(shape)
    flux = free_boundary_rows(
        pressure,
        heights,
        problem.dry,
        grid.stiffness,
        grid.weights / (grid.dx * grid.dy),
        residual,
        by_pressure,
        by_gap,
        cavitated,
        sizes,
    )
    # A node that is about to leave contact may still be drawn there, below the floor.
    loose = np.where(contact, 0.0, state.asperity_pressure)
    gap_error = float(np.abs(loose).max() * grid.stiffness)
    if count:
        gap_error = max(gap_error, float(np.abs(gap[contact] - problem.floor).max()))
    return Evaluation(
        gap=gap,
        contact=contact,
        cavitated=cavitated,
        residual=residual,
        by_pressure=by_pressure,
        by_gap=by_gap,
        sizes=sizes,
        flux_error=flux * grid.dy / problem.width,
        load_rest=problem.load - grid.integral(pressure + state.asperity_pressure),
        gap_error=gap_error / problem.floor,
    )


def film_rows(
    grid: Grid, problem: GridProblem, pressure: Array, gap: Array, contact: Mask
) -> tuple[Array, Array, Array, Array]:
    """Return Reynolds' residual, its planes by pressure and by gap, and the film [-]."""
    residual, by_pressure, by_gap = _no_rows(grid)
    if problem.dry:
        return residual, by_pressure, by_gap, np.empty(grid.shape)
    film = film_planes(problem, pressure, gap, contact)
    if problem.columns is not None:
        thin_film(grid, problem.columns, pressure, film)
        _moving_rows(grid, problem, problem.columns, pressure, film, residual, by_pressure, by_gap)
    else:
        reynolds_rows(
            pressure,
            film,
            problem.mobility,
            grid.aspect,
            problem.order,
            problem.fading,
            problem.inlet,
            residual,
            by_pressure,
            by_gap,
        )
    return residual, by_pressure, by_gap, film[2]


def thin_film(grid: Grid, columns: Columns, pressure: Array, film: Array) -> None:
    """Thin the oil of a film by shear, where it does that [-]."""
    if columns.shear:
        along, across = 0.5 * columns.shear / grid.dx, 0.5 * columns.shear / grid.dy
        thin_by_shear(pressure, film, along, across)


def _no_rows(grid: Grid) -> tuple[Array, Array, Array]:
    return np.zeros(grid.shape), np.zeros((6, *grid.shape)), np.zeros((6, *grid.shape))


def film_planes(problem: GridProblem, pressure: Array, gap: Array, contact: Mask) -> Array:
    """Return the planes of `film_properties` [-]."""
    film = np.empty((7, *gap.shape))
    film_properties(
        pressure,
        gap,
        contact,
        problem.floor,
        problem.pressure_scale,
        problem.growth,
        problem.exponent,
        problem.density_gain,
        film,
    )
    return film


def _moving_rows(
    grid: Grid,
    problem: GridProblem,
    columns: Columns,
    pressure: Array,
    film: Array,
    residual: Array,
    by_pressure: Array,
    by_gap: Array,
) -> Array:
    """Assemble Reynolds' equation of moving columns; return the mass that they carry on [-]."""
    carried = np.empty(grid.shape)
    column_rows(
        film, columns.mass, columns.carried, columns.stride, carried, residual, by_pressure, by_gap
    )
    flow_rows(
        pressure,
        film,
        problem.mobility,
        grid.aspect,
        problem.fading > 0.0,
        problem.inlet,
        residual,
        by_pressure,
        by_gap,
    )
    clear_border(residual, by_pressure, by_gap)
    return carried


def carried_on(
    grid: Grid, problem: GridProblem, pressure: Array, gap: Array, contact: Mask
) -> tuple[Array, Array]:
    """Return rho h and the mass carried at the end of a step, where the next one starts [-]."""
    film = film_planes(problem, pressure, gap, contact)
    assert problem.columns is not None
    carried = _moving_rows(grid, problem, problem.columns, pressure, film, *_no_rows(grid))
    return film[0] * film[2], carried
