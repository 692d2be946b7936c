# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Lookup of the screw's behaviour over speed, opposing load and temperature.

Speeds are mapped, s = log(speed) - log(onset(load, temperature)), so that a rectilinear grid can
crowd the nodes where asperity contact begins. Lookup is exact at the nodes, never extrapolates and
keeps the kinks at zero load and at the unloading load. Needs numpy only and never imports ROS.

"""

from collections.abc import Mapping
import copy
import functools
import math
from pathlib import Path
from typing import Any

import numpy as np
from surrogate.formulas.torque import with_typical_drag
from surrogate.surface import file as surface_file
from surrogate.surface.correction import (
    corrected_hash,
    Correction,
    HasOperatingPoint,
    make_correction,
    places_of,
    solved_values,
)
from surrogate.surface.fields import FIELDS
from surrogate.surface.file import SurfaceData, SurfaceError
from surrogate.surface.hermite import hermite_weights
from surrogate.surface.interpolate import (
    cell_below,
    face_weights,
    field,
    fraction_of,
    look_up,
    look_up_rest,
    onset_on_face,
    width_of,
)
from surrogate.surface.point import SurfacePoint, VALIDITIES, Validity
from surrogate.surface.tables import as_lists, summary, SurfaceTables, tabulate, with_pulls


class Surface:
    """A verified surface, ready for lookup; build it with `load` or from `SurfaceData`."""

    def __init__(self, data: SurfaceData) -> None:
        self.header: Mapping[str, Any] = data.header
        self.sha256 = self._uncorrected = data.sha256
        self._pulls: dict[tuple[int, int, int], Correction] = {}
        self.array_tables = self._base_tables = tabulate(data)
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
        for kind, named, wanted in (('screw', 'screw', screw), ('lubricant', 'oil', oil)):
            sheet = data.header['inputs'][kind]['name']
            if wanted is not None and sheet != wanted:
                raise SurfaceError(
                    f'{path}: built for {named} {sheet!r}, configured is {wanted!r}: state '
                    f'{named} {sheet}, or build the surface of {wanted}'
                )
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
        """Least and largest limit of RCS in speed over that in force by what is not known [-]."""
        return self._band('limit_band')

    @property
    def numerical_band(self) -> tuple[float, float]:
        """Least and largest limit of RCS in speed over that in force by law and lookup [-]."""
        return self._band('numerical_band')

    @property
    def onset_band(self) -> tuple[float, float]:
        """Least and largest limit of RCS in speed over that in force, by all of it [-]."""
        return both_bands(self.limit_band, self.numerical_band)

    @property
    def onset_measure(self) -> tuple[str, tuple[float, float]] | None:
        """Measurement that narrows that band most, and what it leaves [-], None for none."""
        for step in self.header.get('measure', ()):
            low, high = step['limit_band']
            return str(step['measurement']), both_bands((low, high), self.numerical_band)
        return None

    def _band(self, name: str) -> tuple[float, float]:
        low, high = self.header.get(name, (math.nan, math.nan))
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
        return float(self.array_tables.lead)

    def with_typical_drag(
        self, friction_torque: float, opposing_load: float
    ) -> dict[str, dict[str, float]]:
        """
        Return torque and efficiency with the drag of typical nuts, empty where it is identified.

        Friction torque without it [N m], opposing load [N]; as `torque.with_typical_drag`.

        """
        screw = self.header['inputs']['screw']
        if screw.get('typical_drag') is None:
            return {}
        drag = tuple(float(screw[f'typical_drag{end}']) for end in ('_low', '', '_high'))
        return with_typical_drag(friction_torque, opposing_load, self.lead, drag)

    @property
    def reference_temperature(self) -> float:
        """Temperature at which the oil's datasheet holds [K]."""
        return float(self.header['inputs']['lubricant']['reference_temperature'])

    @property
    def speed_range(self) -> tuple[float, float]:
        """Speeds covered, whatever load and temperature [rad/s]."""
        return self.array_tables.speed_low, self.array_tables.speed_high

    @property
    def load_range(self) -> tuple[float, float]:
        """Opposing loads covered [N]."""
        return self.array_tables.load_low, self.array_tables.load_high

    @property
    def temperature_range(self) -> tuple[float, float]:
        """Temperatures covered [K]."""
        return self.array_tables.temperature_low, self.array_tables.temperature_high

    @property
    def cells(self) -> tuple[int, int, int]:
        """Return the number of cells along speed, load and temperature."""
        s, load, temperature = (len(axis) - 1 for axis in self.array_tables[:3])
        return s, load, temperature

    @property
    def masked_cells(self) -> int:
        """Return the number of cells that answer MASKED."""
        return int(np.count_nonzero(~self.array_tables.open_cells))

    @functools.cached_property
    def tables(self) -> SurfaceTables:
        """Return the tables that an interpreted lookup reads; `array_tables` are to compile."""
        return as_lists(self.array_tables)

    def onset_speed(self, opposing_load: float, temperature: float) -> float:
        """Return the speed [rad/s] of the coordinate origin at load [N], temperature [K]."""
        tables = self.tables
        inside = tables.load_low <= opposing_load <= tables.load_high
        if not (inside and tables.temperature_low <= temperature <= tables.temperature_high):
            return math.nan
        loads, heats = tables.load_nodes, tables.heat_nodes
        j, k = cell_below(loads, opposing_load), cell_below(heats, temperature)
        fractions = fraction_of(loads, j, opposing_load), fraction_of(heats, k, temperature)
        face = face_weights(loads, j, fractions[0], heats, k, fractions[1])
        node = tables.load_rows[j] * len(heats) + k
        return math.exp(onset_on_face(tables.onset, node, len(heats), face))

    def lookup(self, speed: float, opposing_load: float, temperature: float) -> SurfacePoint:
        """
        Look up |w| [rad/s], opposing load [N] (positive opposes the motion), temperature [K].

        Never extrapolates: outside the nodes, and in cells beside an unconverged node, the answer
        is NaN and `validity` says which limit was passed. A NaN argument is out of range.

        """
        point = SurfacePoint()
        validity = look_up(self.tables, speed, opposing_load, temperature, point)
        look_up_rest(self.tables, opposing_load, point)
        point.validity = VALIDITIES[validity]
        return point

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
        answer = self.lookup(*where)
        if answer.validity is not Validity.VALID:
            raise SurfaceError(
                f'no correction where the surface has no answer: {answer.validity.name}'
            )
        cell = answer.speed_cell, answer.load_cell, answer.heat_cell
        fractions = answer.speed_fraction, answer.load_fraction, answer.heat_fraction
        tables, across, along = self.tables, len(self.tables.heat_nodes), self.tables.rows
        i, j, k = cell
        fast = hermite_weights(width_of(tables.speed_nodes, i), fractions[0])
        face = face_weights(tables.load_nodes, j, fractions[1], tables.heat_nodes, k, fractions[2])
        node = (i * along + tables.load_rows[j]) * across + k
        uncorrected = [
            field(tables.values, name, node, across, along, fast, face)
            for name in range(len(FIELDS))
        ]
        pulls = {
            place: make_correction(point, place, where, uncorrected, values)
            for place, where in places_of(cell, fractions, self.cells)
        }
        replaced = {_solve_of(self._pulls[place]) for place in pulls if place in self._pulls}
        kept = {
            place: pull for place, pull in self._pulls.items() if _solve_of(pull) not in replaced
        }
        other = copy.copy(self)
        other._pulls = kept | pulls
        other.array_tables = with_pulls(self._base_tables, other._pulls)
        other.__dict__.pop('tables', None)
        other.sha256 = corrected_hash(self._uncorrected, other.corrections)
        return other


def _solve_of(pull: Correction) -> tuple[float, float, float]:
    """Return what tells one solve from another; it may have pulled two cells."""
    return pull.speed, pull.opposing_load, pull.temperature


def both_bands(one: tuple[float, float], other: tuple[float, float]) -> tuple[float, float]:
    """Return the band of two independent causes [-]: squares of logarithms add up, each side."""
    low, high = (math.hypot(*(math.log(band[end]) for band in (one, other))) for end in (0, 1))
    return math.exp(-low), math.exp(high)
