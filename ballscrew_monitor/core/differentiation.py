# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
The slope of a sampled quantity, causal: a speed from positions, an acceleration from speeds.

A straight line is fitted by least squares to the samples of the last window. It is exact for a
ramp. Of a sine of angular frequency w, sampled densely, a window T gives the slope T / 2 late and
3 (sin u - u cos u) / u^3 times as large, u = w T / 2: 0.9 at w T = 2, 0.65 at 4. Stamps are
arguments, there is no clock.

"""

import collections
import dataclasses
import math

from ballscrew_monitor.core.conversions import seconds
from ballscrew_monitor.core.inputs import InputSample, Refusal, StampSource, Why

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


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class PositionSettings:
    """How speeds follow from positions: window [ns], and the turn at which angles wrap [rad]."""

    window: int
    wrap: float = 0.0  # none


class SpeedFromPosition:
    """Makes samples of the speed out of those of the position."""

    def __init__(self, settings: PositionSettings, *, max_gap: int) -> None:
        """Begin without a position; `max_gap` is the timeout of the speed [ns]."""
        self._wrap = settings.wrap
        self._filter = SlopeFilter(window=settings.window, max_gap=max_gap)

    def take(self, sample: InputSample, *, most: float) -> InputSample | Refusal | None:
        """
        Return the speed [rad/s] at the stamp of a position [rad]; None for a first position.

        A position that asks for more than the speed `most` [rad/s] is refused, and so is the first
        one after a hole: no speed is known there. Both begin a new window.

        """
        refusal = self._refusal(sample, most)
        if refusal is not None:
            self._filter.restart(sample.stamp, sample.value)
            return refusal
        self._filter.take(sample.stamp, sample.value)
        speed = self._filter.slope
        return None if math.isnan(speed) else dataclasses.replace(sample, value=speed)

    def _refusal(self, sample: InputSample, most: float) -> Refusal | None:
        """Return why no speed follows from a position and the one before, if none does."""
        if self._filter.last is None:
            return None
        stamp, before = self._filter.last
        step = sample.value - before
        if self._wrap and math.isfinite(step / self._wrap):
            turns = self._wrap * round(step / self._wrap)
            self._filter.shift(turns)  # the way to the new position is the shorter one
            step -= turns
        gap, step = sample.stamp - stamp, abs(step)
        if gap > self._filter.max_gap:
            text = f'no position for {seconds(gap):.3g} s, so no speed follows'
            return _refused(sample, Why.HOLE, f'{text}: send more, or raise speed.timeout')
        if sample.stamp_source is not StampSource.HEADER:  # a burst of messages is no jump
            gap = max(gap, self._filter.window)
        if gap <= 0 or step <= most * seconds(gap):
            return None
        text = (
            f'the position jumps by {step:.4g} rad of the screw within {seconds(gap):.3g} s, '
            f'plausible is a speed of {most:.4g} rad/s: mend the source, or set speed.wrap to the '
            'position at which it begins anew'
        )
        return _refused(sample, Why.IMPLAUSIBLE, text)


def _refused(sample: InputSample, why: Why, text: str) -> Refusal:
    return Refusal(source=sample.source, why=why, text=text, arrival=sample.arrival)
