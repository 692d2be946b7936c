# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Surfaces periodic across the track: exactly so, near the ones they come from, cost reported."""

from dataclasses import replace
import math

from hypothesis import given
from hypothesis import strategies as st
import numpy as np
import pytest
from surrogate.raceway.fractal import FractalSurface
from surrogate.raceway.periodic import periodic_across, turn_and_loss
from surrogate.raceway.scaling import draw_raceway, scale_spectrum
from surrogate.raceway.spectrum import RoughnessSpectrum

SPECTRUM = RoughnessSpectrum(rms=1e-7, cutoff_long=0.25e-3, fractal_dimension=2.5)


def one_wave(along, across, amplitude=1e-7):
    """Return a surface of one wave with its wave numbers in turns per millimetre."""
    numbers = {
        f'wave_number_{name}': np.array([2e3 * math.pi * value])
        for name, value in (('x', along), ('y', across))
    }
    return FractalSurface(amplitude=np.array([amplitude]), phase=np.array([0.3]), **numbers)


@given(width=st.floats(1e-4, 5e-3), seed=st.integers(0, 50), y=st.floats(-1e-3, 1e-3))
def test_heights_repeat_across_the_track(width, seed, y):
    surface = periodic_across(draw_raceway(scale_spectrum(SPECTRUM), seed), width)
    heights = surface.heights(np.linspace(0, 1e-3, 7), y + width * np.array([0, 1, -1, 10]))
    np.testing.assert_allclose(heights, heights[:, :1] * np.ones(4), atol=1e-17)


@given(width=st.floats(1e-4, 5e-3), seed=st.integers(0, 50))
def test_waves_move_by_half_a_step_across_or_keep_their_length(width, seed):
    """Nearest multiples; where the length changes, the part along the track does not."""
    before = draw_raceway(scale_spectrum(SPECTRUM), seed)
    after = periodic_across(before, width)
    step = 2 * math.pi / width
    assert np.all(np.abs(after.wave_number_y - before.wave_number_y) <= step / 2 * (1 + 1e-9))
    old, new = (np.hypot(one.wave_number_x, one.wave_number_y) for one in (before, after))
    kept = np.isclose(old, new, rtol=1e-9)
    assert np.all(kept | (after.wave_number_x == before.wave_number_x))
    np.testing.assert_array_equal(after.amplitude, before.amplitude)
    np.testing.assert_array_equal(after.phase, before.phase)


def amounts(surface):
    """Return the amounts of the wave vectors of a surface [rad/m]."""
    return np.hypot(surface.wave_number_x, surface.wave_number_y)


def test_the_cost_falls_with_the_width_and_single_waves_keep_their_length():
    """A steep wave keeps its length, one that runs across keeps its part along the track."""
    surface = draw_raceway(scale_spectrum(SPECTRUM), 1)
    found = [periodic_across(surface, width) for width in (5e-4, 5e-3, 5e-2)]
    turns = [turn_and_loss(surface, periodic)[0] for periodic in found]
    stretches = [np.abs(amounts(surface) / amounts(periodic) - 1) for periodic in found]
    changes = [np.sqrt(surface.amplitude**2 @ stretch**2) for stretch in stretches]
    for costs in (turns, changes, [stretch.max() for stretch in stretches]):
        assert costs[0] > costs[1] > costs[2]
    assert turns[2] < 0.02 * turns[0]
    assert changes[2] < 0.02 * changes[0]
    again = periodic_across(found[1], 5e-3)
    assert turn_and_loss(found[1], again) == pytest.approx((0, 0), abs=1e-9)
    np.testing.assert_allclose(amounts(again), amounts(found[1]), rtol=1e-9)
    steep = one_wave(40.0, 1.1)
    turned = periodic_across(steep, 1e-3)
    assert turned.wave_number_y == pytest.approx(2e3 * math.pi)
    assert amounts(turned) == pytest.approx(amounts(steep), rel=1e-12)
    assert turn_and_loss(steep, turned)[0] == pytest.approx(0.1 / 40, rel=0.01)
    stretched = periodic_across(one_wave(0.2, 10.4), 1e-3)
    assert stretched.wave_number_x == pytest.approx(2e3 * math.pi * 0.2)
    assert amounts(one_wave(0.2, 10.4)) / amounts(stretched) == pytest.approx(1.04, rel=4e-4)
    flat = one_wave(0.0, 0.3)
    assert turn_and_loss(flat, periodic_across(flat, 1e-3)) == (0.0, 1.0)


def test_ridges_along_the_track_stay_so():
    """A longitudinal lay without a fan is the same at every place of the track, snapped or not."""
    ridges = replace(SPECTRUM, lay='longitudinal', fan_angle=0.0)
    surface = draw_raceway(scale_spectrum(ridges), 2)
    found = periodic_across(surface, 0.7e-3)
    heights = found.heights(np.linspace(0, 1e-3, 5), np.linspace(0, 1e-3, 50))
    np.testing.assert_allclose(heights, heights[:1] * np.ones((5, 1)), atol=1e-17)
    assert turn_and_loss(surface, found)[0] < 1e-9
    assert not np.allclose(amounts(found), amounts(surface), rtol=1e-9)


def test_what_has_no_period_is_refused(refused):
    refused('strip_width_1', periodic_across, one_wave(1.0, 1.0), -1e-3)
    with refused('slopes_across_track'):
        periodic_across(replace(one_wave(1.0, 1.0), plane=(0.0, 0.0, 1e-3)), 1e-3)
