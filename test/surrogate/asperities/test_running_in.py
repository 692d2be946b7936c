# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Raceways as they run: what is cut, by how much, and what is left alone."""

from dataclasses import replace
import math

import numpy as np
import pytest
from surrogate.asperities.running_in import (
    LONG_TILES,
    running_tiles,
    RunningContact,
    tile_size,
    working_load,
    working_pressure,
)
from surrogate.formulas.geometry import hertz, screw_contact, SIDES
from surrogate.formulas.load_sharing import normal_force, nut_forces
from surrogate.parameters import BallRoughness
from surrogate.raceway.scaling import scale_spectrum
from surrogate.raceway.tile import draw_tile
from surrogate.screw.screw_onset import with_raceway


def rms(tiles):
    return math.sqrt(float(np.mean([tile.heights.var() for tile in tiles])))


def test_without_a_stated_load_the_relieved_nut_is_just_unloaded(screw):
    assert nut_forces(working_load(screw), screw.preload)[1] == pytest.approx(0.0, abs=1e-6)
    assert working_load(replace(screw, working_load=1234.0)) == 1234.0


@pytest.mark.parametrize('side', SIDES)
def test_the_working_pressure_is_that_of_the_loaded_nut(screw, side):
    """Under preload alone that of a stated load of 0; beyond unloading, the cube root of it."""
    contact = screw_contact(screw, side)
    preload = hertz(contact, float(normal_force(screw, screw.preload))).max_pressure
    assert working_pressure(replace(screw, working_load=0.0), side) == pytest.approx(preload)
    light, heavy = (
        working_pressure(replace(screw, working_load=load), side) for load in (4e3, 32e3)
    )
    assert preload < working_pressure(screw, side) < light
    assert heavy == pytest.approx(2 * light)


def test_a_profile_traced_after_running_in_is_cut_at_the_hardness_alone(screw):
    traced, new = (
        running_tiles(RunningContact.of(with_raceway(screw, **keys), 'screw'))
        for keys in ({'state': 'run_in', 'traced': 'run_in'}, {'state': 'new'})
    )
    assert len(traced) == LONG_TILES
    for one, other in zip(traced, new, strict=True):
        assert np.array_equal(one.heights, other.heights)


def test_a_softer_cut_lowers_the_summits_more(screw):
    """A prototype on this spectrum lost 0.3 % of Sq at 7 GPa, and 5 % at 3 GPa."""
    size, shape = tile_size(RunningContact.of(screw, 'screw'))
    waves = scale_spectrum(screw.roughness)
    whole = rms([draw_tile(waves, draw, size=size, shape=shape) for draw in range(LONG_TILES)])
    new, run = (
        rms(running_tiles(RunningContact.of(with_raceway(screw, state=state), 'screw')))
        for state in ('new', 'run_in')
    )
    assert 0.001 < 1 - new / whole < 0.02
    assert 0.03 < 1 - run / whole < 0.12


def test_what_no_tile_holds_and_no_cut_finds_is_refused(screw, refused, monkeypatch):
    long = with_raceway(screw, cutoff_short=400e-6, cutoff_long=8e-3)
    refused('waves_longer_contact', running_tiles, RunningContact.of(long, 'screw'))
    monkeypatch.setattr('surrogate.raceway.dry_contact.MOST', 2)
    refused('summits_not_found', running_tiles, RunningContact.of(screw, 'screw'))


def test_tiles_hold_the_shortest_wave_and_the_ball_and_smooth_raceways_have_none(screw):
    nut = RunningContact.of(screw, 'nut')
    (length, width), (rows, columns) = tile_size(nut)
    assert nut.resolved_wave == pytest.approx(2 * math.pi / nut.waves[0].wave_number[-1])
    assert nut.resolved_wave * rows / length >= 8
    assert nut.resolved_wave * columns / width >= 8
    assert (length, width) == pytest.approx((4 * nut.half_length, 2 * nut.half_length))
    assert rows % 2 == columns % 2 == 0
    rough = replace(screw, ball_roughness=BallRoughness(rms=0.05e-6))
    both, alone = (rms(running_tiles(RunningContact.of(one, 'screw'))) for one in (rough, screw))
    assert both == pytest.approx(math.hypot(alone, 0.05e-6), rel=0.1)
    assert running_tiles(RunningContact.of(with_raceway(screw, rms=0.0), 'screw')) == []
