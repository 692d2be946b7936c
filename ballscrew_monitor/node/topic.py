# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""A topic that is read: its subscription, what waits in it, and what was lost of it."""

from collections.abc import Mapping
import dataclasses
import functools
from typing import Any

from ballscrew_monitor.core.inputs import Input, InputSample, Refusal
from ballscrew_monitor.core.links import Link
from ballscrew_monitor.node.raw_field import RawField
from ballscrew_monitor.node.sources import InputName, LossCounter, NO_NUMBER, SourceCounter
from ballscrew_monitor.recordings.bulk.layout import NoLayout
from ballscrew_monitor.settings.axis import Axis
from ballscrew_monitor.settings.qos import input_qos, overriding_options, publishers_on
from rclpy.callback_groups import CallbackGroup
from rclpy.event_handler import SubscriptionEventCallbacks
from rclpy.node import Node
from rclpy.qos import QoSProfile
from rclpy.serialization import deserialize_message
from rclpy.subscription import Subscription

MOST = 400  # messages of one topic that are taken before anything else has a turn

Reader = tuple[Axis, Input]
Taken = tuple[Any, dict[str, Any]]
"""A message or its bytes, and what the middleware says of it."""
RECEIVED, NUMBER = 'received_timestamp', 'publication_sequence_number'

UNREAD = object()
"""A message that nobody has decoded yet."""


class Arrival:
    """
    A message, its arrival on the clock of this machine [ns], and the topic that it is of.

    `data` is the message as it came over the wire, of a topic that is taken so.

    """

    __slots__ = ('_message', 'data', 'number', 'received', 'topic')

    def __init__(
        self, received: int, message: Any, number: int, topic: 'Topic', data: bytes = b''
    ) -> None:
        self.received, self.number, self.topic, self.data = received, number, topic, data
        self._message = message

    @property
    def message(self) -> Any:
        """Return the message, None for one that does not decode."""
        if self._message is UNREAD:
            self._message = self.topic.decoded(self.data)
        return self._message

    def read(
        self, reader: int, *, now: int, max_future: int, lost: int | None
    ) -> InputSample | Refusal:
        """Return what the reader of this number in the topic takes; see `Input.read`."""
        source = self.topic.readers[reader][1]
        field = self.topic.field(reader) if self._message is UNREAD else None
        if field is not None and (numbers := field.find(self.data)):
            return source.sample(*numbers, now=now, max_future=max_future, lost=lost)
        return source.read(self.message, now=now, max_future=max_future, lost=lost)


@dataclasses.dataclass(kw_only=True, slots=True)
class Topic:
    """A subscription, who reads its messages, and what was lost of them."""

    name: str
    readers: list[Reader]
    loss: LossCounter
    subscription: Subscription
    sources: dict[InputName, SourceCounter] = dataclasses.field(default_factory=dict)
    fields: list[RawField | None] = dataclasses.field(default_factory=list)  # of the readers

    @property
    def type_name(self) -> str:
        """Return the type of its messages."""
        return self.readers[0][1].type_name

    def count(self, source: InputName, number: int, now: int) -> None:
        """Take the publication number of a sample of an input that arrived at `now` [ns]."""
        counter = self.sources.get(source)
        if counter is None:
            counter = self.sources[source] = SourceCounter()
        counter.take(number, self.loss.publishers, now)

    def field(self, reader: int) -> RawField | None:
        """Return what finds the number of a reader in bytes, None if nothing does."""
        known = len(self.fields)
        for _, source in self.readers[known:]:
            try:
                self.fields.append(RawField(source))
            except NoLayout:
                self.fields.append(None)
        return self.fields[reader]

    def arrival(self, taken: Any, info: Mapping[str, Any]) -> Arrival:
        """Return what was taken with what the middleware says of it."""
        received, number = info[RECEIVED], info[NUMBER] or NO_NUMBER
        if self.subscription.raw:
            return Arrival(received, UNREAD, number, self, taken)
        return Arrival(received, taken, number, self)

    def decoded(self, data: bytes) -> Any:
        """Return the message of some bytes, None if they are of another definition of its type."""
        try:
            return deserialize_message(data, self.subscription.msg_type)
        except Exception:  # whatever the middleware says of it
            return None

    def waiting(self) -> list[Arrival]:
        """Return what waits in the queue of the subscription, which is then empty."""
        return [self.arrival(*taken) for taken in self.taken()]

    def taken(self) -> list[Taken]:
        """
        Return the same as the middleware gives it.

        When the publishers have changed it may be of those before and of those now, whose numbers
        do not go together.

        """
        messages: list[Taken] = []
        subscription, handle = self.subscription, self.subscription.handle
        with handle:
            take, kind, raw = handle.take_message, subscription.msg_type, subscription.raw
            while len(messages) < MOST and (taken := take(kind, raw)) is not None:
                messages.append(taken)
        if messages:  # the event that tells of it may not have had its turn
            count = subscription.get_publisher_count()
            if count != self.loss.publishers:
                self.loss.match(count)
                for _, info in messages:
                    info[NUMBER] = NO_NUMBER
        return messages


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

    The QoS is that of an input unless stated. Messages that are taken `raw` are bytes until
    somebody decodes them.

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
