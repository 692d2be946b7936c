# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The end of an iteration, and the longest step."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from surrogate.ehl import Condition, newton, Settings
from surrogate.ehl.case import make_case
from surrogate.ehl.newton import limit_on_contact, OVERSHOOT
from surrogate.ehl.system import evaluate

RISE = 1.0


@pytest.fixture(name='at_hertz')
def start_at_hertz(nominal):
    """Return grid, problem and Hertz's state of a smooth contact."""
    settings, speed = Settings(nx=33, ny=33), 0.5
    case = make_case(*nominal, Condition(load=27.6, entrainment_speed=speed), settings, None)
    grid = case.grid(33, 33, symmetric=False)
    problem = case.problem(grid, speed, case.shape_heights(grid), 1.0)
    return grid, problem, case.hertz_state(grid, speed)


@pytest.mark.parametrize('sign', [1, -1])
def test_asperity_pressure_on_a_free_node_is_an_error_of_the_gap(at_hertz, sign):
    """Also one that pulls: its node is about to leave contact and may lie below the floor."""
    grid, problem, state = at_hertz
    assert evaluate(grid, problem, state).gap_error == 0.0
    asperity = np.zeros(grid.shape)
    asperity[2, 2] = sign * 1e-3 * problem.floor / grid.stiffness
    now = evaluate(grid, problem, replace(state, asperity_pressure=asperity))
    assert not now.contact.any()
    assert now.gap_error == pytest.approx(1e-3)


def test_linear_solves_are_tight_where_newton_stalls(at_hertz, monkeypatch):
    """Loose at first and after each step that halved the flux error; both happen from Hertz."""
    seen, solve = [], newton.solve_linear

    def watch(grid, problem, state, now, tolerance):
        seen.append((now.flux_error, tolerance))
        return solve(grid, problem, state, now, tolerance)

    monkeypatch.setattr(newton, 'solve_linear', watch)
    limits = newton.NewtonLimits(krylov=0.3, stalled=0.02)
    assert newton.solve_grid(*at_hertz, limits).converged
    flux, tolerance = zip(*seen, strict=True)
    falls = [True, *(after < 0.5 * before for before, after in pairwise(flux))]
    assert {*falls} == {True, False}
    assert [*tolerance] == [0.3 if fell else 0.02 for fell in falls]
    seen.clear()
    newton.solve_grid(*at_hertz, replace(limits, stalled=1.0))
    assert {tight for _, tight in seen} == {0.3}


def test_a_step_that_does_not_help_is_halved(at_hertz):
    """Away from a solution: halved as often as told; towards it: taken whole."""
    grid, problem, start = at_hertz
    solved = newton.solve_grid(grid, problem, start, newton.NewtonLimits(flux=1e-6)).state
    flux = evaluate(grid, problem, solved).flux_error
    wrong = replace(solved, approach=solved.approach + 1.0)
    kept = newton._shortened(grid, problem, solved, wrong, flux, 4)
    assert kept.approach == pytest.approx(solved.approach + 1 / 16)
    whole = newton._shortened(
        grid, problem, start, solved, evaluate(grid, problem, start).flux_error, 4
    )
    assert whole is solved


def limited(at_hertz, change):
    """Return what is taken of changes of the film pressure from half the Hertz pressure."""
    _, problem, _ = at_hertz
    return limit_on_contact(problem, np.full(len(change), 0.5), np.array(change), RISE)


def test_small_changes_on_contact_are_taken_whole_and_large_ones_cut(at_hertz):
    """A fall by powers of e of the viscosity, in steps that grow as it does; a rise by its cap."""
    change = [-1e-3, -1e-6, 0.0, 1e-6, 0.5]
    assert limited(at_hertz, change) == pytest.approx(change, rel=1e-12)
    _, problem, _ = at_hertz
    viscosity = replace(problem, exponent=1.0, growth=20.0, pressure_scale=1.96e8)
    found = limit_on_contact(viscosity, np.full(2, 5.0), np.array([-3.0, -4.0]), RISE)
    assert found == pytest.approx(-OVERSHOOT * np.log1p(20.0 * np.array([3.0, 4.0])) / 20.0)
    assert limited(at_hertz, [7.0, -50.0]) == pytest.approx([RISE, -0.5])
