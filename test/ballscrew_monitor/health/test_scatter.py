# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Means of groups over days: closed forms, scatter found again, and the coverage of intervals."""

import math

from ballscrew_monitor.health.energy import student
from ballscrew_monitor.health.scatter import (
    Information,
    information_of,
    OWN_WORTH,
    Scatter,
    scatter_of,
    Seen,
    USUAL,
    WORTH,
)
import numpy as np
import pytest

FRICTION = np.array([0.2, 0.3, 0.25, 0.4, 0.35, 0.3])
SLOPES = -np.array([0.0, 0.002, 0.004, 0.01, 0.014, 0.012])
"""Change of the friction by the warmth of the contacts [N m/K]."""


def seen(residual, day, group, noise=1e-8):
    size = len(residual)
    slopes = np.zeros((size, 4))
    slopes[:, 3] = SLOPES[group]
    return Seen(
        friction=FRICTION,
        group=np.asarray(group),
        day=np.asarray(day),
        stretches=np.full(size, 8.0),
        residual=np.asarray(residual),
        modelled=FRICTION[group],
        noise=np.full(size, noise),
        slopes=slopes,
    )


def drawn(random, days, true, shift=0.0, *, share=1.0):
    """Return days of a known scatter; each group is seen on a share of them."""
    day, group, residual = [], [], []
    for number in range(days):
        common, warm = true.common * random.normal(), true.warmth * random.normal()
        for at, torque in enumerate(FRICTION):
            if random.random() > share:
                continue
            own = true.own * random.normal()
            day.append(number)
            group.append(at)
            residual.append((common + own + shift) * torque + warm * SLOPES[at])
    return seen(np.array(residual), day, np.array(group))


def total(period, scatter):
    """Return the mean of all groups together over the friction with its deviation [-]."""
    matrix, pull = (
        sum(parts) for parts in zip(*(information_of(one, scatter) for one in period.days()))
    )
    covariance = np.linalg.inv(matrix)
    weights = np.ones(len(FRICTION)) / FRICTION.sum()
    return weights @ covariance @ pull, math.sqrt(weights @ covariance @ weights)


def test_one_group_has_the_variance_of_a_mean_of_days():
    scatter, torque, slope = Scatter(0.02, 0.5, 0.01), FRICTION[3], SLOPES[3]
    period = seen(np.array([0.01, 0.02, 0.03]), [1, 2, 3], np.array([3, 3, 3]), noise=4e-6)
    known = [information_of(one, scatter) for one in period.days()]
    matrix = sum(one.matrix for one in known)
    variance = (0.02 * torque) ** 2 + (0.01 * torque) ** 2 + (0.5 * slope) ** 2 + 4e-6
    assert matrix[3, 3] == pytest.approx(3.0 / variance, rel=1e-9)
    assert sum(one.pull for one in known)[3] == pytest.approx(0.06 / variance, rel=1e-9)
    assert np.count_nonzero(matrix) == 1
    assert isinstance(known[0], Information)


def test_the_mean_of_one_day_is_what_it_shows():
    residual = 0.01 * np.arange(6)
    (known,) = [information_of(one, USUAL) for one in seen(residual, [5] * 6, np.arange(6)).days()]
    assert np.linalg.solve(known.matrix, known.pull) == pytest.approx(residual, abs=1e-12)


def test_a_scatter_is_found_again_and_little_leaves_what_is_usual():
    true = Scatter(common=0.03, warmth=1.5, own=0.004)
    found = scatter_of([drawn(np.random.default_rng(2), 200, true)])
    assert found.common == pytest.approx(true.common, rel=0.2)
    assert found.warmth == pytest.approx(true.warmth, rel=0.2)
    assert found.own == pytest.approx(true.own, rel=0.1)
    single = scatter_of([seen(np.zeros(1), [1], np.array([0]))])
    assert 0.5 * USUAL.common < single.common <= USUAL.common
    assert WORTH < OWN_WORTH


def test_the_interval_of_a_change_holds_it_in_95_of_100_series():
    """60 series with fixed seeds: 57 are expected, and fewer than 52 in one of a hundred draws."""
    true, held = Scatter(common=0.015, warmth=0.8, own=0.008), 0
    for seed in range(60):
        random = np.random.default_rng(seed)
        before = drawn(random, 12, true, share=0.8)
        now = drawn(random, 8, true, -0.05, share=0.8)
        scatter = scatter_of([before, now])
        (old, apart), (new, apart_now) = total(before, scatter), total(now, scatter)
        reach = student(11 + WORTH) * math.hypot(apart, apart_now)
        held += abs(new - old + 0.05) <= reach
    assert 52 <= held <= 60
