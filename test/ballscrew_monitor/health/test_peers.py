# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Axes of one kind narrow the interval of each other, and it holds as often as it says."""

import math

from ballscrew_monitor.health.detection import BASELINE_DAYS, baseline_of, now_of
from ballscrew_monitor.health.mixed import (
    estimate,
    GRID,
    Logs,
    MODEL_DOUBT,
    Prior,
    SLOPE,
    SLOPE_DOUBT,
    USUAL,
)
from ballscrew_monitor.health.peers import own_prior, prior_of, priors
import numpy as np
import pytest

WEEKS, NOW = 20, 4
GROUPS = frozenset({1, 2})


def axis_logs(rng, slope, scatter, wander):
    """
    Return weekly logs from January on, and the true change of the last four over the first ones.

    ln(friction) with a slope [1/K], a scatter of logs, and a walk that is forgotten in 15 weeks.

    """
    time = 7.0 * np.arange(WEEKS) + rng.uniform(0.0, 0.3, WEEKS)
    warmth = -6.0 * np.cos(2.0 * math.pi * time / 365.0) + rng.normal(0.0, 1.5, WEEKS)
    walk = np.empty(WEEKS)
    walk[0], kept = rng.standard_normal(), math.exp(-1.0 / 15.0)
    for week in range(1, WEEKS):
        walk[week] = kept * walk[week - 1] + math.sqrt(1.0 - kept**2) * rng.standard_normal()
    lasting = wander * walk
    effect = lasting + slope * warmth + scatter * rng.standard_normal(WEEKS)
    change = lasting[-NOW:].mean() - lasting[: WEEKS - NOW][time[: WEEKS - NOW] <= 91.0].mean()
    return Logs(time, effect, warmth - warmth.mean(), np.ones(WEEKS)), change


def interval(logs, prior):
    now = np.arange(WEEKS) >= WEEKS - now_of(logs.time)
    found = estimate(logs, baseline_of(logs.time, now, BASELINE_DAYS), now, prior=prior)
    return found.change, 1.96 * found.deviation


@pytest.fixture(scope='module')
def families():
    """Return for each axis of 40 families of six: change, and interval without and with peers."""
    rng, rows = np.random.default_rng(11), []
    for _ in range(40):
        kind = rng.normal(-0.012, 0.004)
        scatter, wander = rng.uniform(0.008, 0.02), rng.uniform(0.002, 0.015)
        drawn = [
            axis_logs(
                rng,
                rng.normal(kind, 0.0015),
                scatter * rng.uniform(0.8, 1.25),
                wander * rng.uniform(0.8, 1.25),
            )
            for _ in range(6)
        ]
        spreads = {
            str(at): (own_prior(logs, warm=True), GROUPS) for at, (logs, _) in enumerate(drawn)
        }
        for prior, (logs, change) in zip(priors(spreads).values(), drawn, strict=True):
            rows.append((change, *interval(logs, USUAL), *interval(logs, prior)))
    return np.array(rows)


def test_peers_narrow_the_interval_and_it_still_holds(families):
    change, value, reach, of_peers, reach_of_peers = families.T
    alone, together = np.abs(value - change) <= reach, np.abs(of_peers - change) <= reach_of_peers
    of_model = [np.sqrt((part / 1.96) ** 2 - MODEL_DOUBT**2) for part in (reach, reach_of_peers)]
    assert np.median(of_model[1] / of_model[0]) < 0.92
    assert np.median(reach_of_peers / reach) < 0.95  # the whole interval, as it is said
    assert together.mean() >= 0.9
    assert alone.mean() >= 0.9
    assert np.mean((of_peers - change) ** 2) < 0.8 * np.mean((value - change) ** 2)


def peer(slope=-0.014, doubt=0.001, pairs=None):
    usual = np.exp(GRID.prior)
    pairs = tuple((usual / usual.sum()).tolist()) if pairs is None else pairs
    return Prior(slope, doubt, pairs)


def test_one_peer_says_nothing_and_many_alike_say_nearly_all():
    assert prior_of([peer()]) == USUAL
    three, many = prior_of([peer()] * 3), prior_of([peer()] * 30)
    assert SLOPE > three.slope > many.slope > -0.014
    assert SLOPE_DOUBT > three.doubt > many.doubt
    assert many.slope == pytest.approx(-0.014, abs=3e-4)


def test_peers_that_differ_leave_the_slope_open():
    apart = prior_of([peer(-0.002), peer(-0.018), peer(-0.004), peer(-0.016)])
    alike = prior_of([peer(-0.010)] * 4)
    assert apart.doubt > 1.5 * alike.doubt
    assert apart.slope == pytest.approx(SLOPE, abs=1e-6)


def test_axes_without_a_temperature_share_their_scatter_alone():
    prior = prior_of([peer(doubt=math.inf)] * 3)
    assert (prior.slope, prior.doubt) == (SLOPE, pytest.approx(SLOPE_DOUBT))


def test_the_pairs_of_peers_outweigh_the_usual_ones():
    pairs = tuple(float(at == 5) for at in range(49))
    prior = prior_of([peer(pairs=pairs)] * 4)
    assert prior.pairs[5] == pytest.approx((4.0 + 2.0 * peer().pairs[5]) / 6.0)
    assert sum(prior.pairs) == pytest.approx(1.0)
    assert min(prior.pairs) > 0.0


def test_another_programme_is_no_peer():
    others = {name: (peer(), frozenset({8, 9})) for name in 'abc'}
    found = priors({'x': (peer(), GROUPS), **others})
    assert found['x'] == USUAL
    assert found['a'] != USUAL
