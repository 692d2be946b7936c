# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Entries are put into order by arrays as one by one."""

import heapq

from ballscrew_monitor.judge.step import BACKWARD_JUMP
from ballscrew_monitor.recordings.bulk.entries import joined, Kind, made
from ballscrew_monitor.recordings.bulk.order import Arrivals, REORDER, StampOrder
from hypothesis import given
from hypothesis import strategies as st
import numpy as np

MS = 1_000_000
BEGIN = 1_700_000_000_000 * MS


def entries(log_times, lags, sources):
    """Return entries by log time, lag of the stamp [ms] and source; the value numbers them."""
    log_time = np.array(log_times, dtype=np.int64)
    return made(
        len(log_time),
        log_time=log_time,
        place=np.arange(len(log_time)),
        stamp=log_time - np.array(lags, dtype=np.int64) * MS,
        arrival=log_time,
        source=sources,
        value=np.arange(len(log_time), dtype=float),
    )


def one_by_one(found):
    """Return the values in the order in which they leave a heap."""
    waiting, order = [], []
    last = {}
    for at in range(len(found)):
        line, stamp = int(found.source[at]), int(found.stamp[at])
        if last.get(line, stamp) - stamp > BACKWARD_JUMP:
            order += [key[2] for key in sorted(waiting)]
            waiting.clear()
        last[line] = stamp
        key = (int(found.stamp[at]), int(found.source[at]), at)
        heapq.heappush(waiting, key)
        while found.log_time[at] - found.log_time[waiting[0][2]] > REORDER:
            order.append(heapq.heappop(waiting)[2])
    return [*order, *(key[2] for key in sorted(waiting))]


@given(
    steps=st.lists(
        st.tuples(
            st.sampled_from((0, 1, 10, 400, 1200)),
            st.sampled_from((0, 0, 0, 0, 1, 300, 990, 1500, 5000, -200)),
            st.integers(0, 3),
        ),
        min_size=1,
        max_size=60,
    ),
    cuts=st.lists(st.integers(0, 60), max_size=4),
)
def test_batches_come_in_the_order_of_a_heap(steps, cuts):
    wait, lags, sources = zip(*steps)
    found = entries(BEGIN + np.cumsum(wait) * MS, lags, sources)
    order, values = StampOrder(), []
    bounds = sorted({0, len(found), *(min(cut, len(found)) for cut in cuts)})
    for begin, end in zip(bounds, bounds[1:]):
        values += order.push(found.take(slice(begin, end))).value.tolist()
    values += order.finish().value.tolist()
    assert values == one_by_one(found)


def test_stamps_decades_apart_are_put_into_order_too():
    found = entries([BEGIN, BEGIN, BEGIN], [0, BEGIN // MS, 1], [0, 1, 0])
    order = StampOrder()
    parts = [order.push(found), order.finish()]
    assert joined(parts).value.tolist() == [1.0, 2.0, 0.0]


def test_arrivals_wait_until_nothing_earlier_can_come():
    found = entries([BEGIN + 3 * MS, BEGIN + MS, BEGIN + 2 * MS], [0, 0, 0], [0, 0, 0])
    arrivals = Arrivals(1000 * MS)
    first = arrivals.push(found, BEGIN + 3 * MS)
    assert first.value[first.kind != Kind.TICK].tolist() == [1.0, 2.0]
    assert arrivals.push(made(0), BEGIN + 4 * MS).value.tolist()[-1] == 0.0
