# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""March a contact while its rough raceway rolls through it, and average what happens."""

from collections.abc import Sequence
from dataclasses import replace
import time

import numpy as np
from numpy.typing import NDArray
from surrogate.ehl.case import make_case
from surrogate.ehl.domain import production_domain
from surrogate.ehl.interface import (
    check_contact,
    Condition,
    ContactLubricant,
    ContactSolution,
    RoughHeights,
)
from surrogate.ehl.moving.feed import raceway_heights
from surrogate.ehl.moving.interface import LEAST_TRANSITS, MarchSettings, MovingSolution
from surrogate.ehl.moving.line import scale_strip, smooth_strip, strip_case, StripContact
from surrogate.ehl.moving.run import March, SmoothPath
from surrogate.ehl.results import state_from_solution
from surrogate.ehl.scales import scale_contact, ScaledContact
from surrogate.ehl.solver import solve_contact
from surrogate.ehl.watch import at
from surrogate.files import InputError
from surrogate.formulas.geometry import Contact

Array = NDArray[np.float64]
PRODUCTION = MarchSettings()
LEAST_INLET, LEAST_SIDE = 2.3, 1.3
"""Least inlet and side of the domain [semi-axes]: rough material enters in the inlet."""
SAMPLE = 64
"""Points along and across at which the highest summit of a raceway is looked for [-]."""


def march_contact(
    contact: Contact,
    lubricant: ContactLubricant,
    condition: Condition,
    raceway: RoughHeights,
    *,
    transits: float,
    settings: MarchSettings = PRODUCTION,
    start: ContactSolution | None = None,
) -> MovingSolution:
    """
    Let a rough raceway roll through a contact and average over time.

    `raceway` is a function z(x, y) [m] of places [m]; `transits` of the contact, two semi-axes
    each, are shared over `settings.places` beside each other, after a run-in at each. A `start`
    from a neighbouring condition saves the way to the smooth contact. Raises InputError for
    inputs that no contact has and for less than a transit at each place; everything else is a
    status.

    """
    check_contact(contact)
    check_transits(transits, settings)
    began = time.perf_counter()
    with at(stage='rolling contact'):
        march = contact_march(
            contact,
            lubricant,
            condition.load,
            (condition.entrainment_speed,),
            raceway,
            settings,
            start,
        )
        march.run(transits / settings.places)
    return march.solution(contact, time.perf_counter() - began)


def march_strip(
    strip: StripContact,
    lubricant: ContactLubricant,
    entrainment_speed: float,
    raceway: RoughHeights,
    *,
    transits: float,
    settings: MarchSettings = PRODUCTION,
) -> MovingSolution:
    """
    Let a rough raceway roll through a strip of a long contact and average over time.

    As `march_contact`, at an entrainment speed [m/s]. The raceway has to repeat with the width of
    the strip; the columns of the strip stand in for `settings.ny`, and of a domain only inlet and
    outlet count.

    """
    check_transits(transits, settings)
    began = time.perf_counter()
    with at(stage='rolling contact'):
        march = strip_march(strip, lubricant, (entrainment_speed,), raceway, settings)
        march.run(transits / settings.places)
    return march.solution(strip, time.perf_counter() - began)


def contact_march(
    contact: Contact,
    lubricant: ContactLubricant,
    load: float,
    speeds: Sequence[float],
    raceway: RoughHeights,
    settings: MarchSettings,
    start: ContactSolution | None = None,
) -> March:
    """Return a march at its start: load [N], entrainment speeds of its way [m/s]."""
    conditions = [Condition(load=load, entrainment_speed=speed) for speed in speeds]
    fastest = max(conditions, key=lambda condition: condition.entrainment_speed)
    scaled = scale_contact(contact, lubricant, fastest, raceway)
    steady = settings.steady(settings.domain or marching_domain(scaled))
    case = make_case(contact, lubricant, conditions[0], steady, raceway)
    grid = case.grid(settings.nx, settings.ny, symmetric=False)
    states = []
    for condition in conditions:
        start = solve_contact(
            contact, lubricant, condition, roughness=flat, settings=steady, start=start
        )
        if not start.converged:
            return March(case=case, grid=grid, settings=settings, path=None)
        states.append(state_from_solution(case, grid, start))
    path = SmoothPath(speeds=np.array(speeds), states=tuple(states))
    return March(case=case, grid=grid, settings=settings, path=path)


def strip_march(
    strip: StripContact,
    lubricant: ContactLubricant,
    speeds: Sequence[float],
    raceway: RoughHeights,
    settings: MarchSettings,
) -> March:
    """Return a march through a strip at its start: entrainment speeds of its way [m/s]."""
    scaled = scale_strip(strip, lubricant, max(speeds), raceway)
    steady = settings.steady(settings.domain or marching_domain(scaled))
    cases = [strip_case(scale_strip(strip, lubricant, u, raceway), steady) for u in speeds]
    grid = cases[0].grid(settings.nx, strip.columns, symmetric=False)
    states = []
    for case in cases:
        state, converged = smooth_strip(case, grid)
        if not converged:
            return March(case=case, grid=grid, settings=settings, path=None)
        states.append(state)
    path = SmoothPath(speeds=np.array(speeds), states=tuple(states))
    return March(case=cases[0], grid=grid, settings=settings, path=path)


def check_transits(transits: float, settings: MarchSettings) -> None:
    """Raise InputError for less than a transit [-] at each place."""
    if not transits >= LEAST_TRANSITS * settings.places:
        raise InputError(
            f'transits is {transits!r}, allowed is {LEAST_TRANSITS:g} or more at each of '
            f'{settings.places} places: a shorter strip has not been through the contact'
        )


def flat(x: Array, y: Array) -> Array:
    """Return heights of a raceway without roughness [m]: the solver of rough contacts, smooth."""
    return np.zeros(np.broadcast_shapes(x.shape, y.shape))


def marching_domain(scaled: ScaledContact) -> tuple[float, float, float]:
    """Return inlet, outlet and side over the semi-axes, with room for the highest summit."""
    a, b = scaled.semi_axis_x, scaled.semi_axis_y
    sample = raceway_heights(
        scaled.roughness, np.linspace(-4 * a, 4 * a, SAMPLE), np.linspace(-b, b, SAMPLE)
    )
    summit = float(sample.max() - sample.mean())
    everywhere = replace(scaled, roughness=lambda x, y: np.full(x.shape, summit))
    inlet, outlet, side = production_domain(everywhere, summit_reach=2.0)
    return min(inlet, -LEAST_INLET), outlet, max(side, LEAST_SIDE)
