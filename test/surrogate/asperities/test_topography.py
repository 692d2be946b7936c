# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Acting height: limits, scaling, and what is left of single waves."""

from dataclasses import replace
import math

import numpy as np
import pytest
from surrogate.asperities.topography import acting_roughness, lay_of, left_by_rolling, WAVE_POWER
from surrogate.raceway.scaling import scale_spectrum
from surrogate.raceway.spectrum import RoughnessSpectrum
from surrogate.raceway.tile import draw_tile, Tile

MODULUS, SHORTEST = 113e9, 4e-6


def tiles(draws=(0, 1), **changes):
    given = {'rms': 0.12e-6, 'cutoff_long': 0.25e-3, 'fractal_dimension': 2.6}
    waves = scale_spectrum(RoughnessSpectrum(**given | changes))
    size, shape = (80e-6, 40e-6), (96, 48)
    return [draw_tile(waves, draw, size=size, shape=shape, shortest=SHORTEST) for draw in draws]


@pytest.fixture(scope='module')
def acting():
    return acting_roughness(tiles(), MODULUS, SHORTEST)


def shift(one, other):
    return np.array(other.log_height) - np.array(one.log_height)


def test_a_contact_leaves_of_a_wave_what_venner_has():
    """1/(1 + 0.125 n + 0.04 n^2) with n the reduction times the wavelength."""
    x = np.arange(64) / 64
    heights = np.cos(2 * math.pi * 4 * x)[:, None] + np.zeros((64, 8))
    left = left_by_rolling(Tile(heights=heights, length=1e-4, width=1e-5), 3.0 / 25e-6)
    assert left.heights.max() == pytest.approx(1 / (1 + 0.125 * 3 + 0.04 * 9))


def test_the_height_falls_is_exact_where_it_was_pressed_and_goes_on_beyond(acting):
    reductions, pressures = np.geomspace(1e4, 1e7, 40), np.geomspace(0.1e9, 4e9, 12)
    height = acting.height(reductions[:, None], pressures)
    assert (np.diff(height, axis=0) <= 0).all()
    assert (np.diff(height, axis=1) <= 1e-12).all()
    for row, reduction in enumerate(acting.log_reduction):
        for column, pressure in enumerate(acting.log_pressure):
            found = acting.height(math.exp(reduction), math.exp(pressure))
            assert math.log(found) == pytest.approx(acting.log_height[row][column], abs=1e-9)
    far = math.exp(acting.log_reduction[-1]) * np.array([2.0, 4.0])
    one, other = acting.height(far, 1e9)
    assert one / other == pytest.approx(4.0)


@pytest.mark.parametrize('factor', [0.5, 3.0])
def test_heights_follow_those_of_the_tile_in_elastic_contact(acting, factor):
    """Heights times s on a body 1/s as stiff press alike: gaps are s times as high."""
    scaled = [replace(tile, heights=factor * tile.heights) for tile in tiles()]
    other = acting_roughness(scaled, MODULUS / factor, SHORTEST)
    assert shift(acting, other) == pytest.approx(math.log(factor), abs=1e-9)


def test_a_larger_copy_is_higher_but_for_the_power_of_the_wave(acting):
    larger = [
        replace(tile, heights=2 * tile.heights, length=2 * tile.length, width=2 * tile.width)
        for tile in tiles()
    ]
    other = acting_roughness(larger, MODULUS, 2 * SHORTEST)
    assert shift(acting, other) == pytest.approx((1 + WAVE_POWER) * math.log(2), abs=1e-9)


@pytest.mark.parametrize(
    ('lay', 'expected'), [('longitudinal', 0.95), ('isotropic', 0.0), ('transverse', -0.95)]
)
def test_lay_is_the_anisotropy_of_the_slopes(lay, expected):
    fan = None if lay == 'isotropic' else math.radians(20)
    found = [lay_of(tile) for tile in tiles(lay=lay, fan_angle=fan)]
    assert found == pytest.approx([expected, expected], abs=0.1)
