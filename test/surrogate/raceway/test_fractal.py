# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Fractal surfaces: the published sum, one surface whatever the grid, patches, lays."""

from dataclasses import replace
import logging
import math

from hypothesis import given
from hypothesis import strategies as st
import numpy as np
import pytest
from surrogate.files import InputError
from surrogate.raceway.fractal import fractal_surface, PublishedRoughness, shifted
from surrogate.raceway.fractal_fit import structure_function
from surrogate.raceway.patch import take_patch, Window
from surrogate.raceway.scaling import draw_raceway, scale_spectrum
from surrogate.raceway.spectrum import RoughnessSpectrum

NOMINAL = PublishedRoughness()
COARSE = replace(NOMINAL, shortest_wavelength=64e-6)
SHORT = replace(NOMINAL, sample_length=1e-5, shortest_wavelength=2e-5)
HERTZ = Window(length_x=0.2e-3, length_y=1.6e-3)
SMALL = Window(length_x=0.1e-3, length_y=0.8e-3)
RACEWAY = draw_raceway(scale_spectrum(RoughnessSpectrum(rms=1e-7, fractal_dimension=2.5)), 4)
ACROSS = np.linspace(-4e-4, 4e-4, 33)
PLACE = st.floats(-2e-3, 2e-3)


def direct_sum(roughness, seed, x, y):
    """Return the height at one place as the formula is printed, without vectors."""
    length, g, m_max = roughness.sample_length, roughness.scale_ratio, roughness.ridges
    n_max = int(math.log(length / roughness.shortest_wavelength) / math.log(g))
    phase = np.random.default_rng(seed).uniform(0, 2 * math.pi, (n_max + 1, m_max))
    total = 0.0
    for m in range(1, m_max + 1):
        for n in range(n_max + 1):
            turn = 2 * math.pi * g**n * math.hypot(x, y) / length
            turn *= math.cos(math.atan2(y, x) - math.pi * m / m_max)
            wave = math.cos(phase[n, m - 1]) - math.cos(turn + phase[n, m - 1])
            total += g ** ((roughness.fractal_dimension - 3) * n) * wave
    ratio = roughness.fractal_roughness / length
    return (
        length
        * ratio ** (roughness.fractal_dimension - 2)
        * math.sqrt(math.log(g) / m_max)
        * total
    )


def rms_over(surface, window, points=(151, 451)):
    """Return the rms height [m] over a window, on a grid that the patch was not taken on."""
    x = np.linspace(-window.length_x / 2, window.length_x / 2, points[0])
    y = np.linspace(-window.length_y / 2, window.length_y / 2, points[1])
    return float(np.std(surface.heights(x, y)))


@given(x=PLACE, y=PLACE, seed=st.integers(0, 2**32))
def test_heights_are_the_published_sum(x, y, seed):
    found = fractal_surface(COARSE, seed).heights([x], [y])[0, 0]
    assert found == pytest.approx(direct_sum(COARSE, seed, x, y), rel=1e-9, abs=1e-16)


@given(x=PLACE, y=PLACE, seed=st.integers(0, 100))
def test_a_place_has_one_height_whatever_the_grid(x, y, seed):
    """A node of any grid, given by axes or by arrays, sees what a single point sees."""
    surface = take_patch(fractal_surface(COARSE, seed), 'rescaled', HERTZ, COARSE.rms)
    alone = surface.heights([x], [y])[0, 0]
    axes = np.array([-1e-3, x, 3e-3]), np.array([y, 0.0])
    for places in (axes, np.meshgrid(*axes, indexing='ij'), np.ix_(*axes)):
        grid = surface.heights(*places)
        assert grid.shape == (3, 2)
        assert grid[1, 0] == pytest.approx(alone, rel=1e-9, abs=1e-16)


def test_rms_follows_from_the_constants(theoretical_rms):
    """The nominal constants give Rq 0.12 um over 4 mm, and less over shorter samples."""
    assert theoretical_rms(NOMINAL) == pytest.approx(0.1186e-6, rel=1e-3)
    for length, expected in ((0.2e-3, 0.046e-6), (1e-3, 0.076e-6)):
        short = replace(NOMINAL, sample_length=length)
        assert theoretical_rms(short) == pytest.approx(expected, rel=0.08)
    x = np.linspace(-40e-3, 40e-3, 300)
    drawn = np.mean([np.var(fractal_surface(COARSE, seed).heights(x, x)) for seed in range(4)])
    assert math.sqrt(drawn) == pytest.approx(theoretical_rms(COARSE), rel=0.02)


def test_a_shorter_wave_adds_and_changes_nothing():
    long, short = fractal_surface(COARSE, 3), fractal_surface(NOMINAL, 3)
    count = len(long.phase)
    assert len(short.phase) == count + 5 * NOMINAL.ridges
    for name in ('amplitude', 'wave_number_x', 'wave_number_y', 'phase'):
        np.testing.assert_array_equal(getattr(short, name)[:count], getattr(long, name))
    assert short.shortest_wavelength == pytest.approx(4e-3 / 1.5**15)
    assert short.shortest_wavelength > NOMINAL.shortest_wavelength


@pytest.mark.parametrize('seed', range(4))
def test_a_rescaled_patch_has_the_rms_of_the_datasheet(seed):
    """Within 1 % on another grid; the mean plane is gone; the factor is kept and logged once."""
    patch = take_patch(fractal_surface(NOMINAL, seed), 'rescaled', HERTZ, NOMINAL.rms)
    assert patch.patch == 'rescaled'
    assert rms_over(patch, HERTZ) == pytest.approx(NOMINAL.rms, rel=0.01)
    assert 1.0 < patch.scale < 3.0
    x = np.linspace(-1e-4, 1e-4, 101)
    y = np.linspace(-8e-4, 8e-4, 401)
    heights = patch.heights(x, y)
    assert abs(heights.mean()) < 0.01 * NOMINAL.rms
    assert abs(np.polyfit(y, heights.mean(axis=0), 1)[0]) * 1.6e-3 < 0.05 * NOMINAL.rms


def test_the_factor_of_a_patch_is_logged_and_another_one_starts_raw(caplog):
    """One line says kind, rms before, window and factor; a second patch replaces the first."""
    with caplog.at_level(logging.INFO, 'surrogate.raceway.patch'):
        patch = take_patch(fractal_surface(NOMINAL, 0), 'rescaled', HERTZ, NOMINAL.rms)
    (line,) = caplog.messages
    before = NOMINAL.rms / patch.scale
    assert line == (
        f'patch rescaled: rms {1e6 * before:.4g} um over 0.2 x 1.6 mm, times {patch.scale:.4g}'
    )
    surface = fractal_surface(NOMINAL, 5)
    once = take_patch(surface, 'cut', SMALL, NOMINAL.rms)
    again = take_patch(take_patch(surface, 'rescaled', HERTZ, 9e-6), 'cut', SMALL, NOMINAL.rms)
    assert again.scale == once.scale == 1.0
    assert again.plane == once.plane


def test_cut_patches_scatter_by_draw():
    """Half of the nominal 0.12 um and less over a contact, by draw; a patch is never rescaled."""
    draws = [fractal_surface(NOMINAL, seed) for seed in range(24)]
    patches = [take_patch(draw, 'cut', HERTZ, NOMINAL.rms) for draw in draws]
    assert all(patch.scale == 1.0 for patch in patches)
    levelled = np.array([rms_over(patch, HERTZ, (51, 201)) for patch in patches])
    assert 0.045e-6 < levelled.min() < 0.065e-6
    assert 0.085e-6 < levelled.max() < 0.12e-6
    # With their slope left in, as a stylus without levelling sees them: 0.06 to 0.14 um.
    tilted = np.array([rms_over(draw, HERTZ, (51, 201)) for draw in draws])
    assert np.percentile(tilted, 10) == pytest.approx(0.06e-6, abs=0.01e-6)
    assert 0.1e-6 < tilted.max() < 0.16e-6
    assert np.all(levelled <= tilted * 1.001)


@given(x=PLACE, y=PLACE, seed=st.integers(0, 20))
def test_a_shift_moves_the_place_to_the_centre(x, y, seed):
    """Raw surface or patch: heights(0, 0) of the shifted are heights(x, y) of the first."""
    raw = fractal_surface(COARSE, seed)
    for surface in (raw, take_patch(raw, 'rescaled', HERTZ, COARSE.rms)):
        moved = shifted(surface, x, y)
        expected = surface.heights([x + 1e-5], [y + 2e-5])[0, 0]
        assert moved.heights([1e-5], [2e-5])[0, 0] == pytest.approx(expected, rel=1e-6, abs=1e-14)


def test_a_lay_runs_along_its_direction():
    x = np.arange(0, 1e-3, 2e-6)
    lags = np.array([4])
    ratio = {}
    for lay in ('isotropic', 'longitudinal', 'transverse'):
        along = across = 0.0
        for seed in range(6):
            heights = fractal_surface(NOMINAL, seed, lay=lay).heights(x, x)
            along += np.mean(structure_function(heights, lags))
            across += np.mean(structure_function(heights.T, lags))
        ratio[lay] = across / along
    assert ratio['isotropic'] == pytest.approx(1.0, rel=0.2)
    assert ratio['longitudinal'] > 10
    assert ratio['transverse'] < 0.1


def test_a_lay_keeps_the_rms(theoretical_rms):
    x = np.linspace(-40e-3, 40e-3, 300)
    rms = [
        np.sqrt(
            np.mean(
                [np.var(fractal_surface(COARSE, seed, lay=lay).heights(x, x)) for seed in range(4)]
            )
        )
        for lay in ('isotropic', 'longitudinal', 'transverse')
    ]
    np.testing.assert_allclose(rms, theoretical_rms(COARSE), rtol=0.06)


@pytest.mark.parametrize(
    ('act', 'sentence'),
    [
        (lambda: fractal_surface(NOMINAL, 0, lay='round'), 'lay_round_isotropic'),
        (lambda: fractal_surface(SHORT, 0), 'shortest_wavelength_20'),
        (
            lambda: take_patch(fractal_surface(NOMINAL, 0), 'whole', HERTZ, 1e-7),
            'patch_whole_rescaled',
        ),
        (lambda: Window(length_x=0.0, length_y=1.0), 'length_x_0_m'),
    ],
)
def test_bad_input_is_one_sentence(act, sentence, says):
    with pytest.raises(InputError) as caught:
        act()
    assert says(sentence) in str(caught.value)
    assert '\n' not in str(caught.value)


def test_a_surface_goes_on_without_end():
    """A metre along the track it is the surface moved there, and as rough as at its start."""
    x = 1e-6 * np.arange(200)
    far = RACEWAY.heights(1.0 + x, ACROSS)
    np.testing.assert_allclose(far, shifted(RACEWAY, 1.0, 0.0).heights(x, ACROSS), atol=1e-14)
    places = np.arange(0.0, 0.4, 1.3e-3)
    start, later = (np.std(RACEWAY.heights(where + places, ACROSS)) for where in (0.0, 2.0))
    assert later == pytest.approx(start, rel=0.1)
