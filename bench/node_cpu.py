# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Measure the processor time of the node, with speed and load at a rate each.

Usage: python bench/node_cpu.py [RATE [SECONDS]], 100 Hz and 20 s unless told. Prints the share of
one core, the time per judged sample, and the time from the publication of a speed to the
reception of its state.

"""

import os
import subprocess
import sys
import time

from ballscrew_monitor.core.conversions import SECOND
from ballscrew_monitor.cycle.domain import free_domain
from ballscrew_monitor.cycle.node_process import child_environment, ros_environment
from ballscrew_msgs.msg import BallScrewState
from geometry_msgs.msg import WrenchStamped
import rclpy
from rclpy.executors import SingleThreadedExecutor
from sensor_msgs.msg import JointState

WARM_UP = 2.0  # [s] before the measurement begins
DRAIN = 1.0  # [s] for the last states to arrive


def processor_time(pid: int) -> float:
    """Return user and system time of a process [s]."""
    with open(f'/proc/{pid}/stat') as file:
        fields = file.read().rpartition(')')[2].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf('SC_CLK_TCK')


class Machine:
    """Publishes speed and load, and takes the time until the state comes back."""

    def __init__(self, context: rclpy.Context) -> None:
        """Make the publishers and the subscription."""
        self.node = rclpy.create_node('machine', context=context)
        self.executor = SingleThreadedExecutor(context=context)
        self.executor.add_node(self.node)
        self.speeds = self.node.create_publisher(JointState, 'joint_states', 10)
        self.loads = self.node.create_publisher(WrenchStamped, 'axial_load', 10)
        self.node.create_subscription(
            BallScrewState, '/ballscrew_monitor/x/state', self._take, 1000
        )
        self.times: list[float] = []
        self.judged = 0

    def _take(self, state: BallScrewState) -> None:
        self.judged = state.judged
        stamp = state.header.stamp
        sent = stamp.sec + stamp.nanosec / SECOND
        self.times.append(time.time() - sent)

    def publish(self) -> None:
        """Publish a load and a speed of now."""
        load, speed = WrenchStamped(), JointState(name=['x_axis'], velocity=[150.0])
        load.wrench.force.x = -1000.0
        load.header.stamp = speed.header.stamp = self.node.get_clock().now().to_msg()
        self.loads.publish(load)
        self.speeds.publish(speed)

    def run(self, rate: float, duration: float) -> None:
        """Publish for some time [s] at a rate [Hz]."""
        due, end = time.monotonic(), time.monotonic() + duration
        while due < end:
            self.publish()
            due += 1.0 / rate
            while (left := due - time.monotonic()) > 0.0:
                self.executor.spin_once(timeout_sec=left)


def main(rate: float = 100.0, duration: float = 20.0) -> None:
    """Run the node and print what it takes."""
    with free_domain() as domain:
        os.environ.update(ros_environment(domain))
        command = [sys.executable, '-m', 'ballscrew_monitor.node']
        node = subprocess.Popen(command, env=child_environment(domain))
        context = rclpy.Context()
        rclpy.init(context=context)
        try:
            measure(Machine(context), node.pid, rate, duration)
        finally:
            node.terminate()
            node.wait()
            rclpy.shutdown(context=context)


def measure(machine: Machine, pid: int, rate: float, duration: float) -> None:
    """Warm up, measure, print."""
    while not machine.judged:
        machine.run(rate, WARM_UP)
    before, judged = processor_time(pid), machine.judged
    machine.times.clear()
    begin = time.monotonic()
    machine.run(rate, duration)
    spent, wall = processor_time(pid) - before, time.monotonic() - begin
    machine.run(1.0, DRAIN)
    count = machine.judged - judged
    times = sorted(machine.times)
    print(f'{count} of {round(rate * duration)} samples judged at {rate:g} Hz')
    print(f'{100 * spent / wall:.1f} % of one core, {1e6 * spent / count:.0f} us per state')
    print(
        f'latency p50 {1e3 * times[len(times) // 2]:.2f} ms, '
        f'p99 {1e3 * times[len(times) * 99 // 100]:.2f} ms'
    )


if __name__ == '__main__':
    main(*(float(argument) for argument in sys.argv[1:]))
