# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Waves that a grid is too coarse for, as a higher film floor.

Solved with their oil, short waves move the onset of contact as a floor would that is higher by a
small share of their rms: most of their height is flattened before the film is as thin as the
floor. The share was fitted to resolved ensembles (docs/theory/raceway.md) and is taken as
independent of the load.

"""

from dataclasses import replace
import math

import numpy as np
from surrogate.files import InputError
from surrogate.raceway.fractal import FractalSurface

STANDING = 0.05
"""Rise of the floor over the rms of the waves that are left out [-]."""


def without_short_waves(surface: FractalSurface, shortest: float) -> FractalSurface:
    """Return the surface less its waves shorter than `shortest` [m]; plane and scale stay."""
    length = 2 * math.pi / np.hypot(surface.wave_number_x, surface.wave_number_y)
    kept = length > shortest * (1 - 1e-9)
    if not kept.any():
        raise InputError(
            f'shortest wave on the grid is {1e6 * shortest:g} um, allowed is the longest of the '
            f'surface ({1e6 * length.max():g} um) at most'
        )
    names = ('amplitude', 'wave_number_x', 'wave_number_y', 'phase')
    return replace(surface, **{name: getattr(surface, name)[kept] for name in names})


def wave_rms(surface: FractalSurface) -> float:
    """Return the rms height of all waves of a surface [m], whatever its window."""
    return surface.scale * math.sqrt(0.5 * float(np.sum(surface.amplitude**2)))


def subgrid_floor(surface: FractalSurface, shortest: float) -> float:
    """Return by how much [m] waves shorter than `shortest` [m] raise the film floor."""
    kept = wave_rms(without_short_waves(surface, shortest))
    return STANDING * math.sqrt(max(wave_rms(surface) ** 2 - kept**2, 0.0))
