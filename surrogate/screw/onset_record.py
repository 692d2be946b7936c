# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Record and page of the onset of contact, new and run in, with its band."""

from collections.abc import Iterator, Mapping
from dataclasses import replace
from typing import Any

from surrogate.files import InputError
from surrogate.parameters import Lubricant, OperatingPoint, Screw
from surrogate.raceway.ball import roughness_sentence
from surrogate.screw.onset_bands import onset_bands
from surrogate.screw.opened import Contacts
from surrogate.screw.screw_onset import (
    law_band,
    onset_over_working_load,
    onset_point,
    with_raceway,
)
from surrogate.surface.contact_onset import law_doubt, MARCHED
from surrogate.surface.lookup import both_bands
from surrogate.units import digits, GIGA, MICRO, RPM, ZERO_CELSIUS

MARCHED_WAVES = 1.25e-6, 10e-6
"""Short cut-offs among those of the marched strips [m]."""
LOAD_FACTORS = 0.5, 2.0
"""Other working loads under which an onset is told, over the stated one [-]."""
WORDS = {'new': 'new, after its first pass', 'run_in': 'run in'}


def onset_record(
    screw: Screw, lubricant: Lubricant, load: float, temperature: float
) -> dict[str, Any]:
    """
    Return the onsets of a screw, new and run in, under a load [N] at a temperature [K], SI units.

    A profile that was traced after running in has the latter alone, and a raceway whose onset was
    calibrated the state in which that was done.

    """
    OperatingPoint(speed=0.0, load=load, temperature=temperature)  # which checks both
    low, high = lubricant.minimum_temperature, lubricant.maximum_temperature
    if not low <= temperature <= high:
        raise InputError(
            f'temperature is {temperature - ZERO_CELSIUS:g} degC, allowed is '
            f'{low - ZERO_CELSIUS:g} to {high - ZERO_CELSIUS:g} degC (the range of the oil sheet)'
        )
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
        bands = onset_bands(raceway, *place)
        states[state] = {
            **onset_point(contacts, *place),
            'cutting_pressure_Pa': raceway.roughness.cutting_pressure,
            'marched': raceway.roughness.marched_film is not None,
            **law_band(contacts, *place),
            'band': list(bands.whole),
            **bands.record(),
        }
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


def extrapolated(screw: Screw) -> list[str]:
    """Return where a screw lies outside the strips that were marched, in words."""
    sheet, (shortest, longest) = screw.roughness, MARCHED_WAVES
    texts = [law_doubt(rms=sheet.rms, likely_rms=sheet.likely_rms, measured=sheet.measured)]
    if not shortest <= sheet.cutoff_short <= longest:
        texts.append(f'short cut-off {MICRO * sheet.cutoff_short:g} um (marched: 1.3 to 9.8 um)')
    if screw.ball_roughness is not None:
        texts.append('rough balls (marched: smooth ones)')
    return [text for text in texts if text]


def onset_page(record: Mapping[str, Any]) -> str:
    """Return the lines that a person reads."""
    return '\n'.join(_lines(record))


def _lines(record: Mapping[str, Any]) -> Iterator[str]:
    yield (
        f'{record["screw"]}, {record["oil"]}: {record["load_N"]:g} N, '
        f'{record["temperature_K"] - ZERO_CELSIUS:g} degC'
    )
    for state, onset in record['states'].items():
        yield f'  {WORDS[state]:26} {_told(onset)}'
        yield from (f'  {"":26} {words}' for words in _narrowed(onset))
    states = record['states'].values()
    slowest, fastest = (
        pick(state['band'][end] * state['speed_rad_s'] for state in states)
        for end, pick in enumerate((min, max))
    )
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


def _told(onset: Mapping[str, Any]) -> str:
    """Say where contact begins in one state."""
    if not onset['speed_rad_s']:
        return 'no contact: raceway and ball are smooth'
    cut = onset['cutting_pressure_Pa']
    low, high = (share * onset['speed_rad_s'] / RPM for share in onset['band'])
    return (
        f'{MARCHED * onset["marched"]}contact begins at {digits(onset["speed_rad_s"] / RPM)} '
        f'rev/min ({digits(low)} to {digits(high)}), film {1e9 * onset["central_film_m"]:.3g} nm, '
        f'cut at {GIGA * cut:g} GPa'
    )


def _narrowed(onset: Mapping[str, Any]) -> Iterator[str]:
    """Yield what of the band the measurement leaves that narrows it most."""
    for step in onset['measure'][:1]:
        left = both_bands(step['limit_band'], onset['numerical_band'])
        low, high = (digits(share * onset['speed_rad_s'] / RPM) for share in left)
        yield f'a measured {step["measurement"]} leaves {low} to {high} rev/min'


def _over_load(record: Mapping[str, Any]) -> str:
    """Say where contact begins in the last state if other loads had cut its summits."""
    loads, speeds = record['other_working_loads_N'], record['other_working_load_speeds_rad_s']
    low, high = (_newtons(load) for load in loads)
    faster, slower = (f'{digits(speed / RPM)} rev/min' for speed in speeds)
    state = WORDS[[*record['states']][-1]]
    return f'{state} under {low}, contact begins at {faster}, under {high} at {slower}'


def _newtons(load: float) -> str:
    return f'{digits(load, 4)} N'
