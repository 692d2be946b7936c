# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The last minutes of an axis: a row for each state, in a ring of fixed size."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
COLUMNS = (
    'stamp',
    'speed_rpm',
    'load_N',
    'temperature_degC',
    'efficiency',
    'rcs',
    'film_ratio',
    'torque_N_m',
    'measured_torque_N_m',
    'level',
)
"""Columns of a row, the stamp [s] first."""
SPAN = 600.0  # [s] that are kept
STEP = 0.02  # [s] between two rows that are kept, unless the level changes
LARGEST = round(SPAN / STEP)  # rows
LEVEL = COLUMNS.index('level')


class History:
    """Rows in order of their stamps; `count` is the number of all that were ever taken."""

    def __init__(self) -> None:
        self.count = 0
        self._begin = 0  # of the rows since time last went back
        self._ring = np.empty((LARGEST, len(COLUMNS)))

    def take(self, row: Sequence[float]) -> None:
        """Take a row, unless it follows the last one at once; when time goes back, begin again."""
        if self.count > self._begin:
            last = self._ring[(self.count - 1) % LARGEST]
            step = row[0] - last[0]
            if step < 0.0:
                self._begin = self.count
            elif step < 0.9 * STEP and row[LEVEL] == last[LEVEL]:
                return
        self._ring[self.count % LARGEST] = row
        self.count += 1

    def since(self, count: int) -> Array:
        """Return the rows after the first `count`, as far as they are kept, within the span."""
        first = max(count, self._begin, self.count - LARGEST)
        rows = self._ring[np.arange(first, self.count) % LARGEST]
        return rows[rows[:, 0] >= rows[-1, 0] - SPAN] if len(rows) else rows


def columns_of(rows: Array) -> dict[str, Array]:
    """Return rows as columns by name."""
    return dict(zip(COLUMNS, rows.T))
