# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Readings of a stylus instrument: Gaussian profile filters, height and slope of waves in a trace.

A roughness number is that of a profile between two cut-offs, not that of an area. A plane wave of
wave number q whose direction is at the angle t to the trace is read as one of q cos t. The stylus
is taken as a point, so that its radius filters nothing.

"""

from dataclasses import dataclass
import math

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.ndimage import gaussian_filter1d
from scipy.special import i0e, i1e
from surrogate.raceway.standards import ProfileBand

Array = NDArray[np.float64]

GAUSSIAN_ALPHA = math.sqrt(math.log(2) / math.pi)
"""Constant of the Gaussian profile filter, ISO 16610-21: half passes at the cut-off [-]."""
KERNEL = 4.0
"""Where the weights of a filter end, over their standard deviation [-]; 6e-5 lies beyond."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Reading:
    """
    What a stylus reads of waves, one value for each wave.

    Mean square height of the profile over that of the wave [-], `height`; mean square slope of the
    profile over the mean square height of the wave [1/m2], `slope`.

    """

    height: Array
    slope: Array


def gaussian_transmission(wave_number: ArrayLike, cutoff: float) -> Array:
    """
    Return the amplitude [-] that a Gaussian low-pass leaves of waves [rad/m]; `cutoff` [m].

    exp(-pi (alpha cutoff/lambda)^2), alpha = sqrt(ln 2/pi): ISO 16610-21.

    """
    return np.asarray(np.exp(-_weakening(cutoff) * np.asarray(wave_number, dtype=float) ** 2))


def band_transmission(wave_number: ArrayLike, band: ProfileBand) -> Array:
    """Return the amplitude [-] that both filters leave of waves [rad/m] along the trace."""
    short = gaussian_transmission(wave_number, band.cutoff_short)
    return np.asarray(short * (1 - gaussian_transmission(wave_number, band.cutoff_long)))


def read_waves(wave_number: ArrayLike, band: ProfileBand) -> Reading:
    """Return what is read of waves of that wave number [rad/m] along the trace, q cos t."""
    number = np.asarray(wave_number, dtype=float)
    height = band_transmission(number, band) ** 2
    return Reading(height=height, slope=number**2 * height)


def read_all_directions(wave_number: ArrayLike, band: ProfileBand) -> Reading:
    """
    Return what is read of waves [rad/m], the mean over all directions of the trace.

    The square of the transmission is a sum of exp(-b cos^2 t), whose mean is exp(-b/2) I0(b/2);
    that of cos^2 t exp(-b cos^2 t) is exp(-b/2) [I0(b/2) - I1(b/2)]/2, Abramowitz and Stegun
    9.6.16 and 9.6.19.

    """
    square = np.asarray(wave_number, dtype=float) ** 2
    short, long = _weakening(band.cutoff_short), _weakening(band.cutoff_long)
    # The rates [m2] of the three exponentials in the square of the transmission.
    half = [square * (2 * short + count * long) / 2 for count in (0, 1, 2)]
    height = sum(sign * i0e(one) for sign, one in zip((1.0, -2.0, 1.0), half, strict=True))
    slope = sum(
        sign * (i0e(one) - i1e(one)) for sign, one in zip((1.0, -2.0, 1.0), half, strict=True)
    )
    return Reading(height=np.asarray(height), slope=np.asarray(0.5 * square * slope))


def _weakening(cutoff: float) -> float:
    """Return pi (alpha cutoff/(2 pi))^2 [m2], the exponent over the wave number squared."""
    return math.pi * (GAUSSIAN_ALPHA * cutoff / (2 * math.pi)) ** 2


def low_pass(heights: Array, axis: int, cutoff: float) -> Array:
    """Return heights through the Gaussian filter; `cutoff` in samples, ends mirrored."""
    if heights.shape[axis] == 1:
        return heights
    deviation = GAUSSIAN_ALPHA * cutoff / math.sqrt(2 * math.pi)
    return np.asarray(
        gaussian_filter1d(heights, deviation, axis=axis, mode='mirror', truncate=KERNEL)
    )
