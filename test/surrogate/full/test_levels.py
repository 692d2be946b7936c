# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The two grids of the nodes: what is dry, what is weak, which contact is the worst."""

import numpy as np
import pytest
from surrogate.build import speed_at_film_ratio
from surrogate.full.chain import FINE, HALF
from surrogate.full.columns import Columns
from surrogate.full.levels import commonest, DRY, dry, gather, solve_levels, worst_contacts

LOADS, HEATS = np.array([0.0, 1000.0]), np.array([293.15, 313.15, 333.15])
S = np.linspace(-5.0, 6.0, 12)


@pytest.fixture(name='columns')
def make_columns(screw, oil):
    """Return two loads and three temperatures, s = 0 at one film ratio."""
    onset = speed_at_film_ratio(screw, oil, LOADS[:, None], HEATS, 0.1)
    return Columns(
        screw=screw,
        lubricant=oil,
        load=LOADS,
        temperature=HEATS,
        speed_range=(0.003, 100.0),
        draws=3,
        shared_draws=2,
        log_onset=np.log(onset),
    )


def test_dry_nodes_are_slow_and_not_solved_on_the_fine_grid(columns, stand_in):
    """RCS of two draws above the limit at either load; they still are on the half grid."""
    half, fine = solve_levels(columns, S, stand_in.run)
    found = dry(columns, half)
    rcs = half.values['rcs'][:, :, 1, :2].mean(axis=-1)
    assert found.any()
    assert (rcs[found] >= DRY).all()
    assert (rcs[~found & (S < 0)].min(axis=1) < DRY).all()
    assert not fine.asked[found].any()
    assert half.asked[found, :, 1].any()


def test_a_range_that_is_all_dry_has_one_speed_on_the_fine_grid(columns, stand_in):
    """Nothing is known of the grid otherwise."""
    slow = S[S < -3.5]
    half, fine = solve_levels(columns, slow, stand_in.run)
    assert np.nanmin(half.values['rcs']) > DRY
    assert fine.asked.any(axis=(1, 2, 3)).tolist() == [False] * (len(slow) - 1) + [True]


def test_a_level_knows_what_its_chains_say(columns, stand_in):
    """One node by hand; the draw of a chain that failed is unknown, and its node weak."""
    asked = columns.asked_half(S)
    chains = columns.chains(S, asked, HALF)
    results = stand_in.run('', chains)
    level = gather(columns, asked, results)
    i, j, k = 5, 1, 1
    speed = float(np.exp(S[i] + columns.log_onset[j, k]))
    for draw in range(3):
        alone = columns.chain(LOADS[j], HEATS[k], draw, np.array([speed]), HALF)
        record = stand_in.solve(alone)['opposing'][0]
        assert level.values['rcs'][i, j, k, draw] == pytest.approx(record['rcs'])
    assert not level.weak.any()
    gone = {
        name: None if '1000.0 N, temperature 0' in name else found
        for name, found in results.items()
    }
    failed = gather(columns, asked, gone)
    assert np.isnan(failed.values['rcs'][:, 1, 0]).all()
    assert np.array_equal(failed.weak[:, 1, 0], asked[:, 1, 0].any(axis=-1))
    assert not failed.weak[:, 0].any()


def test_the_worst_contact_is_that_of_the_finer_grid(columns, stand_in):
    """Where both were solved; the other elsewhere."""
    half, fine = solve_levels(columns, S, stand_in.run)
    node, other = next(iter(fine.contacts)), (0, 0, 0)
    half.contacts.update({node: [1, 1], other: [2]})
    fine.contacts[node] = [3, 3, 1]
    worst = worst_contacts((half, fine))
    assert worst[node] == 3
    assert worst[other] == 2


def test_commonest_is_the_same_whatever_the_order():
    """Ties go to the least."""
    assert commonest([3, 1, 3, 1, 0]) == commonest([1, 3, 0, 3, 1]) == 1


def test_grids_are_named_as_the_solver_knows_them():
    """Chains are kept by these words."""
    assert (FINE, HALF) == ('fine', 'half')
