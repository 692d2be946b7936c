# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""March of a case whose roughness rolls: its surface, its nodes and its averages."""

from dataclasses import replace
import logging
import math

from surrogate.contact.case import CaseStrip, ContactCase
from surrogate.contact.solve import warn_of_coarse_nodes
from surrogate.contact.surface import case_surface, level_surface
from surrogate.ehl.moving import (
    march_contact,
    march_strip,
    MarchSettings,
    MovingSolution,
    strip_at,
    StripContact,
)
from surrogate.ehl.moving.line import scale_strip
from surrogate.ehl.moving.march import marching_domain
from surrogate.ehl.scales import scale_contact, ScaledContact
from surrogate.raceway.fractal import FractalSurface
from surrogate.raceway.periodic import periodic_across, turn_and_loss

TRANSITS, PLACES = 8.0, 4
"""Transits of the contact, and places over which they are shared, of a case without them [-]."""
LOG = logging.getLogger(__name__)


def march_case(case: ContactCase) -> tuple[MovingSolution, FractalSurface]:
    """
    March a case; return the averages over its transits and the surface that rolled.

    Raises InputError for inputs that no contact has; anything else is a status of the solution.

    """
    surface = case_surface(case)
    assert isinstance(surface, FractalSurface)  # by the checks of a case
    surface, transits = level_surface(surface), case.transits or TRANSITS
    if case.strip is not None:
        strip, speed = case_strip(case, case.strip), case.entrainment_speed
        periodic = periodic_across(surface, strip.width)
        turn, lost = turn_and_loss(surface, periodic)
        LOG.info(
            'strip: to repeat across it the waves are turned by %.2g deg rms; %.2g %% of their '
            'mean square is lost',
            math.degrees(turn),
            100 * lost,
        )
        heights = periodic.heights
        scaled = scale_strip(strip, case.lubricant, speed, heights)
        settings = march_settings(case, scaled)
        _check_nodes(settings, scaled, strip.width / strip.columns, periodic)
        solution = march_strip(
            strip, case.lubricant, speed, heights, transits=transits, settings=settings
        )
        return solution, surface
    scaled = scale_contact(case.contact, case.lubricant, case.condition, surface.heights)
    settings = march_settings(case, scaled)
    assert settings.domain is not None
    across = 2 * settings.domain[2] * scaled.semi_axis_y / (settings.ny - 1)
    _check_nodes(settings, scaled, across, surface)
    contact, heights = case.contact, surface.heights
    solution = march_contact(
        contact, case.lubricant, case.condition, heights, transits=transits, settings=settings
    )
    return solution, surface


def case_strip(case: ContactCase, stated: CaseStrip) -> StripContact:
    """Return the strip of a case."""
    return strip_at(case.contact, case.load, stated.place, stated.width, stated.columns)


def march_settings(case: ContactCase, scaled: ScaledContact) -> MarchSettings:
    """Return how to march a case; a domain that it does not state has room for its summits."""
    settings = MarchSettings(
        places=case.places or PLACES, film_floor=case.film_floor, domain=marching_domain(scaled)
    )
    if case.grid is not None:
        settings = replace(settings, nx=case.grid.nx, ny=case.grid.ny)
    if case.domain is not None:
        domain = (case.domain.inlet, case.domain.outlet, case.domain.side)
        settings = replace(settings, domain=domain)
    if case.slide_roll_ratio:
        settings = replace(settings, slide_roll_ratio=case.slide_roll_ratio[0])
    return settings


def _check_nodes(
    settings: MarchSettings, scaled: ScaledContact, across: float, surface: FractalSurface
) -> None:
    """Warn when the nodes, `across` [m] apart on a line across, are too far apart."""
    assert settings.domain is not None
    inlet, outlet, _ = settings.domain
    along = (outlet - inlet) * scaled.semi_axis_x / (settings.nx - 1)
    warn_of_coarse_nodes((along, across), surface.shortest_wavelength)
