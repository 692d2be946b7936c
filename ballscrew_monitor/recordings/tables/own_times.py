# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Second columns of times, which scopes write left of the columns that they belong to."""

from collections.abc import Collection, Sequence

from ballscrew_monitor.recordings.tables.cells import Array
import numpy as np

ONE_CLOCK = 0.01  # of the span: times of a row that keep so close are of one clock


def is_own_time(main: Array, other: Array, *, is_alike: bool) -> bool | None:
    """
    Return whether the times `other` are those of columns of their own beside the times `main`.

    Both are in one unit, by row of the table, NaN where there is none; they are alike if a map can
    read both. True: they run over the times of `main`, and differ from them. None: they are the
    times of the same rows, told again or from another zero. False: they may be either.

    """
    apart = (other - main)[np.isfinite(other - main)]
    span = min(np.nanmax(main) - np.nanmin(main), np.nanmax(other) - np.nanmin(other))
    if len(apart) and np.abs(apart).max() <= ONE_CLOCK * span:
        return None
    overlap = min(np.nanmax(main), np.nanmax(other)) - max(np.nanmin(main), np.nanmin(other))
    if overlap > 0.0:
        return is_alike
    return None if len(apart) and np.ptp(apart) <= ONE_CLOCK * span else False


def are_pairs(columns: Sequence[str], times: Collection[str]) -> bool:
    """Return True if a table is a time and its signal again and again, so that none is idle."""
    before, behind = columns[::2], columns[1::2]
    return set(before) == set(times) and len(before) == len(behind)
