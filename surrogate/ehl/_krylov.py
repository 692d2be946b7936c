# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Right-preconditioned GMRES for one Newton step, compiled as a whole.

Unknowns, in one vector: total pressure on all nodes, film pressure on the contact nodes, approach.
Rows: Reynolds on all nodes, gap on the contact nodes, load. Where there is no contact the change
of film pressure is that of the total pressure.

"""

import math
from typing import NamedTuple

from numba import njit
import numpy as np
from numpy.typing import NDArray
from surrogate.ehl._line import line_factors, mirror, solve_film_lines, solve_lines
from surrogate.ehl.half_space import deform, HalfSpace

Array = NDArray[np.floating]
Mask = NDArray[np.bool_]
CHUNK = 32
"""Partial sums of a dot product."""


class Workspace(NamedTuple):
    """Arrays of the linear solver of one grid, in its precision and in Hertz units [-]."""

    by_pressure: Array
    by_gap: Array
    bands: Array
    sides: Array
    film_bands: Array
    scratch: Array
    total: Array
    film: Array
    lift: Array
    basis: Array
    border: Array


def make_workspace(nx: int, ny: int, krylov: int, dtype: type) -> Workspace:
    """Allocate for an (nx, ny) grid and at most `krylov` iterations."""

    def planes(count: int) -> Array:
        return np.zeros((count, nx, ny), dtype)

    longest = 2 * nx * ny + 1
    return Workspace(
        by_pressure=planes(6),
        by_gap=planes(6),
        bands=planes(5),
        sides=planes(6),
        film_bands=planes(3),
        scratch=planes(3),
        total=planes(1)[0],
        film=planes(1)[0],
        lift=planes(1)[0],
        basis=np.zeros((krylov + 1, longest), dtype),
        border=np.zeros(longest, dtype),
    )


@njit(cache=True, error_model='numpy')
def dot(a: Array, b: Array) -> np.floating:
    """Sum a b over `CHUNK` partial sums, which vectorises without reordering rights."""
    size, zero = a.size, a.dtype.type(0)
    partial = np.zeros(CHUNK, a.dtype)
    whole = size - size % CHUNK
    for start in range(0, whole, CHUNK):
        for lane in range(CHUNK):
            partial[lane] += a[start + lane] * b[start + lane]
    total = zero
    for lane in range(CHUNK):
        total += partial[lane]
    for k in range(whole, size):
        total += a[k] * b[k]
    return total


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
def apply_operator(
    space: HalfSpace,
    work: Workspace,
    nodes: NDArray[np.int64],
    contact: Mask,
    weights: Array,
    inverse: np.floating,
    x: Array,
    out: Array,
) -> None:
    """Multiply the full Jacobian: out = J x."""
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
    stencil(work.by_pressure, work.by_gap, film, lift, out[:size].reshape(nx, ny))
    raised = lift.reshape(size)
    for k in range(count):
        out[size + k] = raised[nodes[k]] * inverse
    out[size + count] = load_of(total, weights)


@njit(cache=True, error_model='numpy')
def apply_lines(
    space: HalfSpace,
    work: Workspace,
    nodes: NDArray[np.int64],
    contact: Mask,
    steps: int,
    x: Array,
    out: Array,
) -> None:
    """Precondition all but the border of load and approach."""
    nx, ny = work.total.shape
    size, count = nx * ny, nodes.size
    rhs = x[:size].reshape(nx, ny)
    if count == 0:
        total = out[:size].reshape(nx, ny)
        solve_lines(work.bands, work.sides, rhs, steps, space.symmetric, work.scratch, total)
        if space.symmetric:
            total[:, 0] = 0
        return
    mixed, total, film = work.scratch[2], work.total, work.film
    mixed[:] = rhs
    flat = mixed.reshape(size)
    for k in range(count):
        flat[nodes[k]] = x[size + k]
    solve_lines(work.bands, work.sides, mixed, steps, space.symmetric, work.scratch, total)
    solve_film_lines(
        work.by_pressure,
        work.film_bands,
        contact,
        rhs,
        total,
        3,
        space.symmetric,
        work.scratch,
        film,
    )
    out[:size] = total.reshape(size)
    if space.symmetric:
        out[:size].reshape(nx, ny)[:, 0] = 0
    flat = film.reshape(size)
    for k in range(count):
        out[size + k] = flat[nodes[k]]


@njit(cache=True, error_model='numpy')
def precondition(
    space: HalfSpace,
    work: Workspace,
    nodes: NDArray[np.int64],
    contact: Mask,
    weights: Array,
    steps: int,
    border: Array,
    x: Array,
    out: Array,
) -> None:
    """Apply the lines and eliminate the border: load row and approach column."""
    nx, ny = work.total.shape
    size, count = nx * ny, nodes.size
    apply_lines(space, work, nodes, contact, steps, x, out)
    load = load_of(border[:size].reshape(nx, ny), weights)
    approach = (load_of(out[:size].reshape(nx, ny), weights) - x[size + count]) / load
    for k in range(size + count):
        out[k] -= approach * border[k]
    out[size + count] = approach


@njit(cache=True, error_model='numpy')
def solve_newton_step(
    space: HalfSpace,
    work: Workspace,
    nodes: NDArray[np.int64],
    contact: Mask,
    weights: Array,
    inverse: np.floating,
    steps: int,
    tolerance: float,
    limit: int,
    x: Array,
) -> tuple[int, float]:
    """
    Solve J x = rhs (in basis[0]) by GMRES; return iterations and the relative residual.

    The planes of J are in `work`; this factors the lines, builds the basis by modified Gram-
    Schmidt and leaves the solution in `x`.

    """
    nx, ny = work.total.shape
    size, count = nx * ny, nodes.size
    length = size + count + 1
    one = weights.dtype.type(1)
    line_factors(
        work.by_pressure,
        work.by_gap,
        contact,
        space.near,
        inverse,
        work.bands,
        work.sides,
        work.film_bands,
    )
    trial = np.zeros(length, x.dtype)
    column = trial[:size].reshape(nx, ny)
    for i in range(1, nx - 1):
        for j in range(1, ny - 1):
            for plane in range(6):
                column[i, j] += work.by_gap[plane, i, j]
    for k in range(count):
        trial[size + k] = inverse
    border = work.border[:length]
    apply_lines(space, work, nodes, contact, steps, trial, border)

    first = work.basis[0][:length]
    norm = math.sqrt(dot(first, first))
    if norm == 0.0:
        x[:] = 0
        return 0, 0.0
    first *= one / x.dtype.type(norm)
    upper = np.zeros((limit + 1, limit))
    cos, sin, rest = np.zeros(limit), np.zeros(limit), np.zeros(limit + 1)
    rest[0] = norm
    used = 0
    for k in range(limit):
        precondition(
            space, work, nodes, contact, weights, steps, border, work.basis[k][:length], trial
        )
        new = work.basis[k + 1][:length]
        apply_operator(space, work, nodes, contact, weights, inverse, trial, new)
        for i in range(k + 1):
            old = work.basis[i][:length]
            product = dot(old, new)
            upper[i, k] = product
            for n in range(length):
                new[n] -= product * old[n]
        size_new = math.sqrt(dot(new, new))
        upper[k + 1, k] = size_new
        if size_new > 0.0:
            factor = x.dtype.type(1.0 / size_new)
            for n in range(length):
                new[n] *= factor
        for i in range(k):
            turned = cos[i] * upper[i, k] + sin[i] * upper[i + 1, k]
            upper[i + 1, k] = cos[i] * upper[i + 1, k] - sin[i] * upper[i, k]
            upper[i, k] = turned
        radius = math.hypot(upper[k, k], upper[k + 1, k])
        if radius == 0.0 or not math.isfinite(radius):
            break
        cos[k], sin[k] = upper[k, k] / radius, upper[k + 1, k] / radius
        upper[k, k] = radius
        rest[k + 1] = -sin[k] * rest[k]
        rest[k] *= cos[k]
        used = k + 1
        if abs(rest[k + 1]) < tolerance * norm or size_new == 0.0:
            break
    for i in range(used - 1, -1, -1):
        value = rest[i]
        for k in range(i + 1, used):
            value -= upper[i, k] * rest[k]
        rest[i] = value / upper[i, i]
    new = work.basis[used][:length]
    new[:] = 0
    for k in range(used):
        factor = x.dtype.type(rest[k])
        old = work.basis[k][:length]
        for n in range(length):
            new[n] += factor * old[n]
    precondition(space, work, nodes, contact, weights, steps, border, new, x)
    return used, abs(rest[used]) / norm
