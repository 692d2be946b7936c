# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Full tier: the screw at one operating point from its four solved contacts and balanced balls.

Each nut carries its share of the load on equal balls. A balanced ball yields its torque on the
screw and, apart from it, the power that it loses.

"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
import math

from surrogate.ehl.watch import at
from surrogate.files import InputError
from surrogate.formulas.film import film_ratio
from surrogate.formulas.geometry import SIDES
from surrogate.formulas.load_sharing import IDLE_SHARE, normal_force, nut_forces
from surrogate.formulas.torque import driving_torque, efficiency, is_back_driving
from surrogate.parameters import Lubricant, OperatingPoint, Screw
from surrogate.results import number
from surrogate.screw.ball_motion import Flank
from surrogate.screw.contacts import (
    make_contacts,
    RollingContact,
    ScrewSettings,
    solve_sides,
    SolvedContact,
    with_oil_of,
)
from surrogate.screw.nut import (
    FLOATING_SHARE,
    load_change,
    make_nut,
    NutLoad,
    ScrewContact,
    solve_nut,
    SolvedNut,
)
from surrogate.screw.opened import Contacts
from surrogate.screw.oversize import LIGHT_SHARE, make_oversize, solve_oversize
from surrogate.screw.point import ScrewPoint

TIER = 'full'
SOLVED = (
    'No load on either nut: nothing to solve.',
    'Solved: two contacts and the balls of the loaded nut, the relieved one is idle.',
    'Solved: four contacts and the balls of both nuts.',
)
"""Status by the number of nuts that carry load."""
FOUR_POINTS_SOLVED = 'Solved: oversize balls and their {} contacts.'
SAME_FORCE = 1e-3
"""Normal forces that differ by less, over the larger, count as the same [-]."""


@dataclass(frozen=True, kw_only=True, slots=True)
class ScrewSolution(ScrewPoint[float]):
    """
    The screw at one point by solved contacts; numbers are NaN unless `converged`.

    Driving torque [N m] from the loads on the screw; `energy_error`, what it and the friction
    torque, from lost power, miss of the energy balance, over the friction torque [-]; efficiency
    [-], whether the load drives the screw; `load_change`, largest difference between a normal
    force in balance and that under which its contact was solved [-].

    """

    contacts: tuple[ScrewContact, ...]
    driving_torque: float = number('Nm')
    energy_error: float = number()
    efficiency: float = number()
    back_driving: bool = number(default=False)
    load_change: float = number()

    @property
    def loaded_contacts(self) -> tuple[SolvedContact, ...]:
        """Solved contacts, those that carry load."""
        return tuple(contact.solved for contact in self.contacts if contact.solved is not None)


def solve_screw(
    opened: Contacts,
    lubricant: Lubricant,
    point: OperatingPoint,
    *,
    settings: ScrewSettings | None = None,
    start: ScrewSolution | None = None,
) -> ScrewSolution:
    """
    Solve the full model of a screw, opened by `Contacts.of`, at one operating point.

    A `start` from a neighbouring point of the same screw saves time and changes nothing beyond the
    tolerances of the contacts. Speed zero is the limit of slow motion in the positive direction:
    all load on asperities. A contact or a ball that did not converge leaves its sentence in the
    status and NaN elsewhere.

    """
    settings, screw = settings or ScrewSettings(), opened.sheet
    nuts = _nut_loads(screw, point)
    near = [contact.smooth for contact in start.contacts] if start else []
    contacts: tuple[RollingContact, ...] = ()
    if any(nut.force for nut in nuts):
        contacts = make_contacts(opened, lubricant, point, settings)
    loaded, relieved = (float(normal_force(screw, nut.force)) for nut in nuts)
    four_points = screw.nut == 'oversize'
    if four_points:
        relieved = max(relieved, LIGHT_SHARE * loaded)
    with at(nut=1):
        pairs = [solve_sides(contacts, (loaded, loaded), near[:2])]
    same = loaded == relieved
    with at(nut=2):
        pairs.append(pairs[0] if same else solve_sides(contacts, (relieved, relieved), near[2:]))
    solved, tolerance = [], settings.coupling_tolerance
    if four_points and loaded > 0:
        solved = solve_oversize(screw, point, nuts, contacts, pairs, tolerance=tolerance)
        return _combine(opened, point, solved)
    for place, (nut, pair) in enumerate(zip(nuts, pairs, strict=True)):
        with at(nut=place + 1):
            solved.append(solve_nut(screw, point, nut, contacts, pair, tolerance=tolerance))
    return _combine(opened, point, _without_floating(screw, point, nuts, solved))


def rebalance_screw(
    opened: Contacts,
    lubricant: Lubricant,
    point: OperatingPoint,
    solution: ScrewSolution,
    *,
    settings: ScrewSettings | None = None,
) -> ScrewSolution:
    """
    Balance the balls again on the contacts of a solution: faster than a solve by far.

    For another asperity friction or parasitic torque, which no contact knows of, this is what a
    solve gives. Another oil or speed must keep the product of viscosity and speed, which pressure
    and film follow, nearly; asperities follow the law of the `settings`. Raises InputError for
    another load than that solved.

    """
    screw = opened.sheet
    _check_same_load(screw, point, solution)
    sides = make_contacts(opened, lubricant, point, settings or ScrewSettings())
    pairs = [
        [
            with_oil_of(side, contact.solved) if contact.solved is not None else None
            for side, contact in zip(sides, contacts, strict=True)
        ]
        for contacts in (solution.contacts[:2], solution.contacts[2:])
    ]
    nuts = _nut_loads(screw, point)
    if screw.nut == 'oversize':
        return _combine(opened, point, make_oversize(screw, point, nuts, pairs))
    solved = [
        make_nut(screw, point, nut, [contact for contact in pair if contact is not None])
        for nut, pair in zip(nuts, pairs, strict=True)
    ]
    return _combine(opened, point, _without_floating(screw, point, nuts, solved))


def _without_floating(
    screw: Screw, point: OperatingPoint, nuts: tuple[NutLoad, NutLoad], solved: Sequence[SolvedNut]
) -> list[SolvedNut]:
    """Return the nuts; a relieved one whose balls float, and so are not solved, is idle."""
    loaded, relieved = nuts
    if solved[1].failure and relieved.force < FLOATING_SHARE * loaded.force:
        return [solved[0], make_nut(screw, point, replace(relieved, force=0.0), ())]
    return list(solved)


def _check_same_load(screw: Screw, point: OperatingPoint, solution: ScrewSolution) -> None:
    """Raise InputError when the contacts of a solution belong to other normal forces."""
    wanted = [float(normal_force(screw, nut.force)) for nut in _nut_loads(screw, point)]
    unsolved = any(
        force > 0 and contact.solved is None
        for place, contact in enumerate(solution.contacts)
        for force in [wanted[place // len(SIDES)]]
        if screw.nut != 'oversize' or place < len(SIDES)
    )
    apart = max(abs(new - old) for new, old in zip(wanted, solution.normal_forces, strict=True))
    if unsolved or apart > SAME_FORCE * max(wanted):
        raise InputError(
            f'load is {point.load:g} N, with {wanted[0]:.4g} and {wanted[1]:.4g} N a ball, '
            f'allowed is that solved, with {solution.normal_forces[0]:.4g} and '
            f'{solution.normal_forces[1]:.4g} N'
        )


def _nut_loads(screw: Screw, point: OperatingPoint) -> tuple[NutLoad, NutLoad]:
    """Return what both nuts carry; a share too small to hold its balls counts as no load."""
    ahead: Flank = 1 if point.opposing_load >= 0 else -1
    behind: Flank = -1 if ahead == 1 else 1
    loaded, relieved = (float(force) for force in nut_forces(point.opposing_load, screw.preload))
    if relieved < IDLE_SHARE * loaded:
        loaded, relieved = abs(point.opposing_load), 0.0
    return (
        NutLoad(nut='loaded', force=loaded, flank=ahead),
        NutLoad(nut='relieved', force=relieved, flank=behind),
    )


def _combine(opened: Contacts, point: OperatingPoint, nuts: Sequence[SolvedNut]) -> ScrewSolution:
    screw, speed, load = opened.sheet, abs(point.speed), point.opposing_load
    contacts = nuts[0].contacts + nuts[1].contacts
    worst = worst_contact(contacts)
    worn = contacts[worst].solved if contacts else None
    done = SOLVED[sum(nut.force > 0 for nut in nuts)]
    if screw.nut == 'oversize':
        done = FOUR_POINTS_SOLVED.format(sum(contact.solved is not None for contact in contacts))
    solution = ScrewSolution(
        status=next((nut.failure for nut in nuts if nut.failure), done),
        converged=not any(nut.failure for nut in nuts),
        contacts=contacts,
        worst_contact=worst,
        rcs_deviation=worn.asperities.rcs_deviation if worn else math.nan,
        entrainment_speed=opened.rates.entrainment * speed,
        normal_forces=(
            float(normal_force(screw, nuts[0].force)),
            float(normal_force(screw, nuts[1].force)),
        ),
    )
    if not solution.converged:
        return solution
    carrying = [contact for contact in contacts if contact.solved is not None]
    film = min((contact.central_film for contact in carrying), default=math.nan)
    parasitic = screw.parasitic_torque + screw.parasitic_torque_rate * speed
    balls = [nut.ball for nut in nuts if nut.ball is not None]
    friction = screw.loaded_balls_per_nut * sum(ball.loss_torque for ball in balls) + parasitic
    pressing = sum(contact.normal_force for contact in carrying)
    sliding = sum(contact.normal_force * contact.friction_coefficient for contact in carrying)
    driving = screw.loaded_balls_per_nut * sum(ball.torque for ball in balls) + parasitic
    missed = driving - driving_torque(friction, load, screw.lead)
    return replace(
        solution,
        friction_torque=friction,
        driving_torque=driving,
        energy_error=abs(missed) / friction if friction else 0.0,
        efficiency=efficiency(friction, load, screw.lead),
        back_driving=is_back_driving(friction, load, screw.lead),
        load_change=max(load_change(nut) for nut in nuts),
        friction_coefficient=sliding / pressing if pressing else math.nan,
        rcs=max((contact.rcs for contact in carrying), default=0.0),
        asperity_share=max((contact.asperity_share for contact in carrying), default=0.0),
        film_ratio=float(film_ratio(film, screw.composite_rms)),
        central_film=film,
        minimum_film=min((contact.minimum_film for contact in carrying), default=math.nan),
        max_pressure=max((contact.max_pressure for contact in carrying), default=math.nan),
    )


def worst_contact(contacts: Sequence[ScrewContact]) -> int:
    """Return the place of the largest RCS, of equal ones that of the thinnest film."""
    pressed = [
        (contact.rcs, -contact.film_ratio, -place)
        for place, contact in enumerate(contacts)
        if contact.solved is not None and not math.isnan(contact.rcs)
    ]
    return -max(pressed)[2] if pressed else 0
