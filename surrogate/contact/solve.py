# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Solution of a contact case: the rough surface, the grid, the solve.

The surface never follows the grid; a grid that the case does not state follows the surface, or the
estimated error of a smooth film.

"""

from dataclasses import replace
import logging

from surrogate.contact.case import ContactCase
from surrogate.contact.surface import case_surface
from surrogate.ehl import ContactSolution, Settings, solve_contact
from surrogate.ehl.case import make_case
from surrogate.ehl.domain import nodes_on_waves
from surrogate.formulas.geometry import ellipticity
from surrogate.raceway.fractal import FractalSurface
from surrogate.raceway.patch import Raceway
from surrogate.raceway.short_waves import subgrid_floor, without_short_waves

SLENDER, WIDE_NY = 2.5, 257
"""Nodes across a contact with an axis ratio below that [-]: its least film lies at its sides."""
FILM_ERROR, FINE_NX = 0.005, 513
"""Estimated error of the film above which a smooth case is refined, and nodes along x then [-]."""
ROUGH_NX = 129
"""Fewest nodes along x of a rough grid that the case does not state [-]."""
LOG = logging.getLogger(__name__)


def solve_case(case: ContactCase) -> tuple[ContactSolution, Raceway | None]:
    """
    Solve a case; return the solution and the rough surface on the grid, None if smooth.

    Waves shorter than the case wants on its grid raise the film floor of the solution instead.

    A smooth case without a stated grid is solved again on a finer one when its estimated error is
    larger than `FILM_ERROR`. Raises InputError for inputs that no contact has; anything else is a
    status of the solution.

    """
    surface = case_surface(case)
    surface, raised = _on_grid(case, surface)
    settings = case_settings(replace(case, film_floor=case.film_floor + raised), surface)
    solution = _solve(case, surface, settings)
    if surface is None and case.grid is None and solution.film_error > FILM_ERROR:
        fine = replace(settings, nx=FINE_NX, ny=2 * settings.ny - 1)
        finer = _solve(case, surface, fine)
        if finer.converged:
            counts = ('newton_iterations', 'krylov_iterations', 'wall_time')
            both = {name: getattr(solution, name) + getattr(finer, name) for name in counts}
            return replace(finer, **both), None
    return solution, surface


def _on_grid(case: ContactCase, surface: Raceway | None) -> tuple[Raceway | None, float]:
    """Return the surface less the waves that do not go on the grid, and their floor [m]."""
    shortest = case.roughness.grid_wavelength if case.roughness else None
    if shortest is None or not isinstance(surface, FractalSurface):
        return surface, 0.0
    raised = subgrid_floor(surface, shortest)
    LOG.info('waves below %.3g um raise the film floor by %.3g nm', 1e6 * shortest, 1e9 * raised)
    return without_short_waves(surface, shortest), raised


def _solve(case: ContactCase, surface: Raceway | None, settings: Settings) -> ContactSolution:
    return solve_contact(
        case.contact,
        case.lubricant,
        case.condition,
        roughness=surface.heights if surface else None,
        settings=settings,
    )


def case_settings(case: ContactCase, surface: Raceway | None) -> Settings:
    """
    Return how to solve a case.

    On a stated domain the rolling force is that of the domain, without the tail to the meniscus.

    """
    settings = Settings(film_floor=case.film_floor)
    if case.domain is not None:
        domain = (case.domain.inlet, case.domain.outlet, case.domain.side)
        settings = replace(settings, domain=domain, meniscus_length=0.0)
    if case.grid is not None:
        settings = replace(settings, nx=case.grid.nx, ny=case.grid.ny)
    elif surface is not None:
        along, across = (
            nodes_on_waves(side, surface.shortest_wavelength) for side in _sides(case, settings)
        )
        settings = replace(settings, nx=max(along, ROUGH_NX), ny=max(across, settings.ny))
    elif ellipticity(case.contact) < SLENDER:
        settings = replace(settings, ny=WIDE_NY)
    if surface is not None:
        sides = _sides(case, settings)
        warn_of_coarse_nodes(
            (sides[0] / (settings.nx - 1), sides[1] / (settings.ny - 1)),
            surface.shortest_wavelength,
        )
    return settings


def _sides(case: ContactCase, settings: Settings) -> tuple[float, float]:
    scaled = make_case(case.contact, case.lubricant, case.condition, settings, None)
    inlet, outlet, side = scaled.domain
    return (outlet - inlet) * scaled.semi_axis_x, 2 * side * scaled.semi_axis_x


def warn_of_coarse_nodes(distances: tuple[float, float], wave: float) -> None:
    """Warn of nodes further apart along x or y [m] than half the shortest wavelength [m]."""
    for name, distance in zip('xy', distances, strict=True):
        if distance > 0.5 * wave:
            LOG.warning(
                'the nodes are %.3g um apart along %s, the shortest wavelength is %.3g um: '
                'asperity contact is not resolved',
                1e6 * distance,
                name,
                1e6 * wave,
            )
