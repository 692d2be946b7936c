# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Transfer between a symmetric grid and that with half the intervals; compiled.

Fine row 2i and fine column 2j - 1 are the coarse row i and column j; column 0 of both is the
mirror image of column 2.

"""

from typing import TypeVar

import numpy as np
from numpy.typing import NDArray
from surrogate.compiler import njit
from surrogate.ehl.kernels.line import mirror

Array = NDArray[np.floating]
Kind = TypeVar('Kind', bound=np.generic)


def inject(field: NDArray[Kind]) -> NDArray[Kind]:
    """Take the values on the coarse nodes."""
    nx, ny = field.shape
    coarse = np.empty((nx // 2 + 1, ny // 2 + 1), field.dtype)
    coarse[:, 1:] = field[::2, 1::2]
    coarse[:, 0] = coarse[:, 2]
    return coarse


@njit(cache=True, error_model='numpy')
def restrict(fine: Array, sizes: Array, sizes_coarse: Array, coarse: Array) -> None:
    """
    Average the Reynolds rows of nine nodes, weighted 1 2 1 along x and y.

    Rows stand for the node distance times the equation, divided by their sizes [-]: zero sizes
    take a row out. The border and the mirror column are zero.

    """
    nx, ny = coarse.shape
    side, corner = coarse.dtype.type(0.5), coarse.dtype.type(0.25)
    coarse[:] = 0
    for i in range(1, nx - 1):
        for j in range(1, ny - 1):
            if sizes_coarse[i, j] == 0:
                continue
            total = coarse.dtype.type(0)
            for a in range(2 * i - 1, 2 * i + 2):
                east, middle = 2 * j, 2 * j - 1
                west = middle - 1 if j > 1 else east
                row = side * fine[a, middle] * sizes[a, middle] + corner * (
                    fine[a, west] * sizes[a, west] + fine[a, east] * sizes[a, east]
                )
                total += row if a == 2 * i else side * row
            coarse[i, j] = total / sizes_coarse[i, j]


@njit(cache=True, error_model='numpy')
def prolong(coarse: Array, fine: Array) -> None:
    """Interpolate bilinearly, mirror column included."""
    nx, ny = coarse.shape
    half = coarse.dtype.type(0.5)
    for i in range(nx):
        for j in range(1, ny):
            fine[2 * i, 2 * j - 1] = coarse[i, j]
        for j in range(1, ny - 1):
            fine[2 * i, 2 * j] = half * (coarse[i, j] + coarse[i, j + 1])
    for i in range(1, fine.shape[0], 2):
        for j in range(1, fine.shape[1]):
            fine[i, j] = half * (fine[i - 1, j] + fine[i + 1, j])
    mirror(fine)
