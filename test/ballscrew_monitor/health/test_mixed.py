# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The mixed model against textbook forms: regression, Kalman filter, and its own coverage."""

import math

from ballscrew_monitor.health import mixed
from ballscrew_monitor.health.mixed import (
    CORRELATION_TIME,
    covariance,
    estimate,
    fit,
    Grid,
    grid,
    Logs,
    SLOPE,
    weights_of,
)
import numpy as np
import pytest

WEEK = 7.0


def logs_of(effect, warmth=None, step=WEEK):
    count = len(effect)
    warm = np.zeros(count) if warmth is None else np.asarray(warmth)
    return Logs(step * np.arange(count), np.asarray(effect), warm, np.ones(count))


def two_blocks(count, now):
    return np.array([0] * (count - now) + [1] * now)


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
        monkeypatch.setattr(mixed, 'grid', lambda: pair)
        return pair

    return choose


def test_without_wander_the_change_is_the_difference_of_two_means(only, monkeypatch):
    monkeypatch.setattr(mixed, 'RUNNING_IN', 1e-6)
    monkeypatch.setattr(mixed, 'FREE', 1e3)
    only(0.02, 1e-9)
    effect = np.random.default_rng(1).normal(0.0, 0.02, 14)
    found = estimate(logs_of(effect), two_blocks(14, 4), np.ones(1))
    assert found.value == pytest.approx(effect[10:].mean() - effect[:10].mean(), abs=1e-5)
    wanted = 0.02 * math.sqrt(1 / 4 + 1 / 10)
    assert found.deviation == pytest.approx(wanted, rel=1e-3)
    assert found.lasting_deviation == pytest.approx(wanted, rel=1e-3)


def test_the_slope_is_that_of_a_regression_with_a_prior(only, monkeypatch):
    """Two normal estimates, that of the data and that of the oil, weighed by their precision."""
    monkeypatch.setattr(mixed, 'RUNNING_IN', 1e-6)
    only(0.01, 1e-9)
    random = np.random.default_rng(3)
    warmth = random.normal(0.0, 2.0, 20)
    effect = -0.02 * warmth + random.normal(0.0, 0.01, 20)
    found = fit(logs_of(effect, warmth), np.zeros(20, dtype=int))
    centred = warmth - warmth.mean()
    precision = (centred @ centred) / 0.01**2
    own = (centred @ effect) / (centred @ centred)
    prior = mixed.SLOPE_DOUBT**-2.0
    wanted = (precision * own + prior * SLOPE) / (precision + prior)
    assert SLOPE + found.mean[0, 1] == pytest.approx(wanted, abs=1e-5)


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


def test_the_covariance_is_that_of_a_state_that_a_kalman_filter_follows():
    effect = np.random.default_rng(5).normal(0.0, 0.02, 30)
    pairs = Grid(np.array([0.02, 0.01]), np.array([0.015, 0.03]), np.zeros(2))
    for matrix, scatter, wander in zip(
        covariance(logs_of(effect), pairs), pairs.scatter, pairs.wander, strict=True
    ):
        sign, determinant = np.linalg.slogdet(matrix)
        chi = effect @ np.linalg.solve(matrix, effect)
        dense = -0.5 * (determinant + chi + 30 * math.log(2.0 * math.pi))
        assert sign == 1.0
        assert dense == pytest.approx(kalman_likelihood(effect, scatter, wander), abs=1e-9)


def test_the_grid_is_weighed_towards_the_scatter_and_wander_that_are_there():
    random, pairs = np.random.default_rng(7), grid()
    blocks = np.zeros(60, dtype=int)
    quiet = weights_of(logs_of(random.normal(0.0, 0.01, 60)), blocks)
    loud = weights_of(logs_of(wandering(random, 60, 0.05) + random.normal(0.0, 0.02, 60)), blocks)
    assert quiet.sum() == pytest.approx(1.0)
    assert quiet @ pairs.scatter < 0.013
    assert loud @ pairs.scatter > 0.015
    assert loud @ pairs.wander > quiet @ pairs.wander + 0.005


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
        blocks = np.array([0] * 13 + [1] * 8 + [2] * 5 + [3] * 4)
        weight = weights_of(logs_of(effect, warmth).until(22), blocks[:22])
        found = estimate(logs_of(effect, warmth), blocks, weight)
        held += abs(found.value - drift[26:].mean()) < 1.96 * found.deviation
    assert held >= 108


def test_a_season_without_a_thermometer_widens_the_interval():
    effect = np.random.default_rng(13).normal(0.0, 0.01, 30)
    blocks = np.array([0] * 13 + [1] * 13 + [2] * 4)
    weight = np.ones(len(grid().prior)) / len(grid().prior)
    known, unknown = (
        estimate(logs_of(effect), blocks, weight, warm=warm) for warm in (True, False)
    )
    assert unknown.deviation > 1.5 * known.deviation
