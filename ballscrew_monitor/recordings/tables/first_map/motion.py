# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The speed and the position of an axis, compared: whether both are of one motion, and how."""

import math

from ballscrew_monitor.core import conversions
from ballscrew_monitor.recordings.tables import estimates
from ballscrew_monitor.recordings.tables.doubts import OF_SLOPE, unclear_direction
from ballscrew_monitor.recordings.tables.first_map.draft import Draft
from ballscrew_monitor.recordings.tables.first_map.own_times import OwnTimes
from ballscrew_monitor.recordings.tables.quantities import MOTION
import numpy as np


def compare_motion(draft: Draft, times: OwnTimes, name: str) -> None:
    """Take down the way of a position for its speed; leave out a command, or ask what is wrong."""
    log, used = draft.log, draft.used[name]
    draft.ways[name] = math.nan
    if not set(MOTION) <= set(used):
        return
    speed, position = (log.axes[name][kind] for kind in MOTION)
    clocks = [times.times(one.column) for one in (position, speed)]
    way = math.nan
    if all(map(len, clocks)):
        places = log.places(position.column, position.unit, log.data)
        way = estimates.way_per_speed((clocks[0], places), (clocks[1], log.data[speed.column]))
    draft.ways[name] = abs(way)
    if math.isnan(way):
        columns = [one.column for one in (speed, position)]
        if all(len(times.times(one)) and np.ptp(log.extremes[one]) for one in columns):
            draft.ask(
                f'{name}.speed.unit',
                f': {position.column} does not move as {speed.column} says; take one of both out '
                'of the map if it is wrong',
            )
        return
    _compare_units(draft, name)
    if way < 0.0 and 'speed' in used:
        used['speed']['scale'] = None
        draft.unstated.append(unclear_direction(name, speed.column, position.column))


def _compare_units(draft: Draft, name: str) -> None:
    """Leave out a command that the position does not follow, and ask for another unit."""
    chosen = draft.log.axes[name]
    speed, position = (chosen[kind] for kind in MOTION)
    of_screw = speed.unit in conversions.ROTARY_SPEED_UNITS
    if not speed.unit or not position.unit:
        return
    if of_screw != (position.unit in conversions.ROTARY_POSITION_UNITS):
        return
    factor = draft.ways[name] * conversions.POSITION_UNITS[position.unit]
    factor /= conversions.SPEED_UNITS[speed.unit]
    if abs(factor - 1.0) < estimates.NEAR:
        return
    why = f'{position.column} moves {factor:.3g} times as far as {speed.column} says'
    if speed.rank < 0:
        del draft.used[name]['speed'], chosen['speed']
        draft.ways[name] = math.nan
        draft.notes.append(f'axis {name}: {why}, a command: {OF_SLOPE}')
        return
    draft.ask(f'{name}.speed.unit', f': {why} in {speed.unit}')
