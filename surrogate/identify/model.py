# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Friction torque of the contacts at the points of a run, as a function of what is identified.

The parasitic torque is left out: it is exactly linear and belongs to the fit. The oil is anchored
at the mean temperature of the run; a viscosity factor thickens it as another grade would.

"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np
from surrogate.formulas.lubricant import GOLD_EXPONENT_MINERAL, lubricant_state
from surrogate.identify.data import Array, NoLoadRun
from surrogate.parameters import Lubricant, Screw
from surrogate.screw import closed_form
from surrogate.screw.opened import Contacts

VISCOSITY_BOUNDS = (0.5, 2.0)
"""Viscosity factor [-]: beyond, the sheet is that of another oil or the temperature is wrong."""
FRICTION_BOUNDS = (0.02, 0.3)
"""Boundary friction coefficient [-] of steel in mineral oil, dry of additives to badly fed."""
ONSET_FRICTIONS = (0.05, 0.16)
"""
The same where the onset is identified [-]: below, nothing turns the torque up.

SKF takes 0.15 for lubricants in general, by their additives: catalogue Rolling bearings, model of
the frictional moment, sliding in mixed lubrication. What asks for more than 0.16 is friction of
something else than the balls.

"""
ONSET_BOUNDS = (0.1, 10.0)
"""Onset speed over that which the topography tells [-]: beyond, the sheet is of another screw."""


@dataclass(frozen=True, kw_only=True, slots=True)
class ContactModel:
    """
    What the contacts of a run do.

    `torque` returns their friction torque [N m] at every point, for a viscosity factor [-], an
    asperity friction coefficient [-] and an onset factor [-]; `asperity_share` [-] of the worst
    contact at every point, for the datasheets; tier; screw without parasitic torque; oil anchored
    at the run.

    """

    torque: Callable[[float, float, float], Array]
    asperity_share: Array
    tier: str
    screw: Screw
    lubricant: Lubricant


def anchored(lubricant: Lubricant, temperature: float) -> Lubricant:
    """Return the oil with `temperature` [K] as its reference: the same oil there."""
    state = lubricant_state(lubricant, temperature)
    return replace(
        lubricant,
        reference_temperature=temperature,
        viscosity=float(state.viscosity),
        pressure_viscosity=float(state.pressure_viscosity),
        density=float(state.density),
    )


def thickened(lubricant: Lubricant, factor: float) -> Lubricant:
    """
    Return an oil of the same kind whose viscosity is `factor` [-] times as large.

    The pressure-viscosity coefficient follows by the 0.139 power: Gold et al. (2001).

    """
    return replace(
        lubricant,
        viscosity=lubricant.viscosity * factor,
        pressure_viscosity=lubricant.pressure_viscosity * factor**GOLD_EXPONENT_MINERAL,
        kinematic_viscosity_40=lubricant.kinematic_viscosity_40 * factor,
        kinematic_viscosity_100=lubricant.kinematic_viscosity_100 * factor,
    )


def bare(screw: Screw, **roughness: float) -> Screw:
    """Return the screw without parasitic torque, with other keys of its roughness."""
    rough = replace(screw.roughness, **roughness)  # type: ignore[arg-type]
    return replace(screw, parasitic_torque=0.0, parasitic_torque_rate=0.0, roughness=rough)


def closed_form_model(screw: Screw, lubricant: Lubricant, run: NoLoadRun) -> ContactModel:
    """Return the contacts by published formulas, solved afresh for every question."""
    oil = anchored(lubricant, run.mean_temperature)
    speed, load = np.abs(run.speed), run.direction * run.load

    @lru_cache(maxsize=64)
    def torque(factor: float, friction: float, onset: float) -> Array:
        rough = bare(screw, asperity_friction=friction, onset_factor=onset)
        thick, place = thickened(oil, factor), (speed, load, run.temperature)
        return closed_form.solve(Contacts.of(rough), thick, *place).friction_torque

    sheet = Contacts.of(bare(screw))
    share = closed_form.solve(sheet, oil, speed, load, run.temperature).asperity_share
    return ContactModel(
        torque=torque,
        asperity_share=share,
        tier=closed_form.TIER,
        screw=bare(screw),
        lubricant=oil,
    )
