# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Roughness of the ball, a second field that rolls through the contact with that of the raceway.

Without slip both surfaces move with the oil, so that the gap sees their plain sum.

"""

import numpy as np
from numpy.typing import NDArray
from surrogate.raceway.fractal import FractalSurface
from surrogate.raceway.scaling import draw_raceway, scale_spectrum, ScaledSpectrum
from surrogate.raceway.spectrum import RoughnessSpectrum
from surrogate.raceway.stated import BallRoughness, Roughness

Array = NDArray[np.float64]


def ball_waves(rms: float, raceway: RoughnessSpectrum) -> ScaledSpectrum:
    """
    Return the scaled waves of a ball with Rq `rms` [m], above 0.

    They are isotropic, with dimension and generator of the raceway, between the same short cut-off
    and the long one of the table: balls are measured by it.

    """
    return scale_spectrum(
        RoughnessSpectrum(
            rms=rms,
            cutoff_short=raceway.cutoff_short,
            fractal_dimension=scale_spectrum(raceway).fractal_dimension,
            scale_ratio=raceway.scale_ratio,
            ridges=raceway.ridges,
        )
    )


def ball_of(roughness: RoughnessSpectrum, ball: BallRoughness | None) -> ScaledSpectrum | None:
    """Return the scaled waves of a ball beside a raceway of `roughness`, None where smooth."""
    if ball is None or not ball.height:
        return None
    return ball_waves(ball.height, roughness)


def roughness_sentence(roughness: Roughness, ball: BallRoughness | None) -> str:
    """Say what the stated roughness stands for, and what of it is assumed."""
    raceway, rolling = scale_spectrum(roughness), ball_of(roughness, ball)
    state = {'run_in': 'run in', 'new': 'new'}[roughness.state]
    words = f'raceway ({state}): {raceway.sentence}, {roughness.lay}'
    if not roughness.rms:
        words = 'raceway: smooth'
    words += f', {roughness.calibration}' if roughness.calibration else ''
    if ball is None:
        return f'{words}; ball: smooth, not stated'
    grade = f' ({ball.grade})' if ball.grade else ''
    return f'{words}; ball{grade}: {rolling.sentence if rolling else "smooth"}'


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
