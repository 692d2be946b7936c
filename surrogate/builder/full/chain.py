# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Unit of work of a full-tier surface: one draw at one load and temperature over falling speeds.

Plain JSON in and out, so that it runs on any worker and is kept by its content. Each point starts
from the one before it; the chain is a fixed unit, and its numbers do not depend on who solves it.

"""

from collections.abc import Iterator, Mapping
from dataclasses import asdict, dataclass, replace
from functools import lru_cache
from typing import Any

from surrogate.builder.tiers import screw_and_oil
from surrogate.ehl import Settings
from surrogate.parameters import Lubricant, OperatingPoint, Screw
from surrogate.screw.contacts import GRID_WAVELENGTH, ScrewSettings
from surrogate.screw.nut import ScrewContact
from surrogate.screw.solve import rebalance_screw, ScrewSolution, solve_screw
from surrogate.surface import FIELDS, SolvedPoint

WORK = 'full tier 9'
"""Solver and version of what a chain returns; part of the key under which it is kept."""
FLUX_TOLERANCE = 3e-3
"""Rest of the flux of a rough contact per line over that of the film, weighted as there [-];
docs/theory/contact_solver.md."""


@dataclass(frozen=True, slots=True)
class SolvedChain:
    """Points of a chain in the order of its speeds: load against the motion, and with it."""

    opposing: tuple[SolvedPoint, ...]
    assisting: tuple[SolvedPoint, ...]

    def under(self, load: float) -> tuple[SolvedPoint, ...]:
        """Return the points under a load [N] of either sign."""
        return self.opposing if load >= 0 else self.assisting


def chain_inputs(
    screw: Screw,
    lubricant: Lubricant,
    load: float,
    temperature: float,
    draw: int,
    speeds: list[float],
    grid_wavelength: float | None = GRID_WAVELENGTH,
) -> dict[str, Any]:
    """
    Return a chain: `load` [N] at least 0, `temperature` [K], falling `speeds` [rad/s].

    Waves of the roughness shorter than `grid_wavelength` [m] raise the film floor.

    """
    return {
        'screw': asdict(screw),
        'lubricant': asdict(lubricant),
        'load': load,
        'temperature': temperature,
        'draw': draw,
        'speeds': speeds,
        'grid_wavelength': grid_wavelength,
    }


def solve_chain(inputs: Mapping[str, Any]) -> dict[str, Any]:
    """
    Solve a chain, with the load against the motion and, unless it is zero, with it.

    Returns a `SolvedChain` in plain JSON types, which `solved_chain` reads.

    """
    screw, lubricant = screw_and_oil(inputs)
    settings = chain_settings(inputs['draw'], inputs['grid_wavelength'])
    pairs = list(_points(screw, lubricant, settings, inputs))
    return {
        sense: [asdict(solved_point(pair[place])) for pair in pairs]
        for place, sense in enumerate(('opposing', 'assisting'))
    }


def solved_chain(result: Mapping[str, Any]) -> SolvedChain:
    """Return what `solve_chain` returned, typed; the only reader of its JSON."""
    opposing, assisting = (
        tuple(SolvedPoint(**point) for point in result[sense])
        for sense in ('opposing', 'assisting')
    )
    return SolvedChain(opposing, assisting)


def chain_settings(draw: int | None, grid_wavelength: float | None) -> ScrewSettings:
    """
    Return how chains are solved: as a point is, but for grid and tolerances of rough contacts.

    A quarter fewer nodes along, a sixth fewer across, for light contacts half as many, and a
    limited wedge that fades later: as near to the finest grid at 27.6 N and as the grid of a point
    at 100 N, in half the time; docs/theory/roughness.md. Balls with a thousandth of the load rest
    on summits far beside the middle.

    """
    rough = Settings(
        nx=97,
        ny=129,
        wedge_fading=4.0,
        summit_reach=6.0,
        flux_tolerance=FLUX_TOLERANCE,
        krylov_tolerance=0.1,
        error_estimate=False,
    )
    return ScrewSettings(
        draw=draw,
        grid_wavelength=grid_wavelength,
        rough=rough,
        nodes_per_wave=5.0,
        same_places=True,
    )


def _points(
    screw: Screw, lubricant: Lubricant, settings: ScrewSettings, inputs: Mapping[str, Any]
) -> Iterator[tuple[ScrewSolution, ScrewSolution]]:
    """Yield both solutions of each speed; they share their contacts and differ by the balance."""
    last: ScrewSolution | None = None
    for speed in inputs['speeds']:
        point = OperatingPoint(speed=speed, load=inputs['load'], temperature=inputs['temperature'])
        start = _with_rough(_smooth(screw, lubricant, point), last)
        opposing = solve_screw(screw, lubricant, point, settings=settings, start=start)
        last = assisting = opposing
        if point.load:
            assisting = _turned(screw, lubricant, settings, point, opposing)
        yield opposing, assisting


def _turned(
    screw: Screw,
    lubricant: Lubricant,
    settings: ScrewSettings,
    point: OperatingPoint,
    found: ScrewSolution,
) -> ScrewSolution:
    """Return the solution with the load turned round: of the same contacts, if friction lets."""
    if any(_has_failed(contact) for contact in found.contacts):
        return found
    against = replace(point, load=-point.load)
    if found.load_change <= settings.coupling_tolerance:
        balanced = rebalance_screw(screw, lubricant, against, found)
        if balanced.load_change <= settings.coupling_tolerance:
            return balanced
    return solve_screw(screw, lubricant, against, settings=settings, start=found)


def _has_failed(contact: ScrewContact) -> bool:
    """Tell whether the rough solution of a contact is of no use."""
    return contact.rough is not None and not contact.rough.converged


@lru_cache(maxsize=24)
def _smooth(screw: Screw, lubricant: Lubricant, point: OperatingPoint) -> ScrewSolution:
    """Solve a point with smooth raceways, which all draws share."""
    return solve_screw(screw, lubricant, point, settings=chain_settings(None, None))


def _with_rough(smooth: ScrewSolution, last: ScrewSolution | None) -> ScrewSolution:
    """Return the smooth contacts of a point, with the rough ones of the last that converged."""
    before = last.contacts if last else smooth.contacts
    return replace(
        smooth,
        contacts=tuple(
            replace(contact, rough=None if not last or _has_failed(near) else near.rough)
            for contact, near in zip(smooth.contacts, before, strict=True)
        ),
    )


def solved_point(found: ScrewSolution) -> SolvedPoint:
    """Return what a surface keeps of a solution."""
    return SolvedPoint(
        converged=found.converged and bool(found.rough_contacts),
        status=found.status,
        worst_contact=found.worst_contact,
        film_over_floor=found.film_over_floor,
        **{name: getattr(found, name) for name in FIELDS},
    )
