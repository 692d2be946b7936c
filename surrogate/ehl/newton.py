# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Semismooth Newton on one grid: film, cavitated and contact nodes in one system.

Film: Reynolds' equation for pf with the film max(h, floor) everywhere; pf >= 0, F >= 0, pf F = 0.
Contact: pa >= 0, h >= floor, pa (h - floor) = 0. Load: the integral of pf + pa. Speed zero leaves
the film out.

"""

from dataclasses import dataclass, replace
import math
import time

import numpy as np
from numpy.typing import NDArray
from surrogate.ehl._krylov import solve_newton_step
from surrogate.ehl._level import Level
from surrogate.ehl._reynolds import (
    contact_set,
    film_properties,
    fluid_at,
    free_boundary_rows,
    reynolds_rows,
    ROELANDS_PRESSURE,
)
from surrogate.ehl._transfer import inject
from surrogate.ehl.grid import Grid, KRYLOV_LIMIT, KRYLOV_TYPE, LEVELS, State
from surrogate.ehl.half_space import deform

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]
HOPELESS = 5
"""Linear solves cut at their limit after which an iteration is given up [-]."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Problem:
    """
    Equations on one grid, in Hertz units [-].

    Heights of the undeformed gap, film floor, load, pressed width along y; dry or not; mobility
    (flow factor over rho h^3/eta, times dx), the numbers of the fluid laws, order of the wedge (1
    to 2), whether surfaces touch or may, pressure just outside the inlet over that inside per
    column.

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
    touching: bool
    inlet: Array


@dataclass(frozen=True, kw_only=True, slots=True)
class Limits:
    """
    Tolerances [-] and caps of one Newton solve.

    A step may change the pressure of a film node by `step` and the logarithm of the viscosity at
    the Hertz pressure by `viscous`, and may raise the film pressure of a contact node by `rise`.

    """

    flux: float = 1e-4
    load: float = 1e-6
    gap: float = 1e-4
    krylov: float = 0.02
    newton: int = 40
    step: float = 0.5
    viscous: float = 6.0
    rise: float = 0.3
    deadline: float = math.inf


@dataclass(frozen=True, kw_only=True, slots=True)
class Outcome:
    """Last state of a Newton solve, its fields, errors and counts."""

    state: State
    gap: Array
    contact: Mask
    cavitated: Mask
    converged: bool
    out_of_time: bool
    flux_error: float
    load_error: float
    gap_error: float
    newton: int
    krylov: int


@dataclass(slots=True)
class _Evaluation:
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


def solve_grid(grid: Grid, problem: Problem, start: State, limits: Limits) -> Outcome:
    """Iterate from `start` until all three errors are small, or say what is left."""
    state, krylov, count, hopeless = start, 0, 0, 0
    while True:
        now = _evaluate(grid, problem, state)
        converged = _is_converged(now, problem, limits)
        late = time.perf_counter() > limits.deadline
        finite = math.isfinite(now.flux_error) and math.isfinite(now.load_rest)
        if converged or late or not finite or count >= limits.newton or hopeless >= HOPELESS:
            break
        state, used = _step(grid, problem, state, now, limits)
        krylov += used
        count += 1
        hopeless += used == KRYLOV_LIMIT
    return Outcome(
        state=state,
        gap=now.gap,
        contact=now.contact,
        cavitated=now.cavitated,
        converged=converged,
        out_of_time=late and not converged,
        flux_error=now.flux_error,
        load_error=now.load_rest / problem.load,
        gap_error=now.gap_error,
        newton=count,
        krylov=krylov,
    )


def _is_converged(now: _Evaluation, problem: Problem, limits: Limits) -> bool:
    return bool(
        now.flux_error < limits.flux
        and now.gap_error < limits.gap
        and abs(now.load_rest) < limits.load * problem.load
    )


def _evaluate(grid: Grid, problem: Problem, state: State) -> _Evaluation:
    shape = grid.shape
    pressure = state.film_pressure
    gap = np.empty(shape)
    deform(grid.space, pressure + state.asperity_pressure, gap)
    gap += problem.heights + state.approach
    contact, cavitated = np.zeros(shape, bool), np.zeros(shape, bool)
    count = contact_set(
        state.asperity_pressure, gap, problem.floor, grid.stiffness, grid.symmetric, contact
    )
    residual, by_pressure, by_gap, heights = _rows(grid, problem, pressure, gap, contact)
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
    gap_error = float((np.where(contact, 0.0, state.asperity_pressure) * grid.stiffness).max())
    if count:
        gap_error = max(gap_error, float(np.abs(gap[contact] - problem.floor).max()))
    return _Evaluation(
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


def _rows(
    grid: Grid, problem: Problem, pressure: Array, gap: Array, contact: Mask
) -> tuple[Array, Array, Array, Array]:
    """Return Reynolds' residual, its planes by pressure and by gap, and the film heights."""
    residual, film = np.zeros(grid.shape), np.empty((7, *grid.shape))
    by_pressure, by_gap = np.zeros((6, *grid.shape)), np.zeros((6, *grid.shape))
    if not problem.dry:
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
        reynolds_rows(
            pressure,
            film,
            problem.mobility,
            (grid.dx / grid.dy) ** 2,
            problem.order,
            problem.touching,
            problem.inlet,
            residual,
            by_pressure,
            by_gap,
        )
    return residual, by_pressure, by_gap, film[2]


def _step(
    grid: Grid, problem: Problem, state: State, now: _Evaluation, limits: Limits
) -> tuple[State, int]:
    """One Newton step, limited."""
    film_change, total_change, approach, used = _linear_solve(grid, problem, state, now, limits)
    contact = now.contact
    free = np.abs(np.where(contact, 0.0, film_change)).max()
    if problem.dry:
        film_change = -state.film_pressure
    asperity_change = total_change - film_change
    if contact.any():
        limited = _limit_on_contact(
            problem, state.film_pressure[contact], film_change[contact], limits.rise
        )
        asperity_change[contact] += film_change[contact] - limited
        film_change[contact] = limited
    share = min(1.0, min(limits.step, limits.viscous / _stiffening(problem)) / max(free, 1e-30))
    asperity_pressure = state.asperity_pressure + share * asperity_change
    if share == 1.0:
        asperity_pressure[~contact] = 0.0
    return State(
        film_pressure=np.maximum(state.film_pressure + share * film_change, 0.0),
        asperity_pressure=asperity_pressure,
        approach=state.approach + share * approach,
    ), used


def _stiffening(problem: Problem) -> float:
    """Return the slope of ln(viscosity) at the Hertz pressure."""
    slope = fluid_at(1.0, problem.pressure_scale, problem.growth, problem.exponent, 0.0)[1]
    return max(float(slope), 1e-30)


def _limit_on_contact(problem: Problem, pressure: Array, change: Array, rise: float) -> Array:
    """
    Limit the change of film pressure where the viscosity law would throw it about.

    As for the diode in circuit simulation: a fall is followed in the logarithm of the viscosity, a
    rise is capped; the asperity pressure takes the rest, so that elasticity is untouched.

    """
    base = 1.0 + pressure * problem.pressure_scale / ROELANDS_PRESSURE
    slope = (
        problem.growth
        * problem.exponent
        * base ** (problem.exponent - 1.0)
        * problem.pressure_scale
        / ROELANDS_PRESSURE
    )
    fall = -np.log1p(slope * np.abs(change)) / slope
    return np.maximum(np.where(change < 0, fall, np.minimum(change, rise)), -pressure)


def _linear_solve(
    grid: Grid, problem: Problem, state: State, now: _Evaluation, limits: Limits
) -> tuple[Array, Array, float, int]:
    """Return changes of film pressure, total pressure and approach, and the iterations."""
    levels = _levels(grid, problem, state, now)
    nodes, size = levels[0].nodes, now.gap.size
    released = np.where(now.contact, 0.0, state.asperity_pressure)
    rhs = grid.workspace.basis[0]
    rhs[:size] = -now.residual.ravel()
    if released.any():
        rhs[:size] -= _film_rows(now.by_pressure, released).ravel()
    border = size + nodes.size
    rhs[size:border] = (problem.floor - now.gap.ravel()[nodes]) * levels[0].inverse
    rhs[border] = now.load_rest
    padded = tuple(levels + levels[-1:] * (LEVELS - len(levels)))
    used = solve_newton_step(padded, len(levels), limits.krylov, KRYLOV_LIMIT)
    x = grid.workspace.answer[: border + 1]
    total = x[:size].astype(float).reshape(grid.shape)
    film = total + released
    film.ravel()[nodes] = x[size:-1]
    if grid.symmetric:
        total[:, 0], film[:, 0] = total[:, 2], film[:, 2]
    return film, total, float(x[-1]), used


def _levels(grid: Grid, problem: Problem, state: State, now: _Evaluation) -> list[Level]:
    """Return the Jacobian on the grid and, for a film without contact, on coarser ones."""
    levels = [_level(grid, now.contact, now.by_pressure, now.by_gap, now.sizes)]
    pressure, gap, film = state.film_pressure, now.gap, ~now.cavitated
    if problem.dry or now.contact.any():
        return levels
    while grid.coarser is not None and len(levels) < LEVELS:
        grid, problem = grid.coarser, _coarser(problem)
        pressure, gap, film = inject(pressure), inject(gap), inject(film)
        levels.append(_coarse_level(grid, problem, pressure, gap, film))
    return levels


def _level(grid: Grid, contact: Mask, by_pressure: Array, by_gap: Array, sizes: Array) -> Level:
    work = grid.workspace
    work.by_pressure[:], work.by_gap[:] = by_pressure, by_gap
    return Level(
        space=grid.krylov_space,
        work=work,
        nodes=np.flatnonzero(_own_nodes(grid, contact)),
        contact=contact,
        weights=grid.weights.astype(KRYLOV_TYPE),
        inverse=KRYLOV_TYPE(1.0 / grid.stiffness),
        sizes=sizes.astype(KRYLOV_TYPE),
    )


def _coarser(problem: Problem) -> Problem:
    """Return the problem with twice the node distance, as far as its Jacobian goes."""
    return replace(
        problem, mobility=problem.mobility / 2, inlet=inject(problem.inlet[None])[0] ** 2
    )


def _coarse_level(grid: Grid, problem: Problem, pressure: Array, gap: Array, film: Mask) -> Level:
    """Linearise about an injected state; nodes outside `film` are cavitated."""
    contact = np.zeros(grid.shape, bool)
    _, by_pressure, by_gap, _ = _rows(grid, problem, pressure, gap, contact)
    sizes = np.where(film, np.abs(by_pressure[0]) + np.abs(by_gap[0]) * grid.stiffness, 0.0)
    factor = np.divide(1.0, sizes, out=np.zeros(grid.shape), where=sizes > 0)
    by_pressure *= factor
    by_gap *= factor
    by_pressure[0][sizes == 0] = 1.0
    return _level(grid, contact, by_pressure, by_gap, sizes)


def _own_nodes(grid: Grid, mask: Mask) -> Mask:
    """Drop the mirror column of a mask."""
    if not grid.symmetric:
        return mask
    own = mask.copy()
    own[:, 0] = False
    return own


def _film_rows(planes: Array, field: Array) -> Array:
    """Apply the pressure planes to a field that vanishes on the border."""
    out = np.zeros_like(field)
    inner = (slice(1, -1), slice(1, -1))
    out[inner] = (
        planes[0][inner] * field[inner]
        + planes[1][inner] * field[:-2, 1:-1]
        + planes[2][inner] * field[2:, 1:-1]
        + planes[3][inner] * field[1:-1, :-2]
        + planes[4][inner] * field[1:-1, 2:]
    )
    out[2:-1, 1:-1] += planes[5][2:-1, 1:-1] * field[:-3, 1:-1]
    return out
