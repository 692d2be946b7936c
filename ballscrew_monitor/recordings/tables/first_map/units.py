# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Units of columns whose names state none that is known: by the motion, by the size, or asked."""

import math

from ballscrew_monitor.core import conversions
from ballscrew_monitor.core.conversions import LINEAR_POSITION_UNITS
from ballscrew_monitor.recordings.tables import estimates, names
from ballscrew_monitor.recordings.tables.cells import Array
from ballscrew_monitor.recordings.tables.first_map.draft import Draft
from ballscrew_monitor.recordings.tables.first_map.machine import LEADS
from ballscrew_monitor.recordings.tables.mapping import MOTOR, NUMBERS
from ballscrew_monitor.recordings.tables.quantities import MOTION, RATED, UNITS
from ballscrew_monitor.recordings.tables.unit_names import words_of
from ballscrew_monitor.recordings.words import short
import numpy as np
from surrogate.units import MILLI, TURN

OF_DEGF = 'scale 0.555556 and offset -17.7778 make of it'
WARM = 50.0  # [degC] from which on numbers may as well be of degF, a cool machine
TURNS = 6.3  # range of a joint from which its unit is no metre
OF_JOINT = {'position': 'rad', 'speed': 'rad/s', 'torque': 'N m'}
"""Units of a joint that turns."""
SPEED_UNITS = {False: conversions.LINEAR_SPEED_UNITS, True: conversions.ROTARY_SPEED_UNITS}
POSITION_UNITS = {False: LINEAR_POSITION_UNITS, True: conversions.ROTARY_POSITION_UNITS}
"""Units of a table, and of a screw."""


def leave_out_unitless(draft: Draft, name: str) -> None:
    """Leave out torques and currents of an unknown unit but for that which tells the load."""
    used, chosen = draft.used[name], draft.log.axes[name]
    source = next((kind for kind in ('load', *MOTOR) if kind in used), '')
    for kind in MOTOR:
        if kind not in used or kind == source or chosen[kind].unit:
            continue
        column = chosen[kind].column
        if _of_joint(draft, name, kind):
            continue
        used.pop(kind)
        draft.notes.append(
            f'axis {name}: {column} states no unit that is known, and {chosen[source].column} '
            f'tells the load: it is left out; state `{kind}: {{column: {column}, unit: '
            f'{next(iter(UNITS[kind]))}}}` in the map to read it'
        )


def set_unit(draft: Draft, name: str, kind: str) -> None:
    """Let the map say in which unit an input is, by its name or numbers, or ask for it."""
    place, stated = draft.used[name][kind], draft.log.axes[name][kind].unit
    if 'unit' in place:
        return
    if stated == RATED and 0.0 < np.nanmax(np.abs(draft.log.extremes[place['column']])) <= 1.0:
        most = f'{place["column"]} holds {_largest(draft.log.extremes[place["column"]])} at most'
        draft.ask(f'{name}.{kind}.unit', f": {most}: '%', with scale 100 beside if 1 means 100 %")
        return
    if stated:
        place['unit'] = stated
        return
    if kind == 'position' and name in draft.agreeing and not _of_joint(draft, name, kind):
        place['unit'] = None  # which is asked for with that of the speed
        return
    unit, why = _unit(draft, name, kind)
    if unit:
        why = f'{place["column"]} states none that is known; {why}'
        draft.assume(f'{name}.{kind}.unit', unit, why)
        return
    units = f', {" or ".join(UNITS[kind])}' if kind not in MOTION else ''
    draft.ask(f'{name}.{kind}.unit', f'{units}: {why}')


def _unit(draft: Draft, name: str, kind: str) -> tuple[str, str]:
    """Return the unit of an input and why, or no unit and why the map must state it."""
    column = draft.used[name][kind]['column']
    if unit := _of_joint(draft, name, kind):
        return unit, 'positions of joints are in rad or m, and none is so large in m'
    if kind == 'position':
        return _of_position(draft, name, column)
    if kind == 'speed':
        turning = names.turning_unit(column)
        turns = turning, 'its name is that of a turning speed'
        return turns if turning else _of_speed(draft, name, column)
    if kind == 'load':
        return '', _of_load(draft, name, column)
    if kind in MOTOR:
        return '', f'{column} states none that is known, and tells the load'
    if kind == 'temperature' and words_of(column)[-1:] == ['f']:
        return '', f'{column} may be in degF: unit degC, {OF_DEGF}'
    if kind == 'temperature':
        return _of_temperature(draft, name, column)
    return next(iter(UNITS[kind])), 'the usual one'


def _of_temperature(draft: Draft, name: str, column: str) -> tuple[str, str]:
    """Return the unit of a temperature and why, which is said; or why the map must state it."""
    least, most = draft.log.extremes[column]
    coldest, hottest = NUMBERS['temperature_degC']
    span = f'its values are {least:.3g} to {most:.3g}'
    if WARM <= least and most <= hottest:
        return '', f'{column} states none and may be in degF, {span}: unit degC, {OF_DEGF}'
    unit = 'degC' if coldest <= least and most <= hottest else 'K' if least > hottest else ''
    if not unit:
        return '', f'{column} states none that is known, and {span}'
    draft.notes.append(
        f'axis {name}: {short(column)} states no unit of a temperature: it is read in {unit}, '
        f'{span}'
    )
    return unit, span


def _of_joint(draft: Draft, name: str, kind: str) -> str:
    """Return the unit of a column of a joint that turns, empty for others or if it may slide."""
    log = draft.log
    position = log.axes[name].get('position')
    turns = position is not None and np.ptp(log.extremes[position.column]) > TURNS
    is_joint = draft.used[name][kind]['column'] in log.joints
    return OF_JOINT.get(kind, '') if is_joint and turns else ''


def _of_load(draft: Draft, name: str, column: str) -> str:
    """Return why the unit of a force is open, and what the load may be of instead."""
    log, chosen = draft.log, draft.log.axes[name]
    motors = [chosen[kind] for kind in MOTOR if kind in chosen]
    moving = (one for one in motors if not estimates.is_silent(log.extremes[one.column]))
    motor = next(moving, None)
    instead = ''
    if motor:
        kind, unit = motor.kind, motor.unit or next(iter(UNITS[motor.kind]))
        instead = (
            f'; or write `load: {{from: {kind}}}` and `{kind}: {{column: {motor.column}, unit: '
            f'{unit}}}` there, so that {motor.column} tells the load'
        )
    elif words_of(column)[-1:] == ['a']:
        instead = (
            f'; or if its A means ampere, write `load: {{from: current}}` and `current: '
            f'{{column: {column}, unit: A}}` there'
        )
    elif 'load' in words_of(column):
        instead = (
            '; or if it is that of the motor in per cent, write `load: {from: torque}` and '
            f"`torque: {{column: {column}, unit: '%'}}` there"
        )
    most = _largest(log.extremes[column])
    return f'{column} states none that is known, and forces of up to {most} may be in any{instead}'


def _of_speed(draft: Draft, name: str, column: str) -> tuple[str, str]:
    """Return the unit of a speed and why, or no unit and why the map must state it."""
    log = draft.log
    if 'position' not in draft.used[name]:
        none = f'{column} states none that is known, and no position tells it'
        return '', f'{none}; its largest amount is {_largest(log.extremes[column])}'
    position = log.axes[name]['position']
    unit = position.unit or estimates.position_unit(log.extremes[position.column])[0]
    of_screw = unit in conversions.ROTARY_POSITION_UNITS
    factor = draft.ways[name] * conversions.POSITION_UNITS[unit]
    if math.isnan(factor):
        return estimates.largest_speed_unit(float(np.nanmax(np.abs(log.extremes[column]))))
    fitting = estimates.unit_by_factor(factor, SPEED_UNITS[of_screw])
    if fitting and (position.unit or log.is_metric):
        return fitting, 'it agrees with the position over time'
    if fitting:
        draft.agreeing[name] = {'position': unit, 'speed': fitting}
        return '', (
            f'neither {column} nor {position.column} states one; they agree in {fitting} and '
            f'{unit}, and so they do in inches or turns: state that of the position, too'
        )
    leads = {
        unit: of / factor * TURN if of_screw else factor * TURN / of
        for unit, of in SPEED_UNITS[not of_screw].items()
    }
    least, most = LEADS
    fits = ' or '.join(
        f'{unit} at a lead of {lead * MILLI:.3g} mm'
        for unit, lead in leads.items()
        if least <= lead <= most
    )
    way = f'{factor:.3g} {"rad" if of_screw else "m"} in a second for each of it'
    may = f', as it would in {fits}' if fits else ''
    return '', f'{column} states none that is known, and {position.column} moves {way}{may}'


def _of_position(draft: Draft, name: str, column: str) -> tuple[str, str]:
    """Return the unit of a position and why, or no unit and why the map must state it."""
    log = draft.log
    speed, way = log.axes[name].get('speed'), draft.ways[name]
    if speed is None and not log.is_metric:
        return '', f'{column} states none that is known, and no speed tells it'
    if speed is None or not speed.unit or math.isnan(way):
        return estimates.position_unit(log.extremes[column])
    per_unit = conversions.SPEED_UNITS[speed.unit] / way
    of_screw = speed.unit in conversions.ROTARY_SPEED_UNITS
    if fitting := estimates.unit_by_factor(per_unit, POSITION_UNITS[of_screw]):
        return fitting, 'it agrees with the speed over time'
    least, most = LEADS
    for unit, metres in LINEAR_POSITION_UNITS.items():
        if of_screw and least <= (lead := TURN * metres / per_unit) <= most:
            return unit, f'it agrees with the speed at a lead of {lead * MILLI:.3g} mm'
    return '', (
        f'{column} states none that is known, and moves by {way:.3g} in a second for each '
        f'{speed.unit} of {speed.column}'
    )


def _largest(extremes: Array) -> str:
    return f'{np.nanmax(np.abs(extremes)):.3g}'
