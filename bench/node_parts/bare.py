# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
A bare rclpy node of the same subscriptions; it sends a state where the monitor would.

Run `python bench/node_parts/bare.py AXES PERIOD`.

"""

import contextlib
import sys

from ballscrew_msgs.msg import BallScrewState, InputHealth
from geometry_msgs.msg import WrenchStamped
from peer import axis_names, FAST, INPUTS, topic
import rclpy
from rclpy.executors import ExternalShutdownException, SingleThreadedExecutor
from rclpy.node import Node
from sensor_msgs.msg import JointState


class BareAxis:
    """An axis that counts its inputs, and sends a state where the node would."""

    def __init__(self, node: Node, axis: str, period: float) -> None:
        """Subscribe; `period` [s] is that of the node."""
        self._period = period
        self._state = BallScrewState(axis=axis, inputs=[InputHealth(name=name) for name in INPUTS])
        self._publisher = node.create_publisher(BallScrewState, topic('bare', axis, 'state'), 10)
        make = node.create_subscription
        make(JointState, topic('bare', axis, 'speed'), self._on_speed, 200)
        make(WrenchStamped, topic('bare', axis, 'load'), self._on_load, 200)
        node.create_timer(0.1, self._on_tick)

    def _on_load(self, message: WrenchStamped) -> None:
        self._state.inputs[1].received += 1

    def _on_speed(self, message: JointState) -> None:
        state, level = self._state, 1 if message.velocity[0] == FAST else 2
        state.inputs[0].received += 1
        if self._period == 0.0 or level != state.level:
            state.level, state.header.stamp = level, message.header.stamp
            state.result.validity = state.result.VALIDITY_VALID
            self._publisher.publish(state)

    def _on_tick(self) -> None:
        self._state.result.validity = self._state.result.VALIDITY_NO_INPUT
        self._publisher.publish(self._state)


def run_bare(axes: int, period: float) -> None:
    """Be the bare node until SIGINT."""
    rclpy.init()
    node = rclpy.create_node('bare')
    kept = [BareAxis(node, axis, period) for axis in axis_names(axes)]
    executor = SingleThreadedExecutor()
    executor.add_node(node)
    with contextlib.suppress(ExternalShutdownException, KeyboardInterrupt):
        executor.spin()
    del kept


if __name__ == '__main__':
    run_bare(int(sys.argv[1]), float(sys.argv[2]))
