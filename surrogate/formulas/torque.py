# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Driving torque and efficiency from the friction torque, and the classical comparators.

The normal force has the arm r_m exactly, so the load contributes F L / (2 pi) and friction adds to
it. Plain arithmetic on floats or arrays, without further imports: the lookup uses it too.

"""

import math
import sys
from typing import Any

DRAGS = 'low', 'typical', 'high'
"""Values of a drag that was not identified."""
SMALLEST = sys.float_info.min
"""Ideal torque below which a load counts as no load [N m]: its inverse overflows."""


def driving_torque(friction_torque: Any, opposing_load: Any, lead: float) -> Any:
    """
    Return the torque on the screw [N m], positive along the motion.

    F L/(2 pi) + M_f, with the friction torque [N m], the opposing load [N] and the lead [m].
    Negative: the load drives the screw and the motor must hold it back.

    """
    return opposing_load * lead / (2 * math.pi) + friction_torque


def efficiency(friction_torque: float, opposing_load: float, lead: float) -> float:
    """
    Return output over input power [-], 0 to 1, from torque [N m], opposing load [N], lead [m].

    Load opposes the motion: F L/(2 pi M). Load drives the motion: 2 pi M/(F L) with the torque
    taken from the screw, 0 where friction keeps more than the load gives. 0 at zero load.

    """
    ideal = abs(opposing_load) * lead / (2 * math.pi)
    if ideal < SMALLEST:
        return 0.0
    if opposing_load > 0:
        return ideal / (ideal + friction_torque)
    left = (ideal - friction_torque) / ideal
    return 0.0 if left < 0 else left


def efficiency_slope(friction_torque: float, opposing_load: float, lead: float) -> float:
    """
    Return how much efficiency is lost per friction torque [1/(N m)], at least 0.

    Torque [N m], opposing load [N], lead [m]; NaN at zero load, where no efficiency is defined.

    """
    ideal = abs(opposing_load) * lead / (2 * math.pi)
    if ideal < SMALLEST:
        return math.nan
    if opposing_load > 0:
        return ideal / (ideal + friction_torque) / (ideal + friction_torque)
    return 1 / ideal


def is_back_driving(friction_torque: float, opposing_load: float, lead: float) -> bool:
    """Return True if the load drives the screw and gives more torque [N m] than friction takes."""
    return bool(driving_torque(friction_torque, opposing_load, lead) < 0)


def with_typical_drag(
    friction_torque: float, opposing_load: float, lead: float, drag: tuple[float, ...]
) -> dict[str, dict[str, float]]:
    """
    Return friction torque and efficiency as they are with a typical drag, by its range.

    Torque [N m], opposing load [N], lead [m]; `drag` [N m] is the least, typical and largest one.

    """
    torques = [friction_torque + each for each in drag]
    values = {
        'drag_Nm': list(drag),
        'friction_torque_Nm': torques,
        'efficiency': [efficiency(each, opposing_load, lead) for each in torques],
    }
    return {name: dict(zip(DRAGS, row, strict=True)) for name, row in values.items()}


def torque_constant_friction(
    opposing_force: float,
    assisting_force: float,
    pitch_radius: float,
    helix_angle: float,
    friction_coefficient: float,
) -> float:
    """
    Return the driving torque [N m] of a double nut with one constant friction coefficient [-].

    M = r_m [F_o tan(alpha + rho) - F_a tan(alpha - rho)], rho = atan(mu), forces [N] of the nut
    that opposes the motion (the loaded one when the load does) and of the other, radius
    [m], angle [rad]: the constant-friction model of Pan and others.

    """
    rho = math.atan(friction_coefficient)
    return pitch_radius * (
        opposing_force * math.tan(helix_angle + rho)
        - assisting_force * math.tan(helix_angle - rho)
    )


def drag_torque_catalogue(preload: float, lead: float, helix_angle: float) -> float:
    """
    Return the catalogue drag torque [N m] of a preloaded nut.

    0.05 (tan alpha)^-0.5 F_pre L / (2 pi), preload [N], lead [m], angle [rad]: ISO 3408-3
    practice.

    """
    return 0.05 / math.sqrt(math.tan(helix_angle)) * preload * lead / (2 * math.pi)


def friction_torque_jungnickel_2010(
    balls: int,
    normal_force: float,
    *,
    speed: float,
    pitch_radius: float,
    ball_radius: float,
    helix_angle: float,
    kinematic_viscosity: float,
    density: float,
) -> float:
    """
    Return the friction torque of the contacts of a preloaded double nut [N m].

    9.16 N G^-0.2 W^-0.516 U^0.512 Q r / cos(alpha): Jungnickel 2010, (9.49), as the source of
    thermca has it, where a seal doubles it. Loaded balls of both nuts, normal force [N], screw
    speed [rad/s], radii [m], angle [rad], oil [m2/s], [kg/m3].

    """
    modulus, cosine = 2.31e11, math.cos(helix_angle)
    material = 1.29e-7 * kinematic_viscosity**0.204 * modulus
    load = normal_force / (modulus * ball_radius**2)
    viscosity = density * kinematic_viscosity
    moving = viscosity * speed * pitch_radius / (2 * modulus * ball_radius * cosine)
    coefficient: float = 9.16 * material**-0.2 * load**-0.516 * moving**0.512
    return balls * coefficient * normal_force * pitch_radius / cosine
