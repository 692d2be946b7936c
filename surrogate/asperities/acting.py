# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
The film over the roughness that acts: what decides where contact begins.

A rolling contact flattens long waves and keeps short ones, so that not the whole Rq acts but what
the amplitude reduction leaves of each wave.

"""

from dataclasses import dataclass
import math

import numpy as np
from numpy.typing import NDArray
from surrogate.ehl import ContactLubricant
from surrogate.formulas.line import (
    amplitude_reduction_venner_1997,
    central_film_line,
    Line,
    moes_line,
)
from surrogate.raceway.ball import ball_of
from surrogate.raceway.scaling import scale_spectrum, ScaledSpectrum
from surrogate.raceway.stated import BallRoughness, Roughness, spectrum_of

Array = NDArray[np.float64]
SLOWEST, FASTEST, SPEEDS = 1e-6, 1e3, 400
"""Entrainment speeds between which an onset is looked for [m/s], and how many are tried."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Waves:
    """Wavelengths [m] of a roughness and the mean square height of each [m^2], any shape."""

    length: Array
    mean_square: Array

    def longer_than(self, shortest: float) -> 'Waves':
        """Return the waves not shorter than `shortest` [m]."""
        kept = self.length > shortest * (1 - 1e-9)
        return Waves(length=self.length[kept], mean_square=self.mean_square[kept])


def waves_of(*fields: ScaledSpectrum) -> Waves:
    """Return the waves of one or more independent fields, as those of raceway and ball."""
    each = [0.5 * len(one.direction) * one.amplitude**2 for one in fields]
    return Waves(
        length=np.concatenate([2 * math.pi / one.wave_number for one in fields]),
        mean_square=np.concatenate(each),
    )


def stated_waves(roughness: Roughness, ball: BallRoughness | None) -> Waves:
    """Return the waves of raceway and ball as a datasheet states them."""
    raceway, rolling = scale_spectrum(spectrum_of(roughness)), ball_of(roughness, ball)
    return waves_of(*(one for one in (raceway, rolling) if one is not None))


def acting_rms(waves: Waves, line: Line, speed: Array, oil: ContactLubricant) -> Array:
    """
    Return the rms of the roughness that a rolling contact leaves [m].

    sqrt(sum (Ad/Ai)^2 mean square) at entrainment speeds [m/s]; waves of all directions are
    reduced as those across the track. Shape of speed and pressure broadcast.

    """
    M1, L = moes_line(line, speed, oil.viscosity, oil.pressure_viscosity)
    left = amplitude_reduction_venner_1997(
        waves.length, line.semi_axis[..., None], M1[..., None], L[..., None]
    )
    return np.asarray(np.sqrt((left**2) @ waves.mean_square))


def film_over_acting(waves: Waves, line: Line, speed: Array, oil: ContactLubricant) -> Array:
    """Return the smooth central film over the acting rms [-] at entrainment speeds [m/s]."""
    film = central_film_line(line, speed, oil.viscosity, oil.pressure_viscosity)
    return np.asarray(film / acting_rms(waves, line, speed, oil))


def speed_at_ratio(waves: Waves, line: Line, oil: ContactLubricant, ratio: Array) -> Array:
    """
    Return the fastest entrainment speed [m/s] of a film over the acting rms [-]; 0 if none.

    For every pressure of the line and every ratio, which broadcast. Below it the ratio may rise
    again, where the contact is so slow that it flattens everything: that is no end of contact.

    """
    logs = np.linspace(math.log(SLOWEST), math.log(FASTEST), SPEEDS)
    pressure = np.asarray(line.max_pressure)
    every = Line(
        radius=line.radius, reduced_modulus=line.reduced_modulus, max_pressure=pressure[..., None]
    )
    if not waves.mean_square.any():
        return np.zeros(np.broadcast_shapes(pressure.shape, np.shape(ratio)))
    found = np.log(film_over_acting(waves, every, np.exp(logs), oil))
    wanted = np.log(np.asarray(ratio, dtype=float))
    found, wanted = np.broadcast_arrays(found, wanted[..., None])
    below = found < wanted
    last = SPEEDS - 2 - np.argmax(below[..., -2::-1], axis=-1)
    low, high = (np.take_along_axis(found, (last + k)[..., None], -1)[..., 0] for k in (0, 1))
    weight = (wanted[..., 0] - low) / (high - low)
    speed = np.exp(logs[last] + weight * (logs[1] - logs[0]))
    return np.asarray(np.where(below[..., :-1].any(axis=-1), speed, 0.0))
