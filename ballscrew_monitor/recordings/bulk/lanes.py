# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
One input over a stretch of entries: which of its samples count, and what is held when.

What `Monitor.update` and `Tracker` do sample by sample. A lane begins with what the tracker of the
input knows and tells it in the end what it has missed.

"""

import dataclasses
from typing import Any

from ballscrew_monitor.core.estimate import PointSource
from ballscrew_monitor.core.input_status import RATE_SAMPLES, Tracker
from ballscrew_monitor.core.inputs import implausible, InputSample, Refusal
from ballscrew_monitor.core.monitor import BACKWARD_JUMP
from ballscrew_monitor.recordings.bulk.entries import Entries, Kind
import numpy as np
from numpy.typing import NDArray

Places = NDArray[np.intp]
Times = NDArray[np.int64]
NEVER = -(2**62)


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class Lane:
    """
    The entries of one input by their places in the stretch.

    `own` are all of them, `good` the samples that are taken, `bad` the refused ones; a sample at
    `jumps` was stamped long before the one before it.

    """

    entries: Entries
    tracker: Tracker
    most: float
    own: Places
    good: Places
    bad: Places
    jumps: Places

    def stamps(self, at: Places) -> Times:
        """Return the stamps [ns] of the last good samples at some places, `NEVER` for none."""
        before = NEVER if self.tracker.last is None else self.tracker.last.stamp
        return self._held(at, self.entries.stamp, before)

    def fresh(self, at: Places, now: Times) -> NDArray[np.bool_]:
        """Tell whether a good sample has arrived within the timeout before `now` [ns]."""
        before = NEVER if self.tracker.last is None else self.tracker.last.arrival
        return now - self._held(at, self.entries.arrival, before) <= self.tracker.timeout

    def values(self, at: Places, now: Times) -> tuple[NDArray[np.float64], NDArray[np.uint8]]:
        """Return the values that are held at some places and their standing, a PointSource."""
        last = self.tracker.last
        value = self._held(at, self.entries.value, np.nan if last is None else last.value)
        good, bad = _last(self.good, at, -2), _last(self.bad, at, -3)
        if self.tracker.refusal is not None:
            bad = np.maximum(bad, -1)
        measured = self.fresh(at, now) & (good > bad)
        source = np.where(measured, PointSource.MEASURED, PointSource.HELD)
        if last is None:
            source[good < 0] = PointSource.UNKNOWN
        return value, source.astype(np.uint8)

    def _held(self, at: Places, column: NDArray[Any], before: Any) -> NDArray[Any]:
        """Return a column of the last good samples, `before` where there is none yet."""
        place = _last(self.good, at, -1)
        return np.where(place < 0, before, column[place] if len(column) else before)

    def slow_periods(self) -> Times:
        """Return what `Tracker.slow_period` is after each of the good samples [ns]."""
        gap, long = self._gaps()
        before = np.concatenate([[self.tracker._long_gaps > 0], long[:-1]])
        return np.where(long & before, gap, 0)

    def _gaps(self) -> tuple[Times, NDArray[np.bool_]]:
        """Return the time since the sample before [ns], and whether it is above the timeout."""
        stamp = self.entries.stamp[self.good]
        first = stamp[:1] if self.tracker.last is None else [self.tracker.last.stamp]
        gap = np.diff(np.concatenate([np.asarray(first, dtype=np.int64), stamp]))
        return gap, gap > self.tracker.timeout

    def may_lag(self) -> bool:
        """Tell whether any stamp lies far behind its arrival."""
        lag = (self.entries.arrival - self.entries.stamp)[self.good]
        return self.tracker.lagging or bool((lag > self.tracker.max_lag).any())

    def part(self, begin: int, end: int) -> 'Lane':
        """Return the lane between two places of the stretch."""
        parts = {name: getattr(self, name) for name in ('own', 'good', 'bad', 'jumps')}
        bounds = {name: np.searchsorted(part, [begin, end]) for name, part in parts.items()}
        return dataclasses.replace(
            self, **{name: part[slice(*bounds[name])] for name, part in parts.items()}
        )

    def tell(self) -> None:
        """Tell the tracker of all entries."""
        tracker, entries = self.tracker, self.entries
        tracker.received += len(self.own) - len(self.bad)
        tracker.dropped += len(self.own) - len(self.good) - len(self.bad)
        for at in self.bad.tolist():
            tracker.refuse(self._refusal(at))
        if len(self.good):
            self._tell_good()
        last = self.good[-1] if len(self.good) else -1
        others = self.own[self.own > last]
        others = others[entries.kind[others] == Kind.OTHER_JOINTS]
        for joints in dict.fromkeys(entries.note[others].tolist()):
            tracker.hear_of(joints)

    def _refusal(self, at: int) -> Refusal:
        event = self.entries.event(at)
        return implausible(event, self.most) if isinstance(event, InputSample) else event

    def _tell_good(self) -> None:
        tracker, entries = self.tracker, self.entries
        gap, long = self._gaps()
        run = len(long) - np.flatnonzero(~long)[-1] - 1 if not long.all() else len(long)
        longest = int(gap[-run:].max()) if run else 0
        if run == len(long):
            run, longest = run + tracker._long_gaps, max(longest, tracker._longest_gap)
        tracker._long_gaps, tracker._longest_gap = int(run), longest
        tracker._others.clear()
        tracker._stamps.extend(entries.stamp[self.good[-RATE_SAMPLES:]].tolist())
        timed = self.good[entries.header[self.good] & (entries.arrival[self.good] != 0)]
        timed = timed[-RATE_SAMPLES:]
        tracker._lags.extend((entries.arrival[timed] - entries.stamp[timed]).tolist())
        last = entries.event(int(self.good[-1]))
        assert isinstance(last, InputSample)
        tracker.last = last
        if not len(self.bad) or self.bad[-1] < self.good[-1]:
            tracker.refusal = None


def _last(places: Places, at: Places, none: int) -> Places:
    """Return the last of some places up to each of others, `none` where there is none."""
    if not len(places):
        return np.full(len(at), none)
    found = np.searchsorted(places, at, 'right') - 1
    return np.where(found < 0, none, places[found])


def make_lane(entries: Entries, tracker: Tracker, most: float) -> Lane:
    """Return the lane of an input; an amount above `most` [SI] is not plausible."""
    own = np.flatnonzero(entries.source == tracker.source)
    sample = entries.kind[own] == Kind.SAMPLE
    with np.errstate(invalid='ignore'):
        plausible = sample & ~(np.abs(entries.value[own]) > most)
    bad = own[(sample & ~plausible) | (entries.kind[own] == Kind.REFUSED)]
    good = own[plausible]
    stamp = entries.stamp[good]
    first = NEVER if tracker.last is None else tracker.last.stamp
    before = np.maximum.accumulate(np.concatenate([[first], stamp]))[:-1]
    late = stamp < before
    return Lane(
        entries=entries,
        tracker=tracker,
        most=most,
        own=own,
        good=good[~late],
        bad=bad,
        jumps=good[late & (before - stamp > BACKWARD_JUMP)],
    )
