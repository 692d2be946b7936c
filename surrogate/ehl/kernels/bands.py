# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Correction on bands of neighbouring lines, where the film is thick; compiled.

In front of and beside the contact Poiseuille flow evens out the pressure across the lines, which
line-Jacobi steps pass on by one line at a time. There `BAND` lines share one unknown per node
along x. The bands are coupled by the flow alone and solved directly, ordered by node along x and
then by band.

"""

import numpy as np
from numpy.typing import NDArray
from surrogate.compiler import njit

Array = NDArray[np.floating]
Mask = NDArray[np.bool_]

BAND = 8
"""Lines of a band."""
THICK = 0.03
"""Most that deflection may weigh against flow in a row for its film to count as thick [-]."""


def bands_across(ny: int) -> int:
    """Return the number of bands of a grid with `ny` array columns."""
    return -(-(ny - 2) // BAND)


@njit(cache=True, error_model='numpy')
def mark_thick_film(
    by_pressure: Array, by_gap: Array, contact: Mask, sizes: Array, near: Array, thick: Array
) -> bool:
    """Set 1 on nodes of thick film, without contact nor cavity, else 0 [-]; True if any is."""
    nx, ny = thick.shape
    stiffness, limit = near[0], near.dtype.type(THICK)
    zero, one = thick.dtype.type(0), thick.dtype.type(1)
    any_thick = False
    for i in range(1, nx - 1):
        for j in range(1, ny - 1):
            flow, lift = abs(by_pressure[0, i, j]), abs(by_gap[0, i, j]) * stiffness
            is_thick = sizes[i, j] > 0 and not contact[i, j] and lift < limit * flow
            thick[i, j] = one if is_thick else zero
            any_thick = any_thick or is_thick
    return any_thick


@njit(cache=True, error_model='numpy')
def factor_bands(by_pressure: Array, thick: Array, rows: Array, lower: Array) -> None:
    """
    Assemble and factor the equations of the bands, in Hertz units [-].

    Row k of `rows` holds columns k - count to k + count, after the factorisation the inverse pivot
    and the columns behind it; `lower` the factors of the rows below each pivot.

    """
    _assemble(by_pressure, thick, rows)
    size, count = lower.shape
    one, first = rows.dtype.type(1), count + 1
    for k in range(size):
        if rows[k, count] == 0:
            rows[k, count] = one
        pivot, ahead = one / rows[k, count], rows[k, first:]
        rows[k, count] = pivot
        for below in range(1, min(count, size - 1 - k) + 1):
            factor = rows[k + below, count - below] * pivot
            lower[k, below - 1] = factor
            if factor != 0:
                start, end = first - below, first - below + count
                under = rows[k + below, start:end]
                for n in range(count):
                    under[n] -= factor * ahead[n]


@njit(cache=True, error_model='numpy')
def _assemble(by_pressure: Array, thick: Array, rows: Array) -> None:
    """
    Sum up the rows of each band, with columns beside it one band apart.

    Those two nodes away join the next ones. A step to the next band is `BAND` times as long as one
    to the next line. What a periodic grid has beyond its sides counts to the outer bands.

    """
    nx, ny = thick.shape
    count = rows.shape[1] // 2
    rows[:] = 0
    share = rows.dtype.type(1.0 / BAND)
    rest = rows.dtype.type(1.0 - 1.0 / BAND)
    for i in range(1, nx - 1):
        for j in range(1, ny - 1):
            if thick[i, j] == 0:
                continue
            band = (j - 1) // BAND
            row = rows[i * count + band]
            west = by_pressure[1, i, j] + by_pressure[5, i, j]
            south = by_pressure[3, i, j] * thick[i, j - 1]
            north = by_pressure[4, i, j] * thick[i, j + 1]
            row[0] += west * thick[i - 1, j]
            row[count] += by_pressure[0, i, j]
            row[2 * count] += by_pressure[2, i, j] * thick[i + 1, j]
            if (j - 1) % BAND > 0 or j == 1:
                row[count] += south
            else:
                row[count] += rest * south
                row[count - 1] += share * south
            if j % BAND > 0 or j == ny - 2:
                row[count] += north
            else:
                row[count] += rest * north
                row[count + 1] += share * north


@njit(cache=True, error_model='numpy', fastmath={'reassoc', 'contract', 'nsz'})
def solve_bands(
    rows: Array, lower: Array, thick: Array, rhs: Array, bands: Array, value: Array
) -> None:
    """Solve for the bands and hand the answer [-] to the nodes of thick film; else zero."""
    nx, ny = thick.shape
    size, count = lower.shape
    behind = count + 1
    bands[:] = 0
    for i in range(1, nx - 1):
        for band in range(count):
            first, last = 1 + band * BAND, min(1 + (band + 1) * BAND, ny - 1)
            here, known = thick[i, first:last], rhs[i, first:last]
            total = bands.dtype.type(0)
            for n in range(here.size):
                total += here[n] * known[n]
            bands[i * count + band] = total
    for k in range(size):
        first, last = k + 1, k + 1 + count
        known, below, factors = bands[k], bands[first:last], lower[k]
        for n in range(count):
            below[n] -= factors[n] * known
    for k in range(size - 1, -1, -1):
        first, last = k + 1, k + 1 + count
        total, ahead, row = bands[k], bands[first:last], rows[k, behind:]
        for n in range(count):
            total -= row[n] * ahead[n]
        bands[k] = total * rows[k, count]
    for i in range(1, nx - 1):
        for band in range(count):
            first, last = 1 + band * BAND, min(1 + (band + 1) * BAND, ny - 1)
            lift = bands[i * count + band]
            for j in range(first, last):
                value[i, j] = thick[i, j] * lift
