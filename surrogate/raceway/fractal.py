# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Fractal raceways in metres, drawn from a seed.

A surface is a fixed sum of plane waves, so that one draw is the same whatever load, speed, grid or
domain looks at it. Its shortest wavelength never follows a grid. Heights are positive out of the
material.

"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
import math
from typing import get_args, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray
from surrogate.files import InputError
from surrogate.files.datasheet import Checked, count, quantity
from surrogate.raceway.patch import grid_axes, on_plane, Patch, Plane

Array = NDArray[np.float64]
Lay = Literal['isotropic', 'longitudinal', 'transverse']

DIMENSIONS = (2.01, 2.99)
"""Range of the fractal dimension [-]."""
LAY_SPREAD = math.radians(20.0)
"""Range of wave directions of a surface with a lay [rad]."""


@dataclass(frozen=True, kw_only=True, slots=True)
class PublishedRoughness(Checked):
    """
    Constants of a generated surface, by default those published for the nominal screw.

    Rq `rms` [m] to which a patch is rescaled; fractal dimension D [-], fractal roughness G [m],
    sample length L and shortest wavelength Ls [m], scale ratio g and ridges M [-]. Published are
    Rq, D and G; L is the length at which the sum has this Rq; Ls, g and M are assumed.

    """

    rms: float = quantity('um', 1e-6, 0.001, 10.0, default=0.12e-6)
    fractal_dimension: float = quantity('', 1.0, *DIMENSIONS, default=2.68)
    fractal_roughness: float = quantity('nm', 1e-9, 1e-6, 1e3, default=0.97e-9)
    sample_length: float = quantity('mm', 1e-3, 0.01, 100.0, default=4e-3)
    shortest_wavelength: float = quantity('um', 1e-6, 0.1, 1000.0, default=8e-6)
    scale_ratio: float = quantity('', 1.0, 1.01, 10.0, default=1.5)
    ridges: int = count(1, 1000, default=10)


@dataclass(frozen=True, kw_only=True)
class FractalSurface:
    """
    Sum of plane waves less a plane: z = scale (sum a [cos phi - cos(kx x + ky y + phi)] - plane).

    Amplitudes [m], wave numbers [rad/m], phases [rad]; plane, scale, patch as in `Raceway`.

    """

    amplitude: Array
    wave_number_x: Array
    wave_number_y: Array
    phase: Array
    plane: Plane = (0.0, 0.0, 0.0)
    scale: float = 1.0
    patch: Patch | None = None

    @property
    def shortest_wavelength(self) -> float:
        """Shortest wavelength of the sum [m]."""
        return float(2 * math.pi / np.max(np.hypot(self.wave_number_x, self.wave_number_y)))

    def heights(self, x: ArrayLike, y: ArrayLike) -> Array:
        """Return heights [m], shape (nx, ny), on the grid of `x` and `y` [m] (see `grid_axes`)."""
        x, y = grid_axes(x, y)
        along = np.exp(1j * np.outer(x, self.wave_number_x))
        across = np.exp(1j * np.outer(self.wave_number_y, y))
        weight = self.amplitude * np.exp(1j * self.phase)
        waves = np.sum(weight.real) - ((along * weight) @ across).real
        return np.asarray(self.scale * (waves - on_plane(self.plane, x, y)))


def fractal_surface(
    roughness: PublishedRoughness, seed: int, *, lay: Lay = 'isotropic'
) -> FractalSurface:
    """
    Return one draw of the Weierstrass-Mandelbrot surface, its phases [rad] from `seed`.

    z = L (G/L)^(D-2) sqrt(ln g / M) sum_m sum_n g^((D-3)n) {cos phi_mn - cos[2 pi g^n r/L
    cos(theta - pi m/M) + phi_mn]}, n to int(log(L/Ls)/log g): Yan, Komvopoulos, J. Appl. Phys. 84
    (1998) 3617. A lay puts the M directions into a fan. A smaller Ls adds waves and changes none.

    """
    number, amplitude = wave_spectrum(roughness)
    return wave_sum(number, amplitude, wave_directions(roughness.ridges, lay), seed)


def wave_sum(
    number: Array, amplitude: Array, direction: Array, seed: int | Sequence[int]
) -> FractalSurface:
    """
    Return one draw of a sum of waves in all `direction` [rad] at each wave number [rad/m].

    `amplitude` [m] is that of one wave at each wave number; phases [rad] from `seed`, long waves
    first, so that adding shorter ones changes none.

    """
    phase = np.random.default_rng(seed).uniform(0, 2 * math.pi, (len(number), len(direction)))
    return FractalSurface(
        amplitude=np.repeat(amplitude, len(direction)),
        wave_number_x=np.outer(number, np.cos(direction)).ravel(),
        wave_number_y=np.outer(number, np.sin(direction)).ravel(),
        phase=phase.ravel(),
    )


def wave_spectrum(roughness: PublishedRoughness) -> tuple[Array, Array]:
    """Return wave numbers [rad/m] and the amplitude of one wave at each [m]."""
    g, length = roughness.scale_ratio, roughness.sample_length
    shortest = roughness.shortest_wavelength
    if not shortest < length:
        raise InputError(
            f'roughness: shortest wavelength is {1e6 * shortest:g} um, allowed is less than the '
            f'sample length ({1e6 * length:g} um)'
        )
    order = wave_orders(length, shortest, g)
    dimension = roughness.fractal_dimension
    height = length * (roughness.fractal_roughness / length) ** (dimension - 2)
    one_ridge = math.sqrt(math.log(g) / roughness.ridges)
    number = np.asarray(2 * math.pi / length * g**order)
    return number, height * one_ridge * g ** ((dimension - 3) * order)


def wave_orders(longest: float, shortest: float, ratio: float) -> NDArray[np.int64]:
    """Return 0, 1, ... of the waves from `longest` down to `shortest` [m] in steps of `ratio`."""
    # The rounding of a logarithm must not cost the last wave.
    return np.arange(int(math.log(longest / shortest) / math.log(ratio) + 1e-9) + 1)


def wave_directions(ridges: int, lay: Lay, fan: float = LAY_SPREAD) -> Array:
    """
    Return the directions of the waves [rad]; a lay along x has its waves along y.

    `fan` is the angle [rad] over which those of a lay spread; isotropic ones have none.

    """
    if lay not in get_args(Lay):
        raise InputError(f'lay is {lay!r}, allowed is isotropic, longitudinal or transverse')
    if lay == 'isotropic':
        return math.pi * np.arange(1, ridges + 1) / ridges
    centre = 0.5 * math.pi if lay == 'longitudinal' else 0.0
    return centre + fan * (np.arange(ridges) - 0.5 * (ridges - 1)) / max(ridges - 1, 1)


def shifted(surface: FractalSurface, x: float, y: float) -> FractalSurface:
    """Return the surface with its place (x, y) [m] moved to the contact centre."""
    phase = surface.phase + surface.wave_number_x * x + surface.wave_number_y * y
    lift = float(np.sum(surface.amplitude * (np.cos(surface.phase) - np.cos(phase))))
    offset, slope_x, slope_y = surface.plane
    offset += slope_x * x + slope_y * y - lift
    return replace(surface, phase=phase, plane=(offset, slope_x, slope_y))
