# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
One nut of the screw in the full tier: its two contacts, solved, and the balance of its balls.

A ball has a contact with the screw and one with the nut; both are solved, smooth for the film
ratio and rough for what asperities carry. Their tractions and rolling couples balance the ball.

"""

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
import math
from typing import Literal

from surrogate.ball_balance import balance_ball
from surrogate.ball_motion import BallMotion, Flank, slip_floor
from surrogate.ball_result import BallBalance, BallContact
from surrogate.ball_traction import solved_traction
from surrogate.ehl import Condition, ContactLubricant, ContactSolution, Settings, solve_contact
from surrogate.geometry import hertz, screw_contact, Side, SIDES
from surrogate.kinematics import no_slip_rates
from surrogate.load_sharing import normal_force, UNLOADING_RATIO
from surrogate.lubricant import lubricant_state
from surrogate.parameters import InputError, Lubricant, OperatingPoint, Screw, ZERO_CELSIUS
from surrogate.roughness import fractal_surface, FractalSurface, take_patch, Window
from surrogate.subgrid import subgrid_floor, without_short_waves

NutName = Literal['loaded', 'relieved']
Pair = tuple[ContactSolution, ContactSolution]
"""The same contact smooth and rough."""
CREEP = 1e-3
"""Screw speed of the limit of slow motion [rad/s]."""
ACROSS, MOST_NODES = 2.42, 513
"""Width of a rough domain over the semi-axis across, most nodes there by the wavelength [-]."""
NEGLECTED_FRICTION = 3e-4
"""Share of the friction of a contact on nodes that the balance leaves out [-]."""
WINDOW_SHARE = 0.05
"""Least axial load whose Hertz rectangle is the window of the patch, over the rating [-]."""


@dataclass(frozen=True, kw_only=True, slots=True)
class ScrewSettings:
    """
    How to solve a screw.

    Settings of the smooth and of the rough contacts, but for the film floor, which is that of the
    datasheet; draw of the roughness, None for smooth raceways; shortest wavelength on the grid
    [m], shorter ones raise the floor, None to solve them all; nodes per such wave across the
    track, up to `MOST_NODES`, if that is more than the rough settings have [-].

    """

    smooth: Settings = field(default_factory=Settings)
    rough: Settings = field(default_factory=lambda: Settings(nx=129, ny=257, error_estimate=False))
    draw: int | None = 0
    grid_wavelength: float | None = 16e-6
    nodes_per_wave: float = 6.0


@dataclass(frozen=True, kw_only=True, slots=True)
class ScrewContact:
    """
    One contact of one nut; solutions are None where it carries no load.

    Smooth and rough solution, the part of the ball balance at this contact, the motion of the
    ball, film ratio [-].

    """

    nut: NutName
    side: Side
    smooth: ContactSolution | None
    rough: ContactSolution | None
    ball: BallContact
    motion: BallMotion | None
    film_ratio: float


@dataclass(frozen=True, kw_only=True, slots=True)
class Nut:
    """One nut: its axial force [N], contacts, ball (None without load or solved contacts)."""

    name: NutName
    force: float
    contacts: tuple[ScrewContact, ...]
    ball: BallBalance | None
    failure: str = ''


def solve_sides(
    screw: Screw,
    lubricant: Lubricant,
    point: OperatingPoint,
    settings: ScrewSettings,
    force: float,
    start: Sequence[ScrewContact] = (),
) -> tuple[Pair, ...]:
    """
    Solve the contacts of a nut under an axial force [N], with the screw and with the nut.

    `start` holds both contacts of a neighbouring point. No pairs for a nut without load.

    """
    if force == 0:
        return ()
    load = float(normal_force(screw, force))
    known = [(found.smooth, found.rough) for found in start] or [(None, None)] * len(SIDES)
    return tuple(
        _solve_side(screw, lubricant, point, settings, side, load, near)
        for side, near in zip(SIDES, known, strict=True)
    )


def make_nut(
    screw: Screw,
    point: OperatingPoint,
    name: NutName,
    force: float,
    flank: Flank,
    pairs: tuple[Pair, ...],
) -> Nut:
    """Balance the ball of a nut with an axial force [N] between its solved contacts."""
    if not pairs:
        idle = tuple(_contact(screw, name, side, None, None, None) for side in SIDES)
        return Nut(name=name, force=force, contacts=idle, ball=None)
    failure, ball = _failure(name, pairs), None
    if not failure:
        ball = _balance(screw, point, force, flank, [rough for _, rough in pairs])
        failure = '' if ball.converged else f'{name} nut, ball: {ball.status.value}'
    contacts = tuple(
        _contact(screw, name, side, *pair, ball) for side, pair in zip(SIDES, pairs, strict=True)
    )
    return Nut(name=name, force=force, contacts=contacts, ball=ball, failure=failure)


def _failure(name: NutName, pairs: tuple[Pair, ...]) -> str:
    """Return the sentence of the first contact that did not converge, or nothing."""
    for side, pair in zip(SIDES, pairs, strict=True):
        for kind, found in zip(('smooth', 'rough'), pair, strict=True):
            if not found.converged:
                return f'{name} nut, {side}, {kind} contact: {found.status.value}'
    return ''


def _contact(
    screw: Screw,
    nut: NutName,
    side: Side,
    smooth: ContactSolution | None,
    rough: ContactSolution | None,
    ball: BallBalance | None,
) -> ScrewContact:
    """Return one contact with its part of the balance."""
    part = BallContact() if ball is None else ball.screw if side == 'screw' else ball.nut
    film = math.nan if smooth is None else smooth_film(smooth)
    return ScrewContact(
        nut=nut,
        side=side,
        smooth=smooth,
        rough=rough,
        ball=part,
        motion=ball.motion if ball else None,
        film_ratio=film / screw.roughness.rms,
    )


def smooth_film(smooth: ContactSolution) -> float:
    """Return the central film [m], extrapolated where the half grid was solved; 0 at rest."""
    if not smooth.condition.entrainment_speed:
        return 0.0
    extrapolated = smooth.extrapolated_film
    return smooth.central_film if math.isnan(extrapolated) else extrapolated


def _solve_side(
    screw: Screw,
    lubricant: Lubricant,
    point: OperatingPoint,
    settings: ScrewSettings,
    side: Side,
    load: float,
    start: tuple[ContactSolution | None, ContactSolution | None],
) -> Pair:
    """Return the smooth and the rough contact under a normal force [N], from a near pair."""
    contact = screw_contact(screw, side)
    speed = no_slip_rates(screw).entrainment * abs(point.speed)
    condition = Condition(load=load, entrainment_speed=speed)
    fluid = _fluid(lubricant, point.temperature)
    smooth = solve_contact(
        contact,
        fluid,
        condition,
        settings=replace(settings.smooth, film_floor=screw.roughness.film_floor),
        start=start[0],
    )
    if settings.draw is None or not smooth.converged:
        return smooth, smooth
    surface = raceway_patch(screw, side, settings.draw)
    floor = screw.roughness.film_floor
    cut = settings.grid_wavelength
    if cut is not None and cut < screw.roughness.sample_length:
        floor += subgrid_floor(surface, cut)
        surface = without_short_waves(surface, cut)
    rough = solve_contact(
        contact,
        fluid,
        condition,
        roughness=surface.heights,
        settings=replace(
            settings.rough,
            film_floor=floor,
            ny=_nodes_across(settings, smooth.semi_axis_y, surface.shortest_wavelength),
        ),
        start=start[1],
    )
    return smooth, rough


def _fluid(lubricant: Lubricant, temperature: float) -> ContactLubricant:
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
    surface, cut = fractal_surface(screw.roughness, settings.draw), settings.grid_wavelength
    if cut is not None and cut < screw.roughness.sample_length:
        surface = without_short_waves(surface, cut)
    return surface.shortest_wavelength


def _nodes_across(settings: ScrewSettings, semi_axis: float, wave: float) -> int:
    """Return the nodes that a semi-axis and a shortest wave [m] ask for, within the bounds."""
    wanted = 2 * math.ceil(settings.nodes_per_wave * ACROSS * semi_axis / wave / 2) + 1
    return max(settings.rough.ny, min(wanted, MOST_NODES))


def raceway_patch(screw: Screw, side: Side, draw: int) -> FractalSurface:
    """
    Return one draw of the raceway, rescaled once over a window that no load moves.

    The window is the Hertz rectangle under the load that relieves the other nut, or under
    `WINDOW_SHARE` of the static rating where that is larger.

    """
    force = max(UNLOADING_RATIO * screw.preload, WINDOW_SHARE * screw.static_rating)
    ellipse = hertz(screw_contact(screw, side), float(normal_force(screw, force)))
    window = Window(
        length_x=2 * float(ellipse.semi_axis_x), length_y=2 * float(ellipse.semi_axis_y)
    )
    surface = fractal_surface(screw.roughness, draw)
    return take_patch(surface, 'rescaled', window, screw.roughness.rms)


def _balance(
    screw: Screw, point: OperatingPoint, force: float, flank: Flank, rough: list[ContactSolution]
) -> BallBalance:
    """Balance one ball of a nut that carries an axial `force` [N]."""
    speed = abs(point.speed) or CREEP
    floor = slip_floor(screw, speed)
    friction = screw.roughness.asperity_friction
    tractions = [
        solved_traction(
            found, asperity_friction=friction, slip_floor=floor, neglected=NEGLECTED_FRICTION
        )
        for found in rough
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
