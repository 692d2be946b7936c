# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The least squares problem of GMRES and a whole Newton step, against dense algebra of numpy."""

import numpy as np
import pytest
from surrogate.ehl import Condition, Settings
from surrogate.ehl.case import make_case
from surrogate.ehl.grid import LEVELS
from surrogate.ehl.kernels.krylov import dot, orthogonalise, rotate, solve_newton_step
from surrogate.ehl.kernels.level import apply_operator, unknowns
from surrogate.ehl.linear import jacobian_levels
from surrogate.ehl.system import evaluate


def test_dot_is_numpys():
    a, b = np.random.default_rng(1).normal(size=(2, 1001))
    assert dot(a, b) == pytest.approx(a @ b, rel=1e-12)


def test_basis_and_column_are_those_of_a_qr_factorisation():
    """Vectors that were orthonormalised one by one are Q, their columns R, signs aside."""
    vectors = np.random.default_rng(2).normal(size=(5, 40))
    basis, upper = vectors.copy(), np.zeros((5, 5))
    for last in range(5):
        orthogonalise(basis, last, 40, upper[:, last])
    q, r = np.linalg.qr(vectors.T)
    signs = np.sign(np.diag(r))
    np.testing.assert_allclose(basis, (q * signs).T, atol=1e-12)
    np.testing.assert_allclose(upper, r * signs[:, None], atol=1e-12)


def test_rotations_solve_the_least_squares_problem():
    """A Hessenberg matrix turns triangular; what is left of the right-hand side is the error."""
    hessenberg = np.triu(np.random.default_rng(3).normal(size=(7, 6)), -1)
    upper, turns, rest = hessenberg.copy(), np.zeros((2, 6)), np.zeros(8)
    rest[0] = 3.0
    assert all(rotate(upper, turns, rest, k) for k in range(6))
    right = np.zeros(7)
    right[0] = 3.0
    expected, error, _, _ = np.linalg.lstsq(hessenberg, right, rcond=None)
    np.testing.assert_allclose(np.linalg.solve(np.triu(upper[:6]), rest[:6]), expected)
    assert rest[6] ** 2 == pytest.approx(float(error[0]))
    assert not rotate(np.zeros((7, 6)), np.zeros((2, 6)), rest, 0)


def test_a_newton_step_is_that_of_the_dense_jacobian(nominal):
    """All columns of the operator, one by one, and a right-hand side of noise."""
    settings = Settings(nx=25, ny=25, domain=(-2.5, 1.5, 1.5))
    case = make_case(*nominal, Condition(load=27.6, entrainment_speed=0.05), settings, None)
    grid = case.grid(25, 25, symmetric=False)
    problem = case.problem(grid, 0.05, case.shape_heights(grid), 1.0)
    state = case.hertz_state(grid, 0.05)
    now = evaluate(grid, problem, state)
    levels = jacobian_levels(grid, problem, state, now)
    size = unknowns(levels[0])
    matrix, column = np.empty((size, size)), np.zeros(size, np.float32)
    for k, unit in enumerate(np.eye(size, dtype=np.float32)):
        apply_operator(levels[0], unit, column)
        matrix[:, k] = column
    inner = np.abs(matrix).sum(axis=1) > 0
    right = np.random.default_rng(4).normal(size=size).astype(np.float32) * inner
    grid.workspace.basis[0, :size] = right
    solve_newton_step(tuple(levels * LEVELS), 1, 1e-5, 120)
    found = grid.workspace.answer[:size].astype(float)
    assert np.linalg.norm(matrix @ found - right) < 1e-4 * np.linalg.norm(right)
