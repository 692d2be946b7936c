# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
One step in time after the other: in each the raceway and the oil on it move on by whole nodes.

A step is a Newton solve of the project's discrete system with the material derivative of
`kernels.moving` in place of the wedge, and it balances the load. It starts from the last one,
whose ripples over the smooth contact move on with the raceway.

"""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from surrogate.ehl.case import ScaledCase
from surrogate.ehl.grid import Grid, GridState
from surrogate.ehl.newton import NewtonLimits, NewtonResult, solve_grid
from surrogate.ehl.system import carried_on, Columns, evaluate, film_planes, GridProblem

Array = NDArray[np.float64]
TIGHT = 0.01
"""What linear solves leave of their residual where a step is tried again [-]."""
PATIENT, HALVINGS = 40, 4
"""Most Newton iterations of a step that is tried again, and halvings of each [-]."""


def step_limits(flux: float, load: float, gap: float) -> NewtonLimits:
    """Return the tolerances of a step [-] with the caps of a rough contact."""
    return NewtonLimits(
        flux=flux,
        load=load,
        gap=gap,
        krylov=0.05,
        stalled=TIGHT,
        newton=25,
        step=10.0,
        viscous=12.0,
        rise=1.0,
    )


@dataclass(frozen=True, kw_only=True, slots=True)
class Step:
    """
    Outcome of a step, its speed [m/s] and equations, and what all tries took.

    `stored` is the work that load and elastic bodies took up on the way, over its length [-].

    """

    speed: float
    stored: float
    problem: GridProblem
    outcome: NewtonResult
    newton: int
    krylov: int


class Stepper:
    """
    A contact on its grid, from a `smooth` state on, in Hertz units.

    Between steps the last state and the mass of the columns are kept [-].

    """

    def __init__(
        self,
        *,
        case: ScaledCase,
        grid: Grid,
        smooth: GridState,
        limits: NewtonLimits,
        stride: int = 1,
        moving: bool = True,
        shear: float = 0.0,
    ) -> None:
        """
        Take the steady smooth contact as what was before the first step.

        The raceway moves unless `moving` is False; `stride` nodes are one step; `shear` as in
        `Columns` [-].

        """
        self.case, self.grid, self.smooth, self.limits = case, grid, smooth, limits
        self.stride, self.moving, self.shear = stride, moving, shear
        self.speed = case.condition.entrainment_speed  # [m/s]
        self._state, self._approach_before = self.smooth, self.smooth.approach
        self._ripples_over = self.smooth
        problem = self._problem(np.zeros(self.grid.shape))
        pressure = self.smooth.film_pressure
        now = evaluate(self.grid, problem, self.smooth)
        self._energy = self._energy_of(problem, self.smooth, now.gap)
        film = film_planes(problem, pressure, now.gap, now.contact)
        mass = film[0] * film[2]
        steady = Columns(mass=arrived(mass, 1), carried=mass, stride=1)
        problem = replace(problem, columns=steady)
        self._mass, self._carried = carried_on(self.grid, problem, pressure, now.gap, now.contact)

    def follow(self, speed: float, smooth: GridState) -> None:
        """Go on at an entrainment speed [m/s] near the last one, and its smooth contact."""
        self.speed = speed
        self._ripples_over, self.smooth = self.smooth, smooth

    def step(self, rough: Array) -> Step:
        """Solve one step on, with the heights `rough` that are on the grid then."""
        columns = Columns(
            mass=arrived(self._mass, self.stride),
            carried=arrived(self._carried, self.stride),
            stride=self.stride,
            shear=self.shear,
        )
        problem = replace(self._problem(rough), columns=columns)
        step = self._solve(problem)
        state, before = step.outcome.state, self._energy
        self._energy = self._energy_of(problem, state, step.outcome.gap)
        length = self.stride * self.grid.dx
        step = replace(step, stored=(self._energy - before) / length)
        self._approach_before, self._state = self._state.approach, state
        self._mass, self._carried = carried_on(
            self.grid, problem, state.film_pressure, step.outcome.gap, step.outcome.contact
        )
        return step

    def _energy_of(self, problem: GridProblem, state: GridState, gap: Array) -> float:
        """Return half the integral of pressure times deflection, and load times approach [-]."""
        deflection = gap - problem.heights - state.approach
        pressure = state.film_pressure + state.asperity_pressure
        elastic = 0.5 * self.grid.integral(pressure * deflection)
        return elastic + problem.load * state.approach

    def _problem(self, rough: Array) -> GridProblem:
        case, grid = self.case, self.grid
        heights = case.shape_heights(grid) - rough
        return case.problem(grid, self.speed, heights, case.order)

    def _solve(self, problem: GridProblem) -> Step:
        """
        Solve from the predicted state; failing that more carefully, or from another one.

        Where nothing converges the next step goes on from what came nearest.

        """
        predicted = state = self._state
        if self.moving:  # its ripples move on
            smooth, before = self.smooth, self._ripples_over
            film = state.film_pressure - before.film_pressure
            asperity = state.asperity_pressure - before.asperity_pressure
            predicted = GridState(
                film_pressure=_moved_on(film, smooth.film_pressure, self.stride),
                asperity_pressure=_moved_on(asperity, smooth.asperity_pressure, self.stride),
                approach=2 * state.approach - self._approach_before,
            )
        tries = [solve_grid(self.grid, problem, predicted, self.limits)]
        careful = replace(self.limits, krylov=TIGHT, newton=PATIENT, halvings=HALVINGS)
        for start in (predicted, state, self.smooth):
            if not tries[-1].converged:
                tries.append(solve_grid(self.grid, problem, start, careful))
        return Step(
            speed=self.speed,
            stored=0.0,
            problem=problem,
            outcome=min(tries, key=lambda result: (not result.converged, result.flux_error)),
            newton=sum(result.newton for result in tries),
            krylov=sum(result.krylov for result in tries),
        )


def arrived(before: Array, stride: int) -> Array:
    """
    Return a field of material columns where they are after `stride` nodes.

    Those that come from outside the grid continue the first two rows.

    """
    now = np.empty_like(before)
    now[stride:] = before[:-stride]
    outside = np.arange(-stride, 0)[:, None]
    now[:stride] = before[0] + outside * (before[1] - before[0])
    return now


def _moved_on(ripples: Array, smooth: Array, stride: int) -> Array:
    """Return a smooth field with ripples on it that have moved on by `stride` nodes [-]."""
    now = smooth.copy()
    now[stride:] += ripples[:-stride]
    now[0] = now[-1] = 0.0
    return np.maximum(now, 0.0)
