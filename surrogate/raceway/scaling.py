# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Roughness by the standard: waves whose expected stylus profile has the stated Rq.

The sum of Yan and Komvopoulos gives the shape, waves of amplitude g^((D-3)n) in M directions; one
factor, from the expectation over all phases, gives the height. No draw is scaled by itself.

"""

from dataclasses import dataclass, replace
import math

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq
from surrogate.files import InputError
from surrogate.raceway.fractal import DIMENSIONS, FractalSurface, wave_orders, wave_sum
from surrogate.raceway.spectrum import RoughnessSpectrum
from surrogate.raceway.standards import ProfileBand, RA_OVER_RQ
from surrogate.raceway.stylus import read_all_directions, read_waves, Reading

Array = NDArray[np.float64]

SLOPES_AGREE = 0.01
"""Relative difference of a stated rms slope from that of the stated dimension, at most [-]."""


@dataclass(frozen=True, kw_only=True, slots=True)
class ScaledSpectrum:
    """
    Waves whose expected profile has the stated Rq, and what follows from them.

    Wave numbers [rad/m], the amplitude of one wave at each [m] and the directions [rad]; D [-];
    G [m] of the same sum as published, L its longest wave (NaN when smooth; it may underflow to 0
    for D near 2); Rq [m] and Rdq [rad] of the expected profile; `band`, `cutoff_by_table` true
    when its long cut-off was not stated.

    """

    wave_number: Array
    amplitude: Array
    direction: Array
    fractal_dimension: float
    fractal_roughness: float
    rms: float
    rms_slope: float
    band: ProfileBand
    cutoff_by_table: bool

    @property
    def sentence(self) -> str:
        """Say what the roughness numbers stand for, and which of them nobody stated."""
        if not self.rms:
            return 'smooth'
        table = f' by the table for Ra = {RA_OVER_RQ:g} Rq, not stated,' * self.cutoff_by_table
        return (
            f'Rq {1e6 * self.rms:.3g} um between {1e6 * self.band.cutoff_short:g} um and '
            f'{1e3 * self.band.cutoff_long:g} mm{table or ","} rms slope '
            f'{math.degrees(self.rms_slope):.3g} deg, D {self.fractal_dimension:.3f}'
        )


def scale_spectrum(
    spectrum: RoughnessSpectrum, *, wavelengths: tuple[float, float] | None = None
) -> ScaledSpectrum:
    """
    Return the waves of a spectrum, scaled once by the expectation over all phases.

    `wavelengths` are the longest and the shortest one [m], by default the cut-offs.

    Rq^2 = sum over waves of a^2 |H(q cos t)|^2/2, t the angle of a wave to the trace, H the
    filters: a lay is traced across; isotropic waves are read by the mean over all traces, since
    that of M directions alone depends on the trace (0.8 % of Rq at most for M = 10).

    Raises InputError where no dimension has the stated slope, or the stated one another slope.

    """
    longest, shortest = wavelengths or (spectrum.band.cutoff_long, spectrum.cutoff_short)
    order = wave_orders(longest, shortest, spectrum.scale_ratio)
    number = np.asarray(2 * math.pi / longest * spectrum.scale_ratio**order)
    reading = _read(spectrum, number)
    dimension = _dimension(spectrum, order, reading)
    unit = spectrum.scale_ratio ** ((dimension - 3) * order)
    found = float(unit**2 @ reading.height)
    smooth = spectrum.rms == 0
    height = 0.0 if smooth else spectrum.rms / math.sqrt(found)
    published = math.nan
    if height:  # the amplitude of the longest wave is L (G/L)^(D-2) sqrt(ln g/M)
        ratio = height / (longest * math.sqrt(math.log(spectrum.scale_ratio) / spectrum.ridges))
        published = float(longest * ratio ** (1 / (dimension - 2)))
    return ScaledSpectrum(
        wave_number=number,
        amplitude=np.zeros(len(order)) if smooth else np.asarray(height * unit),
        direction=spectrum.directions,
        fractal_dimension=dimension,
        fractal_roughness=published,
        rms=spectrum.rms,
        rms_slope=0.0 if smooth else _rms_slope(spectrum, order, reading, dimension),
        band=spectrum.band,
        cutoff_by_table=spectrum.cutoff_long is None,
    )


def with_shorter_waves(spectrum: RoughnessSpectrum, shortest: float) -> ScaledSpectrum:
    """
    Return the waves of a spectrum carried on to `shortest` [m], which no stylus has measured.

    Its dimension is that before; Rq through the same filters stays too, for which all waves shrink
    a little (0.4 % of D 2.68 for one wave more). Phases of a draw stay.

    """
    dimension = scale_spectrum(spectrum).fractal_dimension
    stated = None if math.isnan(dimension) else dimension
    known = replace(spectrum, fractal_dimension=stated, rms_slope=None)
    return scale_spectrum(known, wavelengths=(spectrum.band.cutoff_long, shortest))


def _read(spectrum: RoughnessSpectrum, number: Array) -> Reading:
    """Return what is read of all waves at each wave number, for unit amplitudes."""
    half = 0.5 * int(spectrum.ridges)
    if spectrum.lay == 'isotropic':
        one = read_all_directions(number, spectrum.band)
        return Reading(height=half * one.height, slope=half * one.slope)
    across = 0.5 * math.pi if spectrum.lay == 'longitudinal' else 0.0
    each = read_waves(np.outer(number, np.cos(spectrum.directions - across)), spectrum.band)
    return Reading(height=half * each.height.mean(axis=1), slope=half * each.slope.mean(axis=1))


def _rms_slope(
    spectrum: RoughnessSpectrum, order: NDArray[np.int64], reading: Reading, dimension: float
) -> float:
    """Return Rdq [rad] of the expected profile; it rises with the dimension."""
    weight = spectrum.scale_ratio ** (2 * (dimension - 3) * order)
    ratio = float(weight @ reading.slope) / float(weight @ reading.height)
    return math.atan(spectrum.rms * math.sqrt(ratio))


def _dimension(spectrum: RoughnessSpectrum, order: NDArray[np.int64], reading: Reading) -> float:
    """Return the stated dimension [-], or that with the stated slope; NaN when smooth."""
    stated, slope = spectrum.fractal_dimension, spectrum.rms_slope
    if slope is None:
        return math.nan if stated is None else stated

    def excess(dimension: float) -> float:
        return _rms_slope(spectrum, order, reading, dimension) - slope

    if stated is not None:
        if abs(excess(stated)) > SLOPES_AGREE * slope:
            raise InputError(
                f'roughness: fractal dimension {stated:g} has the rms slope '
                f'{math.degrees(excess(stated) + slope):.3g} deg, stated is '
                f'{math.degrees(slope):.3g} deg, allowed is one of the two, or both within '
                f'{100 * SLOPES_AGREE:g} %'
            )
        return stated
    low, high = (excess(end) for end in DIMENSIONS)
    if low > 0 or high < 0:
        raise InputError(
            f'roughness: rms slope is {math.degrees(slope):.3g} deg, allowed is '
            f'{math.degrees(low + slope):.3g} to {math.degrees(high + slope):.3g} deg, which '
            f'fractal dimensions of {DIMENSIONS[0]:g} to {DIMENSIONS[1]:g} give with Rq '
            f'{1e6 * spectrum.rms:g} um between these cut-offs'
        )
    return float(brentq(excess, *DIMENSIONS, xtol=1e-10))


def draw_raceway(scaled: ScaledSpectrum, seed: int, *, field: int = 0) -> FractalSurface:
    """
    Return one draw of a scaled spectrum, its phases [rad] from `seed`, its mean height 0.

    Draws of one seed and another `field` are independent: the raceway is 0, its ball 1.

    """
    draft = wave_sum(
        scaled.wave_number, scaled.amplitude, scaled.direction, [seed, field] if field else seed
    )
    # The published sum is 0 at its origin; a profile has its mean there.
    mean = float(np.sum(draft.amplitude * np.cos(draft.phase)))
    return replace(draft, plane=(mean, 0.0, 0.0))
