# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Identification of D and G: on generated surfaces, where both are known."""

from dataclasses import replace
import math

import numpy as np
import pytest
from surrogate.raceway.fractal import fractal_surface, PublishedRoughness
from surrogate.raceway.fractal_fit import (
    expected_structure_function,
    identify_fractal,
    structure_function,
)

NOMINAL = PublishedRoughness()
SPACING = 2e-6
ALONG = np.arange(0, 4e-3, SPACING)
TRACES = np.linspace(0, 4e-3, 64)


def test_the_structure_function_is_the_mean_of_many_and_tends_to_the_variance(theoretical_rms):
    """Over many places and draws; heights far apart differ by 2 Rq^2 on average."""
    lags = np.array([1, 4, 16, 64])
    measured = np.mean(
        [
            structure_function(fractal_surface(NOMINAL, seed).heights(ALONG, TRACES), lags)
            for seed in range(6)
        ],
        axis=(0, 2),
    )
    expected = expected_structure_function(NOMINAL, lags * SPACING)
    np.testing.assert_allclose(measured, expected, rtol=0.06)
    far = np.mean(expected_structure_function(NOMINAL, np.linspace(0.05, 0.5, 4000)))
    assert far == pytest.approx(2 * theoretical_rms(NOMINAL) ** 2, rel=0.1)


@pytest.mark.parametrize('seed', range(6))
def test_dimension_and_roughness_come_back(seed):
    """64 profiles: D within 0.02, G within a fifth, and an error estimate of that order."""
    fit = identify_fractal(fractal_surface(NOMINAL, seed).heights(ALONG, TRACES), SPACING, NOMINAL)
    assert fit.fractal_dimension == pytest.approx(2.68, abs=0.02)
    assert fit.fractal_roughness == pytest.approx(0.97e-9, rel=0.2)
    assert 0.001 < fit.dimension_error < 0.02
    assert fit.misfit < 0.03
    assert fit.profiles == 64


@pytest.mark.parametrize('dimension', [2.2, 2.4, 2.85])
def test_other_dimensions_come_back(dimension, theoretical_rms):
    other = replace(NOMINAL, fractal_dimension=dimension)
    fit = identify_fractal(fractal_surface(other, 1).heights(ALONG, TRACES), SPACING, NOMINAL)
    assert fit.fractal_dimension == pytest.approx(dimension, abs=0.03)
    fitted = replace(
        NOMINAL, fractal_dimension=fit.fractal_dimension, fractal_roughness=fit.fractal_roughness
    )
    assert theoretical_rms(fitted) == pytest.approx(theoretical_rms(other), rel=0.1)


def test_a_straight_line_through_the_logarithms_is_biased():
    """What the fit is for: the slope alone gives 2.64 where D is 2.68."""
    distance = np.geomspace(8e-6, 4e-4, 24)
    expected = expected_structure_function(NOMINAL, distance)
    slope = np.polyfit(np.log(distance), np.log(expected), 1)[0]
    assert 3 - slope / 2 == pytest.approx(2.637, abs=0.02)


def test_one_profile_is_enough_and_a_lay_is_profiled_across():
    """D within 0.1 without error estimate; slope and height of a profile do not matter."""
    profile = fractal_surface(NOMINAL, 0).heights(ALONG, [0.0])[:, 0]
    fit = identify_fractal(profile, SPACING, NOMINAL)
    assert fit.fractal_dimension == pytest.approx(2.68, abs=0.1)
    assert math.isnan(fit.dimension_error)
    tilted = identify_fractal(profile + 1e-3 + 0.01 * ALONG, SPACING, NOMINAL)
    assert tilted.fractal_dimension == pytest.approx(fit.fractal_dimension, abs=1e-4)
    surface = fractal_surface(NOMINAL, 2, lay='longitudinal')
    heights = surface.heights(np.linspace(0, 80e-3, 64), ALONG).T
    fit = identify_fractal(heights, SPACING, NOMINAL, lay='longitudinal', across=True)
    assert fit.fractal_dimension == pytest.approx(2.68, abs=0.02)


@pytest.mark.parametrize(
    ('heights', 'spacing', 'sentence'),
    [
        (np.zeros(10), SPACING, '10_points_64'),
        (np.zeros((100, 2, 2)), SPACING, 'one_two_dimensions'),
        (np.full(500, np.nan), SPACING, 'finite_number'),
        (np.linspace(0, 1, 500), SPACING, 'flat'),
        (np.ones(500), 0.0, 'spacing_0_m'),
        (np.sin(np.arange(500)), 5e-6, '500_points_1'),
        (np.sin(np.arange(70)), 1e-6, '70_points_8'),
    ],
)
def test_bad_profiles_are_one_sentence(heights, spacing, sentence, refused):
    refused(sentence, identify_fractal, heights, spacing, NOMINAL)
