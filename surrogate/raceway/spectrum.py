# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Roughness as a datasheet or a drawing states it: Rq with its filters, the slope, the lay.

Waves run from the long cut-off, above which is form, to the short one: shorter ones are absent by
assumption, not by measurement.

"""

from dataclasses import dataclass
import math
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray
from surrogate.files import InputError
from surrogate.files.datasheet import Checked, choice, count, quantity
from surrogate.raceway.fractal import DIMENSIONS, Lay, wave_directions
from surrogate.raceway.standards import (
    CUTOFF_SHORT,
    long_cutoff_iso_21920,
    ProfileBand,
    RA_OVER_RQ,
)

Array = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True, slots=True)
class RoughnessSpectrum(Checked):
    """
    Roughness by the standard: Rq of a profile traced across the lay, its filters and its shape.

    Rq `rms` [m], 0 for smooth; long cut-off [m], None for that of the table at Ra = 0.8 Rq; short
    cut-off [m]; the fractal dimension D [-] or the rms slope Rdq of the same profile [rad], which
    fixes it; lay, along which its ridges run, with the angle [rad] over which they fan. Of the
    generator: ratio of neighbouring wavelengths and ridges [-].

    """

    WHERE: ClassVar[str] = 'roughness'

    rms: float = quantity(
        'um',
        1e-6,
        0.0,
        10.0,
        means='Rq of a profile traced across the lay, which moves films and RCS most; 0 is smooth',
    )
    cutoff_long: float | None = quantity(
        'mm',
        1e-3,
        0.001,
        100.0,
        default=None,
        means='long cut-off of that profile; without it by ISO 21920 for Ra = 0.8 Rq, '
        'which every result then states',
    )
    cutoff_short: float = quantity(
        'um', 1e-6, 0.1, 1000.0, default=CUTOFF_SHORT, means='short cut-off, and the shortest wave'
    )
    fractal_dimension: float | None = quantity(
        '',
        1.0,
        *DIMENSIONS,
        default=None,
        means='steepness of the short waves, from measured profiles; this or `rms_slope_deg`',
    )
    rms_slope: float | None = quantity(
        'deg',
        math.pi / 180,
        0.001,
        45.0,
        default=None,
        means='Rdq of the same profile; this or `fractal_dimension`',
    )
    lay: Lay = choice(
        'isotropic',
        'longitudinal',
        'transverse',
        default='isotropic',
        means='`longitudinal`: ridges along the track; `transverse`: across it',
    )
    fan_angle: float | None = quantity(
        'deg',
        math.pi / 180,
        0.0,
        90.0,
        default=None,
        means='angle over which the waves of a lay fan',
    )
    scale_ratio: float = quantity(
        '',
        1.0,
        1.01,
        10.0,
        default=1.5,
        means='ratio of neighbouring wavelengths of the generator',
    )
    ridges: int = count(1, 1000, default=10, means='ridges of the generator')

    def __post_init__(self) -> None:
        Checked.__post_init__(self)
        if self.fractal_dimension is None and self.rms_slope is None and self.rms:
            raise InputError(
                'roughness: neither fractal dimension nor rms slope is given, allowed is one of '
                'them: how steep the short waves are cannot be told from Rq'
            )
        if self.rms_slope is not None and not self.rms:
            raise InputError(
                f'roughness: rms_slope_deg is {math.degrees(self.rms_slope):g} deg and rms_um is '
                '0 um, allowed is a slope with an rms above 0'
            )
        fan = self.fan_angle
        if (fan is None) != (self.lay == 'isotropic'):
            raise InputError(
                f'roughness: fan angle is {"missing" if fan is None else "given"}, lay is '
                f'{self.lay}, allowed is a fan angle with every lay that is not isotropic'
            )
        _ = self.band

    @property
    def band(self) -> ProfileBand:
        """Both cut-offs, the long one from the table where it is not stated."""
        stated = self.cutoff_long
        return ProfileBand(
            cutoff_short=self.cutoff_short,
            cutoff_long=long_cutoff_iso_21920(RA_OVER_RQ * self.rms) if stated is None else stated,
        )

    @property
    def directions(self) -> Array:
        """Directions of the waves [rad]."""
        return wave_directions(self.ridges, self.lay, self.fan_angle or 0.0)
