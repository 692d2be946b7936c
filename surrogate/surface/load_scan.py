# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
The friction torque over all loads at once, at one speed and temperature: what `lookup` says there.

Loads and their weights never change, so the tables are drawn together along the load when a
surface is loaded, and along the temperature when that changes. A speed then costs a few sums over
arrays. Corrections by full solves are left to the caller. Needs numpy only.

"""

from collections.abc import Sequence
import math

import numpy as np
from numpy.typing import NDArray
from surrogate.surface.hermite import hermite_weights, Weights
from surrogate.surface.tables import ROUNDING

Array = NDArray[np.float64]
SPLITS = 4
"""Parts into which the scan divides each cell of the load."""


class LoadScan:
    """Nodes of the load and places between them, and the friction torque at all of them."""

    def __init__(
        self,
        axes: tuple[Array, Array, Array],
        rows: Sequence[Sequence[int]],
        onset: Array,
        torque: Array,
        open_cells: NDArray[np.bool_],
    ) -> None:
        """
        Place the loads.

        Speed coordinate, load and temperature nodes; table rows at which their cells begin; tables
        of the onset and of the friction torque, value and slopes behind; cells with an answer.

        """
        nodes = axes[1]
        cells = np.arange(len(nodes) - 1)
        self.cells = np.append(np.repeat(cells, SPLITS), cells[-1])
        fraction = np.append(np.tile(np.arange(SPLITS) / SPLITS, len(cells)), 1.0)
        width = np.diff(nodes)[self.cells]
        self.loads = np.append((nodes[self.cells] + fraction * width)[:-1], nodes[-1])
        self._weights = hermite_weights(width, fraction)
        self._row = np.asarray(rows[1])[self.cells]
        self._heat_rows = rows[2]
        self._nodes, self._onset, self._torque, self._open = axes[0], onset, torque, open_cells
        self._last: tuple[tuple[int, Weights], tuple[Array, Array, Array]] | None = None

    def friction_torques(self, speed: float, heat_cell: int, heat: Weights) -> Array:
        """
        Return the friction torque [N m] at the loads, NaN where there is no answer.

        Speed [rad/s]; cell of the temperature and the weights of its place in it.

        """
        if self._last is None or self._last[0] != (heat_cell, heat):
            self._last = (heat_cell, heat), self._at_temperature(self._heat_rows[heat_cell], heat)
        log_onset, value, slope = self._last[1]
        s = math.log(speed) - log_onset
        nodes = self._nodes
        inside = np.clip(s, nodes[0], nodes[-1])
        cell = np.clip(np.searchsorted(nodes, inside, 'right') - 1, 0, len(nodes) - 2)
        width = nodes[cell + 1] - nodes[cell]
        a, da, b, db = hermite_weights(width, (inside - nodes[cell]) / width)
        at = np.arange(len(s))
        torque = a * value[cell, at] + da * slope[cell, at]
        torque += b * value[cell + 1, at] + db * slope[cell + 1, at]
        known = (np.abs(inside - s) < ROUNDING) & self._open[cell, self.cells, heat_cell]
        return np.where(known, torque, np.nan)

    def _at_temperature(self, k: int, heat: Weights) -> tuple[Array, Array, Array]:
        """Return onset, and torque and its slope along the speed, at the loads."""
        onset, torque = self._onset, self._torque
        log_onset = self._along_load(_blend(onset, k, 0, 2, heat), _blend(onset, k, 1, None, heat))
        value = self._along_load(_blend(torque, k, 0, 3, heat), _blend(torque, k, 2, None, heat))
        slope = self._along_load(_blend(torque, k, 1, None, heat), None)
        return log_onset, value, slope

    def _along_load(self, value: Array, slope: Array | None) -> Array:
        """Interpolate along the load, the last axis; the slope of a slope counts as zero."""
        a, da, b, db = self._weights
        j = self._row
        found = a * value[..., j] + b * value[..., j + 1]
        if slope is not None:
            found = found + da * slope[..., j] + db * slope[..., j + 1]
        return np.asarray(found)


def _blend(table: Array, k: int, place: int, slope: int | None, heat: Weights) -> Array:
    """Interpolate one entry of the table along the temperature, with its slope if it has one."""
    c, dc, d, dd = heat
    found = c * table[..., k, place] + d * table[..., k + 1, place]
    if slope is not None:
        found = found + dc * table[..., k, slope] + dd * table[..., k + 1, slope]
    return np.asarray(found)
