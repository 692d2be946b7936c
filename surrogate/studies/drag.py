# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Efficiency and torque by formulas as makers and measurements have them, for the validation."""

from collections.abc import Sequence
import math
from typing import Any

import numpy as np
from surrogate.formulas import torque
from surrogate.parameters import load_lubricant, load_screw
from surrogate.screw import closed_form
from surrogate.screw.opened import Contacts
from surrogate.studies.tasks import OIL
from surrogate.units import RPM

SIZES = 'iso3408_16x5', 'iso3408_40x10', 'iso3408_63x20'
"""Screws whose efficiency is compared."""
RATED_SPEED, RATED_SHARE = 300.0, 0.1
"""Screw speed [rev/min] and load over C [-] of the efficiency of makers."""


def _torques(name: str, speed: float, loads: Sequence[float]) -> list[float]:
    """Return the friction torques [N m] of a shipped screw by formulas at a speed [rev/min]."""
    screw, oil = load_screw(name), load_lubricant(OIL)
    places = np.full(len(loads), speed * RPM), np.array(loads), oil.reference_temperature
    return closed_form.solve(Contacts.of(screw), oil, *places).friction_torque.tolist()


def _rated_efficiencies(*, whole: bool) -> list[float]:
    """
    Return efficiencies [-] of shipped sizes under a tenth of C.

    With a typical drag, or of the contacts less what the preload alone takes.

    """
    found = []
    for name in SIZES:
        screw = load_screw(name)
        load = RATED_SHARE * (screw.dynamic_rating or math.nan)
        idle, loaded = _torques(name, RATED_SPEED, (0.0, load))
        friction = loaded + (screw.typical_drag or math.nan) if whole else loaded - idle
        found.append(torque.efficiency(friction, load, screw.lead))
    return found


def efficiency_with_drag(case: Any) -> list[float]:
    """Return efficiencies of shipped sizes under a tenth of C with a typical drag [-]."""
    return _rated_efficiencies(whole=True)


def efficiency_of_load(case: Any) -> list[float]:
    """Return efficiencies of shipped sizes under a tenth of C, the preload torque apart [-]."""
    return _rated_efficiencies(whole=False)


def efficiency_over_load(case: Any) -> list[float]:
    """Return the efficiency under four preloads over that under one, 1000 rev/min [-]."""
    found = []
    for name in SIZES:
        screw = load_screw(name)
        loads = screw.preload, 4 * screw.preload
        less, more = (
            torque.efficiency(friction, load, screw.lead)
            for friction, load in zip(_torques(name, 1000.0, loads), loads, strict=True)
        )
        found.append(more / less)
    return found


def stribeck_branches(case: Any) -> list[float]:
    """Return torques at 10 and 1000 rev/min over the least between, that of the contacts [-]."""
    speeds = np.geomspace(10.0, 1000.0, 25) * RPM
    friction = closed_form.solve(
        case.opened, case.lubricant, speeds, 0.0, case.temperature
    ).friction_torque
    return [float(end / friction.min()) for end in friction[[0, -1]]]
