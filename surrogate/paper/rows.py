# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Rows of the comparison with the published study: numbers in a CSV, fields of contacts beside it.

`inputs` of a row is the beginning of a hash of the datasheets, and of the version of the asperity
law where that decides what touches; rows of others are not read.

"""

from collections.abc import Collection, Iterable
from dataclasses import asdict, dataclass
import hashlib
import math
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from surrogate.files import canonical_json, new_file
from surrogate.paper.cases import OURS, SMOOTH, StudyTask
from surrogate.parameters import Lubricant, Screw
from surrogate.tasks.table import read_table, write_table

Array = NDArray[np.float64]
TABLE, FIELDS = 'paper.csv', 'paper_fields'
"""Names of the table and of the folder of fields in the output folder."""
VERSION = '2'
"""Of what a row means; other versions are not read."""


@dataclass(frozen=True, kw_only=True, slots=True)
class StudyRow:
    """
    One solve; numbers that its kind does not have, or that did not converge, are NaN.

    Task: kind, case, screw speed [rev/min], axial load [N], draw. Contact or worst contact: normal
    force [N], entrainment speed [m/s], films at the centre, over the inner half of the ellipse and
    the least [m], largest pressure [Pa], RCS and asperity share [-], mean distance of
    the asperity load from the centre over the semi-axes [-].
    Screw: standard deviation of RCS by that of the law, RCS of loaded and relieved nut [-],
    friction torque and its sliding and rolling part, the sliding part with the central film in
    Eyring's law, the torque of friction along the track [N m], friction coefficient and its parts
    from film and asperities [-]. Processor time [s].

    """

    inputs: str
    kind: str
    case: str = OURS
    rpm: float
    load: float
    draw: int = SMOOTH
    status: str = ''
    normal_force: float = math.nan
    entrainment_speed: float = math.nan
    central_film: float = math.nan
    mean_film: float = math.nan
    minimum_film: float = math.nan
    max_pressure: float = math.nan
    rcs: float = math.nan
    asperity_share: float = math.nan
    asperity_distance: float = math.nan
    rcs_deviation: float = math.nan
    rcs_loaded: float = math.nan
    rcs_relieved: float = math.nan
    friction_torque: float = math.nan
    sliding_torque: float = math.nan
    rolling_torque: float = math.nan
    central_film_torque: float = math.nan
    track_torque: float = math.nan
    friction_coefficient: float = math.nan
    film_coefficient: float = math.nan
    asperity_coefficient: float = math.nan
    seconds: float = math.nan

    @property
    def key(self) -> str:
        """Name of the task that the row answers."""
        task: Any = {name: getattr(self, name) for name in ('kind', 'case', 'rpm', 'load', 'draw')}
        return StudyTask(**task).key


def empty_row(task: StudyTask, inputs: str) -> StudyRow:
    """Return the row of a task before it is solved."""
    return StudyRow(
        inputs=inputs, kind=task.kind, case=task.case, rpm=task.rpm, load=task.load, draw=task.draw
    )


@dataclass(frozen=True, kw_only=True, slots=True)
class ContactFields:
    """
    What a picture of a contact needs, whole or on the centre line.

    Places along and across the track [m], semi-axes [m], Hertz, film and asperity pressure [Pa],
    film [m], heights of the surface out of the raceway [m]; arrays (nx, ny), ny = 1 on a line.

    """

    x: Array
    y: Array
    semi_axis_x: float
    semi_axis_y: float
    hertz_pressure: float
    film_pressure: Array
    asperity_pressure: Array
    film: Array
    heights: Array


def inputs_hash(screw: Screw, lubricant: Lubricant, law: str = '') -> str:
    """Return the beginning of the hash of datasheets, version of the law and what a row means."""
    text = canonical_json([VERSION, screw.stated(), lubricant.stated(), law])
    return hashlib.sha256(text).hexdigest()[:12]


def read_rows(path: Path, inputs: Collection[str] = ()) -> dict[str, StudyRow]:
    """Return the rows of a table by key, those of some inputs if they are given; InputError."""
    rows = read_table(path, StudyRow)
    return {row.key: row for row in rows if not inputs or row.inputs in inputs}


def write_rows(path: Path, rows: Iterable[StudyRow]) -> None:
    """Write a table as a whole."""
    write_table(path, StudyRow, rows, digits=6)


def fields_path(folder: Path, inputs: str, key: str) -> Path:
    """Return the file of the fields of a task."""
    return folder / FIELDS / inputs / f'{key}.npz'


def read_fields(path: Path) -> ContactFields:
    """Return the fields in a file."""
    with np.load(path, allow_pickle=False) as file:
        kept: dict[str, Any] = {name: file[name] for name in file.files}
    numbers = ('semi_axis_x', 'semi_axis_y', 'hertz_pressure')
    return ContactFields(**(kept | {name: float(kept[name]) for name in numbers}))


def write_fields(path: Path, found: ContactFields) -> None:
    """Keep the fields of a task, by atomic rename."""
    with new_file(path) as partial, partial.open('wb') as file:
        np.savez_compressed(file, **asdict(found))
