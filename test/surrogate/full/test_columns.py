# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Chains of all columns: which there are, and over which speeds."""

from dataclasses import replace

import numpy as np
import pytest
from surrogate.full.chain import FINE, HALF
from surrogate.full.columns import ANCHOR_STEP, ANCHORED, Columns, NEAR_ONSET
from surrogate.full.idle import BESIDE, idle_load
from surrogate.parameters import load_lubricant, load_screw

LOADS, HEATS = np.array([-1000.0, 0.0, 1000.0]), np.array([293.15, 313.15, 333.15])
S, FINE_S = np.linspace(-3.0, 6.0, 10), np.linspace(-3.0, 6.0, 61)
NOT_DRY = np.zeros(len(S), dtype=bool)


@pytest.fixture(name='columns')
def make_columns():
    """Return three loads and three temperatures with an onset that moves with both."""
    return Columns(
        screw=load_screw('nominal'),
        lubricant=load_lubricant('iso_vg_68'),
        load=LOADS,
        temperature=HEATS,
        speed_range=(0.2, 100.0),
        draws=3,
        shared_draws=2,
        log_onset=np.log([[0.5, 1.0, 3.0], [0.6, 1.2, 3.5], [0.5, 1.0, 3.0]]),
    )


def test_loads_of_either_sign_share_their_chains(columns):
    """Two magnitudes; the third draw at the middle temperature alone; speeds fall."""
    assert columns.reference == 1
    half = columns.chains(S, columns.asked_half(S), HALF)
    fine = columns.chains(S, columns.asked_fine(S, NOT_DRY), FINE)
    assert len(half) == 2 * (3 * 2 + 1)
    assert len(fine) == 2 * 3
    for grid, chains in ((HALF, half), (FINE, fine)):
        for chain in chains.values():
            assert chain['load'] >= 0
            assert chain['grid'] == grid
            assert chain['speeds'] == sorted(chain['speeds'], reverse=True)


def test_what_a_lookup_reads_is_solved_and_little_else(columns):
    """Around every cell of loads that holds a speed of the range both columns are needed."""
    needed = columns.needed(S)
    low, high = np.log(columns.speed_range)
    for j, k in np.ndindex(2, 3):
        onset = columns.log_onset[slice(j, j + 2), k]
        inside = (S[1:] > low - onset.max()) & (S[:-1] < high - onset.min())
        for i in np.flatnonzero(inside):
            assert needed[slice(i, i + 2), slice(j, j + 2), k].all()
    assert not needed.all()


def test_the_last_draw_is_solved_around_the_onset_and_at_two_far_speeds(columns):
    """On the half grid at the middle temperature; the others everywhere needed."""
    asked, needed, full = columns.asked_half(S), columns.needed(S), columns.full(S)
    assert np.array_equal(asked[..., 0], needed)
    assert np.array_equal(asked[..., 1], needed)
    assert not asked[:, :, [0, 2], 2].any()
    assert np.array_equal(asked[:, :, 1, 2], needed[:, :, 1] & full[:, None])
    low, high = NEAR_ONSET
    around = np.flatnonzero(full)
    near, (beyond, *far) = around[S[around] <= high], around[S[around] > high]
    assert low <= S[near[0]] < low + 1
    assert beyond == near[-1] + 1
    assert len(far) == 2
    assert needed[far][:, :, 1].all()
    assert not needed[far[-1] + 1, :, 1].all()


def test_anchors_keep_their_distance_and_one_is_far(columns):
    """All draws on the fine grid there, at the middle temperature alone."""
    anchors, asked = columns.anchors(FINE_S), columns.asked_fine(FINE_S, FINE_S < -2.5)
    near = FINE_S[anchors & (FINE_S < ANCHORED[1])]
    assert near[0] == pytest.approx(-1.2)
    assert near[-1] <= ANCHORED[1]
    assert np.diff(near).min() >= ANCHOR_STEP
    assert np.diff(near).max() < 2 * ANCHOR_STEP
    assert (FINE_S[anchors] > NEAR_ONSET[1]).sum() == 1
    needed = columns.needed(FINE_S)[:, :, 1]
    assert np.array_equal(asked[anchors][:, :, 1].all(axis=-1), needed[anchors])
    assert not asked[:, :, [0, 2]].any()


def test_few_draws_on_the_fine_grid_beyond_the_anchors(columns):
    """Slower ones that are not dry, the first beyond the onset and the last."""
    ends = columns.ends(FINE_S, FINE_S < -2.5)
    assert np.array_equal(ends[FINE_S < ANCHORED[0]], FINE_S[FINE_S < ANCHORED[0]] >= -2.5)
    beyond, last = FINE_S[ends & (FINE_S > 0)]
    assert NEAR_ONSET[1] < beyond < NEAR_ONSET[1] + 0.3
    assert columns.needed(FINE_S)[FINE_S == last, :, 1].all()
    asked = columns.asked_fine(FINE_S, FINE_S < -2.5)[:, :, 1]
    assert not asked[ends][..., 2].any()
    assert np.array_equal(asked[ends][..., 0], columns.needed(FINE_S)[ends][:, :, 1])


def test_chains_are_the_pieces_of_all_columns(columns):
    """Together they hold every speed that is asked for, once per load without its sign."""
    for asked in (columns.asked_half(S), columns.asked_fine(S, NOT_DRY)):
        found = np.zeros_like(asked, dtype=int)
        for name, (j, k, draw), places in columns.chain_nodes(asked):
            found[places, j, k, draw] += 1
            assert columns.chains(S, asked, FINE)[name]['draw'] == draw
        assert np.array_equal(found, asked)


def test_a_draw_without_speeds_has_no_chain(columns):
    """Far from the onset the third draw has nothing to say."""
    slow = replace(columns, speed_range=(0.05, 0.08))
    names = slow.chains(S, slow.asked_half(S), HALF)
    assert len(names) == 2 * 3 * 2
    assert not any('draw 2' in name for name in names)


def test_waves_that_are_left_out_are_in_the_chains(columns):
    """The shortest wavelength of the settings reaches the solver."""
    long = replace(columns, grid_wavelength=8e-6)
    chain = long.chain(0.0, 313.15, 0, np.array([1.0]), FINE)
    assert chain['grid_wavelength'] == 8e-6


def test_both_signs_of_a_lopsided_range_share_their_chains(columns):
    """Though a load has another neighbour than its opposite."""
    loads = np.array([-4000.0, -1000.0, 0.0, 1000.0])
    onset = np.log([[9.0, 9.0, 9.0], [0.6, 1.2, 3.5], [0.5, 1.0, 3.0], [0.6, 1.2, 3.5]])
    lopsided = replace(columns, load=loads, log_onset=onset)
    needed = lopsided.needed(S)
    assert np.array_equal(needed[:, 1], needed[:, 3])
    seen = {}
    for name, _, places in lopsided.chain_nodes(lopsided.asked_half(S)):
        assert seen.setdefault(name, places.tolist()) == places.tolist()


def test_nothing_is_solved_where_no_ball_is_pressed(columns):
    """Zero load of a free screw."""
    free = replace(columns, screw=replace(columns.screw, preload=0.0))
    assert {chain['load'] for chain in free.chains(S, free.asked_half(S), HALF).values()} == {
        1000.0
    }


def test_loads_beside_the_idle_one_know_their_neighbours(columns):
    """Of both signs, towards zero; none on a screw without preload."""
    below = (1 - BESIDE) * idle_load(columns.screw)
    loads = np.array([-below, -1000.0, 0.0, 1000.0, below, 3000.0])
    wide = replace(columns, load=loads, log_onset=np.zeros((6, 3)))
    assert wide.verges() == [(0, 1), (4, 3)]
    assert columns.verges() == []
