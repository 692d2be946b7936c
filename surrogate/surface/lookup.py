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
import copy
import functools
import math
from operator import mul
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from surrogate.formulas import torque
from surrogate.surface import file as surface_file
from surrogate.surface.correction import (
    corrected_hash,
    Correction,
    HasOperatingPoint,
    make_correction,
    places_of,
    solved_values,
)
from surrogate.surface.file import SurfaceData, SurfaceError
from surrogate.surface.hermite import (
    extend_patch_weights,
    first_rows,
    hermite_weights,
    patch_table,
    patch_weights,
    trilinear_weights,
)
from surrogate.surface.load_scan import LoadScan
from surrogate.surface.point import FIELDS, INDEX, MEASURED, NO_SPREADS, SurfacePoint, Validity
from surrogate.surface.tables import open_cells, ROUNDING, spread_table, summary, transform

Place = tuple[int, float, float]
"""Cell, its width and the fraction of it at which a value lies."""
Located = tuple[Place, Place, Place, list[float]]
"""Places along speed, load and temperature, and the weights of the face of the last two."""


class Surface:
    """A verified surface, ready for lookup; build it with `load` or from `SurfaceData`."""

    def __init__(self, data: SurfaceData) -> None:
        """Tabulate values and slopes."""
        self.header: Mapping[str, Any] = data.header
        self.sha256 = self._uncorrected = data.sha256
        self._pulls: dict[tuple[int, int, int], Correction] = {}
        self._axes = (data.speed_coordinate, data.load, data.temperature)
        self._lists = tuple(axis.tolist() for axis in self._axes)
        breaks = np.asarray(data.header['load_breaks'], dtype=float)
        cuts = (np.empty(0), breaks, np.empty(0))
        self._rows = tuple(first_rows(axis, cut) for axis, cut in zip(self._axes, cuts))
        # Plain lists: a small table is read faster than an array is sliced.
        self._onset = patch_table(self._axes[1:], cuts[1:], data.log_onset).tolist()
        values = np.stack([transform(name, data.fields[name]) for name in FIELDS], axis=-1)
        self._table = patch_table(self._axes, cuts, values)
        self._speed_range = tuple(data.header['settings']['speed_range'])
        self._lead = float(data.header['inputs']['screw']['lead'])
        self._worst = data.worst_contact
        self._spreads = spread_table(data)
        self._open_cells = open_cells(data.mask)
        self._errors = np.stack([data.errors[name] for name in MEASURED], -1)
        self.errors = {name: summary(error) for name, error in data.errors.items()}

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
    def base_sha256(self) -> str:
        """Content hash of the surface without its corrections."""
        return self._uncorrected

    @property
    def tier(self) -> str:
        """Model behind the numbers: `closed_form` or `full`."""
        return str(self.header['tier'])

    @property
    def screw_name(self) -> str:
        """Name of the screw datasheet."""
        return str(self.header['inputs']['screw']['name'])

    @property
    def limit_band(self) -> tuple[float, float]:
        """Limit of RCS in speed over that in force, for thin and thick boundary films [-]."""
        low, high = self.header.get('limit_band', (math.nan, math.nan))
        return float(low), float(high)

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
        s, load, temperature = (len(axis) - 1 for axis in self._lists)
        return s, load, temperature

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
        found = self._locate(speed, opposing_load, temperature)
        if isinstance(found, Validity):
            return self._empty(found, opposing_load)
        return self._interpolate(*found, opposing_load)

    def driving_torques(
        self, speed: float, temperature: float
    ) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """
        Return opposing loads [N] from end to end, and the torques that drive the screw there.

        Speed |w| [rad/s], temperature [K]; a torque [N m] is along the motion, and NaN where a
        lookup has no answer. The loads are the nodes and places between them.

        """
        heat, (slowest, fastest) = self._place(2, temperature), self._speed_range
        loads = self._scan.loads
        if heat is None or not slowest <= speed <= fastest:
            return loads, np.full_like(loads, np.nan)
        weights = hermite_weights(heat[1], heat[2])
        friction = self._scan.friction_torques(speed, heat[0], weights)
        for cell in {cell[1] for cell in self._pulls if cell[2] == heat[0]}:
            for place in np.flatnonzero(self._scan.cells == cell):
                point = self.lookup(speed, float(loads[place]), temperature)
                friction[place] = point.friction_torque
        return loads, torque.driving_torque(friction, loads, self._lead)

    @functools.cached_property
    def _scan(self) -> LoadScan:
        return LoadScan(
            self._axes,
            self._rows,
            np.array(self._onset),
            self._table[..., INDEX['friction_torque']],
            self._open_cells,
        )

    def drag(self, speed: float) -> float:
        """Return the parasitic part [N m] of the friction torque at a speed [rad/s]."""
        screw = self.header['inputs']['screw']
        return float(screw['parasitic_torque'] + screw['parasitic_torque_rate'] * abs(speed))

    @property
    def corrections(self) -> tuple[Correction, ...]:
        """Return the full solves that have pulled this surface, in the order of their cells."""
        solves = {_solve_of(self._pulls[cell]): self._pulls[cell] for cell in sorted(self._pulls)}
        return tuple(solves.values())

    def with_correction(self, point: HasOperatingPoint, solution: object) -> 'Surface':
        """
        Return a surface that agrees with a full solve at `point`, and with this one elsewhere.

        The point has a speed [rad/s], an opposing load [N] and a temperature [K]; of the solution
        the attributes named in `FIELDS` are taken, those it lacks or that are NaN stay. Nothing
        changes further away than `TRUST_RADIUS`, or outside the cell of the point, both cells for
        one on a node of temperature; a correction of the same cell is replaced. Raises
        SurfaceError for a solution that is not converged and a point that is not covered or lies
        at a face of speed or load.

        """
        values = solved_values(solution)
        where = abs(point.speed), point.opposing_load, point.temperature
        validity, found = self.lookup(*where).validity, self._locate(*where)
        if isinstance(found, Validity) or validity is not Validity.VALID:
            raise SurfaceError(f'no correction where the surface has no answer: {validity.name}')
        cell, fractions = zip(*((place[0], place[2]) for place in found[:3]))
        here = self._values(*found)
        made = {
            place: make_correction(point, place, where, here, values)
            for place, where in places_of(cell, fractions, self.cells)
        }
        replaced = {_solve_of(self._pulls[place]) for place in made if place in self._pulls}
        kept = {
            place: pull for place, pull in self._pulls.items() if _solve_of(pull) not in replaced
        }
        other = copy.copy(self)
        other._pulls = kept | made
        other.sha256 = corrected_hash(self._uncorrected, other.corrections)
        return other

    def _locate(
        self, speed: float, opposing_load: float, temperature: float
    ) -> Located | Validity:
        """Return where a point lies, or which limit it passes."""
        heat = self._place(2, temperature)
        if heat is None:
            return Validity.TEMPERATURE_OUT_OF_RANGE
        load = self._place(1, opposing_load)
        if load is None:
            return Validity.LOAD_OUT_OF_RANGE
        if not self._speed_range[0] <= speed <= self._speed_range[1]:
            fast = speed > self._speed_range[1]
            return Validity.SPEED_ABOVE_RANGE if fast else Validity.SPEED_BELOW_RANGE
        patch = self._patch(load, heat)
        s = math.log(speed) - self._log_onset(load, heat, patch)
        place = self._place_speed(s)
        if place is None:
            slow = s < self._lists[0][0]
            return Validity.SPEED_BELOW_RANGE if slow else Validity.SPEED_ABOVE_RANGE
        return place, load, heat, patch

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
        onset: float = sum(map(mul, patch, (*low[k], *low[k + 1], *high[k], *high[k + 1])))
        return onset

    def _values(self, fast: Place, load: Place, heat: Place, patch: list[float]) -> list[float]:
        """Return the fields, transformed, without corrections."""
        i, j, k = self._rows[0][fast[0]], self._rows[1][load[0]], self._rows[2][heat[0]]
        # Bounds with names: the two formatters disagree about spaces beside the colon of sums.
        x, y, z = i + 2, j + 2, k + 2
        corners = self._table[i:x, j:y, k:z].reshape(32, -1)
        weights = extend_patch_weights(hermite_weights(fast[1], fast[2]), patch)
        values: list[float] = np.array(weights).dot(corners).tolist()
        return values

    def _interpolate(
        self, fast: Place, load: Place, heat: Place, patch: list[float], opposing_load: float
    ) -> SurfacePoint:
        cell = fast[0], load[0], heat[0]
        if not self._open_cells[cell]:
            return self._empty(Validity.MASKED, opposing_load)
        values = self._values(fast, load, heat, patch)
        pull, corrected = self._pulls.get(cell), False
        if pull is not None:
            values, corrected = pull.apply(values, (fast[2], load[2], heat[2]))
        nearest = (cell[0] + (fast[2] > 0.5), cell[1] + (load[2] > 0.5), cell[2] + (heat[2] > 0.5))
        return SurfacePoint(
            validity=Validity.VALID,
            opposing_load=opposing_load,
            lead=self._lead,
            values=values,
            worst_contact=int(self._worst[nearest]),
            errors=self._errors[cell].tolist(),
            spreads=NO_SPREADS if self._spreads is None else self._spread(fast, load, heat),
            corrected=corrected,
        )

    def _empty(self, validity: Validity, opposing_load: float) -> SurfacePoint:
        return SurfacePoint(validity=validity, opposing_load=opposing_load, lead=self._lead)

    def _spread(self, fast: Place, load: Place, heat: Place) -> list[float]:
        """Return what strips differ by, linear between the nodes: never below zero."""
        assert self._spreads is not None
        i, j, k = fast[0], load[0], heat[0]
        x, y, z = i + 2, j + 2, k + 2
        corners = self._spreads[i:x, j:y, k:z].reshape(8, -1)
        weights = np.array(trilinear_weights(fast[2], load[2], heat[2]))
        # A node that is not known has no part in a point where its weight is zero.
        used = weights > 0
        spread: list[float] = weights[used].dot(corners[used]).tolist()
        return spread


def _solve_of(pull: Correction) -> tuple[float, float, float]:
    """Return what tells one solve from another; it may have pulled two cells."""
    return pull.speed, pull.opposing_load, pull.temperature
