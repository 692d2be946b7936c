# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Plain twin of `judge/slopes.py`: least squares over a deque, summed exactly."""

import collections
import math

from ballscrew_monitor.core.conversions import seconds

NAN = math.nan
FEWEST = 2  # samples of a line
MOST = 512  # samples in a window; faster sources shorten it
LARGEST = 1e300  # differences of samples beyond it have no slope: their sums would overflow


class SlopeFilter:
    """Slope of the samples of a window, which begins anew after a hole and a step back in time."""

    def __init__(self, *, window: int, max_gap: int) -> None:
        """Begin without samples; window and longest gap between samples [ns]."""
        self.window = window
        self.max_gap = max_gap
        self._samples: collections.deque[tuple[int, float]] = collections.deque(maxlen=MOST)

    @property
    def last(self) -> tuple[int, float] | None:
        """Return stamp [ns] and value of the last sample, None without one."""
        return self._samples[-1] if self._samples else None

    def restart(self, stamp: int, value: float) -> None:
        """Forget the samples but this one."""
        self._samples.clear()
        self._samples.append((stamp, value))

    def shift(self, amount: float) -> None:
        """Add `amount` to every sample."""
        for place, (stamp, value) in enumerate(self._samples):
            self._samples[place] = stamp, value + amount

    def take(self, stamp: int, value: float) -> None:
        """Take a sample at `stamp` [ns]; one of the same stamp as the last replaces it."""
        samples = self._samples
        if not samples or not 0 <= stamp - samples[-1][0] <= self.max_gap:
            self.restart(stamp, value)
            return
        if stamp == samples[-1][0]:
            samples.pop()
        samples.append((stamp, value))
        while len(samples) > FEWEST and stamp - samples[0][0] > self.window:
            samples.popleft()

    @property
    def slope(self) -> float:
        """Return the slope [1/s], of the last two samples at least; NaN with fewer."""
        return _slope(list(self._samples))

    @property
    def change(self) -> float:
        """
        Return by how much the slope of the newest quarter of the window is another [1/s].

        That quarter has two samples at least. What the slope leaves out shows here: its own
        change within the window, and noise.

        """
        samples = list(self._samples)
        begin = samples[-1][0] - self.window // 4 if samples else 0
        newest = [sample for sample in samples if sample[0] >= begin]
        newest = newest if len(newest) >= FEWEST else samples[-FEWEST:]
        return abs(_slope(newest) - _slope(samples))


def _slope(samples: list[tuple[int, float]]) -> float:
    """Return the slope of the least-squares line [1/s]; NaN of less than two samples."""
    if len(samples) < FEWEST:
        return NAN
    end, value = samples[-1]
    if max(abs(other - value) for _, other in samples) > LARGEST:
        return NAN
    # From the last sample: differences of large numbers keep their digits.
    times = [seconds(stamp - end) for stamp, _ in samples]
    middle = math.fsum(times) / len(times)
    arms = [time - middle for time in times]
    moment = math.fsum(arm * (other - value) for arm, (_, other) in zip(arms, samples))
    return moment / math.fsum(arm * arm for arm in arms)
