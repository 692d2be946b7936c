# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The entries of a whole bag, batch by batch: read, decoded, put into the order of judging."""

from collections.abc import Callable, Iterator

from ballscrew_monitor.recordings.bag import Bag
from ballscrew_monitor.recordings.bulk.batches import batches
from ballscrew_monitor.recordings.bulk.decode import Reader, TopicDecoder
from ballscrew_monitor.recordings.bulk.entries import Entries, joined
from ballscrew_monitor.recordings.bulk.order import ALL_AXES, Arrivals, StampOrder
from ballscrew_monitor.settings.axis import Axis
from ballscrew_monitor.settings.topics import absolute
import numpy as np
from numpy.typing import NDArray

LATEST = 2**62  # [ns] log times from here on have no place in the arrays
OnDone = Callable[[float], None]
"""Told which share of a bag is done [-]."""


def ordered_entries(
    bag: Bag, axes: list[Axis], period: int, *, on_done: OnDone
) -> Iterator[Entries]:
    """
    Yield the entries of `axes` in the order in which they are judged, a tick each `period` [ns].

    `on_done` is told how far the bag is judged [-]. Raises InputError for a damaged bag, unless
    its intact part is to be salvaged.

    """
    decoders = {topic: TopicDecoder(bag, readers) for topic, readers in _readers(axes).items()}
    arrivals, order = Arrivals(period), StampOrder()
    for batch in batches(bag, decoders.keys()):
        decoded = [decoders[topic].entries(found) for topic, found in batch.topics.items()]
        yield order.push(arrivals.push(joined(decoded), batch.until))
        on_done(batch.done)
    yield order.finish()


def _readers(axes: list[Axis]) -> dict[str, list[Reader]]:
    readers: dict[str, list[Reader]] = {}
    for number, axis in enumerate(axes):
        for source in axis.inputs:
            readers.setdefault(absolute(source.topic), []).append((number, axis, source))
    return readers


def places_of_axis(entries: Entries, number: int) -> NDArray[np.intp]:
    """Return the places of the entries of an axis, ticks among them."""
    return np.flatnonzero((entries.axis == number) | (entries.axis == ALL_AXES))
