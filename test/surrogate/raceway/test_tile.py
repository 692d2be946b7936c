# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Tiles against the waves that they are made of."""

import math

import numpy as np
import pytest
from surrogate.raceway.scaling import draw_raceway, scale_spectrum
from surrogate.raceway.spectrum import RoughnessSpectrum
from surrogate.raceway.tile import draw_tile, Tile

SIZE, SHAPE = (120e-6, 60e-6), (240, 120)


def spectrum(**changes):
    given = {'rms': 0.12e-6, 'cutoff_long': 0.25e-3, 'fractal_dimension': 2.6}
    return scale_spectrum(RoughnessSpectrum(**given | changes))


def cosine(amplitude=1e-7, waves=(3, 2)):
    x, y = (np.arange(nodes) * side / nodes for nodes, side in zip(SHAPE, SIZE, strict=True))
    phase = 2 * math.pi * (waves[0] * x[:, None] / SIZE[0] + waves[1] * y / SIZE[1])
    return Tile(heights=amplitude * np.cos(phase), length=SIZE[0], width=SIZE[1])


def test_moments_and_factors_of_a_wave():
    number = 2 * math.pi * math.hypot(3 / SIZE[0], 2 / SIZE[1])
    for order in range(3):
        assert cosine().moment(order) == pytest.approx(0.5 * (1e-7 * number**order) ** 2)
    tile = cosine()
    number = 2 * math.pi * math.hypot(3 / SIZE[0], 2 / SIZE[1])
    halved = tile.filtered(np.where(np.isclose(tile.wave_number, number), 0.5, 0.0))
    assert halved.heights == pytest.approx(0.5 * tile.heights, abs=1e-20)


def test_heights_between_the_nodes_are_those_of_the_wave_and_repeat():
    tile, place = cosine(), np.array([13.37e-6, -41.1e-6])
    phase = 2 * math.pi * (3 * place / SIZE[0] + 2 * 7.7e-6 / SIZE[1])
    there = tile.height_at(place, np.full(2, 7.7e-6))
    assert there == pytest.approx(1e-7 * np.cos(phase), abs=1e-11)
    turned = tile.height_at(place + 2 * SIZE[0], np.full(2, 7.7e-6 - SIZE[1]))
    assert turned == pytest.approx(there, abs=1e-14)


def test_a_tile_holds_the_waves_of_its_draw():
    waves = spectrum()
    tile = draw_tile(waves, 3, size=SIZE, shape=SHAPE)
    drawn = draw_raceway(waves, 3)
    whole = 2 * math.pi / np.hypot(drawn.wave_number_x, drawn.wave_number_y) < 0.4 * SIZE[1]
    # Waves that share a node of the transform interfere, so that the sum of squares is near only.
    least = 0.5 * float(np.sum(drawn.amplitude[whole] ** 2))
    assert 0.7 * least < tile.moment(0) < 2.0 * 0.5 * float(np.sum(drawn.amplitude**2))
    assert tile.heights.mean() == pytest.approx(0.0, abs=1e-18)


def test_shorter_waves_are_left_out_and_another_field_is_another_surface():
    tile = draw_tile(spectrum(), 3, size=SIZE, shape=SHAPE, shortest=6e-6)
    power = np.abs(np.fft.rfft2(tile.heights))
    short = tile.wave_number > 2 * math.pi / 5.5e-6
    assert power[short].max() < 1e-9 * power.max()
    one, other = (
        draw_tile(spectrum(), 1, size=SIZE, shape=SHAPE, field=field).heights.ravel()
        for field in (0, 1)
    )
    assert abs(np.corrcoef(one, other)[0, 1]) < 0.3
