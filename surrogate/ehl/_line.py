# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Line preconditioner: all lines along x at once, the inner loops run across them; compiled.

The elastic influence is replaced by its fitted 3x3 near kernel, so that a line is a matrix with
bands -3 to +1; neighbouring lines are coupled by Jacobi steps. Contact rows hold the near kernel
itself. The unknown is the total pressure; on contact nodes the film pressure follows from a second
line system.

"""

from numba import njit
import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.floating]
Mask = NDArray[np.bool_]


@njit(cache=True, error_model='numpy')
def line_factors(
    by_pressure: Array,
    by_gap: Array,
    contact: Mask,
    near: Array,
    inverse: np.floating,
    bands: Array,
    sides: Array,
    film_bands: Array,
) -> None:
    """
    Factor all lines; everything is in Hertz units [-].

    Total pressure: planes l3, l2, l1, 1/d, u1 in `bands`; coupling to both neighbours at -3, -2,
    -1, +1 in `sides` 0 to 3 and at 0 to the south and north in 4 and 5. Film pressure on contact
    nodes: planes l1, 1/d, u1 in `film_bands`. Contact rows are multiplied by `inverse`.

    """
    nx, ny = contact.shape
    k0, k1, m0, m1 = near[0], near[1], near[2], near[3]
    one = near.dtype.type(1)
    zero = near.dtype.type(0)
    for i in range(1, nx - 1):
        last = i == nx - 2
        for j in range(1, ny - 1):
            if contact[i, j]:
                c3, c2, c1, c0, cp = zero, zero, k1 * inverse, k0 * inverse, k1 * inverse
                sides[0, i, j], sides[1, i, j] = zero, zero
                sides[2, i, j], sides[3, i, j] = m1 * inverse, m1 * inverse
                sides[4, i, j], sides[5, i, j] = m0 * inverse, m0 * inverse
            else:
                h0, h1, h5 = by_gap[0, i, j], by_gap[1, i, j], by_gap[5, i, j]
                c3 = h5 * k1
                c2 = h5 * k0 + h1 * k1 + by_pressure[5, i, j]
                c1 = h5 * k1 + h1 * k0 + h0 * k1 + by_pressure[1, i, j]
                c0 = h1 * k1 + h0 * k0 + by_pressure[0, i, j]
                cp = h0 * k1 + by_pressure[2, i, j]
                sides[0, i, j] = h5 * m1
                sides[1, i, j] = h5 * m0 + h1 * m1
                sides[2, i, j] = h5 * m1 + h1 * m0 + h0 * m1
                sides[3, i, j] = h0 * m1
                middle = h1 * m1 + h0 * m0
                sides[4, i, j] = middle + by_pressure[3, i, j]
                sides[5, i, j] = middle + by_pressure[4, i, j]
            l3 = l2 = l1 = zero
            if i > 3:
                l3 = c3 * bands[3, i - 3, j]
                c2 -= l3 * bands[4, i - 3, j]
            if i > 2:
                l2 = c2 * bands[3, i - 2, j]
                c1 -= l2 * bands[4, i - 2, j]
            if i > 1:
                l1 = c1 * bands[3, i - 1, j]
                c0 -= l1 * bands[4, i - 1, j]
            bands[0, i, j], bands[1, i, j], bands[2, i, j] = l3, l2, l1
            bands[3, i, j] = one / c0
            bands[4, i, j] = zero if last else cp
            d1 = d0 = zero
            if contact[i, j]:
                d1, d0 = by_pressure[1, i, j], by_pressure[0, i, j]
                film_bands[2, i, j] = by_pressure[2, i, j]
            else:
                d0 = one
                film_bands[2, i, j] = zero
            l1 = zero
            if i > 1:
                l1 = d1 * film_bands[1, i - 1, j]
                d0 -= l1 * film_bands[2, i - 1, j]
            film_bands[0, i, j] = l1
            film_bands[1, i, j] = one / d0


@njit(cache=True, error_model='numpy')
def mirror(values: Array) -> None:
    """Fill the mirror column of a symmetric field."""
    for i in range(values.shape[0]):
        values[i, 0] = values[i, 2]


@njit(cache=True, error_model='numpy')
def solve_lines(
    bands: Array,
    sides: Array,
    rhs: Array,
    steps: int,
    started: bool,
    symmetric: bool,
    work: Array,
    value: Array,
) -> None:
    """Apply `steps` line-Jacobi steps to the total pressure, from `value` if started or zero."""
    nx, ny = rhs.shape
    pair = work[1]
    work = work[0]
    for step in range(steps):
        if step > 0 or started:
            for i in range(1, nx - 1):
                for j in range(1, ny - 1):
                    pair[i, j] = value[i, j - 1] + value[i, j + 1]
        for i in range(1, nx - 1):
            for j in range(1, ny - 1):
                work[i, j] = rhs[i, j]
            if step > 0 or started:
                for j in range(1, ny - 1):
                    work[i, j] -= (
                        sides[4, i, j] * value[i, j - 1]
                        + sides[5, i, j] * value[i, j + 1]
                        + sides[3, i, j] * pair[i + 1, j]
                        + sides[2, i, j] * pair[i - 1, j]
                    )
                if i > 2:
                    for j in range(1, ny - 1):
                        work[i, j] -= (
                            sides[1, i, j] * pair[i - 2, j] + sides[0, i, j] * pair[i - 3, j]
                        )
            if i > 3:
                for j in range(1, ny - 1):
                    work[i, j] -= (
                        bands[2, i, j] * work[i - 1, j]
                        + bands[1, i, j] * work[i - 2, j]
                        + bands[0, i, j] * work[i - 3, j]
                    )
            elif i == 3:
                for j in range(1, ny - 1):
                    work[i, j] -= bands[2, i, j] * work[i - 1, j] + bands[1, i, j] * work[i - 2, j]
            elif i == 2:
                for j in range(1, ny - 1):
                    work[i, j] -= bands[2, i, j] * work[i - 1, j]
        value[nx - 1] = 0
        for i in range(nx - 2, 0, -1):
            for j in range(1, ny - 1):
                value[i, j] = (work[i, j] - bands[4, i, j] * value[i + 1, j]) * bands[3, i, j]
        if symmetric:
            mirror(value)


@njit(cache=True, error_model='numpy')
def solve_film_lines(
    by_pressure: Array,
    film_bands: Array,
    contact: Mask,
    box: tuple[int, int, int, int],
    rhs: Array,
    total: Array,
    steps: int,
    symmetric: bool,
    work: Array,
    value: Array,
) -> None:
    """Solve for the film pressure [-] on contact nodes, in `box`; elsewhere it is the total."""
    nx, ny = rhs.shape
    first, end, left, right = box
    zero = rhs.dtype.type(0)
    work = work[0]
    for i in range(nx):
        for j in range(ny):
            value[i, j] = zero if contact[i, j] else total[i, j]
    for _ in range(steps):
        for i in range(first, end):
            for j in range(left, right):
                free = (
                    rhs[i, j]
                    - by_pressure[3, i, j] * value[i, j - 1]
                    - by_pressure[4, i, j] * value[i, j + 1]
                )
                work[i, j] = free if contact[i, j] else total[i, j]
            if i > first:
                for j in range(left, right):
                    work[i, j] -= film_bands[0, i, j] * work[i - 1, j]
        for i in range(end - 1, first - 1, -1):
            for j in range(left, right):
                value[i, j] = (work[i, j] - film_bands[2, i, j] * value[i + 1, j]) * film_bands[
                    1, i, j
                ]
        if symmetric:
            mirror(value)
