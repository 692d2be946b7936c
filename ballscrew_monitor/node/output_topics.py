# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Publishers of an axis beside its state: plain numbers, and topics whose last message stays."""

from collections.abc import Callable
import functools
from typing import Any

from ballscrew_monitor.core.state import State
from ballscrew_monitor.messages.state_messages import plain_values
from ballscrew_msgs.msg import OutOfZone, SurfaceInfo
from rclpy.event_handler import PublisherEventCallbacks
from rclpy.lifecycle import LifecycleNode
from rclpy.qos import QoSDurabilityPolicy, QoSProfile, QoSReliabilityPolicy
from std_msgs.msg import Bool, Float64, String

TYPES = {
    'efficiency': Float64,
    'rcs': Float64,
    'film_ratio': Float64,
    'regime': String,
    'out_of_zone': Bool,
}
LATCHED_QOS = QoSProfile(
    depth=1,
    reliability=QoSReliabilityPolicy.RELIABLE,
    durability=QoSDurabilityPolicy.TRANSIENT_LOCAL,
)


def quiet_publishers(node: LifecycleNode) -> functools.partial[Any]:
    """
    Return what makes publishers without events.

    rclpy looks at every event of every publisher in every round. What these would warn of, a
    subscriber with QoS that does not fit, its own node warns of too.

    """
    quiet = PublisherEventCallbacks(use_default_callbacks=False)
    return functools.partial(node.create_lifecycle_publisher, event_callbacks=quiet)


class LatchedTopics:
    """Publishers that live as long as the node, so that the end of an event outlives its axis."""

    def __init__(self, node: LifecycleNode, axis: str) -> None:
        """Make them; they stay silent until the node is active."""
        make = quiet_publishers(node)
        self.event = make(OutOfZone, f'~/{axis}/out_of_zone', LATCHED_QOS)
        self.info = make(SurfaceInfo, f'~/{axis}/surface_info', LATCHED_QOS)


class PlainTopics:
    """The plain topics of one axis, none unless they are `wanted`."""

    def __init__(
        self, node: LifecycleNode, axis: str, make: Callable[..., Any], qos: Any, *, wanted: bool
    ) -> None:
        """Make the publishers by `make`, which is given type, name and `qos`."""
        self._node = node
        kinds = TYPES if wanted else {}
        self._publishers = {
            name: make(kind, f'~/{axis}/plain/{name}', qos) for name, kind in kinds.items()
        }

    def publish(self, state: State) -> None:
        """Publish a state."""
        for name, value in plain_values(state).items() if self._publishers else ():
            self._publishers[name].publish(TYPES[name](data=value))

    def close(self) -> None:
        """Destroy the publishers."""
        for publisher in self._publishers.values():
            self._node.destroy_lifecycle_publisher(publisher)
