# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The mixed model against textbook forms: normal densities, Kalman filter, and its coverage."""

import math

from ballscrew_monitor.health import mixed
from ballscrew_monitor.health.mixed import (
    CORRELATION_TIME,
    estimate,
    GRID,
    Grid,
    Logs,
    Model,
    SLOPE,
)
import numpy as np
import pytest

WEEK = 7.0


def logs_of(effect, warmth=None, step=WEEK):
    count = len(effect)
    warm = np.zeros(count) if warmth is None else np.asarray(warmth)
    return Logs(step * np.arange(count), np.asarray(effect), warm, np.ones(count))


def parts(count, baseline=13, now=4):
    at = np.arange(count)
    return at < baseline, at >= count - now


def density(values, covariance):
    """Return the logarithm of the density of the normal distribution about zero."""
    sign, determinant = np.linalg.slogdet(2.0 * math.pi * covariance)
    assert sign == 1.0
    return -0.5 * (determinant + values @ np.linalg.solve(covariance, values))


def wandering(random, count, deviation):
    """Return an autoregression of first order, week by week."""
    keep = math.exp(-WEEK / CORRELATION_TIME)
    values = [random.normal(0.0, deviation)]
    for _ in range(count - 1):
        values.append(keep * values[-1] + math.sqrt(1.0 - keep**2) * random.normal(0.0, deviation))
    return np.array(values)


@pytest.fixture(name='only')
def only_pair(monkeypatch):
    """Return a function that makes one pair of scatter and wander the whole grid."""

    def choose(scatter, wander):
        pair = Grid(np.array([scatter]), np.array([wander]), np.zeros(1))
        monkeypatch.setattr(mixed, 'GRID', pair)
        return pair

    return choose


def test_a_shape_is_as_probable_as_its_density_says(only):
    """Twice: the second shape beside a first one that is held for true."""
    only(0.015, 0.01)
    logs = logs_of(np.random.default_rng(1).normal(0.0, 0.02, 20))
    model = Model(logs)
    shapes = model.shapes
    for first in (5, len(shapes.mean) - 3):
        weights = model.weights()
        covariance = np.linalg.inv(model.inverse[0])
        plain = density(model.rest, covariance)
        for which in (0, 20, 40, len(shapes.mean) - 1):
            column = shapes.column[:, which]
            rest = model.rest - shapes.mean[which] * column
            more = covariance + shapes.deviation[which] ** 2 * np.outer(column, column)
            wanted = density(rest, more) - plain + shapes.prior[which]
            ratio = math.log(weights.shapes[which] / weights.none)
            assert ratio == pytest.approx(wanted, abs=1e-6)
        model.hold(first)


def test_a_number_is_what_it_is_by_conditional_normal_distributions(only):
    """The mean and the deviation of the level of now, without a shape and with one."""
    pair = only(0.015, 0.02)
    logs = logs_of(wandering(np.random.default_rng(2), 20, 0.02))
    model = Model(logs)
    shapes = model.shapes
    share = np.where(np.arange(20) >= 16, 0.25, 0.0)
    pull = model.signal @ share
    level = model.mixture(model.weights(), pull, pull @ share, share @ shapes.column)
    signal, noise = model.signal[0], np.linalg.inv(model.inverse[0]) - model.signal[0]
    for which, column in ((0, np.zeros(20)), (30, shapes.column[:, 29])):
        with_it = signal + shapes.deviation[29] ** 2 * np.outer(column, column)
        gain = share @ with_it @ np.linalg.inv(with_it + noise)
        left = share @ with_it @ share - gain @ with_it @ share
        assert level.mean[0, which] == pytest.approx(gain @ model.rest, abs=1e-6)
        assert level.deviation[0, which] == pytest.approx(math.sqrt(left), rel=1e-4)
    assert pair.prior.size == 1


def test_the_slope_is_that_of_a_regression_with_a_prior(only, monkeypatch):
    """Two normal estimates, that of the data and that of the oil, weighed by their precision."""
    for rate in ('CHANGE_RATE', 'GREASE_RATE', 'RUNNING_IN'):
        monkeypatch.setattr(mixed, rate, 1e-9)
    only(0.01, 1e-9)
    random = np.random.default_rng(3)
    warmth = random.normal(0.0, 2.0, 20)
    effect = -0.02 * warmth + random.normal(0.0, 0.01, 20)
    found = estimate(logs_of(effect, warmth), *parts(20))
    centred = warmth - warmth.mean()
    precision = (centred @ centred) / 0.01**2
    own = (centred @ effect) / (centred @ centred)
    prior = mixed.SLOPE_DOUBT**-2.0
    wanted = (precision * own + prior * SLOPE) / (precision + prior)
    assert found.slope == pytest.approx(wanted, abs=1e-5)


def kalman_likelihood(effect, scatter, wander):
    """Return the log likelihood of wander and scatter about zero, by the textbook filter."""
    keep = math.exp(-WEEK / CORRELATION_TIME)
    mean, variance, total = 0.0, wander**2, 0.0
    for value in effect:
        spread = variance + scatter**2
        total -= 0.5 * (math.log(2.0 * math.pi * spread) + (value - mean) ** 2 / spread)
        gain = variance / spread
        mean, variance = mean + gain * (value - mean), (1.0 - gain) * variance
        mean, variance = keep * mean, keep**2 * variance + (1.0 - keep**2) * wander**2
    return total


def test_the_covariance_is_that_of_a_state_that_a_kalman_filter_follows(monkeypatch):
    for other in ('LEVEL', 'RUNNING_IN'):
        monkeypatch.setattr(mixed, other, 1e-9)
    effect = np.random.default_rng(5).normal(0.0, 0.02, 30)
    pairs = Grid(np.array([0.02, 0.01]), np.array([0.015, 0.03]), np.zeros(2))
    monkeypatch.setattr(mixed, 'GRID', pairs)
    matrices = np.linalg.inv(Model(logs_of(effect)).inverse)
    for matrix, scatter, wander in zip(matrices, pairs.scatter, pairs.wander, strict=True):
        wanted = kalman_likelihood(effect, scatter, wander)
        assert density(effect, matrix) == pytest.approx(wanted, abs=1e-9)


def pairs_of(effect):
    return Model(logs_of(effect)).weights().probability.sum(axis=1)


def test_the_grid_is_weighed_towards_the_scatter_and_wander_that_are_there():
    random = np.random.default_rng(7)
    quiet = pairs_of(random.normal(0.0, 0.01, 60))
    loud = pairs_of(wandering(random, 60, 0.05) + random.normal(0.0, 0.02, 60))
    assert quiet.sum() == pytest.approx(1.0)
    assert quiet @ GRID.scatter < 0.013
    assert loud @ GRID.scatter > 0.015
    assert loud @ GRID.wander > quiet @ GRID.wander + 0.005


@pytest.mark.parametrize(('scatter', 'wander'), [(0.01, 0.0), (0.02, 0.015), (0.03, 0.03)])
def test_the_interval_holds_the_change_with_its_wander(scatter, wander):
    """A change of a tenth, 120 times; at least nine of ten hold."""
    random, held = np.random.default_rng(11), 0
    for _ in range(120):
        drift = wandering(random, 30, wander)
        drift[26:] -= 0.1
        warmth = random.normal(0.0, 2.0, 30) + 5.0 * np.sin(np.arange(30) / 8.0)
        slope = random.normal(SLOPE, 0.004)
        effect = 0.7 + drift + slope * warmth + random.normal(0.0, scatter, 30)
        found = estimate(logs_of(effect, warmth), *parts(30))
        truth = drift[26:].mean() - drift[:13].mean()
        held += abs(found.change - truth) < 1.96 * found.deviation
    assert held >= 108


def test_what_lasts_is_told_from_what_wanders():
    """The same loss at once and over 40 weeks: the step is the surer one."""
    random = np.random.default_rng(17)
    noise = random.normal(0.0, 0.012, 48)
    slow = np.clip((np.arange(48) - 8) / 40.0, 0.0, 1.0)
    fast = np.where(np.arange(48) >= 40, 1.0, 0.0)
    doubts = [
        estimate(logs_of(noise - 0.07 * shape), *parts(48)).lasts.within(0.03, -1)
        for shape in (slow, fast)
    ]
    assert doubts[1] < 0.01 < doubts[0]


def test_a_season_without_a_thermometer_widens_the_interval():
    effect = np.random.default_rng(13).normal(0.0, 0.01, 30)
    known, unknown = (estimate(logs_of(effect), *parts(30), warm=warm) for warm in (True, False))
    assert unknown.deviation > 1.3 * known.deviation
