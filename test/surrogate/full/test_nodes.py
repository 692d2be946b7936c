# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Fields gathered from chains: means, what few draws share with all of them, and the spread."""

from dataclasses import replace
import math

import numpy as np
import pytest
from surrogate.build import speed_at_film_ratio
from surrogate.full.chain import FINE, HALF
from surrogate.full.columns import Columns, covering
from surrogate.full.idle import BESIDE, idle_load
from surrogate.full.levels import solve_levels
from surrogate.full.nodes import continued, gather_nodes
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
    chains = [
        columns.chain(abs(LOADS[j]), HEATS[k], draw, np.array([speed]), FINE) for draw in draws
    ]
    return [stand_in.solve(chain)[sense][0] for chain in chains]


def gather(columns, run, s=S):
    """Return the nodes at the solved temperatures."""
    half, fine = solve_levels(columns, s, run)
    return gather_nodes(columns, s, half, fine, columns.temperature, columns.log_onset)


@pytest.fixture(name='broken')
def make_broken(stand_in):
    """Return a run in which `fails(name, chain, place)` tells what does not converge."""

    def broken(fails):
        def run(purpose, chains):
            results = stand_in.run(purpose, chains)
            for name in chains:
                for records in results[name].values():
                    for place, record in enumerate(records):
                        record['converged'] &= not fails(purpose, name, len(records) - 1 - place)
            return results

        return run

    return broken


def test_fields_are_means_and_spreads_over_draws(columns, stand_in):
    """At an anchor of the middle temperature: mean, deviation and error of five draws, by hand."""
    nodes = gather(columns, stand_in.run)
    i, k = 3, REFERENCE
    assert columns.anchors(S)[i]
    for j in (0, 2):
        found = at_node(columns, stand_in, S[i], j, k, range(5))
        for name in ('friction_torque', 'rcs'):
            values = [record[name] for record in found]
            assert nodes.means[name][i, j, k] == pytest.approx(np.mean(values))
            deviation = np.std(values, ddof=1)
            assert nodes.deviations[name][i, j, k] == pytest.approx(deviation)
            error = nodes.standard_errors[name][i, j, k]
            assert error == pytest.approx(deviation / math.sqrt(5))
    needed = covering(S, columns.log_onset, columns.speed_range, (3, 3))
    assert np.array_equal(nodes.mask, ~needed)
    assert all(np.isfinite(values).all() for values in nodes.means.values())


@pytest.mark.parametrize('k', [0, 2])
def test_few_draws_come_near_the_mean_of_all_of_them(columns, stand_in, k):
    """At other temperatures: nearer to the mean of five draws than the two solved there."""
    fine = np.linspace(-3.0, 6.0, 31)
    nodes = gather(columns, stand_in.run, fine)
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


def test_half_grid_alone_is_told_what_the_fine_one_changes(columns, stand_in):
    """Between the anchors, where no fine grid was solved: nearer by far than the half grid."""
    fine = np.linspace(-3.0, 6.0, 31)
    nodes = gather(columns, stand_in.run, fine)
    asked = columns.asked_fine(fine, fine < -3).any(axis=-1)[:, 2, REFERENCE]
    between = np.flatnonzero(~asked & (np.abs(fine) < 1.3))
    assert len(between) > 3
    for i in between:
        speed = math.exp(fine[i] + columns.log_onset[2, REFERENCE])
        solved = {
            grid: [
                stand_in.solve(columns.chain(1000.0, HEATS[1], draw, np.array([speed]), grid))[
                    'opposing'
                ][0]
                for draw in range(5)
            ]
            for grid in (FINE, HALF)
        }
        for name, least in (('friction_torque', 1e-4), ('rcs', 5e-4)):
            on_half, on_fine = (
                np.mean([record[name] for record in solved[grid]]) for grid in (HALF, FINE)
            )
            off = abs(nodes.means[name][i, 2, REFERENCE] - on_fine)
            assert off < max(least, 0.2 * abs(on_half - on_fine)), (name, fine[i])


def test_sharing_all_draws_is_nearly_solving_all(columns, stand_in):
    """With as many shared as there are, the grid is what other temperatures are told of."""
    whole = replace(columns, shared_draws=5)
    nodes = gather(whole, stand_in.run)
    for k in (0, 2):
        found = at_node(columns, stand_in, S[3], 0, k, range(5))
        for name, near in (('friction_torque', 0.01), ('rcs', 0.05), ('central_film', 1e-9)):
            mean = np.mean([record[name] for record in found])
            assert nodes.means[name][3, 0, k] == pytest.approx(mean, rel=near)


def test_failed_draws_are_left_out_until_too_few_remain(columns, stand_in, broken):
    """One of two is enough, none masks the node; the others stay."""
    whole = gather(columns, stand_in.run)
    there = '1000.0 N, temperature 2'
    one = gather(columns, broken(lambda _, name, place: name == f'{there}, draw 0'))
    assert np.array_equal(one.mask, whole.mask)
    both = gather(columns, broken(lambda _, name, place: name.startswith(there)))
    assert both.mask[columns.needed(S)[:, 0, 2], 0, 2].all()
    assert np.array_equal(both.mask[:, 1], whole.mask[:, 1])


def test_nothing_on_the_fine_grid_masks_the_node(columns, stand_in, broken):
    """The half grid does not stand in for a fine one that fails."""
    there = f'1000.0 N, temperature {REFERENCE}'
    nodes = gather(columns, broken(lambda what, name, _: 'fine' in what and there in name))
    anchors = columns.anchors(S) & columns.needed(S)[:, 2, REFERENCE]
    assert nodes.mask[anchors, 2, REFERENCE].all()
    assert not nodes.mask[anchors, 1, REFERENCE].any()


def test_ends_that_failed_are_masked_and_not_continued(columns, broken):
    """The two slowest speeds of hot oil without a solution have no number."""
    slowest = np.flatnonzero(columns.needed(S)[:, 0, 2])[:2]
    there = '1000.0 N, temperature 2'
    nodes = gather(columns, broken(lambda _, name, place: there in name and place < 2))
    assert nodes.mask[slowest, 0, 2].all()
    assert not nodes.mask[slowest[-1] + 1, 0, 2]


def test_a_column_beside_the_idle_load_is_completed(columns, stand_in, broken):
    """A gap and an end that failed come near what solves give; elsewhere they stay masked."""
    below = (1 - BESIDE) * idle_load(columns.screw)
    loads = np.array([-0.9 * below, 0.0, 0.9 * below, below])
    onset = speed_at_film_ratio(columns.screw, columns.lubricant, loads[:, None], HEATS, 0.1)
    wide = replace(columns, load=loads, log_onset=np.log(onset))
    whole = gather(wide, stand_in.run)
    failing = np.flatnonzero(wide.needed(S)[:, 3, 2])[[0, 3]]
    there = f'{below!r} N, temperature 2'
    found = gather(wide, broken(lambda _, name, place: there in name and place in (0, 3)))
    assert np.array_equal(found.mask, whole.mask)
    for name in ('friction_torque', 'central_film'):
        solved = whole.means[name][failing, 3, 2]
        assert found.means[name][failing, 3, 2] == pytest.approx(solved, rel=0.03)


def test_certified_is_free_of_contact_at_every_node_beyond(columns, stand_in):
    """The least coordinate from which all films are twice the floor; None when one never is."""
    nodes = gather(columns, stand_in.run)
    assert nodes.certified in S
    beyond = S >= nodes.certified
    assert (nodes.means['rcs'][beyond] == 0).all()
    slow = replace(columns, speed_range=(0.2, 0.6))
    found = gather(slow, stand_in.run, S[:5])
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
