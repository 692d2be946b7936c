# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Measured rough surfaces, with the same interface as the fractal ones.

A profile is continued unchanged in the direction that was not measured: one along the track stands
for a transverse lay, one across it for a longitudinal lay. Heights are positive out of the
material.

"""

from dataclasses import dataclass
import math
from typing import get_args, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.interpolate import make_interp_spline
from surrogate.files import InputError
from surrogate.raceway.patch import grid_axes, on_plane, Patch, Plane
from surrogate.raceway.stylus import low_pass

Array = NDArray[np.float64]
Outside = Literal['refuse', 'mirror']

FEWEST_POINTS = 16
"""Fewest points along a measured direction [-]."""


@dataclass(frozen=True, kw_only=True)
class MeasuredSurface:
    """
    Measured heights [m], centred, between whose points a cubic spline runs.

    `raw` heights [m], shape (nx, ny), one point along a direction that was not measured; spacings
    [m]; `shortest_wavelength` [m] is the cutoff of the filter, two spacings without one; `outside`
    the map: `refuse`, or `mirror`, which repeats the map with every second copy reversed. Plane,
    scale and patch as in `surrogate.raceway.patch.Raceway`. Nothing is ever extrapolated.

    """

    raw: Array
    spacing_x: float
    spacing_y: float
    shortest_wavelength: float
    source: str = ''
    outside: Outside = 'refuse'
    plane: Plane = (0.0, 0.0, 0.0)
    scale: float = 1.0
    patch: Patch | None = None

    @property
    def length_x(self) -> float:
        """Length along the track [m], infinite when measured only across it."""
        return (self.raw.shape[0] - 1) * self.spacing_x if self.raw.shape[0] > 1 else math.inf

    @property
    def length_y(self) -> float:
        """Length across the track [m], infinite when measured only along it."""
        return (self.raw.shape[1] - 1) * self.spacing_y if self.raw.shape[1] > 1 else math.inf

    def heights(self, x: ArrayLike, y: ArrayLike) -> Array:
        """Return heights [m], shape (nx, ny), on the grid of `x` and `y` [m] (see `grid_axes`)."""
        x, y = grid_axes(x, y)
        values = self._along(self.raw, x, self.spacing_x, 'x')
        values = self._along(values.T, y, self.spacing_y, 'y').T
        return np.asarray(self.scale * (values - on_plane(self.plane, x, y)))

    def _along(self, values: Array, places: Array, spacing: float, name: str) -> Array:
        """Interpolate along the first axis at `places` [m] from the centre."""
        last = len(values) - 1
        if last == 0:
            return np.repeat(values, len(places), axis=0)
        rows = places / spacing + last / 2
        if np.all((rows > -1e-6) & (rows < last + 1e-6)):  # beyond the edge by rounding
            rows = np.clip(rows, 0, last)
        elif self.outside == 'mirror':
            turn = np.mod(rows, 2 * last)
            rows = np.minimum(turn, 2 * last - turn)
        else:
            reach = float(np.max(np.abs(rows - last / 2)))
            raise InputError(
                f'{self.source}: the contact needs heights to {1e3 * reach * spacing:.4g} mm from '
                f'its centre along {name}, the map ends at {1e3 * last / 2 * spacing:.4g} mm: '
                'measure a larger area, make the domain smaller or allow the map to be mirrored'
            )
        return np.asarray(make_interp_spline(np.arange(last + 1), values, k=3)(rows))


def measured_surface(
    heights: ArrayLike,
    spacing_x: float,
    spacing_y: float,
    *,
    shortest_wavelength: float | None = None,
    outside: Outside = 'refuse',
    source: str = 'heights',
) -> MeasuredSurface:
    """
    Return the surface of heights [m], shape (nx, ny), sampled every spacing_x, spacing_y [m].

    One point along a direction means that it was not measured. `shortest_wavelength` [m] is the
    cutoff of a Gaussian filter (ISO 16610-21); without it the points are taken as they are.

    """
    raw = np.asarray(heights, dtype=float)
    if outside not in get_args(Outside):
        raise InputError(f'{source}: outside is {outside!r}, allowed is refuse or mirror')
    if raw.ndim != 2 or not any(points > 1 for points in raw.shape):
        raise InputError(f'{source}: {raw.size} points, allowed is {FEWEST_POINTS} or more')
    if any(1 < points < FEWEST_POINTS for points in raw.shape):
        raise InputError(
            f'{source}: {" x ".join(str(points) for points in raw.shape)} points, allowed is '
            f'{FEWEST_POINTS} or more along a measured direction'
        )
    missing = raw.size - int(np.isfinite(raw).sum())
    if missing:
        raise InputError(
            f'{source}: {missing} of {raw.size} heights are not finite numbers, allowed is 0: '
            'fill the gaps with the software of the instrument'
        )
    coarsest = max(
        gap for gap, points in zip((spacing_x, spacing_y), raw.shape, strict=True) if points > 1
    )
    finest = min(spacing_x, spacing_y)
    if not 0 < finest <= coarsest < math.inf:
        raise InputError(f'{source}: a spacing is {finest:g} m, allowed is above 0')
    if shortest_wavelength is not None:
        if shortest_wavelength < 2 * coarsest:
            raise InputError(
                f'{source}: shortest wavelength is {1e6 * shortest_wavelength:g} um, allowed is '
                f'two spacings of the points ({2e6 * coarsest:g} um) or more'
            )
        for axis, gap in enumerate((spacing_x, spacing_y)):
            raw = low_pass(raw, axis, shortest_wavelength / gap)
    return MeasuredSurface(
        raw=raw,
        spacing_x=spacing_x,
        spacing_y=spacing_y,
        shortest_wavelength=shortest_wavelength or 2 * coarsest,
        source=source,
        outside=outside,
    )
