# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Critical speed and buckling load of the shaft between its bearings.

The shaft counts as a bar of the diameter at the bottom of its groove; the nut, which holds it too,
is left out.

"""

from collections.abc import Iterator
import math
from typing import Any

from surrogate.parameters import Screw
from surrogate.units import digits, MILLI, RPM

SUPPORT_FACTORS = {
    'fixed_fixed': (4.730, 4.0),
    'fixed_supported': (3.927, 2.0),
    'supported_supported': (math.pi, 1.0),
    'fixed_free': (1.875, 0.25),
}
"""First root of the bending wave [-] and factor on Euler's load [-]: THK, General Catalog, A15."""
SPEED_SHARE, LOAD_SHARE = 0.8, 0.5
"""Shares of critical speed and buckling load that makers allow [-]."""


def core_diameter(screw: Screw) -> float:
    """
    Return the diameter at the bottom of the gothic groove [m].

    The arcs of radius f D have their centres (f - 1/2) D behind the ball, along the contact
    normals, and meet under the ball.

    """
    beta = screw.contact_angle
    radius = screw.conformity_screw * screw.ball_diameter
    behind = radius - 0.5 * screw.ball_diameter
    depth = math.sqrt(radius**2 - (behind * math.sin(beta)) ** 2) - behind * math.cos(beta)
    return 2 * (screw.pitch_radius - depth)


def critical_speed(screw: Screw) -> float:
    """
    Return the speed at which the shaft begins to whirl [rad/s], NaN without length and support.

    lambda^2 / L^2 (E I / (rho A))^(1/2), the first natural frequency of bending: THK, General
    Catalog, A15-32, (7).

    """
    if screw.free_length is None or screw.support is None:
        return math.nan
    root, _ = SUPPORT_FACTORS[screw.support]
    wave = math.sqrt(screw.raceway.young_modulus / screw.raceway.density)
    return (root / screw.free_length) ** 2 * wave * core_diameter(screw) / 4


def buckling_load(screw: Screw) -> float:
    """
    Return the thrust under which the shaft buckles [N], NaN without length and support.

    eta pi^2 E I / L^2, Euler's load: THK, General Catalog, A15-30, (5).

    """
    if screw.free_length is None or screw.support is None:
        return math.nan
    _, factor = SUPPORT_FACTORS[screw.support]
    stiffness = screw.raceway.young_modulus * math.pi * core_diameter(screw) ** 4 / 64
    return factor * math.pi**2 * stiffness / screw.free_length**2


def service_of(screw: Screw) -> dict[str, Any]:
    """Return what a sheet states for the service of a screw, and what follows from it, in SI."""
    shaft = {'critical_speed': critical_speed(screw), 'buckling_load': buckling_load(screw)}
    return screw.service() | {
        name: value for name, value in shaft.items() if not math.isnan(value)
    }


def shaft_doubts(screw: Screw, speed: float, load: float, whose: str = '') -> Iterator[str]:
    """
    Yield a sentence for a speed [rad/s] and for a load [N] that are too much for the shaft.

    `whose` begins with a comma and tells where they come from.

    """
    most, thrust = SPEED_SHARE * critical_speed(screw), LOAD_SHARE * buckling_load(screw)
    shaft = f'free_length_mm {MILLI * (screw.free_length or 0.0):g} mm, {screw.support}'
    if speed > most:
        yield (
            f'the speed is {digits(speed / RPM, 4)} rev/min{whose}, allowed is up to '
            f'{digits(most / RPM, 4)} rev/min, {100 * SPEED_SHARE:g} % of the critical speed '
            f'with {shaft}'
        )
    if load > thrust:
        yield (
            f'the load is {load:.4g} N{whose}, allowed is up to {thrust:.4g} N, half of the '
            f'buckling load with {shaft}, where it presses the shaft'
        )
