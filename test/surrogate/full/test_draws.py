# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Weights of draws: what they make of the factors, of fields, and of the error of a mean."""

from dataclasses import asdict
import math

from hypothesis import given, settings
from hypothesis import strategies as st
import numpy as np
import pytest
from surrogate.full.draws import (
    Calibration,
    calibration,
    draw_weights,
    draws_at,
    LEAST_DRAWS,
    mean_of_draws,
    POPULATION,
    standard_error,
    weighted_mean,
)
from surrogate.full.idle import idle_load
from surrogate.parameters import load_screw
from surrogate.screw_contacts import raceway_patch

POWERS = (1.4, 5.1, 3.3, 2.0, 4.4, 2.9, 6.2, 3.8, 1.9, 2.4)
WEIGH = Calibration(POWERS, 3.9)
ALL = np.ones(len(POWERS), bool)


@given(
    powers=st.lists(st.floats(1.0, 9.0), min_size=2, max_size=24),
    place=st.floats(0.05, 0.95),
    lost=st.integers(0, 23),
)
@settings(deadline=None, max_examples=200)
def test_known_draws_have_the_mean_of_the_population(powers, place, lost):
    """Positive weights with the sum 1; even ones where no such weights are moderate."""
    known = np.arange(len(powers)) != lost
    x = np.array(powers)[known]
    if np.ptp(x) < 1e-3:
        return
    mean = float(x.min() + place * np.ptp(x))
    weights = Calibration(tuple(powers), mean).weights(known)
    assert weights.sum() == pytest.approx(1.0)
    assert (weights[known] > 0).all()
    assert not weights[~known].any()
    even = np.ptp(weights[known]) < 1e-12
    assert even or weights[known] @ x == pytest.approx(mean, rel=1e-9)


def test_a_field_that_is_linear_in_the_power_is_found_without_error():
    """Whatever draws failed; the error that is left is that of the population's mean."""
    values = np.tile(0.2 + 0.3 * np.array(POWERS), (4, 1))
    values[1, 2] = values[2, [0, 7]] = np.nan
    weights = draw_weights(values, WEIGH)
    assert weighted_mean(values, weights) == pytest.approx(0.2 + 0.3 * WEIGH.mean, rel=1e-9)
    error = standard_error(values, weights, WEIGH)
    x, own = np.array(POWERS), weights[0]
    spread = math.sqrt(own @ (x - own @ x) ** 2)
    assert error[0] == pytest.approx(0.3 * spread / math.sqrt(POPULATION), rel=1e-6)


def test_without_calibration_means_are_plain():
    """Of the draws that are known, with the textbook error of their mean; NaN of none or one."""
    values = np.random.default_rng(1).normal(3.0, 1.0, (3, 6))
    values[1, 4], values[2, 1:] = np.nan, np.nan
    weights = draw_weights(values, None)
    assert weighted_mean(values, weights) == pytest.approx(np.nanmean(values, axis=-1))
    error = standard_error(values, weights, None)
    assert error[0] == pytest.approx(values[0].std(ddof=1) / math.sqrt(6))
    assert error[1] == pytest.approx(np.nanstd(values[1], ddof=1) / math.sqrt(5))
    assert math.isnan(error[2])
    assert math.isnan(weighted_mean(np.full(3, np.nan), np.full(3, np.nan)))


def test_the_stated_error_is_the_scatter_of_the_mean():
    """Over many ensembles of sixteen; a plain mean scatters twice as much."""
    drawn = np.random.default_rng(7)
    x = drawn.gamma(9.0, 0.4, (2000, 16))
    values = 0.02 * x + 0.02 * drawn.normal(size=x.shape)
    calibrated, plain, stated = [], values.mean(axis=-1).std(), []
    for powers, row in zip(x, values, strict=True):
        weigh = Calibration(tuple(powers), 3.6)
        weights = draw_weights(row, weigh)
        calibrated.append(weighted_mean(row, weights))
        stated.append(standard_error(row, weights, weigh))
    scatter = float(np.std(calibrated))
    assert np.mean(calibrated) == pytest.approx(0.072, rel=0.005)
    assert np.mean(stated) == pytest.approx(scatter, rel=0.1)
    assert plain > 1.4 * scatter


def test_no_weights_where_all_known_draws_lie_on_one_side():
    """Then nothing is known of the other, and the mean is the plain one."""
    known = np.array(POWERS) < WEIGH.mean
    assert WEIGH.weights(known)[known] == pytest.approx(1 / known.sum())
    assert not WEIGH.weights(~ALL).any()


def test_factors_are_those_of_the_raceway():
    """The first of a thousand draws; fewer than eight are not weighted."""
    screw = load_screw('nominal')
    assert calibration(screw, LEAST_DRAWS - 1) is None
    weigh = calibration(screw, LEAST_DRAWS)
    assert weigh.powers[3] == raceway_patch(screw, 'screw', 3).scale ** 4
    assert len(weigh.powers) == LEAST_DRAWS
    nut = [raceway_patch(screw, 'nut', draw).scale ** 4 for draw in range(LEAST_DRAWS)]
    assert nut == pytest.approx(weigh.powers, rel=0.12)
    assert calibration(screw, 16).mean == weigh.mean
    assert Calibration(**asdict(weigh)) == weigh


def test_draws_are_doubled_on_the_verge_of_the_idle_load():
    """From eight on; not beyond it, where the relieved balls carry nothing."""
    screw = load_screw('nominal')
    idle = idle_load(screw)
    loads = [0.0, 0.9 * idle, 0.97 * idle, -0.999 * idle, 1.001 * idle, 2 * idle]
    assert [draws_at(screw, 16, load) for load in loads] == [16, 16, 32, 32, 16, 16]
    assert {draws_at(screw, 7, load) for load in loads} == {7}


def test_records_of_draws_have_one_mean():
    """A chain that failed or a draw that did not converge is left out, half of them at most."""
    records = [{'converged': True, 'rcs': 0.1 * power, 'torque': 2.0 - power} for power in POWERS]
    records[1] = None
    records[4] = {'converged': False, 'rcs': math.nan, 'torque': math.nan}
    found = mean_of_draws(records, ('rcs', 'torque'), WEIGH)
    assert found == pytest.approx({'rcs': 0.39, 'torque': -1.9}, rel=1e-9)
    assert mean_of_draws([None] * 6 + records[6:], ('rcs',), WEIGH) == {}
    more = Calibration((*POWERS, 3.0, 4.0), WEIGH.mean)
    assert mean_of_draws(records, ('rcs', 'torque'), more) == pytest.approx(found, rel=1e-12)
