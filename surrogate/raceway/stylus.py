# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Readings of a stylus instrument: Gaussian profile filters, Rq and Rdq of a trace.

A roughness number is that of a profile between two cut-offs, not that of an area. A plane wave of
wave number q whose direction is at the angle t to the trace is read as one of q cos t. The stylus
is taken as a point, so that its radius filters nothing.

"""

from collections.abc import Iterable
from dataclasses import dataclass
import math

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.ndimage import gaussian_filter1d
from scipy.special import i0e, i1e
from surrogate.files import InputError
from surrogate.raceway.standards import ProfileBand

Array = NDArray[np.float64]

GAUSSIAN_ALPHA = math.sqrt(math.log(2) / math.pi)
"""Constant of the Gaussian profile filter, ISO 16610-21: half passes at the cut-off [-]."""
KERNEL = 4.0
"""Where the weights of a filter end, over their standard deviation [-]; 6e-5 lies beyond."""
FINEST_CUTOFF = 4.0
"""Least cut-off over the spacing of a profile [-]: its sampled weights are then exact to 2e-5."""
DERIVATIVE = np.array([-1.0, 9.0, -45.0, 0.0, 45.0, -9.0, 1.0]) / 60
"""Weights of the local slope at seven neighbours over their spacing, ISO 21920-2 [-]."""


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
    half = [square * rate / 2 for rate in _rates(band)]
    height = sum(sign * i0e(one) for sign, one in zip((1.0, -2.0, 1.0), half, strict=True))
    slope = sum(
        sign * (i0e(one) - i1e(one)) for sign, one in zip((1.0, -2.0, 1.0), half, strict=True)
    )
    return Reading(height=np.asarray(height), slope=np.asarray(0.5 * square * slope))


def _rates(band: ProfileBand) -> Iterable[float]:
    """Return the rates [m2] of the three exponentials in the square of the transmission."""
    short, long = _weakening(band.cutoff_short), _weakening(band.cutoff_long)
    return (2 * short + count * long for count in (0, 1, 2))


def _weakening(cutoff: float) -> float:
    """Return pi (alpha cutoff/(2 pi))^2 [m2], the exponent over the wave number squared."""
    return math.pi * (GAUSSIAN_ALPHA * cutoff / (2 * math.pi)) ** 2


def low_pass(heights: Array, axis: int, cutoff: float) -> Array:
    """Return heights through the Gaussian filter; `cutoff` in samples, ends mirrored."""
    if heights.shape[axis] == 1:
        return heights
    return np.asarray(
        gaussian_filter1d(heights, _deviation(cutoff), axis=axis, mode='mirror', truncate=KERNEL)
    )


def _deviation(cutoff: float) -> float:
    """Return the standard deviation of the weights, in the unit of `cutoff`."""
    return GAUSSIAN_ALPHA * cutoff / math.sqrt(2 * math.pi)


def filtered_profile(heights: ArrayLike, spacing: float, band: ProfileBand) -> Array:
    """
    Return the roughness profile [m] of heights [m] sampled every `spacing` [m] along axis 0.

    Nothing is assumed of the ends: what the weights do not reach on both sides is left out, 0.75
    of both cut-offs at each end. Raises InputError for a profile that is too short or too coarse.

    """
    profile = np.asarray(heights, dtype=float)
    if not 0 < spacing < math.inf:
        raise InputError(f'profile: spacing is {spacing:g} m, allowed is above 0')
    cutoffs = [cutoff / spacing for cutoff in (band.cutoff_short, band.cutoff_long) if cutoff]
    if min(cutoffs) < FINEST_CUTOFF:
        raise InputError(
            f'profile: spacing is {1e6 * spacing:g} um, allowed is a quarter of the cut-off '
            f'({1e6 * min(cutoffs) * spacing / FINEST_CUTOFF:g} um) at most'
        )
    end = sum(int(KERNEL * _deviation(cutoff) + 0.5) for cutoff in cutoffs)
    if len(profile) <= 2 * end:
        raise InputError(
            f'profile: {len(profile)} points are {1e3 * len(profile) * spacing:.4g} mm, the '
            f'filters need more than {2e3 * end * spacing:.4g} mm'
        )
    for cutoff in cutoffs[:-1]:
        profile = low_pass(profile, 0, cutoff)
    rough = profile - low_pass(profile, 0, cutoffs[-1])
    return np.asarray(rough[end:-end])


def profile_rms(roughness_profile: ArrayLike) -> Array:
    """Return Rq [m] of roughness profiles [m] along axis 0, ISO 21920-2."""
    return np.asarray(np.sqrt(np.mean(np.asarray(roughness_profile) ** 2, axis=0)))


def profile_rms_slope(roughness_profile: ArrayLike, spacing: float) -> Array:
    """Return Rdq [rad] of roughness profiles [m] with `spacing` [m] along axis 0, ISO 21920-2."""
    profile = np.asarray(roughness_profile, dtype=float)
    last = len(profile) - len(DERIVATIVE) + 1
    slope = sum(
        weight * profile[slice(at, at + last)] for at, weight in enumerate(DERIVATIVE) if weight
    )
    return np.asarray(np.arctan(profile_rms(np.asarray(slope) / spacing)))
