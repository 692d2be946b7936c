# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Questions and notes of a first map on columns beside those of the axes, and on factors."""

import itertools
from typing import Any

from ballscrew_monitor.recordings.tables import estimates, names
from ballscrew_monitor.recordings.tables.doubts import unclear_factors
from ballscrew_monitor.recordings.tables.first_map.columns import Columns
from ballscrew_monitor.recordings.tables.first_map.draft import Draft
from ballscrew_monitor.recordings.tables.names import Named
from ballscrew_monitor.recordings.tables.quantities import INPUTS
from ballscrew_monitor.recordings.words import short
import numpy as np

APART = 0.05  # of the rows that hold neither of two signals of joined tables
MANY = 10  # rows of which one is not known, of a signal in the rows of another
SAME_WAY = 0.05  # of its way by which a position may differ from another of the same axis


def ask_for_columns(draft: Draft, name: str) -> None:
    """Let the map name the column of a quantity that several may be."""
    log = draft.log
    for kind, one in log.axes[name].items():
        if kind not in draft.used[name] or kind == 'temperature':
            continue
        others = [
            other.column
            for other in names.rivals(log.by_axis[name], one)
            if not estimates.is_silent(log.extremes.get(other.column, np.ones(1)))
            and not (names.may_agree(one, other) and _agree(log, one, other))
        ]
        if others:
            draft.ask(f'{name}.{kind}.column', f': {" or ".join([one.column, *others])}')


def _agree(log: Columns, one: Named, other: Named) -> bool:
    """Return True if two columns of one unit hold the same but for an offset, or no number."""
    if other.column not in log.data:
        return True
    columns = log.sampled[one.column], log.sampled[other.column] * other.scale
    if not (np.isfinite(columns[0]) & np.isfinite(columns[1])).any():
        columns = log.extremes[one.column], log.extremes[other.column] * other.scale
    ways = [float(np.nanmax(each) - np.nanmin(each)) for each in (*columns, np.subtract(*columns))]
    return ways[2] <= SAME_WAY * max(ways)


def ask_for_factors(draft: Draft) -> None:
    """Let the map say what scales the columns of a head that states factors."""
    factors = draft.log.head.factors
    if not factors:
        return
    draft.unstated.append(unclear_factors(factors))
    for name, used in draft.used.items():
        for kind in filter(used.__contains__, INPUTS):
            if 'column' in used[kind]:
                if scale := used[kind].get('scale'):
                    draft.unstated.append(
                        f'axes.{name}.{kind}.scale is times {scale:g}, for the unit of '
                        f'{used[kind]["column"]}'
                    )
                used[kind]['scale'] = None


def note_joined_tables(draft: Draft) -> None:
    """Say of signals that hold words such as NaN in the rows of each other what to write."""
    log = draft.log
    unknown = {
        one.column: np.isnan(log.data[one.column])
        for one in log.inputs
        if log.table.readings[one.column].note
    }
    for (name, rows), (other, others) in itertools.combinations(unknown.items(), 2):
        if min(rows.mean(), others.mean()) > 1.0 / MANY and (rows & others).mean() < APART:
            draft.notes.append(
                f'{short(name)} and {short(other)} hold no number in the rows of each other, as '
                'joined tables do: leave those cells empty, for a word there is a number that is '
                'not known'
            )
            return


def note_unused(draft: Draft, times: set[Any]) -> None:
    """Say which columns are neither inputs, their marks, nor times."""
    used = {*times, *draft.log.mark_cells, *(each['value'] for each in draft.assumed.values())}
    for axis in draft.used.values():
        used |= {axis[kind].get('column') for kind in INPUTS if kind in axis}
    draft.notes += names.left_out([one for one in draft.log.named if one.column not in used])
