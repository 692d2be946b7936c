# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
The events of a whole bag in the order in which they are judged, and the ticks between them.

Events arrive by their log times and are judged by their stamps, as far as these are out of order
by less than `REORDER`; a clock that is set back begins a new time line. Ticks lie on a grid of log
time, after the samples of equal stamp.

"""

from collections.abc import Callable, Iterator, Sequence
import functools
import heapq
from typing import Any, NamedTuple

from ballscrew_monitor.core.conversions import nanoseconds
from ballscrew_monitor.judge.records import RUN, SAMPLE
from ballscrew_monitor.judge.step import BACKWARD_JUMP
from ballscrew_monitor.recordings.bag import Bag
from ballscrew_monitor.recordings.bulk.batches import batches
from ballscrew_monitor.recordings.bulk.chunks import Integers
from ballscrew_monitor.recordings.bulk.decode import readers_by_topic, TopicDecoder
from ballscrew_monitor.recordings.bulk.events import (
    Events,
    inserted,
    joined,
    Notes,
    some,
    TICK_SOURCE,
    ticks,
)
from ballscrew_monitor.recordings.bulk.written import check_rising, WrittenTimes
from ballscrew_monitor.settings.axis import Axis
import numpy as np

REORDER = nanoseconds(1.0)  # [ns] log time over which samples are put into the order of stamps
LONGEST_HOLE = nanoseconds(60.0)  # [ns] between two messages that is filled with ticks
LAST = 2**63 - 1  # place of a tick among what is logged at the same time
LOWEST = -(2**62)
RANGE = 2**59  # [ns] of stamps that fit into one key with the source
OnDone = Callable[[float], None]
"""Told which share of a bag is done [-]."""


@functools.singledispatch
def ordered_events(
    bag: Bag, axes: list[Axis], period: int, notes: Notes, *, on_done: OnDone
) -> Iterator[Events]:
    """
    Yield the events of `axes` in the order in which they are judged, a tick each `period` [ns].

    `notes` keep what they refer to. `on_done` is told how far the bag is judged [-]. Raises
    InputError for a damaged bag, and for one of several runs that cannot be told apart.

    """
    readers = readers_by_topic(axes)
    decoders = {topic: TopicDecoder(bag, wanted, notes) for topic, wanted in readers.items()}
    order, written = EventOrder(period, bag.run_borders), WrittenTimes()
    for batch in batches(bag, decoders.keys()):
        for topic, messages in batch.topics.items():
            written.add(topic, messages)
        decoded = [decoders[topic].events(messages) for topic, messages in batch.topics.items()]
        yield order.push(joined(decoded), batch.until)
        on_done(batch.done)
    check_rising(bag, written, decoders.keys())
    yield order.finish()


class _Keys(NamedTuple):
    """By what events are ordered: stamp and log time [ns], source, and axis with source."""

    stamp: Integers
    log_time: Integers
    source: Integers
    line: Integers  # -1 for what is no sample

    def some(self, which: Any) -> '_Keys':
        return _Keys(*(column[which] for column in self))


def _keys_of(events: Events) -> _Keys:
    line = events['axis'].astype(np.int64) * (TICK_SOURCE + 1) + events['source']
    line[events['kind'] != SAMPLE] = -1
    source = events['source'].astype(np.int64)
    return _Keys(events['stamp'].copy(), events['log_time'].copy(), source, line)


class EventOrder:
    """
    Puts events into the order of judging, with the ticks between them.

    They arrive in the order of their log times, and leave in that of their stamps. In the pause
    between two runs of a log there is no tick, but the begin of the next run.

    """

    def __init__(self, period: int, borders: Sequence[int] = ()) -> None:
        """Begin with nothing; a tick is due at every multiple of `period` [ns]."""
        self._period = period
        self._borders = np.array(borders, np.int64)  # [ns] in the pauses between runs
        self._later = self._waiting = joined([])  # not arrived yet; arrived
        self._passed: int | None = None  # the last log time
        self._past = LOWEST, 0  # largest stamp that has been handed on, and its source
        self._last: dict[int, int] = {}  # stamps [ns] by axis and source

    def push(self, events: Events, until: int) -> Events:
        """Return what is judged next when all has arrived that was logged before `until` [ns]."""
        events = joined([self._later, events])
        ready = events['log_time'] < until
        self._later = some(events, ~ready)
        events = events if ready.all() else some(events, ready)
        if not len(events):
            return events
        arrival = np.lexsort((events['place'], events['log_time']))
        times = events['log_time'][arrival]
        due, before = self.ticks(times), len(self._waiting)
        everything = joined([self._waiting, events, due])
        at = np.searchsorted(times, due['stamp'], 'right')
        arrived = np.insert(arrival, at, len(events) + np.arange(len(due)))
        return self._take(
            everything, np.concatenate([np.arange(before), before + arrived]), before
        )

    def _take(self, events: Events, arrival: Integers, before: int) -> Events:
        """Return what leaves of the events, which have arrived so; some of them waited before."""
        keys = _keys_of(events).some(arrival)
        leaving: list[Integers] = []
        waiting, begin = np.arange(before), before
        arrived, cuts = keys.some(slice(before, None)), set[int]()
        # Where a clock is set back, what came before leaves before the new time line.
        for line in set(np.unique(arrived.line).tolist()) - {-1}:
            at = np.flatnonzero(arrived.line == line)
            stamp = arrived.stamp[at]
            last = np.concatenate([[self._last.get(line, stamp[0])], stamp[:-1]])
            cuts.update((before + at[last - stamp > BACKWARD_JUMP]).tolist())
            self._last[line] = int(stamp[-1])
        for cut in [*sorted(cuts), None]:
            end = len(arrival) if cut is None else cut
            present = np.concatenate([waiting, np.arange(begin, end)])
            order, ready = self._order(keys.some(present), len(waiting))
            leaving.append(present[order[:ready]])
            waiting, begin = present[np.sort(order[ready:])], end
            self._pass(keys.some(leaving[-1]))
            if cut is not None:
                leaving.append(waiting[_by_stamp(keys.some(waiting))])
                waiting, self._past = waiting[:0], (LOWEST, 0)
        self._waiting = some(events, arrival[waiting])
        return some(events, arrival[np.concatenate(leaving)])

    def finish(self) -> Events:
        """Return the rest."""
        rest, self._waiting = self._waiting, joined([])
        self._past = LOWEST, 0
        return some(rest, _by_stamp(_keys_of(rest)))

    def _pass(self, leaving: _Keys) -> None:
        if len(leaving.stamp):
            last = int(leaving.stamp.max())
            self._past = max(self._past, (last, int(leaving.source[leaving.stamp == last].max())))

    def _order(self, keys: _Keys, before: int) -> tuple[Integers, int]:
        """Return the places of the events by stamp, and how many of them are ready."""
        if not len(keys.stamp):
            return np.arange(0), 0
        if not self._is_plain(keys):
            return _one_by_one(keys, before)
        order = _by_stamp(keys)
        young = keys.log_time[-1] - keys.log_time[order] <= REORDER
        return order, int(young.argmax())

    def _is_plain(self, keys: _Keys) -> bool:
        """Return True if nothing comes before what may have been handed on when it arrived."""
        stamp, (past, source) = keys.stamp, self._past
        largest = np.maximum.accumulate(stamp)
        gone = np.searchsorted(keys.log_time, keys.log_time - REORDER)
        later = (stamp > past) | ((stamp == past) & (keys.source >= source))
        return bool((later & ((gone == 0) | (stamp > largest[gone - 1]))).all())

    def ticks(self, times: Integers) -> Events:
        """Return ticks and runs up to the last of some log times, but few in a long hole."""
        first = int(times[0]) if self._passed is None else self._passed
        self._passed = int(times[-1])
        times = np.concatenate([[first], times])
        runs = np.searchsorted(self._borders, times)
        pauses = np.diff(runs) > 0
        holes = np.flatnonzero((np.diff(times) > LONGEST_HOLE) | pauses)
        begins = [first, *times[holes + 1].tolist()]
        ends = [*times[holes].tolist(), int(times[-1])]
        grids = [self._grid(begin, end) for begin, end in zip(begins, ends)]
        for hole in holes[~pauses[holes]]:
            begin, end = int(times[hole]), int(times[hole + 1])
            grids.append(self._grid(begin, min(end, self._ceiling(begin) + LONGEST_HOLE)))
        due = ticks(np.sort(np.concatenate(grids)), place=LAST)
        if not pauses.any():
            return due
        first, last = runs[0], runs[-1]
        borders = ticks(self._borders[first:last], place=LAST, kind=RUN)
        return inserted(due, np.searchsorted(due['stamp'], borders['stamp']), borders)

    def _grid(self, begin: int, end: int) -> Integers:
        return np.arange(self._ceiling(begin), end, self._period, dtype=np.int64)

    def _ceiling(self, time: int) -> int:
        return -(-time // self._period) * self._period


def _by_stamp(keys: _Keys) -> Integers:
    """Return the places of events that have arrived in this order by stamp and source."""
    if not len(keys.stamp):
        return np.arange(0)
    first = int(keys.stamp.min())
    if int(keys.stamp.max()) - first >= RANGE:
        return np.lexsort((keys.source, keys.stamp))
    return np.argsort((keys.stamp - first) * 8 + keys.source, kind='stable')


def _one_by_one(keys: _Keys, before: int) -> tuple[Integers, int]:
    """Return the same where some come too late to be put into order; `before` waited already."""
    log_times = keys.log_time.tolist()
    places = list(zip(keys.stamp.tolist(), keys.source.tolist(), range(len(log_times))))
    waiting, ready = places[:before], []
    heapq.heapify(waiting)
    for place, log_time in zip(places[before:], log_times[before:]):
        heapq.heappush(waiting, place)
        while log_time - log_times[waiting[0][2]] > REORDER:
            ready.append(heapq.heappop(waiting)[2])
    rest = [place[2] for place in sorted(waiting)]
    return np.array(ready + rest, dtype=np.int64), len(ready)
