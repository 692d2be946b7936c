# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
The events of a whole bag in the order in which they are judged, and the ticks between them.

Events arrive by their log times and are judged by their stamps, as far as these are out of order
by less than `REORDER`; a clock that is set back begins a new time line. Ticks lie on a grid of log
time, after the samples of equal stamp.

"""

from collections.abc import Callable, Iterator
import heapq

from ballscrew_monitor.core.conversions import nanoseconds
from ballscrew_monitor.judge.records import SAMPLE
from ballscrew_monitor.judge.step import BACKWARD_JUMP
from ballscrew_monitor.recordings.bag import Bag
from ballscrew_monitor.recordings.bulk.batches import batches
from ballscrew_monitor.recordings.bulk.decode import readers_by_topic, TopicDecoder
from ballscrew_monitor.recordings.bulk.events import Events, joined, Notes, TICK_SOURCE, ticks
from ballscrew_monitor.settings.axis import Axis
import numpy as np
from numpy.typing import NDArray

REORDER = nanoseconds(1.0)  # [ns] log time over which samples are put into the order of stamps
LONGEST_HOLE = nanoseconds(60.0)  # [ns] between two messages that is filled with ticks
LAST = 2**63 - 1  # place of a tick among what is logged at the same time
LOWEST = -(2**62)
RANGE = 2**59  # [ns] of stamps that fit into one key with the source
OnDone = Callable[[float], None]
"""Told which share of a bag is done [-]."""


def ordered_events(
    bag: Bag, axes: list[Axis], period: int, notes: Notes, *, on_done: OnDone
) -> Iterator[Events]:
    """
    Yield the events of `axes` in the order in which they are judged, a tick each `period` [ns].

    `notes` keep what they refer to. `on_done` is told how far the bag is judged [-]. Raises
    InputError for a damaged bag, unless its intact part is to be salvaged.

    """
    readers = readers_by_topic(axes)
    decoders = {topic: TopicDecoder(bag, wanted, notes) for topic, wanted in readers.items()}
    arrivals, order = Arrivals(period), StampOrder()
    for batch in batches(bag, decoders.keys()):
        decoded = [decoders[topic].events(found) for topic, found in batch.topics.items()]
        yield order.push(arrivals.push(joined(decoded), batch.until))
        on_done(batch.done)
    yield order.finish()


class Arrivals:
    """Puts events into the order of their log times, with the ticks between them."""

    def __init__(self, period: int) -> None:
        """Begin with nothing; a tick is due at every multiple of `period` [ns]."""
        self._period = period
        self._waiting = joined([])
        self._last: int | None = None  # log time that has been passed

    def push(self, events: Events, until: int) -> Events:
        """Return what was logged before `until` [ns], of these events and of those before."""
        everything = joined([self._waiting, events])
        ready = everything['log_time'] < until
        self._waiting = everything[~ready]
        arrived = everything[ready]
        if not len(arrived):
            return arrived
        arrived = joined([arrived, self._ticks(np.sort(arrived['log_time']))])
        return arrived.take(np.lexsort((arrived['place'], arrived['log_time'])))

    def _ticks(self, times: NDArray[np.int64]) -> Events:
        """Return the ticks up to the last of some log times, but few in a long hole."""
        first = int(times[0]) if self._last is None else self._last
        self._last = int(times[-1])
        times = np.concatenate([[first], times])
        holes = np.flatnonzero(np.diff(times) > LONGEST_HOLE)
        begins = [first, *times[holes + 1].tolist()]
        ends = [*times[holes].tolist(), int(times[-1])]
        grids = [self._grid(begin, end) for begin, end in zip(begins, ends)]
        for hole in holes:
            begin, end = int(times[hole]), int(times[hole + 1])
            grids.append(self._grid(begin, min(end, self._ceiling(begin) + LONGEST_HOLE)))
        stamps = np.concatenate(grids)
        return ticks(stamps, place=LAST)

    def _grid(self, begin: int, end: int) -> NDArray[np.int64]:
        return np.arange(self._ceiling(begin), end, self._period, dtype=np.int64)

    def _ceiling(self, time: int) -> int:
        return -(-time // self._period) * self._period


class StampOrder:
    """Puts events that arrive into the order of their stamps."""

    def __init__(self) -> None:
        """Begin with nothing."""
        self._waiting = joined([])
        self._past = LOWEST, 0  # largest stamp that has been handed on, and its source
        self._last: dict[int, int] = {}  # stamps [ns] by axis and source

    def push(self, arrived: Events) -> Events:
        """Return what is to be judged next, of what has arrived now and before."""
        parts, begin = [], 0
        for cut in self._cuts(arrived):
            parts += [self._push(arrived[begin:cut]), self.finish()]
            begin = cut
        return joined([*parts, self._push(arrived[begin:])])

    def _cuts(self, arrived: Events) -> list[int]:
        """Return where a clock is set back: what comes before the new time line comes before."""
        cuts = []
        lines = arrived['axis'] * (TICK_SOURCE + 1) + arrived['source']
        samples = arrived['kind'] == SAMPLE
        for line in np.unique(lines[samples]).tolist():
            at = np.flatnonzero(samples & (lines == line))
            stamp = arrived['stamp'][at]
            before = np.concatenate([[self._last.get(line, stamp[0])], stamp[:-1]])
            cuts += at[before - stamp > BACKWARD_JUMP].tolist()
            self._last[line] = int(stamp[-1])
        return sorted(set(cuts))

    def _push(self, arrived: Events) -> Events:
        everything = joined([self._waiting, arrived])
        if not len(everything):
            return everything
        order, ready = self._order(everything, len(self._waiting))
        ordered = everything[order[:ready]]
        self._waiting = everything[np.sort(order[ready:])]
        if ready:
            last = int(ordered['stamp'].max())
            of_last = int(ordered['source'][ordered['stamp'] == last].max())
            self._past = max(self._past, (last, of_last))
        return ordered

    def finish(self) -> Events:
        """Return the rest."""
        rest, self._waiting = self._waiting, joined([])
        self._past = LOWEST, 0
        return rest[_by_stamp(rest)]

    def _order(self, events: Events, before: int) -> tuple[NDArray[np.intp], int]:
        """Return the places of the events by stamp, and how many of them are ready."""
        if not self._is_plain(events):
            return _one_by_one(events, before)
        order = _by_stamp(events)
        young = events['log_time'][-1] - events['log_time'][order] <= REORDER
        return order, int(young.argmax())

    def _is_plain(self, events: Events) -> bool:
        """Tell whether nothing comes before what may have been handed on when it arrived."""
        stamp, (past, source) = events['stamp'], self._past
        largest = np.maximum.accumulate(stamp)
        gone = np.searchsorted(events['log_time'], events['log_time'] - REORDER)
        later = (stamp > past) | ((stamp == past) & (events['source'] >= source))
        return bool((later & ((gone == 0) | (stamp > largest[gone - 1]))).all())


def _by_stamp(events: Events) -> NDArray[np.intp]:
    """Return the places of events that have arrived in this order by stamp and source."""
    if not len(events):
        return np.empty(0, dtype=np.intp)
    first = int(events['stamp'].min())
    if int(events['stamp'].max()) - first >= RANGE:
        return np.lexsort((events['source'], events['stamp']))
    return np.argsort((events['stamp'] - first) * 8 + events['source'], kind='stable')


def _one_by_one(events: Events, before: int) -> tuple[NDArray[np.intp], int]:
    """Return the same where some come too late to be put into order; `before` waited already."""
    stamps, sources = events['stamp'].tolist(), events['source'].tolist()
    log_times = events['log_time'].tolist()
    keys = list(zip(stamps, sources, range(len(events))))
    waiting, ready = keys[:before], []
    heapq.heapify(waiting)
    for key, log_time in zip(keys[before:], log_times[before:]):
        heapq.heappush(waiting, key)
        while log_time - log_times[waiting[0][2]] > REORDER:
            ready.append(heapq.heappop(waiting)[2])
    rest = [key[2] for key in sorted(waiting)]
    return np.array(ready + rest, dtype=np.intp), len(ready)
