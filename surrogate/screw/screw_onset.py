# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Onset of contact by the topography of the raceways, as a speed of the screw."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
import math
from typing import Any

import numpy as np
from numpy.typing import NDArray
from surrogate.ehl import ContactLubricant
from surrogate.files import InputError
from surrogate.formulas.geometry import Side
from surrogate.formulas.inlet import speed_before_inlet, starved_speed
from surrogate.formulas.line import central_film_line, line_at
from surrogate.formulas.load_sharing import normal_force, nut_forces, working_preload
from surrogate.parameters import Lubricant, OperatingPoint, Screw
from surrogate.raceway.ball import roughness_sentence
from surrogate.raceway.stated import NINE_OF_TEN
from surrogate.screw.contacts import oil_at
from surrogate.screw.opened import Contacts
from surrogate.surface.contact_onset import law_doubt, MARCHED
from surrogate.units import digits, GIGA, MICRO, RPM, ZERO_CELSIUS

Array = NDArray[np.float64]
MARCHED_WAVES = 1.25e-6, 10e-6
"""Short cut-offs among those of the marched strips [m]."""
SMOOTH_ONSET = 1e-3
"""Entrainment speed that stands for the onset of smooth raceways [m/s]."""
ABOVE = 1.1
"""Least pressure at which summits are cut over that of the contact [-]."""
LOAD_FACTORS = 0.5, 2.0
"""Other working loads under which an onset is told, over the stated one [-]."""
WORDS = {'new': 'new, after its first pass', 'run_in': 'run in'}


def onset_speeds(opened: Contacts, lubricant: Lubricant, load: Array, temperature: Array) -> Array:
    """
    Return the screw speeds [rad/s] of the onset over load [N] and temperature [K].

    That of the loaded nut, for the side where contact begins faster.

    """
    found = [
        [
            onset_point(opened, lubricant, force, heat)['speed_rad_s']
            for heat in temperature.tolist()
        ]
        for force in load.tolist()
    ]
    least = SMOOTH_ONSET / starved_speed(lubricant, opened.rates.entrainment)
    return np.maximum(found, least)


def with_raceway(screw: Screw, **changes: Any) -> Screw:
    """Return a screw with other keys of its raceway roughness; marches hold in their state."""
    if changes.get('state', screw.roughness.state) != screw.roughness.state:
        changes = {'marched_film': None, 'marched_error': None, **changes}
    return replace(screw, roughness=replace(screw.roughness, **changes))


def run_in_range(screw: Screw) -> tuple[float, float]:
    """Return the likely range of the pressure of running in [Pa], which the contact must bear."""
    sheet = screw.roughness
    low = max(sheet.run_in_low, ABOVE * Contacts.of(screw).working_pressure)
    return min(low, sheet.run_in_pressure), sheet.run_in_high


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
    force = loaded_force(opened.sheet, load)
    return max(
        (onset.speed(opened.geometry[side], force, oil, floor), side)
        for side, onset in opened.law.onsets.items()
    )


def onset_band(
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
        onset_point(opened.with_law(one), lubricant, load, temperature)
        for one in (law.shifted(-NINE_OF_TEN), law, law.shifted(NINE_OF_TEN))
    )
    if not stated['speed_rad_s']:
        return {'band': [1.0, 1.0], 'film_factor': 1.0, 'slope': math.nan}
    low, high = (one['speed_rad_s'] / stated['speed_rad_s'] for one in (later, sooner))
    reach = NINE_OF_TEN * law.deviation
    across = math.log(sooner['entrainment_speed_m_s'] / later['entrainment_speed_m_s'])
    slope = 2 * reach / across if reach else math.nan
    return {'band': [low, high], 'film_factor': math.exp(reach), 'slope': slope}


def onset_record(
    screw: Screw, lubricant: Lubricant, load: float, temperature: float
) -> dict[str, Any]:
    """
    Return the onsets of a screw, new and run in, under a load [N] at a temperature [K], SI units.

    A profile that was traced after running in has the latter alone, and a raceway whose onset was
    calibrated the state in which that was done.

    """
    _check_place(lubricant, load, temperature)
    stated = screw.working_load is not None
    opened, states = Contacts.of(screw), {}
    if abs(load) > opened.working_load:
        screw = replace(screw, working_load=abs(load))
        opened = Contacts.of(screw)
    sheet, place = screw.roughness, (lubricant, load, temperature)
    alone = sheet.traced == 'run_in' or sheet.calibrated
    for state in [sheet.state] if alone else ['new', 'run_in']:
        raceway = with_raceway(screw, state=state)
        contacts = Contacts.of(raceway)
        states[state] = onset_point(contacts, *place) | {
            'cutting_pressure_Pa': raceway.roughness.cutting_pressure,
            'marched': raceway.roughness.marched_film is not None,
            **onset_band(contacts, *place),
        }
    if len(states) > 1:
        states['run_in']['speed_range_rad_s'] = onset_over_pressure(
            with_raceway(screw, state='run_in'), *place, run_in_range(screw)
        )
    # The lower the pressure at which summits are cut, the more the load matters.
    raceway = with_raceway(screw, state=[*states][-1])
    loads = [factor * opened.working_load for factor in LOAD_FACTORS]
    return {
        'screw': screw.name,
        'oil': lubricant.name,
        'load_N': load,
        'temperature_K': temperature,
        'working_load_N': opened.working_load,
        'working_load_stated': stated,
        'other_working_loads_N': loads,
        'other_working_load_speeds_rad_s': onset_over_working_load(raceway, *place, loads),
        'working_pressure_Pa': opened.working_pressure,
        'roughness': roughness_sentence(screw.roughness, screw.ball_roughness),
        'extrapolated': extrapolated(screw),
        'states': states,
    }


def _check_place(lubricant: Lubricant, load: float, temperature: float) -> None:
    """Raise InputError for a load [N] or temperature [K] that no point may have."""
    OperatingPoint(speed=0.0, load=load, temperature=temperature)
    low, high = lubricant.minimum_temperature, lubricant.maximum_temperature
    if not low <= temperature <= high:
        raise InputError(
            f'temperature is {temperature - ZERO_CELSIUS:g} degC, allowed is '
            f'{low - ZERO_CELSIUS:g} to {high - ZERO_CELSIUS:g} degC (the range of the oil sheet)'
        )


def extrapolated(screw: Screw) -> list[str]:
    """Return where a screw lies outside the strips that were marched, in words."""
    sheet, (shortest, longest) = screw.roughness, MARCHED_WAVES
    found = [law_doubt(rms=sheet.rms, measured=sheet.measured)]
    if not shortest <= sheet.cutoff_short <= longest:
        found.append(f'short cut-off {MICRO * sheet.cutoff_short:g} um (marched: 1.3 to 9.8 um)')
    if screw.ball_roughness is not None:
        found.append('rough balls (marched: smooth ones)')
    return [text for text in found if text]


def onset_page(record: Mapping[str, Any]) -> str:
    """Return the lines that a person reads."""
    return '\n'.join(_lines(record))


def _lines(record: Mapping[str, Any]) -> Iterator[str]:
    yield (
        f'{record["screw"]}, {record["oil"]}: {record["load_N"]:g} N, '
        f'{record["temperature_K"] - ZERO_CELSIUS:g} degC'
    )
    for state, found in record['states'].items():
        yield f'  {WORDS[state]:26} {_told(found)}'
    states = record['states'].values()
    slowest = min(
        one['band'][0] * min(one.get('speed_range_rad_s', [one['speed_rad_s']])) for one in states
    )
    fastest = max(one['band'][1] * one['speed_rad_s'] for one in states)
    if fastest:
        yield (
            f'  Contact is likely below {digits(slowest / RPM)} rev/min and possible below '
            f'{digits(fastest / RPM)} rev/min.'
        )
    assumed = '' if record['working_load_stated'] else ', assumed: it unloads the relieved nut'
    yield (
        f'  summits are cut under {_newtons(record["working_load_N"])}{assumed}, '
        f'{GIGA * record["working_pressure_Pa"]:.3g} GPa'
    )
    if fastest:
        yield f'  {_over_load(record)}'
    for words in record['extrapolated']:
        yield f'  extrapolated: {words}'
    yield f'  roughness: {record["roughness"]}'


def _told(found: Mapping[str, Any]) -> str:
    """Say where contact begins in one state."""
    if not found['speed_rad_s']:
        return 'no contact: raceway and ball are smooth'
    cut = found['cutting_pressure_Pa']
    low, high = (share * found['speed_rad_s'] / RPM for share in found['band'])
    text = (
        f'{MARCHED * found["marched"]}contact begins at {digits(found["speed_rad_s"] / RPM)} '
        f'rev/min ({digits(low)} to {digits(high)}), film {1e9 * found["central_film_m"]:.3g} nm, '
        f'cut at {GIGA * cut:g} GPa'
    )
    if 'speed_range_rad_s' in found:
        low, high = (speed / RPM for speed in found['speed_range_rad_s'])
        text += f'; {digits(low)} to {digits(high)} rev/min over the range of that pressure'
    return text


def _over_load(record: Mapping[str, Any]) -> str:
    """Say where contact begins in the last state if other loads had cut its summits."""
    loads, speeds = record['other_working_loads_N'], record['other_working_load_speeds_rad_s']
    low, high = (
        f'at {digits(speed / RPM)} rev/min if it was {_newtons(load)}'
        if math.isfinite(speed)
        else f'at an unknown speed if it was {_newtons(load)}, more than the summits bear'
        for load, speed in zip(loads, speeds, strict=True)
    )
    return f'that load matters: {WORDS[[*record["states"]][-1]]}, contact begins {low}, {high}'


def _newtons(load: float) -> str:
    return f'{digits(load, 4)} N'


def onset_over_working_load(
    screw: Screw, lubricant: Lubricant, load: float, temperature: float, loads: Sequence[float]
) -> list[float]:
    """
    Return the onset speeds [rad/s] of a screw whose summits were cut under some loads [N].

    NaN where a load presses the contact by more than the pressure at which summits are cut.

    """
    found = []
    for largest in loads:
        try:
            pressed = Contacts.of(replace(screw, working_load=largest))
            point = onset_point(pressed, lubricant, load, temperature)
        except InputError:
            point = {'speed_rad_s': math.nan}
        found.append(point['speed_rad_s'])
    return found


def onset_over_pressure(
    screw: Screw, lubricant: Lubricant, load: float, temperature: float, pressures: Sequence[float]
) -> list[float]:
    """Return the onset speeds [rad/s] of a profile that runs in at some pressures [Pa]."""
    worn = [Contacts.of(run_in_at(screw, pressure)) for pressure in pressures]
    return [onset_point(one, lubricant, load, temperature)['speed_rad_s'] for one in worn]
