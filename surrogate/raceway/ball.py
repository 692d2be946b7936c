# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Roughness of the ball, a second field that rolls through the contact with that of the raceway.

Without slip both surfaces move with the oil, so that the gap sees their plain sum.

"""

import numpy as np
from numpy.typing import NDArray
from surrogate.files import InputError
from surrogate.raceway.fractal import FractalSurface
from surrogate.raceway.scaling import draw_raceway, ScaledSpectrum
from surrogate.raceway.stylus import RA_OVER_RQ

Array = NDArray[np.float64]

BALL_RA = {
    'G3': 0.010e-6,
    'G5': 0.014e-6,
    'G10': 0.020e-6,
    'G16': 0.025e-6,
    'G20': 0.032e-6,
    'G24': 0.040e-6,
    'G28': 0.050e-6,
    'G40': 0.060e-6,
    'G60': 0.080e-6,
    'G100': 0.100e-6,
    'G200': 0.150e-6,
}
"""Largest Ra of steel balls of a grade [m], ISO 3290-1:2014, measured by ISO 4288."""


def ball_rms(grade: str) -> float:
    """Return the largest Rq [m] of a ball of that grade, its largest Ra over 0.8."""
    if grade not in BALL_RA:
        raise InputError(f'ball grade is {grade!r}, allowed is {", ".join(BALL_RA)}')
    return BALL_RA[grade] / RA_OVER_RQ


def draw_pair(raceway: ScaledSpectrum, ball: ScaledSpectrum, seed: int) -> FractalSurface:
    """Return one draw of raceway and ball together, their phases [rad] independent."""
    return summed(draw_raceway(raceway, seed), draw_raceway(ball, seed, field=1))


def summed(first: FractalSurface, second: FractalSurface) -> FractalSurface:
    """Return the surface whose heights [m] are the sum of those of two."""

    def joined(name: str) -> Array:
        return np.concatenate([getattr(first, name), getattr(second, name)])

    one, other = (np.multiply(surface.scale, surface.plane) for surface in (first, second))
    offset, slope_x, slope_y = (float(value) for value in one + other)
    return FractalSurface(
        amplitude=np.concatenate(
            [surface.scale * surface.amplitude for surface in (first, second)]
        ),
        wave_number_x=joined('wave_number_x'),
        wave_number_y=joined('wave_number_y'),
        phase=joined('phase'),
        plane=(offset, slope_x, slope_y),
    )
