# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Constant friction on the ellipse of Hertz, whose sums are known: a law to test a ball with."""

from dataclasses import dataclass
import math

import numpy as np
from surrogate.formulas.geometry import hertz, screw_contact, Side
from surrogate.formulas.sliding import polar_nodes
from surrogate.parameters import Screw
from surrogate.screw.ball_motion import Array

RADIAL_NODES, ANGULAR_NODES = 20, 60
"""Quadrature of the ellipse: lost power within 1e-4 of a rule twice as fine each way."""


@dataclass(frozen=True, kw_only=True, slots=True)
class CoulombTraction:
    """
    Constant friction coefficient [-] on the Hertz pressure of a growing ellipse.

    Places `x` along and `y` across the track under 1 N [m N^(-1/3)], `share` of the normal force
    at each [-]; slip floor [m/s].

    """

    coefficient: float
    x: Array
    y: Array
    share: Array
    slip_floor: float = 1e-4

    @property
    def growth(self) -> float:
        """Exponent of the size of the ellipse in the normal force [-]: Hertz, 1/3."""
        return 1 / 3

    def places(self, load: float) -> tuple[Array, Array]:
        """Return the quadrature points x, y [m] of the ellipse under `load` [N]."""
        size = math.cbrt(load)
        return size * self.x, size * self.y

    def strengths(self, load: float) -> tuple[Array, Array, Array, Array]:
        """Return mu N [N] of each place under `load` [N], and no oil."""
        none = np.zeros_like(self.share)
        return self.coefficient * load * self.share, none, none, none

    def sample(self) -> 'CoulombTraction':
        """Return itself: a quadrature has no place too many."""
        return self


def hertz_nodes(
    radial: int = RADIAL_NODES, angular: int = ANGULAR_NODES
) -> tuple[Array, Array, Array]:
    """
    Return x, y on the unit disk [-] and the share of a Hertz load at each place [-].

    Gauss-Legendre in u = sqrt(1 - r^2), which is the pressure: the weight is 3 u^2 du.

    """
    points, weights = np.polynomial.legendre.leggauss(radial)
    u = 0.5 * (points + 1)
    return polar_nodes(np.sqrt(1 - u * u), 1.5 * weights * u * u, angular, around=1.0)


def coulomb_traction(
    screw: Screw, side: Side, coefficient: float, *, slip_floor: float = 1e-4
) -> CoulombTraction:
    """
    Return sliding with a constant friction coefficient [-] over the Hertz ellipse of one side.

    Slip floor [m/s].

    """
    ellipse = hertz(screw_contact(screw, side), 1.0)
    x, y, share = hertz_nodes()
    return CoulombTraction(
        coefficient=coefficient,
        x=float(ellipse.semi_axis_x) * x,
        y=float(ellipse.semi_axis_y) * y,
        share=share,
        slip_floor=slip_floor,
    )
