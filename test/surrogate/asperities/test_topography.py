# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Acting height: limits, scaling, and what is left of single waves."""

from dataclasses import replace
import math

import numpy as np
import pytest
from surrogate.asperities.topography import (
    acting_roughness,
    isotropy,
    lay_of,
    left_by_rolling,
    WAVE_POWER,
)
from surrogate.ehl import ContactLubricant
from surrogate.ehl.moving import march_strip, MarchSettings, StripContact
from surrogate.formulas.line import central_film_line, moes_line
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


@pytest.mark.parametrize(('angle', 'length'), [(90, 0.25), (90, 1.0), (45, 0.5), (45, 1.0)])
def test_a_wave_that_is_marched_is_flattened_by_its_direction(angle, length):
    """
    Amplitudes of solved films, whose equations know no flattening; 90 deg: ridges along the track.

    An isotropic tile has the wave and another one beside it, so that its slopes have no direction.
    Without directions these waves would keep 1.03 to 1.74 times what is left of them.

    """
    half, speed, oil = 36e-6, 0.1, ContactLubricant(viscosity=0.06, pressure_viscosity=2e-8)
    number, turned = 2 * math.pi / (length * half), math.radians(angle)
    along, across = number * math.cos(turned), number * math.sin(turned)
    strip = StripContact(
        radius=2.5e-3,
        reduced_modulus=226.4e9,
        max_pressure=226.4e9 * half / (4 * 2.5e-3),
        width=2 * math.pi / across,
        columns=16,
    )
    size = 0.1 * float(central_film_line(strip.line, speed, oil.viscosity, oil.pressure_viscosity))
    solved = march_strip(
        strip,
        oil,
        speed,
        lambda x, y: size * np.cos(along * x + across * y),
        transits=1.0,
        settings=MarchSettings(nx=129, places=1, film_floor=1e-10),
    )
    middle = np.abs(solved.x_nodes) < 0.5 * strip.semi_axis
    waves = np.abs(np.fft.rfft(solved.film[middle][:, 1:-1], axis=1)[:, 1]) * 2 / 16
    M1, L = moes_line(strip.line, speed, oil.viscosity, oil.pressure_viscosity)
    # Four of these waves along a tile of 64 nodes, and four that are turned by 90 deg.
    x = 2 * math.pi * np.arange(64) / 64
    ways = ((0, 4), (4, 0)) if angle == 90 else ((4, 4), (4, -4))
    heights = np.sum([np.cos(m * x[:, None] + n * x) for m, n in ways], axis=0)
    side = 2 * math.pi * math.hypot(*ways[0]) / number
    tile = Tile(heights=heights, length=side, width=side)
    left = left_by_rolling(tile, float(M1**0.75 / np.sqrt(L)) / strip.semi_axis)
    kept = np.abs(np.fft.fft2(left.heights))[ways[0]] * 2 / heights.size
    assert kept == pytest.approx(waves.mean() / size, rel=0.11)


@pytest.mark.parametrize(('lay', 'share'), [(0.1, 1.0), (-0.4, 0.5), (0.64, 0.0), (-0.99, 0.0)])
def test_waves_of_a_lay_are_flattened_by_its_constants_alone(lay, share):
    assert float(isotropy(lay)) == pytest.approx(share)


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
