# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Curves of the comparison over speed, load and draws: means, changes, crossings."""

from collections.abc import Iterable
from dataclasses import dataclass
import math
from typing import Any, Literal

import numpy as np
from surrogate.formulas.geometry import helix_angle
from surrogate.formulas.load_sharing import nut_forces
from surrogate.formulas.torque import efficiency, torque_constant_friction
from surrogate.paper.cases import OURS, SMOOTH
from surrogate.paper.rows import Array, StudyRow
from surrogate.parameters import Screw
from surrogate.screw.record import CONSTANT_FRICTION

Along = Literal['rpm', 'load']
NO_CONTACT = 1e-6
"""RCS that stands for none on logarithmic scales [-]."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Curve:
    """
    A number over speed [rev/min] or load [N], with its spread over draws.

    Places, means, standard deviations and standard errors of the mean, in the unit of the number;
    NaN where too few draws are known; least number of draws at a place.

    """

    at: Array
    mean: Array
    deviation: Array
    error: Array
    draws: int


def pick(rows: Iterable[StudyRow], **wanted: Any) -> list[StudyRow]:
    """
    Return the converged rows whose columns have the wanted values, of our own case by default.

    `rough` asks for any draw of the roughness, or for none.

    """
    rough = wanted.pop('rough', None)
    wanted = {'case': OURS} | wanted
    return [
        row
        for row in rows
        if row.status == 'CONVERGED'
        and all(getattr(row, name) == value for name, value in wanted.items())
        and rough in (None, row.draw != SMOOTH)
    ]


def curve(rows: Iterable[StudyRow], along: Along, name: str, **wanted: Any) -> Curve:
    """Return the mean of a column over draws, along speed or load."""
    groups: dict[float, list[float]] = {}
    for row in pick(rows, **wanted):
        groups.setdefault(getattr(row, along), []).append(getattr(row, name))
    places = sorted(groups)
    counts = np.array([len(groups[place]) for place in places])
    spreads = np.array([_deviation(groups[place]) for place in places])
    return Curve(
        at=np.array(places, dtype=float),
        mean=np.array([np.mean(groups[place]) for place in places], dtype=float),
        deviation=spreads,
        error=spreads / np.sqrt(counts),
        draws=int(counts.min(initial=10**6)) if places else 0,
    )


def _deviation(values: list[float]) -> float:
    return float(np.std(values, ddof=1)) if len(values) > 1 else math.nan


def paired_change(
    rows: Iterable[StudyRow], name: str, along: Along, first: float, last: float, **wanted: Any
) -> tuple[float, float, int]:
    """
    Return by how much a column differs between two places, in the same draws.

    Mean and standard error of the difference, in the unit of the column, and the draws.

    """
    rows = list(rows)
    ends = [
        {row.draw: getattr(row, name) for row in pick(rows, **{along: place}, **wanted)}
        for place in (first, last)
    ]
    common = sorted(set(ends[0]) & set(ends[1]))
    changes = [ends[1][draw] - ends[0][draw] for draw in common]
    if not changes:
        return math.nan, math.nan, 0
    return float(np.mean(changes)), _deviation(changes) / math.sqrt(len(changes)), len(changes)


def crossing(found: Curve, limit: float) -> float:
    """
    Return the fastest place at which a falling mean passes `limit`, by logarithms; NaN if never.

    `limit` in the unit of the column.

    """
    above = np.flatnonzero(found.mean >= limit)
    if not above.size or above[-1] + 1 == len(found.mean):
        return math.nan
    i = int(above[-1])
    high, low = np.log(np.maximum(found.mean[[i, i + 1]], NO_CONTACT))
    part = (high - math.log(limit)) / (high - low)
    return float(found.at[i] * (found.at[i + 1] / found.at[i]) ** part)


def lowest(found: Curve) -> tuple[float, float]:
    """Return place and value of the least mean."""
    i = int(np.argmin(found.mean))
    return float(found.at[i]), float(found.mean[i])


def efficiencies(screw: Screw, rows: Iterable[StudyRow], column: str = 'friction_torque') -> Array:
    """Return the efficiency [-] of rows with an opposing load, of the torque in a column."""
    return np.array([efficiency(getattr(row, column), row.load, screw.lead) for row in rows])


def constant_friction_efficiency(screw: Screw, load: float) -> float:
    """Return the efficiency [-] at an opposing `load` [N] with one constant coefficient."""
    loaded, relieved = (float(force) for force in nut_forces(load, screw.preload))
    driving = torque_constant_friction(
        loaded, relieved, screw.pitch_radius, helix_angle(screw), CONSTANT_FRICTION
    )
    return load * screw.lead / (2 * math.pi * driving)


def mapped(rows: Iterable[StudyRow], **wanted: Any) -> list[StudyRow]:
    """Return the rows of the whole screw under load, by load and speed."""
    found = [row for row in pick(rows, kind='screw', **wanted) if row.load > 0]
    return sorted(found, key=lambda row: (row.load, row.rpm))


def grid(rows: Iterable[StudyRow], name: str) -> tuple[Array, Array, Array]:
    """Return speeds [rev/min], loads [N] and a column of the map; NaN where none was solved."""
    found = {(row.load, row.rpm): getattr(row, name) for row in mapped(rows)}
    loads, speeds = (sorted({key[i] for key in found}) for i in (0, 1))
    values = [[found.get((load, rpm), math.nan) for rpm in speeds] for load in loads]
    return np.array(speeds), np.array(loads), np.array(values, dtype=float)
