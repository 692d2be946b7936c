# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Tables that the lookup makes once, when a surface is loaded."""

from collections.abc import Mapping
import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray
from surrogate.surface.correction import Cell, Correction
from surrogate.surface.fields import FIELDS, LOGARITHMIC, MEASURED
from surrogate.surface.file import SurfaceData
from surrogate.surface.hermite import first_rows, hermite_weights, patch_table

Array = NDArray[np.float64]
ROUNDING = 1e-9
"""Largest error of a mapped speed [-]."""
WIDTH, ONSETS = 4 * len(FIELDS), 3
"""Numbers of a node in the tables: value and slopes of each field, and of the onset."""
ERRORS, SPREADS, PULL = len(MEASURED), 2 * len(MEASURED), 3 + 2 * len(FIELDS)
"""Numbers of a cell's errors, of a node's spreads and of a correction."""
SPLITS = 4
"""Parts into which a scan over the load divides each of its cells."""


class SurfaceTables(NamedTuple):
    """
    All that a lookup reads, as flat sequences: lists to interpret, arrays to compile.

    The numbers of a node or cell lie side by side, temperature running fastest, then load, then
    speed. `onset` has the logarithm of the onset speed and its slopes along load and temperature,
    `values` the FIELDS, then their slopes along speed, load and temperature, both with `rows`
    along the load; `load_rows` are those at which its cells begin. `errors` are of MEASURED;
    `spreads` standard deviation and standard error of each of them, empty unless `has_spreads`. A
    correction is its place in the cell, then gains and shifts of the FIELDS in `pulls`;
    `pull_of_cell` is its number, -1: none. `scan_*` are the loads of a scan [N], their cells,
    fractions and weights, and what it remembers, see `load_scan`. Any friction torque lies between
    torque_low and torque_high, and states at most torque_error of its errors and standard errors
    [N m]. lead [m], speeds [rad/s], loads [N], temperatures [K], parasitic_torque [N m] and
    parasitic_torque_rate [N m s/rad].

    """

    speed_nodes: Any
    load_nodes: Any
    heat_nodes: Any
    load_rows: Any
    onset: Any
    values: Any
    errors: Any
    spreads: Any
    open_cells: Any
    worst_contacts: Any
    pull_of_cell: Any
    pulls: Any
    scan_loads: Any
    scan_cells: Any
    scan_fractions: Any
    scan_weights: Any
    scan_key: Any
    scan_onset: Any
    scan_values: Any
    scan_filled: Any
    scan_torques: Any
    rows: int
    has_spreads: bool
    lead: float
    speed_low: float
    speed_high: float
    load_low: float
    load_high: float
    temperature_low: float
    temperature_high: float
    torque_low: float
    torque_high: float
    torque_error: float
    parasitic_torque: float
    parasitic_torque_rate: float


def tabulate(data: SurfaceData) -> SurfaceTables:
    """Return the tables of a surface without corrections, as arrays."""
    axes = (data.speed_coordinate, data.load, data.temperature)
    breaks = np.asarray(data.header['load_breaks'], dtype=float)
    cuts = (np.empty(0), breaks, np.empty(0))
    fields = np.stack([transform(name, data.fields[name]) for name in FIELDS], axis=-1)
    values = patch_table(axes, cuts, fields)
    spreads = spread_table(data)
    cells = open_cells(data.mask)
    screw = data.header['inputs']['screw']
    low, high = data.header['settings']['speed_range']
    load_rows = np.array(first_rows(data.load, breaks))
    torque_low, torque_high = _torque_bounds(axes, load_rows, values[..., 0])
    return SurfaceTables(
        speed_nodes=axes[0],
        load_nodes=axes[1],
        heat_nodes=axes[2],
        load_rows=load_rows,
        onset=patch_table(axes[1:], cuts[1:], data.log_onset).ravel(),
        values=values.ravel(),
        errors=np.stack([data.errors[name] for name in MEASURED], axis=-1).ravel(),
        spreads=np.empty(0) if spreads is None else spreads.ravel(),
        open_cells=cells.ravel(),
        worst_contacts=data.worst_contact.astype(np.int64).ravel(),
        pull_of_cell=np.full(cells.size, -1),
        pulls=np.empty(0),
        **_scan(axes),
        rows=values.shape[1],
        has_spreads=spreads is not None,
        lead=float(screw['lead']),
        speed_low=float(low),
        speed_high=float(high),
        load_low=float(data.load[0]),
        load_high=float(data.load[-1]),
        temperature_low=float(data.temperature[0]),
        temperature_high=float(data.temperature[-1]),
        torque_low=torque_low,
        torque_high=torque_high,
        torque_error=_largest(data.errors[MEASURED[0]])
        + _largest(data.standard_errors.get(MEASURED[0], np.empty(0))),
        parasitic_torque=float(screw['parasitic_torque']),
        parasitic_torque_rate=float(screw['parasitic_torque_rate']),
    )


def _torque_bounds(
    axes: tuple[Array, Array, Array], load_rows: NDArray[np.intp], table: Array
) -> tuple[float, float]:
    """Return two numbers between which every patch lies: the hull of its control points."""
    reach = np.zeros(table.shape[:3])
    for axis, nodes in enumerate(axes):
        cells = load_rows if axis == 1 else np.arange(len(nodes) - 1)
        width = np.zeros(table.shape[axis])
        for side in (0, 1):
            width[cells + side] = np.maximum(width[cells + side], np.diff(nodes))
        shape = [1, 1, 1]
        shape[axis] = -1
        reach += np.abs(table[..., axis + 1]) * width.reshape(shape) / 3.0
    low, high = np.nanmin(table[..., 0] - reach), np.nanmax(table[..., 0] + reach)
    margin = ROUNDING * (1.0 + max(abs(low), abs(high)))
    return float(low - margin), float(high + margin)


def _largest(values: Array) -> float:
    known = values[np.isfinite(values)]
    return float(known.max()) if known.size else 0.0


def _scan(axes: tuple[Array, Array, Array]) -> dict[str, Any]:
    """Return the loads of a scan, nodes and places between them, and an empty memory."""
    speeds, nodes = len(axes[0]), axes[1]
    each = np.arange(len(nodes) - 1)
    cells = np.append(np.repeat(each, SPLITS), each[-1])
    fractions = np.append(np.tile(np.arange(SPLITS) / SPLITS, len(each)), 1.0)
    width = np.diff(nodes)[cells]
    return {
        'scan_loads': np.append((nodes[cells] + fractions * width)[:-1], nodes[-1]),
        'scan_cells': cells,
        'scan_fractions': fractions,
        'scan_weights': np.stack(hermite_weights(width, fractions), axis=-1).ravel(),
        'scan_key': np.full(2, np.nan),
        'scan_onset': np.zeros(len(cells)),
        'scan_values': np.zeros(2 * len(cells) * speeds),
        'scan_filled': np.zeros(len(cells) * speeds, dtype=bool),
        'scan_torques': np.zeros(len(cells)),
    }


def with_pulls(tables: SurfaceTables, pulls: Mapping[Cell, Correction]) -> SurfaceTables:
    """Return tables of arrays with other corrections, by their cells."""
    of_cell = np.full_like(tables.pull_of_cell, -1)
    counts = tuple(len(nodes) - 1 for nodes in tables[:3])
    for number, cell in enumerate(pulls):
        of_cell[np.ravel_multi_index(cell, counts)] = number
    rows = [[*pull.fractions, *pull.gains, *pull.shifts] for pull in pulls.values()]
    ends = [tables.torque_low, tables.torque_high]
    ends += [
        end + pull.gains[0] * end + pull.shifts[0] for end in ends[:2] for pull in pulls.values()
    ]
    return tables._replace(
        pull_of_cell=of_cell,
        pulls=np.array(rows, dtype=float).ravel(),
        torque_low=min(ends),
        torque_high=max(ends),
    )


def as_lists(tables: SurfaceTables) -> SurfaceTables:
    """Return tables of lists, which plain Python reads faster than arrays."""
    lists = (each.tolist() if isinstance(each, np.ndarray) else each for each in tables)
    return SurfaceTables._make(lists)


def transform(name: str, values: Array) -> Array:
    """Return the values of a field as they are interpolated: films by their logarithm."""
    with np.errstate(divide='ignore', invalid='ignore'):
        return np.log(values) if name in LOGARITHMIC else values


def spread_table(data: SurfaceData) -> Array | None:
    """Return deviations and standard errors of MEASURED at the nodes; None without spreads."""
    groups = (data.deviations, data.standard_errors)
    if not any(groups):
        return None
    unknown = np.full(data.mask.shape, np.nan)
    return np.stack([group.get(name, unknown) for name in MEASURED for group in groups], axis=-1)


def open_cells(mask: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Return the cells of which no corner is masked."""
    good = ~mask
    for axis in range(3):
        low = [slice(None)] * 3
        high = [slice(None)] * 3
        low[axis], high[axis] = slice(None, -1), slice(1, None)
        good = good[tuple(low)] & good[tuple(high)]
    return good


def summary(error: Array) -> tuple[float, float]:
    """Return the largest and the 95th percentile of the measured errors; NaN if none."""
    known = error[np.isfinite(error)]
    if not known.size:
        return math.nan, math.nan
    return float(known.max()), float(np.quantile(known, 0.95))
