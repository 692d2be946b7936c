# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The ball's own roughness: grades, and the sum with the raceway's."""

from dataclasses import replace
import math

import numpy as np
import pytest
from surrogate.raceway.ball import draw_pair, summed
from surrogate.raceway.scaling import draw_raceway, scale_spectrum
from surrogate.raceway.short_waves import wave_rms
from surrogate.raceway.spectrum import RoughnessSpectrum
from surrogate.raceway.standards import BALL_RA, ball_rms

RACEWAY = scale_spectrum(RoughnessSpectrum(rms=0.12e-6, fractal_dimension=2.5))
BALL = scale_spectrum(RoughnessSpectrum(rms=ball_rms('G10'), fractal_dimension=2.5))


def test_grades_are_those_of_the_standard(refused):
    """Ra limits in micrometres; a larger number is a rougher ball; unknown ones are refused."""
    assert ball_rms('G10') == pytest.approx(0.025e-6)
    assert {grade: 1e6 * BALL_RA[grade] for grade in ('G3', 'G5', 'G16', 'G20', 'G28', 'G40')} == (
        pytest.approx(
            {'G3': 0.01, 'G5': 0.014, 'G16': 0.025, 'G20': 0.032, 'G28': 0.05, 'G40': 0.06}
        )
    )
    limits = [BALL_RA[grade] for grade in sorted(BALL_RA, key=lambda grade: int(grade[1:]))]
    assert limits == sorted(limits)
    refused('ball_grade_g7', ball_rms, 'G7')


def test_a_pair_is_the_plain_sum_of_both():
    """Heights add as they stand; mean squares add, because the phases are independent."""
    x, y = np.linspace(-1e-4, 1e-4, 40), np.linspace(-4e-4, 4e-4, 30)
    raceway, ball = draw_raceway(RACEWAY, 6), draw_raceway(BALL, 6, field=1)
    pair = draw_pair(RACEWAY, BALL, 6)
    expected = raceway.heights(x, y) + ball.heights(x, y)
    np.testing.assert_allclose(pair.heights(x, y), expected, atol=1e-18)
    assert wave_rms(pair) == pytest.approx(math.hypot(wave_rms(raceway), wave_rms(ball)))
    assert pair.shortest_wavelength == min(raceway.shortest_wavelength, ball.shortest_wavelength)
    x, y = np.linspace(-1e-4, 1e-4, 20), np.linspace(-4e-4, 4e-4, 20)
    one = replace(draw_raceway(RACEWAY, 1), scale=1.7, plane=(1e-7, 1e-4, -2e-4))
    other = replace(draw_raceway(BALL, 2), scale=0.6, plane=(0.0, 0.0, 3e-4))
    expected = one.heights(x, y) + other.heights(x, y)
    np.testing.assert_allclose(summed(one, other).heights(x, y), expected, atol=1e-18)
    smooth = scale_spectrum(RoughnessSpectrum(rms=0.0))
    x = np.linspace(0, 1e-3, 30)
    wanted = draw_raceway(RACEWAY, 3).heights(x, x)
    np.testing.assert_allclose(draw_pair(RACEWAY, smooth, 3).heights(x, x), wanted)
