# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Coarser grids of the linear solver: transfer, the same solution, few steps."""

import numpy as np
import pytest
from surrogate.ehl import Condition, Settings, solve_contact
from surrogate.ehl.case import make_case
from surrogate.ehl.grid import KRYLOV_LIMIT, LEVELS, make_grid
from surrogate.ehl.kernels.krylov import solve_newton_step
from surrogate.ehl.kernels.transfer import inject, prolong, restrict
from surrogate.ehl.linear import jacobian_levels
from surrogate.ehl.system import evaluate


@pytest.fixture(scope='module')
def grid():
    """Return a symmetric grid that has two coarser ones."""
    return make_grid(129, 129, (-2.5, 1.5, 2.0), symmetric=True, compliance=1.0)


def test_coarser_grid_keeps_every_other_node(grid):
    """Nodes, mirror column and weights agree; long, short and odd cells have no coarser grid."""
    coarse = grid.coarser
    assert coarse.x == pytest.approx(grid.x[::2])
    assert coarse.y[1:] == pytest.approx(grid.y[1::2])
    assert coarse.y[0] == pytest.approx(-coarse.y[2])
    places = np.meshgrid(grid.x, grid.y, indexing='ij')
    assert inject(places[1])[:, 1:] == pytest.approx(np.tile(coarse.y[1:], (65, 1)))
    assert coarse.coarser.coarser is None
    for ny, side in ((129, 20.0), (129, 0.5), (131, 2.0)):
        other = make_grid(129, ny, (-2.5, 1.5, side), symmetric=True, compliance=1.0)
        assert other.coarser is None


def test_transfer_of_linear_fields(grid):
    """Interpolation and averages are exact for fields linear in x and |y|, borders aside."""

    def field(on):
        return 1.0 + on.x[:, None] + np.abs(on.y)[None, :]

    fine, coarse = np.empty(grid.shape), np.empty(grid.coarser.shape)
    prolong(field(grid.coarser), fine)
    assert fine == pytest.approx(field(grid))
    sizes, sizes_coarse = np.full(grid.shape, 3.0), np.full(coarse.shape, 6.0)
    restrict(fine, sizes, sizes_coarse, coarse)
    assert coarse[1:-1, 2:-1] == pytest.approx(field(grid.coarser)[1:-1, 2:-1])
    assert (coarse[0] == 0).all()
    assert (coarse[:, 0] == 0).all()
    sizes_coarse[5, 5] = 0
    restrict(fine, sizes, sizes_coarse, coarse)
    assert coarse[5, 5] == 0


def test_coarser_grids_change_the_way_not_the_solution(moes_case):
    """The Newton step from Hertz's pressure is that of the lines, in a fraction of the steps."""
    contact, oil, condition, _ = moes_case(200.0, 10.0, 'roelands_dh')
    settings = Settings(nx=129, ny=129, domain=(-2.5, 1.5, 2.0))
    case = make_case(contact, oil, condition, settings, None)
    grid, speed = case.grid(129, 129, symmetric=True), condition.entrainment_speed
    problem = case.problem(grid, speed, case.shape_heights(grid), 1.0)
    state = case.hertz_state(grid, speed)
    now = evaluate(grid, problem, state)
    answers, steps = [], []
    for count in (1, 3):
        levels = jacobian_levels(grid, problem, state, now)
        assert len(levels) == 3
        grid.workspace.basis[0, : now.gap.size] = -now.residual.ravel()
        grid.workspace.basis[0, now.gap.size] = now.load_rest
        padded = tuple(levels + levels[-1:] * (LEVELS - 3))
        steps.append(solve_newton_step(padded, count, 1e-4, KRYLOV_LIMIT))
        answers.append(grid.workspace.answer[: now.gap.size + 1].copy())
    assert np.abs(answers[1] - answers[0]).max() < 3e-2 * np.abs(answers[0]).max()
    assert 2 * steps[1] < steps[0] < KRYLOV_LIMIT


def test_steps_hardly_grow_with_the_grid(moes_case):
    """A solve at 129 x 129 and one at 257 x 257 take about the same Krylov steps."""
    contact, oil, condition, _ = moes_case(200.0, 10.0, 'roelands_dh')
    for nodes in (129, 257):
        settings = Settings(nx=nodes, ny=nodes, domain=(-2.5, 1.5, 2.0))
        found = solve_contact(contact, oil, condition, settings=settings)
        assert found.converged
        assert found.krylov_iterations < 110


def test_contact_is_solved_by_lines_alone(nominal):
    condition = Condition(load=27.6, entrainment_speed=0.0)
    case = make_case(*nominal, condition, Settings(nx=65, ny=129), None)
    grid = case.grid(65, 129, symmetric=True)
    problem = case.problem(grid, 0.0, case.shape_heights(grid), 1.0)
    state = case.hertz_state(grid, 0.0)
    assert grid.coarser is not None
    assert len(jacobian_levels(grid, problem, state, evaluate(grid, problem, state))) == 1
