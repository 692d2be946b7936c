# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
One nut of the screw in the full tier: its two contacts, solved, and the balance of its balls.

A ball has a contact with the screw and one with the nut. Their tractions and rolling couples
balance the ball.

"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
import math

import numpy as np
from surrogate.ehl import ContactSolution
from surrogate.ehl.friction import contact_friction
from surrogate.formulas.film import film_ratio
from surrogate.formulas.geometry import opposite_flank_approach, Side, SIDES
from surrogate.formulas.load_sharing import NutName
from surrogate.formulas.sliding import hysteresis_force
from surrogate.parameters import OperatingPoint, Screw
from surrogate.results import number
from surrogate.screw.ball_balance import balance_ball
from surrogate.screw.ball_equations import BallFlank
from surrogate.screw.ball_motion import Array, BallMotion, Flank, slip_field, slip_floor
from surrogate.screw.ball_result import BallBalance, BallContact
from surrogate.screw.ball_traction import FREE, solved_traction
from surrogate.screw.contacts import RollingContact, smooth_film, solve_sides, SolvedContact
from surrogate.screw.point import PointContact

CREEP = 1e-3
"""Screw speed of the limit of slow motion [rad/s]."""
COUPLING_ROUNDS = 4
"""Most times that contacts are solved again under the forces of the balance [-]."""
FLOATING_SHARE = 0.02
"""Share of the load of the other nut below which a nut that is not solved counts as idle [-]: its
balls float on films thicker than their approach."""
NEGLECTED_FRICTION = 3e-4
"""Share of the friction of a contact on nodes that the balance leaves out [-]."""


@dataclass(frozen=True, kw_only=True, slots=True)
class ScrewContact(PointContact[float]):
    """
    One contact of one nut; `solved` is None where it carries no load.

    Solutions and asperity contact, the part of the ball balance at this contact, the motion of
    the ball; contact angle [rad], largest pressure [Pa], estimated relative error of the film [-],
    how far the ball comes towards the opposite flank [m].

    """

    solved: SolvedContact | None
    ball: BallContact
    motion: BallMotion | None
    contact_angle: float = number('rad')
    max_pressure: float = number('Pa')
    film_error: float = number()
    opposite_flank_approach: float = number('m')

    @property
    def smooth(self) -> ContactSolution | None:
        """Return the smooth contact."""
        return self.solved.smooth if self.solved else None

    @property
    def pressed(self) -> ContactSolution | None:
        """Return the contact whose pressures and films the ball feels."""
        return self.solved.pressed if self.solved else None


@dataclass(frozen=True, kw_only=True, slots=True)
class NutLoad:
    """What a nut carries: its axial force [N] and the flanks that it presses."""

    nut: NutName
    force: float
    flank: Flank


@dataclass(frozen=True, kw_only=True, slots=True)
class SolvedNut:
    """One nut: its axial force [N], contacts, ball (None without load or solved contacts)."""

    force: float
    contacts: tuple[ScrewContact, ...]
    ball: BallBalance | None
    failure: str = ''


def solve_nut(
    screw: Screw,
    point: OperatingPoint,
    carried: NutLoad,
    contacts: Sequence[RollingContact],
    solved: tuple[SolvedContact, ...],
    *,
    tolerance: float,
) -> SolvedNut:
    """
    Balance the ball of a nut between its `contacts`, `solved` without friction.

    Friction and inertia move the normal forces; where by more than the `tolerance` [-], contacts
    are solved again under the forces found, until they agree or `COUPLING_ROUNDS`.

    """
    nut = make_nut(screw, point, carried, solved)
    for _ in range(COUPLING_ROUNDS):
        if not load_change(nut) > tolerance:
            break
        first, second = (contact.ball.normal_force for contact in nut.contacts)
        nut = make_nut(screw, point, carried, solve_sides(contacts, (first, second)))
    return nut


def load_change(nut: SolvedNut) -> float:
    """Return the largest change of a normal force by friction over that solved [-], or NaN."""
    changes = [
        abs(contact.ball.normal_force / contact.pressed.condition.load - 1)
        for contact in nut.contacts
        if contact.pressed is not None
    ]
    return max(changes, default=0.0)


def make_nut(
    screw: Screw, point: OperatingPoint, carried: NutLoad, solved: Sequence[SolvedContact]
) -> SolvedNut:
    """Balance the ball of a nut between its solved contacts."""
    if carried.force == 0:
        return balanced_nut(screw, carried, (None, None), None)
    failure, ball = contact_failure(carried.nut, solved), None
    if not failure:
        ball = balance_nut(screw, point, carried.force, carried.flank, solved)
    return balanced_nut(screw, carried, solved, ball, failure)


def balanced_nut(
    screw: Screw,
    carried: NutLoad,
    solved: Sequence[SolvedContact | None],
    ball: BallBalance | None,
    failure: str = '',
) -> SolvedNut:
    """Return a nut by its contacts, None without load, and the balance of its ball."""
    if ball is not None and not ball.converged:
        failure = f'{carried.nut} nut, ball: {ball.status.value}'
    contacts = tuple(
        _contact(screw, carried.nut, side, contact, ball)
        for side, contact in zip(SIDES, solved, strict=True)
    )
    return SolvedNut(force=carried.force, contacts=contacts, ball=ball, failure=failure)


def contact_failure(name: NutName, solved: Sequence[SolvedContact | None]) -> str:
    """Return the sentence of the first contact that did not converge, or nothing."""
    for side, contact in zip(SIDES, solved, strict=True):
        if contact is not None and not contact.converged:
            return f'{name} nut, {side}, smooth contact: {contact.smooth.status.value}'
    return ''


def _contact(
    screw: Screw, nut: NutName, side: Side, solved: SolvedContact | None, ball: BallBalance | None
) -> ScrewContact:
    part = BallContact() if ball is None else ball.screw if side == 'screw' else ball.nut
    motion = ball.motion if ball else None
    idle = ScrewContact(
        nut=nut, side=side, solved=solved, ball=part, motion=motion, normal_force=0.0
    )
    if solved is None:
        return idle
    pressed, film = solved.pressed, smooth_film(solved.smooth)
    speed, friction = math.nan, math.nan
    if motion is not None:
        speed = motion.screw_speed
        friction = friction_coefficient(screw, solved, side, motion)
    return replace(
        idle,
        normal_force=part.normal_force,
        contact_angle=part.angle,
        semi_axis_x=pressed.semi_axis_x,
        semi_axis_y=pressed.semi_axis_y,
        hertz_pressure=pressed.hertz_pressure,
        max_pressure=pressed.max_pressure,
        central_film=film,
        film_error=solved.smooth.film_error,
        minimum_film=pressed.minimum_film,
        film_ratio=float(film_ratio(film, screw.composite_rms)),
        rcs=solved.asperities.rcs,
        asperity_share=solved.asperities.asperity_share,
        friction_coefficient=friction,
        rolling_force=rolling_force(screw, solved),
        opposite_flank_approach=opposite_flank_approach(screw, side, part.angle, pressed.approach),
        sliding_torque=screw.loaded_balls_per_nut * part.slip_power / speed,
        rolling_torque=screw.loaded_balls_per_nut * part.rolling_power / speed,
    )


def balance_nut(
    screw: Screw,
    point: OperatingPoint,
    force: float,
    flank: Flank,
    solved: Sequence[SolvedContact],
) -> BallBalance:
    """Balance one ball of a nut that carries an axial `force` [N] between two solved contacts."""
    on_screw, on_nut = flanks_of(screw, point, flank, solved)
    return balance_ball(
        screw,
        abs(point.speed) or CREEP,
        screw_traction=on_screw.traction,
        nut_traction=on_nut.traction,
        axial_force=force / screw.loaded_balls_per_nut,
        flank=flank,
        screw_rolling_force=on_screw.rolling_force,
        nut_rolling_force=on_nut.rolling_force,
    )


def flanks_of(
    screw: Screw, point: OperatingPoint, flank: Flank, solved: Sequence[SolvedContact | None]
) -> tuple[BallFlank, ...]:
    """Return the flanks of screw and nut by a ball, with their friction, none without contact."""
    floor = slip_floor(screw, abs(point.speed) or CREEP)
    return tuple(
        BallFlank(
            side=side,
            flank=flank,
            traction=solved_traction(
                contact.pressed,
                asperity_friction=screw.roughness.asperity_friction,
                asperity_share=contact.friction_share,
                slip_floor=floor,
                neglected=NEGLECTED_FRICTION,
            ),
            rolling_force=rolling_force(screw, contact),
        )
        if contact is not None
        else BallFlank(side=side, flank=flank, traction=FREE, rolling_force=0.0)
        for side, contact in zip(SIDES, solved, strict=True)
    )


def rolling_force(screw: Screw, solved: SolvedContact) -> float:
    """Return the force that resists rolling on each surface [N]: oil, inlet tail, hysteresis."""
    pressed = solved.pressed
    elastic = hysteresis_force(
        screw.hysteresis_loss,
        pressed.condition.load,
        pressed.semi_axis_x,
        pressed.contact.radius_x,
    )
    return solved.asperities.loss_factor * pressed.whole_rolling_force + elastic


def friction_coefficient(
    screw: Screw, solved: SolvedContact, side: Side, motion: BallMotion
) -> float:
    """Return the mean traction against the slip over the load [-] at the motion of the ball."""
    slip_x, slip_y = contact_slip(screw, solved.pressed, side, motion)
    return contact_friction(
        solved.pressed,
        slip_x=slip_x,
        slip_y=slip_y,
        asperity_friction=screw.roughness.asperity_friction,
        asperity_share=solved.friction_share,
        slip_floor=slip_floor(screw, motion.screw_speed),
    ).coefficient


def contact_slip(
    screw: Screw, solution: ContactSolution, side: Side, motion: BallMotion
) -> tuple[Array, Array]:
    """Return the slip along and across the track [m/s] on the nodes of a contact."""
    x, y = np.meshgrid(solution.x, solution.y, indexing='ij')
    turn = 1 if side == 'screw' else -1  # the nut's entrainment runs against t
    return slip_field(screw, side, motion, turn * x, turn * y)
