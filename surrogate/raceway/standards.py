# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Tables of the standards of roughness: cut-offs of a profile, and balls by their grade."""

from dataclasses import dataclass
import math

from surrogate.files import InputError

RA_OVER_RQ = 0.8
"""Ra over Rq [-] of heights with a normal distribution, sqrt(2/pi) rounded."""
CUTOFF_SHORT = 2.5e-6
"""Short cut-off of long ones to 0.8 mm [m], ISO 3274."""
CUTOFFS = ((0.02e-6, 0.08e-3), (0.1e-6, 0.25e-3), (2e-6, 0.8e-3), (1e-5, 2.5e-3), (math.inf, 8e-3))
"""Ra up to [m] and long cut-off [m] of a profile that is not periodic, ISO 4288, ISO 21920-3."""
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


@dataclass(frozen=True, kw_only=True, slots=True)
class ProfileBand:
    """Cut-offs of a roughness profile, lambda_s [m], 0 for none, and lambda_c [m]."""

    cutoff_short: float
    cutoff_long: float

    def __post_init__(self) -> None:
        if not 0 <= self.cutoff_short < math.inf:
            raise InputError(
                f'roughness: short cut-off is {1e6 * self.cutoff_short:g} um, allowed is 0 or more'
            )
        if not self.cutoff_short < self.cutoff_long < math.inf:
            raise InputError(
                f'roughness: long cut-off is {1e6 * self.cutoff_long:g} um, allowed is more than '
                f'the short one ({1e6 * self.cutoff_short:g} um)'
            )


def long_cutoff_iso_21920(ra: float) -> float:
    """
    Return the long cut-off [m] for a profile of `ra` [m] that is not periodic.

    ISO 4288:1996 table 1, the same in ISO 21920-3:2021; Ra at a limit belongs to the row below it.

    """
    return next(cutoff for limit, cutoff in CUTOFFS if ra <= limit * (1 + 1e-9))


def ball_rms(grade: str) -> float:
    """Return the largest Rq [m] of a ball of that grade, its largest Ra over 0.8."""
    if grade not in BALL_RA:
        raise InputError(f'ball grade is {grade!r}, allowed is {", ".join(BALL_RA)}')
    return BALL_RA[grade] / RA_OVER_RQ
