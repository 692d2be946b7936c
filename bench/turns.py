# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Cost of the turns of a node in its own thread, beside a bare loop that takes the same as bytes.

Run `python bench/turns.py AXES MESSAGES TURNS`: each turn has so many messages of
each topic, which this process publishes itself, 1 ms apart by their stamps, and is judged
compiled. Prints processor time of the thread for a message, medians of turns. Other work on the
machine makes both dearer: look at their ratio.

"""

import os
from pathlib import Path
import statistics
import sys
import tempfile
import threading
import time
from typing import Any

from ballscrew_monitor.cycle.domain import free_domain
from ballscrew_monitor.cycle.node_process import ros_environment
from ballscrew_monitor.node import compiled_turns
from ballscrew_monitor.node.intake import Intake
from ballscrew_monitor.node.node import BallscrewMonitor
from geometry_msgs.msg import WrenchStamped
from node import write_parameters
from node_parts.peer import axis_names, FAST, LOAD, topic
import rclpy
from rclpy.executors import SingleThreadedExecutor
from rclpy.serialization import serialize_message
from sensor_msgs.msg import JointState

STEP = 1_000_000  # [ns]
DELIVERY = 0.02  # [s] which the middleware has to hand over what was published
FIRST = 5  # turns that do not count


class Always:
    """Turns that are always judged compiled."""

    are_due, at_rest = True, threading.Event()

    def count(self, events: int, now: float) -> None:
        """Take no note of it."""


class Machine:
    """Publishers of speed and load of all axes, and the stamps of their messages."""

    def __init__(self, axes: int) -> None:
        node = rclpy.create_node('machine')
        self._speeds = [
            (name, node.create_publisher(JointState, topic('node', name, 'speed'), 1000))
            for name in axis_names(axes)
        ]
        self._loads = [
            node.create_publisher(WrenchStamped, topic('node', name, 'load'), 1000)
            for name in axis_names(axes)
        ]
        self._now = time.time_ns()

    def publish(self, count: int) -> None:
        """Publish so many messages to each topic."""
        for _ in range(count):
            self._now += STEP
            load = self._stamped(WrenchStamped())
            load.wrench.force.x = LOAD
            for (name, speeds), loads in zip(self._speeds, self._loads):
                loads.publish(serialize_message(load))
                speed = self._stamped(JointState(name=[name], velocity=[FAST]))
                speeds.publish(serialize_message(speed))
        time.sleep(DELIVERY)

    def _stamped(self, message: Any) -> Any:
        message.header.stamp.sec, message.header.stamp.nanosec = divmod(self._now, 10**9)
        return message


def take(intake: Intake) -> int:
    """Take all that waits, as bytes; return how much that was."""
    count = 0
    for one in intake.topics.values():
        handle, kind = one.subscription.handle, one.subscription.msg_type
        while handle.take_message(kind, True) is not None:
            count += 1
    return count


def cost(call: Any, *arguments: Any) -> float:
    """Return the processor time of this thread in a call [us]."""
    begin = time.thread_time_ns()
    call(*arguments)
    return 1e-3 * (time.thread_time_ns() - begin)


def measure(node: BallscrewMonitor, machine: Machine, messages: int, turns: int) -> str:
    """Return what a message costs in turns of so many of each topic."""
    intake, bare, whole = node._intake, list[float](), list[float]()
    assert intake is not None
    total = messages * len(intake.topics)
    for _ in range(turns + FIRST):
        machine.publish(messages)
        bare.append(cost(take, intake) / total)
        for one in intake.topics.values():
            one.loss.match(one.loss.publishers)
        machine.publish(messages)
        whole.append(cost(intake.drain) / total)
    taken, judged = (statistics.median(costs[FIRST:]) for costs in (bare, whole))
    return (
        f'{total} messages a turn: taken as bytes {taken:.2f} us, judged {judged:.2f} us each, '
        f'{judged / taken:.1f} times'
    )


def main() -> None:
    """Measure a node in this process."""
    axes, messages, turns = map(int, sys.argv[1:4])
    os.environ.pop('ROS_PYTHON_CHECK_FIELDS', None)  # as a user has it
    with free_domain() as domain, tempfile.TemporaryDirectory() as folder:
        os.environ.update(ros_environment(domain))
        path = Path(folder, 'parameters.yaml')
        write_parameters(path, axes, 0.1, 'never')
        rclpy.init(args=['--ros-args', '--log-level', 'error', '--params-file', str(path)])
        node = BallscrewMonitor()
        compiled_turns.load({})
        always: Any = Always()
        node._compiled = always
        node.start()
        executor = SingleThreadedExecutor()
        executor.add_node(node)
        machine = Machine(axes)
        end = time.monotonic() + 3.0
        while time.monotonic() < end:
            executor.spin_once(timeout_sec=0.05)
        print(measure(node, machine, messages, turns))
        node.finish()
        rclpy.shutdown()


if __name__ == '__main__':
    main()
