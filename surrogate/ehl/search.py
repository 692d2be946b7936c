# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Ways to a solution of one contact: from Hertz, from coarser grids, easier cases and neighbours.

Cold: a cascade of grids from Hertz's pressure, first-order wedge below the finest; if that fails,
from a faster speed downwards. Rough or nearly dry: the smooth film at a speed that parts the
surfaces, then the roughness grows, then the speed falls. Every path is cut in halves where a step
fails.

"""

from collections.abc import Callable
from dataclasses import replace
import math

import numpy as np
from surrogate.ehl.case import Array, COARSEST, ScaledCase, STIFF
from surrogate.ehl.grid import Grid, GridState, transfer
from surrogate.ehl.interface import ContactSolution
from surrogate.ehl.newton import NewtonLimits, NewtonResult, solve_grid
from surrogate.ehl.results import film_and_share, Half, state_from_solution
from surrogate.ehl.system import GridProblem

GridResult = tuple[Grid, NewtonResult]
FINEST_CUT = 1 / 64
"""Shortest step of a continuation path, as a share of it [-]."""
WARM_CUT = 1 / 4
"""Shortest step from a neighbouring solution of a rough contact, as a share of the path [-]."""
RIGID = 10.0
"""Film over that by which the Hertz zone flattens, a^2/Rx, of bodies that hardly deform [-]."""
SAME_LOAD = 0.02
"""Largest relative difference of loads at which a rough contact starts from another [-]."""
SAME_SPEED = 1.0
"""Largest difference of the logarithms of speeds at which a rough contact starts from another [-];
docs/theory/contact_solver.md."""
WARM_NEWTON, SMOOTH_NEWTON = 25, 12
"""Most Newton iterations of one step from a neighbouring solution, rough and smooth [-]."""
STALLED = 0.01
"""What linear solves of rough contacts leave of their residual at most where Newton stalls [-]."""
PARTING = 1.5
"""Smooth film over the roughness rms at which a rough path starts [-]."""


class Search:
    """The way to one solution, with the iterations that it took and what the half grid found."""

    def __init__(self, *, case: ScaledCase, deadline: float) -> None:
        self.case, self.deadline = case, deadline
        self.newton = self.krylov = 0
        self.half = Half()

    def limits(self, *, rough: bool, final: bool) -> NewtonLimits:
        """Return the tolerances of a smooth or rough solve, on the way or at the end."""
        settings, stiff = self.case.settings, self.case.fluid_numbers(0.0)[0] > STIFF
        steps = (10.0, 12.0, 1.0) if rough else (0.5, 3.0 if stiff else 6.0, 0.3)
        return NewtonLimits(
            flux=settings.flux_tolerance if final else max(1e-2, settings.flux_tolerance),
            load=settings.load_tolerance,
            gap=settings.gap_tolerance,
            krylov=settings.krylov_tolerance if rough else 0.01 if stiff else 0.05,
            stalled=STALLED if rough else math.inf,
            newton=settings.newton_limit,
            step=steps[0],
            viscous=steps[1],
            rise=steps[2],
            deadline=self.deadline,
        )

    def solve(
        self, grid: Grid, problem: GridProblem, state: GridState, limits: NewtonLimits
    ) -> NewtonResult:
        """Solve on one grid and count."""
        outcome = solve_grid(grid, problem, state, limits)
        self.newton += outcome.newton
        self.krylov += outcome.krylov
        return outcome

    def march(
        self,
        grid: Grid,
        state: GridState,
        path: Callable[[float], GridProblem],
        limits: NewtonLimits,
        first: float = 1.0,
        finest: float = FINEST_CUT,
    ) -> NewtonResult:
        """Follow `path` from 0, where `state` holds, to 1, in steps that are halved on failure."""
        place, step = 0.0, first
        loose = replace(
            limits,
            flux=max(1e-2, limits.flux),
            gap=max(1e-2, limits.gap),
            newton=min(limits.newton, WARM_NEWTON),
        )
        while True:
            target = 1.0 if place + step > 1 - 1e-9 else place + step
            outcome = self.solve(grid, path(target), state, limits if target == 1.0 else loose)
            if outcome.converged:
                place, state, step = target, outcome.state, min(2 * step, 1 - target)
                if place == 1.0:
                    return outcome
            else:
                step /= 2
                if step < finest or outcome.out_of_time:
                    return outcome

    def smooth(self, speed: float, *, final: bool) -> GridResult:
        """Solve the smooth contact at a speed [m/s] from cold through the cascade."""
        levels = self.case.levels()
        grid, outcome = self._cascade(speed, levels[:-1])
        fine = self.case.grid(*levels[-1], symmetric=True)
        heights = self.case.shape_heights(fine)
        limits = self.limits(rough=False, final=final)
        state = (
            transfer(outcome.state, grid, fine) if grid and outcome and outcome.converged else None
        )
        first = self.case.problem(fine, speed, heights, 1.0)
        if state is None:
            outcome = self.from_hertz(fine, speed, limits)
            if not outcome.converged:
                return fine, outcome
            state = outcome.state
        order = self.case.order
        outcome = self.solve(fine, replace(first, order=order), state, limits)
        if not outcome.converged and not outcome.out_of_time:
            easier = self.solve(fine, first, state, limits)
            if easier.converged:
                outcome = self.march(
                    fine,
                    easier.state,
                    lambda t: replace(first, order=1.0 + t * (order - 1.0)),
                    limits,
                    0.5,
                )
        return fine, outcome

    def _cascade(
        self, speed: float, levels: list[tuple[int, int]]
    ) -> tuple[Grid | None, NewtonResult | None]:
        """Solve the coarser grids at first order; the last also as the finest, for its film."""
        grid: Grid | None = None
        outcome: NewtonResult | None = None
        limits = self.limits(rough=False, final=False)
        for shape in levels:
            finer = self.case.grid(*shape, symmetric=True)
            problem = self.case.problem(finer, speed, self.case.shape_heights(finer), 1.0)
            if outcome is not None and outcome.converged and grid is not None:
                outcome = self.solve(finer, problem, transfer(outcome.state, grid, finer), limits)
            else:
                outcome = self.from_hertz(finer, speed, limits)
            grid = finer
        skips = not self.case.settings.error_estimate or self.case.touches
        if grid is None or outcome is None or not outcome.converged or skips:
            return grid, outcome
        limits = replace(self.limits(rough=False, final=True), flux=1e-3, newton=15)
        half = self.solve(grid, replace(problem, order=self.case.order), outcome.state, limits)
        if not half.converged or (half.contact.any() and not problem.dry):
            return grid, outcome
        self.half = film_and_share(self.case, grid, half)
        return grid, half

    def from_hertz(self, grid: Grid, speed: float, limits: NewtonLimits) -> NewtonResult:
        """Start from Hertz's pressure at this speed [m/s] or, failing that, at a faster one."""
        heights = self.case.shape_heights(grid)
        if speed and self.case.fluid_numbers(0.0)[0] > STIFF:  # the oil stiffens on the way

            def stiffening(t: float) -> GridProblem:
                return self.case.problem(grid, speed, heights, 1.0, 1.0 - t)

            outcome = self.solve(grid, stiffening(0.0), self.case.hertz_state(grid, speed), limits)
            if not outcome.converged:
                return outcome
            return self.march(grid, outcome.state, stiffening, limits, 0.5)
        for factor in (1.0, 4.0, 16.0, 64.0, 256.0):
            start = speed * factor
            outcome = self.solve(
                grid,
                self.case.problem(grid, start, heights, 1.0),
                self.case.hertz_state(grid, start),
                limits,
            )
            if outcome.converged or outcome.out_of_time or speed == 0.0:
                break
        if not outcome.converged or factor == 1.0:
            return outcome
        return self.march(
            grid,
            outcome.state,
            self._slowing(grid, heights, start, speed, 1.0),
            limits,
            1 / math.log2(2 * factor),
        )

    def _slowing(
        self, grid: Grid, heights: Array, fast: float, slow: float, order: float | None = None
    ) -> Callable[[float], GridProblem]:
        """Return the path in the logarithm of speed, at an order or at that of the finest grid."""

        def problem(t: float) -> GridProblem:
            speed = slow if t == 1.0 else fast * (slow / fast) ** t
            return self.case.problem(grid, speed, heights, order or self.case.order)

        return problem

    def rough(self) -> GridResult:
        """
        Solve a rough contact from cold: all the way on the half grid, then on the finest.

        Four times fewer nodes on the way; where that fails, the whole way on the finest grid.

        """
        case, shape = self.case, self._half_shape()
        if min(shape) < COARSEST or not case.has_heights_on(shape):
            return self.thin()
        nx, ny = shape
        other = Search(
            case=replace(case, settings=replace(case.settings, nx=nx, ny=ny)),
            deadline=self.deadline,
        )
        coarse, half = other.thin()
        self.newton, self.krylov = self.newton + other.newton, self.krylov + other.krylov
        if not half.converged:
            return self.thin()
        grid = case.grid(case.settings.nx, case.settings.ny, symmetric=False)
        heights = case.shape_heights(grid) - case.rough_heights(grid)
        problem = case.problem(grid, case.condition.entrainment_speed, heights, case.order)
        state = transfer(half.state, coarse, grid)
        outcome = self.solve(grid, problem, state, self.limits(rough=True, final=True))
        if not outcome.converged:
            return self.thin()
        if case.settings.error_estimate:
            self.half = film_and_share(case, coarse, half)
        return grid, outcome

    def _half_shape(self) -> tuple[int, int]:
        return self.case.settings.nx // 4 * 2 + 1, self.case.settings.ny // 4 * 2 + 1

    def thin(self) -> GridResult:
        """
        Solve a rough contact, or a smooth one whose film is near the floor, from cold.

        The smooth film at a speed that parts the surfaces comes first, then the roughness grows to
        its height, then the speed falls; if that fails, the dry contact is wetted.

        """
        case, settings = self.case, self.case.settings
        speed, smooth = case.condition.entrainment_speed, case.roughness is None
        grid = case.grid(settings.nx, settings.ny, symmetric=smooth)
        rough = np.zeros(grid.shape) if smooth else case.rough_heights(grid)
        inside = grid.x[:, None] ** 2 + (grid.y[None, :] / case.ellipticity) ** 2 < 1
        height = float(rough[inside].std()) if inside.any() else 0.0
        parting = max(PARTING * height, 2 * case.floor)
        start = max(speed, case.speed_of_film(parting)) if speed else 0.0
        half, outcome = self.smooth(start, final=smooth and start == speed)
        if not outcome.converged:
            return half, outcome
        limits, shape = self.limits(rough=True, final=True), case.shape_heights(grid)
        state = transfer(outcome.state, half, grid)
        if not smooth:
            outcome = self.march(
                grid,
                state,
                lambda t: case.problem(grid, start, shape - t * rough, case.order),
                limits,
                0.5,
            )
        if not outcome.converged or start == speed:
            return grid, outcome
        path = self._slowing(grid, shape - rough, start, speed)
        outcome = self.march(
            grid, outcome.state, path, limits, min(1.0, 0.5 / math.log(start / speed))
        )
        if outcome.converged or outcome.out_of_time:
            return grid, outcome
        dry = self.march(
            grid,
            case.hertz_state(grid, 0.0),
            lambda t: case.problem(grid, 0.0, shape - t * rough, 2.0),
            limits,
            0.5,
        )
        wet = self.solve(grid, path(1.0), dry.state, limits) if dry.converged else outcome
        return grid, wet if wet.converged else outcome

    def warm(self, start: ContactSolution) -> GridResult | None:
        """
        Solve from a neighbouring solution; None if that fails.

        The ripples of a rough contact do not stretch with the load: it starts from none of another
        load, and in steps if need be. A smooth one is tried once in few iterations: from cold it
        takes no more. Bodies that hardly deform are solved from cold alone.

        """
        case, settings = self.case, self.case.settings
        rough = case.roughness is not None
        flattened = start.semi_axis_x**2 / start.contact.radius_x
        is_rigid = start.central_film > RIGID * flattened
        if rough and not self._is_near(start) or is_rigid:
            return None
        grid = case.grid(settings.nx, settings.ny, symmetric=not rough)
        heights = case.shape_heights(grid)
        if rough:
            heights = heights - case.rough_heights(grid)
        speed, last = case.condition.entrainment_speed, start.condition.entrainment_speed
        limits = self.limits(rough=case.touches, final=True)
        most = WARM_NEWTON if rough else SMOOTH_NEWTON
        limits = replace(limits, newton=min(limits.newton, most))
        state = state_from_solution(case, grid, start)
        if speed and last:
            path = self._slowing(grid, heights, last, speed)
            outcome = self.march(grid, state, path, limits, finest=WARM_CUT if rough else 1.0)
        else:
            problem = case.problem(grid, speed, heights, case.order)
            outcome = self.solve(grid, problem, state, limits)
        return (grid, outcome) if outcome.converged else None

    def _is_near(self, start: ContactSolution) -> bool:
        """Return True if load and speed of a rough solution are near enough to start from it."""
        here, there = self.case.condition, start.condition
        if abs(there.load / here.load - 1) > SAME_LOAD:
            return False
        moving = here.entrainment_speed > 0 and there.entrainment_speed > 0
        if not moving:
            return True
        return abs(math.log(there.entrainment_speed / here.entrainment_speed)) <= SAME_SPEED

    def estimate(self, grid: Grid, outcome: NewtonResult) -> None:
        """Solve the half grid from the solution, unless it was solved on the way."""
        case, shape = self.case, self._half_shape()
        speed = case.condition.entrainment_speed
        known = math.isfinite(self.half.central_film) or grid.x.size != case.settings.nx
        if known or not case.settings.error_estimate or not case.has_heights_on(shape):
            return
        coarser = case.grid(*shape, symmetric=case.roughness is None)
        heights = case.shape_heights(coarser)
        if case.roughness is not None:
            heights = heights - case.rough_heights(coarser)
        limits = replace(self.limits(rough=case.touches, final=True), newton=WARM_NEWTON)
        problem = case.problem(coarser, speed, heights, case.order)
        half = self.solve(coarser, problem, transfer(outcome.state, grid, coarser), limits)
        if half.converged:
            self.half = film_and_share(case, coarser, half)

    def refuse(self) -> GridResult:
        """Return Hertz's state on the finest grid without any iteration."""
        case, settings = self.case, self.case.settings
        grid = case.grid(settings.nx, settings.ny, symmetric=True)
        speed = case.condition.entrainment_speed
        problem = case.problem(grid, speed, case.shape_heights(grid), 1.0)
        limits = replace(self.limits(rough=False, final=True), newton=0)
        return grid, self.solve(grid, problem, case.hertz_state(grid, speed), limits)
