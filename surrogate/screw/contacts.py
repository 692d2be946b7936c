# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Contacts of the screw in the full tier: smooth ones with the asperity contact of their raceway.

The raceway rolls, so that pressures and films are those of the smooth contact and the asperity law
says what touches. For comparison a rough raceway may stand still: one draw of its waves, scaled by
the standard, which the contact is solved with; waves that the grid is too coarse for raise the
film floor.

"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from functools import lru_cache, partial
import math
from typing import Literal

from surrogate.asperities.law import AsperityContact, AsperityLaw
from surrogate.ehl import Condition, ContactLubricant, ContactSolution, Settings, solve_contact
from surrogate.ehl.domain import nodes_on_waves
from surrogate.ehl.watch import at
from surrogate.files import InputError
from surrogate.formulas.geometry import Contact, Side, SIDES
from surrogate.formulas.inlet import inlet_speed
from surrogate.formulas.lubricant import lubricant_state
from surrogate.parameters import BallRoughness, Lubricant, OperatingPoint, Roughness, Screw
from surrogate.raceway.ball import draw_stated
from surrogate.raceway.fractal import FractalSurface
from surrogate.raceway.short_waves import subgrid_floor, without_short_waves
from surrogate.screw.opened import Contacts
from surrogate.units import ZERO_CELSIUS

Kinematics = Literal['rolling', 'standing', 'smooth']
Start = tuple[ContactSolution | None, ContactSolution | None]
ACROSS = 2.42
"""About the width of a rough domain over the semi-axis across (2.4 to 3.1) [-]."""
GRID_WAVELENGTH = 16e-6
"""Shortest wavelength on the grid [m]; docs/theory/raceway.md."""


@dataclass(frozen=True, kw_only=True, slots=True)
class ScrewSettings:
    """
    How to solve a screw.

    What the roughness does: it rolls, it stands still, or the raceway is smooth. Settings of the
    smooth and of the rough contacts, but for the film floor, which is that of the oil. Of
    roughness that stands: its draw,
    shortest wavelength on the grid [m], shorter ones raise the floor, None to solve all; nodes per
    such wave across the track, up to `MOST_NODES`, if that is more than the rough settings have
    [-]. `inlet_heating` thins films by shear in the inlet, as it does in formulas; contacts are
    solved again where friction changes their normal force by more than `coupling_tolerance` [-].

    """

    kinematics: Kinematics = 'rolling'
    smooth: Settings = field(default_factory=Settings)
    rough: Settings = field(default_factory=lambda: Settings(nx=129, ny=257, error_estimate=False))
    draw: int = 0
    grid_wavelength: float | None = GRID_WAVELENGTH
    nodes_per_wave: float = 6.0
    inlet_heating: bool = True
    coupling_tolerance: float = 0.01


@dataclass(frozen=True, kw_only=True, slots=True)
class SolvedContact:
    """
    A ball on one raceway, solved.

    The smooth contact; that whose pressures and films the ball feels, the smooth one unless the
    roughness stands; what asperities do; their share of the friction of every node [-], None where
    the solution itself says which nodes touch.

    """

    smooth: ContactSolution
    pressed: ContactSolution
    asperities: AsperityContact
    friction_share: float | None = None

    @property
    def converged(self) -> bool:
        """Whether both were solved."""
        return self.smooth.converged and self.pressed.converged


@dataclass(frozen=True, kw_only=True, slots=True)
class RollingContact:
    """
    A ball on one raceway at one point: all that a solve needs but the normal force.

    Side and geometry; oil at its temperature; entrainment speed [m/s] by the normal force [N],
    lower where a heated inlet thins the film; film floor of the oil [m]; law of asperity contact
    where the roughness rolls, else None; where it stands, raceway on the grid and what its shorter
    waves lift the floor by [m]; how to solve.

    """

    side: Side
    geometry: Contact
    oil: ContactLubricant
    entrainment: Callable[[float], float]
    film_floor: float
    law: AsperityLaw | None
    raceway: FractalSurface | None
    raised: float
    settings: ScrewSettings


def make_contacts(
    opened: Contacts, lubricant: Lubricant, point: OperatingPoint, settings: ScrewSettings
) -> tuple[RollingContact, ...]:
    """Return the contacts of a ball with screw and nut, the same for both nuts of a point."""
    oil = oil_at(lubricant, point.temperature)
    speed, heated = opened.rates.entrainment * abs(point.speed), settings.inlet_heating
    raceway, raised = None, 0.0
    if settings.kinematics == 'standing':
        raceway, raised = standing_raceway(opened.sheet, settings)

    def entrained(side: Side, load: float) -> float:
        place = load, speed, point.temperature
        return float(inlet_speed(opened.sheet, lubricant, side, *place, heated=heated))

    return tuple(
        RollingContact(
            side=side,
            geometry=opened.geometry[side],
            oil=oil,
            entrainment=partial(entrained, side),
            film_floor=lubricant.film_floor,
            law=opened.law if settings.kinematics == 'rolling' else None,
            raceway=raceway,
            raised=raised,
            settings=settings,
        )
        for side in SIDES
    )


def solve_sides(
    contacts: Sequence[RollingContact], loads: tuple[float, float], start: Sequence[Start] = ()
) -> tuple[SolvedContact, ...]:
    """
    Solve the contacts of a nut under their normal forces [N], with the screw and with the nut.

    `start` holds smooth and pressed ones of a neighbouring point; a smooth contact of this very
    point is taken as it is. None for a nut without load.

    """
    if not any(loads):
        return ()
    known = start or [(None, None)] * len(SIDES)
    solved = []
    for side, (contact, load, near) in enumerate(zip(contacts, loads, known, strict=True)):
        condition = Condition(load=load, entrainment_speed=contact.entrainment(load))
        case = contact.geometry, contact.oil, condition
        even = replace(contact.settings.smooth, film_floor=contact.film_floor)
        smooth, pressed = near
        with at(side=side + 1):
            same = (
                smooth is not None
                and smooth.converged
                and (*case, even)
                == (*(smooth.contact, smooth.lubricant, smooth.condition, smooth.settings),)
            )
            if smooth is None or not same:
                smooth = solve_contact(*case, settings=even, start=smooth)
            if contact.raceway is not None and smooth.converged:
                solved.append(_standing(contact, smooth, pressed))
            else:
                solved.append(_rolling(contact, smooth))
    return tuple(solved)


def smooth_film(smooth: ContactSolution) -> float:
    """Return the central film [m], extrapolated where the half grid was solved; 0 at rest."""
    if not smooth.condition.entrainment_speed:
        return 0.0
    extrapolated = smooth.extrapolated_film
    return smooth.central_film if math.isnan(extrapolated) else extrapolated


def _rolling(contact: RollingContact, smooth: ContactSolution) -> SolvedContact:
    """Return a smooth contact with what asperities do on a raceway that rolls through it."""
    if contact.law is None:
        asperities = AsperityContact(smooth.rcs, smooth.asperity_share, 1.0)
        return SolvedContact(smooth=smooth, pressed=smooth, asperities=asperities)
    asperities = _asperities(contact, contact.law, smooth.condition)
    return SolvedContact(
        smooth=smooth,
        pressed=smooth,
        asperities=asperities,
        friction_share=asperities.asperity_share,
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
    return law.contact(contact.side, contact.geometry, condition, contact.oil, contact.film_floor)


def _standing(
    contact: RollingContact, smooth: ContactSolution, start: ContactSolution | None
) -> SolvedContact:
    assert contact.raceway is not None
    wave = contact.raceway.shortest_wavelength
    rough = _across(contact.settings, smooth.semi_axis_y, wave)
    pressed = solve_contact(
        contact.geometry,
        contact.oil,
        smooth.condition,
        roughness=contact.raceway.heights,
        settings=replace(rough, film_floor=contact.film_floor + contact.raised),
        start=start,
    )
    asperities = AsperityContact(pressed.rcs, pressed.asperity_share, 1.0)
    return SolvedContact(smooth=smooth, pressed=pressed, asperities=asperities)


def standing_raceway(screw: Screw, settings: ScrewSettings) -> tuple[FractalSurface | None, float]:
    """
    Return the raceway with the waves of the grid and what others lift the floor by [m].

    None where raceway and ball are smooth.

    """
    rough, ball = screw.roughness, screw.ball_roughness
    return _on_grid(rough, ball, settings.draw, settings.grid_wavelength)


@lru_cache(maxsize=8)
def _on_grid(
    rough: Roughness, ball: BallRoughness | None, draw: int, cut: float | None
) -> tuple[FractalSurface | None, float]:
    surface = draw_stated(rough, ball, draw)
    if surface is None or cut is None:
        return surface, 0.0
    return without_short_waves(surface, cut), subgrid_floor(surface, cut)


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


def shortest_on_grid(screw: Screw, settings: ScrewSettings) -> float:
    """Return the shortest wavelength that rough contacts solve [m], infinite when smooth."""
    if settings.kinematics != 'standing':
        return math.inf
    surface, _ = standing_raceway(screw, settings)
    return math.inf if surface is None else surface.shortest_wavelength


def _across(settings: ScrewSettings, semi_axis: float, wave: float) -> Settings:
    """Return the rough settings with the nodes across that a semi-axis and a wave [m] ask for."""
    rough, width = settings.rough, ACROSS * semi_axis
    wanted = nodes_on_waves(width, wave, settings.nodes_per_wave)
    return replace(rough, ny=max(rough.ny, wanted))
