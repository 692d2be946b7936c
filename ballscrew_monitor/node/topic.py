# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""A topic that is read: its subscription, what waits in it, and what was lost of it."""

from collections.abc import Mapping
import dataclasses
import functools
from typing import Any

from ballscrew_monitor.core.inputs import Input
from ballscrew_monitor.core.links import Link
from ballscrew_monitor.node.sources import InputName, LossCounter, NO_NUMBER, SourceCounter
from ballscrew_monitor.settings.axis import Axis
from ballscrew_monitor.settings.qos import DEPTH, input_qos, overriding_options, publishers_on
from rclpy.callback_groups import CallbackGroup
from rclpy.event_handler import SubscriptionEventCallbacks
from rclpy.node import Node
from rclpy.qos import QoSProfile
from rclpy.serialization import deserialize_message
from rclpy.subscription import Subscription

MOST = 2 * DEPTH  # messages of one topic that are taken before anything else has a turn

Reader = tuple[Axis, Input]


@dataclasses.dataclass(frozen=True, slots=True)
class Arrival:
    """
    A message, its arrival on the clock of this machine [ns], and the topic that it is of.

    `data` is the message as it came over the wire, of a topic that is taken so; one that does not
    decode is None.

    """

    received: int
    message: Any
    number: int
    topic: 'Topic'
    data: bytes = b''


@dataclasses.dataclass(kw_only=True, slots=True)
class Topic:
    """A subscription, who reads its messages, and what was lost of them."""

    name: str
    readers: list[Reader]
    loss: LossCounter
    subscription: Subscription
    sources: dict[InputName, SourceCounter] = dataclasses.field(default_factory=dict)

    @property
    def type_name(self) -> str:
        """Return the type of its messages."""
        return self.readers[0][1].type_name

    def count(self, one: InputName, number: int, now: int) -> None:
        """Take the publication number of a sample of an input that arrived at `now` [ns]."""
        self.sources.setdefault(one, SourceCounter()).take(number, self.loss.publishers, now)

    def arrival(self, taken: Any, info: Mapping[str, Any]) -> Arrival:
        """Return what was taken with what the middleware says of it."""
        data = taken if self.subscription.raw else b''
        message = self._decoded(data) if self.subscription.raw else taken
        number = info['publication_sequence_number'] or NO_NUMBER
        return Arrival(info['received_timestamp'], message, number, self, data)

    def _decoded(self, data: bytes) -> Any:
        """Return the message of some bytes, None if they are of another definition of its type."""
        try:
            return deserialize_message(data, self.subscription.msg_type)
        except Exception:  # whatever the middleware says of it
            return None

    def waiting(self) -> list[Arrival]:
        """
        Return what waits in the queue of the subscription, which is then empty.

        When the publishers have changed it may be of those before and of those now, whose numbers
        do not go together.

        """
        arrivals: list[Arrival] = []
        subscription = self.subscription
        with subscription.handle:
            while len(arrivals) < MOST:
                taken = subscription.handle.take_message(subscription.msg_type, subscription.raw)
                if taken is None:
                    break
                arrivals.append(self.arrival(*taken))
        if arrivals:  # the event that tells of it may not have had its turn
            count = subscription.get_publisher_count()
            if count != self.loss.publishers:
                self.loss.match(count)
                return [dataclasses.replace(arrival, number=NO_NUMBER) for arrival in arrivals]
        return arrivals


class Apart(CallbackGroup):
    """Keeps the executor from waiting for its members one by one."""

    def can_execute(self, entity: Any) -> bool:
        """Return False: what happens to a member is seen by the intake."""
        return False


def open_topic(
    node: Node,
    name: str,
    kind: Any,
    group: CallbackGroup,
    *,
    overridable: bool = False,
    raw: bool = False,
    qos: QoSProfile | None = None,
) -> Topic:
    """
    Subscribe to messages of a `kind`; where `overridable`, parameters may change the QoS.

    The QoS is that of an input unless stated. Messages that are taken `raw` keep the bytes that
    they came as, for a recording.

    """
    loss = LossCounter()
    subscription = node.create_subscription(
        kind,
        name,
        lambda message: None,  # never called: the intake takes the messages itself
        qos or input_qos(),
        callback_group=group,
        # Only some middlewares would name one of another type: the graph does.
        event_callbacks=SubscriptionEventCallbacks(
            matched=functools.partial(_count, loss), use_default_callbacks=False
        ),
        qos_overriding_options=overriding_options() if overridable else None,
        raw=raw,
    )
    return Topic(name=name, readers=[], loss=loss, subscription=subscription)


def link_of(
    node: Node, name: str, topic: Topic | None, *, several: bool | None = False, problem: str = ''
) -> Link:
    """
    Return how the topic of a full name is connected; None: its type is not known yet.

    `several` tells whether several publishers send the input.

    """
    if topic is None:
        publishers = publishers_on(node, name)
        return Link(topic=name, type_name='', publishers=publishers, problem=problem)
    matched = topic.subscription.get_publisher_count()
    qos = topic.subscription.qos_profile
    return Link(
        topic=name,
        type_name=topic.type_name,
        matched=matched,
        publishers=() if matched and not several else publishers_on(node, name),
        reliability=qos.reliability.name.lower(),
        durability=qos.durability.name.lower(),
        several=several,
    )


def _count(loss: LossCounter, event: Any) -> None:
    """
    Note how many publishers a topic has now.

    That the first one of all has come may be told after its first messages: its count goes on.

    """
    if event.total_count > 1 or event.current_count != loss.publishers:
        loss.match(event.current_count)
