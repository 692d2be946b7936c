# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Contacts of the screw in the full tier: smooth ones with the asperity contact of their raceway.

The raceway rolls, so that pressures and films are those of the smooth contact and the asperity law
says what touches.

"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from functools import partial
import math
from typing import Literal

from surrogate.asperities.law import AsperityContact, AsperityLaw
from surrogate.ehl import Condition, ContactLubricant, ContactSolution, Settings, solve_contact
from surrogate.ehl.watch import at
from surrogate.files import InputError
from surrogate.formulas.geometry import Contact, Side, SIDES
from surrogate.formulas.inlet import inlet_speed
from surrogate.formulas.lubricant import lubricant_state
from surrogate.parameters import Lubricant, OperatingPoint
from surrogate.screw.opened import Contacts
from surrogate.units import ZERO_CELSIUS

Kinematics = Literal['rolling', 'smooth']


@dataclass(frozen=True, kw_only=True, slots=True)
class ScrewSettings:
    """
    How to solve a screw.

    Whether the roughness rolls or the raceway is smooth; settings of the contacts, but for the
    film floor, which is that of the oil. `inlet_heating` thins films by shear in the inlet, as it
    does in formulas; contacts are solved again where friction changes their normal force by more
    than `coupling_tolerance` [-].

    """

    kinematics: Kinematics = 'rolling'
    smooth: Settings = field(default_factory=Settings)
    inlet_heating: bool = True
    coupling_tolerance: float = 0.01


@dataclass(frozen=True, kw_only=True, slots=True)
class SolvedContact:
    """
    A ball on one raceway, solved.

    The smooth contact as it was solved, and as the ball feels it, in the oil of its balance; what
    asperities do; their share of the friction of every node [-], None where the solution itself
    says which nodes touch.

    """

    smooth: ContactSolution
    pressed: ContactSolution
    asperities: AsperityContact
    friction_share: float | None = None

    @property
    def converged(self) -> bool:
        """Whether it was solved."""
        return self.smooth.converged


@dataclass(frozen=True, kw_only=True, slots=True)
class RollingContact:
    """
    A ball on one raceway at one point: all that a solve needs but the normal force.

    Side and geometry; oil at its temperature; entrainment speed [m/s] by the normal force [N],
    lower where a heated inlet thins the film; law of asperity contact where the roughness rolls,
    else None; how to solve, with the film floor of the oil.

    """

    side: Side
    geometry: Contact
    oil: ContactLubricant
    entrainment: Callable[[float], float]
    law: AsperityLaw | None
    settings: Settings


def make_contacts(
    opened: Contacts, lubricant: Lubricant, point: OperatingPoint, settings: ScrewSettings
) -> tuple[RollingContact, ...]:
    """Return the contacts of a ball with screw and nut, the same for both nuts of a point."""
    oil = oil_at(lubricant, point.temperature)
    speed, heated = opened.rates.entrainment * abs(point.speed), settings.inlet_heating

    def entrained(side: Side, load: float) -> float:
        place = load, speed, point.temperature
        return float(inlet_speed(opened.sheet, lubricant, side, *place, heated=heated))

    return tuple(
        RollingContact(
            side=side,
            geometry=opened.geometry[side],
            oil=oil,
            entrainment=partial(entrained, side),
            law=opened.law if settings.kinematics == 'rolling' else None,
            settings=replace(settings.smooth, film_floor=lubricant.film_floor),
        )
        for side in SIDES
    )


def solve_sides(
    contacts: Sequence[RollingContact],
    loads: tuple[float, float],
    start: Sequence[ContactSolution | None] = (),
) -> tuple[SolvedContact, ...]:
    """
    Solve the contacts of a nut under their normal forces [N], with the screw and with the nut.

    `start` holds those of a neighbouring point; one of this very point is taken as it is. None for
    a nut without load.

    """
    if not any(loads):
        return ()
    known = start or [None] * len(SIDES)
    solved = []
    for side, (contact, load, near) in enumerate(zip(contacts, loads, known, strict=True)):
        condition = Condition(load=load, entrainment_speed=contact.entrainment(load))
        case = contact.geometry, contact.oil, condition
        with at(side=side + 1):
            same = (
                near is not None
                and near.converged
                and (*case, contact.settings)
                == (near.contact, near.lubricant, near.condition, near.settings)
            )
            if near is None or not same:
                near = solve_contact(*case, settings=contact.settings, start=near)
            solved.append(_rolling(contact, near))
    return tuple(solved)


def smooth_film(smooth: ContactSolution) -> float:
    """Return the central film [m], extrapolated where the half grid was solved; 0 at rest."""
    if not smooth.condition.entrainment_speed:
        return 0.0
    extrapolated = smooth.extrapolated_film
    return smooth.central_film if math.isnan(extrapolated) else extrapolated


def _rolling(contact: RollingContact, smooth: ContactSolution) -> SolvedContact:
    """Return a smooth contact with what asperities do on a raceway that rolls through it."""
    share = None
    if contact.law is None:
        asperities = AsperityContact(smooth.rcs, smooth.asperity_share, 1.0)
    else:
        asperities = _asperities(contact, contact.law, smooth.condition)
        share = asperities.asperity_share
    return SolvedContact(
        smooth=smooth, pressed=smooth, asperities=asperities, friction_share=share
    )


def with_oil_of(contact: RollingContact, solved: SolvedContact) -> SolvedContact:
    """Return a solved contact with the oil, and with the speed and asperities, of another one."""
    pressed = replace(solved.pressed, lubricant=contact.oil)
    if contact.law is None or solved.friction_share is None:
        return replace(solved, pressed=pressed)
    load = solved.smooth.condition.load
    condition = Condition(load=load, entrainment_speed=contact.entrainment(load))
    asperities = _asperities(contact, contact.law, condition)
    return replace(
        solved, pressed=pressed, asperities=asperities, friction_share=asperities.asperity_share
    )


def _asperities(
    contact: RollingContact, law: AsperityLaw, condition: Condition
) -> AsperityContact:
    floor = contact.settings.film_floor
    return law.contact(contact.side, contact.geometry, condition, contact.oil, floor)


def oil_at(lubricant: Lubricant, temperature: float) -> ContactLubricant:
    """Return the oil at a temperature [K]; InputError where it is no liquid any more."""
    oil = lubricant_state(lubricant, temperature)
    try:
        return ContactLubricant(
            viscosity=float(oil.viscosity),
            pressure_viscosity=float(oil.pressure_viscosity),
            eyring_stress=oil.eyring_stress,
            limiting_shear_share=oil.limiting_shear_share,
        )
    except InputError as error:
        raise InputError(
            f'temperature is {temperature - ZERO_CELSIUS:g} degC: {lubricant.name}: {error}'
        ) from None
