# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Dry contact against Westergaard's wave, exact limits and identities."""

import math

from hypothesis import given
from hypothesis import strategies as st
import numpy as np
import pytest
from surrogate.raceway.dry_contact import press, run_in
from surrogate.raceway.tile import Tile

MODULUS = 113e9
LENGTH, WIDTH, AMPLITUDE = 20e-6, 5e-6, 50e-9
FULL = math.pi * MODULUS * AMPLITUDE / LENGTH
"""Mean pressure at which Westergaard's wave touches everywhere [Pa]."""


def wave(nodes=256, amplitude=AMPLITUDE):
    x = np.arange(nodes) / nodes
    heights = amplitude * np.cos(2 * math.pi * x)[:, None] + np.zeros((nodes, 8))
    return Tile(heights=heights, length=LENGTH, width=WIDTH)


def rough(seed, scale=1.0):
    """Return a tile of random waves of like amplitude."""
    random = np.random.default_rng(seed)
    shape, number = (48, 32), np.arange(1, 7)
    transform = np.zeros(shape, dtype=complex)
    transform[np.ix_(number, number)] = np.exp(2j * math.pi * random.random((6, 6)))
    heights = np.real(np.fft.ifft2(transform))
    heights *= scale * 40e-9 / heights.std()
    return Tile(heights=heights, length=24e-6, width=16e-6)


@pytest.mark.parametrize('share', [0.1, 0.3, 0.6, 0.9])
def test_a_wave_is_pressed_as_westergaard_has_it(share):
    """p(x) = 2 p cos(psi)/s sqrt(s - sin^2 psi), s = sin^2(pi a/lambda) = p/p*."""
    found = press(wave(), MODULUS, share * FULL)
    assert found.converged
    edge = math.asin(math.sqrt(share))
    assert found.contact_share == pytest.approx(2 * edge / math.pi, abs=0.012)
    psi = math.pi * (np.arange(256) / 256 + 0.5) % math.pi - 0.5 * math.pi
    inside = np.maximum(share - np.sin(psi) ** 2, 0.0)
    exact = 2 * share * FULL * np.cos(psi) / share * np.sqrt(inside)
    assert found.pressure[:, 3] == pytest.approx(exact, abs=0.025 * exact.max())


def test_beyond_full_contact_the_wave_is_followed():
    found = press(wave(), MODULUS, 1.5 * FULL)
    exact = FULL * (1.5 + np.cos(2 * math.pi * np.arange(256) / 256))
    assert found.pressure[:, 0] == pytest.approx(exact, rel=2e-3)
    assert found.separation == pytest.approx(0.0, abs=1e-12)


@given(seed=st.integers(0, 50), share=st.floats(0.5, 0.98), scale=st.floats(1.0, 30.0))
def test_where_nearly_all_yields_each_node_is_at_a_bound_or_touches(seed, share, scale):
    """Gaps are above 0 where nothing is carried, below 0 where the hardness is, else 0."""
    found = press(rough(seed, scale), MODULUS, share * 1e9, hardness=1e9, tolerance=1e-5)
    assert found.converged
    assert found.pressure.mean() == pytest.approx(share * 1e9, rel=1e-6)
    small = 2e-3 * scale * 40e-9
    assert found.gap[found.pressure == 0].min(initial=0.0) > -small
    assert found.gap[found.pressure >= 1e9].max(initial=0.0) < small
    assert np.abs(found.gap[(found.pressure > 0) & (found.pressure < 1e9)]).max(initial=0) < small


@pytest.mark.parametrize('seed', [3, 4, 5])  # the last two without a free node
def test_mountains_yield_wherever_they_touch(seed):
    found = press(rough(seed, 300.0), MODULUS, 0.5e9, hardness=1e9)
    assert found.converged
    assert found.contact_share == pytest.approx(0.5, abs=1e-3)
    assert found.gap[found.pressure >= 1e9].max() <= 1e-12


@given(seed=st.integers(0, 50), hardness=st.floats(1.0, 20.0), share=st.floats(0.05, 0.8))
def test_no_node_carries_more_than_the_hardness_and_the_load_is_carried(seed, hardness, share):
    mean = share * hardness * 1e9
    found = press(rough(seed), MODULUS, mean, hardness=hardness * 1e9)
    assert found.pressure.max() <= hardness * 1e9 * (1 + 1e-12)
    assert found.pressure.min() >= 0
    assert found.pressure.mean() == pytest.approx(mean, rel=2e-3)
    assert found.converged


@given(seed=st.integers(0, 50), scale=st.floats(0.1, 8.0))
def test_gaps_scale_with_heights_and_pressures_together(seed, scale):
    one = press(rough(seed), MODULUS, 0.3e9, tolerance=1e-6)
    other = press(rough(seed, scale), MODULUS, scale * 0.3e9, tolerance=1e-6)
    assert other.separation == pytest.approx(scale * one.separation, rel=1e-3)


@given(seed=st.integers(0, 50))
def test_a_second_pass_is_elastic(seed):
    first, found = run_in(rough(seed), MODULUS, 1e9, 3e9)
    second, _ = run_in(first, MODULUS, 1e9, 3e9)
    sunk = (rough(seed).heights - first.heights).max()
    assert sunk > 0
    assert np.abs(second.heights - first.heights).max() < 0.02 * sunk


@given(seed=st.integers(0, 50), scale=st.floats(1.0, 30.0), mean=st.floats(0.1, 9.0))
def test_the_tile_rises_evenly_by_the_volume_that_summits_give_up(seed, scale, mean):
    tile = rough(seed, scale)
    lower, contact = run_in(tile, MODULUS, mean * 1e9, 3e9)
    moved = lower.heights - tile.heights
    assert moved.mean() == pytest.approx(0.0, abs=1e-6 * np.abs(moved).max())
    apart = contact.pressure == 0
    assert moved[apart] == pytest.approx(moved.max(), rel=1e-9)
    assert moved.max() >= 0
    assert (moved[~apart] <= moved.max()).all()


@pytest.mark.parametrize('pressure', [0.1, 0.3, 1.0, 3.0])
def test_summits_persist_as_pullen_and_williamson_have_them(pressure):
    """
    Summits that yield all are cut by a flat; what is apart rises by their volume, and persists.

    The real area is p/(p + H), in a second pass as in the first, also where the mean is above the
    hardness. The height above which so much of a tile lies gives gaps and volume.

    """
    tile, share = rough(3, 300.0), pressure / (pressure + 1)
    lower, first = run_in(tile, MODULUS, pressure * 3e9, 3e9)
    _, second = run_in(lower, MODULUS, pressure * 3e9, 3e9)
    flat = float(np.quantile(tile.heights, 1 - share))
    gap, volume = (np.maximum(sign * (tile.heights - flat), 0.0).mean() for sign in (-1, 1))
    for contact in (first, second):
        assert contact.contact_share == pytest.approx(share, abs=0.005)
        assert contact.separation == pytest.approx(gap, rel=0.02)
    risen = lower.heights - tile.heights
    assert risen[first.pressure == 0] == pytest.approx(volume, rel=0.02)


def test_nothing_sinks_below_the_hardness_and_more_the_softer_the_summits():
    tile = rough(1)
    most = press(tile, MODULUS, 0.5e9).pressure.max()
    assert np.array_equal(run_in(tile, MODULUS, 0.5e9, 1.1 * most)[0].heights, tile.heights)
    sunk = [
        (rough(2).heights - run_in(rough(2), MODULUS, 1e9, hardness)[0].heights).max()
        for hardness in (8e9, 5e9, 3e9, 2e9)
    ]
    assert sunk == sorted(sunk)
    assert sunk[0] < 0.1 * sunk[-1]


@pytest.mark.parametrize('share', [0.1, 0.3, 0.5])
def test_high_summits_yield_all_and_the_area_is_the_load_over_the_hardness(share):
    found = press(rough(3, 3.0), MODULUS, share * 1e9, hardness=1e9)
    assert found.contact_share == pytest.approx(share, rel=0.05)


@pytest.mark.parametrize('hardness', [math.inf, 5e9, 3e9])
def test_area_pressure_and_what_sinks_are_those_of_an_independent_solver(hardness):
    """Elastic and with summits that yield, as ContactMechanics has them."""
    mechanics = pytest.importorskip('ContactMechanics')
    optimization = pytest.importorskip('ContactMechanics.Optimization')
    topography = pytest.importorskip('SurfaceTopography')
    tile, mean = rough(4, 3.0), 1e9
    size, cell = (tile.length, tile.width), tile.length * tile.width / tile.heights.size
    theirs = optimization.constrained_conjugate_gradients(
        mechanics.PeriodicFFTElasticHalfSpace(tile.heights.shape, MODULUS, size),
        topography.Topography(tile.heights, size, periodic=True),
        hardness=None if math.isinf(hardness) else hardness * cell,
        external_force=mean * tile.length * tile.width,
        pentol=1e-13,
    )
    assert theirs.success
    pressure, gap = np.abs(theirs.jac) / cell, theirs.x - tile.heights - theirs.offset
    found = press(tile, MODULUS, mean, hardness=hardness)
    assert found.contact_share == pytest.approx((pressure > 0).mean(), abs=1e-3)
    assert np.abs(found.pressure - pressure).sum() < 3e-4 * pressure.sum()
    assert found.gap == pytest.approx(gap, abs=0.1e-9)
    sunk = np.where(pressure >= hardness * (1 - 1e-9), np.maximum(-gap, 0.0), 0.0)
    assert (sunk.max() > 50e-9) == (hardness < math.inf)
    if hardness < math.inf:
        lower, _ = run_in(tile, MODULUS, mean, hardness - mean)
        assert tile.heights - lower.heights == pytest.approx(sunk - sunk.mean(), abs=0.1e-9)


@pytest.mark.parametrize('mean', [0.0, 7e9, 9e9, math.nan])
def test_a_mean_pressure_that_no_raceway_carries_is_refused(mean, refused):
    refused('mean_pressure_below', press, rough(1), MODULUS, mean, hardness=7e9)
