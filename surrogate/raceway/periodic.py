# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Raceways that repeat across the track, for a domain whose sides are joined.

Each wave number across is moved to the nearest multiple of 2 pi over the width. That along the
track follows, so that the wave keeps its length; for ridges nearly along the track it would have
to move much further than the one across and stays, so that they are not turned.

"""

from dataclasses import replace
import math

import numpy as np
from numpy.typing import NDArray
from surrogate.files import InputError
from surrogate.raceway.fractal import FractalSurface

Array = NDArray[np.float64]

STEEPEST = 2.0
"""Largest wave number across over that along the track of a wave that keeps its length [-]."""


def periodic_across(surface: FractalSurface, width: float) -> FractalSurface:
    """
    Return a surface with period `width` [m] along y; amplitudes and phases stay.

    Raises InputError for a width that is not positive, and for a surface whose plane slopes across
    the track, as that of a patch does: no such surface is periodic.

    """
    if not 0 < width < math.inf:
        raise InputError(f'strip: width is {1e3 * width:g} mm, allowed is above 0')
    if surface.plane[2]:
        raise InputError('strip: its surface slopes across the track, allowed is a level one')
    along, across = surface.wave_number_x, surface.wave_number_y
    unit = 2 * math.pi / width
    snapped = unit * np.round(across / unit)
    number = np.hypot(along, across)
    kept = np.copysign(np.sqrt(np.maximum(number**2 - snapped**2, 0.0)), along)
    near = np.abs(across) <= STEEPEST * np.abs(along)
    adjusted = np.where(near & (np.abs(snapped) <= number), kept, along)
    return replace(surface, wave_number_x=adjusted, wave_number_y=snapped)


def turn_and_loss(surface: FractalSurface, periodic: FractalSurface) -> tuple[float, float]:
    """
    Return what the period of a surface has cost: turn of its waves [rad], share of them lost [-].

    The turn is the rms over the waves by their mean square height; the share is that of this
    height in waves that have become constant over the strip.

    """
    along, across = surface.wave_number_x, surface.wave_number_y
    new_along, new_across = periodic.wave_number_x, periodic.wave_number_y
    alive = np.hypot(new_along, new_across) > 1e-9 * np.hypot(along, across)
    total = float(np.sum(surface.amplitude**2)) or 1.0
    weight = np.where(alive, surface.amplitude**2, 0.0) / total
    crossed = along * new_across - across * new_along
    turn = np.abs(np.arctan2(crossed, along * new_along + across * new_across))
    lost = float(np.sum(surface.amplitude[~alive] ** 2)) / total
    return math.sqrt(float(weight @ turn**2)), lost
