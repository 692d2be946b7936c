# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Equations of the quasi-static balance of one ball, and what a solution of them means.

Three forces and three moments balance; where the axial force is given it is an equation too. A
ball between two flanks touches at two places: unknowns are their contact angles, the normal force
on the nut, orbit rate, rotation and, with the axial force, the normal force on the screw; the
contact angles close by (beta_A + beta_B)/2 = beta. After Lin, Velinsky, Ravani, J. Mech. Des. 116
(1994) 849, with the exact slip. A ball that is larger than the room between screw and nut touches
all four flanks: unknowns are the place of its centre, the axial shift of the nut, orbit rate and
rotation; the place decides the four angles and, by Hertz, the four normal forces.

"""

from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass, field
import math
from typing import Any

import numpy as np
from surrogate.formulas.geometry import conformity, helix_angle, hertz, screw_contact, Side, SIDES
from surrogate.parameters import Screw
from surrogate.screw.ball_motion import (
    Array,
    axis_vector,
    BallMotion,
    contact_frame,
    Flank,
    four_point_motion,
    no_slip_motion,
    relative_motion,
    Vector,
)
from surrogate.screw.ball_traction import integrate_traction, Traction, Wrench

COMPLEX_STEP = 1e-30
SCREW_ANGLE, NUT_ANGLE, NUT_FORCE, ORBIT, ROTATION, SCREW_FORCE = 0, 1, 2, 3, slice(4, 7), 7
CENTRE, SHIFT = slice(0, 2), 2
"""Unknowns of a ball at four flanks [m]; orbit and rotation stand where those of two have them."""


@dataclass(frozen=True, kw_only=True, slots=True)
class BallFlank:
    """
    A flank that a ball touches: side, place, friction law, rolling force [N].

    The flank of the screw lies at cos(beta) n + flank sin(beta) b of the ball, that of the nut
    with the same sign across the ball.

    """

    side: Side
    flank: Flank
    traction: Traction
    rolling_force: float


@dataclass(frozen=True, kw_only=True)
class BallProblem(ABC):
    """
    One ball between screw and nut.

    Screw `speed` [rad/s], not zero; `flanks` that the ball touches, first that of the screw and
    that of the nut which carry the load; their normal force without friction [N], by which forces
    are scaled; axial force [N] along that flank, None where the normal force on the screw is given
    instead; `slip_floor` [m/s] is taken where that of a friction law is smaller. Derived: unit
    vector of the axis [-], rolling couples on the ball about e_p at each flank [N m], sizes that
    matter of the unknowns.

    """

    screw: Screw
    speed: float
    flanks: tuple[BallFlank, ...]
    force_unit: float
    axial_force: float | None
    slip_floor: float = 0.0
    axis: Array = field(init=False)
    couples: tuple[float, ...] = field(init=False)
    scales: Array = field(init=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, 'axis', axis_vector(self.screw))
        # The pressure centre lies upstream: M_r = -integral x p dA = 2 Rx F_roll along e_p where
        # the entrainment is along t.
        couples = tuple(
            2
            * self.direction(place)
            * screw_contact(self.screw, place.side).radius_x
            * place.rolling_force
            for place in self.flanks
        )
        object.__setattr__(self, 'couples', couples)
        # The size of each rate that matters: as the helical slip has it.
        slow = self.speed * math.sin(helix_angle(self.screw))
        orbit = 0.5 * slow * self.screw.ball_diameter / self.screw.pitch_radius
        object.__setattr__(self, 'scales', self._scales([orbit, slow, slow, slow]))

    @abstractmethod
    def _scales(self, rates: list[float]) -> Array:
        """Return the sizes that matter of all unknowns, with those of orbit and rotation."""

    @abstractmethod
    def angles(self, values: Vector) -> Sequence[Any]:
        """Return the contact angle at each flank [rad] for unscaled unknowns."""

    @abstractmethod
    def normal_forces(self, values: Vector) -> Sequence[Any]:
        """Return the normal force at each flank [N] for unscaled unknowns."""

    @abstractmethod
    def closure(self, values: Vector) -> list[Any]:
        """Return what unscaled unknowns miss beside balance and axial force."""

    @abstractmethod
    def frictionless(self) -> Array:
        """Return the scaled unknowns [-] of the ball without friction."""

    @property
    def flank(self) -> Flank:
        """Flank that carries the load."""
        return self.flanks[0].flank

    @property
    def mass(self) -> float:
        """Mass of the ball [kg]."""
        return math.pi / 6 * self.screw.ball.density * self.screw.ball_diameter**3

    def direction(self, place: BallFlank) -> float:
        """Return the sense of the entrainment along t at a flank, 1 or -1."""
        return math.copysign(1.0, self.speed if place.side == 'screw' else -self.speed)


class TwoPointBall(BallProblem):
    """A ball between one flank of the screw and one of the nut."""

    def _scales(self, rates: list[float]) -> Array:
        forces = [] if self.axial_force is None else [self.force_unit]
        return np.array([1.0, 1.0, self.force_unit, *rates, *forces])

    def angles(self, values: Vector) -> Sequence[Any]:
        """Return both contact angles [rad] for unscaled unknowns."""
        return values[SCREW_ANGLE], values[NUT_ANGLE]

    def normal_forces(self, values: Vector) -> Sequence[Any]:
        """Return both normal forces [N] for unscaled unknowns."""
        on_screw = self.force_unit if self.axial_force is None else values[SCREW_FORCE]
        return on_screw, values[NUT_FORCE]

    def closure(self, values: Vector) -> list[Any]:
        """Return what the mean of the contact angles misses [rad]."""
        return [0.5 * (values[SCREW_ANGLE] + values[NUT_ANGLE]) - self.screw.contact_angle]

    def frictionless(self) -> Array:
        """Return the scaled unknowns [-] of the ball that rolls without gross slip."""
        motion = no_slip_motion(self.screw, self.speed, self.flank)
        angle, force = self.screw.contact_angle, self.force_unit
        forces = [] if self.axial_force is None else [force]
        values = [angle, angle, force, motion.orbit_rate, *motion.rotation, *forces]
        return np.array(values) / self.scales


@dataclass(frozen=True, kw_only=True)
class FourPointBall(BallProblem):
    """
    A ball between both flanks of screw and nut; the pair that carries more comes first.

    Normal force without friction of the other pair, and of each under preload alone [N], which
    the oversize makes; the ball then touches at the nominal contact angle. Derived: approach under
    1 N on each side [m].

    """

    relieved_force: float
    preload_force: float
    springs: dict[Side, float] = field(init=False)

    def __post_init__(self) -> None:
        springs = {
            side: float(hertz(screw_contact(self.screw, side), 1.0).approach) for side in SIDES
        }
        object.__setattr__(self, 'springs', springs)
        super().__post_init__()

    def _scales(self, rates: list[float]) -> Array:
        size = self.springs['screw'] * self.force_unit ** (2 / 3)
        return np.array([size, size, size, *rates])

    def angles(self, values: Vector) -> Sequence[Any]:
        """Return the four contact angles [rad] for unscaled unknowns."""
        return [np.arctan(b / n) for n, b in self._reaches(values)]

    def normal_forces(self, values: Vector) -> Sequence[Any]:
        """Return the four normal forces [N] by Hertz for unscaled unknowns, 0 of a free flank."""
        forces = []
        for place, (n, b) in zip(self.flanks, self._reaches(values)):
            approach = np.sqrt(n * n + b * b) - self._gap(place.side)
            pressed = np.where(np.real(approach) > 0, approach, 0.0)
            forces.append((pressed / self.springs[place.side]) ** 1.5)
        return forces

    def closure(self, values: Vector) -> list[Any]:
        """Return nothing: the place of the ball decides its angles."""
        return []

    def frictionless(self) -> Array:
        """Return the scaled unknowns [-] of the ball that turns about an axis like the screw's."""
        motion = four_point_motion(self.screw, self.speed)
        apart = self.force_unit ** (2 / 3) - self.relieved_force ** (2 / 3)
        way = self.flank * apart / (2 * math.sin(self.screw.contact_angle))
        centre = [0.0, way * self.springs['screw']]
        shift = way * sum(self.springs.values())
        return np.array([*centre, shift, motion.orbit_rate, *motion.rotation]) / self.scales

    def _gap(self, side: Side) -> float:
        """Return the radius of the groove less that of the ball [m]."""
        return (conformity(self.screw, side) - 0.5) * self.screw.ball_diameter

    def _reaches(self, values: Vector) -> list[tuple[Any, Any]]:
        """Return the way from the centre of each groove to that of the ball, inward and aside."""
        beta, reaches = self.screw.contact_angle, []
        for place in self.flanks:
            sign = 1 if place.side == 'screw' else -1
            reach = self._gap(place.side) + self.springs[place.side] * self.preload_force ** (
                2 / 3
            )
            aside = values[1] if place.side == 'screw' else values[1] - values[SHIFT]
            n = reach * math.cos(beta) + sign * values[0]
            reaches.append((n, reach * math.sin(beta) + sign * place.flank * aside))
        return reaches


def motions(problem: BallProblem, values: Vector) -> list[Vector]:
    """Return the motion against the raceway at each flank [m/s, rad/s] for unscaled unknowns."""
    return [
        relative_motion(
            problem.screw,
            place.side,
            angle=angle,
            flank=place.flank,
            speed=problem.speed,
            orbit=values[ORBIT],
            rotation=values[ROTATION],
        )
        for place, angle in zip(problem.flanks, problem.angles(values))
    ]


def wrenches(problem: BallProblem, unknowns: Array) -> list[Wrench]:
    """Return the friction at each flank for scaled unknowns [-]."""
    values = problem.scales * unknowns
    return [
        integrate_traction(
            problem.screw,
            place.side,
            place.traction,
            float(load),
            motion,
            direction=problem.direction(place),
            slip_floor=problem.slip_floor,
        )
        for place, load, motion in zip(
            problem.flanks, problem.normal_forces(values), motions(problem, values)
        )
    ]


def contact_load(
    problem: BallProblem, which: int, values: Vector, friction: Vector
) -> tuple[Vector, Vector]:
    """
    Return force [N] and moment about the ball centre [N m] on the ball at one flank.

    Normal force along -e, friction (5 rows as in Wrench) and rolling couple; unscaled unknowns.

    """
    place = problem.flanks[which]
    e, across = contact_frame(place.side, problem.angles(values)[which], place.flank)
    track = np.array([1.0, 0.0, 0.0]).reshape(3, *[1] * (e.ndim - 1))
    along_t, along_p, tumble, spin, roll = friction
    normal = problem.normal_forces(values)[which]
    force = along_t * track + along_p * across - normal * e
    return force, tumble * track + spin * e + (roll + problem.couples[which]) * across


def inertia_load(problem: BallProblem, values: Vector) -> tuple[Vector, Vector]:
    """
    Return d'Alembert's force [N] and moment [N m]: -m phi'^2 r_m n and -phi' k x (I W).

    Solid ball, I = 0.4 m r_b^2; unscaled unknowns.

    """
    orbit, turn = values[ORBIT], values[ROTATION]
    inertia = 0.4 * problem.mass * (0.5 * problem.screw.ball_diameter) ** 2
    outward = -problem.mass * problem.screw.pitch_radius * orbit**2
    none = np.zeros_like(outward)
    kt, kn, kb = problem.axis
    turned = np.array([[0.0, -kb, kn], [kb, 0.0, -kt], [-kn, kt, 0.0]]) @ turn
    return np.array([none, outward, none]), -inertia * orbit * turned


def residual(problem: BallProblem, unknowns: Vector, friction: Sequence[Vector]) -> Vector:
    """
    Return what is out of balance [-]: forces, moments, closure and, where given, axial force.

    Over the force unit, and the ball radius for moments. Scaled unknowns [-], friction at each
    flank.

    """
    values = (problem.scales * unknowns.T).T
    unit, screw = problem.force_unit, problem.screw
    loads = [contact_load(problem, which, values, force) for which, force in enumerate(friction)]
    inertia = inertia_load(problem, values)
    forces = (sum(force for force, _ in loads) + inertia[0]) / unit
    moments = (sum(moment for _, moment in loads) + inertia[1]) / (
        unit * 0.5 * screw.ball_diameter
    )
    rows = [*forces, *moments, *problem.closure(values)]
    if problem.axial_force is not None:
        on_screw = sum(
            force for place, (force, _) in zip(problem.flanks, loads) if place.side == 'screw'
        )
        pushed = -problem.flank * (problem.axis @ on_screw)
        rows.append((pushed - problem.axial_force) / unit)
    return np.array(rows)


def linearise(
    problem: BallProblem, unknowns: Array, friction_at: Sequence[Wrench]
) -> tuple[Array, Array]:
    """
    Return the residual and its exact Jacobian [-] at scaled unknowns and the friction there.

    Complex steps through the equations, in which friction follows its own exact derivatives.

    """
    steps = unknowns[:, None] + 1j * COMPLEX_STEP * np.eye(len(unknowns))
    values = problem.scales[:, None] * steps
    loads, moved = problem.normal_forces(values), motions(problem, values)
    friction = [
        wrench.values[:, None]
        + 1j * (wrench.by_motion @ motion.imag + np.outer(wrench.by_load, np.imag(load)))
        for wrench, motion, load in zip(friction_at, moved, loads)
    ]
    jacobian = residual(problem, steps, friction).imag / COMPLEX_STEP
    return residual(problem, unknowns, [wrench.values for wrench in friction_at]), jacobian


def screw_torque(
    problem: BallProblem, which: int, values: Vector, friction: Vector
) -> tuple[float, float]:
    """
    Return torque about the axis [N m] and axial force [N] of a flank of the screw on the ball.

    Moments of all that acts on the ball at the contact, taken about the axis, which passes r_m
    along n from the ball centre; both along k; unscaled unknowns.

    """
    force, moment = contact_load(problem, which, values, friction)
    arm = np.array([0.0, -problem.screw.pitch_radius, 0.0])
    return float(problem.axis @ (np.cross(arm, force) + moment)), float(problem.axis @ force)


def ball_motion(problem: BallProblem, pair: int, values: Array) -> BallMotion:
    """Return the motion of the ball between a pair of its flanks, in unscaled unknowns."""
    turn, angles = values[ROTATION], problem.angles(values)
    return BallMotion(
        screw_speed=problem.speed,
        orbit_rate=float(values[ORBIT]),
        rotation=(float(turn[0]), float(turn[1]), float(turn[2])),
        screw_angle=float(angles[pair]),
        nut_angle=float(angles[pair + 1]),
        flank=problem.flanks[pair].flank,
    )
