# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Time that an axis was surely outside its zone: wherever in its bands the limit of RCS may lie.

The bands are factors on the speed of the limit. A row in which asperities carry too much is surely
outside if they also do at its speed over the least factor. Too low an efficiency is surely so. As
in the survey, a row lasts until the next one, unless that comes after the timeout of the speed.

"""

from ballscrew_monitor.core.conversions import SECOND
from ballscrew_monitor.core.judgement import Limits, Zone
from ballscrew_monitor.judge.point import POSITIVE
from ballscrew_monitor.judge.records import LIGHT_LOAD
import numpy as np
from numpy.typing import NDArray
from surrogate.surface import look_up_many, Surface

Rows = NDArray[np.void]


class SureTime:
    """Adds up the time surely outside of one axis."""

    def __init__(self, surface: Surface, limits: Limits, *, max_gap: int) -> None:
        """Begin without rows; a row lasts `max_gap` [ns] at most."""
        self._surface, self._limits, self._max_gap = surface, limits, max_gap
        self._least = min(*surface.limit_band, *surface.numerical_band)
        self._last = np.empty(0, np.int64), np.empty(0, bool)
        self._time = 0

    def add(self, rows: Rows) -> None:
        """Take the next rows, an array of ROW."""
        stamps, sure = rows['stamp'], self._surely_outside(rows)
        before = np.concatenate([self._last[0], stamps]), np.concatenate([self._last[1], sure])
        steps = np.diff(before[0])
        counted = before[1][:-1] & (steps > 0) & (steps <= self._max_gap)
        self._time += int(steps[counted].sum())
        self._last = stamps[-1:].copy(), sure[-1:]

    def _surely_outside(self, rows: Rows) -> NDArray[np.bool_]:
        outside = rows['zone'] == Zone.OUTSIDE
        heavy = rows['gates'] & LIGHT_LOAD == 0
        sure: NDArray[np.bool_] = outside & heavy & (rows['efficiency'] < self._limits.efficiency)
        asked = np.flatnonzero(outside & ~sure)
        if len(asked) and np.isfinite(self._least):
            some = rows[asked]
            load = np.where(some['direction'] == POSITIVE, -1.0, 1.0) * some['axial_load']
            speed = np.abs(some['speed']) / self._least
            answers = look_up_many(self._surface, speed, load, some['temperature'])
            sure[asked] = answers['rcs'] >= self._limits.rcs
        return sure

    @property
    def seconds(self) -> float:
        """Return the time surely outside [s], NaN on a surface without its bands."""
        return self._time / SECOND if np.isfinite(self._least) else np.nan
