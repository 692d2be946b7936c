# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
The strip of raceway that rolls through a contact, as rows of heights on its grid.

Row r of the strip lies on node r of the grid when the march begins; after n nodes node i sees row
i - n. Rows are evaluated in blocks as they come in, so that a strip of any length costs the same.

"""

import numpy as np
from numpy.typing import NDArray
from surrogate.ehl.case import ScaledCase
from surrogate.ehl.grid import Grid
from surrogate.ehl.interface import RoughHeights
from surrogate.files import InputError

Array = NDArray[np.float64]
FRONT, RAMP = -1.2, 0.5
"""Where the rough material begins, and over which length it reaches its height [semi-axes]."""
BLOCK = 256
"""Rows that are evaluated together."""


class Feed:
    """Rows of a raceway that enters a smooth contact."""

    def __init__(
        self,
        *,
        case: ScaledCase,
        grid: Grid,
        place: tuple[float, float] = (0.0, 0.0),
        ramp: bool = True,
        side_slip: float = 0.0,
    ) -> None:
        """
        Begin with the rows that lie on the grid.

        `place` [m] is where on the raceway the middle of the contact's track lies, along it and
        across. With `side_slip` [-] it drifts sideways, against the oil by half as much as against
        the ball. With `ramp` the rough material enters from the inlet, else it is there from the
        start.

        """
        self.case, self.grid, self.place = case, grid, place
        self.ramp, self.side_slip = ramp, side_slip
        self._first = 0  # number of the first row that is kept
        self._rows = self._heights(0, grid.shape[0])

    def at(self, moved: int) -> Array:
        """Return the heights on the grid after the strip has moved on by so many nodes [-]."""
        nx = self.grid.shape[0]
        if self.side_slip:
            return self._heights(-moved, nx, 0.5 * self.side_slip * moved * self.grid.dx)
        while -moved < self._first:
            block = self._heights(self._first - BLOCK, BLOCK)
            self._rows = np.concatenate([block, self._rows[:nx]])
            self._first -= BLOCK
        start = -moved - self._first
        return self._rows[start:][:nx]

    def _heights(self, first: int, count: int, drift: float = 0.0) -> Array:
        """Return rows of the strip after a drift sideways, in Hertz units [-]."""
        case, grid = self.case, self.grid
        x = grid.x[0] + grid.dx * np.arange(first, first + count)
        rows = raceway_heights(
            case.roughness,
            x * case.semi_axis_x + self.place[0],
            (grid.y - drift) * case.semi_axis_x + self.place[1],
        )
        rows = rows / case.height_unit
        if self.ramp:
            share = np.clip((FRONT - x) / RAMP, 0.0, 1.0)
            rows = rows * (share * share * (3 - 2 * share))[:, None]
        return rows


def raceway_heights(raceway: RoughHeights | None, x: Array, y: Array) -> Array:
    """Return heights z(x, y) [m] on the grid of two axes [m]; raises InputError if not finite."""
    if not callable(raceway):
        raise InputError('raceway is not a function z(x, y): a strip has no end')
    heights = np.asarray(raceway(*np.meshgrid(x, y, indexing='ij')), dtype=float)
    if heights.shape != (x.size, y.size) or not np.isfinite(heights).all():
        raise InputError(
            f'raceway gives heights of shape {heights.shape} on a grid {(x.size, y.size)} or '
            'some that are not finite'
        )
    return heights
