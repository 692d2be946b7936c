# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Unit of work of a full-tier surface: a load and a temperature over falling speeds.

Plain JSON in and out, so that it runs on any worker and is kept by its content. Each point starts
from the one before it; the chain is a fixed unit, and its numbers do not depend on who solves it.
Its grids are coarse: beside those of a single point the friction torque is 0.1 to 0.9 % larger.

"""

from collections.abc import Iterator, Mapping
from dataclasses import asdict, replace
from typing import Any

from surrogate.asperities.law import VERSION
from surrogate.ehl import Settings
from surrogate.parameters import Lubricant, OperatingPoint, Screw, screw_and_oil
from surrogate.screw.contacts import ScrewSettings
from surrogate.screw.opened import Contacts
from surrogate.screw.point import kept_point
from surrogate.screw.solve import rebalance_screw, ScrewSolution, solve_screw
from surrogate.surface import SolvedPoint

WORK = f'full tier 13, {VERSION}'
"""Solver and version of what a chain returns, constants of the asperity law with it; part of the
key under which it is kept."""
COARSE = Settings(nx=129)
"""Contacts of a chain: half of the nodes along the track, half of the time and less."""


SENSES = ('opposing', 'assisting')
"""Load against the motion, and with it."""
SolvedChain = tuple[tuple[SolvedPoint, ...], ...]
"""Points of a chain in the order of its speeds, by the `SENSES` of the load."""


def chain_inputs(
    screw: Screw, lubricant: Lubricant, load: float, temperature: float, speeds: list[float]
) -> dict[str, Any]:
    """Return a chain: `load` [N] at least 0, `temperature` [K], falling `speeds` [rad/s]."""
    return {
        'screw': screw.stated(),
        'lubricant': lubricant.stated(),
        'load': load,
        'temperature': temperature,
        'speeds': speeds,
    }


def point_inputs(
    screw: Screw, lubricant: Lubricant, load: float, temperature: float, speed: float
) -> dict[str, Any]:
    """Return a chain of one point on the grids of a single point, `load` [N] of either sign."""
    return chain_inputs(screw, lubricant, load, temperature, [speed]) | {'single': True}


def solve_chain(inputs: Mapping[str, Any]) -> dict[str, Any]:
    """
    Solve a chain, with the load against the motion and, unless it is zero or single, with it.

    Returns a `SolvedChain` in plain JSON types, which `solved_chain` reads.

    """
    pairs = list(_points(inputs))
    return {
        sense: [asdict(kept_point(pair[place])) for pair in pairs]
        for place, sense in enumerate(SENSES)
    }


def solved_chain(result: Mapping[str, Any]) -> SolvedChain:
    """Return what `solve_chain` returned, typed; the only reader of its JSON."""
    return tuple(tuple(SolvedPoint(**point) for point in result[sense]) for sense in SENSES)


def _points(inputs: Mapping[str, Any]) -> Iterator[tuple[ScrewSolution, ScrewSolution]]:
    """Yield both solutions of each speed; they share their contacts and differ by the balance."""
    screw, lubricant = screw_and_oil(inputs)
    opened = Contacts.of(screw)
    single = inputs.get('single', False)
    settings = ScrewSettings() if single else ScrewSettings(smooth=COARSE)
    last: ScrewSolution | None = None
    for speed in inputs['speeds']:
        point = OperatingPoint(speed=speed, load=inputs['load'], temperature=inputs['temperature'])
        opposing = solve_screw(opened, lubricant, point, settings=settings, start=last)
        last = opposing if opposing.converged else last
        assisting = opposing
        if point.load and not single:
            assisting = _turned(opened, lubricant, settings, point, opposing)
        yield opposing, assisting


def _turned(
    opened: Contacts,
    lubricant: Lubricant,
    settings: ScrewSettings,
    point: OperatingPoint,
    solution: ScrewSolution,
) -> ScrewSolution:
    """Return the solution with the load turned round: of the same contacts, if friction lets."""
    if not all(contact.converged for contact in solution.loaded_contacts):
        return solution
    against = replace(point, load=-point.load)
    # Balls that float on one side may hold on the other: an idle nut is solved again.
    if all(solution.normal_forces) and solution.load_change <= settings.coupling_tolerance:
        balanced = rebalance_screw(opened, lubricant, against, solution, settings=settings)
        if balanced.load_change <= settings.coupling_tolerance:
            return balanced
    return solve_screw(opened, lubricant, against, settings=settings, start=solution)
