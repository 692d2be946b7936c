# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The load at which the relieved nut becomes idle."""

from surrogate.parameters import Screw
from surrogate.screw.solve import IDLE_SHARE

BESIDE = 1e-4
"""Distance of the nodes beside the idle load, over that load [-]."""


def idle_load(screw: Screw) -> float:
    """
    Return the axial load [N] from which on the relieved nut is idle; 0 without preload.

    Where F_R = e F_L with the least share e of `surrogate.screw.solve`, of F_L^(2/3) + F_R^(2/3) =
    2 F_pre^(2/3).

    """
    loaded = screw.preload * (2 / (1 + IDLE_SHARE ** (2 / 3))) ** 1.5
    return float((1 - IDLE_SHARE) * loaded)
