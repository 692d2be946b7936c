# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Full tier: the screw at one operating point from its four solved contacts and balanced balls.

Each nut carries its share of the load on equal balls. A ball has a contact with the screw and one
with the nut; both are solved, smooth for the film ratio and rough for what asperities carry. Their
tractions and rolling couples balance the ball, which yields its torque on the screw and, apart
from it, the power that it loses.

"""

from dataclasses import dataclass, field, replace
import math
from typing import Literal

from surrogate.ball_balance import balance_ball
from surrogate.ball_motion import Flank, slip_floor
from surrogate.ball_result import BallBalance, BallContact
from surrogate.ball_traction import solved_traction
from surrogate.ehl import Condition, ContactLubricant, ContactSolution, Settings, solve_contact
from surrogate.geometry import hertz, screw_contact, Side, SIDES
from surrogate.kinematics import no_slip_rates
from surrogate.load_sharing import normal_force, nut_forces, UNLOADING_RATIO
from surrogate.lubricant import lubricant_state
from surrogate.parameters import Lubricant, OperatingPoint, Screw
from surrogate.roughness import fractal_surface, FractalSurface, take_patch, Window
from surrogate.torque import driving_torque, efficiency, is_back_driving

TIER = 'full'
SOLVED = 'Solved: four contacts and the balls of both nuts.'
Nut = Literal['loaded', 'relieved']
CREEP = 1e-3
"""Screw speed of the limit of slow motion [rad/s]."""
WINDOW_SHARE = 0.05
"""Axial load whose Hertz rectangle is the patch of an unpreloaded screw, over its rating [-]."""


@dataclass(frozen=True, kw_only=True, slots=True)
class ScrewSettings:
    """
    How to solve a screw.

    Settings of the smooth and of the rough contacts; draw of the roughness, None for smooth
    raceways; shortest wavelength on the grid [m], None for that of the datasheet.

    """

    smooth: Settings = field(default_factory=Settings)
    rough: Settings = field(default_factory=lambda: Settings(nx=129, ny=257, error_estimate=False))
    draw: int | None = 0
    grid_wavelength: float | None = 16e-6


@dataclass(frozen=True, kw_only=True, slots=True)
class ScrewContact:
    """
    One contact of one nut; solutions are None where it carries no load.

    Smooth and rough solution, the part of the ball balance at this contact, film ratio [-].

    """

    nut: Nut
    side: Side
    smooth: ContactSolution | None
    rough: ContactSolution | None
    ball: BallContact
    film_ratio: float


@dataclass(frozen=True, kw_only=True, slots=True)
class ScrewSolution:
    """
    The screw at one point; numbers are NaN unless `converged`, and `status` says why.

    Friction torque [N m] with the parasitic part, from lost power; driving torque [N m] from the
    loads on the screw; `energy_error`, what both miss of the energy balance, over the friction
    torque [-]; efficiency [-], whether the load drives the screw; RCS and asperity share of the
    worst contact [-], film ratio [-] and central film [m] of the thinnest; entrainment speed
    [m/s], normal forces of a ball of the loaded and the relieved nut before friction [N], largest
    change of them by friction [-], for which the contacts are not solved again.

    """

    status: str
    converged: bool
    contacts: tuple[ScrewContact, ...]
    entrainment_speed: float
    normal_forces: tuple[float, float]
    friction_torque: float = math.nan
    driving_torque: float = math.nan
    energy_error: float = math.nan
    efficiency: float = math.nan
    back_driving: bool = False
    rcs: float = math.nan
    asperity_share: float = math.nan
    film_ratio: float = math.nan
    central_film: float = math.nan
    load_change: float = math.nan


def solve_screw(
    screw: Screw,
    lubricant: Lubricant,
    point: OperatingPoint,
    *,
    settings: ScrewSettings | None = None,
) -> ScrewSolution:
    """
    Solve the full model at one operating point.

    Speed zero is the limit of slow motion in the positive direction: all load on asperities. A
    contact or a ball that did not converge leaves its sentence in the status and NaN elsewhere.

    """
    settings = settings or ScrewSettings()
    forces = nut_forces(point.opposing_load, screw.preload)
    ahead: Flank = 1 if point.opposing_load >= 0 else -1
    behind: Flank = -1 if point.opposing_load >= 0 else 1
    nuts = (
        _solve_nut(screw, lubricant, point, settings, 'loaded', float(forces[0]), ahead),
        _solve_nut(screw, lubricant, point, settings, 'relieved', float(forces[1]), behind),
    )
    return _combine(screw, point, nuts)


@dataclass(frozen=True, kw_only=True, slots=True)
class _Nut:
    """One nut: its axial force [N], contacts and ball, None without load or after a failure."""

    name: Nut
    force: float
    contacts: tuple[ScrewContact, ...]
    ball: BallBalance | None
    failure: str = ''


def _solve_nut(
    screw: Screw,
    lubricant: Lubricant,
    point: OperatingPoint,
    settings: ScrewSettings,
    name: Nut,
    force: float,
    flank: Flank,
) -> _Nut:
    """Solve both contacts of a nut under an axial force [N] and balance its ball."""
    if force == 0:
        idle = tuple(_contact(screw, name, side, None, None, None) for side in SIDES)
        return _Nut(name=name, force=force, contacts=idle, ball=None)
    load = float(normal_force(screw, force))
    pairs = [_solve_side(screw, lubricant, point, settings, side, load) for side in SIDES]
    failure, ball = _failure(name, pairs), None
    if not failure:
        ball = _balance(screw, point, force, flank, [rough for _, rough in pairs])
        failure = '' if ball.converged else f'{name} nut, ball: {ball.status.value}'
    contacts = tuple(
        _contact(screw, name, side, *pair, ball) for side, pair in zip(SIDES, pairs, strict=True)
    )
    return _Nut(name=name, force=force, contacts=contacts, ball=ball, failure=failure)


def _failure(name: Nut, pairs: list[tuple[ContactSolution, ContactSolution]]) -> str:
    """Return the sentence of the first contact that did not converge, or nothing."""
    for side, pair in zip(SIDES, pairs, strict=True):
        for kind, found in zip(('smooth', 'rough'), pair, strict=True):
            if not found.converged:
                return f'{name} nut, {side}, {kind} contact: {found.status.value}'
    return ''


def _contact(
    screw: Screw,
    nut: Nut,
    side: Side,
    smooth: ContactSolution | None,
    rough: ContactSolution | None,
    ball: BallBalance | None,
) -> ScrewContact:
    """Return one contact with its part of the balance."""
    part = BallContact() if ball is None else ball.screw if side == 'screw' else ball.nut
    film = math.nan if smooth is None or not smooth.condition.entrainment_speed else best(smooth)
    return ScrewContact(
        nut=nut,
        side=side,
        smooth=smooth,
        rough=rough,
        ball=part,
        film_ratio=film / screw.roughness.rms,
    )


def best(smooth: ContactSolution) -> float:
    """Return the central film [m], extrapolated where the half grid was solved."""
    extrapolated = smooth.extrapolated_film
    return smooth.central_film if math.isnan(extrapolated) else extrapolated


def _solve_side(
    screw: Screw,
    lubricant: Lubricant,
    point: OperatingPoint,
    settings: ScrewSettings,
    side: Side,
    load: float,
) -> tuple[ContactSolution, ContactSolution]:
    """Return the smooth and the rough contact under a normal force [N]."""
    oil = lubricant_state(lubricant, point.temperature)
    contact = screw_contact(screw, side)
    speed = no_slip_rates(screw).entrainment * abs(point.speed)
    condition = Condition(load=load, entrainment_speed=speed)
    fluid = ContactLubricant(
        viscosity=float(oil.viscosity),
        pressure_viscosity=float(oil.pressure_viscosity),
        eyring_stress=oil.eyring_stress,
    )
    smooth = solve_contact(contact, fluid, condition, settings=settings.smooth)
    if settings.draw is None or not smooth.converged:
        return smooth, smooth
    surface = raceway_patch(screw, side, settings)
    rough = solve_contact(
        contact, fluid, condition, roughness=surface.heights, settings=settings.rough
    )
    return smooth, rough


def raceway_patch(screw: Screw, side: Side, settings: ScrewSettings) -> FractalSurface:
    """
    Return the draw that a contact sees, rescaled once over a window that no load moves.

    The window is the Hertz rectangle under the load that relieves the other nut.

    """
    force = UNLOADING_RATIO * screw.preload or WINDOW_SHARE * screw.static_rating
    ellipse = hertz(screw_contact(screw, side), float(normal_force(screw, force)))
    window = Window(
        length_x=2 * float(ellipse.semi_axis_x), length_y=2 * float(ellipse.semi_axis_y)
    )
    roughness = screw.roughness
    if settings.grid_wavelength is not None:
        longest = max(settings.grid_wavelength, roughness.shortest_wavelength)
        roughness = replace(roughness, shortest_wavelength=longest)
    return take_patch(
        fractal_surface(roughness, settings.draw or 0), 'rescaled', window, roughness.rms
    )


def _balance(
    screw: Screw, point: OperatingPoint, force: float, flank: Flank, rough: list[ContactSolution]
) -> BallBalance:
    """Balance one ball of a nut that carries an axial `force` [N]."""
    speed = abs(point.speed) or CREEP
    floor = slip_floor(screw, speed)
    friction = screw.roughness.asperity_friction
    tractions = [
        solved_traction(found, asperity_friction=friction, slip_floor=floor) for found in rough
    ]
    rolling = [found.rolling_force + found.rolling_tail for found in rough]
    return balance_ball(
        screw,
        speed,
        screw_traction=tractions[0],
        nut_traction=tractions[1],
        axial_force=force / screw.loaded_balls_per_nut,
        flank=flank,
        screw_rolling_force=rolling[0],
        nut_rolling_force=rolling[1],
    )


def _combine(screw: Screw, point: OperatingPoint, nuts: tuple[_Nut, _Nut]) -> ScrewSolution:
    """Add up both nuts."""
    speed, load = abs(point.speed), point.opposing_load
    found = ScrewSolution(
        status=next((nut.failure for nut in nuts if nut.failure), SOLVED),
        converged=not any(nut.failure for nut in nuts),
        contacts=nuts[0].contacts + nuts[1].contacts,
        entrainment_speed=no_slip_rates(screw).entrainment * speed,
        normal_forces=tuple(float(normal_force(screw, nut.force)) for nut in nuts),
    )
    if not found.converged:
        return found
    parasitic = screw.parasitic_torque + screw.parasitic_torque_rate * speed
    balls = [nut.ball for nut in nuts if nut.ball is not None]
    friction = screw.loaded_balls_per_nut * sum(ball.loss_torque for ball in balls) + parasitic
    driving = screw.loaded_balls_per_nut * sum(ball.torque for ball in balls) + parasitic
    missed = driving - driving_torque(friction, load, screw.lead)
    return replace(
        found,
        friction_torque=friction,
        driving_torque=driving,
        energy_error=abs(missed) / friction if friction else 0.0,
        efficiency=efficiency(friction, load, screw.lead),
        back_driving=is_back_driving(friction, load, screw.lead),
        load_change=_load_change(screw, nuts),
        **_worst(found.contacts),
    )


def _load_change(screw: Screw, nuts: tuple[_Nut, _Nut]) -> float:
    """Return the largest relative change of a normal force by friction [-]."""
    changes = [
        abs(contact.ball.normal_force / float(normal_force(screw, nut.force)) - 1)
        for nut in nuts
        for contact in nut.contacts
        if nut.ball is not None
    ]
    return max(changes, default=0.0)


def _worst(contacts: tuple[ScrewContact, ...]) -> dict[str, float]:
    """Return RCS and asperity share of the worst contact, film and its ratio of the thinnest."""
    pressed = [contact for contact in contacts if contact.rough is not None]
    rough = [contact.rough for contact in pressed if contact.rough is not None]
    films = [contact.film_ratio for contact in pressed if contact.film_ratio > 0]
    smooth = [
        best(contact.smooth)
        for contact in pressed
        if contact.smooth is not None and contact.film_ratio > 0
    ]
    return {
        'rcs': max((found.rcs for found in rough), default=0.0),
        'asperity_share': max((found.asperity_share for found in rough), default=0.0),
        'film_ratio': min(films, default=math.nan if not rough else 0.0),
        'central_film': min(smooth, default=math.nan if not rough else 0.0),
    }
