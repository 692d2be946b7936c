# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Sums over time: statistics of the window since the last state, and totals since their reset.

Functions of the subset that numba compiles, arguments as in `zone`.

"""

import math
from typing import Any

from ballscrew_monitor.core.conversions import SECOND
from ballscrew_monitor.judge.records import COLUMNS, LIGHT_LOAD, STANDSTILL
from ballscrew_monitor.judge.zone import NO_ZONE, VALID

SPEED, AXIAL_LOAD, EFFICIENCY, RCS, FILM_RATIO = range(COLUMNS)


def clear_window(memory: Any) -> None:
    """Begin a window if a state has published the last one."""
    if not memory.window_told:
        return
    memory.window_told = False
    for column in range(COLUMNS):
        memory.window_count[column] = 0
        memory.window_low[column] = math.inf
        memory.window_high[column] = -math.inf
        memory.window_total[column] = 0.0


def add_to_window(memory: Any, row: Any) -> None:
    """Add a row with a zone; its efficiency only where that was judged."""
    if row.zone == NO_ZONE:
        return
    _add(memory, SPEED, row.speed)
    _add(memory, AXIAL_LOAD, row.axial_load)
    _add(memory, RCS, row.rcs)
    _add(memory, FILM_RATIO, row.film_ratio)
    if row.gates & LIGHT_LOAD == 0:
        _add(memory, EFFICIENCY, row.efficiency)


def _add(memory: Any, column: int, value: float) -> None:
    memory.window_count[column] += 1
    memory.window_total[column] += value
    if value < memory.window_low[column]:
        memory.window_low[column] = value
    if value > memory.window_high[column]:
        memory.window_high[column] = value


def add_to_totals(memory: Any, row: Any, max_gap: int) -> None:
    """Add the time since the last sample, unless it is longer than `max_gap` [ns]."""
    if memory.since == 0:
        memory.since = row.stamp
    span = row.stamp - memory.moment_stamp
    if memory.moment and memory.moment_speed != 0.0 and 0 < span <= max_gap:
        _add_span(memory, span)
    memory.moment, memory.moment_stamp = True, row.stamp
    memory.moment_speed = 0.0 if row.gates & STANDSTILL != 0 else abs(row.speed)
    power = row.friction_torque * memory.moment_speed if row.validity == VALID else 0.0
    memory.moment_power = power if math.isfinite(power) else 0.0
    memory.moment_regime, memory.moment_zone = row.regime, row.zone


def _add_span(memory: Any, span: int) -> None:
    """Add a time [ns] during which the last sample held."""
    memory.running_time += span
    memory.angle += memory.moment_speed * (span / SECOND)
    memory.energy_lost += memory.moment_power * (span / SECOND)
    if memory.moment_zone == NO_ZONE:
        memory.unjudged_time += span
    else:
        memory.regime_time[memory.moment_regime] += span
        memory.zone_time[memory.moment_zone] += span
