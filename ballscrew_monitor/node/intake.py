# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Takes what the inputs have received: all that waits, whatever woke the node, oldest first.

An executor costs more for each message than its judgement does, and hands the messages of several
topics over in an order of its own. So the first message of a burst brings along all the others,
and the clock is asked once for all of them. Simulated time is read in the same order: a message
arrived at the last `/clock` before it, whatever of both the executor has handed over by now.

"""

from collections.abc import Callable, Iterable, Mapping, Sequence
import dataclasses
import functools
import operator
import time
from typing import Any

from ballscrew_monitor.core.conversions import SECOND
from ballscrew_monitor.core.inputs import Input, InputSample, Refusal, Source
from ballscrew_monitor.core.loss import LossCounter
from ballscrew_monitor.node.axis import Axis
from rclpy.event_handler import SubscriptionEventCallbacks
from rclpy.node import Node
from rclpy.qos import QoSDurabilityPolicy, QoSHistoryPolicy, QoSProfile, QoSReliabilityPolicy
from rclpy.subscription import Subscription
from rosgraph_msgs.msg import Clock

INPUT_QOS = QoSProfile(
    history=QoSHistoryPolicy.KEEP_LAST,
    depth=200,
    reliability=QoSReliabilityPolicy.BEST_EFFORT,
    durability=QoSDurabilityPolicy.VOLATILE,
)
CLOCK = '/clock'
MOST = 2 * INPUT_QOS.depth  # messages of one topic that are taken before anything else has a turn

Reader = tuple[Axis, Input]
AxisEvent = tuple[Axis, InputSample | Refusal]
Take = Callable[[Axis, InputSample | Refusal], None]


@dataclasses.dataclass(frozen=True, slots=True)
class Arrival:
    """A message, its arrival on the clock of this machine [ns], and the topic that it is of."""

    received: int
    message: Any
    number: int
    topic: 'Topic'


@dataclasses.dataclass(kw_only=True, slots=True)
class Topic:
    """A subscription, who reads its messages, and what was lost of them."""

    readers: Sequence[Reader]
    loss: LossCounter
    subscription: Subscription | None = None  # until it is made with a callback of this

    def match(self, event: Any) -> None:
        """Note how many publishers the topic has now."""
        self.loss.match(event.current_count)

    def arrival(self, message: Any, info: Mapping[str, Any]) -> Arrival:
        """Return a message with what the middleware says of it."""
        return Arrival(
            info['received_timestamp'], message, info['publication_sequence_number'] or 0, self
        )

    def waiting(self) -> list[Arrival]:
        """Return what waits in the queue of the subscription, which is then empty."""
        found: list[Arrival] = []
        subscription = self.subscription
        if subscription is None:
            return found
        with subscription.handle:
            while len(found) < MOST:
                taken = subscription.handle.take_message(subscription.msg_type, subscription.raw)
                if taken is None:
                    break
                found.append(self.arrival(*taken))
        return found


class Intake:
    """The subscriptions of all axes; each sample and refusal is handed to `take`."""

    def __init__(self, node: Node, axes: Iterable[Axis], take: Take) -> None:
        """Subscribe once to each topic, however many inputs read it."""
        self._node = node
        self._take = take
        self._simulated = 0  # the last `/clock` [ns]
        readers: dict[str, list[Reader]] = {}
        for axis in axes:
            for source in axis.inputs:
                readers.setdefault(node.resolve_topic_name(source.topic), []).append(
                    (axis, source)
                )
        self.topics = {name: self._subscribe(name, those) for name, those in readers.items()}
        self._clock: Topic | None = None
        if node.get_parameter('use_sim_time').value:
            self._clock = self._subscribe_to(CLOCK, Clock, [])

    @property
    def _all(self) -> list[Topic]:
        clock = [] if self._clock is None else [self._clock]
        return [*clock, *self.topics.values()]

    def _subscribe(self, name: str, readers: list[Reader]) -> Topic:
        return self._subscribe_to(name, readers[0][1].message_type, readers)

    def _subscribe_to(self, name: str, kind: Any, readers: list[Reader]) -> Topic:
        topic = Topic(readers=readers, loss=LossCounter())
        topic.subscription = self._node.create_subscription(
            kind,
            name,
            functools.partial(self._on_message, topic),
            INPUT_QOS,
            event_callbacks=SubscriptionEventCallbacks(matched=topic.match),
        )
        return topic

    def close(self) -> None:
        """Unsubscribe."""
        for topic in self._all:
            if topic.subscription is not None:
                self._node.destroy_subscription(topic.subscription)
        self.topics, self._clock = {}, None

    def publishers(self, axis: str) -> dict[Source, int]:
        """Return how many publishers each input of an axis is matched with."""
        return {
            source.source: topic.subscription.get_publisher_count()
            for topic in self.topics.values()
            for reader, source in topic.readers
            if reader.name == axis and topic.subscription is not None
        }

    def drain(self) -> None:
        """Take what waits."""
        self._read([])

    def _on_message(self, topic: Topic, message: Any, info: Mapping[str, Any]) -> None:
        self._read([topic.arrival(message, info)])

    def _read(self, first: list[Arrival]) -> None:
        """Hand over the first arrivals and all others that wait, oldest first."""
        arrivals = first + [one for topic in self._all for one in topic.waiting()]
        arrivals.sort(key=operator.attrgetter('received'))
        now, wall = self._node.get_clock().now().nanoseconds, time.time_ns()
        events: list[AxisEvent] = []
        for arrival in arrivals:
            if arrival.topic is self._clock:
                shown = arrival.message.clock
                self._simulated = shown.sec * SECOND + shown.nanosec
                continue
            waited = max(wall - arrival.received, 0) if arrival.received else 0
            events += _events(arrival, self._simulated or max(now - waited, 0))
        for axis, event in ordered(events):
            self._take(axis, event)


def _events(arrival: Arrival, now: int) -> list[AxisEvent]:
    """Return what a message that arrived at `now` [ns] of the node's clock says of each axis."""
    lost = arrival.topic.loss.take(arrival.number)
    return [
        (axis, source.read(arrival.message, now=now, max_future=axis.max_future, lost=lost))
        for axis, source in arrival.topic.readers
    ]


def ordered(events: Sequence[AxisEvent]) -> list[AxisEvent]:
    """
    Return events in the order in which they came, but those of equal stamps by their sources.

    The speed is the last of them, so that it is judged with what was measured with it.

    """
    first: dict[int, int] = {}
    keys = []
    for place, (_, event) in enumerate(events):
        stamp = event.arrival if isinstance(event, Refusal) else event.stamp
        keys.append((first.setdefault(stamp, place), event.source, place))
    return [events[place] for _, _, place in sorted(keys)]
