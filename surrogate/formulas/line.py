# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
A line contact by formula: its film, and how much of a wave of roughness survives in it.

A contact many times as wide as long is such a line at each place across the track.

"""

from dataclasses import dataclass
import math

import numpy as np
from numpy.typing import ArrayLike, NDArray
from surrogate.formulas.film import central_film_nijenbanning_1994, groups
from surrogate.formulas.geometry import Contact, hertz

Array = NDArray[np.float64]
LONG = 20.0
"""Radius ratio of the ellipse whose film formula serves for a line [-]."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Line:
    """
    A line contact under one or many pressures.

    Radius of relative curvature along the track [m], reduced modulus as in `Contact` [Pa], Hertz
    pressure [Pa].

    """

    radius: float
    reduced_modulus: float
    max_pressure: Array

    @property
    def semi_axis(self) -> Array:
        """Half width of the Hertz zone b = 4 R pH/E' [m]."""
        return np.asarray(4 * self.radius * self.max_pressure / self.reduced_modulus)


def line_at(contact: Contact, load: float, place: ArrayLike) -> Line:
    """
    Return the line contact at `place` across an ellipse under a load [N], over its semi-axis [-].

    There the Hertz pressure and the half length along the track are those of the ellipse times
    sqrt(1 - place^2); the radius is that of the line contact that has both, whatever the load.

    """
    ellipse = hertz(contact, load)
    pressure = float(ellipse.max_pressure)
    return Line(
        radius=contact.reduced_modulus * float(ellipse.semi_axis_x) / (4 * pressure),
        reduced_modulus=contact.reduced_modulus,
        max_pressure=np.asarray(pressure * np.sqrt(1 - np.asarray(place, dtype=float) ** 2)),
    )


def long_ellipse(line: Line) -> tuple[Contact, Array]:
    """Return the ellipse that serves for a line in formulas, and its load [N] at that pressure."""
    long = Contact(
        radius_x=line.radius, radius_y=LONG * line.radius, reduced_modulus=line.reduced_modulus
    )
    return long, np.asarray((line.max_pressure / float(hertz(long, 1.0).max_pressure)) ** 3)


def central_film_line(
    line: Line, speed: ArrayLike, viscosity: float, pressure_viscosity: float
) -> Array:
    """
    Return the central film [m] at an entrainment speed [m/s], by that of a long ellipse.

    The ellipse has the same Hertz pressure; viscosity [Pa s], coefficient [1/Pa].

    """
    long, load = long_ellipse(line)
    return central_film_nijenbanning_1994(
        long, groups(long, load, speed, viscosity, pressure_viscosity)
    )


def moes_line(
    line: Line, speed: ArrayLike, viscosity: float, pressure_viscosity: float
) -> tuple[Array, Array]:
    """
    Return the line load M1 [-] and the lubricant number L [-] of Moes.

    M1 = w/(E' R) U^(-1/2), L = alpha E' U^(1/4), U = eta0 2u/(E' R) with the entrainment speed u
    [m/s], w = pi/2 pH b; viscosity [Pa s], coefficient [1/Pa].

    """
    U = 2 * viscosity * np.asarray(speed) / (line.reduced_modulus * line.radius)
    load = 0.5 * math.pi * line.max_pressure * line.semi_axis
    M1 = load / (line.reduced_modulus * line.radius) / np.sqrt(U)
    return np.asarray(M1), np.asarray(pressure_viscosity * line.reduced_modulus * U**0.25)


def amplitude_reduction_venner_1997(
    wavelength: ArrayLike, semi_axis: ArrayLike, moes_load: ArrayLike, moes_material: ArrayLike
) -> Array:
    """
    Return the deformed over the undeformed amplitude of a wave that rolls through a line [-].

    1/(1 + 0.125 n + 0.04 n^2), n = (lambda/b) M1^(3/4)/L^(1/2), ridges across the track, pure
    rolling, small amplitudes: Venner, Couhier, Lubrecht, Greenwood, Tribol. Ser. 32 (1997) 103.
    Wavelength [m], half width of the Hertz zone [m], M1 and L as `moes_line` has them [-].

    """
    length = np.asarray(wavelength) / np.asarray(semi_axis)
    n = length * np.asarray(moes_load) ** 0.75 / np.asarray(moes_material) ** 0.5
    return np.asarray(1 / (1 + 0.125 * n + 0.04 * n * n))
