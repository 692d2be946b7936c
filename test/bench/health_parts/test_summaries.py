# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Intervals of machines of one size, drawn from catalogues, hold with what their peers tell."""

from functools import partial

from ballscrew_monitor.health.detection import looks
from ballscrew_monitor.health.peers import prior_of, spread_of
from ballscrew_monitor.health.summary import array_of
from health_parts.axis_year import axis_year
from health_parts.score import score_of
from health_parts.summaries import cells_of_year
import numpy as np
import pytest

SEEDS = range(8000, 8006)


@pytest.fixture(scope='module')
def courses():
    """Return the courses of clean years of six axes, each without and with its peers."""
    years = [axis_year(seed, size='32x10', days=240.0) for seed in SEEDS]
    spreads = [spread_of(array_of(cells_of_year(year)), year.machine.size.lead) for year in years]
    alone, together = [], []
    for at, year in enumerate(years):
        prior = prior_of([peer for other, (peer, _) in enumerate(spreads) if other != at])
        alone.append(score_of(year, causes=False))
        together.append(score_of(year, judge=partial(looks, prior=prior), causes=False))
    return alone, together


def test_intervals_hold_with_peers_and_are_hardly_wider(courses):
    alone, together = courses
    assert sum(one.held for one in together) >= 0.9 * sum(one.known for one in together)
    halves = [np.median([one.half for one in some]) for some in courses]
    assert halves[1] < 1.1 * halves[0]
    assert not any(one.early for one in together)
    assert [one.known for one in together] == [one.known for one in alone]
