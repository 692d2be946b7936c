# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Chains of all columns: which there are, and over which speeds."""

from dataclasses import replace

import numpy as np
import pytest
from surrogate.builder.full.columns import BESIDE, Columns, moved_records, NEAR_ONSET
from surrogate.formulas.load_sharing import idle_load
from surrogate.parameters import load_lubricant, load_screw
from surrogate.surface import SolvedPoint

LOADS, HEATS = np.array([-1000.0, 0.0, 1000.0]), np.array([293.15, 313.15, 333.15])
S = np.linspace(-3.0, 6.0, 10)


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
    """Two magnitudes; a third draw at the middle temperature; speeds fall."""
    chains = columns.chains(S)
    assert columns.reference == 1
    assert len(chains) == 2 * (2 + 3 + 2)
    for chain in chains.values():
        assert chain['load'] >= 0
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


def test_the_last_draw_is_solved_around_the_onset_and_at_a_far_speed(columns):
    """At the middle temperature; the others wherever any is."""
    asked, sought, full = columns.asked(S), columns.sought(S), columns.full(S)
    assert np.array_equal(asked[..., 0], sought)
    assert np.array_equal(asked[..., 1], sought)
    assert not asked[:, :, [0, 2], 2].any()
    assert np.array_equal(asked[:, :, 1, 2], sought[:, :, 1] & full[:, None])
    low, high = NEAR_ONSET
    near, far = S[full][:-1], S[full][-1]
    assert (near[0] >= low) & (near[-1] <= high < far)
    assert columns.needed(S)[full][:, :, 1].all()
    assert columns.needed(S)[S > far][0, :, 1].all()


def test_draws_are_doubled_on_the_verge_alone(columns):
    """At the middle temperature around the onset; far from it all are what there is elsewhere."""
    verge = 0.95 * idle_load(columns.screw)
    wide = replace(columns, draws=8, load=np.array([-verge, 0.0, verge]))
    asked, full = wide.asked(S), wide.full(S)
    assert asked.shape[-1] == wide.ensemble.most == 16
    near = full & (S < 2)
    assert near.sum() < full.sum()
    assert asked[near][:, [0, 2], 1].all()
    assert asked[full][:, :, 1, :8].all()
    assert not asked[full & ~near][..., 8:].any()
    assert not asked[:, 1, :, 8:].any()
    assert not asked[~full][..., 2:].any()
    assert columns.ensemble.most == 3


def test_without_a_far_speed_the_first_beyond_the_onset_tells_where_contact_ends(columns):
    """A range that ends there has no other."""
    short = replace(columns, speed_range=(0.2, 2.2))
    assert S[short.full(S)].tolist() == [-1.0, 0.0, 1.0]


def test_more_speeds_change_nothing_that_was_asked_for(columns):
    """Those left out in hot and cold oil and the far one stay; every new one is asked for."""
    more = np.union1d(S, [-1.5, 0.5, 3.5])
    later = replace(columns, first=S)
    old, new = np.isin(more, S), np.isin(more, [-1.5, 0.5, 3.5])
    assert not (later.sought(more)[old] & ~columns.sought(S)).any()
    assert np.array_equal(later.sought(more)[new], columns.needed(more)[new])
    assert set(S[columns.full(S)]) < set(more[later.full(more)])
    assert set(more[later.full(more)]) - set(S) == {0.5}


def test_hot_and_cold_oil_leave_out_every_second_speed_of_the_middle(columns):
    """Not the ends, nor what only they need, nor the far speed of all draws."""
    needed, sought = columns.needed(S), columns.sought(S)
    assert np.array_equal(sought[:, :, 1], needed[:, :, 1])
    common = np.flatnonzero(needed[:, :, 1].all(axis=1))
    for k in (0, 2):
        left_out = np.flatnonzero((needed & ~sought)[:, :, k].any(axis=1))
        assert left_out.size
        assert set(left_out) <= set(common[1:-1:2])
        assert np.flatnonzero(columns.full(S))[-1] not in left_out
        assert (np.diff(np.flatnonzero(sought[common][:, 1, k])) <= 2).all()


def test_chains_are_the_pieces_of_all_columns(columns):
    """Together they hold every speed that is asked for, once per load without its sign."""
    asked, found = columns.asked(S), np.zeros_like(columns.asked(S), dtype=int)
    for name, (j, k, draw), places in columns.chain_nodes(S):
        found[places, j, k, draw] += 1
        assert columns.chains(S)[name]['draw'] == draw
    assert np.array_equal(found, asked)


def test_a_draw_without_speeds_has_no_chain(columns):
    """Far from the onset all but the shared draws have their far speeds only."""
    slow = replace(columns, speed_range=(0.05, 0.08))
    names = slow.chains(S)
    assert len(names) == 2 * 3 * 2
    assert not any('draw 2' in name for name in names)


def test_both_signs_of_a_lopsided_range_share_their_chains(columns):
    """Though a load has another neighbour than its opposite."""
    loads = np.array([-4000.0, -1000.0, 0.0, 1000.0])
    onset = np.log([[9.0, 9.0, 9.0], [0.6, 1.2, 3.5], [0.5, 1.0, 3.0], [0.6, 1.2, 3.5]])
    lopsided = replace(columns, load=loads, log_onset=onset)
    needed = lopsided.needed(S)
    assert np.array_equal(needed[:, 1], needed[:, 3])
    seen = {}
    for name, _, places in lopsided.chain_nodes(S):
        assert seen.setdefault(name, places.tolist()) == places.tolist()


def test_nothing_is_solved_where_no_ball_is_pressed(columns):
    """Zero load of a free screw."""
    free = replace(columns, screw=replace(columns.screw, preload=0.0))
    assert {chain['load'] for chain in free.chains(S).values()} == {1000.0}


def test_loads_beside_the_idle_one_know_their_neighbours(columns):
    """Of both signs, towards zero; none on a screw without preload."""
    below = (1 - BESIDE) * idle_load(columns.screw)
    loads = np.array([-below, -1000.0, 0.0, 1000.0, below, 3000.0])
    wide = replace(columns, load=loads, log_onset=np.zeros((6, 3)))
    assert wide.verges() == [(0, 1), (4, 3)]
    assert columns.verges() == []


def test_records_move_with_their_nodes():
    """More speeds and loads: each record is found under the numbers of its own node."""
    before, loads = S, LOADS
    records = {
        (i, j, 1, 0): SolvedPoint(
            converged=True, rcs=float(before[i]), max_pressure=float(loads[j])
        )
        for i, j in np.ndindex(len(before), len(loads))
    }
    after = np.union1d(before, [-1.5, 0.5]), np.union1d(loads, [-1500.0, 300.0])
    moved = moved_records(records, (before, loads), after)
    assert len(moved) == len(records)
    for (i, j, _, _), point in moved.items():
        assert (after[0][i], after[1][j]) == (point.rcs, point.max_pressure)
    assert moved_records({}, (np.empty(0), np.empty(0)), after) == {}
