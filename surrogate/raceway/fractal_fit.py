# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Identification of a fractal surface from measured profiles, by the structure function.

A straight line through the structure function in logarithms is biased, because a surface between
a longest and a shortest wave has no pure power law. The expected function of the very sum of waves
is fitted instead. One profile of 4 mm gives D within 0.03, 64 within 0.01 (standard deviation).

"""

from dataclasses import dataclass, replace
import math

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.optimize import minimize_scalar
from surrogate.files import InputError
from surrogate.raceway.fractal import (
    DIMENSIONS,
    Lay,
    PublishedRoughness,
    wave_directions,
    wave_spectrum,
)

Array = NDArray[np.float64]

LAGS = 24
"""Largest number of distances of a fit [-]."""
SHORTEST_LAG, LONGEST_LAG, LONGEST_SHARE = 0.25, 25.0, 0.1
"""Distances of a fit: from and to in shortest waves [-], at most this share of the profile [-]."""
GROUPS = 8
"""Largest number of groups of profiles of the error estimate [-]."""
FEWEST_POINTS = 64


@dataclass(frozen=True, kw_only=True, slots=True)
class FractalFit:
    """
    Fractal constants of measured profiles.

    Dimension D [-] of the surface and roughness G [m], with the standard error of D [-], from the
    scatter between groups of profiles (NaN for fewer than 4); `misfit`, rms difference of the
    logarithms of measured and fitted structure function [-]; distances of the fit [m]; number of
    profiles.

    """

    fractal_dimension: float
    fractal_roughness: float
    dimension_error: float
    misfit: float
    shortest_distance: float
    longest_distance: float
    profiles: int


def structure_function(heights: Array, lags: NDArray[np.int64]) -> Array:
    """Return the mean square height difference [m2] along the first axis at `lags` [samples]."""
    return np.array([np.mean((heights[lag:] - heights[:-lag]) ** 2, axis=0) for lag in lags])


def expected_structure_function(
    roughness: PublishedRoughness,
    distance: ArrayLike,
    *,
    lay: Lay = 'isotropic',
    across: bool = False,
) -> Array:
    """
    Return the structure function of the fractal surface [m2] at `distance` [m], mean over phases.

    S = sum over waves of a^2 [1 - cos(k distance c)], c the cosine of the wave's direction along
    x, its sine `across`.

    """
    number, amplitude = wave_spectrum(roughness)
    direction = wave_directions(roughness.ridges, lay)
    share = np.sin(direction) if across else np.cos(direction)
    turns = np.multiply.outer(np.asarray(distance, dtype=float), np.outer(number, share))
    return np.asarray(np.sum(amplitude[:, None] ** 2 * (1 - np.cos(turns)), axis=(-2, -1)))


def identify_fractal(
    profiles: ArrayLike,
    spacing: float,
    roughness: PublishedRoughness,
    *,
    lay: Lay = 'isotropic',
    across: bool = False,
) -> FractalFit:
    """
    Fit D [-] and G [m] to profiles [m] sampled every `spacing` [m] along the first axis.

    One profile or many side by side, measured along x, or along y if `across`. Shortest
    wavelength, sample length, scale ratio and ridges are those of `roughness`. Each profile is
    levelled by its straight line first. Under a lay take the profiles far apart along it, since
    neighbours tell the same.

    """
    heights = _levelled(profiles, spacing)
    lags = _lags(len(heights), roughness.shortest_wavelength / spacing)
    measured = structure_function(heights, lags)
    unit = replace(roughness, fractal_roughness=1e-9)

    def gap(dimension: float, found: Array) -> Array:
        expected = expected_structure_function(
            replace(unit, fractal_dimension=dimension), lags * spacing, lay=lay, across=across
        )
        return np.asarray(np.log(found) - np.log(expected))

    def fit(found: Array) -> float:
        # S is proportional to G^(2(D-2)), so the mean gap gives G and its variance is left to D.
        best = minimize_scalar(
            lambda dimension: np.var(gap(dimension, found)),
            bounds=DIMENSIONS,
            method='bounded',
            options={'xatol': 1e-6},
        )
        return float(best.x)

    mean = measured.mean(axis=1)
    dimension = fit(mean)
    rest = gap(dimension, mean)
    left_out = [fit(group) for group in _left_out(measured)]
    return FractalFit(
        fractal_dimension=dimension,
        fractal_roughness=1e-9 * math.exp(float(rest.mean()) / (2 * (dimension - 2))),
        dimension_error=math.sqrt((len(left_out) - 1) * float(np.var(left_out)))
        if left_out
        else math.nan,
        misfit=float(np.std(rest)),
        shortest_distance=float(lags[0] * spacing),
        longest_distance=float(lags[-1] * spacing),
        profiles=heights.shape[1],
    )


def _levelled(profiles: ArrayLike, spacing: float) -> Array:
    """Return profiles as columns, each less its straight line; raises InputError."""
    heights = np.asarray(profiles, dtype=float)
    heights = heights[:, None] if heights.ndim == 1 else heights
    if not 0 < spacing < math.inf:
        raise InputError(f'profile: spacing is {spacing:g} m, allowed is above 0')
    if heights.ndim != 2 or len(heights) < FEWEST_POINTS:
        raise InputError(
            f'profile: {len(heights)} points, allowed is {FEWEST_POINTS} or more along the first '
            'axis of one or two dimensions'
        )
    if not np.isfinite(heights).all():
        raise InputError('profile: a height is not a finite number')
    place = np.linspace(-1, 1, len(heights))[:, None]
    slope = (place * heights).sum(axis=0) / (place**2).sum()
    levelled = heights - heights.mean(axis=0) - slope * place
    if np.any(np.ptp(levelled, axis=0) <= 1e-9 * np.abs(heights).max()):
        raise InputError('profile: it is flat, so that it has no fractal dimension')
    return np.asarray(levelled)


def _lags(points: int, wave: float) -> NDArray[np.int64]:
    """Return the distances of a fit [samples]; `wave` is the shortest wavelength [samples]."""
    low, high = max(1.0, SHORTEST_LAG * wave), min(LONGEST_LAG * wave, LONGEST_SHARE * points)
    if wave < 2 or high < 4 * low:
        raise InputError(
            f'profile: {points} points at {wave:.3g} per shortest wavelength, allowed is 2 or '
            f'more per wavelength and a length of {4 * SHORTEST_LAG / LONGEST_SHARE:g} of them'
        )
    return np.unique(np.geomspace(low, high, LAGS).astype(np.int64))


def _left_out(measured: Array) -> list[Array]:
    """Return mean structure functions, each without one group of neighbouring profiles."""
    count = measured.shape[1]
    groups = min(GROUPS, count)
    label = np.arange(count) * groups // count
    return [measured[:, label != one].mean(axis=1) for one in range(groups)] if count >= 4 else []
