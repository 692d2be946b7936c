# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Validity of inputs in a first map: by columns of marks, between jumps, and in gaps."""

from ballscrew_monitor.recordings.tables.amounts import stays_in_gaps
from ballscrew_monitor.recordings.tables.doubts import unclear_gaps, unclear_none
from ballscrew_monitor.recordings.tables.dropouts import column_of, dropped
from ballscrew_monitor.recordings.tables.first_map.draft import Draft
from ballscrew_monitor.recordings.tables.first_map.own_times import OwnTimes
from ballscrew_monitor.recordings.tables.mapping import MOTOR
from ballscrew_monitor.recordings.words import listed, short
import numpy as np


def set_marks(draft: Draft, name: str, kind: str) -> None:
    """Let the map read an input by its marks, or ask for the cells that mark it."""
    log, place = draft.log, draft.used[name][kind]
    column = short(place['column'])
    for role, mark in log.marks[place['column']].items():
        place[role] = dict(mark)
        if mark['cells'] is not None:
            draft.notes.append(
                f'axis {name}: {column} is {role} where {short(mark["column"])} is '
                f'{listed(mark["cells"])}'
            )
        else:
            draft.ask(
                f'{name}.{kind}.{role}.cells',
                f': the cells of {short(mark["column"])} by which {column} is {role}, of '
                f'{listed(log.mark_cells[mark["column"]])}; or take {role} out of the map',
            )
    if place['column'] in log.none:
        values = log.none[place['column']]
        place['none'] = None
        draft.unstated.append(unclear_none(name, kind, place['column'], values))
    if 'valid' not in place:
        _ask_for_dropouts(draft, name, kind)


def _ask_for_dropouts(draft: Draft, name: str, kind: str) -> None:
    """Let the map say where an input is valid that stands still between two jumps."""
    log, column = draft.log, draft.used[name][kind]['column']
    values = log.data[column]
    lost = dropped(values)
    if not lost.any():
        return
    held = {*(one.column for one in log.inputs), *log.timed}
    others = [name for name in log.source.names() if name not in held]
    mark, cells = column_of(lost, log.source.blocks(others)) if others else ('', [])
    beside = f', while {short(mark)} is one of {listed(cells)}' if mark else ''
    at = int(np.argmax(lost))
    draft.ask(
        f'{name}.{kind}.valid',
        f', the column and its cells by which {short(column)} is valid, or leave those cells '
        f'empty: it jumps to {values[at]:g} in row {log.first_row + at} and back after '
        f'{np.count_nonzero(lost)} rows{beside}; take valid out of the map if it is so',
        {'column': mark or None, 'cells': None},
    )


def ask_for_gaps(draft: Draft, times: OwnTimes, name: str) -> None:
    """Let the map say whether values stay in gaps, where the speed is the same after them."""
    used = draft.used[name]
    if 'speed' not in used or not times.are_known:
        return
    column = used['speed']['column']
    if stays_in_gaps(times.times(column), draft.log.data[column]):
        for kind in ('speed', 'load', *MOTOR):
            if 'column' in used.get(kind, {}):
                used[kind]['hold'] = None
        draft.unstated.append(unclear_gaps(name, 'speed', column))
