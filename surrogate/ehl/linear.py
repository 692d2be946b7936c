# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The linear system of a Newton step: rows on the grid and on coarser ones, and its solution."""

from dataclasses import replace

import numpy as np
from surrogate.ehl.grid import Grid, GridState, KRYLOV_LIMIT, KRYLOV_TYPE, LEVELS
from surrogate.ehl.half_space import repeat
from surrogate.ehl.kernels.krylov import solve_newton_step
from surrogate.ehl.kernels.level import GridLevel
from surrogate.ehl.kernels.transfer import inject
from surrogate.ehl.system import Array, Evaluation, film_rows, GridProblem, Mask


def solve_linear(
    grid: Grid, problem: GridProblem, state: GridState, now: Evaluation, tolerance: float
) -> tuple[Array, Array, float, int]:
    """Return changes of film pressure, total pressure and approach, and the iterations."""
    levels = jacobian_levels(grid, problem, state, now)
    nodes, size = levels[0].nodes, now.gap.size
    released = np.where(now.contact, 0.0, state.asperity_pressure)
    rhs = grid.workspace.basis[0]
    rhs[:size] = -now.residual.ravel()
    if released.any():  # it vanishes on the border
        by_pressure, inner = now.by_pressure, (slice(1, -1), slice(1, -1))
        flow = np.zeros_like(released)
        flow[inner] = (
            by_pressure[0][inner] * released[inner]
            + by_pressure[1][inner] * released[:-2, 1:-1]
            + by_pressure[2][inner] * released[2:, 1:-1]
            + by_pressure[3][inner] * released[1:-1, :-2]
            + by_pressure[4][inner] * released[1:-1, 2:]
        )
        flow[2:-1, 1:-1] += by_pressure[5][2:-1, 1:-1] * released[:-3, 1:-1]
        rhs[:size] -= flow.ravel()
    border = size + nodes.size
    rhs[size:border] = (problem.floor - now.gap.ravel()[nodes]) * levels[0].inverse
    rhs[border] = now.load_rest
    padded = tuple(levels + levels[-1:] * (LEVELS - len(levels)))
    used = solve_newton_step(padded, len(levels), tolerance, KRYLOV_LIMIT)
    x = grid.workspace.answer[: border + 1]
    total = x[:size].astype(float).reshape(grid.shape)
    film = total + released
    film.ravel()[nodes] = x[size:-1]
    if grid.symmetric:
        total[:, 0], film[:, 0] = total[:, 2], film[:, 2]
    if grid.periodic:
        repeat(total)
        repeat(film)
    return film, total, float(x[-1]), used


def jacobian_levels(
    grid: Grid, problem: GridProblem, state: GridState, now: Evaluation
) -> list[GridLevel]:
    """Return the Jacobian on the grid and, for a film without contact, on coarser ones."""
    levels = [_level(grid, now.contact, now.by_pressure, now.by_gap, now.sizes)]
    pressure, gap, film = state.film_pressure, now.gap, ~now.cavitated
    if problem.dry or now.contact.any():
        return levels
    while grid.coarser is not None and len(levels) < LEVELS:
        # The problem with twice the node distance, as far as its Jacobian goes.
        inlet = inject(problem.inlet[None])[0] ** 2
        grid, problem = grid.coarser, replace(problem, mobility=problem.mobility / 2, inlet=inlet)
        pressure, gap, film = inject(pressure), inject(gap), inject(film)
        contact = np.zeros(grid.shape, bool)
        _, by_pressure, by_gap, _ = film_rows(grid, problem, pressure, gap, contact)
        sizes = np.where(film, np.abs(by_pressure[0]) + np.abs(by_gap[0]) * grid.stiffness, 0.0)
        factor = np.divide(1.0, sizes, out=np.zeros(grid.shape), where=sizes > 0)
        by_pressure *= factor
        by_gap *= factor
        by_pressure[0][sizes == 0] = 1.0  # cavitated
        levels.append(_level(grid, contact, by_pressure, by_gap, sizes))
    return levels


def _level(
    grid: Grid, contact: Mask, by_pressure: Array, by_gap: Array, sizes: Array
) -> GridLevel:
    work = grid.workspace
    work.by_pressure[:], work.by_gap[:] = by_pressure, by_gap
    own = contact.copy()  # without the mirror column, or the copies of a period
    if grid.symmetric:
        own[:, 0] = False
    if grid.periodic:
        own[:, [0, -1]] = False
    return GridLevel(
        space=grid.krylov_space,
        work=work,
        nodes=np.flatnonzero(own),
        contact=contact,
        box=contact_box(contact),
        weights=grid.weights.astype(KRYLOV_TYPE),
        inverse=KRYLOV_TYPE(1.0 / grid.stiffness),
        sizes=sizes.astype(KRYLOV_TYPE),
    )


def contact_box(contact: Mask) -> tuple[int, int, int, int]:
    """Return first row, end of the rows, first column, end of the columns about the contact."""
    ends: list[int] = []
    for axis in (1, 0):
        lines = np.flatnonzero(contact.any(axis=axis))
        last = contact.shape[1 - axis] - 1
        ends += (
            [max(int(lines[0]) - 1, 1), min(int(lines[-1]) + 2, last)] if lines.size else [1, 1]
        )
    return ends[0], ends[1], ends[2], ends[3]
