# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Load sharing of the two nuts of a preloaded pair."""

import math
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray
from surrogate.formulas.geometry import helix_angle
from surrogate.parameters import Screw

Array = NDArray[np.float64]
NutName = Literal['loaded', 'relieved']
"""Nut that a load presses, and the one that it relieves."""

UNLOADING_RATIO = 2.0**1.5
"""Axial load over preload at which the relieved nut carries nothing [-]."""
IDLE_SHARE = 1e-3
"""Force of the relieved nut over that of the loaded one below which it counts as idle [-]."""
LIGHT_IN_RATINGS = 0.01
"""Stands for the preload of a screw without one, over the static rating [-]."""


def nut_forces(load: ArrayLike, preload: float) -> tuple[Array, Array]:
    """
    Return the axial forces [N] in the loaded and in the relieved nut.

    `load` [N] of any shape and sign, `preload` [N]. Two Hertzian springs in opposition: F_L^(2/3)
    + F_R^(2/3) = 2 F_pre^(2/3) and F_L - F_R = F. With F_L^(1/3), F_R^(1/3) on a circle, cos^3 -
    sin^3 = F / (2^(3/2) F_pre) is a cubic in d = cos - sin with the root below; past unloading the
    loaded nut carries everything.

    """
    force = np.abs(np.asarray(load, dtype=float))
    limit = UNLOADING_RATIO * preload
    ratio = np.minimum(force / limit, 1.0) if limit > 0 else np.ones_like(force)
    d = 2.0 * np.sin(np.arcsin(ratio) / 3.0)
    # 1 - d^2 leaves a rounding at the unloading load, where the nut carries exactly nothing.
    relieved = np.where(ratio < 1, limit * ((1 - d * d) / (np.sqrt(2 - d * d) + d)) ** 3, 0.0)
    return force + relieved, relieved


def normal_force(screw: Screw, nut_force: ArrayLike) -> Array:
    """Return the normal force per ball [N]: Q = F / (n_b sin(beta) cos(alpha))."""
    share = (
        screw.loaded_balls_per_nut * math.sin(screw.contact_angle) * math.cos(helix_angle(screw))
    )
    return np.asarray(nut_force) / share


def working_preload(screw: Screw, in_ratings: float = LIGHT_IN_RATINGS) -> float:
    """Return the preload [N]; without one, that share [-] of the static rating stands for it."""
    return screw.preload or in_ratings * screw.static_rating


def idle_load(screw: Screw) -> float:
    """
    Return the axial load [N] from which on the relieved nut is idle; 0 without preload.

    Where F_R = e F_L with the least share e = `IDLE_SHARE`, of F_L^(2/3) + F_R^(2/3) = 2
    F_pre^(2/3).

    """
    loaded = screw.preload * (2 / (1 + IDLE_SHARE ** (2 / 3))) ** 1.5
    return float((1 - IDLE_SHARE) * loaded)
