# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Roughness as a datasheet or a drawing states it: Rq with its filters, the slope, the lay.

Waves run from the long cut-off, above which is form, to the short one: shorter ones are absent by
assumption, not by measurement.

"""

from dataclasses import dataclass
import math
from typing import get_args

import numpy as np
from numpy.typing import NDArray
from surrogate.files import InputError
from surrogate.raceway.fractal import DIMENSIONS, Lay, wave_directions
from surrogate.raceway.standards import (
    CUTOFF_SHORT,
    long_cutoff_iso_21920,
    ProfileBand,
    RA_OVER_RQ,
)

Array = NDArray[np.float64]

LARGEST_SLOPE = math.radians(45.0)
"""Largest rms slope that is accepted [rad]."""


@dataclass(frozen=True, kw_only=True, slots=True)
class RoughnessSpectrum:
    """
    What is known of a roughness: Rq of a profile traced across the lay, its filters and its shape.

    Rq `rms` [m], 0 for smooth; long cut-off [m], None for that of the table at Ra = 0.8 Rq; short
    cut-off [m]; the fractal dimension D [-] or the rms slope Rdq of the same profile [rad], which
    fixes it; lay, along which its ridges run, with the angle [rad] over which they fan. Of the
    generator: ratio of neighbouring wavelengths and ridges [-], longest and shortest wavelength
    [m], None for the cut-offs.

    """

    rms: float
    cutoff_long: float | None = None
    cutoff_short: float = CUTOFF_SHORT
    fractal_dimension: float | None = None
    rms_slope: float | None = None
    lay: Lay = 'isotropic'
    fan_angle: float | None = None
    scale_ratio: float = 1.5
    ridges: int = 10
    longest_wavelength: float | None = None
    shortest_wavelength: float | None = None

    def __post_init__(self) -> None:
        """Check each value, and that the band and the waves are not upside down."""
        _require('rms', self.rms, 'um', 0 <= self.rms < math.inf, '0 or more')
        self._check_shape()
        self._check_lay()
        band, (longest, shortest) = self.band, self.wavelengths
        allowed = f'above 0 and less than the long cut-off ({1e6 * band.cutoff_long:g} um)'
        _require('shortest wave', shortest, 'um', 0 < shortest < band.cutoff_long, allowed)
        least = max(shortest, band.cutoff_short)
        allowed = f'more than {1e6 * least:g} um, the shortest wave and the short cut-off'
        _require('longest wave', longest, 'um', least < longest < math.inf, allowed)
        ratio, ridges = self.scale_ratio, self.ridges
        _require('scale ratio', ratio, '', 1 < ratio < math.inf, 'above 1')
        _require(
            'number of ridges', ridges, '', ridges >= 1 and ridges == int(ridges), '1, 2, ...'
        )

    def _check_shape(self) -> None:
        low, high = DIMENSIONS
        dimension, slope = self.fractal_dimension, self.rms_slope
        if dimension is None and slope is None and self.rms:
            raise InputError(
                'roughness: neither fractal dimension nor rms slope is given, allowed is one of '
                'them: how steep the short waves are cannot be told from Rq'
            )
        if dimension is not None:
            allowed = f'{low:g} to {high:g}'
            _require('fractal dimension', dimension, '', low <= dimension <= high, allowed)
        if slope is not None:
            inside = 0 < slope <= LARGEST_SLOPE and self.rms > 0
            allowed = f'above 0 to {math.degrees(LARGEST_SLOPE):g} deg, with an rms above 0'
            _require('rms slope', slope, 'deg', inside, allowed)

    def _check_lay(self) -> None:
        if self.lay not in get_args(Lay):
            raise InputError(
                f'roughness: lay is {self.lay!r}, allowed is isotropic, longitudinal or transverse'
            )
        fan = self.fan_angle
        if (fan is None) != (self.lay == 'isotropic'):
            raise InputError(
                f'roughness: fan angle is {"missing" if fan is None else "given"}, lay is '
                f'{self.lay}, allowed is a fan angle with every lay that is not isotropic'
            )
        if fan is not None:
            _require('fan angle', fan, 'deg', 0 <= fan <= math.pi / 2, '0 to 90 deg')

    @property
    def band(self) -> ProfileBand:
        """Both cut-offs, the long one from the table where it is not stated."""
        stated = self.cutoff_long
        return ProfileBand(
            cutoff_short=self.cutoff_short,
            cutoff_long=long_cutoff_iso_21920(RA_OVER_RQ * self.rms) if stated is None else stated,
        )

    @property
    def wavelengths(self) -> tuple[float, float]:
        """Longest and shortest wavelength of the generator [m]."""
        return (
            self.band.cutoff_long if self.longest_wavelength is None else self.longest_wavelength,
            self.cutoff_short if self.shortest_wavelength is None else self.shortest_wavelength,
        )

    @property
    def directions(self) -> Array:
        """Directions of the waves [rad]."""
        return wave_directions(self.ridges, self.lay, self.fan_angle or 0.0)


def _require(name: str, value: float, unit: str, inside: bool, allowed: str) -> None:
    """Raise InputError in file units unless `inside`."""
    if not inside:
        shown = value * {'um': 1e6, 'deg': 180 / math.pi, '': 1.0}[unit]
        raise InputError(
            f'roughness: {name} is {shown:g} {unit}'.rstrip() + f', allowed is {allowed}'
        )
