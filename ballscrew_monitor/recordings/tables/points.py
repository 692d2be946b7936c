# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Torque measured at steady speeds, a point in each row of a table, for an identification.

Such a table needs no time and no map: names and units of its columns are read as `--guess` reads
them. Of several columns of a quantity one must be named.

"""

from collections.abc import Sequence
import dataclasses
from pathlib import Path
import re

from ballscrew_monitor.core import conversions
from ballscrew_monitor.recordings.tables.cells import Array
from ballscrew_monitor.recordings.tables.names import read_name
from ballscrew_monitor.recordings.tables.quantities import RATED, UNITS
from ballscrew_monitor.recordings.tables.read import open_table
from ballscrew_monitor.recordings.tables.sources import source_of
from ballscrew_monitor.recordings.tables.unit_names import unit_of, words_of
from ballscrew_monitor.recordings.words import listed, short
import numpy as np
from surrogate.files import InputError

MILLI_NEWTON = re.compile(r'mN[ ._*·]?m')
SPREAD = frozenset({'std', 'sigma', 'deviation'})
"""Words of a standard deviation."""


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class PointColumns:
    """
    What the table does not say: columns by name, lead [m], constant [N m/A], None for no current.

    The constant is the torque on the screw over the current.

    """

    lead: float
    torque_constant: float | None = None
    speed_column: str | None = None
    torque_column: str | None = None


def read_points(path: Path, asked: PointColumns) -> tuple[dict[str, Array], tuple[str, ...]]:
    """
    Return speed, torque and, where the table holds them, its spread, load and temperature.

    In SI units: speed [rad/s], torque and torque_std [N m], load [N], temperature [K]; NaN where a
    cell holds no number, which the notes count. Raises InputError for a table without a column
    that is needed, or with two of a quantity.

    """
    source = source_of(path)
    names = source.names()
    measured = 'torque' if asked.torque_constant is None else 'current'
    columns = {
        'speed': asked.speed_column or _column_of(path, names, 'speed', '--speed-column'),
        'torque': asked.torque_column or _column_of(path, names, measured, '--torque-column'),
        'torque_std': _column_of(path, names, 'torque', spread=True),
        'load': _column_of(path, names, 'load'),
        'temperature': _column_of(path, names, 'temperature'),
    }
    chosen = {quantity: name for quantity, name in columns.items() if name}
    kinds = {'torque': measured, 'torque_std': 'torque'}
    table = open_table(source, list(dict.fromkeys(chosen.values())))
    scalings = {
        quantity: _scaling(path, name, kinds.get(quantity, quantity), asked)
        for quantity, name in chosen.items()
    }
    blocks = list(table.blocks())
    numbers = {name: np.concatenate([block[name] for block in blocks]) for name in table.readings}
    quantities = {
        quantity: numbers[name] * scalings[quantity].factor + scalings[quantity].shift
        for quantity, name in chosen.items()
    }
    return quantities, table.notes


def _column_of(
    path: Path, names: Sequence[str], kind: str, option: str = '', *, spread: bool = False
) -> str:
    """Return the column of a kind of quantity; empty for none, unless an `option` names it."""
    named = [
        one
        for one in map(read_name, names)
        if one.kind == kind and bool(SPREAD & set(words_of(one.column))) is spread
    ]
    best = max((one.rank for one in named), default=0)
    columns = [one.column for one in named if one.rank == best]
    if len(columns) > 1:
        remedy = f'{option} names the one that counts' if option else 'leave one out'
        raise InputError(f'log {path}: {listed(columns)} are all a {kind}: {remedy}')
    if not columns and option:
        current = kind == 'torque' and any(read_name(name).kind == 'current' for name in names)
        constant = ', and --torque-constant K takes the current [N m/A]' if current else ''
        raise InputError(
            f'log {path}: no column is a {kind} by its name, the log holds {listed(names)}: '
            f'{option} names one{constant}'
        )
    return columns[0] if columns else ''


def _scaling(path: Path, column: str, kind: str, asked: PointColumns) -> conversions.Scaling:
    """Return the line from the numbers of a column to SI units, by the unit in its name."""
    milli = kind == 'torque' and MILLI_NEWTON.search(column) is not None
    unit = 'N m' if milli else unit_of(column, kind)
    allowed = [one for one in UNITS[kind] if one != RATED]
    if unit not in allowed:
        raise InputError(
            f'log {path}: the name of column {short(repr(column))} states no unit of a {kind}, '
            f'allowed are {", ".join(allowed)}, as in {kind}_{allowed[0].replace(" ", "")}'
        )
    if kind == 'speed':
        line = {'scale': 1.0, 'offset': 0.0, 'lead': asked.lead}
        return conversions.speed_scaling(unit, handedness='right', **line)
    if kind == 'temperature':
        return conversions.temperature_scaling(unit, scale=1.0, offset=0.0)
    factor = UNITS[kind][unit] * (1e-3 if milli else 1.0)
    if kind == 'current' and asked.torque_constant is not None:
        factor *= asked.torque_constant
    return conversions.Scaling(factor=factor, shift=0.0)
