# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The messages of a turn by columns, in the order of arrival."""

from collections.abc import Iterable, Sequence
from typing import NamedTuple

from ballscrew_monitor.judge.records import NOT_KNOWN
from ballscrew_monitor.node.event_recorder import Heard
from ballscrew_monitor.node.sources import NO_NUMBER
from ballscrew_monitor.node.topic import Arrival, NUMBER, RECEIVED, Taken, Topic, UNREAD
import numpy as np
from numpy.typing import NDArray


class Burst(NamedTuple):
    """
    Messages with the numbers of their topics, and their places in the lists of what they are.

    `now` is the arrival of each [ns] on the clock of the node; `lost` messages were lost before.

    """

    topics: Sequence[Topic]
    topic: NDArray[np.intp]
    place: NDArray[np.intp]
    now: NDArray[np.int64]
    lost: NDArray[np.int64]
    data: Sequence[bytes]
    received: Sequence[int]
    numbers: Sequence[int]

    @classmethod
    def of(cls, heard: Sequence[Heard], topics: Iterable[Topic] = ()) -> 'Burst':
        """Return messages heard one by one; `topics` come first, in order, also without any."""
        arrivals = [arrival for arrival, _, _ in heard]
        named = (*topics, *(arrival.topic for arrival in arrivals))
        known = {topic.name: topic for topic in named}
        places = {name: place for place, name in enumerate(known)}
        return cls(
            topics=[*known.values()],
            topic=np.array([places[arrival.topic.name] for arrival in arrivals], np.intp),
            place=np.arange(len(heard)),
            now=np.array([now for _, now, _ in heard], np.int64),
            lost=_losses([lost for _, _, lost in heard]),
            data=[arrival.data for arrival in arrivals],
            received=[arrival.received for arrival in arrivals],
            numbers=[arrival.number for arrival in arrivals],
        )

    @classmethod
    def taken(cls, taken: Sequence[tuple[Topic, list[Taken]]], now: int, wall: int) -> 'Burst':
        """Return what was taken at `now` [ns] of the node's clock, `wall` of the system's."""
        counts = [len(messages) for _, messages in taken]
        infos = [info for _, messages in taken for _, info in messages]
        received = [info[RECEIVED] for info in infos]
        numbers = [info[NUMBER] or NO_NUMBER for info in infos]
        losses: list[int | None] = []
        for (topic, _), count in zip(taken, counts):
            begin, end = len(losses), len(losses) + count
            losses += topic.loss.take_many(numbers[begin:end])
        arrived = np.array(received, np.int64)
        waited = np.where(arrived == 0, 0, np.maximum(wall - arrived, 0))
        order = np.argsort(arrived, kind='stable')
        return cls(
            topics=[topic for topic, _ in taken],
            topic=np.repeat(np.arange(len(taken)), counts)[order],
            place=order,
            now=np.maximum(now - waited, 0)[order],
            lost=_losses(losses)[order],
            data=[data for _, messages in taken for data, _ in messages],
            received=received,
            numbers=numbers,
        )

    def heard(self, at: int) -> Heard:
        """Return a message by itself."""
        place, lost = self.place[at], int(self.lost[at])
        arrival = Arrival(
            *(self.received[place], UNREAD, self.numbers[place]),
            *(self.topics[self.topic[at]], self.data[place]),
        )
        return arrival, int(self.now[at]), None if lost == NOT_KNOWN else lost


def _losses(lost: Sequence[int | None]) -> NDArray[np.int64]:
    return np.array([NOT_KNOWN if count is None else count for count in lost], np.int64)
