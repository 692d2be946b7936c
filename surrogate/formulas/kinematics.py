# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Kinematics of a ball without gross slip: exact rates, and the slip that geometry cannot avoid.

Every rate is linear in the screw speed, so all are kept per unit of it. Without friction the ball
splits spin and helical slip evenly between its two contacts; under friction the split moves, which
only a balance of the ball can tell.

"""

from dataclasses import dataclass
import math

import numpy as np
from numpy.typing import ArrayLike, NDArray
from surrogate.formulas.geometry import (
    conformity,
    curvature_ratio,
    helix_angle,
    screw_contact,
    Side,
)
from surrogate.parameters import Screw

Array = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True, slots=True)
class Rates:
    """
    Rates per screw speed.

    `entrainment` and `helical_slip` [m/s per rad/s], equal at both contacts; `orbit`, `rolling`
    and `spin` per contact (rad/s per rad/s) [-]; `rolling` is w_b cos(beta) - s w_n sin(beta).

    """

    entrainment: float
    helical_slip: float
    orbit: float
    rolling: float
    spin: float


def no_slip_rates(screw: Screw) -> Rates:
    """
    Return the rates of a ball that rolls along the track without gross slip.

    Orbit (1 - g)/2, entrainment r_m (1 - g^2) / (2 cos(alpha)), helical slip r_b sin(alpha)/2 at
    each contact, spin cos(alpha) sin(beta)/2 at each contact: after Lin, Velinsky, Ravani (1994).

    """
    alpha, beta, g = helix_angle(screw), screw.contact_angle, curvature_ratio(screw)
    ball_radius = 0.5 * screw.ball_diameter
    orbit = 0.5 * (1 - g)
    return Rates(
        entrainment=screw.pitch_radius * (1 - g * g) / (2 * math.cos(alpha)),
        helical_slip=0.5 * ball_radius * math.sin(alpha),
        orbit=orbit,
        rolling=-screw.pitch_radius * orbit / (ball_radius * math.cos(alpha)),
        spin=0.5 * math.cos(alpha) * math.sin(beta),
    )


def entrainment_speed_paper(screw: Screw, speed: ArrayLike) -> Array:
    """Return w r_m / 2 [m/s] for `speed` [rad/s]: the published study's simpler entrainment."""
    return np.asarray(speed) * screw.pitch_radius / 2


def heathcote_radius(screw: Screw, side: Side) -> float:
    """Return the radius of the pressed surface across the track, 2 r_b r_g/(r_b + r_g) [m]."""
    f = conformity(screw, side)
    return 2 * f * screw.ball_diameter / (1 + 2 * f)


def slip_arm(
    screw: Screw,
    side: Side,
    x: ArrayLike,
    y: ArrayLike,
    semi_axis_y: ArrayLike,
    *,
    spin: float | None = None,
) -> Array:
    """
    Return the slip speed per screw speed [m/s per rad/s] at `x`, `y` [m] from the contact centre.

    Spin and curvature slip (Heathcote) run along the track, helical slip and spin across it. The
    curvature slip y^2/(2 R_d) is taken about its mean under Hertz pressure, a_y^2/5 with the
    semi-axis a_y [m], because a free ball carries no net traction along the track. The `spin`
    [rad/s per rad/s] is that of a ball between two flanks unless it is given.

    """
    x, y = np.asarray(x, dtype=float), np.asarray(y, dtype=float)
    rates = no_slip_rates(screw)
    relative_rolling = rates.entrainment / screw_contact(screw, side).radius_x
    bulge = (y * y - np.asarray(semi_axis_y) ** 2 / 5) / (2 * heathcote_radius(screw, side))
    turn = rates.spin if spin is None else spin
    along = turn * y - relative_rolling * bulge
    return np.asarray(np.hypot(along, rates.helical_slip - turn * x))
