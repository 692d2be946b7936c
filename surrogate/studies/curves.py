# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Rows of the comparison with the published study, and their curves over speed, load and draws.

`inputs` of a row is the beginning of a hash of the datasheets, and of the version of the asperity
law where that decides what touches.

"""

from collections.abc import Iterable
from dataclasses import dataclass, replace
import hashlib
import math
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray
from surrogate.files import canonical_json
from surrogate.formulas.torque import efficiency
from surrogate.parameters import Lubricant, Screw
from surrogate.studies.tasks import LOADED, PRELOAD, ROUGH_SPEEDS, SMOOTH, StudyTask

Array = NDArray[np.float64]
Along = Literal['rpm', 'load']
VERSION = '2'
"""Of what a row means; other versions are not read."""
NO_CONTACT = 1e-6
"""RCS that stands for none on logarithmic scales [-]."""


@dataclass(frozen=True, kw_only=True, slots=True)
class StudyRow(StudyTask):
    """
    One solved task; numbers that its kind does not have, or that did not converge, are NaN.

    Contact or worst contact: normal force [N], films at the centre and over the inner half of the
    ellipse [m], RCS and asperity share [-], mean distance of the asperity load from the centre
    over the semi-axes [-]. Screw: RCS of loaded and relieved nut [-], friction torque and its
    sliding and rolling part [N m], friction coefficient and its parts from film and asperities
    [-]. Processor time [s].

    """

    inputs: str
    status: str = ''
    normal_force: float = math.nan
    central_film: float = math.nan
    mean_film: float = math.nan
    rcs: float = math.nan
    asperity_share: float = math.nan
    asperity_distance: float = math.nan
    rcs_loaded: float = math.nan
    rcs_relieved: float = math.nan
    friction_torque: float = math.nan
    sliding_torque: float = math.nan
    rolling_torque: float = math.nan
    friction_coefficient: float = math.nan
    film_coefficient: float = math.nan
    asperity_coefficient: float = math.nan
    seconds: float = math.nan


def markdown_table(heads: Iterable[str], rows: Iterable[Iterable[str]]) -> str:
    """Return rows below their heads as a table in Markdown."""
    names = list(heads)
    lines = [f'| {" | ".join(names)} |', f'|{len(names) * "---|"}']
    return '\n'.join(lines + [f'| {" | ".join(cells)} |' for cells in rows])


def inputs_hash(screw: Screw, lubricant: Lubricant, law: str = '') -> str:
    """Return the beginning of the hash of datasheets, version of the law and what a row means."""
    text = canonical_json([VERSION, screw.stated(), lubricant.stated(), law])
    return hashlib.sha256(text).hexdigest()[:12]


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
    Return the converged rows whose columns have the wanted values, of the loaded nut by default.

    `rough` asks for any draw of the roughness, or for none.

    """
    rough = wanted.pop('rough', None)
    wanted = {'nut': LOADED} | wanted
    return [
        row
        for row in rows
        if row.status == 'CONVERGED'
        and all(getattr(row, name) == value for name, value in wanted.items())
        and rough in (None, row.draw != SMOOTH)
    ]


def curve(rows: Iterable[StudyRow], along: Along, name: str, **wanted: Any) -> Curve:
    """Return the mean of a column over draws, along speed or load."""
    draws: dict[float, list[float]] = {}
    for row in pick(rows, **wanted):
        draws.setdefault(getattr(row, along), []).append(getattr(row, name))
    groups = [draws[place] for place in sorted(draws)]
    counts = np.array([len(group) for group in groups])
    deviation = np.array([_deviation(group) for group in groups])
    return Curve(
        at=np.array(sorted(draws), dtype=float),
        mean=np.array([np.mean(group) for group in groups], dtype=float),
        deviation=deviation,
        error=deviation / np.sqrt(counts),
        draws=int(counts.min()) if groups else 0,
    )


def _deviation(values: list[float]) -> float:
    return float(np.std(values, ddof=1)) if len(values) > 1 else math.nan


def screw_speeds(rows: Iterable[StudyRow], name: str) -> Curve:
    """Return a column of the screw under preload over speed."""
    return curve(rows, 'rpm', name, kind='screw', load=PRELOAD)


def contact_speeds(rows: Iterable[StudyRow]) -> Curve:
    """Return RCS of a contact with the study's roughness, which stands still, over speed."""
    near = [row for row in rows if row.rpm in ROUGH_SPEEDS]
    return curve(near, 'rpm', 'rcs', kind='contact', load=PRELOAD, rough=True)


def nut_rows(rows: Iterable[StudyRow], nut: str) -> list[StudyRow]:
    """Return contacts of a nut, those under preload for either, as if of the loaded one."""
    return [
        replace(row, nut=LOADED)
        for row in rows
        if row.kind == 'contact' and (row.nut == nut or row.load == PRELOAD)
    ]


def apparent_friction(rows: Iterable[StudyRow]) -> Curve:
    """Return the friction coefficient that would make all losses by sliding, over speed."""
    friction, torque, sliding = (
        screw_speeds(rows, name)
        for name in ('friction_coefficient', 'friction_torque', 'sliding_torque')
    )
    return replace(friction, mean=friction.mean * torque.mean / sliding.mean)


def paired_error(rows: Iterable[StudyRow], name: str, load: float, **wanted: Any) -> float:
    """Return the standard error of the change of a column from preload to a `load` [N] by draw."""
    before, after = (
        {row.draw: getattr(row, name) for row in pick(rows, load=place, **wanted)}
        for place in (PRELOAD, load)
    )
    changes = [after[draw] - before[draw] for draw in before.keys() & after.keys()]
    return _deviation(changes) / math.sqrt(max(len(changes), 1))


def crossing(falling: Curve, limit: float) -> float:
    """
    Return the fastest place at which a falling mean passes `limit`, by logarithms; NaN if never.

    `limit` in the unit of the column.

    """
    above = np.flatnonzero(falling.mean >= limit)
    if not above.size or above[-1] + 1 == len(falling.mean):
        return math.nan
    i = int(above[-1])
    high, low = np.log(np.maximum(falling.mean[[i, i + 1]], NO_CONTACT))
    part = (high - math.log(limit)) / (high - low)
    return float(falling.at[i] * (falling.at[i + 1] / falling.at[i]) ** part)


def efficiencies(screw: Screw, rows: Iterable[StudyRow]) -> Array:
    """Return the efficiency [-] of rows with an opposing load."""
    return np.array([efficiency(row.friction_torque, row.load, screw.lead) for row in rows])


def mapped(rows: Iterable[StudyRow], **wanted: Any) -> list[StudyRow]:
    """Return the rows of the screw under load, by load and speed."""
    loaded = [row for row in pick(rows, kind='screw', **wanted) if row.load > 0]
    return sorted(loaded, key=lambda row: (row.load, row.rpm))


def grid(rows: Iterable[StudyRow], name: str) -> tuple[Array, Array, Array]:
    """Return speeds [rev/min], loads [N] and a column of the map; NaN where none was solved."""
    solved = {(row.load, row.rpm): getattr(row, name) for row in mapped(rows)}
    loads, speeds = (sorted({place[i] for place in solved}) for i in (0, 1))
    values = [[solved.get((load, rpm), math.nan) for rpm in speeds] for load in loads]
    return np.array(speeds), np.array(loads), np.array(values, dtype=float)
