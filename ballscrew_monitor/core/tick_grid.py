# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
The grid of ticks in time, and whether the clock still runs.

Two clocks meet here: `now` [ns] is that of the stamps, which may be set back, simulated or at a
stand; `steady` [ns] only ever runs on. Both are handed in.

"""


class TickGrid:
    """Gives each stamp of a grid at most once."""

    def __init__(self, period: int) -> None:
        """Begin with a grid of `period` [ns]."""
        self._period = period
        self._last_grid = -1
        self._now = -1
        self._changed = 0  # when `now` did, on the steady clock

    def tick(self, now: int) -> int | None:
        """Return the stamp [ns] to tick at, if any."""
        grid = now - now % self._period
        if grid == self._last_grid:
            return None
        self._last_grid = grid
        return grid

    def stood(self, now: int, steady: int) -> int:
        """Return for how long [ns] this has found the same `now`."""
        if now != self._now:
            self._now, self._changed = now, steady
        return steady - self._changed
