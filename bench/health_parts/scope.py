# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Logs of an axis-year as a control exports them: texts with a head, and times that count from 0.

The form is that of the scope of TwinCAT: tabs, a decimal comma, names, symbols, data types and
units in rows above the numbers, and the start with day and month without leading zeros.

"""

from collections.abc import Sequence
import datetime
import math
from pathlib import Path

from health_parts.axis_year import AxisYear, Log
from health_parts.machine import Array, CELSIUS
import numpy as np

HEAD = (
    'Scope Export',
    'File\tfeed.svdx',
    'StartTime\t{0.day}-{0.month}-{0.year} {0:%H:%M:%S}',
    'Version\t3.1',
    '',
)


def write_year(year: AxisYear, folder: Path) -> list[Path]:
    """Write each log of a year as `feed_NN.csv` in a folder; return the files in order."""
    folder.mkdir(parents=True, exist_ok=True)
    paths = []
    for number, log in enumerate(year.logs):
        path = folder / f'feed_{number:02}.csv'
        path.write_text(scope_text(log, year.machine.size.lead), encoding='utf-8')
        paths.append(path)
    return paths


def scope_text(log: Log, lead: float) -> str:
    """Return a log of a screw with a lead [m] as text."""
    columns = list(_columns(log, lead))
    names = [name for name, _, _ in columns]
    start = datetime.datetime.fromtimestamp(log.start // 10**9, datetime.UTC)
    period = _number(1e3 * float(log.time[1] - log.time[0]))
    head = [
        *(line.format(start) for line in HEAD),
        _row(['Name', *names]),
        _row(['SymbolName', *(f'Axes.X.{name}' for name in names)]),
        _row(['Data-Type', *('REAL64' for _ in names)]),
        _row(['SampleTime[ms]', *(period for _ in names)]),
        _row(['Unit', *(unit for _, unit, _ in columns)]),
    ]
    values = np.column_stack([1e3 * log.time, *(values for _, _, values in columns)])
    rows = (_row([_number(value) for value in row]) for row in values.tolist())
    return '\n'.join([*head, *rows]) + '\n'


def _columns(log: Log, lead: float) -> Sequence[tuple[str, str, Array]]:
    """Return name, unit and values of the columns that a log has."""
    columns = [
        ('ActPos', 'mm', 1e3 * log.position),
        ('ActVelo', 'mm/s', 1e3 * log.speed * lead / (2.0 * math.pi)),
        ('fTorque', 'Nm', log.torque),
    ]
    if log.load is not None:
        columns.append(('fForce', 'N', log.load))
    if log.temperature is not None:
        columns.append(('fOilTemp', '°C', log.temperature - CELSIUS))
    return columns


def _number(value: float) -> str:
    return f'{value:.4f}'.replace('.', ',')


def _row(cells: Sequence[str]) -> str:
    return '\t'.join(cells)
