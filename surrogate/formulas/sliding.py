# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Sliding friction over a Hertzian ellipse with one film thickness, by slip power.

The film part shears by Eyring's law under the local pressure, up to the limit of the oil, the
asperity part by a boundary coefficient; both oppose the local slip. The power over the ellipse
gives the torque, its mean the coefficient.

"""

import numpy as np
from numpy.typing import NDArray
from surrogate.formulas.geometry import Hertz, hertz, screw_contact, Side, SIDES
from surrogate.formulas.kinematics import slip_arm
from surrogate.formulas.load_sharing import normal_force, working_preload
from surrogate.formulas.lubricant import (
    limiting_shear_stress_bair_winer_1979,
    LubricantState,
    shear_stress_eyring_1936,
    viscosity_roelands_1966,
)
from surrogate.parameters import Screw

Array = NDArray[np.float64]

RADIAL_NODES, ANGULAR_NODES = 12, 24
"""Quadrature of the ellipse: torque within 3e-4 of a grid four times finer each way."""
HYSTERESIS = 3 / 32
"""Work of Hertz's pressure on the front half of the ellipse, as a force over Q b / Rx [-]."""


def ellipse_nodes(
    radial: int = RADIAL_NODES, angular: int = ANGULAR_NODES
) -> tuple[Array, Array, Array]:
    """Return nodes x, y on the unit disk [-] and weights that sum to pi [-], all flat."""
    points, weights = np.polynomial.legendre.leggauss(radial)
    radius = 0.5 * (points + 1)
    return polar_nodes(radius, 0.5 * weights * radius, angular, around=2 * np.pi)


def polar_nodes(
    radius: Array, ring: Array, angular: int, *, around: float
) -> tuple[Array, Array, Array]:
    """
    Return x, y on rings of `angular` nodes [-] and their weights, all flat.

    `radius` of each ring and its weight `ring`, of a turn that counts `around` [-].

    """
    angle = (np.arange(angular) + 0.5) * 2 * np.pi / angular
    x, y = np.outer(radius, np.cos(angle)), np.outer(radius, np.sin(angle))
    weight = np.outer(ring, np.full(angular, around / angular))
    return x.ravel(), y.ravel(), weight.ravel()


def sliding_friction(
    screw: Screw,
    side: Side,
    ellipse: Hertz,
    film: Array,
    share: Array,
    oil: LubricantState,
    speed: Array,
    *,
    spin: float | None = None,
) -> tuple[Array, Array]:
    """
    Return power per screw speed (a torque) [N m] and friction coefficient [-] of one contact.

    The coefficient is the mean traction against the slip over the normal force. All arrays share
    one shape.

    `ellipse` under the normal force, `film` [m], asperity `share` [-], screw `speed` [rad/s], at
    least 0, `spin` as in `slip_arm`. At speed zero the film carries no traction and the limit of
    slow motion remains.

    """
    x, y, weight = ellipse_nodes()
    pressure = ellipse.max_pressure[..., None] * np.sqrt(1 - x * x - y * y)
    arm = slip_arm(
        screw,
        side,
        ellipse.semi_axis_x[..., None] * x,
        ellipse.semi_axis_y[..., None] * y,
        ellipse.semi_axis_y[..., None],
        spin=spin,
    )
    viscosity = viscosity_roelands_1966(
        pressure, oil.viscosity[..., None], oil.pressure_viscosity[..., None]
    )
    slip = arm * speed[..., None]
    thickness = np.broadcast_to(film[..., None], slip.shape)
    rate = np.divide(slip, thickness, out=np.zeros_like(slip), where=thickness > 0)
    sheared = shear_stress_eyring_1936(viscosity, rate, oil.eyring_stress)
    if oil.limiting_shear_share is not None:
        largest = limiting_shear_stress_bair_winer_1979(pressure, oil.limiting_shear_share)
        sheared = np.minimum(sheared, largest)
    traction = (1 - share[..., None]) * sheared + share[
        ..., None
    ] * screw.roughness.asperity_friction * pressure
    area = weight * (ellipse.semi_axis_x * ellipse.semi_axis_y)[..., None]
    force = np.sum(traction * area, axis=-1)
    normal = np.sum(pressure * area, axis=-1)
    coefficient = np.divide(force, normal, out=np.zeros_like(force), where=normal > 0)
    return np.sum(traction * arm * area, axis=-1), coefficient


def mean_sliding_speed(screw: Screw, side: Side, load: float, speed: float) -> float:
    """
    Return the mean sliding speed [m/s] of a contact under its Hertz pressure.

    Normal `load` [N], screw `speed` [rad/s]; by the motion without friction.

    """
    ellipse = hertz(screw_contact(screw, side), load)
    x, y, weight = ellipse_nodes()
    semi_x, semi_y = ellipse.semi_axis_x, ellipse.semi_axis_y
    arm = slip_arm(screw, side, semi_x * x, semi_y * y, semi_y)
    return float(abs(speed) * np.average(arm, weights=weight * np.sqrt(1 - x * x - y * y)))


def largest_sliding(screw: Screw) -> float:
    """Return the larger mean sliding of both sides under preload, per screw angle [m/rad]."""
    load = float(normal_force(screw, working_preload(screw)))
    return max(mean_sliding_speed(screw, side, load, 1.0) for side in SIDES)


def hysteresis_force(loss: float, load: float, semi_axis_x: float, radius_x: float) -> float:
    """
    Return the rolling force on each surface by elastic hysteresis [N].

    Moment 3/16 alpha Q b of a contact, b along the rolling: Johnson, Contact Mechanics (1985),
    section 9.2, for any ellipse; it is 2 Rx times this force. `loss` is his alpha [-], normal
    `load` [N], `semi_axis_x` b and `radius_x` Rx [m].

    """
    return HYSTERESIS * loss * load * semi_axis_x / radius_x
