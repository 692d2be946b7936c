# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Contacts of the screw in the full tier, each solved twice: smooth for the film ratio, and rough.

The rough raceway is one draw of its waves, scaled by the standard; waves that the grid is too
coarse for raise the film floor.

"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from functools import lru_cache
import math

from surrogate.ehl import Condition, ContactLubricant, ContactSolution, Settings, solve_contact
from surrogate.ehl.domain import MOST_NODES, nodes_on_waves
from surrogate.ehl.watch import at
from surrogate.files import InputError
from surrogate.formulas.geometry import Contact, screw_contact, Side, SIDES
from surrogate.formulas.inlet_heating import heated_speed
from surrogate.formulas.kinematics import no_slip_rates
from surrogate.formulas.lubricant import lubricant_state
from surrogate.formulas.starvation import starved_speed
from surrogate.parameters import Lubricant, OperatingPoint, Screw
from surrogate.raceway.ball import draw_stated
from surrogate.raceway.fractal import FractalSurface
from surrogate.raceway.short_waves import subgrid_floor, without_short_waves
from surrogate.units import ZERO_CELSIUS

Pair = tuple[ContactSolution, ContactSolution]
"""The same contact smooth and rough."""
Start = tuple[ContactSolution | None, ContactSolution | None]
ACROSS = 2.42
"""About the width of a rough domain over the semi-axis across (2.4 to 3.1) [-]."""
GRID_WAVELENGTH = 16e-6
"""Shortest wavelength on the grid [m]; docs/theory/roughness.md."""


@dataclass(frozen=True, kw_only=True, slots=True)
class ScrewSettings:
    """
    How to solve a screw.

    Settings of the smooth and of the rough contacts, but for the film floor, which is that of the
    oil; draw of the roughness, None for smooth raceways; shortest wavelength on the grid
    [m], shorter ones raise the floor, None to solve them all; nodes per such wave across the
    track, up to `MOST_NODES`, if that is more than the rough settings have [-]; `same_places`
    puts them at the same places of the raceway whatever the load; `inlet_heating` thins films by
    shear heating of the inlet; contacts are solved again where friction changes their normal force
    by more than `coupling_tolerance` [-].

    """

    smooth: Settings = field(default_factory=Settings)
    rough: Settings = field(default_factory=lambda: Settings(nx=129, ny=257, error_estimate=False))
    draw: int | None = 0
    grid_wavelength: float | None = GRID_WAVELENGTH
    nodes_per_wave: float = 6.0
    same_places: bool = False
    inlet_heating: bool = False
    coupling_tolerance: float = 0.01


@dataclass(frozen=True, kw_only=True, slots=True)
class RollingContact:
    """
    A ball on one raceway at one point: all that a solve needs but the normal force.

    Geometry; oil at its temperature; entrainment speed [m/s] by the normal force [N], lower where
    a heated inlet thins the film; film floor of the oil [m], raceway on the grid (None when
    smooth) and what its shorter waves lift the floor by [m]; how to solve.

    """

    geometry: Contact
    oil: ContactLubricant
    entrainment: Callable[[float], float]
    film_floor: float
    raceway: FractalSurface | None
    raised: float
    settings: ScrewSettings


def make_contacts(
    screw: Screw, lubricant: Lubricant, point: OperatingPoint, settings: ScrewSettings
) -> tuple[RollingContact, ...]:
    """Return the contacts of a ball with screw and nut, the same for both nuts of a point."""
    oil = oil_at(lubricant, point.temperature)
    speeds = [
        _entrainment(screw, lubricant, point, side, heated=settings.inlet_heating)
        for side in SIDES
    ]
    return tuple(
        _make_contact(screw, side, oil, lubricant.film_floor, speed, settings)
        for side, speed in zip(SIDES, speeds, strict=True)
    )


def _make_contact(
    screw: Screw,
    side: Side,
    oil: ContactLubricant,
    film_floor: float,
    entrainment: Callable[[float], float],
    settings: ScrewSettings,
) -> RollingContact:
    raceway, raised = None, 0.0
    if settings.draw is not None:
        raceway, raised = _on_grid(screw, settings.draw, settings.grid_wavelength)
    return RollingContact(
        geometry=screw_contact(screw, side),
        oil=oil,
        entrainment=entrainment,
        film_floor=film_floor,
        raceway=raceway,
        raised=raised,
        settings=settings,
    )


def _entrainment(
    screw: Screw, lubricant: Lubricant, point: OperatingPoint, side: Side, *, heated: bool
) -> Callable[[float], float]:
    """Return the entrainment speed [m/s] as a function of the normal force [N]."""
    speed = starved_speed(lubricant, no_slip_rates(screw).entrainment * abs(point.speed))
    if not heated:
        return lambda load: speed
    return lambda load: heated_speed(screw, lubricant, side, load, speed, point.temperature)


def solve_sides(
    contacts: Sequence[RollingContact], loads: tuple[float, float], start: Sequence[Start] = ()
) -> tuple[Pair, ...]:
    """
    Solve the contacts of a nut under their normal forces [N], with the screw and with the nut.

    `start` holds both pairs of a neighbouring point; a smooth contact of this very point is taken
    as it is. No pairs for a nut without load.

    """
    if not any(loads):
        return ()
    known = start or [(None, None)] * len(SIDES)
    solved = []
    for side, (contact, load, near) in enumerate(zip(contacts, loads, known, strict=True)):
        with at(side=side + 1):
            solved.append(_solve_side(contact, load, near))
    return tuple(solved)


def smooth_film(smooth: ContactSolution) -> float:
    """Return the central film [m], extrapolated where the half grid was solved; 0 at rest."""
    if not smooth.condition.entrainment_speed:
        return 0.0
    extrapolated = smooth.extrapolated_film
    return smooth.central_film if math.isnan(extrapolated) else extrapolated


def _solve_side(contact: RollingContact, load: float, start: Start) -> Pair:
    """Return the smooth and the rough contact under a normal force [N], from a near pair."""
    condition = Condition(load=load, entrainment_speed=contact.entrainment(load))
    case = contact.geometry, contact.oil, condition
    even, known = replace(contact.settings.smooth, film_floor=contact.film_floor), start[0]
    if known is not None and _is_of(known, (*case, even)):
        smooth = known
    else:
        smooth = solve_contact(*case, settings=even, start=known)
    raceway = contact.raceway
    if raceway is None or not smooth.converged:
        return smooth, smooth
    rough = _across(contact.settings, smooth.semi_axis_y, raceway.shortest_wavelength)
    return smooth, solve_contact(
        *case,
        roughness=raceway.heights,
        settings=replace(rough, film_floor=contact.film_floor + contact.raised),
        start=start[1],
    )


@lru_cache(maxsize=8)
def _on_grid(screw: Screw, draw: int, cut: float | None) -> tuple[FractalSurface | None, float]:
    """
    Return the raceway with waves down to `cut` [m] and what others lift the floor by [m].

    None where raceway and ball are smooth.

    """
    surface = draw_stated(screw.roughness, screw.ball_roughness, draw)
    if surface is None or cut is None:
        return surface, 0.0
    return without_short_waves(surface, cut), subgrid_floor(surface, cut)


def _is_of(
    known: ContactSolution, case: tuple[Contact, ContactLubricant, Condition, Settings]
) -> bool:
    """Tell whether a smooth solution converged and is that of a case."""
    return known.converged and case == (
        known.contact,
        known.lubricant,
        known.condition,
        known.settings,
    )


def oil_at(lubricant: Lubricant, temperature: float) -> ContactLubricant:
    """Return the oil at a temperature [K]; InputError where it is no liquid any more."""
    oil = lubricant_state(lubricant, temperature)
    try:
        return ContactLubricant(
            viscosity=float(oil.viscosity),
            pressure_viscosity=float(oil.pressure_viscosity),
            eyring_stress=oil.eyring_stress,
        )
    except InputError as error:
        raise InputError(
            f'temperature is {temperature - ZERO_CELSIUS:g} degC: {lubricant.name}: {error}'
        ) from None


def shortest_on_grid(screw: Screw, settings: ScrewSettings) -> float:
    """Return the shortest wavelength that rough contacts solve [m], infinite when smooth."""
    if settings.draw is None:
        return math.inf
    surface, _ = _on_grid(screw, settings.draw, settings.grid_wavelength)
    return math.inf if surface is None else surface.shortest_wavelength


def _across(settings: ScrewSettings, semi_axis: float, wave: float) -> Settings:
    """Return the rough settings with the nodes across that a semi-axis and a wave [m] ask for."""
    rough, width = settings.rough, ACROSS * semi_axis
    if settings.same_places:
        return replace(rough, spacing=max(wave / settings.nodes_per_wave, width / MOST_NODES))
    wanted = nodes_on_waves(width, wave, settings.nodes_per_wave)
    return replace(rough, ny=max(rough.ny, wanted))
