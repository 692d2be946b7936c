# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Lookup of many points at once, for recordings; the node looks up one at a time.

The places and weights are those of a single lookup; the sums over the corners of a cell run in
another order, so that numbers agree to rounding. Needs numpy only.

"""

from collections.abc import Sequence
import dataclasses
import math
from typing import Any

import numpy as np
from numpy.typing import NDArray
from surrogate.surface.hermite import extend_patch_weights, hermite_weights, patch_weights
from surrogate.surface.lookup import Surface
from surrogate.surface.point import FIELDS, INDEX, Validity
from surrogate.surface.tables import ROUNDING

Array = NDArray[np.float64]
Places = tuple[NDArray[np.intp], Array, Array]
"""Cells, their widths and the fractions of them at which values lie."""
AT_ONCE = 2048
"""Points whose weights and corners stay in the cache."""
CORNERS = [(i, j, k) for i in (0, 1) for j in (0, 1) for k in (0, 1)]
NEAR = 1e-9
"""Distance from a jump of the answer, in speed coordinate or fraction, that is doubtful [-]."""


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class ManyPoints:
    """
    What the surface says of points, one element each.

    `values` are those of the fields that were asked for as they are interpolated, films by their
    logarithm, shares not yet cut to 0 and 1; NaN unless the validity is VALID. `worst_contact` is
    that of a single point. `doubtful` points are so near to a jump of the answer or to a full
    solve that a single lookup is to tell.

    """

    validity: NDArray[np.uint8]
    values: dict[str, Array]
    worst_contact: NDArray[np.int64]
    doubtful: NDArray[np.bool_]


class ManyLookup:
    """Looks up points of one surface, arrays of them."""

    def __init__(self, surface: Surface, fields: Sequence[str] = FIELDS) -> None:
        """Lay out the table of the surface for some of `FIELDS`."""
        self._surface, self._fields = surface, tuple(fields)
        self._nodes = [np.array(nodes) for nodes in surface._lists]
        self._rows = [np.array(rows) for rows in surface._rows]
        table = surface._table[..., [INDEX[name] for name in fields]]
        # One row per node: the value and the slopes of all fields, side by side.
        self._table = np.ascontiguousarray(table).reshape(-1, 4 * len(self._fields))
        self._steps = table.shape[1] * table.shape[2], table.shape[2]
        onset = np.array(surface._onset)
        self._onset = np.ascontiguousarray(onset.reshape(-1, onset.shape[-1]).T)
        self._pulled = np.zeros(surface._open_cells.shape, dtype=bool)
        for cell in surface._pulls:
            self._pulled[cell] = True

    def __call__(self, speed: Array, opposing_load: Array, temperature: Array) -> ManyPoints:
        """Look up amounts of speed [rad/s], opposing loads [N] and temperatures [K]."""
        count = len(speed)
        found = ManyPoints(
            validity=np.empty(count, dtype=np.uint8),
            values={name: np.empty(count) for name in self._fields},
            worst_contact=np.empty(count, dtype=np.int64),
            doubtful=np.empty(count, dtype=bool),
        )
        for begin in range(0, count, AT_ONCE):
            part = slice(begin, begin + AT_ONCE)
            self._fill(found, part, speed[part], opposing_load[part], temperature[part])
        return found

    def _fill(
        self, found: ManyPoints, part: slice, speed: Array, load: Array, heat: Array
    ) -> None:
        """Answer some of the points; those outside are placed at the nearest node meanwhile."""
        places = self._place(1, load), self._place(2, heat)
        sides: list[Any] = [hermite_weights(width, at) for _, width, at in places]
        weights = patch_weights(*sides)
        slowest, fastest = self._surface.speed_range
        bounded = np.fmin(np.fmax(speed, slowest), fastest)
        s = np.fromiter(map(math.log, bounded.tolist()), float, len(bounded))
        s -= self._log_onset(places[0][0], places[1][0], weights)
        fast = self._place(0, s)
        cell = fast[0], places[0][0], places[1][0]
        validity = self._validity(speed, load, heat, s, cell)
        outside = validity != Validity.VALID
        for name, values in zip(self._fields, self._values(cell, fast, weights), strict=True):
            values[outside] = np.nan
            found.values[name][part] = values
        nearest = tuple(at[0] + (at[2] > 0.5) for at in (fast, *places))
        worst = self._surface._worst[nearest].astype(np.int64)
        found.worst_contact[part] = np.where(outside, -1, worst)
        found.validity[part] = validity
        found.doubtful[part] = self._is_doubtful(s, fast[2], cell)

    def _place(self, axis: int, values: Array) -> Places:
        """Return where values lie, those outside at the nearest end."""
        nodes = self._nodes[axis]
        inside = np.fmin(np.fmax(values, nodes[0]), nodes[-1])
        cell = np.clip(np.searchsorted(nodes, inside, 'right'), 1, len(nodes) - 1) - 1
        width = nodes[cell + 1] - nodes[cell]
        return cell, width, (inside - nodes[cell]) / width

    def _log_onset(self, load: Any, heat: Any, weights: list[Any]) -> Array:
        j, k = self._rows[1][load], self._rows[2][heat]
        corner = j * self._steps[1] + k
        onset = np.zeros(len(corner))
        for at, step in enumerate((0, 1, self._steps[1], self._steps[1] + 1)):
            for column in range(3):  # in the order in which a single lookup adds
                onset += weights[3 * at + column] * self._onset[column][corner + step]
        return onset

    def _values(self, cell: Any, fast: Places, patch: list[Any]) -> list[Array]:
        """Return the fields, transformed, one after another."""
        rows = (table[at] for table, at in zip(self._rows, cell, strict=True))
        i, j, k = rows
        corner = i * self._steps[0] + j * self._steps[1] + k
        along: Any = hermite_weights(fast[1], fast[2])
        weights = extend_patch_weights(along, patch)
        count = len(self._fields)
        sums = [np.zeros(len(corner)) for _ in self._fields]
        for at, (x, y, z) in enumerate(CORNERS):
            row = self._table[corner + (x * self._steps[0] + y * self._steps[1] + z)].T
            for part in range(4):
                weight = weights[4 * at + part]
                for place, total in enumerate(sums):
                    total += weight * row[part * count + place]
        return sums

    def _validity(
        self, speed: Array, load: Array, heat: Array, s: Array, cell: Any
    ) -> NDArray[np.uint8]:
        """Return the validities; of several reasons the one that a single lookup finds first."""
        surface, low, high = self._surface, self._nodes[0][0], self._nodes[0][-1]
        slowest, fastest = surface.speed_range
        validity = np.where(surface._open_cells[cell], Validity.VALID, Validity.MASKED)
        validity[s - high >= ROUNDING] = Validity.SPEED_ABOVE_RANGE
        validity[low - s >= ROUNDING] = Validity.SPEED_BELOW_RANGE
        validity[~(speed >= slowest)] = Validity.SPEED_BELOW_RANGE
        validity[speed > fastest] = Validity.SPEED_ABOVE_RANGE
        validity[~_between(load, *surface.load_range)] = Validity.LOAD_OUT_OF_RANGE
        validity[~_between(heat, *surface.temperature_range)] = Validity.TEMPERATURE_OUT_OF_RANGE
        return validity.astype(np.uint8)

    def _is_doubtful(self, s: Array, fraction: Array, cell: Any) -> NDArray[np.bool_]:
        low, high = self._nodes[0][0], self._nodes[0][-1]
        beside = np.abs(fraction - 0.5) < NEAR
        face = (np.abs(fraction) < NEAR) | (np.abs(fraction - 1.0) < NEAR)
        end = np.minimum(np.abs(s - low), np.abs(s - high)) < 2.0 * ROUNDING
        doubtful: NDArray[np.bool_] = beside | face | end | self._pulled[cell]
        return doubtful


def _between(values: Array, low: float, high: float) -> NDArray[np.bool_]:
    return (values >= low) & (values <= high)
