# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Draws and their weights: what they make of factors, of fields, and of the error of a mean."""

from dataclasses import replace
import math

from hypothesis import given, settings
from hypothesis import strategies as st
import numpy as np
import pytest
from surrogate.builder.full.draws import (
    deviation,
    draws_of,
    mean_of_draws,
    POPULATION,
    raked,
    STEEPEST,
    weighted_mean,
    WeightedDraws,
)
from surrogate.parameters import load_screw
from surrogate.surface import SolvedPoint

POWERS = (14.0, 31.0, 23.0, 20.0, 29.0, 24.0, 26.0, 28.0, 19.0, 17.0)
TEN = WeightedDraws(len(POWERS), powers=POWERS, mean=24.0)
IDLE = 1000.0


@given(powers=st.lists(st.floats(1.0, 90.0), min_size=2, max_size=24), place=st.floats(0.05, 0.95))
@settings(max_examples=300)
def test_weights_meet_the_mean_or_are_even_where_only_steep_ones_would(powers, place):
    """Positive, with the sum 1."""
    x = np.array(powers)
    if np.std(x) < 1e-3:
        return
    off = x - float(x.min() + place * np.ptp(x))
    weights = raked(off)
    assert weights.sum() == pytest.approx(1.0)
    assert (weights > 0).all()
    steep = np.exp(STEEPEST * np.array([[-1.0], [1.0]]) * off / np.std(off))
    low, high = (steep * off).sum(axis=1)
    if low < 0 < high:
        assert weights @ off == pytest.approx(0.0, abs=1e-9 * np.abs(off).max())
    else:
        assert weights == pytest.approx(1 / x.size)


def test_a_field_that_is_linear_in_the_power_is_found_without_error():
    """Whatever draws failed; the error that is left is that of the population's mean."""
    values = np.tile(0.2 + 0.3 * np.array(POWERS), (4, 1))
    values[1, 2] = values[2, [0, 7]] = np.nan
    weights = TEN.weights(values, np.zeros(4))
    assert weighted_mean(values, weights) == pytest.approx(0.2 + 0.3 * TEN.mean, rel=1e-9)
    error = TEN.standard_error(values, weights)
    x, own = np.array(POWERS), weights[0]
    spread = math.sqrt(own @ (x - own @ x) ** 2)
    assert error[0] == pytest.approx(0.3 * spread / math.sqrt(POPULATION), rel=1e-6)


def test_few_draws_have_plain_means():
    """Of those that are known, with the textbook error and deviation; NaN of none or one."""
    values, few = np.random.default_rng(1).normal(3.0, 1.0, (4, 6)), WeightedDraws(6)
    values[1, 4], values[2, 1:], values[3] = np.nan, np.nan, np.nan
    weights = few.weights(values, np.zeros(4))
    assert weighted_mean(values, weights)[:3] == pytest.approx(np.nanmean(values[:3], axis=-1))
    assert math.isnan(weighted_mean(values, weights)[3])
    errors, spreads = few.standard_error(values, weights), deviation(values, weights)
    for row, known in ((0, 6), (1, 5)):
        spread = np.nanstd(values[row], ddof=1)
        assert spreads[row] == pytest.approx(spread)
        assert errors[row] == pytest.approx(spread / math.sqrt(known))
    assert np.isnan([*errors[2:], *spreads[2:]]).all()


@pytest.mark.parametrize(('count', 'bend'), [(16, 0.0), (8, 0.0), (16, 0.5)])
def test_the_stated_error_is_the_scatter_of_the_mean(count, bend):
    """Over many ensembles, for noise alone and for a field that bends over the power, too."""
    drawn = np.random.default_rng(7)
    x = drawn.gamma(9.0, 1 / 9.0, (3000, count))
    values = x + bend * x**2 + 0.3 * drawn.normal(size=x.shape)
    means, stated = [], []
    for powers, row in zip(x, values, strict=True):
        draws = WeightedDraws(count, powers=tuple(powers), mean=1.0)
        weights = draws.weights(row, 0.0)
        means.append(float(weighted_mean(row, weights)))
        stated.append(float(draws.standard_error(row, weights)))
    scatter = float(np.std(means))
    assert math.sqrt(np.mean(np.square(stated))) == pytest.approx(scatter, rel=0.1)
    assert values.mean(axis=-1).std() > 1.25 * scatter


def test_where_no_weights_are_found_the_error_says_so():
    """All known draws on one side: the mean is plain, and its error holds what the line lacks."""
    values = np.where(np.array(POWERS) < 22, 0.3 * np.array(POWERS), np.nan)
    weights = TEN.weights(values, 0.0)
    known = np.isfinite(values)
    assert weights[known] == pytest.approx(1 / known.sum())
    assert not weights[~known].any()
    wrong = 0.3 * TEN.mean - weighted_mean(values, weights)
    assert TEN.standard_error(values, weights) == pytest.approx(wrong, rel=0.01)
    assert not TEN.weights(np.full(10, np.nan), 0.0).any()


def test_draws_of_the_verge_gain_weight_without_a_step():
    """Twice as many from 7/8 of the idle load to it; there alone the second half weighs."""
    draws = WeightedDraws(5, idle=IDLE, powers=POWERS, mean=24.0)
    loads = np.array([0.0, 875.0, 875.1, 900.0, -937.6, 999.0, 1000.0, 4000.0])
    assert [draws.at(load) for load in loads] == [5, 5, 10, 10, 10, 10, 5, 5]
    weights = draws.weights(np.ones((len(loads), 10)), loads)
    late = weights[:, 5:].sum(axis=-1)
    assert late[[0, 1, 6, 7]] == pytest.approx(0.0, abs=1e-12)
    assert late[2] < 0.005
    assert 0.1 < late[3] < late[4]
    assert late[4] == pytest.approx(late[5])
    assert weights.sum(axis=-1) == pytest.approx(1.0)
    assert weights[0, :5] == pytest.approx(raked(np.array(POWERS[:5]) - 24.0))


def test_draws_of_one_height_are_plain():
    """No draw is scaled by itself, so that none stands for others."""
    assert draws_of(load_screw('nominal'), 16) == WeightedDraws(16)


def test_records_of_draws_have_one_mean():
    """A chain that failed or a draw that did not converge is left out, half of them at most."""
    points = [
        SolvedPoint(converged=True, rcs=0.1 * power, friction_torque=2.0 - power)
        for power in POWERS
    ]
    points[1] = None
    points[4] = SolvedPoint(converged=False)
    found = mean_of_draws(points, TEN, 0.0)
    assert found.converged
    assert (found.rcs, found.friction_torque) == pytest.approx((2.4, -22.0), rel=1e-9)
    assert not mean_of_draws([None] * 6 + points[6:], TEN, 0.0).converged
    more = replace(TEN, powers=(*POWERS, *POWERS))
    again = mean_of_draws(points, more, 0.0)
    assert (again.rcs, again.friction_torque) == pytest.approx(
        (found.rcs, found.friction_torque), rel=1e-12
    )
