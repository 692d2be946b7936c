# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Fields gathered from chains: means, what few draws share with all of them, and the spread."""

from dataclasses import replace
import math

import numpy as np
import pytest
from surrogate.builder.closed_form import speed_at_film_ratio
from surrogate.builder.full.chain import SolvedChain
from surrogate.builder.full.columns import BESIDE, Columns, covering
from surrogate.builder.full.nodes import commonest, continued, gather_nodes
from surrogate.formulas.load_sharing import idle_load
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


def at_node(columns, stand_in, s, j, k, draws):
    """Return the records of some draws at one node."""
    sense = 'opposing' if LOADS[j] >= 0 else 'assisting'
    speed = math.exp(s + columns.log_onset[j, k])
    chains = [columns.chain(abs(LOADS[j]), HEATS[k], draw, np.array([speed])) for draw in draws]
    return [stand_in.solve(chain)[sense][0] for chain in chains]


def failing_at(chain, places):
    """Return a chain of which some points did not converge."""
    senses = [list(chain.opposing), list(chain.assisting)]
    for points in senses:
        for place in places:
            points[place] = replace(points[place], converged=False)
    return SolvedChain(*map(tuple, senses))


def gather(columns, results, s=S):
    """Return the nodes at the solved temperatures."""
    records = columns.records(s, results)
    return gather_nodes(columns, s, records, columns.temperature, columns.log_onset)


def test_fields_are_means_and_spreads_over_draws(columns, stand_in):
    """At the reference temperature: mean, deviation and error of five draws, by hand."""
    nodes = gather(columns, stand_in.run('', columns.chains(S)))
    i, k = 3, REFERENCE
    for j in (0, 2):
        found = at_node(columns, stand_in, S[i], j, k, range(5))
        values = [record['friction_torque'] for record in found]
        assert nodes.means['friction_torque'][i, j, k] == pytest.approx(np.mean(values))
        deviation = np.std(values, ddof=1)
        assert nodes.deviations['friction_torque'][i, j, k] == pytest.approx(deviation)
        error = nodes.standard_errors['friction_torque'][i, j, k]
        assert error == pytest.approx(deviation / math.sqrt(5))
    needed = covering(S, columns.log_onset, columns.speed_range, (3, 3))
    assert np.array_equal(nodes.mask, ~needed)
    assert all(np.isfinite(values).all() for values in nodes.means.values())


@pytest.mark.parametrize('k', [0, 2])
def test_few_draws_come_near_the_mean_of_all_of_them(columns, stand_in, k):
    """At other temperatures: nearer to the mean of five draws than the two solved there."""
    fine = np.linspace(-3.0, 6.0, 31)
    nodes = gather(columns, stand_in.run('', columns.chains(fine)), fine)
    around = np.flatnonzero(columns.needed(fine)[:, 2, k] & (np.abs(fine) < 1.3))
    assert len(around) > 5
    off = {'friction_torque': [], 'rcs': []}
    for i in around:
        found = at_node(columns, stand_in, fine[i], 2, k, range(5))
        for name, pairs in off.items():
            values = [record[name] for record in found]
            mean = np.mean(values)
            pairs.append((abs(nodes.means[name][i, 2, k] - mean), abs(np.mean(values[:2]) - mean)))
    for name, pairs in off.items():
        shared, plain = np.max(pairs, axis=0)
        assert plain > 1e-3
        assert shared < 0.2 * plain, name
    assert np.array_equal(
        nodes.deviations['rcs'][around, 2, k], nodes.deviations['rcs'][around, 2, REFERENCE]
    )


def test_sharing_all_draws_is_solving_all(columns, stand_in):
    """With as many shared as there are, every temperature has its plain mean."""
    whole = replace(columns, shared_draws=5)
    nodes = gather(whole, stand_in.run('', whole.chains(S)))
    found = at_node(columns, stand_in, S[3], 0, 2, range(5))
    for name in ('friction_torque', 'rcs', 'central_film'):
        mean = np.mean([record[name] for record in found])
        assert nodes.means[name][3, 0, 2] == pytest.approx(mean, rel=1e-12)


def test_failed_draws_are_left_out_until_too_few_remain(columns, stand_in):
    """One of two is enough, none masks the node; the others stay."""
    chains = columns.chains(S)
    results = stand_in.run('', chains)
    whole = gather(columns, results)
    broken = dict(results)
    first, second = [name for name in chains if name.startswith('1000.0 N, temperature 2')]
    broken[first] = None
    assert np.array_equal(gather(columns, broken).mask, whole.mask)
    broken[second] = None
    masked = gather(columns, broken).mask
    assert masked[columns.sought(S)[:, 0, 2], 0, 2].all()
    assert np.array_equal(masked[:, 1], whole.mask[:, 1])


def test_ends_that_failed_are_masked_and_not_continued(columns, stand_in):
    """The two slowest speeds of hot oil without a solution have no number."""
    results = stand_in.run('', columns.chains(S))
    slowest = np.flatnonzero(columns.needed(S)[:, 0, 2])[:2]
    for name in results:
        if name.startswith('1000.0 N, temperature 2'):
            results[name] = failing_at(results[name], (-1, -2))
    nodes = gather(columns, results)
    assert nodes.mask[slowest, 0, 2].all()
    assert not nodes.mask[slowest[-1] + 1, 0, 2]


def test_a_column_beside_the_idle_load_is_completed(columns, stand_in):
    """A gap and an end that failed come near what solves give; elsewhere they stay masked."""
    below = (1 - BESIDE) * idle_load(columns.screw)
    loads = np.array([-0.9 * below, 0.0, 0.9 * below, below])
    onset = speed_at_film_ratio(columns.screw, columns.lubricant, loads[:, None], HEATS, 0.1)
    wide = replace(columns, load=loads, log_onset=np.log(onset))
    results = stand_in.run('', wide.chains(S))
    whole = gather(wide, results)
    failing = np.flatnonzero(wide.needed(S)[:, 3, 2])[[0, 3]]
    for name in results:
        if name.startswith(f'{below!r} N, temperature 2'):
            results[name] = failing_at(results[name], (-1, -4))
    found = gather(wide, results)
    assert np.array_equal(found.mask, whole.mask)
    for name in ('friction_torque', 'central_film'):
        there = whole.means[name][failing, 3, 2]
        assert found.means[name][failing, 3, 2] == pytest.approx(there, rel=0.03)


def test_certified_is_free_of_contact_at_every_node_beyond(columns, stand_in):
    """The least coordinate from which all films are twice the floor; None when one never is."""
    nodes = gather(columns, stand_in.run('', columns.chains(S)))
    assert nodes.certified in S
    beyond = S >= nodes.certified
    assert (nodes.means['rcs'][beyond] == 0).all()
    slow = replace(columns, speed_range=(0.2, 0.6))
    found = gather(slow, stand_in.run('', slow.chains(S[:5])), S[:5])
    assert found.certified is None


def test_columns_go_on_as_powers_and_constants():
    """Beyond both ends, which only slopes read; zero stays zero, and what failed stays unknown."""
    s = np.arange(6.0)
    values = np.full((6, 1, 3), np.nan)
    values[1:5, 0, 0] = 3.0 * np.exp(0.7 * s[1:5])
    values[1:5, 0, 1] = [0.9, 0.4, 0.1, 0.0]
    values[2:5, 0, 2] = 1.0
    free = np.ones(values.shape, dtype=bool)
    free[1, 0, 2] = False
    found = continued(s, values, free)
    assert found[5, 0, 0] == pytest.approx(3.0 * math.exp(3.5))
    assert found[0, 0, 0] == values[1, 0, 0]
    assert found[5, 0, 1] == 0.0
    assert found[0, 0, 1] == 0.9
    assert np.isnan(found[1, 0, 2])
    assert np.array_equal(found[2:5], values[2:5])


def test_commonest_is_the_same_whatever_the_order():
    """Ties go to the least."""
    assert commonest([3, 1, 3, 1, 0]) == commonest([1, 3, 0, 3, 1]) == 1
