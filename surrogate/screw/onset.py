# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Onset of contact by the topography of the raceways, as a speed of the screw."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from typing import Any

from surrogate.asperities.onset import onset_of
from surrogate.asperities.running_in import Cut, State, USUAL
from surrogate.files import InputError
from surrogate.formulas.geometry import hertz, screw_contact, SIDES
from surrogate.formulas.kinematics import no_slip_rates
from surrogate.formulas.line import central_film_line, line_at
from surrogate.formulas.load_sharing import normal_force, nut_forces, working_preload
from surrogate.formulas.starvation import starved_speed
from surrogate.parameters import Lubricant, OperatingPoint, Screw
from surrogate.raceway.ball import roughness_sentence
from surrogate.screw.contacts import oil_at
from surrogate.units import GIGA, MICRO, RPM, ZERO_CELSIUS

BANDS = {'isotropic': 1.3, 'longitudinal': 2.0, 'transverse': 2.0}
"""Factor within which the topography tells nine of ten marched strips, by the lay [-]; seven of
the strips had a longitudinal lay, two a transverse one."""
MARCHED_RMS, MARCHED_WAVES = (0.06e-6, 0.24e-6), (1.25e-6, 10e-6)
"""Rq and short cut-offs within a factor of 2 of, and among, those of the marched strips [m]."""
STATES: tuple[State, ...] = ('new', 'run_in')
WORDS = {'new': 'new, after its first pass', 'run_in': 'run in'}


def onset_point(
    screw: Screw,
    lubricant: Lubricant,
    load: float,
    temperature: float,
    state: State,
    cut: Cut = USUAL,
) -> dict[str, float]:
    """
    Return where contact begins under an axial load [N] at an oil temperature [K].

    Screw speed [rad/s], entrainment speed [m/s] and smooth central film [m] of the loaded nut, of
    the side where contact begins at the faster speed; all 0 for smooth raceways. Raises InputError
    as `running_tiles` does.

    """
    loaded = float(nut_forces(load, screw.preload)[0]) or working_preload(screw)
    force, oil = float(normal_force(screw, loaded)), oil_at(lubricant, temperature)
    found = {
        side: onset_of(screw, side, state, cut).speed(
            screw_contact(screw, side), force, oil, lubricant.film_floor
        )
        for side in SIDES
    }
    side = max(SIDES, key=found.__getitem__)
    if not found[side]:
        return {'speed_rad_s': 0.0, 'entrainment_speed_m_s': 0.0, 'central_film_m': 0.0}
    line = line_at(screw_contact(screw, side), force, 0.0)
    film = central_film_line(line, found[side], oil.viscosity, oil.pressure_viscosity)
    rate = float(starved_speed(lubricant, no_slip_rates(screw).entrainment))
    return {
        'speed_rad_s': found[side] / rate,
        'entrainment_speed_m_s': found[side],
        'central_film_m': float(film),
    }


def onset_record(
    screw: Screw, lubricant: Lubricant, load: float, temperature: float, cut: Cut = USUAL
) -> dict[str, Any]:
    """Return the onsets of both states under a load [N] at a temperature [K], SI units."""
    _check_place(lubricant, load, temperature)
    cut = replace(cut, working_load=abs(load)) if abs(load) > cut.load(screw) else cut
    band = BANDS[screw.roughness.lay]
    loaded = float(nut_forces(cut.load(screw), screw.preload)[0])
    force = float(normal_force(screw, loaded))
    states = {}
    for state in STATES[1:] if cut.traced_run_in else STATES:
        states[state] = onset_point(screw, lubricant, load, temperature, state, cut) | {
            'cutting_pressure_Pa': cut.pressure(state),
            'band': [1 / band, band],
        }
    if not cut.traced_run_in:
        states['run_in']['speed_range_rad_s'] = [
            onset_point(screw, lubricant, load, temperature, 'run_in', cut_at(cut, bound))[
                'speed_rad_s'
            ]
            for bound in cut.run_in_range
        ]
    return {
        'screw': screw.name,
        'oil': lubricant.name,
        'load_N': load,
        'temperature_K': temperature,
        'working_load_N': cut.load(screw),
        'working_load_stated': cut.working_load is not None,
        'working_pressure_Pa': max(
            float(hertz(screw_contact(screw, side), force).max_pressure) for side in SIDES
        ),
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
    sheet = screw.roughness
    words = {
        f'Rq {MICRO * sheet.rms:g} um (marched: 0.12 um)': MARCHED_RMS,
        f'short cut-off {MICRO * sheet.cutoff_short:g} um (marched: 1.3 to 9.8 um)': MARCHED_WAVES,
    }
    values = sheet.rms, sheet.cutoff_short
    found = [
        text
        for value, (text, (low, high)) in zip(values, words.items(), strict=True)
        if value and not low <= value <= high
    ]
    return found + ['rough balls (marched: smooth ones)'] * (screw.ball_roughness is not None)


def cut_at(cut: Cut, pressure: float) -> Cut:
    """Return a cut that runs in to one pressure [Pa] alone."""
    return replace(
        cut,
        hardness=max(cut.hardness, pressure),
        run_in_pressure=pressure,
        run_in_range=(pressure, pressure),
    )


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
    slowest = min(
        min(one.get('speed_range_rad_s', [one['speed_rad_s']]))
        for one in record['states'].values()
    )
    fastest = max(one['speed_rad_s'] for one in record['states'].values())
    low, high = next(iter(record['states'].values()))['band']
    if fastest:
        yield (
            f'  Contact is likely below {low * slowest / RPM:.3g} rev/min and possible below '
            f'{high * fastest / RPM:.3g} rev/min.'
        )
    assumed = '' if record['working_load_stated'] else ', assumed: it unloads the relieved nut'
    yield (
        f'  summits are cut under {record["working_load_N"]:.4g} N{assumed}, '
        f'{GIGA * record["working_pressure_Pa"]:.3g} GPa'
    )
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
        f'contact begins at {found["speed_rad_s"] / RPM:.3g} rev/min ({low:.3g} to {high:.3g}), '
        f'film {1e9 * found["central_film_m"]:.3g} nm, cut at {GIGA * cut:g} GPa'
    )
    if 'speed_range_rad_s' in found:
        low, high = (speed / RPM for speed in found['speed_range_rad_s'])
        text += f'; {low:.3g} to {high:.3g} rev/min over the range of that pressure'
    return text


def onset_over_pressure(
    screw: Screw, lubricant: Lubricant, load: float, temperature: float, cuts: Sequence[Cut]
) -> list[float]:
    """Return the onset speeds [rad/s] of a profile that runs in, under a load [N], for cuts."""
    return [
        onset_point(screw, lubricant, load, temperature, 'run_in', cut)['speed_rad_s']
        for cut in cuts
    ]
