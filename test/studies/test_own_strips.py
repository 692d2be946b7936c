# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Strips of own screws: how far those of one raceway differ, and what they tell of another."""

from dataclasses import asdict
import math

import numpy as np
import pytest
from scipy.stats import binom, f, t
from surrogate.builder.full.march import marched_film, WITHIN
from surrogate.raceway.stated import NINE_OF_TEN
from surrogate.tasks.table import read_table


@pytest.fixture(scope='module')
def raceways(study):
    """Return lay, state and the strips by name of each own screw that was marched."""
    own = study('own_strips')
    return [
        (
            (own.OWN[number].lay, own.OWN[number].state),
            {name: asdict(row) for name, row in strips.items()},
        )
        for number, strips in own.raceways(read_table(own.RESULTS, own.Strip)).items()
    ]


@pytest.mark.parametrize(
    ('lay', 'states', 'count'),
    [
        ('isotropic', ('new',), 7),
        ('isotropic', ('run_in',), 8),
        ('longitudinal', ('new', 'run_in'), 9),
        ('transverse', ('new', 'run_in'), 4),
    ],
)
def test_strips_of_one_raceway_differ_as_is_stated(raceways, lay, states, count):
    """Variance about the mean of each raceway, pooled; isotropic ones with Student's t."""
    logs = [
        [math.log(strips[f'strip {n}']['film_factor']) for n in (1, 2, 3, 4)]
        for (its, state), strips in raceways
        if its == lay and state in states
    ]
    assert len(logs) == count
    pooled = math.sqrt(np.mean(np.var(logs, axis=1, ddof=1)))
    few = t.ppf(0.95, 3 * count) / NINE_OF_TEN if lay == 'isotropic' else 1.0
    for state in states:
        assert WITHIN[lay, state] == pytest.approx(few * pooled, abs=0.001)


@pytest.mark.parametrize('lay', ['isotropic', 'longitudinal', 'transverse'])
def test_states_that_scatter_unequally_have_their_own(raceways, lay):
    """By an F test of the pooled variances at 5 %."""
    logs = {
        state: [
            [math.log(strips[f'strip {n}']['film_factor']) for n in (1, 2, 3, 4)]
            for kind, strips in raceways
            if kind == (lay, state)
        ]
        for state in ('new', 'run_in')
    }
    new, worn = (np.mean(np.var(of, axis=1, ddof=1)) for of in logs.values())
    chance = f.sf(new / worn, *(3 * len(of) for of in logs.values()))
    assert bool(chance < 0.05) is (WITHIN[lay, 'new'] != WITHIN[lay, 'run_in'])


def test_strips_that_were_held_out_lie_within_what_is_stated(raceways):
    """The fourth of 28 own screws and each of the four in turn, isotropic ones in both states."""
    inside, last = {}, []
    for kind, strips in raceways:
        for held in ('strip 1', 'strip 2', 'strip 3', 'strip 4'):
            known = marched_film({name: strips[name] for name in strips if name != held}, *kind)
            off = abs(math.log(strips[held]['film_factor'] / known['marched_film']))
            inside.setdefault(kind, []).append(off <= NINE_OF_TEN * known['marched_error'])
        last.append(inside[kind][-1])
    assert len(last) == 28
    assert np.mean(last) >= 0.9
    assert np.mean(sum(inside.values(), [])) >= 0.9
    isotropic = [inside['isotropic', state] for state in ('new', 'run_in')]
    assert np.mean(sum(isotropic, [])) >= 0.9
    # Each state by itself is not less than nine of ten but by chance.
    for state in isotropic:
        assert binom.cdf(sum(state), len(state), 0.9) > 0.05
