# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Measured surfaces: interpolated between the points, never beyond them."""

from dataclasses import replace

from hypothesis import given
from hypothesis import strategies as st
import numpy as np
import pytest
from surrogate.raceway.fractal import fractal_surface, PublishedRoughness
from surrogate.raceway.measured import measured_surface
from surrogate.raceway.patch import take_patch, Window

NOMINAL = PublishedRoughness()
STEP = 2e-6
X, Y = np.arange(-100, 101) * STEP, np.arange(-60, 61) * 2 * STEP
FRACTAL = fractal_surface(replace(NOMINAL, shortest_wavelength=16e-6), 4)
HEIGHTS = FRACTAL.heights(X, Y)
INSIDE = st.floats(-0.2e-3, 0.2e-3)


def test_points_are_kept_and_places_between_interpolated():
    """At the points to rounding, between them within 2 % of the rms of the surface measured."""
    surface = measured_surface(HEIGHTS, STEP, 2 * STEP)
    np.testing.assert_allclose(surface.heights(X, Y), HEIGHTS, atol=1e-20)
    between = surface.heights(X[:-1] + STEP / 2, Y[:-1] + STEP)
    error = between - FRACTAL.heights(X[:-1] + STEP / 2, Y[:-1] + STEP)
    assert np.std(error) < 0.02 * np.std(HEIGHTS)
    assert surface.shortest_wavelength == 4 * STEP
    assert (surface.length_x, surface.length_y) == pytest.approx((200 * STEP, 240 * STEP))


@given(x=INSIDE, y=st.floats(-0.24e-3, 0.24e-3))
def test_a_place_has_one_height_whatever_the_grid(x, y):
    surface = measured_surface(HEIGHTS, STEP, 2 * STEP)
    alone = surface.heights([x], [y])[0, 0]
    grid = surface.heights([0.1e-3, x, -0.1e-3], [y, 0.0])
    assert grid.shape == (3, 2)
    assert grid[1, 0] == pytest.approx(alone, rel=1e-9, abs=1e-18)


def test_outside_the_map_is_refused_and_a_profile_goes_on_across(refused):
    """Along x it stands for a transverse lay, along y for a longitudinal one."""
    surface = measured_surface(HEIGHTS, STEP, 2 * STEP, source='map.csv')
    refused('map_contact_needs', surface.heights, [0.0, 0.3e-3], [0.0])
    refused('along_y_map', surface.heights, [0.0], [-0.25e-3])
    profile = HEIGHTS[:, :1]
    transverse = measured_surface(profile, STEP, STEP).heights(X, [-1.0, 0.0, 5.0])
    np.testing.assert_allclose(transverse, np.repeat(profile, 3, axis=1), atol=1e-20)
    longitudinal = measured_surface(profile.T, STEP, STEP).heights([-1.0, 0.0, 5.0], X)
    np.testing.assert_allclose(longitudinal, np.repeat(profile.T, 3, axis=0), atol=1e-20)


@given(x=INSIDE)
def test_a_mirrored_map_goes_on_without_a_jump(x):
    """Beyond an edge it runs back; after two lengths it repeats."""
    surface = measured_surface(HEIGHTS, STEP, 2 * STEP, outside='mirror')
    first, turned, again = surface.heights([x, 0.4e-3 - x, x + 0.8e-3], [0.0])[:, 0]
    assert turned == pytest.approx(first, rel=1e-6, abs=1e-14)
    assert again == pytest.approx(first, rel=1e-6, abs=1e-14)


def test_patches_work_as_on_fractal_surfaces(refused):
    """Levelled and scaled over the window; a window larger than the map is refused."""
    window = Window(length_x=0.2e-3, length_y=0.4e-3)
    surface = measured_surface(HEIGHTS + 1e-3 * X[:, None] + 1e-6, STEP, 2 * STEP)
    patch = take_patch(surface, 'rescaled', window, NOMINAL.rms)
    x, y = np.linspace(-0.1e-3, 0.1e-3, 301), np.linspace(-0.2e-3, 0.2e-3, 301)
    assert np.std(patch.heights(x, y)) == pytest.approx(NOMINAL.rms, rel=0.02)
    level = take_patch(measured_surface(HEIGHTS, STEP, 2 * STEP), 'cut', window, NOMINAL.rms)
    assert patch.plane[1] - level.plane[1] == pytest.approx(1e-3, rel=1e-3)
    with refused('map_ends'):
        take_patch(surface, 'cut', Window(length_x=1e-3, length_y=0.1e-3), NOMINAL.rms)
    refused(
        'flat_over_window',
        take_patch,
        measured_surface(np.ones((50, 50)), STEP, STEP),
        'cut',
        Window(length_x=2e-5, length_y=2e-5),
        NOMINAL.rms,
    )


def test_the_filter_halves_a_wave_at_its_cutoff():
    """Gaussian filter: half at the cutoff, nearly all of a wave three times as long."""
    x = np.arange(4000) * 0.5e-6
    for wave, passed in ((20e-6, 0.5), (60e-6, 0.926), (8e-6, 0.013)):
        profile = np.cos(2 * np.pi * x / wave)[:, None]
        smooth = measured_surface(profile, 0.5e-6, 1.0, shortest_wavelength=20e-6)
        middle = smooth.raw[1000:3000]
        assert np.ptp(middle) / 2 == pytest.approx(passed, abs=0.005)
        assert smooth.shortest_wavelength == 20e-6


@pytest.mark.parametrize(
    ('heights', 'options', 'sentence'),
    [
        (np.ones(50), {}, '50_points_16'),
        (np.ones((1, 1)), {}, '1_points_16'),
        (np.ones((50, 3)), {}, '50_3_points'),
        (np.where(np.eye(50) > 0, np.nan, 1.0), {}, '50_2500_heights'),
        (HEIGHTS, {'shortest_wavelength': 7e-6}, '7_um_two'),
        (HEIGHTS, {'outside': 'guess'}, 'outside_guess_refuse'),
        (HEIGHTS, {'spacing_x': -1.0}, 'spacing_1_m'),
    ],
)
def test_bad_maps_are_one_sentence(heights, options, sentence, refused):
    with refused(sentence):
        measured_surface(heights, **{'spacing_x': STEP, 'spacing_y': 2 * STEP, **options})
