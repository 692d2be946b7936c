# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Jacobian of one Newton step on one grid: operator, preconditioner, transfer to the next; compiled.

Unknowns, in one vector: total pressure on all nodes, film pressure on the contact nodes, approach.
Rows: Reynolds on all nodes, gap on the contact nodes, load. Where there is no contact the change
of film pressure is that of the total pressure.

"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from surrogate.compiler import njit
from surrogate.ehl.half_space import deform, HalfSpace, repeat
from surrogate.ehl.kernels.bands import bands_across, factor_bands, mark_thick_film, solve_bands
from surrogate.ehl.kernels.line import (
    film_factors,
    line_factors,
    lines_of_a_kind,
    mirror,
    solve_film_lines,
    solve_lines,
)
from surrogate.ehl.kernels.transfer import prolong, restrict

Array = NDArray[np.floating]
Mask = NDArray[np.bool_]
LINE_STEPS = 4
"""Times that every other line is solved in one application of the preconditioner."""
FILM_STEPS = 3
"""Line-Jacobi steps for the film pressure on contact nodes."""
FEW_IN_CONTACT = 0.1
"""Share of nodes in contact up to which bands of thick film help; with more they do harm [-]."""


class Workspace(NamedTuple):
    """
    Arrays of the linear solver of one grid, in its precision and in Hertz units [-].

    From `upper` on, the least squares problem of GMRES: triangle, rotations, right-hand side with
    the norm of the system last, iterations used, whether they broke down, whether bands of thick
    film start the lines.

    """

    by_pressure: Array
    by_gap: Array
    bands: Array
    sides: Array
    film_bands: Array
    thick: Array
    thick_rows: Array
    thick_lower: Array
    thick_values: Array
    halves: Array
    scratch: Array
    total: Array
    film: Array
    lift: Array
    basis: Array
    directions: Array
    border: Array
    rest: Array
    answer: Array
    upper: NDArray[np.float64]
    turns: NDArray[np.float64]
    reduced: NDArray[np.float64]
    used: NDArray[np.int64]


class GridLevel(NamedTuple):
    """
    Jacobian on one grid with what it takes to apply and precondition it.

    Contact nodes by index and as a mask, first row, end of the rows, first column and end of the
    columns of a box with a node to spare around them, area of the nodes of a column, row factor of
    the gap rows; what the Reynolds rows were divided by, zero on the border and on cavitated nodes
    [-].

    """

    space: HalfSpace
    work: Workspace
    nodes: NDArray[np.int64]
    contact: Mask
    box: tuple[int, int, int, int]
    weights: Array
    inverse: np.floating
    sizes: Array


def make_workspace(nx: int, ny: int, krylov: int, flexible: bool, dtype: type) -> Workspace:
    """Allocate for an (nx, ny) grid and `krylov` iterations, `flexible` above a coarser grid."""

    def planes(count: int) -> Array:
        return np.zeros((count, nx, ny), dtype)

    longest, across, half = 2 * nx * ny + 1, bands_across(ny), lines_of_a_kind(ny)
    return Workspace(
        by_pressure=planes(6),
        by_gap=planes(6),
        bands=np.zeros((2, 5, nx, half), dtype),
        sides=np.zeros((2, 6, nx, half), dtype),
        film_bands=planes(5),
        thick=planes(1)[0],
        thick_rows=np.zeros((nx * across, 2 * across + 1), dtype),
        thick_lower=np.zeros((nx * across, across), dtype),
        thick_values=np.zeros((nx + 1) * across, dtype),
        halves=np.zeros((6, nx, half), dtype),
        scratch=planes(3),
        total=planes(1)[0],
        film=planes(1)[0],
        lift=planes(1)[0],
        basis=np.zeros((krylov + 1, longest), dtype),
        directions=np.zeros((krylov if flexible else 0, longest), dtype),
        border=np.zeros(longest, dtype),
        rest=np.zeros(longest, dtype),
        answer=np.zeros(longest, dtype),
        upper=np.zeros((krylov + 1, krylov)),
        turns=np.zeros((2, krylov)),
        reduced=np.zeros(krylov + 2),
        used=np.zeros(3, np.int64),
    )


@njit(cache=True, error_model='numpy')
def unknowns(level: GridLevel) -> int:
    """Count the unknowns."""
    return int(level.work.total.size + level.nodes.size + 1)


@njit(cache=True, error_model='numpy')
def stencil(by_pressure: Array, by_gap: Array, film: Array, lift: Array, out: Array) -> None:
    """Apply the Reynolds planes to changes of film pressure and gap [-]."""
    nx, ny = film.shape
    for i in range(1, nx - 1):
        for j in range(1, ny - 1):
            out[i, j] = (
                by_pressure[0, i, j] * film[i, j]
                + by_pressure[1, i, j] * film[i - 1, j]
                + by_pressure[2, i, j] * film[i + 1, j]
                + by_pressure[3, i, j] * film[i, j - 1]
                + by_pressure[4, i, j] * film[i, j + 1]
            )
        for j in range(1, ny - 1):
            out[i, j] += (
                by_gap[0, i, j] * lift[i, j]
                + by_gap[1, i, j] * lift[i - 1, j]
                + by_gap[2, i, j] * lift[i + 1, j]
                + by_gap[3, i, j] * lift[i, j - 1]
                + by_gap[4, i, j] * lift[i, j + 1]
            )
        if i > 1:
            for j in range(1, ny - 1):
                out[i, j] += (
                    by_pressure[5, i, j] * film[i - 2, j] + by_gap[5, i, j] * lift[i - 2, j]
                )


@njit(cache=True, error_model='numpy')
def load_of(total: Array, weights: Array) -> np.floating:
    """Integrate a field with the quadrature weights of the columns."""
    result = weights.dtype.type(0)
    columns = np.zeros(weights.size, total.dtype)
    for i in range(total.shape[0]):
        for j in range(weights.size):
            columns[j] += total[i, j]
    for j in range(weights.size):
        result += columns[j] * weights[j]
    return result


@njit(cache=True, error_model='numpy')
def apply_operator(level: GridLevel, x: Array, out: Array) -> None:
    """Multiply the full Jacobian: out = J x."""
    space, work, nodes = level.space, level.work, level.nodes
    nx, ny = work.total.shape
    size, count = nx * ny, nodes.size
    total = x[:size].reshape(nx, ny)
    film, lift = work.film, work.lift
    film[:] = total
    flat = film.reshape(size)
    for k in range(count):
        flat[nodes[k]] = x[size + k]
    deform(space, total, lift)
    lift += x[size + count]
    if space.symmetric:
        mirror(film)
    if space.periodic:
        repeat(film)
    stencil(work.by_pressure, work.by_gap, film, lift, out[:size].reshape(nx, ny))
    raised = lift.reshape(size)
    for k in range(count):
        out[size + k] = raised[nodes[k]] * level.inverse
    out[size + count] = load_of(total, level.weights)


@njit(cache=True, error_model='numpy')
def apply_lines(level: GridLevel, x: Array, out: Array) -> None:
    """Precondition all but the border of load and approach."""
    work, nodes, symmetric = level.work, level.nodes, level.space.symmetric
    nx, ny = work.total.shape
    size, count = nx * ny, nodes.size
    rhs, total = x[:size].reshape(nx, ny), out[:size].reshape(nx, ny)
    if count == 0:
        _solve_total(level, rhs, total)
    else:
        mixed = work.scratch[2]
        mixed[:] = rhs
        flat = mixed.reshape(size)
        for k in range(count):
            flat[nodes[k]] = x[size + k]
        _solve_total(level, mixed, work.total)
        solve_film_lines(
            work.film_bands,
            level.contact,
            level.box,
            rhs,
            work.total,
            FILM_STEPS,
            symmetric,
            work.scratch,
            work.film,
        )
        out[:size] = work.total.reshape(size)
        flat = work.film.reshape(size)
        for k in range(count):
            out[size + k] = flat[nodes[k]]
    if symmetric or level.space.periodic:
        total[:, 0] = 0
    if level.space.periodic:
        total[:, ny - 1] = 0


@njit(cache=True, error_model='numpy')
def _solve_total(level: GridLevel, rhs: Array, total: Array) -> None:
    """Precondition the total pressure: bands of thick film, then the lines from there."""
    work, started = level.work, level.work.used[2] == 1
    if started:
        rows, lower = work.thick_rows, work.thick_lower
        solve_bands(rows, lower, work.thick, rhs, work.thick_values, total)
    solve_lines(
        work.bands,
        work.sides,
        rhs,
        LINE_STEPS,
        started,
        level.space.symmetric,
        level.space.periodic,
        work.halves,
        total,
    )


@njit(cache=True, error_model='numpy')
def precondition(level: GridLevel, x: Array, out: Array) -> None:
    """Apply the lines and eliminate the border: load row and approach column."""
    nx, ny = level.work.total.shape
    size, count = nx * ny, level.nodes.size
    border, weights = level.work.border, level.weights
    apply_lines(level, x, out)
    load = load_of(border[:size].reshape(nx, ny), weights)
    approach = (load_of(out[:size].reshape(nx, ny), weights) - x[size + count]) / load
    for k in range(size + count):
        out[k] -= approach * border[k]
    out[size + count] = approach


@njit(cache=True, error_model='numpy')
def factor(level: GridLevel) -> None:
    """Factor the lines and bands of a level and precondition its approach column."""
    work, nodes = level.work, level.nodes
    nx, ny = work.total.shape
    size, count = nx * ny, nodes.size
    line_factors(
        work.by_pressure,
        work.by_gap,
        level.contact,
        level.space.near,
        level.inverse,
        work.bands,
        work.sides,
    )
    if count > 0:
        film_factors(work.by_pressure, level.contact, work.film_bands)
    work.used[2] = 0
    # A symmetric grid has coarser bands instead of those of thick film.
    few = count < FEW_IN_CONTACT * level.contact.size
    if (
        few
        and not level.space.symmetric
        and mark_thick_film(
            work.by_pressure, work.by_gap, level.contact, level.sizes, level.space.near, work.thick
        )
    ):
        if level.space.periodic:
            repeat(work.thick)
        factor_bands(work.by_pressure, work.thick, work.thick_rows, work.thick_lower)
        work.used[2] = 1
    raised = np.zeros(size + count + 1, work.border.dtype)
    column = raised[:size].reshape(nx, ny)
    for i in range(1, nx - 1):
        for j in range(1, ny - 1):
            for plane in range(6):
                column[i, j] += work.by_gap[plane, i, j]
    for k in range(count):
        raised[size + k] = level.inverse
    apply_lines(level, raised, work.border[: size + count + 1])


@njit(cache=True, error_model='numpy')
def hand_down(fine: GridLevel, coarse: GridLevel, x: Array) -> None:
    """Restrict a residual to the right-hand side of the coarser grid."""
    nx, ny = fine.work.total.shape
    mx, my = coarse.work.total.shape
    rhs = coarse.work.basis[0]
    field = rhs[: mx * my].reshape(mx, my)
    restrict(x[: nx * ny].reshape(nx, ny), fine.sizes, coarse.sizes, field)
    rhs[mx * my] = x[nx * ny]


@njit(cache=True, error_model='numpy')
def take_up(fine: GridLevel, coarse: GridLevel, x: Array, out: Array) -> None:
    """
    Interpolate the answer of the coarser grid and smooth what it leaves of `x` with the lines.

    The deflection under the interpolated pressure is taken as the interpolated deflection.

    """
    work, low = fine.work, coarse.work
    nx, ny = work.total.shape
    mx, my = low.total.shape
    size, lift = nx * ny, low.lift
    total, rest = work.total, work.rest[: size + 1]
    answer = low.answer[: mx * my].reshape(mx, my)
    prolong(answer, total)
    deform(coarse.space, answer, lift)
    lift += low.answer[mx * my]
    prolong(lift, work.lift)
    stencil(work.by_pressure, work.by_gap, total, work.lift, rest[:size].reshape(nx, ny))
    rest[size] = load_of(total, fine.weights)
    for k in range(size + 1):
        rest[k] = x[k] - rest[k]
    total[:, 0] = 0
    precondition(fine, rest, out)
    flat = total.reshape(size)
    for k in range(size):
        out[k] += flat[k]
    out[size] += low.answer[mx * my]
