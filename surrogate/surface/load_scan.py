# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
The driving torque over all loads at one speed and temperature, in the subset that compiles.

What `look_up` says at the loads of a scan. Loads never change and temperatures seldom do: the
tables are drawn together along both where a speed asks for them, and remembered until the
temperature changes.

"""

import math

from surrogate.formulas.torque import driving_torque
from surrogate.surface.hermite import hermite_weights, patch_weights, Weights
from surrogate.surface.interpolate import (
    bump,
    cell_below,
    Face,
    fraction_of,
    on_face,
    onset_on_face,
    pulled,
    TORQUE,
    width_of,
)
from surrogate.surface.tables import PULL, ROUNDING, SurfaceTables, WIDTH

NAN = math.nan


def scan(tables: SurfaceTables, speed: float, temperature: float) -> int:
    """
    Fill in the driving torques of a scan; return how many of them are known.

    Speed |w| [rad/s], temperature [K]; a torque [N m] is NaN where a lookup has no answer.

    """
    torques = tables.scan_torques
    if not is_inside(tables, speed, temperature):
        for i in range(len(torques)):
            torques[i] = NAN
        return 0
    return scan_part(tables, speed, temperature, 0, len(torques))


def is_inside(tables: SurfaceTables, speed: float, temperature: float) -> bool:
    """Return True if the surface covers a speed |w| [rad/s] and a temperature [K]."""
    return bool(
        tables.speed_low <= speed <= tables.speed_high
        and tables.temperature_low <= temperature <= tables.temperature_high
    )


def scan_part(
    tables: SurfaceTables, speed: float, temperature: float, begin: int, end: int
) -> int:
    """Fill in driving torques between places of the scan at |w| [rad/s] and [K]; see `scan`."""
    heats = tables.heat_nodes
    k = cell_below(heats, temperature)
    w = fraction_of(heats, k, temperature)
    if tables.scan_key[0] != k or tables.scan_key[1] != w:
        turn_to(tables, k, w)
    nodes, onsets, values = tables.speed_nodes, tables.scan_onset, tables.scan_values
    loads, cells, torques = tables.scan_loads, tables.scan_cells, tables.scan_torques
    filled, of_cell, is_open = tables.scan_filled, tables.pull_of_cell, tables.open_cells
    low, high, last, log_speed = nodes[0], nodes[-1], len(nodes) - 2, math.log(speed)
    load_cells, heat_cells, lead = len(tables.load_nodes) - 1, len(heats) - 1, tables.lead
    i, known = -1, 0
    for place in range(begin, end):
        s = log_speed - onsets[place]
        inside = min(max(s, low), high)
        if i < 0:
            i = cell_below(nodes, inside)
        while i > 0 and inside < nodes[i]:
            i -= 1
        while i < last and inside >= nodes[i + 1]:
            i += 1
        cell = (i * load_cells + cells[place]) * heat_cells + k
        if not (abs(inside - s) < ROUNDING and is_open[cell]):
            torques[place] = NAN
            continue
        known += 1
        at = place * (last + 2) + i
        if not (filled[at] and filled[at + 1]):
            remember(tables, at, place, i, k, w)
            remember(tables, at + 1, place, i + 1, k, w)
        width = nodes[i + 1] - nodes[i]
        u = (inside - nodes[i]) / width
        a, da, b, db = hermite_weights(width, u)
        at += at
        torque = a * values[at] + da * values[at + 1] + b * values[at + 2] + db * values[at + 3]
        if of_cell[cell] >= 0:
            torque = corrected(tables, torque, of_cell[cell], u, tables.scan_fractions[place], w)
        torques[place] = driving_torque(torque, loads[place], lead)
    return known


def corrected(
    tables: SurfaceTables, value: float, pull: int, u: float, v: float, w: float
) -> float:
    """Return a friction torque [N m] with a correction at fractions of its cell [-]."""
    pulls, at = tables.pulls, PULL * pull
    weight = bump(u, pulls[at]) * bump(v, pulls[at + 1]) * bump(w, pulls[at + 2])
    return pulled(pulls, pull, weight, TORQUE, value)


def turn_to(tables: SurfaceTables, k: int, heat: float) -> None:
    """Forget what holds at another temperature, and remember the onsets at this one."""
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
    value, slope = on_face(tables.values, corner, heats * WIDTH, face)
    tables.scan_values[2 * at], tables.scan_values[2 * at + 1] = value, slope
    tables.scan_filled[at] = True
