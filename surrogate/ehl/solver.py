# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Solve one lubricated, mixed or dry contact and judge what was found."""

from dataclasses import replace
from functools import lru_cache
import math
import time

import numpy as np
from surrogate.ehl.case import make_case, UNRESOLVED
from surrogate.ehl.grid import Grid, transfer
from surrogate.ehl.interface import (
    check_contact,
    Condition,
    ContactLubricant,
    ContactSolution,
    LARGEST_GRID,
    RoughHeights,
    Settings,
    Status,
)
from surrogate.ehl.newton import NewtonResult
from surrogate.ehl.results import film_and_share, make_solution
from surrogate.ehl.search import GridResult, Search
from surrogate.ehl.watch import at
from surrogate.formulas.geometry import Contact

PRODUCTION = Settings()
REFINEMENTS = 2
"""Grids, each twice as fine, that contact of a smooth surface must outlive [-]."""
EDGE_SHARE = 2e-3
"""Share of the load on the last rows inside outlet and sides that a domain may have [-]."""


def solve_contact(
    contact: Contact,
    lubricant: ContactLubricant,
    condition: Condition,
    *,
    roughness: RoughHeights | None = None,
    settings: Settings = PRODUCTION,
    start: ContactSolution | None = None,
) -> ContactSolution:
    """
    Solve the contact of two bodies with the oil between them.

    `roughness` holds heights [m] on the solution grid, or is a function z(x, y) of places [m]; a
    `start` from a neighbouring condition saves the way from cold. Entrainment runs along x, which
    may be the short or the long axis. Raises InputError for inputs that no contact has; everything
    else is a status.

    """
    check_contact(contact)
    prepare()
    began = time.perf_counter()
    case = make_case(contact, lubricant, condition, settings, roughness)
    search = Search(case=case, deadline=began + settings.time_cap)
    with at(stage='smooth contact' if roughness is None else 'rough contact'):
        grid, outcome, confirmed = _confirm(search, *_find(search, start))
    status = _status(search, grid, outcome) if confirmed else Status.GRID_TOO_COARSE
    if status is Status.CONVERGED:
        search.estimate(grid, outcome)
    return make_solution(
        case,
        grid,
        outcome,
        status,
        half=search.half,
        newton=search.newton,
        krylov=search.krylov,
        wall_time=time.perf_counter() - began,
    )


@lru_cache(maxsize=1)
def prepare() -> None:
    """Compile the solver, or load it from the disk: once per process, outside every time cap."""
    contact = Contact(radius_x=0.01, radius_y=0.01, reduced_modulus=2e11)
    oil = ContactLubricant(viscosity=0.05, pressure_viscosity=2e-8)
    condition = Condition(load=20.0, entrainment_speed=1.0)
    settings = Settings(nx=17, ny=17, newton_limit=2)
    for roughness in (None, lambda x, y: 0.0 * x * y):
        search = Search(
            case=make_case(contact, oil, condition, settings, roughness), deadline=math.inf
        )
        grid = search.case.grid(17, 17, symmetric=roughness is None)
        problem = search.case.problem(grid, 1.0, search.case.shape_heights(grid), 2.0)
        with at(stage='loading'):
            search.solve(
                grid,
                problem,
                search.case.hertz_state(grid, 1.0),
                search.limits(rough=True, final=True),
            )


def _find(search: Search, start: ContactSolution | None) -> GridResult:
    """Choose the way: refuse, warm, thin or smooth."""
    case, speed = search.case, search.case.condition.entrainment_speed
    if not case.touches and speed and case.coarseness(case.settings, speed) > UNRESOLVED:
        return search.refuse()
    warm = search.warm(start) if start is not None else None
    if warm is not None:
        return warm
    if case.roughness is not None:
        return search.rough()
    return search.thin() if case.touches and speed else search.smooth(speed, final=True)


def _status(search: Search, grid: Grid, outcome: NewtonResult) -> Status:
    case = search.case
    if outcome.out_of_time:
        return Status.OUT_OF_TIME
    smooth = case.roughness is None and case.condition.entrainment_speed > 0
    refused = not outcome.converged and outcome.newton == 0
    if smooth and (refused or not outcome.converged and outcome.contact.any()):
        return Status.GRID_TOO_COARSE
    if not outcome.converged:
        return Status.CONTINUATION_FAILED if case.roughness is not None else Status.STALLED
    # Only border nodes can lie below; rows before outlet and sides carry no part of the load.
    below = outcome.gap.min() < (1 - 2 * case.settings.gap_tolerance) * case.floor
    pressure = outcome.state.film_pressure + outcome.state.asperity_pressure
    edge = np.zeros(grid.shape)
    edge[-2], edge[:, -2] = pressure[-2], pressure[:, -2]
    if not grid.symmetric:
        edge[:, 1] = pressure[:, 1]
    at_edge = grid.integral(edge) > EDGE_SHARE * case.load
    return Status.DOMAIN_TOO_SMALL if below or at_edge else Status.CONVERGED


def _confirm(search: Search, grid: Grid, outcome: NewtonResult) -> tuple[Grid, NewtonResult, bool]:
    """
    Solve a smooth contact that touches on finer grids, until it does not or is confirmed.

    Second-order films of a coarse grid dip to the floor where a finer one has none. Returns grid,
    outcome and whether the contact, if any, was there on both finer grids.

    """
    case, settings = search.case, search.case.settings
    speed = case.condition.entrainment_speed
    if case.roughness is not None or not speed or case.touches or outcome.out_of_time:
        return grid, outcome, True
    for _ in range(REFINEMENTS if settings.refine else 0):
        nx, ny = 2 * settings.nx - 1, 2 * settings.ny - 1
        refused = outcome.newton == 0 and not outcome.converged
        if not (refused or outcome.contact.any()):
            return grid, outcome, True
        if max(nx, ny) > LARGEST_GRID:
            return grid, outcome, False
        settings = replace(settings, nx=nx, ny=ny)
        fine = replace(case, settings=settings)
        refined = None
        if outcome.converged:
            finer = fine.grid(nx, ny, symmetric=True)
            problem = fine.problem(finer, speed, fine.shape_heights(finer), fine.order)
            coarse = transfer(outcome.state, grid, finer)
            refined = search.solve(finer, problem, coarse, search.limits(rough=False, final=True))
            search.half = film_and_share(fine, grid, outcome)
        if refined is None or not refined.converged:  # from cold
            other = Search(case=fine, deadline=search.deadline)
            finer, refined = other.smooth(speed, final=True)
            search.half = other.half
            search.newton += other.newton
            search.krylov += other.krylov
        if not refined.converged:
            return grid, outcome, False
        grid, outcome = finer, refined
    return grid, outcome, settings.refine or not outcome.contact.any()
