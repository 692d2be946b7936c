# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Logs of an axis-year as rows of the judgement, and their summaries as the product makes them."""

import math

from ballscrew_monitor.health.collect import Collector
from ballscrew_monitor.health.gather import GatherSettings
from ballscrew_monitor.health.records import Cell
from ballscrew_monitor.health.stroke import reversal_cells
from ballscrew_monitor.health.summary import add
from ballscrew_monitor.judge.inputs import DEFAULT, DERIVED, MEASURED
from ballscrew_monitor.judge.many import ROW
from health_parts.axis_year import AxisYear, Log
import numpy as np
from numpy.typing import NDArray
from surrogate.surface import shipped_surface, Surface

SECOND = 1_000_000_000  # [ns]
STANDSTILL, MOVES = 0.05, 0.5  # [rad/s]
ASSUMED = 313.15  # [K]


def rows_of(log: Log) -> NDArray[np.void]:
    """Return a log as rows, an array of ROW: as judged, but without a point of a surface."""
    rows = np.zeros(len(log.time), ROW)
    rows['stamp'] = log.start + np.round(log.time * SECOND).astype(np.int64)
    rows['speed'], rows['motor_torque'] = log.speed, log.torque
    rows['axial_load'] = np.nan if log.load is None else log.load
    rows['temperature'] = ASSUMED if log.temperature is None else log.temperature
    rows['speed_source'] = rows['motor_torque_source'] = MEASURED
    rows['axial_load_source'] = DERIVED if log.load is None else MEASURED
    rows['temperature_source'] = DEFAULT if log.temperature is None else MEASURED
    rows['direction'] = np.where(log.speed > 0.0, 1, 2)
    rows['gates'] = (np.abs(log.speed) < STANDSTILL).astype(int)
    return rows


def reversals_of(log: Log, lead: float) -> list[Cell]:
    """Return the cell of the lost motion of a log with a scale; `lead` [m] of the screw."""
    if log.table is None:
        return []
    moves = np.abs(log.speed) > MOVES
    stamps = log.start + np.rint(log.time * SECOND).astype(np.int64)
    speed = log.speed * lead / (2.0 * math.pi)
    columns = (part[moves] for part in (stamps, speed, log.position, log.table))
    return reversal_cells(*columns, log.start)


def cells_of_year(year: AxisYear, *, always_free: bool = False) -> list[Cell]:
    """Return the cells of the summaries of all logs of a year."""
    surface = Surface.load(shipped_surface())
    parts: list[Cell] = []
    for log in year.logs:
        collector = Collector(surface, GatherSettings(always_free=always_free))
        stretches = collector.take_many(rows_of(log)).stretches + collector.finish().stretches
        cells: dict = {}
        for stretch in stretches:
            add(cells, stretch, log.start)
        parts += cells.values()
        parts += reversals_of(log, year.machine.size.lead)
    return parts
