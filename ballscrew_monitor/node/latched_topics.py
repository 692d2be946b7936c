# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The topics of an axis whose last word stays: who joins late still hears it."""

import functools
from typing import Any

from ballscrew_msgs.msg import OutOfZone, SurfaceInfo
from rclpy.event_handler import PublisherEventCallbacks
from rclpy.lifecycle import LifecycleNode
from rclpy.qos import QoSDurabilityPolicy, QoSProfile, QoSReliabilityPolicy

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
