# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Chains of all columns: which there are, and over which speeds."""

import numpy as np
import pytest
from surrogate.full.columns import Columns
from surrogate.parameters import load_lubricant, load_screw

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
    """Two magnitudes; three draws at the reference temperature, two at others; speeds fall."""
    chains = columns.chains(S)
    assert columns.reference == 1
    assert len(chains) == 2 * (2 + 3 + 2)
    for chain in chains.values():
        assert chain['load'] >= 0
        assert chain['speeds'] == sorted(chain['speeds'], reverse=True)


def test_what_a_lookup_reads_is_solved_and_little_else(columns):
    """Around every cell that holds a speed of the range all eight corners are needed."""
    needed = columns.needed(S)
    low, high = np.log(columns.speed_range)
    for j in range(2):
        for k in range(2):
            beside = slice(j, j + 2), slice(k, k + 2)
            onset = columns.log_onset[beside]
            inside = (S[1:] > low - onset.max()) & (S[:-1] < high - onset.min())
            for i in np.flatnonzero(inside):
                assert needed[slice(i, i + 2), *beside].all()
    assert not needed.all()
