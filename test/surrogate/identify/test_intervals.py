# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Intervals against closed forms: a mean, a straight line, a Huber location, lost rank."""

import math

import numpy as np
import pytest
from surrogate.identify.intervals import correlation, covariance, student_factor, undetermined

DRAWN = np.random.default_rng(5)


def test_a_mean_and_a_line_have_their_textbook_errors():
    """Over root n, with n - 1 degrees of freedom; t of the printed table; covariance of numpy."""
    sample = DRAWN.standard_normal(11)
    cover, variance = covariance(np.ones((11, 1)), sample - sample.mean())
    assert variance == pytest.approx(np.var(sample, ddof=1))
    assert cover[0, 0] == pytest.approx(np.var(sample, ddof=1) / 11)
    assert student_factor(10) == pytest.approx(2.228, abs=5e-4)
    x = np.linspace(1.0, 9.0, 15)
    y = 1e6 * x + DRAWN.standard_normal(15)
    fit, expected = np.polyfit(x, y, 1, cov=True)
    cover, _ = covariance(np.stack([x, np.ones(15)], axis=1), y - np.polyval(fit, x))
    np.testing.assert_allclose(cover, expected, rtol=1e-6)
    along = correlation(cover)
    assert along[0, 1] == pytest.approx(expected[0, 1] / math.sqrt(np.prod(np.diag(expected))))


def test_robust_variance_is_that_of_least_squares_where_nothing_is_cut():
    """With a spread far above the residuals psi is the residual itself."""
    residual = DRAWN.standard_normal(20)
    jacobian = np.ones((20, 1))
    plain, _ = covariance(jacobian, residual)
    wide, _ = covariance(jacobian, residual, 1e6)
    assert wide[0, 0] == pytest.approx(plain[0, 0], rel=1e-9)
    outlier = np.append(residual, 100.0)
    robust, _ = covariance(np.ones((21, 1)), outlier, 1.0)
    assert robust[0, 0] < 0.01 * covariance(np.ones((21, 1)), outlier)[0][0, 0]


@pytest.mark.parametrize(('angle', 'lost'), [(1.9e-6, True), (2.1e-6, False)])
def test_two_columns_are_told_apart_by_a_millionth_of_the_largest_singular_value(angle, lost):
    """Of unit columns at an angle [rad] they are sqrt(2) times its half's sine and cosine."""
    jacobian = np.array([[1.0, math.cos(angle)], [0.0, math.sin(angle)]])
    assert bool(undetermined(('a', 'b'), jacobian)) is lost


def test_parameters_that_the_data_cannot_tell_are_named():
    """Two equal columns are lost, a third one keeps its error."""
    x = np.linspace(1.0, 2.0, 6)
    jacobian = np.stack([x, 5 * x, x**2], axis=1)
    found = undetermined(('a', 'b', 'c'), jacobian)
    assert found == dict.fromkeys('ab', 'the data cannot tell a from b')
    assert undetermined(('a', 'c'), jacobian[:, [0, 2]]) == {}
    assert undetermined((), jacobian[:, []]) == {}
    residual = DRAWN.standard_normal(6)
    cover, _ = covariance(jacobian, residual)
    # One parameter more costs a degree of freedom and nothing else.
    alone, _ = covariance(jacobian[:, [0, 2]], residual)
    assert cover[2, 2] == pytest.approx(alone[1, 1] * 4 / 3, rel=1e-6)
