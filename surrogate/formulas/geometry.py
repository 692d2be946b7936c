# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Geometry of the ball-screw contacts and Hertz's solution for them.

x runs along the track (rolling, entrainment), y across it. Contact A is ball on screw, contact B
ball on nut; both share the groove curvature across the track unless the conformities differ.

"""

from dataclasses import dataclass
import math
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.optimize import brentq
from scipy.special import elliprd, elliprf
from surrogate.parameters import Material, Screw

Array = NDArray[np.float64]
Side = Literal['screw', 'nut']
SIDES: tuple[Side, Side] = ('screw', 'nut')


@dataclass(frozen=True, kw_only=True, slots=True)
class Contact:
    """
    Undeformed contact of two bodies.

    Radii of relative curvature along and across the track [m], reduced modulus E' [Pa] with
    2/E' = (1 - nu1^2)/E1 + (1 - nu2^2)/E2, which is 226 GPa for steel on steel.

    """

    radius_x: float
    radius_y: float
    reduced_modulus: float


@dataclass(frozen=True, kw_only=True, slots=True)
class Hertz:
    """
    Hertzian contact under one or many loads.

    Semi-axes along and across the track [m], largest pressure [Pa], approach [m]; all zero at zero
    load.

    """

    semi_axis_x: Array
    semi_axis_y: Array
    max_pressure: Array
    approach: Array


def helix_angle(screw: Screw) -> float:
    """Return the helix angle of the ball-centre path [rad]: tan = L / (2 pi r_m)."""
    return math.atan(screw.lead / (2 * math.pi * screw.pitch_radius))


def curvature_ratio(screw: Screw) -> float:
    """Return g = r_b cos(beta) cos^2(alpha) / r_m [-], the ball over the path at the contact."""
    return (
        0.5
        * screw.ball_diameter
        * math.cos(screw.contact_angle)
        * math.cos(helix_angle(screw)) ** 2
        / screw.pitch_radius
    )


def conformity(screw: Screw, side: Side) -> float:
    """Return the groove radius over the ball diameter [-] of one side."""
    return screw.conformity_screw if side == 'screw' else screw.conformity_nut


def reduced_modulus(first: Material, second: Material) -> float:
    """Return E' [Pa] with 2/E' = (1 - nu1^2)/E1 + (1 - nu2^2)/E2."""
    compliance = sum((1 - body.poisson_ratio**2) / body.young_modulus for body in (first, second))
    return 2.0 / compliance


def screw_contact(screw: Screw, side: Side) -> Contact:
    """
    Return the contact of a ball with the screw (A) or with a nut (B).

    Rx = r_b (1 -+ g); 1/Ry = 1/r_b - 1/(2 f r_b).

    """
    ball_radius = 0.5 * screw.ball_diameter
    g = curvature_ratio(screw)
    return Contact(
        radius_x=ball_radius * (1 - g if side == 'screw' else 1 + g),
        radius_y=ball_radius / (1 - 0.5 / conformity(screw, side)),
        reduced_modulus=reduced_modulus(screw.raceway, screw.ball),
    )


def ellipticity(contact: Contact) -> float:
    """
    Return the axis ratio k = a_y / a_x [-] of the Hertz ellipse, either orientation.

    Ry/Rx = R_D(0, k^2, 1) / R_D(0, 1, k^2) with Carlson's elliptic integral: Hertz's condition,
    e.g. Johnson, Contact Mechanics (1985), eq. (4.26), free of cancellation for the circle.

    """

    def mismatch(log_k: float) -> float:
        square = math.exp(2 * log_k)
        return math.log(
            elliprd(0, square, 1) / elliprd(0, 1, square) * contact.radius_x / contact.radius_y
        )

    return math.exp(brentq(mismatch, -12.0, 12.0, xtol=1e-14, rtol=1e-14))


def hertz(contact: Contact, load: ArrayLike) -> Hertz:
    """
    Solve the dry smooth contact under `load` [N], any shape.

    a_x^3 = 2 Q Rx R_D(0, k^2, 1) / (pi E'), p0 = 3 Q / (2 pi a_x a_y), approach = 3 Q R_F(0,
    a_x^2, a_y^2) / (pi E'): Johnson (1985), section 4.2, with exact integrals.

    """
    load = np.asarray(load, dtype=float)
    k = ellipticity(contact)
    modulus = contact.reduced_modulus
    semi_x = np.cbrt(2 * load * contact.radius_x * elliprd(0, k * k, 1) / (math.pi * modulus))
    loaded = load > 0
    area = np.where(loaded, math.pi * k * semi_x**2, 1.0)
    inverse_size = np.divide(1.0, semi_x, out=np.zeros_like(semi_x), where=loaded)
    return Hertz(
        semi_axis_x=semi_x,
        semi_axis_y=k * semi_x,
        max_pressure=1.5 * load / area,
        approach=3 * load * elliprf(0, 1, k * k) * inverse_size / (math.pi * modulus),
    )


def opposite_flank_approach(screw: Screw, side: Side, angle: float, approach: float) -> float:
    """
    Return how far a loaded ball comes towards the other flank of its gothic groove [m].

    A tilt of the contact line to a smaller `angle` [rad] swings the ball about the centre of the
    loaded flank; the elastic `approach` [m] moves it along the line. A third contact appears where
    this exceeds the clearance between an unloaded ball and its flanks. Groove centres lie at the
    nominal contact angle.

    """
    nominal, gap = screw.contact_angle, (conformity(screw, side) - 0.5) * screw.ball_diameter
    reach = gap + approach
    across = reach * math.sin(angle) - 2 * gap * math.sin(nominal)
    return math.hypot(reach * math.cos(angle), across) - gap
