# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Heartbeat of the node, how busy it is, and whether another node has its name.

The beat is asserted by hand: a middleware that asserts for the process would go on while the loop
of the node hangs. Deadline and lease are longer than a service waits for the disk.

"""

import math
import os
import socket
import time
import uuid

from ballscrew_monitor.core.conversions import SECOND
from ballscrew_monitor.core.vitals import Vitals
from ballscrew_monitor.messages import diagnostics
from diagnostic_msgs.msg import DiagnosticStatus, KeyValue
from rclpy.clock import Clock
from rclpy.duration import Duration
from rclpy.event_handler import PublisherEventCallbacks
from rclpy.node import Node
from rclpy.qos import QoSLivelinessPolicy, QoSProfile
from std_msgs.msg import UInt64
from surrogate.files import printable

BEAT = 1.0  # [s]
STEP_SHOWN = 10.0  # [s]
PROMISE = Duration(seconds=5.0)  # within which a beat comes
BEAT_QOS = QoSProfile(
    depth=1,
    deadline=PROMISE,
    liveliness=QoSLivelinessPolicy.MANUAL_BY_TOPIC,
    liveliness_lease_duration=PROMISE,
)
INSTANCE_QOS = QoSProfile(depth=10)
FORGOTTEN = 5.0  # [s] without a word of another node after which it is gone
LONGEST_HOST = 100  # characters
MOST_OTHERS = 10  # that are remembered
MADE = 1_767_225_600 * SECOND  # [ns] begin of 2026: no clock that was set shows an earlier time


def clock_is_set(node: Node) -> bool:
    """Return False where a node reads a clock of the machine that nobody has set."""
    return node.get_parameter('use_sim_time').value or time.time_ns() >= MADE


def own_instance() -> KeyValue:
    """Return what tells this node from every other one: a number by chance, and its host."""
    host = f'{socket.gethostname()} (process {os.getpid()})'
    return KeyValue(key=uuid.uuid4().hex, value=host)


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
        self._instance = own_instance()
        self._others: dict[str, tuple[str, float]] = {}  # by key: host, and when it was heard [s]
        self._instances = node.create_publisher(KeyValue, '~/instance', INSTANCE_QOS)
        node.create_subscription(KeyValue, '~/instance', self._hear, INSTANCE_QOS)
        node.create_timer(BEAT, self._publish, clock=clock)

    @property
    def others(self) -> list[str]:
        """Return the hosts of other nodes of this name that are there now."""
        last = time.monotonic() - FORGOTTEN
        self._others = {key: other for key, other in self._others.items() if other[1] > last}
        return sorted(host for host, _ in self._others.values())

    def _hear(self, instance: KeyValue) -> None:
        """Take that a node of this name, or this one, is there."""
        if instance.key == self._instance.key:
            return
        host, known = printable(instance.value)[:LONGEST_HOST], len(self.others)
        if instance.key not in self._others:
            if known >= MOST_OTHERS:
                return
            self._node.get_logger().error(diagnostics.TWO_NODES.format(host))
        self._others[instance.key] = host, time.monotonic()

    def statuses(self) -> list[DiagnosticStatus]:
        """Return the diagnostics of the node itself."""
        now = time.monotonic()
        signs = self.vitals.look(now, time.process_time())
        step = self._step if now - self._step_at < STEP_SHOWN else 0
        name = self._node.get_fully_qualified_name()
        hosts = [self._instance.value, *self.others]
        is_set = clock_is_set(self._node)
        return [diagnostics.of_node(name, signs, step, hosts, is_clock_set=is_set)]

    def set_clock(self, step: int) -> None:
        """Let the diagnostics say for a while that the clock was set by a `step` [ns]."""
        self._step, self._step_at = step, time.monotonic()

    def _publish(self) -> None:
        self._beat.data += 1
        self._publisher.publish(self._beat)
        self._instances.publish(self._instance)
