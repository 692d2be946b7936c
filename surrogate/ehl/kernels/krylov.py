# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Right-preconditioned GMRES for one Newton step, compiled as a whole.

Lines alone precondition a single grid. With coarser grids every step first solves the restricted
residual on the next one, roughly and by the same GMRES, and smooths what is left with the lines:
GMRES is then the flexible one, which keeps its directions. The levels are walked in a loop, as
compiled functions that call themselves cannot be kept on the disk.

"""

import math

import numpy as np
from numpy.typing import NDArray
from surrogate.compiler import njit
from surrogate.ehl.kernels.level import (
    apply_operator,
    factor,
    GridLevel,
    hand_down,
    precondition,
    take_up,
    unknowns,
    Workspace,
)

Array = NDArray[np.floating]
COARSE_TOLERANCE, COARSE_LIMIT = 0.1, 40
"""Relative residual and most iterations of a solve on a coarser grid [-]."""


@njit(cache=True, error_model='numpy', fastmath={'reassoc', 'contract', 'nsz'})
def dot(a: Array, b: Array) -> np.floating:
    """Sum a b in any order, which vectorises."""
    total = a.dtype.type(0)
    for n in range(a.size):
        total += a[n] * b[n]
    return total


@njit(cache=True, error_model='numpy')
def orthogonalise(basis: Array, last: int, length: int, column: Array) -> float:
    """Make vector `last` orthonormal to those before (modified Gram-Schmidt); return its norm."""
    new = basis[last][:length]
    for i in range(last):
        old = basis[i][:length]
        product = dot(old, new)
        column[i] = product
        for n in range(length):
            new[n] -= product * old[n]
    norm = math.sqrt(dot(new, new))
    column[last] = norm
    if norm > 0.0:
        multiply(new, 1.0 / norm)
    return norm


@njit(cache=True, error_model='numpy')
def multiply(values: Array, factor: float) -> None:
    """Multiply a vector in its own precision."""
    own = values.dtype.type(factor)
    for n in range(values.size):
        values[n] *= own


@njit(cache=True, error_model='numpy')
def rotate(upper: Array, turns: Array, rest: Array, k: int) -> bool:
    """Turn column k and the right-hand side to triangular form; return whether regular."""
    column, cos, sin = upper[:, k], turns[0], turns[1]
    for i in range(k):
        turned = cos[i] * column[i] + sin[i] * column[i + 1]
        column[i + 1] = cos[i] * column[i + 1] - sin[i] * column[i]
        column[i] = turned
    radius = math.hypot(column[k], column[k + 1])
    if radius == 0.0 or not math.isfinite(radius):
        return False
    cos[k], sin[k] = column[k] / radius, column[k + 1] / radius
    column[k] = radius
    rest[k + 1] = -sin[k] * rest[k]
    rest[k] *= cos[k]
    return True


@njit(cache=True, error_model='numpy')
def start(level: GridLevel) -> None:
    """Begin GMRES with the right-hand side in basis[0]."""
    work = level.work
    first = work.basis[0][: unknowns(level)]
    norm = math.sqrt(dot(first, first))
    if norm > 0.0:
        multiply(first, 1.0 / norm)
    work.reduced[0] = work.reduced[-1] = norm
    work.used[0], work.used[1] = 0, norm == 0.0


@njit(cache=True, error_model='numpy')
def advance(level: GridLevel, direction: Array) -> None:
    """Extend the basis by J times a direction."""
    work, length = level.work, unknowns(level)
    k = work.used[0]
    apply_operator(level, direction, work.basis[k + 1])
    norm = orthogonalise(work.basis, k + 1, length, work.upper[:, k])
    if rotate(work.upper, work.turns, work.reduced, k):
        work.used[0] = k + 1
        work.used[1] = norm == 0.0
    else:
        work.used[1] = 1


@njit(cache=True, error_model='numpy')
def is_done(work: Workspace, tolerance: float, limit: int) -> bool:
    """Return True if the residual is small, the iterations are used up or broke down."""
    used = work.used[0]
    small = abs(work.reduced[used]) < tolerance * work.reduced[-1]
    return bool(small or used == limit or work.used[1])


@njit(cache=True, error_model='numpy')
def combine(work: Workspace, vectors: Array, out: Array) -> None:
    """Solve the triangle and add up `vectors` with the solution."""
    used, values, upper = work.used[0], work.reduced[: work.used[0]].copy(), work.upper
    for i in range(used - 1, -1, -1):
        for k in range(i + 1, used):
            values[i] -= upper[i, k] * values[k]
        values[i] /= upper[i, i]
    out[:] = 0
    for k in range(used):
        factor = out.dtype.type(values[k])
        vector = vectors[k][: out.size]
        for n in range(out.size):
            out[n] += factor * vector[n]


@njit(cache=True, error_model='numpy')
def finish(level: GridLevel, varied: bool) -> None:
    """Leave the solution in `answer`; a varied preconditioner has kept its directions."""
    work, length = level.work, unknowns(level)
    if varied:
        combine(work, work.directions, work.answer[:length])
    else:
        combine(work, work.basis, work.rest[:length])
        precondition(level, work.rest, work.answer)


@njit(cache=True, error_model='numpy')
def descend(fine: GridLevel, coarse: GridLevel) -> None:
    """Begin the solve on the coarser grid that the next step waits for."""
    hand_down(fine, coarse, fine.work.basis[fine.work.used[0]])
    start(coarse)


@njit(cache=True, error_model='numpy')
def ascend(fine: GridLevel, coarse: GridLevel) -> None:
    """Take the step that has waited for the coarser grid."""
    k = fine.work.used[0]
    direction = fine.work.directions[k]
    take_up(fine, coarse, fine.work.basis[k], direction)
    advance(fine, direction)


@njit(cache=True, error_model='numpy')
def solve_newton_step(
    levels: tuple[GridLevel, ...], count: int, tolerance: float, limit: int
) -> int:
    """
    Solve J x = rhs on the first of `count` levels; return the iterations there.

    The planes of J are in the work space of each level, the right-hand side is in basis[0] of the
    first, whose `answer` takes the solution. Levels below it are for a film without contact.

    """
    for depth in range(count):
        factor(levels[depth])
    start(levels[0])
    depth = 0
    while depth >= 0:
        level, last = levels[depth], depth + 1 == count
        small, most = (COARSE_TOLERANCE, COARSE_LIMIT) if depth else (tolerance, limit)
        if is_done(level.work, small, most):
            finish(level, not last)
            depth -= 1
            if depth >= 0:
                ascend(levels[depth], level)
        elif last:
            precondition(level, level.work.basis[level.work.used[0]], level.work.answer)
            advance(level, level.work.answer)
        else:
            depth += 1
            descend(level, levels[depth])
    return int(levels[0].work.used[0])
