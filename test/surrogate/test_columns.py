# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Chains of all columns, and the fields gathered from their results."""

from dataclasses import replace
import math

import numpy as np
import pytest
from surrogate.columns import Columns, commonest, continued
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
        log_onset=np.log([[0.5, 1.0, 3.0], [0.6, 1.2, 3.5], [0.5, 1.0, 3.0]]),
    )


def test_loads_of_either_sign_share_their_chains(columns):
    """Two magnitudes, three temperatures, two draws; speeds fall."""
    chains = columns.chains(S, 2)
    assert len(chains) == 2 * 3 * 2
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


def test_fields_are_means_and_spreads_over_draws(columns, stand_in):
    """At one node: mean, deviation and error of three draws by hand; signs by their sense."""
    chains = columns.chains(S, 3)
    nodes = columns.gather(S, 3, stand_in.run('', chains))
    i, k = 4, 1
    for j in (0, 2):
        sense = 'opposing' if LOADS[j] >= 0 else 'assisting'
        speed = math.exp(S[i] + columns.log_onset[j, k])
        values = []
        for draw in range(3):
            chain = columns.chain(1000.0, HEATS[k], draw, np.array([speed]))
            values.append(stand_in.solve(chain)[sense][0]['friction_torque'])
        assert nodes.means['friction_torque'][i, j, k] == pytest.approx(np.mean(values))
        deviation = np.std(values, ddof=1)
        assert nodes.deviations['friction_torque'][i, j, k] == pytest.approx(deviation)
        error = nodes.standard_errors['friction_torque'][i, j, k]
        assert error == pytest.approx(deviation / math.sqrt(3))
    assert nodes.failed == 0
    assert np.array_equal(nodes.mask, ~columns.needed(S))
    assert all(np.isfinite(values).all() for values in nodes.means.values())


def test_failed_draws_are_left_out_until_too_few_remain(columns, stand_in):
    """One of two is enough, none masks the node; the others stay."""
    chains = columns.chains(S, 2)
    results = stand_in.run('', chains)
    whole = columns.gather(S, 2, results)
    broken = dict(results)
    first, second = [name for name in chains if name.startswith('1000.0 N, temperature 1')]
    broken[first] = None
    partly = columns.gather(S, 2, broken)
    assert partly.failed == 2 * int(columns.needed(S)[:, 0, 1].sum())
    assert np.array_equal(partly.mask, whole.mask)
    broken[second] = None
    masked = columns.gather(S, 2, broken).mask
    assert masked[:, 0, 1].all()
    assert np.array_equal(masked[:, 1], whole.mask[:, 1])


def test_certified_is_free_of_contact_at_every_node_beyond(columns, stand_in):
    """The least coordinate from which all films are twice the floor; None when one never is."""
    chains = columns.chains(S, 2)
    nodes = columns.gather(S, 2, stand_in.run('', chains))
    assert nodes.certified in S
    beyond = S >= nodes.certified
    assert (nodes.means['rcs'][beyond] == 0).all()
    slow = replace(columns, speed_range=(0.2, 0.6))
    chains = slow.chains(S[:5], 1)
    assert slow.gather(S[:5], 1, stand_in.run('', chains)).certified is None


def test_columns_go_on_as_powers_and_constants():
    """Beyond both ends, which only slopes read; zero stays zero."""
    s = np.arange(6.0)
    values = np.full((6, 1, 2), np.nan)
    values[1:5, 0, 0] = 3.0 * np.exp(0.7 * s[1:5])
    values[1:5, 0, 1] = [0.9, 0.4, 0.1, 0.0]
    found = continued(s, values)
    assert found[5, 0, 0] == pytest.approx(3.0 * math.exp(3.5))
    assert found[5, 0, 1] == 0.0
    assert found[0, 0, 1] == 0.9
    assert np.array_equal(found[1:5], values[1:5])


def test_commonest_is_the_same_whatever_the_order():
    """Ties go to the least."""
    assert commonest([3, 1, 3, 1, 0]) == commonest([1, 3, 0, 3, 1]) == 1
