# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Conversion of a grid solution from Hertz units to SI, and back for a warm start."""

from dataclasses import dataclass
import math
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray
from surrogate.ehl.case import ScaledCase
from surrogate.ehl.grid import Grid, GridState, transfer
from surrogate.ehl.interface import ContactSolution, Status
from surrogate.ehl.newton import NewtonResult

Array = NDArray[np.float64]
Kind = TypeVar('Kind', bound=np.generic)
THICK, CUT_OFF = (1.0, 5.0, 40.0), (0.0, 0.15, 0.3)
"""Films over a^2/Rx, and what the domain cuts off them [-]: bodies that hardly deform."""
PUNCTURED = 1.001
"""Film over the floor below which a node counts as punctured [-]."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Half:
    """What the half grid found: films in Hertz units and RCS [-], NaN where it was not solved."""

    central_film: float = math.nan
    minimum_film: float = math.nan
    rcs: float = math.nan


def central_film(grid: Grid, gap: Array) -> float:
    """Return the film at x = 0, y = 0 by a parabola through three nodes along x, within them."""
    i, j = int(np.argmin(np.abs(grid.x))), int(np.argmin(np.abs(grid.y)))
    s = -grid.x[i] / grid.dx
    west, here, east = gap[[i - 1, i, i + 1], j]
    film = here + 0.5 * s * (east - west) + 0.5 * s * s * (east - 2 * here + west)
    return float(np.clip(film, min(west, here, east), max(west, here, east)))


def punctured_nodes(solution: ContactSolution) -> NDArray[np.bool_]:
    """Return the nodes whose film is at the floor: there asperities touch."""
    return solution.film <= PUNCTURED * solution.settings.film_floor


def make_solution(
    case: ScaledCase,
    grid: Grid,
    outcome: NewtonResult,
    status: Status,
    *,
    half: Half,
    newton: int,
    krylov: int,
    wall_time: float,
) -> ContactSolution:
    """Return the result of a solve in SI units on the full width; wall time [s]."""
    state, height = outcome.state, case.height_unit
    pressure = case.hertz_pressure
    numbers = _numbers(case, grid, outcome, half)
    if status is not Status.CONVERGED:
        numbers = dict.fromkeys(numbers, math.nan)
    y = np.concatenate([-grid.y[:1:-1], grid.y[1:]]) if grid.symmetric else grid.y
    return ContactSolution(
        contact=case.contact,
        lubricant=case.lubricant,
        condition=case.condition,
        settings=case.settings,
        status=status,
        film_pressure=_full(grid, state.film_pressure) * pressure,
        asperity_pressure=_full(grid, state.asperity_pressure) * pressure,
        film=_full(grid, outcome.gap) * height,
        x=grid.x * case.semi_axis_x,
        y=y * case.semi_axis_x,
        contact_mask=_full(grid, outcome.contact),
        cavitation_mask=_full(grid, outcome.cavitated),
        hertz_pressure=pressure,
        semi_axis_x=case.semi_axis_x,
        semi_axis_y=case.semi_axis_y,
        approach=-state.approach * height,
        load_error=outcome.load_error,
        residual=outcome.flux_error,
        gap_error=outcome.gap_error,
        rolling_tail=_rolling_tail(case),
        newton_iterations=newton,
        krylov_iterations=krylov,
        wall_time=wall_time,
        **numbers,
    )


def _numbers(case: ScaledCase, grid: Grid, outcome: NewtonResult, half: Half) -> dict[str, float]:
    """Return what is known of a converged contact only, in SI units."""
    height, pressure, state = case.height_unit, case.hertz_pressure, outcome.state
    own = film_and_share(case, grid, outcome)
    extrapolated, error = _two_grid(own.central_film, half.central_film)
    cut_off = float(np.interp(own.central_film, THICK, CUT_OFF))
    error = float(np.fmax(error, cut_off)) if cut_off else error
    force = _rolling(grid, outcome.gap, state.film_pressure, case.inlet(grid))
    return {
        'central_film': own.central_film * height,
        'minimum_film': own.minimum_film * height,
        'extrapolated_film': extrapolated * height,
        'extrapolated_minimum': _two_grid(own.minimum_film, half.minimum_film)[0] * height,
        'film_error': error,
        'max_pressure': float((state.film_pressure + state.asperity_pressure).max()) * pressure,
        'rcs': own.rcs,
        'rcs_error': abs(own.rcs - half.rcs),
        'asperity_share': grid.integral(state.asperity_pressure) / case.load,
        'rolling_force': force * pressure * height * case.semi_axis_x,
    }


def film_and_share(case: ScaledCase, grid: Grid, outcome: NewtonResult) -> Half:
    """Return the films [Hertz units] and the share of the load on punctured nodes [-]."""
    total = outcome.state.film_pressure + outcome.state.asperity_pressure
    punctured = outcome.gap <= PUNCTURED * case.floor
    return Half(
        central_film=central_film(grid, outcome.gap),
        minimum_film=float(outcome.gap.min()),
        rcs=grid.integral(np.where(punctured, total, 0.0)) / case.load,
    )


def _full(grid: Grid, field: NDArray[Kind]) -> NDArray[Kind]:
    if not grid.symmetric:
        return field.copy()
    return np.concatenate([field[:, :1:-1], field[:, 1:]], axis=1)


def _two_grid(film: float, half_film: float) -> tuple[float, float]:
    """Return the extrapolated film and the relative error of `film`, both for order 2."""
    step = (film - half_film) / 3
    return film + step, abs(step / film)


def _rolling(grid: Grid, gap: Array, pressure: Array, inlet: Array) -> float:
    """Return the integral of (h/2) dp/dx; before the first row p is that of the inlet."""
    rise = np.diff(pressure, axis=0)
    rise[0] -= inlet * pressure[1]
    return grid.integral(0.25 * (gap[1:] + gap[:-1]) * rise / grid.dx)


def _rolling_tail(case: ScaledCase) -> float:
    """
    Return the rolling force [N] between the meniscus and the inlet edge of the domain.

    Integral of 6 eta0 us / h over the width of the domain with the undeformed gap: in closed form
    along y, by quadrature along x.

    """
    contact, a = case.contact, case.semi_axis_x
    start, side = -case.domain[0] * a, case.domain[2] * a
    if case.settings.meniscus_length <= start or not case.condition.entrainment_speed:
        return 0.0
    nodes, weights = np.polynomial.legendre.leggauss(24)
    span = math.log(case.settings.meniscus_length / start)
    x = start * np.exp(span * (nodes + 1) / 2)
    depth = x**2 / (2 * contact.radius_x)
    root = np.sqrt(2 * contact.radius_y * depth)
    across = 2 * np.arctan(side / root) * root / depth
    integral = float((weights * across * x).sum()) * span / 2
    return 6 * case.lubricant.viscosity * case.condition.entrainment_speed * integral


def state_from_solution(case: ScaledCase, grid: Grid, start: ContactSolution) -> GridState:
    """Return the fields of another solution on `grid`; at rest asperities carry all pressure."""
    old = Grid(
        x=start.x / start.semi_axis_x,
        y=start.y / start.semi_axis_x,
        symmetric=False,
        compliance=grid.compliance,
    )
    height = start.semi_axis_x**2 / start.contact.radius_x
    state = GridState(
        film_pressure=start.film_pressure / start.hertz_pressure,
        asperity_pressure=start.asperity_pressure / start.hertz_pressure,
        approach=-start.approach / height,
    )
    state = transfer(state, old, grid)
    if case.condition.entrainment_speed:
        return state
    return GridState(
        film_pressure=np.zeros(grid.shape),
        approach=state.approach,
        asperity_pressure=state.film_pressure + state.asperity_pressure,
    )
