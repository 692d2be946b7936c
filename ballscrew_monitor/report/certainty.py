# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Time that an axis was surely outside its zone.

As in the survey, a row lasts until the next one, unless that comes after the timeout of the speed.

"""

import math

from ballscrew_monitor.core.conversions import SECOND
from ballscrew_monitor.core.judgement import Limits
from ballscrew_monitor.judge.certainty import least_factor, Rows, surely_outside
import numpy as np
from surrogate.surface import Surface


class SureTime:
    """Adds up the time surely outside of one axis."""

    def __init__(self, surface: Surface, limits: Limits, *, max_gap: int) -> None:
        """Begin without rows; a row lasts `max_gap` [ns] at most."""
        self._surface, self._limits, self._max_gap = surface, limits, max_gap
        self._banded = math.isfinite(least_factor(surface))
        self._last = np.empty(0, np.int64), np.empty(0, bool)
        self._time = 0

    def add(self, rows: Rows) -> None:
        """Take the next rows, an array of ROW."""
        stamps, sure = rows['stamp'], surely_outside(rows, self._surface, self._limits)
        before = np.concatenate([self._last[0], stamps]), np.concatenate([self._last[1], sure])
        steps = np.diff(before[0])
        counted = before[1][:-1] & (steps > 0) & (steps <= self._max_gap)
        self._time += int(steps[counted].sum())
        self._last = stamps[-1:].copy(), sure[-1:]

    @property
    def seconds(self) -> float:
        """Return the time surely outside [s], NaN on a surface without its bands."""
        return self._time / SECOND if self._banded else math.nan
