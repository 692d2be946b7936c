# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Heartbeat of the node, and how busy it is.

The beat is asserted by hand: a middleware that asserts for the process would go on while the loop
of the node hangs. Deadline and lease are longer than a service waits for the disk.

"""

import math
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
STEP_SHOWN = 10.0  # [s]
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
        self._step, self._step_at = 0, -math.inf  # of the clock [ns], and when [s]
        quiet = PublisherEventCallbacks(use_default_callbacks=False)
        self._publisher = node.create_publisher(
            UInt64, '~/heartbeat', BEAT_QOS, event_callbacks=quiet
        )
        node.create_timer(BEAT, self._publish, clock=clock)

    def statuses(self) -> list[DiagnosticStatus]:
        """Return the diagnostics of the node itself."""
        now = time.monotonic()
        signs = self.vitals.look(now, time.process_time())
        step = self._step if now - self._step_at < STEP_SHOWN else 0
        return [diagnostics.of_node(self._node.get_fully_qualified_name(), signs, step)]

    def set_clock(self, step: int) -> None:
        """Let the diagnostics say for a while that the clock was set by a `step` [ns]."""
        self._step, self._step_at = step, time.monotonic()

    def _publish(self) -> None:
        self._beat.data += 1
        self._publisher.publish(self._beat)
