# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Records topics over DDS to a bag: serialised messages as they arrive.

The log time is that of a clock which is handed in, the one of the player: so the inputs and what
the monitor made of them lie on one time line, however fast it is played.

"""

from collections.abc import Callable, Mapping, Sequence
import functools
from typing import Any

from ballscrew_monitor.core.fields import message_class
from ballscrew_monitor.recordings.bag_writer import BagWriter, Offer, Topic
from ballscrew_monitor.settings.parameters import input_topics, output
from rclpy.node import Node
from rclpy.qos import QoSDurabilityPolicy, QoSHistoryPolicy, QoSProfile, QoSReliabilityPolicy

DEPTH = 2000  # messages that may wait for the recorder
DIAGNOSTICS = Topic(
    name='/diagnostics', type_name='diagnostic_msgs/msg/DiagnosticArray', offer=Offer.RELIABLE
)
LATCHED = {'health': 'AxisHealth', 'out_of_zone': 'OutOfZone', 'surface_info': 'SurfaceInfo'}


def recorded_topics(values: Mapping[str, Any]) -> list[Topic]:
    """Return what a run records: inputs, outputs, and the latched outputs last."""
    inputs = [
        Topic(name=name, type_name=kind, offer=Offer.SENSOR)
        for name, kind in input_topics(values).items()
    ]
    states = [_topic(axis, 'state', 'BallScrewState', Offer.RELIABLE) for axis in values['axes']]
    latched = [
        _topic(axis, name, kind, Offer.LATCHED)
        for name, kind in LATCHED.items()
        for axis in values['axes']
    ]
    return [*inputs, *states, DIAGNOSTICS, *latched]


def _topic(axis: str, name: str, kind: str, offer: Offer) -> Topic:
    return Topic(name=output(axis, name), type_name=f'ballscrew_msgs/msg/{kind}', offer=offer)


class Recorder:
    """Subscribes on a node, which somebody else spins, and writes what arrives."""

    def __init__(
        self,
        node: Node,
        writer: BagWriter,
        topics: Sequence[Topic],
        clock: Callable[[], int],
        listeners: Mapping[str, Callable[[bytes], None]] | None = None,
    ) -> None:
        """
        Subscribe to `topics`.

        `clock` tells the log time [ns]; the listener of a topic gets each message of it after it
        has been written.

        """
        self._node, self._writer, self._clock = node, writer, clock
        listeners = listeners or {}
        self._subscriptions: list[Any] = []
        for topic in topics:
            writer.add_topic(topic)
            reliability, durability, _ = topic.offer.value
            all_that_is_offered = QoSProfile(
                history=QoSHistoryPolicy.KEEP_LAST,
                depth=DEPTH,
                reliability=getattr(QoSReliabilityPolicy, reliability.upper()),
                durability=getattr(QoSDurabilityPolicy, durability.upper()),
            )
            subscription = node.create_subscription(
                message_class(topic.type_name),
                topic.name,
                functools.partial(self._on_message, topic.name, listeners.get(topic.name)),
                all_that_is_offered,
                raw=True,
            )
            self._subscriptions.append(subscription)

    def close(self) -> None:
        """Stop to record; the bag is left to its owner."""
        for subscription in self._subscriptions:
            self._node.destroy_subscription(subscription)
        self._subscriptions = []

    def _on_message(
        self, topic: str, listener: Callable[[bytes], None] | None, data: bytes
    ) -> None:
        now = self._clock()
        self._writer.write(topic, data, log_time=now, publish_time=now)
        if listener is not None:
            listener(data)
