# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Efficiency and torque by formulas as makers and measurements have them, for the validation."""

from collections.abc import Sequence
from dataclasses import replace
import math
from typing import Any

import numpy as np
from surrogate.catalogue.screw import screw_of
from surrogate.catalogue.words import CatalogueScrew
from surrogate.formulas import torque
from surrogate.parameters import load_lubricant, load_screw, Screw
from surrogate.screw import closed_form
from surrogate.screw.opened import Contacts
from surrogate.studies.tasks import OIL
from surrogate.units import RPM

SIZES = 'iso3408_16x5', 'iso3408_40x10', 'iso3408_63x20'
"""Screws whose efficiency is compared."""
RATED_SPEED, RATED_SHARE = 300.0, 0.1
"""Screw speed [rev/min] and load over C [-] of the efficiency of makers."""
DRAG_SPEED = 100.0
"""Screw speed at which drag torques are measured [rev/min]: JIS B 1192."""
PRELOADS = 1.0, 2.5, 4.0
"""Preloads over the usual one, evenly apart [-]."""
XJTU = CatalogueScrew(
    nominal_diameter=32e-3,
    lead=8e-3,
    dynamic_rating=16.4e3,
    preload=1.5e3,
    nut='double',
    turns=4.0,
)
"""Screw of the data set of Xi'an Jiaotong University, which has lead, C and preload of it; nut and
turns are those of shipped sizes."""
XJTU_DIAMETERS = 25e-3, 32e-3, 40e-3
"""Nominal diameters that a lead of 8 mm comes with [m]."""
XJTU_TORQUES = 0.3985, 0.5156
"""Friction torques of its two screws, new, means over the stroke [N m]."""


def _torques(screw: Screw, speed: float, loads: Sequence[float]) -> list[float]:
    """Return the friction torques [N m] of a screw by formulas at a speed [rev/min]."""
    oil = load_lubricant(OIL)
    places = np.full(len(loads), speed * RPM), np.array(loads), oil.reference_temperature
    return closed_form.solve(Contacts.of(screw), oil, *places).friction_torque.tolist()


def _rated_efficiencies(*, whole: bool) -> list[float]:
    """
    Return efficiencies [-] of shipped sizes under a tenth of C.

    With a typical drag, or of the contacts less what the preload alone takes.

    """
    efficiencies = []
    for name in SIZES:
        screw = load_screw(name)
        load = RATED_SHARE * (screw.dynamic_rating or math.nan)
        idle, loaded = _torques(screw, RATED_SPEED, (0.0, load))
        friction = loaded + (screw.typical_drag or math.nan) if whole else loaded - idle
        efficiencies.append(torque.efficiency(friction, load, screw.lead))
    return efficiencies


def efficiency_with_drag(case: Any) -> list[float]:
    """Return efficiencies of shipped sizes under a tenth of C with a typical drag [-]."""
    return _rated_efficiencies(whole=True)


def efficiency_of_load(case: Any) -> list[float]:
    """Return efficiencies of shipped sizes under a tenth of C, the preload torque apart [-]."""
    return _rated_efficiencies(whole=False)


def efficiency_over_load(case: Any) -> list[float]:
    """Return the efficiency with a typical drag under four preloads over that under one [-]."""
    ratios = []
    for name in SIZES:
        screw = load_screw(name)
        loads = screw.preload, 4 * screw.preload
        less, more = (
            torque.efficiency(friction + (screw.typical_drag or math.nan), load, screw.lead)
            for friction, load in zip(_torques(screw, 1000.0, loads), loads, strict=True)
        )
        ratios.append(more / less)
    return ratios


def drag_over_preload(case: Any) -> list[float]:
    """Return the torque of the contacts under the middle preload over the mean of the ends [-]."""
    place = case.lubricant, DRAG_SPEED * RPM, 0.0, case.temperature
    screws = (replace(case.screw, preload=share * case.screw.preload) for share in PRELOADS)
    low, middle, high = (
        closed_form.solve(Contacts.of(screw), *place).friction_torque for screw in screws
    )
    return [float(2 * middle / (low + high))]


def drag_over_measured(case: Any) -> list[float]:
    """Return torques of contacts and typical drag over two measured ones, over diameters [-]."""
    screws = [screw_of(replace(XJTU, nominal_diameter=diameter))[0] for diameter in XJTU_DIAMETERS]
    return [
        (_torques(screw, DRAG_SPEED, (0.0,))[0] + (screw.typical_drag or math.nan)) / measured
        for measured in XJTU_TORQUES
        for screw in screws
    ]


def stribeck_branches(case: Any) -> list[float]:
    """Return by which power of the speed torque falls at 10 and rises at 1000 rev/min [-]."""
    speeds = np.geomspace(10.0, 1000.0, 25) * RPM
    friction = closed_form.solve(
        case.opened, case.lubricant, speeds, 0.0, case.temperature
    ).friction_torque
    slopes = np.gradient(np.log(friction), np.log(speeds))
    return [-float(slopes[0]), float(slopes[-1])]
