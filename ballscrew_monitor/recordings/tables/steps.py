# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Times between the rows of a log, counted in narrow bins: their median in bounded memory."""

import math

from ballscrew_monitor.recordings.tables.cells import Array
import numpy as np

WIDTH = 1e-4  # relative, of a bin
LARGEST = 1e19  # [ns] more than any stamp
HUGE_GAP = 100  # times the usual time between rows
_BINS = 2 + math.ceil(math.log(LARGEST) / math.log1p(WIDTH))


class Steps:
    """Times between rows, told block by block; a median is right but for the width of a bin."""

    def __init__(self) -> None:
        """Begin with no row."""
        self._counts = np.zeros(_BINS, np.int64)
        self._sums = np.zeros(_BINS)
        self._last = np.zeros(0)
        self._rows = 0
        self.longest, self.longest_row = 0.0, 0  # [ns], of the row before it

    def add(self, stamps: Array) -> None:
        """Count the steps to and between the next rows, of stamps [ns]."""
        steps = np.diff(np.concatenate([self._last, stamps]))
        if len(steps):
            bins = _bins(steps)
            self._counts += np.bincount(bins, minlength=_BINS)
            self._sums += np.bincount(bins, weights=steps, minlength=_BINS)
            at = int(steps.argmax())
            if steps[at] > self.longest:
                self.longest = float(steps[at])
                self.longest_row = max(self._rows, 1) + at
        self._rows += len(stamps)
        self._last = stamps[-1:]

    @property
    def median(self) -> float:
        """Return the time between rows [ns] that half of them keep; needs two rows."""
        total = int(self._counts.sum())
        middle = np.searchsorted(
            np.cumsum(self._counts), [(total - 1) // 2, total // 2], side='right'
        )
        return float(np.mean(self._sums[middle] / self._counts[middle]))

    def gaps(self) -> int:
        """Return how many steps are huge beside the usual one."""
        means = self._sums / np.maximum(self._counts, 1)
        usual = self.median
        return int(self._counts[means > HUGE_GAP * usual].sum()) if usual > 0 else 0


def _bins(steps: Array) -> np.ndarray[tuple[int, ...], np.dtype[np.int64]]:
    """Return the bin of each step; the first is that of steps below 1 ns."""
    places = np.log(np.clip(steps, 1.0, LARGEST)) / math.log1p(WIDTH)
    return np.where(steps < 1.0, 0, 1 + places).astype(np.int64)
