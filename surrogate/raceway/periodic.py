# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Raceways that repeat across the track, for a domain whose sides are joined.

Each wave number across is moved to the nearest multiple of 2 pi over the width. That along the
track follows, so that the wave keeps its length; for ridges nearly along the track it would have
to move much further than the one across and stays, so that they are not turned.

"""

from dataclasses import dataclass, replace
import math

import numpy as np
from numpy.typing import NDArray
from surrogate.files import InputError
from surrogate.raceway.fractal import FractalSurface

Array = NDArray[np.float64]

STEEPEST = 2.0
"""Largest wave number across over that along the track of a wave that keeps its length [-]."""


@dataclass(frozen=True, kw_only=True, slots=True)
class PeriodicSurface:
    """
    A surface that is periodic across the track, and what that has cost.

    Period `width` [m]; rms over the waves, each by its mean square height, of the turn [rad] and
    of the relative change of length [-]; the largest of the latter [-]; share of the mean square
    height in waves that are constant over the strip and lost [-].

    """

    surface: FractalSurface
    width: float
    turn: float
    length_change: float
    largest_length_change: float
    lost: float


def periodic_across(surface: FractalSurface, width: float) -> PeriodicSurface:
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
    old, new = np.hypot(surface.wave_number_x, surface.wave_number_y), np.hypot(adjusted, snapped)
    alive = new > 1e-9 * old
    total = float(np.sum(surface.amplitude**2)) or 1.0
    weight = np.where(alive, surface.amplitude**2, 0.0) / total
    length = np.where(alive, old / np.where(alive, new, 1.0) - 1.0, 0.0)
    turn = _turn(surface.wave_number_x, surface.wave_number_y, adjusted, snapped)
    return PeriodicSurface(
        surface=replace(surface, wave_number_x=adjusted, wave_number_y=snapped),
        width=width,
        turn=math.sqrt(float(weight @ turn**2)),
        length_change=math.sqrt(float(weight @ length**2)),
        largest_length_change=float(np.max(np.abs(length))),
        lost=float(np.sum(surface.amplitude[~alive] ** 2)) / total,
    )


def _turn(along: Array, across: Array, new_along: Array, new_across: Array) -> Array:
    """Return the angles [rad] between old and new wave vectors [rad/m]."""
    return np.asarray(
        np.abs(
            np.arctan2(
                along * new_across - across * new_along, along * new_along + across * new_across
            )
        )
    )
