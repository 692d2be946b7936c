# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Signs of inputs in a first map: amounts, torques that brake all the time, one direction."""

from ballscrew_monitor.recordings.tables.amounts import are_amounts, brakes_always, slopes
from ballscrew_monitor.recordings.tables.doubts import (
    are_apart,
    of_amounts,
    unclear_brake,
    unclear_sign,
)
from ballscrew_monitor.recordings.tables.first_map.draft import Draft
from ballscrew_monitor.recordings.tables.first_map.own_times import OwnTimes
from ballscrew_monitor.recordings.tables.mapping import MOTOR, SIGNED
from ballscrew_monitor.recordings.tables.quantities import MOTION


def set_sign(draft: Draft, times: OwnTimes, name: str, kind: str) -> None:
    """Let the map say whether an input holds amounts, or ask for that, or for its direction."""
    log, used, chosen = draft.log, draft.used[name], draft.log.axes[name]
    place = used[kind]
    if kind not in SIGNED or 'backward' in place:
        return
    data = {
        each: log.places(used[each]['column'], chosen[each].unit, log.sampled)
        for each in (*MOTION, *SIGNED)
        if each in used
    }
    columns = (used[each]['column'] for each in {*MOTION, kind} & set(data))
    magnitude = are_amounts(
        kind,
        data,
        makes_load='load' not in used,
        own_time=len({*map(times.of_inputs.get, columns)}) > 1,
    )
    program = log.head.program
    if magnitude is None and kind in MOTOR and program and program.are_amounts:
        magnitude = True
    motion = (chosen.get('speed') or chosen['position']).column
    apart = kind in MOTOR and are_apart(log.table, place['column'], motion)
    if magnitude is None:
        place['magnitude'] = None
        draft.unstated.append(unclear_sign(name, kind, place['column'], apart=apart))
    elif magnitude:
        place['magnitude'] = True
        draft.notes.append(of_amounts(name, kind, place['column']))
    elif kind in MOTOR and 'load' not in used and not apart:
        groups = {times.of_inputs.get(column, '') for column in (place['column'], motion)}
        speed = data['speed'] if 'speed' in data else slopes(data['position'])
        if len(groups) == 1 and brakes_always(data[kind], speed):
            scale, place['scale'] = chosen[kind].scale, None
            draft.unstated.append(unclear_brake(name, kind, place['column'], scale))


def assume_direction(draft: Draft, name: str) -> None:
    """Assume of a speed of one sign without a position that it is of one direction."""
    used = draft.used[name]
    if 'speed' not in used or 'position' in used or {'magnitude', 'backward'} & set(used['speed']):
        return
    column = used['speed']['column']
    least, most = draft.log.extremes[column]
    if least * most >= 0.0 and most > least:
        why = (
            f'{column} never changes its sign, and no position tells whether it has one: all '
            'motion is taken to be in one direction'
        )
        draft.assume(f'{name}.speed.magnitude', False, why)
