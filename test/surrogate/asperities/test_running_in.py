# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Raceways as they run: what is cut, by how much, and what is left alone."""

from dataclasses import replace
import math

import numpy as np
import pytest
from surrogate.asperities.running_in import (
    Cut,
    running_tiles,
    shortest_wave,
    tile_size,
    TILES,
    USUAL,
)
from surrogate.formulas.load_sharing import nut_forces
from surrogate.parameters import BallRoughness
from surrogate.raceway.scaling import scale_spectrum
from surrogate.raceway.stated import spectrum_of
from surrogate.raceway.tile import draw_tile


def rms(tiles):
    return math.sqrt(float(np.mean([tile.heights.var() for tile in tiles])))


def test_without_a_stated_load_the_relieved_nut_is_just_unloaded(screw):
    assert nut_forces(USUAL.load(screw), screw.preload)[1] == pytest.approx(0.0, abs=1e-6)
    assert Cut(working_load=1234.0).load(screw) == 1234.0


def test_each_state_is_cut_at_its_own_pressure():
    cut = Cut(hardness=8e9, run_in_pressure=4e9)
    assert (cut.pressure('new'), cut.pressure('run_in')) == (8e9, 4e9)
    assert Cut(traced_run_in=True).pressure('run_in') == 7e9


def test_a_profile_traced_after_running_in_is_cut_at_the_hardness_alone(screw):
    traced, new = (
        running_tiles(screw, 'screw', state, cut)
        for state, cut in (('run_in', Cut(traced_run_in=True)), ('new', USUAL))
    )
    assert len(traced) == TILES
    for one, other in zip(traced, new, strict=True):
        assert np.array_equal(one.heights, other.heights)


def test_a_softer_cut_lowers_the_summits_more(screw):
    """A prototype on this spectrum lost 0.3 % of Sq at 7 GPa, and 5 % at 3 GPa."""
    size, shape = tile_size(screw, 'screw')
    waves = scale_spectrum(spectrum_of(screw.roughness))
    whole = rms([draw_tile(waves, draw, size=size, shape=shape) for draw in range(TILES)])
    new, run = (rms(running_tiles(screw, 'screw', state)) for state in ('new', 'run_in'))
    assert 0.001 < 1 - new / whole < 0.02
    assert 0.03 < 1 - run / whole < 0.12


def test_waves_that_no_tile_holds_are_refused(screw, refused):
    long = replace(screw.roughness, cutoff_short=400e-6, cutoff_long=8e-3)
    refused('waves_longer_than', running_tiles, replace(screw, roughness=long), 'screw', 'new')


@pytest.mark.parametrize(
    ('given', 'sentence'),
    [
        ({'run_in_pressure': 6e9}, 'run_pressure_6'),
        ({'hardness': 4e9}, 'up_hardness_4'),
        ({'hardness': math.nan}, 'rising_numbers'),
        ({'working_load': -1.0}, 'working_load_1'),
    ],
)
def test_a_cut_that_contradicts_itself_is_refused(given, sentence, refused):
    refused(sentence, Cut, **given)


def test_tiles_hold_the_shortest_wave_on_enough_nodes(screw):
    (length, width), (rows, columns) = tile_size(screw, 'nut')
    assert shortest_wave(screw) * rows / length >= 8
    assert shortest_wave(screw) * columns / width >= 8
    assert rows % 2 == columns % 2 == 0


def test_the_ball_is_added(screw):
    rough = replace(screw, ball_roughness=BallRoughness(rms=0.05e-6))
    both, alone = (rms(running_tiles(one, 'screw', 'new')) for one in (rough, screw))
    assert both == pytest.approx(math.hypot(alone, 0.05e-6), rel=0.1)


def test_smooth_raceways_have_no_tiles(screw):
    smooth = replace(screw, roughness=replace(screw.roughness, rms=0.0))
    assert running_tiles(smooth, 'screw', 'run_in') == []


def test_a_load_that_presses_harder_than_the_summits_bear_is_refused(screw, refused):
    cut = Cut(working_load=5e5)
    refused('mean_pressure_gpa', running_tiles, screw, 'screw', 'run_in', cut)
