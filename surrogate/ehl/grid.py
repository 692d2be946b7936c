# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Grids of one contact in Hertz units, and the transfer of states between them.

Lengths along x and y over the semi-axis a along x, heights over a^2/Rx, pressures over the Hertz
pressure. A symmetric grid holds the half y >= 0 in columns 1 on and the mirror image of column 2
in column 0.

"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import DTypeLike, NDArray
from scipy.ndimage import map_coordinates
from surrogate.ehl.half_space import HalfSpace, make_half_space, repeat
from surrogate.ehl.kernels.level import make_workspace, Workspace

Array = NDArray[np.float64]
KRYLOV_TYPE = np.float32
"""Precision of the linear solver; residuals are always in double precision."""
KRYLOV_LIMIT = 120
"""Most iterations of one linear solve [-]."""
LEVELS = 4
"""Most grids of one linear solve, the finest included [-]."""
COARSE_ROWS, COARSE_COLUMNS = 33, 10
"""Least nodes along x and array columns of a coarser grid of the linear solver [-]."""
SHORTEST_CELL, LONGEST_CELL = 0.5, 6.0
"""Least and largest dy over dx of a grid with a coarser one: else lines along x do better [-]."""


@dataclass(frozen=True, kw_only=True)
class Grid:
    """
    Nodes x (nx) and y (array columns, mirror column or copies included), elastic scale.

    A periodic grid repeats its columns 1 to the last but one for ever across the track.

    """

    x: Array
    y: Array
    symmetric: bool
    compliance: float
    periodic: bool = False

    @property
    def dx(self) -> float:
        """Node distance along x."""
        return float(self.x[1] - self.x[0])

    @property
    def dy(self) -> float:
        """Node distance along y."""
        return float(self.y[1] - self.y[0])

    @property
    def aspect(self) -> float:
        """Square of the node distance along x over that along y."""
        return (self.dx / self.dy) ** 2

    @property
    def shape(self) -> tuple[int, int]:
        """Shape of an array."""
        return self.x.size, self.y.size

    @cached_property
    def weights(self) -> Array:
        """Area that a node of each column stands for, mirror images included."""
        weights = np.full(self.y.size, self.dx * self.dy)
        if self.symmetric:
            weights[2:] *= 2
            weights[0] = 0
        if self.periodic:
            weights[[0, -1]] = 0
        return weights

    @cached_property
    def space(self) -> HalfSpace:
        """Half-space in double precision."""
        return self._half_space(np.float64)

    @cached_property
    def krylov_space(self) -> HalfSpace:
        """Half-space in the precision of the linear solver."""
        return self._half_space(KRYLOV_TYPE)

    def _half_space(self, dtype: DTypeLike) -> HalfSpace:
        return make_half_space(
            *self.shape,
            self.dx,
            self.dy,
            symmetric=self.symmetric,
            periodic=self.periodic,
            scale=self.compliance,
            dtype=dtype,
        )

    @cached_property
    def workspace(self) -> Workspace:
        """Arrays of the linear solver."""
        return make_workspace(*self.shape, KRYLOV_LIMIT, self.coarser is not None, KRYLOV_TYPE)

    @cached_property
    def coarser(self) -> 'Grid | None':
        """Grid with half the intervals for the linear solver, where there is use of it."""
        nx, ny = self.shape
        even = self.symmetric and nx % 2 == 1 and ny % 2 == 0
        large = nx // 2 + 1 >= COARSE_ROWS and ny // 2 + 1 >= COARSE_COLUMNS
        if not (even and large and SHORTEST_CELL < self.dy / self.dx < LONGEST_CELL):
            return None
        y = np.concatenate([[-2 * self.dy], self.y[1::2]])
        return Grid(x=self.x[::2], y=y, symmetric=True, compliance=self.compliance)

    @cached_property
    def stiffness(self) -> float:
        """Short-wave deflection under unit pressure: the scale between pressures and gaps."""
        return float(self.space.near[0])

    def integral(self, field: Array) -> float:
        """Integrate a field."""
        return float(field.sum(axis=0) @ self.weights)


def make_grid(
    nx: int, ny: int, domain: tuple[float, float, float], *, symmetric: bool, compliance: float
) -> Grid:
    """
    Return nx by ny nodes on [x_in, x_out] x [-y_side, y_side], all over the semi-axis a.

    ny counts the nodes of the full width and is odd when symmetric.

    """
    x_in, x_out, side = domain
    x, y = np.linspace(x_in, x_out, nx), np.linspace(-side, side, ny)
    first = ny // 2 - 1
    return Grid(x=x, y=y[first:] if symmetric else y, symmetric=symmetric, compliance=compliance)


def make_strip_grid(
    nx: int, columns: int, ends: tuple[float, float], width: float, compliance: float
) -> Grid:
    """
    Return nx nodes from inlet to outlet and `columns` across a `width`, all over the semi-axis a.

    The strip repeats across the track; `columns` is 3^n * 2^k with k at least 2.

    """
    dy = width / columns
    y = np.asarray((np.arange(columns + 2) - 0.5 * (columns + 1)) * dy)
    x = np.linspace(*ends, nx)
    return Grid(x=x, y=y, symmetric=False, compliance=compliance, periodic=True)


@dataclass(frozen=True, kw_only=True, slots=True)
class GridState:
    """Film and asperity pressure and approach, in Hertz units [-]."""

    film_pressure: Array
    asperity_pressure: Array
    approach: float


def transfer(state: GridState, old: Grid, new: Grid) -> GridState:
    """Interpolate a state bilinearly; zero outside the old grid."""
    return GridState(
        film_pressure=_resample(state.film_pressure, old, new),
        asperity_pressure=_resample(state.asperity_pressure, old, new),
        approach=state.approach,
    )


def _resample(field: Array, old: Grid, new: Grid) -> Array:
    y = np.abs(new.y) if old.symmetric else new.y
    rows, columns = (new.x - old.x[0]) / old.dx, (y - old.y[0]) / old.dy
    places = np.stack(np.meshgrid(rows, columns, indexing='ij'))
    values = np.asarray(map_coordinates(field, places, order=1, mode='constant', cval=0.0))
    values[0] = values[-1] = 0.0
    if new.periodic:
        repeat(values)
        return values
    values[:, -1] = 0.0
    if not new.symmetric:
        values[:, 0] = 0.0
    return values
