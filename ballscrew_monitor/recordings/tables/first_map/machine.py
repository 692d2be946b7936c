# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The machine in a first map: screw, oil, lead, load, gear, motor and temperature."""

import functools
import math

from ballscrew_monitor.core import conversions
from ballscrew_monitor.recordings.tables import names
from ballscrew_monitor.recordings.tables.first_map.draft import Draft
from ballscrew_monitor.recordings.tables.mapping import MOTOR
from ballscrew_monitor.recordings.tables.quantities import MOTION, RATED
from ballscrew_monitor.recordings.tables.unit_names import unknown_unit, words_of
from ballscrew_monitor.recordings.words import short
from surrogate.surface import find_surface, Surface
from surrogate.units import MILLI, TURN

SCREW, OIL = 'nominal', 'iso_vg_68'
EFFICIENCY = 0.9
TEMPERATURE = 40.0  # [degC]
SAME_LEAD = 0.01  # part by which a lead out of a log may miss a usual one
LEADS = (1e-3, 0.1)  # [m] of ball screws
OF_THE_MOTOR = frozenset('motor mot drive servo antrieb moteur motore'.split())
_TURNING_UNITS = {*conversions.ROTARY_POSITION_UNITS, *conversions.ROTARY_SPEED_UNITS}
FORCE = (
    '2 pi efficiency torque / lead against the torque: friction of guides and seals, and what '
    'accelerates the axis, count as load'
)


def state_machine(draft: Draft, name: str) -> None:
    """Say of the machine of an axis what the head of the log does, assume or ask the rest."""
    used = draft.used[name]
    for key, value in (('screw', SCREW), ('oil', OIL)):
        stated = _statement(draft, key) or 'the log does not say it'
        draft.assume(f'{name}.{key}', value, f'{stated}; the shipped one')
    _set_lead(draft, name)
    _set_load(draft, name)
    if 'gear' in draft.log.head.machine:
        _ask_for_gear(draft, name)
    else:
        _assume_no_gear(draft, name)
    if 'torque' in used and draft.unit(name, 'torque') == RATED:
        _state_motor(draft, name, 'torque')
    if 'temperature' not in used:
        _set_temperature(draft, name)
    elif not names.is_of_the_screw(used['temperature']['column']):
        column = used['temperature'].pop('column')
        draft.assume(f'{name}.temperature.column', column, 'taken for that of the oil')


def _set_temperature(draft: Draft, name: str) -> None:
    """Ask for the temperature of the oil if a column has it in an unknown unit, else assume it."""
    axes = {'', *(one.axis for one in draft.log.axes[name].values())}
    for one in draft.log.named:
        if (
            one.doubtful == 'temperature'
            and one.axis in axes
            and names.is_of_the_screw(one.column)
        ):
            unit = unknown_unit(one.column, one.doubtful)
            why = f'{short(one.column)} is in {short(unit)}, {names.not_of_maps(one)}'
            draft.ask(f'{name}.temperature_degC', f', or its column: {why}')
            return
    why = 'no column is the oil temperature of this axis'
    _set_by_head(draft, name, 'temperature_degC', TEMPERATURE, why)


def _statement(draft: Draft, key: str) -> str:
    """Return the line of the head that says something of the machine, empty for none."""
    stated = draft.log.head.machine.get(key)
    return f'the head says {short(repr(stated.text))}' if stated else ''


def _set_by_head(draft: Draft, name: str, key: str, usual: float, why: str) -> None:
    """Take a number from the head if it is clear, ask if it is not, else assume the usual."""
    stated = draft.log.head.machine.get(key)
    if stated is None:
        draft.assume(f'{name}.{key}', usual, why)
    elif math.isfinite(stated.value) and len(draft.log.axes) == 1:
        draft.assume(f'{name}.{key}', stated.value, _statement(draft, key))
    else:
        draft.ask(f'{name}.{key}', f': {_statement(draft, key)}')


def _set_lead(draft: Draft, name: str) -> None:
    """Assume the lead of the usual screw; where the log has another the map states it."""
    usual, lead, place = _usual_lead(), _lead(draft, name), f'{name}.lead_mm'
    stated = draft.log.head.machine.get('lead_mm')
    if stated and not abs(lead * MILLI / stated.value - 1.0) > SAME_LEAD:
        _set_by_head(draft, name, 'lead_mm', math.nan, '')
    elif stated:
        statement = _statement(draft, 'lead_mm')
        draft.ask(place, f': {statement}, while position and speed agree at {lead * MILLI:.3g} mm')
    elif math.isfinite(lead) and abs(lead / usual - 1.0) > SAME_LEAD:
        position, speed = (draft.log.axes[name][kind].column for kind in ('position', 'speed'))
        draft.ask(
            place,
            f': {position} and {speed} agree at {lead * MILLI:.3g} mm; behind a gear a scale '
            'makes of either that of the screw',
        )
    else:
        agrees = f'that of {SCREW}, at which position and speed agree'
        why = agrees if math.isfinite(lead) else f'the log does not say it; that of {SCREW}'
        draft.assume(place, float(f'{usual * MILLI:.6g}'), why)


@functools.cache
def _usual_lead() -> float:
    """Return the lead [m] of the screw that is assumed."""
    return Surface.load(find_surface('', SCREW, OIL), screw=SCREW, oil=OIL).lead


def _lead(draft: Draft, name: str) -> float:
    """Return the lead [m] by which the speed of a screw makes a position, NaN: not known."""
    way = draft.ways[name]
    units = [draft.unit(name, kind) for kind in MOTION if kind in draft.used[name]]
    if math.isnan(way) or not all(units):
        return math.nan
    speed, position = units
    of_screw = speed in conversions.ROTARY_SPEED_UNITS
    if of_screw == (position in conversions.ROTARY_POSITION_UNITS):
        return math.nan
    factor = way * conversions.POSITION_UNITS[position] / conversions.SPEED_UNITS[speed]
    return TURN * factor if of_screw else TURN / factor


def _set_load(draft: Draft, name: str) -> None:
    """Let the load be that of a column, of the motor, or unknown for a reason."""
    log, used, chosen = draft.log, draft.used[name], draft.log.axes[name]
    if 'load' in used:
        return
    source = next((kind for kind in MOTOR if kind in used), '')
    if source:
        draft.assume(f'{name}.load.from', source, f'no force is in the log; {FORCE}')
        draft.assume(f'{name}.efficiency', EFFICIENCY, 'usual for a ball screw')
        if source == 'current':
            _state_motor(draft, name, source)
        return
    silent = [chosen[kind].column for kind in ('load', *MOTOR) if kind in chosen]
    lost = [f'{", ".join(log.lost[name])} holds no number'] if log.lost[name] else []
    still = [f'{", ".join(silent)} is always 0'] if silent else []
    doubtful = [
        f'{one.column} is in {unknown_unit(one.column, one.doubtful)}, {names.not_of_maps(one)}'
        for one in log.named
        if one.doubtful in ('load', *MOTOR)
        and one.axis in ('', *(each.axis for each in chosen.values()))
    ]
    why = ', '.join([*lost, *still, *doubtful]) or 'no force, torque or current'
    used['load'] = {'unknown': why}
    draft.notes.append(f'axis {name}: the load is not known ({why}), nothing will be judged')


def _state_motor(draft: Draft, name: str, kind: str) -> None:
    """Ask for what makes a torque of a current, or of one in %, unless the head states it."""
    column, plate = draft.log.axes[name][kind].column, 'it is on the plate of the motor'
    if draft.unit(name, kind) != RATED:
        key, why = 'torque_constant_Nm_per_A', f', the torque at the screw of 1 A: {column} is '
        stated = draft.log.head.machine.get(key)
        if stated:
            _set_by_head(draft, name, key, math.nan, '')
            return
        draft.ask(f'{name}.{key}', f'{why}the current that tells the load, and {plate}')
        return
    draft.ask(
        f'{name}.torque_rated_Nm',
        f', the torque at the screw of 100 %: {column} is in % of it, and {plate}',
    )


def _ask_for_gear(draft: Draft, name: str) -> None:
    """Let the map scale what may be of the motor where the head states a gear."""
    used = draft.used[name]
    if draft.log.head.machine['gear'].value == 1.0:
        return
    for kind in filter(used.__contains__, (*MOTION, *MOTOR)):
        turns = draft.unit(name, kind) in _TURNING_UNITS
        makes_load = kind in MOTOR and used.get('load', {}).get('from') == kind
        if turns or makes_load or 'load' not in used:
            draft.ask(
                f'{name}.{kind}.scale',
                f', what makes {used[kind]["column"]} that of the screw, '
                f'{used[kind].get("scale") or 1.0:g} if it is: '
                f'{_statement(draft, "gear")}',
            )


def _assume_no_gear(draft: Draft, name: str) -> None:
    """
    Assume of what names the motor that the screw turns so, where nothing tells a gear.

    The assumed scale is that of the unit, 1 for one of a map.

    """
    used, turning = draft.used[name], _TURNING_UNITS
    motion = [kind for kind in MOTION if kind in used]
    if draft.log.head.factors:
        return  # each scale is asked for
    alone = all(draft.unit(name, kind) in turning for kind in motion)
    for kind in [*(motion if alone else []), *({'torque'} & set(used))]:
        of_motor = OF_THE_MOTOR & set(words_of(used[kind]['column']))
        is_open = used[kind].get('scale', 1.0) is None
        if of_motor and not is_open and draft.unit(name, kind) != RATED:
            column, of_unit = used[kind]['column'], used[kind].pop('scale', 1.0)
            why = f'{column} is of the motor, taken to drive the screw without a gear'
            draft.assume(f'{name}.{kind}.scale', of_unit, why)
