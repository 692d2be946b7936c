# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Motion of one ball between screw and nut: the exact slip of its surface at both contacts.

Vectors are components along t (the track), n (towards the axis) and b = t x n; the axis is k =
sin(alpha) t + cos(alpha) b. The nut stands and the screw turns about k. A contact lies in the
direction e from the ball centre, across its track runs e_p = t x e.

"""

from dataclasses import dataclass
import math
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray
from surrogate.formulas.geometry import helix_angle, Side
from surrogate.formulas.kinematics import heathcote_radius, no_slip_rates
from surrogate.parameters import Screw

Array = NDArray[np.float64]
Vector = NDArray[Any]
"""Components along the first axis, real or complex."""
Flank = Literal[1, -1]
"""Side of the thread that carries: the contact on the screw lies at cos(beta) n + flank sin(beta)
b."""

SLIP_FLOOR, SLIP_FLOOR_SHARE = 1e-4, 0.01
"""Largest floor of the slip speed [m/s], and its share of the helical slip below that [-]."""


@dataclass(frozen=True, kw_only=True, slots=True)
class BallMotion:
    """
    Motion of a loaded ball.

    Screw speed [rad/s], orbit rate of the ball centre about the axis [rad/s], rotation of the ball
    along t, n, b [rad/s], contact angles on screw and nut [rad], loaded flank, 1 or -1.

    """

    screw_speed: float
    orbit_rate: float
    rotation: tuple[float, float, float]
    screw_angle: float
    nut_angle: float
    flank: Flank


def axis_vector(screw: Screw) -> Array:
    """Return the unit vector of the screw axis along t, n, b [-]."""
    alpha = helix_angle(screw)
    return np.array([math.sin(alpha), 0.0, math.cos(alpha)])


def contact_frame(side: Side, angle: Any, flank: Flank) -> tuple[Vector, Vector]:
    """
    Return e, from the ball centre to the contact, and e_p = t x e [-], for an `angle` [rad].

    e = cos(beta) n + s sin(beta) b on the screw, its opposite on the nut.

    """
    sign = 1 if side == 'screw' else -1
    angle = np.asarray(angle)
    n, b = sign * np.cos(angle), sign * flank * np.sin(angle)
    none = np.zeros_like(n)
    return np.array([none, n, b]), np.array([none, -b, n])


def relative_motion(
    screw: Screw, side: Side, *, angle: Any, flank: Flank, speed: float, orbit: Any, rotation: Any
) -> Vector:
    """
    Return the motion of the ball against one raceway, about the ball centre.

    Rows: velocity along t and along e_p [m/s], rotation about t, e and e_p [rad/s]. `angle` [rad],
    screw `speed`, `orbit` rate and `rotation` along t, n, b [rad/s]; numbers may be complex, and
    arrays after the first axis.

    """
    own = speed if side == 'screw' else 0.0
    path = screw.pitch_radius / math.cos(helix_angle(screw))
    axis = axis_vector(screw)
    turn = np.array([part - own * k for part, k in zip(rotation, axis)])
    e, across = contact_frame(side, angle, flank)
    along = path * (np.asarray(orbit) - own)
    spin, roll = np.sum(e * turn, axis=0), np.sum(across * turn, axis=0)
    return np.array([along, np.zeros_like(along), turn[0], spin, roll])


def slip_maps(screw: Screw, side: Side, x: Array, y: Array) -> tuple[Array, Array]:
    """
    Return the maps from relative motion to slip along t and along e_p, each (5, points).

    `x` along t and `y` along e_p [m] from the centre. V = V_0 + (Omega.e)(y t - x e_p) -
    (y^2/(2 R_d)) Omega x e with R_d = 2 r_b r_g/(r_b + r_g): Heathcote, Proc. Inst. Automob. Eng.
    15 (1921) 569, here with the helix and spin.

    """
    arm = 0.5 * screw.ball_diameter - y * y / (2 * heathcote_radius(screw, side))
    none, one = np.zeros_like(x), np.ones_like(x)
    return np.array([one, none, none, y, -arm]), np.array([none, one, arm, -x, none])


def slip_field(
    screw: Screw, side: Side, motion: BallMotion, x: ArrayLike, y: ArrayLike
) -> tuple[Array, Array]:
    """
    Return the slip of the ball surface along t and along e_p [m/s].

    `x` along t and `y` along e_p [m] from the contact centre, of one shape.

    """
    x, y = np.broadcast_arrays(np.asarray(x, dtype=float), np.asarray(y, dtype=float))
    relative = relative_motion(
        screw,
        side,
        angle=motion.screw_angle if side == 'screw' else motion.nut_angle,
        flank=motion.flank,
        speed=motion.screw_speed,
        orbit=motion.orbit_rate,
        rotation=motion.rotation,
    )
    along, across = slip_maps(screw, side, x, y)
    return np.tensordot(relative, along, 1), np.tensordot(relative, across, 1)


def no_slip_motion(screw: Screw, speed: float, flank: Flank = 1) -> BallMotion:
    """
    Return the motion without gross slip for a screw `speed` [rad/s].

    Spin and helical slip are split evenly between both contacts.

    """
    rates, alpha, angle = no_slip_rates(screw), helix_angle(screw), screw.contact_angle
    e, across = contact_frame('screw', angle, flank)
    spin = 0.5 * float(axis_vector(screw) @ e)
    rotation = speed * (rates.rolling * across + spin * e)
    return BallMotion(
        screw_speed=speed,
        orbit_rate=rates.orbit * speed,
        rotation=(0.5 * speed * math.sin(alpha), float(rotation[1]), float(rotation[2])),
        screw_angle=angle,
        nut_angle=angle,
        flank=flank,
    )


def four_point_motion(screw: Screw, speed: float, flank: Flank = 1) -> BallMotion:
    """
    Return the motion without gross slip at all four flanks for a screw `speed` [rad/s].

    Orbit rate and rolling are those of two flanks, about an axis across the track that is, but for
    the helix, parallel to the screw's: every flank spins. Helical slip is split evenly.

    """
    rates, angle = no_slip_rates(screw), screw.contact_angle
    return BallMotion(
        screw_speed=speed,
        orbit_rate=rates.orbit * speed,
        rotation=(
            0.5 * speed * math.sin(helix_angle(screw)),
            0.0,
            speed * rates.rolling / math.cos(angle),
        ),
        screw_angle=angle,
        nut_angle=angle,
        flank=flank,
    )


def slip_floor(screw: Screw, speed: float) -> float:
    """
    Return the floor of the slip speed [m/s] for a screw `speed` [rad/s].

    1e-4 m/s, but at slow motion 1 % of the helical slip, so that boundary friction keeps its limit
    at rest.

    """
    return min(SLIP_FLOOR, SLIP_FLOOR_SHARE * no_slip_rates(screw).helical_slip * abs(speed))
