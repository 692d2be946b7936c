# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Heartbeat of the node, and how busy it is.

The beat is asserted by hand: a middleware that asserts for the process would go on while the loop
of the node hangs. Deadline and lease are longer than a service waits for the disk.

"""

import time

from ballscrew_monitor.core.vitals import Vitals
from ballscrew_monitor.messages import diagnostics
from diagnostic_msgs.msg import DiagnosticStatus
from rclpy.clock import Clock
from rclpy.duration import Duration
from rclpy.event_handler import PublisherEventCallbacks
from rclpy.node import Node
from rclpy.qos import QoSLivelinessPolicy, QoSProfile
from std_msgs.msg import UInt64

BEAT = 1.0  # [s]
PROMISE = Duration(seconds=5.0)  # within which a beat comes
BEAT_QOS = QoSProfile(
    depth=1,
    deadline=PROMISE,
    liveliness=QoSLivelinessPolicy.MANUAL_BY_TOPIC,
    liveliness_lease_duration=PROMISE,
)


class Heartbeat:
    """Counts the beats of a node on `~/heartbeat`, in every lifecycle state."""

    def __init__(self, node: Node, *, clock: Clock) -> None:
        self.vitals = Vitals()
        self._node = node
        self._beat = UInt64()
        quiet = PublisherEventCallbacks(use_default_callbacks=False)
        self._publisher = node.create_publisher(
            UInt64, '~/heartbeat', BEAT_QOS, event_callbacks=quiet
        )
        node.create_timer(BEAT, self._publish, clock=clock)

    def statuses(self) -> list[DiagnosticStatus]:
        """Return the diagnostics of the node itself."""
        signs = self.vitals.look(time.monotonic(), time.process_time())
        return [diagnostics.of_node(self._node.get_fully_qualified_name(), signs)]

    def _publish(self) -> None:
        self._beat.data += 1
        self._publisher.publish(self._beat)
