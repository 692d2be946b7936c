# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Fields gathered from chains: means, what few draws share with all of them, and the spread."""

from dataclasses import replace
import math

import numpy as np
import pytest
from surrogate.build import speed_at_film_ratio
from surrogate.full.columns import Columns
from surrogate.full.nodes import commonest, continued, gather_nodes
from surrogate.parameters import load_lubricant, load_screw

LOADS, HEATS = np.array([-1000.0, 0.0, 1000.0]), np.array([293.15, 313.15, 333.15])
S = np.linspace(-3.0, 6.0, 10)
REFERENCE = 1


@pytest.fixture(name='columns')
def make_columns():
    """Return three loads and three temperatures, s = 0 at one film ratio."""
    screw, oil = load_screw('nominal'), load_lubricant('iso_vg_68')
    onset = speed_at_film_ratio(screw, oil, LOADS[:, None], HEATS, 0.1)
    return Columns(
        screw=screw,
        lubricant=oil,
        load=LOADS,
        temperature=HEATS,
        speed_range=(0.2, 100.0),
        draws=5,
        shared_draws=2,
        log_onset=np.log(onset),
    )


def at_node(columns, stand_in, i, j, k, draws):
    """Return the records of some draws at one node."""
    sense = 'opposing' if LOADS[j] >= 0 else 'assisting'
    speed = math.exp(S[i] + columns.log_onset[j, k])
    chains = [columns.chain(abs(LOADS[j]), HEATS[k], draw, np.array([speed])) for draw in draws]
    return [stand_in.solve(chain)[sense][0] for chain in chains]


def test_fields_are_means_and_spreads_over_draws(columns, stand_in):
    """At the reference temperature: mean, deviation and error of five draws, by hand."""
    nodes = gather_nodes(columns, S, stand_in.run('', columns.chains(S)))
    i, k = 4, REFERENCE
    for j in (0, 2):
        found = at_node(columns, stand_in, i, j, k, range(5))
        values = [record['friction_torque'] for record in found]
        assert nodes.means['friction_torque'][i, j, k] == pytest.approx(np.mean(values))
        deviation = np.std(values, ddof=1)
        assert nodes.deviations['friction_torque'][i, j, k] == pytest.approx(deviation)
        error = nodes.standard_errors['friction_torque'][i, j, k]
        assert error == pytest.approx(deviation / math.sqrt(5))
    assert nodes.failed == 0
    assert np.array_equal(nodes.mask, ~columns.needed(S))
    assert all(np.isfinite(values).all() for values in nodes.means.values())


@pytest.mark.parametrize('k', [0, 2])
def test_few_draws_come_near_the_mean_of_all_of_them(columns, stand_in, k):
    """At other temperatures: nearer to the mean of five draws than the two solved there."""
    nodes = gather_nodes(columns, S, stand_in.run('', columns.chains(S)))
    off = {'friction_torque': [], 'rcs': []}
    for i in (1, 2, 3, 4):
        found = at_node(columns, stand_in, i, 2, k, range(5))
        for name, (shared, plain) in {name: ([], []) for name in off}.items():
            values = [record[name] for record in found]
            shared.append(abs(nodes.means[name][i, 2, k] - np.mean(values)))
            plain.append(abs(np.mean(values[:2]) - np.mean(values)))
            off[name].append((shared[0], plain[0]))
    for name, pairs in off.items():
        shared, plain = np.array(pairs).T
        assert plain.max() > 1e-3
        assert shared.max() < 0.2 * plain.max(), name
    reference = nodes.deviations['rcs'][3, 2, REFERENCE]
    assert nodes.deviations['rcs'][3, 2, k] == reference


def test_sharing_all_draws_is_solving_all(columns, stand_in):
    """With as many shared as there are, every temperature has its plain mean."""
    whole = replace(columns, shared_draws=5)
    nodes = gather_nodes(whole, S, stand_in.run('', whole.chains(S)))
    found = at_node(columns, stand_in, 3, 0, 2, range(5))
    for name in ('friction_torque', 'rcs', 'central_film'):
        mean = np.mean([record[name] for record in found])
        assert nodes.means[name][3, 0, 2] == pytest.approx(mean, rel=1e-12)


def test_failed_draws_are_left_out_until_too_few_remain(columns, stand_in):
    """One of two is enough, none masks the node; the others stay."""
    chains = columns.chains(S)
    results = stand_in.run('', chains)
    whole = gather_nodes(columns, S, results)
    broken = dict(results)
    first, second = [name for name in chains if name.startswith('1000.0 N, temperature 2')]
    broken[first] = None
    partly = gather_nodes(columns, S, broken)
    assert partly.failed == 2 * int(columns.needed(S)[:, 0, 2].sum())
    assert np.array_equal(partly.mask, whole.mask)
    broken[second] = None
    masked = gather_nodes(columns, S, broken).mask
    assert masked[:, 0, 2].all()
    assert np.array_equal(masked[:, 1], whole.mask[:, 1])


def test_certified_is_free_of_contact_at_every_node_beyond(columns, stand_in):
    """The least coordinate from which all films are twice the floor; None when one never is."""
    nodes = gather_nodes(columns, S, stand_in.run('', columns.chains(S)))
    assert nodes.certified in S
    beyond = S >= nodes.certified
    assert (nodes.means['rcs'][beyond] == 0).all()
    slow = replace(columns, speed_range=(0.2, 0.6))
    found = gather_nodes(slow, S[:5], stand_in.run('', slow.chains(S[:5])))
    assert found.certified is None


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
