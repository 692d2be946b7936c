# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Onset of contact by the topography of the raceways, as a speed of the screw."""

from collections.abc import Sequence
from dataclasses import replace
import math
from typing import Any

import numpy as np
from numpy.typing import NDArray
from surrogate.ehl import ContactLubricant
from surrogate.formulas.geometry import Side
from surrogate.formulas.inlet import speed_before_inlet, starved_speed
from surrogate.formulas.line import central_film_line, line_at
from surrogate.formulas.load_sharing import normal_force, nut_forces, working_preload
from surrogate.parameters import Lubricant, Screw
from surrogate.raceway.stated import NINE_OF_TEN, Roughness
from surrogate.screw.contacts import oil_at
from surrogate.screw.opened import Contacts

Array = NDArray[np.float64]
SMOOTH_ONSET = 1e-3
"""Entrainment speed that stands for the onset of smooth raceways [m/s]."""


def onset_speeds(opened: Contacts, lubricant: Lubricant, load: Array, temperature: Array) -> Array:
    """
    Return the screw speeds [rad/s] of the onset over load [N] and temperature [K].

    That of the loaded nut, for the side where contact begins faster.

    """
    speeds = [
        [
            onset_point(opened, lubricant, force, heat)['speed_rad_s']
            for heat in temperature.tolist()
        ]
        for force in load.tolist()
    ]
    least = SMOOTH_ONSET / starved_speed(lubricant, opened.rates.entrainment)
    return np.maximum(speeds, least)


def with_raceway(screw: Screw, **changes: Any) -> Screw:
    """Return a screw with other keys of its raceway roughness; marches hold in their state."""
    if changes.get('state', screw.roughness.state) != screw.roughness.state:
        changes = {**dict.fromkeys(Roughness.MARCHED), **changes}
    return replace(screw, roughness=replace(screw.roughness, **changes))


def run_in_at(screw: Screw, pressure: float) -> Screw:
    """Return a screw whose raceway, traced new, runs in at one pressure [Pa] alone."""
    return with_raceway(
        screw,
        state='run_in',
        traced='new',
        hardness=max(screw.roughness.hardness, pressure),
        run_in_pressure=pressure,
        run_in_low=pressure,
        run_in_high=pressure,
    )


def onset_point(
    opened: Contacts, lubricant: Lubricant, load: float, temperature: float
) -> dict[str, float]:
    """
    Return where contact begins under an axial load [N] at an oil temperature [K].

    Screw speed [rad/s], entrainment speed [m/s] and smooth central film [m] of the loaded nut, of
    the side where contact begins at the faster speed; all 0 for smooth raceways. Raises InputError
    as `running_tiles` does.

    """
    screw, oil = opened.sheet, oil_at(lubricant, temperature)
    force, film = loaded_force(screw, load), 0.0
    entrainment, side = onset_side(opened, oil, lubricant.film_floor, load)
    if entrainment:
        line = line_at(opened.geometry[side], force, 0.0)
        film = float(central_film_line(line, entrainment, oil.viscosity, oil.pressure_viscosity))
    before = speed_before_inlet(screw, lubricant, side, force, entrainment, temperature)
    speed = before / opened.rates.entrainment
    return {'speed_rad_s': speed, 'entrainment_speed_m_s': entrainment, 'central_film_m': film}


def loaded_force(screw: Screw, load: float) -> float:
    """Return the normal force of a ball of the loaded nut [N] under an axial load [N]."""
    loaded = float(nut_forces(load, screw.preload)[0]) or working_preload(screw)
    return float(normal_force(screw, loaded))


def onset_side(
    opened: Contacts, oil: ContactLubricant, floor: float, load: float
) -> tuple[float, Side]:
    """Return the faster onset of both sides [m/s] under an axial load [N], and its side."""
    return max((speed, side) for side, speed in side_onsets(opened, oil, floor, load).items())


def side_onsets(
    opened: Contacts, oil: ContactLubricant, floor: float, load: float
) -> dict[Side, float]:
    """Return the onset of each side [m/s] under an axial load [N]."""
    force = loaded_force(opened.sheet, load)
    return {
        side: onset.speed(opened.geometry[side], force, oil, floor)
        for side, onset in opened.law.onsets.items()
    }


def law_band(
    opened: Contacts, lubricant: Lubricant, load: float, temperature: float
) -> dict[str, Any]:
    """
    Return between which factors [-] of its speed an onset lies by the law, nine times of ten.

    Two roots of the law, with a film that is off by the `film_factor` of the marches either way;
    `slope` is that of film over height in speed there [-], NaN if all is smooth. A calibrated
    onset has the factor of its calibration.

    """
    law = opened.law
    later, stated, sooner = (
        onset_point(opened.with_law(shifted), lubricant, load, temperature)
        for shifted in (law.shifted(-NINE_OF_TEN), law, law.shifted(NINE_OF_TEN))
    )
    if not stated['speed_rad_s']:
        return {'band': [1.0, 1.0], 'film_factor': 1.0, 'slope': math.nan}
    low, high = (onset['speed_rad_s'] / stated['speed_rad_s'] for onset in (later, sooner))
    reach = NINE_OF_TEN * law.deviation
    across = math.log(sooner['entrainment_speed_m_s'] / later['entrainment_speed_m_s'])
    slope = 2 * reach / across if reach else math.nan
    return {'band': [low, high], 'film_factor': math.exp(reach), 'slope': slope}


def onset_over_working_load(
    screw: Screw, lubricant: Lubricant, load: float, temperature: float, loads: Sequence[float]
) -> list[float]:
    """Return the onset speeds [rad/s] of a screw whose summits were cut under some loads [N]."""
    cut = [Contacts.of(replace(screw, working_load=largest)) for largest in loads]
    return [onset_point(opened, lubricant, load, temperature)['speed_rad_s'] for opened in cut]


def onset_over_pressure(
    screw: Screw, lubricant: Lubricant, load: float, temperature: float, pressures: Sequence[float]
) -> list[float]:
    """Return the onset speeds [rad/s] of a profile that runs in at some pressures [Pa]."""
    worn = [Contacts.of(run_in_at(screw, pressure)) for pressure in pressures]
    return [onset_point(opened, lubricant, load, temperature)['speed_rad_s'] for opened in worn]
