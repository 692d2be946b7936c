# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
The driving torque over all loads at one speed and temperature, in the subset that compiles.

What `look_up` says at the loads of a scan. Loads never change and temperatures seldom do: the
tables are drawn together along both where a speed asks for them, and remembered until the
temperature changes.

"""

import math
from typing import Any

from surrogate.formulas.torque import driving_torque
from surrogate.surface.found import (
    bump,
    cell_below,
    Face,
    fraction_of,
    on_face,
    onset_on_face,
    pulled,
    slope_on_face,
    TORQUE,
    width_of,
)
from surrogate.surface.hermite import hermite_weights, patch_weights, Weights
from surrogate.surface.tables import PULL, ROUNDING, SurfaceTables, WIDTH

NAN = math.nan


def scan(tables: SurfaceTables, speed: float, temperature: float) -> int:
    """
    Fill in the driving torques of a scan; return how many of them are known.

    Speed |w| [rad/s], temperature [K]; a torque [N m] is NaN where a lookup has no answer.

    """
    torques, count = tables.scan_torques, len(tables.scan_loads)
    if not (
        tables.speed_low <= speed <= tables.speed_high
        and tables.temperature_low <= temperature <= tables.temperature_high
    ):
        for i in range(count):
            torques[i] = NAN
        return 0
    k = cell_below(tables.heat_nodes, temperature)
    heat = fraction_of(tables.heat_nodes, k, temperature)
    turn_to(tables, k, heat)
    nodes, onsets, values = tables.speed_nodes, tables.scan_onset, tables.scan_values
    low, high, last, log_speed = nodes[0], nodes[-1], len(nodes) - 2, math.log(speed)
    cell, known = 0, 0
    for i in range(count):
        s = log_speed - onsets[i]
        inside = min(max(s, low), high)
        while cell > 0 and inside < nodes[cell]:
            cell -= 1
        while cell < last and inside >= nodes[cell + 1]:
            cell += 1
        if not (abs(inside - s) < ROUNDING and is_open(tables, cell, i, k)):
            torques[i] = NAN
            continue
        known += 1
        at = i * (last + 2) + cell
        if not tables.scan_filled[at]:
            remember(tables, at, i, cell, k, heat)
        if not tables.scan_filled[at + 1]:
            remember(tables, at + 1, i, cell + 1, k, heat)
        fraction = fraction_of(nodes, cell, inside)
        a, da, b, db = hermite_weights(width_of(nodes, cell), fraction)
        at += at
        friction = a * values[at] + da * values[at + 1] + b * values[at + 2] + db * values[at + 3]
        friction = corrected(tables, friction, i, cell, fraction, k, heat)
        torques[i] = driving_torque(friction, tables.scan_loads[i], tables.lead)
    return known


def scan_cell(tables: SurfaceTables, cell: int, i: int, k: int) -> int:
    """Return the number of a cell of a speed, at a load of the scan and a temperature."""
    at = cell * (len(tables.load_nodes) - 1) + tables.scan_cells[i]
    return at * (len(tables.heat_nodes) - 1) + k  # type: ignore[no-any-return]


def is_open(tables: SurfaceTables, cell: int, i: int, k: int) -> Any:
    """Tell whether a cell has an answer."""
    return tables.open_cells[scan_cell(tables, cell, i, k)]


def corrected(
    tables: SurfaceTables, value: float, i: int, cell: int, fraction: float, k: int, heat: float
) -> float:
    """Return a friction torque [N m] with the correction of its cell."""
    pull, pulls = tables.pull_of_cell[scan_cell(tables, cell, i, k)], tables.pulls
    if pull < 0:
        return value
    at = PULL * pull
    weight = bump(fraction, pulls[at]) * bump(tables.scan_fractions[i], pulls[at + 1])
    return pulled(pulls, pull, weight * bump(heat, pulls[at + 2]), TORQUE, value)


def turn_to(tables: SurfaceTables, k: int, heat: float) -> None:
    """Forget what holds at another temperature, and remember the onsets at this one."""
    if tables.scan_key[0] == k and tables.scan_key[1] == heat:
        return
    tables.scan_key[0], tables.scan_key[1] = float(k), heat
    for at in range(len(tables.scan_filled)):
        tables.scan_filled[at] = False
    across = hermite_weights(width_of(tables.heat_nodes, k), heat)
    heats = len(tables.heat_nodes)
    for i in range(len(tables.scan_loads)):
        node = tables.load_rows[tables.scan_cells[i]] * heats + k
        face = patch_weights(load_weights(tables, i), across)
        tables.scan_onset[i] = onset_on_face(tables.onset, node, heats, face)


def load_weights(tables: SurfaceTables, i: int) -> Weights:
    """Return the weights along the load of a place of the scan."""
    weights = tables.scan_weights
    return weights[4 * i], weights[4 * i + 1], weights[4 * i + 2], weights[4 * i + 3]


def remember(tables: SurfaceTables, at: int, i: int, row: int, k: int, heat: float) -> None:
    """Draw the friction torque at a node of the speed together: value and slope."""
    heats = len(tables.heat_nodes)
    across = hermite_weights(width_of(tables.heat_nodes, k), heat)
    face: Face = patch_weights(load_weights(tables, i), across)
    corner = (row * tables.rows + tables.load_rows[tables.scan_cells[i]]) * heats + k
    corner = corner * WIDTH + TORQUE
    tables.scan_values[2 * at] = on_face(tables.values, corner, heats * WIDTH, face)
    tables.scan_values[2 * at + 1] = slope_on_face(tables.values, corner + 8, heats * WIDTH, face)
    tables.scan_filled[at] = True
