# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Rows in which a signal stands still at a value that it reaches and leaves by a jump.

A channel that fails gives such a value, 0 or another; a motion that stops does not jump, unless
all its changes are jumps.

"""

from collections.abc import Iterable, Mapping

from ballscrew_monitor.recordings.tables.cells import Array
from ballscrew_monitor.recordings.tables.marks import MOST, plain_cell
import numpy as np
from numpy.typing import NDArray
import polars as pl

Rows = NDArray[np.bool_]

SHORTEST = 3  # rows of a dropout
MOST_LOST = 0.2  # of the rows
SAME = 0.1  # of the jump by which the values before and after may differ
USUAL = 0.9  # quantile of the changes from row to row, by which values go on meanwhile
JUMP = 5.0  # times the largest other change from row to row


def dropped(values: Array) -> Rows:
    """
    Return in which rows values [-] stand still between two jumps from and to about the same value.

    The values may go on meanwhile, as a position does. There are none if they stand still at
    different values, or for more than a part of all rows.

    """
    lost = np.zeros(len(values), np.bool_)
    rows = np.flatnonzero(np.isfinite(values))
    known = values[rows]
    if len(known) < 2 * SHORTEST:
        return lost
    steps = np.abs(np.diff(known))
    ends = np.flatnonzero(steps > 0.0)
    first, last = ends[:-1], ends[1:]  # steps into and out of each value that stands
    jump = np.minimum(steps[first], steps[last])
    apart = np.abs(known[np.minimum(last + 1, len(known) - 1)] - known[first])
    way = float(np.quantile(steps, USUAL)) * (last - first + 1)
    stands = (last - first >= SHORTEST) & (apart <= np.maximum(SAME * jump, way))
    while stands.any():
        others = np.ones(len(steps), np.bool_)
        others[np.concatenate([first[stands], last[stands]])] = False
        usual = float(steps[others].max(initial=0.0))
        left = stands & (jump > JUMP * usual) & (usual > 0.0)
        if (left == stands).all():
            break
        stands = left
    if len({*known[last[stands]].tolist()}) != 1:
        return lost
    for begin, end in zip(first[stands] + 1, last[stands] + 1, strict=True):
        lost[rows[begin:end]] = True
    return lost if lost.sum() <= MOST_LOST * len(rows) else np.zeros_like(lost)


def column_of(lost: Rows, blocks: Iterable[pl.DataFrame]) -> tuple[str, list[str]]:
    """Return the column with other cells in lost rows than in others, and all its cells."""
    cells: Mapping[bool, dict[str, set[str]]] = {True: {}, False: {}}
    at = 0
    for block in blocks:
        part = lost[at:][: block.height]
        if not len(part):
            break
        at += len(part)
        for name in block.columns:
            for side in cells:
                chosen = block[name].head(len(part)).filter(pl.Series(part == side))
                held = cells[side].setdefault(name, set())
                if len(held) <= MOST:
                    held |= {*map(plain_cell, chosen.unique().to_list())}
    for name, of_lost in cells[True].items():
        every = of_lost | cells[False][name]
        if len(every) <= MOST and not of_lost & cells[False][name]:
            return name, sorted(every)
    return '', []
