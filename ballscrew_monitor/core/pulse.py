# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
When to tick, and whether the clock still runs.

Two clocks meet here: `now` [ns] is that of the stamps, which may be set back, simulated or at a
stand; `steady` [ns] only ever runs on. Both are handed in.

"""


class Pulse:
    """Gives each stamp of a grid at most once, and none while input may wait to be taken."""

    def __init__(self, period: int) -> None:
        """Begin with a grid of `period` [ns]."""
        self._period = period
        self._last_grid = -1
        self._taken = False  # input, since the last tick
        self._catch_up_end = 0  # on the steady clock
        self._now = -1
        self._changed = 0  # when `now` did, on the steady clock

    def take_input(self) -> None:
        """Note that a message was taken from its queue."""
        self._taken = True

    def be_busy(self, begin: int, end: int) -> None:
        """
        Note that nothing was taken from `begin` to `end` [ns] of the steady clock.

        What has come in since then is old when it is taken, and not stale. To take it needs less
        time than it took to come in, or the node could not keep up at all.

        """
        if end - begin > self._period:
            self._catch_up_end = end + (end - begin)
            self._taken = True  # the next tick comes before the first message

    def tick(self, now: int, steady: int) -> int | None:
        """Return the stamp [ns] to tick at, if any."""
        waiting = self._taken and steady < self._catch_up_end
        self._taken = False
        grid = now - now % self._period
        if waiting or grid == self._last_grid:
            return None
        self._last_grid = grid
        return grid

    def stood(self, now: int, steady: int) -> int:
        """Return for how long [ns] this has found the same `now`."""
        if now != self._now:
            self._now, self._changed = now, steady
        return steady - self._changed
