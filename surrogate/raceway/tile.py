# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Tile of a raceway that repeats along and across the track, as heights on a grid.

A tile can be pressed by Fourier transforms, and rolls through a contact turn after turn, so that
every speed sees the same material.

"""

from dataclasses import dataclass, replace
from functools import cached_property
import math

import numpy as np
from numpy.typing import NDArray
from scipy.fft import ifft2, irfft2, rfft2
from scipy.ndimage import map_coordinates, spline_filter
from surrogate.raceway.scaling import draw_raceway, ScaledSpectrum

Array = NDArray[np.float64]
SAME = 1e-3
"""Relative difference of a wavelength from the shortest one that is still on a tile [-]."""


@dataclass(frozen=True, kw_only=True)
class Tile:
    """Heights [m], shape (nx, ny), positive out of the material; length and width [m]."""

    heights: Array
    length: float
    width: float

    @cached_property
    def wave_vectors(self) -> tuple[Array, Array]:
        """Wave numbers along and across the track [rad/m] of the real transform, broadcast."""
        nx, ny = self.heights.shape
        along = 2 * math.pi * np.fft.fftfreq(nx, self.length / nx)
        across = 2 * math.pi * np.fft.rfftfreq(ny, self.width / ny)
        return along[:, None], across[None, :]

    @cached_property
    def wave_number(self) -> Array:
        """Magnitude of the wave vectors [rad/m]."""
        return np.asarray(np.hypot(*self.wave_vectors))

    def filtered(self, factor: Array) -> 'Tile':
        """Return the tile with its transform multiplied by a real factor [-], its mean 0."""
        transform = rfft2(self.heights) * factor
        transform[0, 0] = 0.0
        return replace(self, heights=irfft2(transform, s=self.heights.shape))

    def moment(self, order: int) -> float:
        """Return the mean square of a derivative of that order [m^(2 - 2 order)]; 0: heights."""
        power = np.abs(rfft2(self.heights)) ** 2 * self.wave_number ** (2 * order)
        # All columns of the real transform but the first and the last stand for two.
        twice = np.full(power.shape[1], 2.0)
        twice[0] = 1.0
        if self.heights.shape[1] % 2 == 0:
            twice[-1] = 1.0
        power[0, 0] = 0.0 if order == 0 else power[0, 0]
        return float((power @ twice).sum()) / self.heights.size**2

    @cached_property
    def _spline(self) -> Array:
        return np.asarray(spline_filter(self.heights, order=3, mode='grid-wrap'))

    def height_at(self, x: Array, y: Array) -> Array:
        """Return heights [m] at places [m] of one shape, by a cubic spline that repeats."""
        nx, ny = self.heights.shape
        place = np.array(np.broadcast_arrays(x / self.length * nx, y / self.width * ny))
        found = map_coordinates(
            self._spline, place.reshape(2, -1), order=3, mode='grid-wrap', prefilter=False
        )
        return np.asarray(found.reshape(place.shape[1:]))


def draw_tile(
    waves: ScaledSpectrum,
    seed: int,
    *,
    size: tuple[float, float],
    shape: tuple[int, int],
    shortest: float = 0.0,
    field: int = 0,
) -> Tile:
    """
    Return a tile of `size` [m] of one draw, its waves not shorter than `shortest` [m].

    Wave vectors move to the nearest multiples of 2 pi over length and width; waves that become
    constant, longer than about twice the tile, are lost. `seed` and `field` as `draw_raceway`.

    """
    drawn = draw_raceway(waves, seed, field=field)
    along, across = drawn.wave_number_x, drawn.wave_number_y
    row, column = (
        np.round(number * side / (2 * math.pi)).astype(int)
        for number, side in zip((along, across), size, strict=True)
    )
    length = 2 * math.pi / np.hypot(along, across)
    kept = (length > shortest * (1 - SAME)) & ((row != 0) | (column != 0))
    transform = np.zeros(shape, dtype=complex)
    wave = drawn.amplitude * np.exp(1j * drawn.phase)
    np.add.at(transform, (row[kept] % shape[0], column[kept] % shape[1]), wave[kept])
    heights = -np.real(ifft2(transform)) * transform.size
    return Tile(heights=heights, length=size[0], width=size[1])
