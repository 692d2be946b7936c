# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Seasons, wander and grease have the amplitudes and times that they are drawn with."""

import math

from health_parts.machine import CELSIUS
from health_parts.weather import draw_weather, fresh_grease, hall_temperature, wandering
import numpy as np
import pytest


def test_hall_swings_by_its_amplitude_over_the_year():
    """The days at the same hour: cold in mid January, warm half a year later."""
    day = 15.0 + np.array([0.0, 182.5 - 0.5, 365.0])
    cold, warm, again = hall_temperature(day, 6.0)
    assert 0.5 * (warm - cold) == pytest.approx(6.0, abs=1.6)  # the half day has 1.5 K itself
    assert again == pytest.approx(cold, abs=1e-9)
    year = hall_temperature(np.arange(365.0) + 0.45, 6.0)
    assert 0.5 * np.ptp(year) == pytest.approx(6.0, rel=1e-3)
    assert np.mean(year) == pytest.approx(CELSIUS + 21.0, abs=0.01)


def test_wander_has_unit_variance_and_fifteen_weeks():
    rng = np.random.default_rng(1)
    day = np.arange(0.0, 364.0, 7.0)
    walks = np.stack([wandering(day, rng) for _ in range(2000)])
    assert np.std(walks, axis=0) == pytest.approx(np.ones(len(day)), abs=0.06)
    together = np.mean(walks[:, 0] * walks[:, 15])
    assert together == pytest.approx(math.exp(-1.0), abs=0.06)


def test_grease_comes_every_quarter_and_wears_off():
    day = np.arange(0.0, 364.0, 0.25)
    fresh = fresh_grease(day, np.random.default_rng(1))
    comes = np.flatnonzero(np.diff(fresh) > 0.5)
    assert 3 <= len(comes) <= 5
    assert np.all(np.diff(day[comes]) > 70.0)
    assert np.all((fresh >= 0.0) & (fresh <= 1.0))
    assert fresh[comes + 1 + 4 * 18] == pytest.approx(fresh[comes + 1] * math.exp(-3.0))


@pytest.mark.parametrize('part', ['nut', 'wiper', 'guideway', 'bearing'])
def test_clean_weeks_stay_within_running_in_grease_and_wander(part):
    """Running-in and grease add at most 12 % each; without wander nothing lies below new."""
    day = np.arange(0.0, 364.0, 7.0)
    for seed in range(20):
        weather = draw_weather(day, np.random.default_rng(seed), wander=0.0)
        factor = getattr(weather.condition, part)
        assert factor.shape == (len(day), 1)
        assert np.all((factor >= 1.0) & (factor <= 1.12 * 1.12))


def test_scatter_is_that_which_is_asked_for():
    day = np.arange(0.0, 364.0, 0.1)
    weather = draw_weather(day, np.random.default_rng(1), scatter=0.02)
    assert np.std(np.log(weather.scatter)) == pytest.approx(0.02, rel=0.05)
