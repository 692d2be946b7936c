# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Semismooth Newton on one grid: film, cavitated and contact nodes in one system."""

from dataclasses import dataclass, replace
import math
import time

import numpy as np
from surrogate.ehl.grid import Grid, GridState, KRYLOV_LIMIT
from surrogate.ehl.kernels.reynolds import fluid_at
from surrogate.ehl.linear import solve_linear
from surrogate.ehl.system import Array, evaluate, Evaluation, GridProblem, Mask
from surrogate.ehl.watch import tell
from surrogate.formulas.lubricant import ROELANDS_PRESSURE

HOPELESS = 5
"""Linear solves cut at their limit after which an iteration is given up [-]."""
FALLING = 0.5
"""Flux error over that of the step before from which on Newton counts as stalled [-]."""
LEAST_FALL = 0.1
"""Fall of the flux error over the length of a step below which the step is halved [-]."""
OVERSHOOT = 2.0
"""Largest fall of the film pressure over that which is exact for exponential viscosity [-]."""


@dataclass(frozen=True, kw_only=True, slots=True)
class NewtonLimits:
    """
    Tolerances [-] and caps of one Newton solve.

    A step may change the pressure of a film node by `step` and the logarithm of the viscosity at
    the Hertz pressure by `viscous`, and may raise the film pressure of a contact node by `rise`.
    A step that lowers the flux error by less than `LEAST_FALL` of its length is halved, `halvings`
    times at most. Linear solves leave `krylov` of their residual, after a stalled step `stalled`
    if that is less.

    """

    flux: float = 1e-4
    load: float = 1e-6
    gap: float = 1e-4
    krylov: float = 0.02
    stalled: float = math.inf
    newton: int = 40
    step: float = 0.5
    viscous: float = 6.0
    rise: float = 0.3
    halvings: int = 0
    deadline: float = math.inf


@dataclass(frozen=True, kw_only=True, slots=True)
class NewtonResult:
    """Last state of a Newton solve, its fields, errors and counts."""

    state: GridState
    gap: Array
    contact: Mask
    cavitated: Mask
    converged: bool
    out_of_time: bool
    flux_error: float
    load_error: float
    gap_error: float
    newton: int
    krylov: int


def solve_grid(
    grid: Grid, problem: GridProblem, start: GridState, limits: NewtonLimits
) -> NewtonResult:
    """Iterate from `start` until all three errors are small, or say what is left."""
    state, krylov, count, hopeless, last = start, 0, 0, 0, math.inf
    while True:
        now = evaluate(grid, problem, state)
        tell(count, now.flux_error)
        converged = bool(
            now.flux_error < limits.flux
            and now.gap_error < limits.gap
            and abs(now.load_rest) < limits.load * problem.load
        )
        late = time.perf_counter() > limits.deadline
        finite = math.isfinite(now.flux_error) and math.isfinite(now.load_rest)
        if converged or late or not finite or count >= limits.newton or hopeless >= HOPELESS:
            break
        # Loose linear solves alone lose thick films of cold oil.
        stalls = now.flux_error >= FALLING * last
        tolerance = min(limits.krylov, limits.stalled) if stalls else limits.krylov
        new, used = _step(grid, problem, state, now, replace(limits, krylov=tolerance))
        state = _shortened(grid, problem, state, new, now.flux_error, limits.halvings)
        last = now.flux_error
        krylov += used
        count += 1
        hopeless += used == KRYLOV_LIMIT
    return NewtonResult(
        state=state,
        gap=now.gap,
        contact=now.contact,
        cavitated=now.cavitated,
        converged=converged,
        out_of_time=late and not converged,
        flux_error=now.flux_error,
        load_error=now.load_rest / problem.load,
        gap_error=now.gap_error,
        newton=count,
        krylov=krylov,
    )


def _shortened(
    grid: Grid, problem: GridProblem, old: GridState, new: GridState, flux: float, halvings: int
) -> GridState:
    """Return the new state, or one between whose flux error falls below that of the old one."""
    share = 1.0
    for _ in range(halvings):
        if evaluate(grid, problem, new).flux_error < (1 - LEAST_FALL * share) * flux:
            break
        share /= 2
        new = GridState(
            film_pressure=0.5 * (old.film_pressure + new.film_pressure),
            asperity_pressure=0.5 * (old.asperity_pressure + new.asperity_pressure),
            approach=0.5 * (old.approach + new.approach),
        )
    return new


def _step(
    grid: Grid, problem: GridProblem, state: GridState, now: Evaluation, limits: NewtonLimits
) -> tuple[GridState, int]:
    film_change, total_change, approach, used = solve_linear(
        grid, problem, state, now, limits.krylov
    )
    contact = now.contact
    free = np.abs(np.where(contact, 0.0, film_change)).max()
    if problem.dry:
        film_change = -state.film_pressure
    asperity_change = total_change - film_change
    if contact.any():
        limited = limit_on_contact(
            problem, state.film_pressure[contact], film_change[contact], limits.rise
        )
        asperity_change[contact] += film_change[contact] - limited
        film_change[contact] = limited
    # Slope of ln(viscosity) at the Hertz pressure.
    slope = fluid_at(1.0, problem.pressure_scale, problem.growth, problem.exponent, 0.0)[1]
    stiffening = max(float(slope), 1e-30)
    share = min(1.0, min(limits.step, limits.viscous / stiffening) / max(free, 1e-30))
    asperity_pressure = state.asperity_pressure + share * asperity_change
    if share == 1.0:
        asperity_pressure[~contact] = 0.0
    return GridState(
        film_pressure=np.maximum(state.film_pressure + share * film_change, 0.0),
        asperity_pressure=asperity_pressure,
        approach=state.approach + share * approach,
    ), used


def limit_on_contact(problem: GridProblem, pressure: Array, change: Array, rise: float) -> Array:
    """
    Limit the `change` of film `pressure` [-] where the viscosity law would throw it about.

    As for the diode in circuit simulation: a large fall is followed in the logarithm of the
    viscosity, `OVERSHOOT` times as far, and a rise is capped; the asperity pressure takes the
    rest, so that elasticity is untouched.

    """
    base = 1.0 + pressure * problem.pressure_scale / ROELANDS_PRESSURE
    slope = (
        problem.growth
        * problem.exponent
        * base ** (problem.exponent - 1.0)
        * problem.pressure_scale
        / ROELANDS_PRESSURE
    )
    fall = np.maximum(change, -OVERSHOOT * np.log1p(slope * np.abs(change)) / slope)
    return np.maximum(np.where(change < 0, fall, np.minimum(change, rise)), -pressure)
