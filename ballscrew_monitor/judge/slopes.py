# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
The slope of a sampled quantity, causal: a speed from positions, an acceleration from speeds.

A straight line is fitted by least squares to the samples of the last window. It is exact for a
ramp. Of a sine of angular frequency w, sampled densely, a window T gives the slope T / 2 late and
3 (sin u - u cos u) / u^3 times as large, u = w T / 2: 0.9 at w T = 2, 0.65 at 4. Stamps are
arguments, there is no clock. The sums are taken over the whole window each time, so that nothing
drifts. In the subset of Python that also compiles.

"""

import dataclasses
import math

from surrogate.surface.records import many

NAN = math.nan
FEWEST = 2  # samples of a line
MOST = 512  # samples in a window; faster sources shorten it
WRAP = MOST - 1  # places of the ring are counted modulo MOST, a power of two
LARGEST = 1e300  # differences of samples beyond it have no slope: their sums would overflow
SECOND = 1e9  # [ns]


@dataclasses.dataclass(slots=True)
class SlopeRing:
    """The samples of a window: stamps [ns] and values, `count` of them from `begin` on."""

    stamps: list[int] = many(MOST, 0)
    values: list[float] = many(MOST, 0.0)
    begin: int = 0
    count: int = 0


def slope_restart(ring: SlopeRing, stamp: int, value: float) -> None:
    """Forget the samples but this one at `stamp` [ns]."""
    ring.begin, ring.count = 0, 1
    ring.stamps[0], ring.values[0] = stamp, value


def slope_shift(ring: SlopeRing, amount: float) -> None:
    """Add `amount` to every sample."""
    for place in range(ring.count):
        ring.values[(ring.begin + place) & WRAP] += amount


def slope_move(ring: SlopeRing, step: int) -> None:
    """Add a `step` [ns] to the stamp of every sample."""
    for place in range(ring.count):
        ring.stamps[(ring.begin + place) & WRAP] += step


def slope_last(ring: SlopeRing) -> int:
    """Return the place of the last sample of a ring that has one."""
    return (ring.begin + ring.count - 1) & WRAP


def slope_take(ring: SlopeRing, window: int, max_gap: int, stamp: int, value: float) -> None:
    """
    Take a sample at `stamp` [ns]; one of the same stamp as the last replaces it.

    The window [ns] begins again after a step back in time and a hole of more than `max_gap` [ns].

    """
    last = slope_last(ring)
    if ring.count == 0 or not 0 <= stamp - ring.stamps[last] <= max_gap:
        slope_restart(ring, stamp, value)
        return
    if stamp != ring.stamps[last]:
        last = (last + 1) & WRAP
        if ring.count == MOST:
            ring.begin = (ring.begin + 1) & WRAP
        else:
            ring.count += 1
    ring.stamps[last], ring.values[last] = stamp, value
    while ring.count > FEWEST and stamp - ring.stamps[ring.begin] > window:
        ring.begin = (ring.begin + 1) & WRAP
        ring.count -= 1


def slope_of(ring: SlopeRing) -> float:
    """Return the slope [1/s], of the last two samples at least; NaN with fewer."""
    return slope_after(ring, 0)


def slope_change(ring: SlopeRing, window: int) -> float:
    """
    Return by how much the slope of the newest quarter of the window [ns] is another [1/s].

    That quarter has two samples at least. What the slope leaves out shows here: its own
    change within the window, and noise.

    """
    if ring.count < FEWEST:
        return NAN
    begin, skipped = ring.stamps[slope_last(ring)] - window // 4, 0
    while ring.count - skipped > FEWEST and ring.stamps[(ring.begin + skipped) & WRAP] < begin:
        skipped += 1
    return abs(slope_after(ring, skipped) - slope_after(ring, 0))


def slope_after(ring: SlopeRing, skipped: int) -> float:
    """Return the slope [1/s] without the oldest samples, so many are skipped."""
    count = ring.count - skipped
    if count < FEWEST:
        return NAN
    stamps, values, begin = ring.stamps, ring.values, ring.begin + skipped
    last = slope_last(ring)
    # From the last sample: differences of large numbers keep their digits.
    end, value = stamps[last], values[last]
    total = 0
    for place in range(begin, begin + count):
        total += stamps[place & WRAP] - end
    middle = total / SECOND / count
    moment = square = 0.0
    for place in range(begin, begin + count):
        difference = values[place & WRAP] - value
        if abs(difference) > LARGEST:
            return NAN
        arm = (stamps[place & WRAP] - end) / SECOND - middle
        moment += arm * difference
        square += arm * arm
    return moment / square
