# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The operator of one grid and the transfer to the next, against their plain twins."""

import numpy as np
import pytest
from surrogate.ehl.kernels.level import load_of, stencil
from surrogate.ehl.kernels.transfer import prolong, restrict

NEIGHBOURS = ((0, 0), (-1, 0), (1, 0), (0, -1), (0, 1), (-2, 0))
"""Places of the nodes of a plane, along x and y."""


def test_stencil_is_the_sum_over_the_planes():
    rng = np.random.default_rng(1)
    planes, film_lift = rng.normal(size=(2, 6, 9, 8)), rng.normal(size=(2, 9, 8))
    expected = np.zeros((9, 8))
    for i in range(1, 8):
        for j in range(1, 7):
            for plane, (di, dj) in enumerate(NEIGHBOURS):
                if i + di >= 0:
                    expected[i, j] += planes[:, plane, i, j] @ film_lift[:, i + di, j + dj]
    found = np.zeros((9, 8))
    stencil(*planes, *film_lift, found)
    np.testing.assert_allclose(found, expected, rtol=1e-12, atol=1e-12)


def test_load_is_the_weighted_sum():
    total, weights = np.random.default_rng(2).normal(size=(9, 8)), np.arange(8.0)
    assert load_of(total, weights) == pytest.approx((total * weights).sum())


def test_restriction_is_the_weighted_mean_of_nine_rows():
    """Weights 1 2 1 each way on |y|, rows multiplied by their sizes; zero sizes take one out."""
    rng = np.random.default_rng(3)
    fine, sizes, coarser = rng.normal(size=(9, 10)), rng.random((9, 10)), rng.random((5, 6))
    coarser[2, 3] = 0.0
    found = np.full((5, 6), np.nan)
    restrict(fine, sizes, coarser, found)
    rows, expected = fine * sizes, np.zeros((5, 6))
    rows[:, 0] = rows[:, 2]
    beside, weights = np.arange(-1, 2), np.outer([0.5, 1.0, 0.5], [0.25, 0.5, 0.25])
    for i in range(1, 4):
        for j in range(1, 5):
            if coarser[i, j]:
                nine = rows[np.ix_(2 * i + beside, 2 * j - 1 + beside)]
                expected[i, j] = (weights * nine).sum() / coarser[i, j]
    np.testing.assert_allclose(found, expected, rtol=1e-12, atol=1e-12)


def test_prolongation_is_bilinear():
    """Fine row 2i and column 2j - 1 are the coarse node, others the mean of what is beside."""
    coarse = np.random.default_rng(4).normal(size=(5, 6))
    found = np.empty((9, 10))
    prolong(coarse, found)
    rows = np.array([np.interp(np.arange(9) / 2, np.arange(5), column) for column in coarse.T])
    places = (np.arange(1, 10) + 1) / 2
    expected = np.array([np.interp(places, np.arange(1, 6), row) for row in rows[1:].T])
    np.testing.assert_allclose(found[:, 1:], expected, rtol=1e-12)
    assert (found[:, 0] == found[:, 2]).all()
