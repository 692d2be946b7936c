# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
The grid of ticks in time, whether the clock still runs, and by how much it was set.

Two clocks meet here: `now` [ns] is that of the stamps, which may be set back, simulated or at a
stand; `steady` [ns] only ever runs on. Both are handed in.

"""

from ballscrew_monitor.core.conversions import SECOND

LEAST_STEP = SECOND
"""A clock that changes by less [ns] was not set."""


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


class ClockSteps:
    """Finds by how much a clock was set, by the steady one; a machine that slept set it too."""

    def __init__(self) -> None:
        self._ahead: tuple[int, int] | None = None  # of the steady clock, at least and at most

    def take(self, now: int, before: int, after: int) -> int:
        """
        Return by how much [ns] the clock was set since it was last looked at, 0: not.

        `now` was read between the times `before` and `after` of the steady clock.

        """
        least, most = now - after, now - before
        known, self._ahead = self._ahead, (least, most)
        if known is None:
            return 0
        if least - known[1] > LEAST_STEP:
            return least - known[1]
        return min(most - known[0], 0) if known[0] - most > LEAST_STEP else 0
