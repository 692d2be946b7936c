# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Lookup of the screw's behaviour over speed, opposing load and temperature.

Speeds are mapped, s = log(speed) - log(onset(load, temperature)), so that a rectilinear grid can
crowd the nodes where asperity contact begins. Lookup is exact at the nodes, never extrapolates and
keeps the kinks at zero load and at the unloading load. Needs numpy only and never imports ROS.

"""

from bisect import bisect_right
from collections.abc import Mapping
import math
from operator import mul
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from surrogate import surface_file
from surrogate.hermite import (
    Array,
    extend_patch_weights,
    first_rows,
    hermite_weights,
    patch_table,
    patch_weights,
)
from surrogate.surface_file import SurfaceData, SurfaceError
from surrogate.surface_point import FIELDS, LOGARITHMIC, SurfacePoint, Validity

__all__ = ['FIELDS', 'shipped_surface', 'Surface', 'SurfaceError', 'SurfacePoint', 'Validity']

Place = tuple[int, float, float]
"""Cell, its width and the fraction of it at which a value lies."""
ROUNDING = 1e-9
"""Largest error of a mapped speed [-]."""
SHIPPED = Path(__file__).parent / 'data' / 'surfaces'


class Surface:
    """A verified surface, ready for lookup; build it with `load` or from `SurfaceData`."""

    def __init__(self, data: SurfaceData) -> None:
        """Tabulate values and slopes."""
        self.header: Mapping[str, Any] = data.header
        self.sha256 = data.sha256
        self._axes = (data.speed_coordinate, data.load, data.temperature)
        self._lists = tuple(axis.tolist() for axis in self._axes)
        breaks = np.asarray(data.header['load_breaks'], dtype=float)
        cuts = (np.empty(0), breaks, np.empty(0))
        self._rows = tuple(first_rows(axis, cut) for axis, cut in zip(self._axes, cuts))
        # Plain lists: a small table is read faster than an array is sliced.
        self._onset = patch_table(self._axes[1:], cuts[1:], data.log_onset).tolist()
        values = np.stack([_transform(name, data.fields[name]) for name in FIELDS], axis=-1)
        self._table = patch_table(self._axes, cuts, values)
        self._speed_range = tuple(data.header['settings']['speed_range'])
        self._lead = float(data.header['inputs']['screw']['lead'])
        self._worst = data.worst_contact
        self._open_cells = _open_cells(data.mask)
        self._errors = np.stack([data.errors[name] for name in ('friction_torque', 'rcs')], -1)
        self.errors = {name: _summary(error) for name, error in data.errors.items()}

    @classmethod
    def load(
        cls, path: str | Path, *, screw: str | None = None, oil: str | None = None
    ) -> 'Surface':
        """
        Load and verify a surface file.

        Raises SurfaceError, one sentence, for a file that cannot be read, is damaged, of an
        unknown version, or built for another `screw` or `oil` than the named ones.

        """
        data = surface_file.read(path)
        for kind, wanted in (('screw', screw), ('lubricant', oil)):
            found = data.header['inputs'][kind]['name']
            if wanted is not None and found != wanted:
                raise SurfaceError(f'{path}: built for {kind} {found!r}, configured is {wanted!r}')
        return cls(data)

    @property
    def tier(self) -> str:
        """Model behind the numbers: `closed_form` or `full`."""
        return str(self.header['tier'])

    @property
    def screw_name(self) -> str:
        """Name of the screw datasheet."""
        return str(self.header['inputs']['screw']['name'])

    @property
    def oil_name(self) -> str:
        """Name of the oil datasheet."""
        return str(self.header['inputs']['lubricant']['name'])

    @property
    def preload(self) -> float:
        """Preload of the nuts [N]."""
        return float(self.header['inputs']['screw']['preload'])

    @property
    def lead(self) -> float:
        """Lead of the screw [m]."""
        return self._lead

    @property
    def reference_temperature(self) -> float:
        """Temperature at which the oil's datasheet holds [K]."""
        return float(self.header['inputs']['lubricant']['reference_temperature'])

    @property
    def speed_range(self) -> tuple[float, float]:
        """Speeds covered, whatever load and temperature [rad/s]."""
        return self._speed_range

    @property
    def load_range(self) -> tuple[float, float]:
        """Opposing loads covered [N]."""
        return self._lists[1][0], self._lists[1][-1]

    @property
    def temperature_range(self) -> tuple[float, float]:
        """Temperatures covered [K]."""
        return self._lists[2][0], self._lists[2][-1]

    @property
    def cells(self) -> tuple[int, int, int]:
        """Return the number of cells along speed, load and temperature."""
        return tuple(len(axis) - 1 for axis in self._lists)  # type: ignore[return-value]

    @property
    def masked_cells(self) -> int:
        """Return the number of cells that answer MASKED."""
        return int(np.count_nonzero(~self._open_cells))

    def onset_speed(self, opposing_load: float, temperature: float) -> float:
        """Return the speed [rad/s] of the coordinate origin at load [N], temperature [K]."""
        load, heat = self._place(1, opposing_load), self._place(2, temperature)
        if load is None or heat is None:
            return math.nan
        return math.exp(self._log_onset(load, heat, self._patch(load, heat)))

    def lookup(self, speed: float, opposing_load: float, temperature: float) -> SurfacePoint:
        """
        Look up |w| [rad/s], opposing load [N] (positive opposes the motion), temperature [K].

        Never extrapolates: outside the nodes, and in cells beside an unconverged node, the answer
        is NaN and `validity` says which limit was passed. A NaN argument is out of range.

        """
        heat = self._place(2, temperature)
        if heat is None:
            return self._empty(Validity.TEMPERATURE_OUT_OF_RANGE, opposing_load)
        load = self._place(1, opposing_load)
        if load is None:
            return self._empty(Validity.LOAD_OUT_OF_RANGE, opposing_load)
        if not self._speed_range[0] <= speed <= self._speed_range[1]:
            fast = speed > self._speed_range[1]
            return self._empty(
                Validity.SPEED_ABOVE_RANGE if fast else Validity.SPEED_BELOW_RANGE, opposing_load
            )
        patch = self._patch(load, heat)
        s = math.log(speed) - self._log_onset(load, heat, patch)
        fast = self._place_speed(s)
        if fast is None:
            slow = s < self._lists[0][0]
            return self._empty(
                Validity.SPEED_BELOW_RANGE if slow else Validity.SPEED_ABOVE_RANGE, opposing_load
            )
        return self._interpolate(fast, load, heat, patch, opposing_load)

    def _place(self, axis: int, value: float) -> Place | None:
        """Return cell, width and fraction of `value`, or None outside."""
        nodes = self._lists[axis]
        if not nodes[0] <= value <= nodes[-1]:
            return None
        cell = bisect_right(nodes, value, 1, len(nodes) - 1) - 1
        width = nodes[cell + 1] - nodes[cell]
        return cell, width, (value - nodes[cell]) / width

    def _place_speed(self, s: float) -> Place | None:
        """Place a speed coordinate; the mapping rounds, so an end may be passed by a rounding."""
        nodes = self._lists[0]
        inside = min(max(s, nodes[0]), nodes[-1])
        return self._place(0, inside) if abs(inside - s) < ROUNDING else None

    def _patch(self, load: Place, heat: Place) -> list[float]:
        return patch_weights(hermite_weights(load[1], load[2]), hermite_weights(heat[1], heat[2]))

    def _log_onset(self, load: Place, heat: Place, patch: list[float]) -> float:
        j, k = self._rows[1][load[0]], self._rows[2][heat[0]]
        low, high = self._onset[j], self._onset[j + 1]
        return sum(map(mul, patch, (*low[k], *low[k + 1], *high[k], *high[k + 1])))

    def _interpolate(
        self, fast: Place, load: Place, heat: Place, patch: list[float], opposing_load: float
    ) -> SurfacePoint:
        cell = fast[0], load[0], heat[0]
        if not self._open_cells[cell]:
            return self._empty(Validity.MASKED, opposing_load)
        i, j, k = self._rows[0][cell[0]], self._rows[1][cell[1]], self._rows[2][cell[2]]
        # Bounds with names: the two formatters disagree about spaces beside the colon of sums.
        x, y, z = i + 2, j + 2, k + 2
        corners = self._table[i:x, j:y, k:z].reshape(32, -1)
        weights = extend_patch_weights(hermite_weights(fast[1], fast[2]), patch)
        nearest = (cell[0] + (fast[2] > 0.5), cell[1] + (load[2] > 0.5), cell[2] + (heat[2] > 0.5))
        return SurfacePoint(
            validity=Validity.VALID,
            opposing_load=opposing_load,
            lead=self._lead,
            values=np.array(weights).dot(corners).tolist(),
            worst_contact=int(self._worst[nearest]),
            errors=self._errors[cell].tolist(),
        )

    def _empty(self, validity: Validity, opposing_load: float) -> SurfacePoint:
        return SurfacePoint(validity=validity, opposing_load=opposing_load, lead=self._lead)


def _transform(name: str, values: Array) -> Array:
    with np.errstate(divide='ignore', invalid='ignore'):
        return np.log(values) if name in LOGARITHMIC else values


def _open_cells(mask: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Return the cells of which no corner is masked."""
    good = ~mask
    for axis in range(3):
        low = [slice(None)] * 3
        high = [slice(None)] * 3
        low[axis], high[axis] = slice(None, -1), slice(1, None)
        good = good[tuple(low)] & good[tuple(high)]
    return good


def _summary(error: Array) -> tuple[float, float]:
    """Return the largest and the 95th percentile of the measured errors; NaN if none."""
    known = error[np.isfinite(error)]
    if not known.size:
        return math.nan, math.nan
    return float(known.max()), float(np.quantile(known, 0.95))


def shipped_surface(screw: str = 'nominal', oil: str = 'iso_vg_68') -> Path:
    """Return where the shipped surface of `screw` and `oil` lies; raises SurfaceError if none."""
    path = SHIPPED / f'{screw}_{oil}.npz'
    if not path.is_file():
        shipped = ', '.join(sorted(found.stem for found in SHIPPED.glob('*.npz')))
        raise SurfaceError(
            f'no surface is shipped for screw {screw!r} and oil {oil!r}, '
            f'shipped are {shipped or "none"}'
        )
    return path
