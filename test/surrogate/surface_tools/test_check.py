# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""A check: by the solver of the file's tier, at points of its own, against what is stated."""

from dataclasses import replace

import numpy as np
import pytest
from surrogate.builder import closed_form as build
from surrogate.builder.full import tier as full
from surrogate.surface import shipped_surface, SolvedPoint
from surrogate.surface.aims import EFFICIENCY_TOLERANCE
from surrogate.surface.file import read
from surrogate.surface_tools.check import check_surface, STATED_FACTOR

DATA = read(shipped_surface(tier='closed_form'))


def always():
    return True


def with_solver(monkeypatch, solve):
    """Make the full tier solve by a function; return the points that it is asked for."""
    asked = []

    def noted(header, *point):
        asked.append(point)
        return solve(header, *point)

    monkeypatch.setattr(full, 'solve_full', noted)
    return asked


def test_a_good_surface_passes_and_another_seed_means_other_points(says):
    """All of it is compared, and the errors are what a solve finds."""
    result = check_surface(DATA, 30, 1, always)
    assert result.passed
    assert (result.asked, result.tried, result.silent, result.unsolved) == (30, 30, 0, 0)
    assert 0 < result.efficiency < EFFICIENCY_TOLERANCE
    assert all(0 < ratio < STATED_FACTOR for ratio in result.stated.values())
    assert result.sentence().startswith(says('passed_hash_verified'))
    first, again, other = (check_surface(DATA, 10, seed, always) for seed in (1, 1, 2))
    assert first == again != other


def test_the_tier_of_the_file_chooses_the_solver(monkeypatch):
    """A file of the full tier is held against the full solver, off nodes and centres."""
    asked = with_solver(monkeypatch, build.solve_closed_form)
    full = replace(DATA, header={**DATA.header, 'tier': 'full'})
    assert check_surface(full, 12, 1, always).passed
    assert len(asked) == 12
    for axis, place in ((DATA.load, 1), (DATA.temperature, 2)):
        points = np.array([point[place] for point in asked])
        special = np.concatenate([axis, 0.5 * (axis[1:] + axis[:-1])])
        assert np.abs(points[:, None] - special).min() > 1e-6


def test_what_does_not_converge_is_counted_and_not_compared(monkeypatch):
    """Half of the solves fail: the others decide; when all fail nothing was shown."""
    calls, failed = iter(range(100)), SolvedPoint(converged=False)
    with_solver(monkeypatch, lambda *a: build.solve_closed_form(*a) if next(calls) % 2 else failed)
    full = replace(DATA, header={**DATA.header, 'tier': 'full'})
    half = check_surface(full, 10, 1, always)
    assert half.passed
    assert half.unsolved == 5
    with_solver(monkeypatch, lambda *a: SolvedPoint(converged=True))
    none = check_surface(full, 10, 1, always)
    assert not none.passed
    assert none.unsolved == 10


def test_errors_that_the_file_understates_fail_and_those_it_does_not_state_are_said():
    """A file whose stated errors are a hundredth of the true ones is not believed."""
    lying = replace(DATA, errors={name: 0.01 * error for name, error in DATA.errors.items()})
    result = check_surface(lying, 100, 1, always)
    assert result.efficiency <= EFFICIENCY_TOLERANCE
    assert not result.passed
    assert result.stated['rcs'] > STATED_FACTOR
    silent = {name: np.full_like(error, np.nan) for name, error in DATA.errors.items()}
    result = check_surface(replace(DATA, errors=silent), 5, 1, always)
    assert result.passed
    assert 'rcs not said' in result.sentence()


def test_what_a_cell_states_is_accepted_and_said(monkeypatch):
    """RCS off by 0.01: missed everywhere, accepted where the file states a third of that."""

    def shifted(*args):
        solved = build.solve_closed_form(*args)
        return replace(solved, rcs=solved.rcs + 0.01 * (solved.rcs < 0.04))

    with_solver(monkeypatch, shifted)
    for stated, passes in ((0.0035, True), (0.0025, False)):
        errors = DATA.errors | {'rcs': np.full_like(DATA.errors['rcs'], stated)}
        header = {**DATA.header, 'tier': 'full'}
        result = check_surface(replace(DATA, header=header, errors=errors), 30, 1, always)
        assert result.missed > 0
        assert result.rcs == pytest.approx(2, abs=0.1)
        assert (result.accepted <= 1) is passes is result.passed
        assert f'{result.missed} points miss an aim' in result.sentence()


@pytest.mark.parametrize('steps', [0, 3])
def test_time_ends_the_check(steps):
    """What was done is judged; nothing done is nothing shown."""
    left = iter(range(steps, -1, -1))
    counted = []
    result = check_surface(DATA, 10, 1, lambda: next(left) > 0, lambda: counted.append(1))
    assert result.tried == len(counted) == steps
    assert result.passed is (steps > 0)
