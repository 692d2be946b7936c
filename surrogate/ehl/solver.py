# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Solve one lubricated, mixed or dry contact from cold or from a neighbouring solution.

Cold: a cascade of grids from Hertz's pressure, first-order wedge below the finest; if that fails, from a
faster speed downwards. Rough: the smooth film at a speed that parts the surfaces, then the roughness
grows to its height, then the speed falls. Every path is cut in halves where a step fails.

"""

from collections.abc import Callable
from dataclasses import dataclass, replace
import math
import time

import numpy as np
from surrogate.ehl.case import Array, Case, make_case, STIFF
from surrogate.ehl.grid import Grid, State, transfer
from surrogate.ehl.model import (
    check_contact,
    Condition,
    ContactLubricant,
    ContactSolution,
    Roughness,
    Settings,
    Status,
)
from surrogate.ehl.newton import Limits, Outcome, Problem, solve_grid
from surrogate.ehl.result import central_film, make_solution, state_from_solution
from surrogate.geometry import Contact

FINEST_CUT = 1 / 64
"""Shortest step of a continuation path, as a share of it [-]."""
EDGE_SHARE = 2e-3
"""Share of the load on the last rows inside outlet and sides that a domain may have [-]."""
WARM_NEWTON = 25
"""Most Newton iterations of one step from a neighbouring solution [-]."""
PARTING = 1.5
"""Smooth film over the roughness rms at which a rough path starts [-]."""


@dataclass(slots=True)
class _Run:
    """Counters of one call and what it has found."""

    case: Case
    deadline: float
    newton: int = 0
    krylov: int = 0
    half: tuple[float, float] = (math.nan, math.nan)

    def limits(self, *, rough: bool, final: bool) -> Limits:
        """Return the tolerances of a smooth or rough solve, on the way or at the end."""
        settings, stiff = self.case.settings, self.case.fluid_numbers(0.0)[0] > STIFF
        steps = (1.0, 12.0, 1.0) if rough else (0.5, 3.0 if stiff else 6.0, 0.3)
        return Limits(
            flux=settings.flux_tolerance if final else max(1e-2, settings.flux_tolerance),
            load=settings.load_tolerance, gap=settings.gap_tolerance,
            krylov=0.01 if rough or stiff else 0.05, newton=settings.newton_limit,
            step=steps[0], viscous=steps[1], rise=steps[2], deadline=self.deadline)

    def solve(self, grid: Grid, problem: Problem, state: State, limits: Limits) -> Outcome:
        """Solve on one grid and count."""
        outcome = solve_grid(grid, problem, state, limits)
        self.newton += outcome.newton
        self.krylov += outcome.krylov
        return outcome

    def march(self, grid: Grid, state: State, path: Callable[[float], Problem], limits: Limits,
              first: float = 1.0) -> Outcome:
        """Follow `path` from 0, where `state` holds, to 1, in steps that are halved on failure."""
        place, step = 0.0, first
        loose = replace(limits, flux=max(1e-2, limits.flux), gap=max(1e-2, limits.gap))
        while True:
            target = 1.0 if place + step > 1 - 1e-9 else place + step
            outcome = self.solve(grid, path(target), state, limits if target == 1.0 else loose)
            if outcome.converged:
                place, state, step = target, outcome.state, min(2 * step, 1 - target)
                if place == 1.0:
                    return outcome
            else:
                step /= 2
                if step < FINEST_CUT or outcome.out_of_time:
                    return outcome

    def smooth(self, speed: float, *, final: bool) -> tuple[Grid, Outcome]:
        """Solve the smooth contact from cold through the cascade."""
        levels = self.case.levels()
        grid, outcome = self._cascade(speed, levels[:-1])
        fine = self.case.grid(*levels[-1], symmetric=True)
        heights = self.case.shape_heights(fine)
        limits = self.limits(rough=False, final=final)
        state = transfer(outcome.state, grid, fine) if outcome and outcome.converged else None
        first = self.case.problem(fine, speed, heights, 1.0)
        if state is None:
            outcome = self._from_hertz(fine, speed, limits)
            if not outcome.converged:
                return fine, outcome
            state = outcome.state
        order = self.case.order(fine, speed, 0.0)
        outcome = self.solve(fine, replace(first, order=order), state, limits)
        if not outcome.converged and not outcome.out_of_time:
            easier = self.solve(fine, first, state, limits)
            if easier.converged:
                outcome = self.march(fine, easier.state, lambda t: replace(
                    first, order=1.0 + t * (order - 1.0)), limits, 0.5)
        return fine, outcome

    def _cascade(self, speed: float, levels: list[tuple[int, int]]) -> tuple[
            Grid | None, Outcome | None]:
        """Solve the coarser grids at first order; on the last also at the final order."""
        grid: Grid | None = None
        outcome: Outcome | None = None
        limits = self.limits(rough=False, final=False)
        for place, shape in enumerate(levels):
            finer = self.case.grid(*shape, symmetric=True)
            problem = self.case.problem(finer, speed, self.case.shape_heights(finer), 1.0)
            if outcome is not None and outcome.converged and grid is not None:
                outcome = self.solve(finer, problem, transfer(outcome.state, grid, finer), limits)
            else:
                outcome = self._from_hertz(finer, speed, limits)
            grid = finer
            if place == len(levels) - 1 and outcome.converged:
                outcome = self._half_grid(grid, problem, speed, outcome)
        return grid, outcome

    def _half_grid(self, grid: Grid, problem: Problem, speed: float, start: Outcome) -> Outcome:
        """Solve the last but one grid as the finest is solved and note its film."""
        if not self.case.settings.error_estimate or self.case.roughness is not None:
            return start
        limits = replace(self.limits(rough=False, final=True), flux=1e-3, newton=15)
        order = self.case.order(grid, speed, 0.0)
        outcome = self.solve(grid, replace(problem, order=order), start.state, limits)
        if not outcome.converged or (outcome.contact.any() and not problem.dry):
            return start
        self.half = central_film(grid, outcome.gap), float(outcome.gap.min())
        return outcome

    def _from_hertz(self, grid: Grid, speed: float, limits: Limits) -> Outcome:
        """Start from Hertz's pressure at this speed or, failing that, at a faster one."""
        heights = self.case.shape_heights(grid)
        if speed and self.case.fluid_numbers(0.0)[0] > STIFF:
            return self._from_soft(grid, speed, heights, limits)
        for factor in (1.0, 4.0, 16.0, 64.0, 256.0):
            start = speed * factor
            outcome = self.solve(grid, self.case.problem(grid, start, heights, 1.0),
                                 self.case.hertz_state(grid, start), limits)
            if outcome.converged or outcome.out_of_time or speed == 0.0:
                break
        if not outcome.converged or factor == 1.0:
            return outcome
        return self.march(grid, outcome.state, self._slowing(grid, heights, start, speed, 0.0),
                          limits, 1 / math.log2(2 * factor))

    def _from_soft(self, grid: Grid, speed: float, heights: Array, limits: Limits) -> Outcome:
        """Start with a softer fluid and stiffen it."""
        def stiffening(t: float) -> Problem:
            return self.case.problem(grid, speed, heights, 1.0, 1.0 - t)

        outcome = self.solve(grid, stiffening(0.0), self.case.hertz_state(grid, speed), limits)
        return self.march(grid, outcome.state, stiffening, limits, 0.5) if (
            outcome.converged) else outcome

    def _slowing(self, grid: Grid, heights: Array, fast: float, slow: float,
                 amplitude: float, smooth_order: float = 1.0) -> Callable[[float], Problem]:
        """Return the path in the logarithm of speed."""
        settings = self.case.settings
        def problem(t: float) -> Problem:
            speed = slow if t == 1.0 else fast * (slow / fast) ** t
            order = self.case.order(grid, speed, amplitude) if amplitude else (
                settings.wedge_order or smooth_order)
            return self.case.problem(grid, speed, heights, order)

        return problem

    def rough(self) -> tuple[Grid, Outcome]:
        """Solve the rough contact from cold."""
        case, settings = self.case, self.case.settings
        speed = case.condition.entrainment_speed
        grid = case.grid(settings.nx, settings.ny, symmetric=False)
        rough = case.rough_heights(grid)
        inside = grid.x[:, None] ** 2 + (grid.y[None, :] / case.ellipticity) ** 2 < 1
        film = max(PARTING * float(rough[inside].std()), 2 * case.floor)
        start = max(speed, case.speed_of_film(film)) if speed else 0.0
        half, outcome = self.smooth(start, final=False)
        if not outcome.converged:
            return half, outcome
        limits, shape = self.limits(rough=True, final=True), case.shape_heights(grid)

        def growing(t: float) -> Problem:
            return case.problem(grid, start, shape - t * rough, case.order(grid, start, t))

        outcome = self.march(grid, transfer(outcome.state, half, grid), growing, limits, 0.5)
        if not outcome.converged or start == speed:
            return grid, outcome
        path = self._slowing(grid, shape - rough, start, speed, 1.0)
        return grid, self.march(grid, outcome.state, path, limits,
                                min(1.0, 0.5 / math.log(start / speed)))

    def warm(self, start: ContactSolution) -> tuple[Grid, Outcome] | None:
        """Solve from a neighbouring solution, in steps if need be; None if that fails."""
        case, settings = self.case, self.case.settings
        rough = case.roughness is not None
        grid = case.grid(settings.nx, settings.ny, symmetric=not rough)
        heights = case.shape_heights(grid)
        if rough:
            heights = heights - case.rough_heights(grid)
        speed = case.condition.entrainment_speed
        limits = self.limits(rough=rough, final=True)
        limits = replace(limits, newton=min(limits.newton, WARM_NEWTON))
        state, amplitude = state_from_solution(case, grid, start), float(rough)
        last = start.condition.entrainment_speed
        if not (speed and last):
            problem = case.problem(grid, speed, heights, case.order(grid, speed, amplitude))
            outcome = self.solve(grid, problem, state, limits)
        else:
            path = self._slowing(grid, heights, last, speed, amplitude, smooth_order=2.0)
            outcome = self.march(grid, state, path, limits)
        return (grid, outcome) if outcome.converged else None


def solve_contact(contact: Contact, lubricant: ContactLubricant, condition: Condition, *,
                  roughness: Roughness | None = None, settings: Settings = Settings(),
                  start: ContactSolution | None = None) -> ContactSolution:
    """
    Solve the contact of two bodies with the oil between them.

    `roughness` holds heights [m] on the solution grid, or is a function z(x, y) of places [m]; a `start`
    from a neighbouring condition saves the way from cold. Entrainment runs along x, which may be the short
    or the long axis. Raises InputError for inputs that no contact has; everything else is a status.

    """
    began = time.perf_counter()
    check_contact(contact)
    case = make_case(contact, lubricant, condition, settings, roughness)
    run = _Run(case=case, deadline=began + settings.time_cap)
    found = run.warm(start) if start is not None else None
    if found is None:
        found = (run.rough() if roughness is not None
                 else run.smooth(condition.entrainment_speed, final=True))
    grid, outcome = found
    status = _status(run, grid, outcome)
    return make_solution(
        case, grid, outcome, status, half=run.half, newton=run.newton,
        krylov=run.krylov, wall_time=time.perf_counter() - began)


def _status(run: _Run, grid: Grid, outcome: Outcome) -> Status:
    """Judge an outcome; contact of a smooth surface must not come from its grid."""
    case = run.case
    if outcome.out_of_time:
        return Status.OUT_OF_TIME
    smooth = case.roughness is None and not case.condition.entrainment_speed == 0.0
    if smooth and outcome.contact.any() and _is_coarse(run, grid, outcome):
        return Status.GRID_TOO_COARSE
    if not outcome.converged:
        return Status.CONTINUATION_FAILED if case.roughness is not None else Status.STALLED
    if _touches_edge(case, grid, outcome):
        return Status.DOMAIN_TOO_SMALL
    return Status.CONVERGED


def _is_coarse(run: _Run, grid: Grid, outcome: Outcome) -> bool:
    """Tell whether smooth contact comes from the wedge: order 1 has none, or the inlet is missed."""
    case, speed = run.case, run.case.condition.entrainment_speed
    if grid.dx > case.inlet_length(speed) or not outcome.converged:
        return True
    problem = case.problem(grid, speed, case.shape_heights(grid), 1.0)
    first = run.solve(grid, problem, outcome.state, run.limits(rough=False, final=False))
    return not (first.converged and bool(first.contact.any()))


def _touches_edge(case: Case, grid: Grid, outcome: Outcome) -> bool:
    """Tell whether the last rows of nodes inside the outlet and the sides carry part of the load."""
    pressure = outcome.state.film_pressure + outcome.state.asperity_pressure
    edge = np.zeros(grid.shape)
    edge[-2], edge[:, -2] = pressure[-2], pressure[:, -2]
    if not grid.symmetric:
        edge[:, 1] = pressure[:, 1]
    return grid.integral(edge) > EDGE_SHARE * case.load
