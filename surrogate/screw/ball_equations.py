# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Equations of the quasi-static balance of one ball, and what a solution of them means.

Three forces, three moments, the closure (beta_A + beta_B)/2 = beta and, where the axial force is
given instead of the normal force on the screw, the axial force. Unknowns are contact angles,
normal force on the nut, orbit rate, rotation and, with the axial force, normal force on the screw.
After Lin, Velinsky, Ravani, J. Mech. Des. 116 (1994) 849, with the exact slip.

"""

from dataclasses import dataclass, field
import math
from typing import Any

import numpy as np
from surrogate.formulas.geometry import helix_angle, screw_contact, SIDES
from surrogate.parameters import Screw
from surrogate.screw.ball_motion import (
    Array,
    axis_vector,
    BallMotion,
    contact_frame,
    Flank,
    no_slip_motion,
    relative_motion,
    Vector,
)
from surrogate.screw.ball_traction import integrate_traction, Traction, Wrench

COMPLEX_STEP = 1e-30
SCREW_ANGLE, NUT_ANGLE, NUT_FORCE, ORBIT, ROTATION, SCREW_FORCE = 0, 1, 2, 3, slice(4, 7), 7


@dataclass(frozen=True, kw_only=True, slots=True)
class BallProblem:
    """
    One ball between screw and nut.

    Screw `speed` [rad/s], not zero; friction laws and rolling forces [N] on screw and nut; one of
    normal force on the screw and axial force [N] is given, the other None; `slip_floor` [m/s] is
    taken where that of a friction law is smaller. Derived: unit vector of the axis [-], normal
    force without friction [N], entrainment along t, 1 or -1, on screw and nut, rolling couples on
    the ball about e_p there [N m], sizes that matter of the unknowns [rad, N, rad/s].

    """

    screw: Screw
    speed: float
    flank: Flank
    tractions: tuple[Traction, Traction]
    rolling_forces: tuple[float, float]
    normal_force: float | None
    axial_force: float | None
    slip_floor: float = 0.0
    axis: Array = field(init=False)
    force_unit: float = field(init=False)
    directions: tuple[float, float] = field(init=False)
    couples: tuple[float, float] = field(init=False)
    scales: Array = field(init=False)

    def __post_init__(self) -> None:
        """Derive what every evaluation needs."""
        sense = math.copysign(1.0, self.speed)
        object.__setattr__(self, 'axis', axis_vector(self.screw))
        angle, alpha = self.screw.contact_angle, helix_angle(self.screw)
        force = self.normal_force
        if force is None:
            assert self.axial_force is not None
            force = self.axial_force / (math.sin(angle) * math.cos(alpha))
        object.__setattr__(self, 'force_unit', force)
        object.__setattr__(self, 'directions', (sense, -sense))
        # The pressure centre lies upstream: M_r = -integral x p dA = 2 Rx F_roll along e_p where
        # the entrainment is along t.
        first, second = (
            2 * direction * screw_contact(self.screw, side).radius_x * force
            for direction, side, force in zip(self.directions, SIDES, self.rolling_forces)
        )
        object.__setattr__(self, 'couples', (first, second))
        # The size of each unknown that matters: rates as the helical slip has them.
        slow = self.speed * math.sin(alpha)
        rates = [0.5 * slow * self.screw.ball_diameter / self.screw.pitch_radius, slow, slow, slow]
        forces = [] if self.normal_force is not None else [force]
        object.__setattr__(self, 'scales', np.array([1.0, 1.0, force, *rates, *forces]))

    @property
    def mass(self) -> float:
        """Mass of the ball [kg]."""
        return math.pi / 6 * self.screw.ball.density * self.screw.ball_diameter**3


def no_slip_unknowns(problem: BallProblem) -> Array:
    """Return the scaled unknowns [-] of the ball without friction."""
    motion = no_slip_motion(problem.screw, problem.speed, problem.flank)
    angle, force = problem.screw.contact_angle, problem.force_unit
    given = [] if problem.normal_force is not None else [force]
    values = [angle, angle, force, motion.orbit_rate, *motion.rotation, *given]
    return np.array(values) / problem.scales


def normal_forces(problem: BallProblem, values: Vector) -> tuple[Any, Any]:
    """Return the normal forces on screw and nut [N] among unscaled unknowns."""
    known = problem.normal_force
    return (values[SCREW_FORCE] if known is None else known), values[NUT_FORCE]


def motions(problem: BallProblem, values: Vector) -> tuple[Vector, Vector]:
    """Return the motion against screw and nut [m/s, rad/s] for unscaled unknowns."""
    first, second = (
        relative_motion(
            problem.screw,
            side,
            angle=angle,
            flank=problem.flank,
            speed=problem.speed,
            orbit=values[ORBIT],
            rotation=values[ROTATION],
        )
        for side, angle in zip(SIDES, values[[SCREW_ANGLE, NUT_ANGLE]])
    )
    return first, second


def wrenches(problem: BallProblem, unknowns: Array) -> tuple[Wrench, Wrench]:
    """Return the friction on screw and nut for scaled unknowns [-]."""
    values = problem.scales * unknowns
    first, second = (
        integrate_traction(
            problem.screw,
            side,
            traction,
            load,
            motion,
            direction=direction,
            slip_floor=problem.slip_floor,
        )
        for side, traction, load, motion, direction in zip(
            SIDES,
            problem.tractions,
            normal_forces(problem, values),
            motions(problem, values),
            problem.directions,
        )
    )
    return first, second


def contact_load(
    problem: BallProblem, which: int, values: Vector, friction: Vector
) -> tuple[Vector, Vector]:
    """
    Return force [N] and moment about the ball centre [N m] on the ball at one contact.

    Normal force along -e, friction (5 rows as in Wrench) and rolling couple; unscaled unknowns.

    """
    e, across = contact_frame(SIDES[which], values[which], problem.flank)
    track = np.array([1.0, 0.0, 0.0]).reshape(3, *[1] * (e.ndim - 1))
    along_t, along_p, tumble, spin, roll = friction
    normal = normal_forces(problem, values)[which]
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


def residual(problem: BallProblem, unknowns: Vector, friction: tuple[Vector, Vector]) -> Vector:
    """
    Return what is out of balance [-]: forces, moments, closure and, where given, axial force.

    Over the force unit, and the ball radius for moments. Scaled unknowns [-], friction on screw
    and nut.

    """
    values = (problem.scales * unknowns.T).T
    unit, screw = problem.force_unit, problem.screw
    first = contact_load(problem, 0, values, friction[0])
    second = contact_load(problem, 1, values, friction[1])
    inertia = inertia_load(problem, values)
    forces = (first[0] + second[0] + inertia[0]) / unit
    moments = (first[1] + second[1] + inertia[1]) / (unit * 0.5 * screw.ball_diameter)
    closure = 0.5 * (values[SCREW_ANGLE] + values[NUT_ANGLE]) - screw.contact_angle
    rows = [*forces, *moments, closure]
    if problem.axial_force is not None:
        pushed = -problem.flank * (problem.axis @ first[0])
        rows.append((pushed - problem.axial_force) / unit)
    return np.array(rows)


def linearise(
    problem: BallProblem, unknowns: Array, both: tuple[Wrench, Wrench]
) -> tuple[Array, Array]:
    """
    Return the residual and its exact Jacobian [-] at scaled unknowns and the friction there.

    Complex steps through the equations, in which friction follows its own exact derivatives.

    """
    steps = unknowns[:, None] + 1j * COMPLEX_STEP * np.eye(len(unknowns))
    values = problem.scales[:, None] * steps
    loads, moved = normal_forces(problem, values), motions(problem, values)
    friction = [
        wrench.values[:, None]
        + 1j * (wrench.by_motion @ motion.imag + np.outer(wrench.by_load, np.imag(load)))
        for wrench, motion, load in zip(both, moved, loads)
    ]
    jacobian = residual(problem, steps, (friction[0], friction[1])).imag / COMPLEX_STEP
    return residual(problem, unknowns, (both[0].values, both[1].values)), jacobian


def screw_torque(problem: BallProblem, values: Vector, friction: Vector) -> tuple[float, float]:
    """
    Return torque about the axis [N m] and axial force [N] that the screw exerts on the ball.

    Moments of all that acts on the ball at the contact with the screw, taken about the axis, which
    passes r_m along n from the ball centre; both along k; unscaled unknowns.

    """
    force, moment = contact_load(problem, 0, values, friction)
    arm = np.array([0.0, -problem.screw.pitch_radius, 0.0])
    return float(problem.axis @ (np.cross(arm, force) + moment)), float(problem.axis @ force)


def ball_motion(problem: BallProblem, values: Array) -> BallMotion:
    """Return the motion of the ball in unscaled unknowns."""
    turn = values[ROTATION]
    return BallMotion(
        screw_speed=problem.speed,
        orbit_rate=float(values[ORBIT]),
        rotation=(float(turn[0]), float(turn[1]), float(turn[2])),
        screw_angle=float(values[SCREW_ANGLE]),
        nut_angle=float(values[NUT_ANGLE]),
        flank=problem.flank,
    )
