# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Acting height of a raceway: how far the roughness that a rolling contact leaves keeps a flat off.

A rolling contact flattens long waves and keeps short ones. What it leaves of a tile is pressed dry
on a flat by a small share of the load, and the mean gap is the height that the film has to bridge.
It depends on two numbers, the reduction and the Hertz pressure, and is tabulated over both.

A wave whose ridges run along the track lets the oil out sideways, so that it is flattened as a
longer wave across it. An isotropic raceway has waves of all directions. One with a lay has those
of one direction, whose flattening is part of the constants that were fitted to lays.

"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
import math

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.fft import rfft2
from scipy.interpolate import RectBivariateSpline
from surrogate.formulas.line import amplitude_reduction_venner_1997
from surrogate.raceway.dry_contact import press
from surrogate.raceway.tile import Tile

Array = NDArray[np.float64]
LOAD_SHARE = 0.015
"""Share of the Hertz load that presses what a contact leaves on the flat [-]."""
WAVE_POWER = -0.22
"""Exponent of the mean wavelength in the acting height [-]: that of the film floor reversed."""
UNCUT, RIDGE_POWER = 1.85, -0.72
"""Mean gap over the rms of heights whose summits are not cut, about, and the exponent of the ratio
to it in the acting height of ridges along the track [-]: oil leaves a plateau by grooves, so that
it touches earlier. Ridges across have the reverse, for they hold the oil."""
ALONG = 0.9
"""By how much of its length a wave along the track is flattened as a longer one [-]: single waves
at angles of 0 to 90 deg, marched with n of 0.5 to 12, see `test_topography.py`."""
HIGHER = 0.11
"""Logarithm of the acting height of an isotropic raceway over that by the constants of lays [-]:
73 strips, whose waves are flattened by their directions."""
ISOTROPIC = 0.2, 0.6
"""Anisotropy of slopes up to which a raceway is isotropic, and from which on it has a lay [-].
Tiles of isotropic raceways have 0.15 at most, a lay that fans over 90 deg has 0.64."""
REDUCTIONS = np.geomspace(0.03, 10.0, 8)
"""Reductions of the shortest wave at which heights are tabulated [-]."""
PRESSURES = np.geomspace(0.15e9, 3e9, 3)
"""Hertz pressures at which they are tabulated [Pa]."""
FLAT = 1e-12
"""Least gap [m]: what is pressed flat keeps no film off."""
TOLERANCE = 3e-3
"""Of the dry contacts, as `press` has it [-]."""
NODES_PER_WAVE = 4
"""Nodes of the dry contacts in the shortest wave [-]; half of those of a tile."""


@dataclass(frozen=True, kw_only=True, slots=True)
class ActingRoughness:
    """
    Table of the acting height of a raceway with its ball.

    Logarithms of the reduction per length [1/m] and of the Hertz pressure [Pa], and the logarithm
    of the acting height [m^0.78] over both, the mean of several tiles; `lay`, the anisotropy of
    the slopes from -1 across the track through 0 to 1 along it [-]; `cut`, the logarithm of the
    mean gap by the rms of what is left, over `UNCUT` [-], below 0 for plateaus; shortest wave [m].

    """

    log_reduction: tuple[float, ...]
    log_pressure: tuple[float, ...]
    log_height: tuple[tuple[float, ...], ...]
    lay: float
    cut: float
    shortest_wave: float

    def height(self, reduction: ArrayLike, pressure: ArrayLike) -> Array:
        """
        Return the acting height [m^0.78] for reductions [1/m] and Hertz pressures [Pa].

        By a spline in the logarithms. Beyond the table it keeps its value, but for large
        reductions, where it falls with their square as the amplitudes do.

        """
        x, y = np.log(reduction), np.log(pressure)
        low, high = self.log_reduction[0], self.log_reduction[-1]
        found = _spline(self).ev(
            np.clip(x, low, high), np.clip(y, self.log_pressure[0], self.log_pressure[-1])
        )
        return np.asarray(np.exp(found - 2 * np.maximum(x - high, 0.0)))


@lru_cache(maxsize=64)
def _spline(acting: ActingRoughness) -> RectBivariateSpline:
    heights = np.array(acting.log_height)
    return RectBivariateSpline(acting.log_reduction, acting.log_pressure, heights, kx=3, ky=2)


def acting_roughness(
    tiles: Sequence[Tile], modulus: float, shortest_wave: float
) -> ActingRoughness:
    """
    Return the table of some tiles of one raceway whose shortest wave [m] is on all of them.

    `modulus` [Pa] as `press` has it.

    """
    # Logarithms of what rolling leaves over reduction and pressure: mean gap, rms, mean wave [m].
    gaps = np.empty((len(tiles), len(REDUCTIONS), len(PRESSURES)))
    heights, waves = np.empty(gaps.shape[:2]), np.empty(gaps.shape[:2])
    lays = np.empty(len(tiles))
    for place, fine in enumerate(tiles):
        spacing = fine.length / fine.heights.shape[0]
        step = max(1, int(shortest_wave / (NODES_PER_WAVE * spacing) + 1e-9))
        tile = replace(fine, heights=fine.heights[::step, ::step])
        lays[place] = lay_of(tile)
        for row, reduction in enumerate(REDUCTIONS / shortest_wave):
            left = left_by_rolling(tile, float(reduction))
            square = left.moment(0)
            heights[place, row] = 0.5 * math.log(square)
            waves[place, row] = math.log(2 * math.pi * math.sqrt(square / left.moment(1)))
            for column, pressure in enumerate(PRESSURES):
                load = LOAD_SHARE * 0.25 * math.pi * float(pressure)
                pressed = press(left, modulus, load, tolerance=TOLERANCE)
                gaps[place, row, column] = math.log(max(pressed.separation, FLAT))
    cuts = gaps - heights[..., None] - math.log(UNCUT)
    power = RIDGE_POWER * lays
    each = gaps + WAVE_POWER * waves[..., None] + power[:, None, None] * cuts
    each += (HIGHER * isotropy(lays))[:, None, None]
    return ActingRoughness(
        log_reduction=tuple(np.log(REDUCTIONS / shortest_wave).tolist()),
        log_pressure=tuple(np.log(PRESSURES).tolist()),
        log_height=tuple(map(tuple, each.mean(axis=0).tolist())),
        lay=float(lays.mean()),
        cut=float(cuts[:, len(REDUCTIONS) // 2, len(PRESSURES) // 2].mean()),
        shortest_wave=shortest_wave,
    )


def left_by_rolling(tile: Tile, reduction: float) -> Tile:
    """
    Return what a rolling contact leaves of a tile, every wave reduced by its length.

    `reduction` M1^(3/4)/(L^(1/2) b) [1/m]. Waves of an isotropic tile are reduced by their
    directions, those of a lay as if they ran across the track.

    """
    number = tile.wave_number.copy()
    number[0, 0] = math.inf
    _, across = tile.wave_vectors
    length = 2 * math.pi / number
    length *= 1 + ALONG * isotropy(lay_of(tile)) * (across / number) ** 2
    return tile.filtered(amplitude_reduction_venner_1997(length, 1 / reduction, 1.0, 1.0))


def isotropy(lay: ArrayLike) -> Array:
    """Return 1 for the anisotropy of slopes of isotropic raceways, 0 for that of a lay [-]."""
    return np.asarray(np.interp(np.abs(lay), ISOTROPIC, (1.0, 0.0)))


def lay_of(tile: Tile) -> float:
    """Return the anisotropy of the slopes of a tile [-]: 1 ridges along the track, -1 across."""
    along, across = tile.wave_vectors
    power = np.abs(rfft2(tile.heights)) ** 2
    power[:, 1:] *= 2.0
    squares = power * along**2, power * across**2
    return float((squares[1] - squares[0]).sum() / (squares[1] + squares[0]).sum())
