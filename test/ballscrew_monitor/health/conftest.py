# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Rows of a known motion, and cells of a known torque."""

from ballscrew_monitor.core.conversions import SECOND
from ballscrew_monitor.health.records import Cell, Stretch
from ballscrew_monitor.health.rows import DAY
from ballscrew_monitor.judge.many import ROW
from ballscrew_monitor.judge.records import Row
import numpy as np
import pytest
from surrogate.surface import shipped_surface, Surface
from surrogate.surface.records import from_array

TODAY = 20_000
NOON = TODAY * DAY + DAY // 2
MEASURED = 1


class Motion:
    """Rows that are judged, every one in order unless it is changed."""

    noon, today = NOON, TODAY

    def rows(self, speeds, *, rate=100, start=NOON, torque=0.5, load=500.0, temperature=313.0):
        """Return rows at a rate [1/s] of speeds [rad/s], the rest constant or one for each."""
        speeds = np.asarray(speeds, dtype=float)
        rows = np.zeros(len(speeds), ROW)
        rows['stamp'] = start + np.arange(len(speeds)) * (SECOND // rate)
        rows['speed'] = speeds
        rows['axial_load'], rows['temperature'], rows['motor_torque'] = load, temperature, torque
        for name in ('axial_load', 'temperature', 'motor_torque'):
            rows[f'{name}_source'] = MEASURED
        rows['direction'] = np.where(speeds > 0.0, 1, 2)
        rows['validity'] = 1
        rows['gates'] = (np.abs(speeds) < 0.5).astype(int)
        rows['friction_torque'] = 0.2
        return rows

    def steady(self, seconds, speed=50.0, **changes):
        """Return rows of one speed [rad/s] for a time [s]."""
        return self.rows(np.full(round(seconds * changes.get('rate', 100)), speed), **changes)

    def then(self, *parts, after=10_000_000):
        """Return rows of several parts, each `after` [ns] the last row before."""
        for before, part in zip(parts[:-1], parts[1:], strict=True):
            part['stamp'] += before['stamp'][-1] + after - part['stamp'][0]
        return np.concatenate(parts)

    def single(self, rows):
        """Return rows as records, as a node has them."""
        return [from_array(Row, row) for row in rows]

    def stretch(self, **changes):
        """Return a stretch of today."""
        values = {
            'start': NOON,
            'duration': 5.0,
            'samples': 50,
            'speed': 50.0,
            'axial_load': 500.0,
            'temperature': 313.0,
            'motor_torque': 0.5,
        }
        return Stretch(**values | changes)

    def cell(self, **changes):
        """Return a cell of today, of several stretches."""
        values = {
            'first_day': TODAY,
            'speed_band': 21,
            'load_band': 6,
            'direction': 1,
            'stretches': 4,
            'duration': 20.0,
            'speed': 50.0,
            'axial_load': 500.0,
            'temperature': 313.0,
            'motor_torque': 0.5,
        }
        values |= changes
        return Cell(**{'start': values['first_day'] * DAY} | values)


@pytest.fixture(scope='session')
def motion():
    return Motion()


@pytest.fixture(scope='session')
def surface():
    return Surface.load(shipped_surface())
