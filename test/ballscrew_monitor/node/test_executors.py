# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The node composed with others: each executor of rclpy spins it, or it says why not."""

import contextlib

from ballscrew_monitor.cycle.domain import free_domain
from ballscrew_monitor.node.node import BallscrewMonitor
from ballscrew_monitor.settings.qos import started_node
from ballscrew_msgs.msg import BallScrewState
from ballscrew_msgs.srv import EvaluateOperatingPoint
from geometry_msgs.msg import WrenchStamped
from lifecycle_msgs.msg import Transition
from lifecycle_msgs.srv import ChangeState
import pytest
import rclpy
from rclpy.executors import MultiThreadedExecutor, SingleThreadedExecutor
from rclpy.experimental.events_executor import EventsExecutor
from rclpy.parameter import Parameter
from sensor_msgs.msg import JointState

ROUNDS = 3  # of deactivation and activation, while messages come
NAME = '/ballscrew_monitor'


@contextlib.contextmanager
def composed(kind, domain):
    """Give a node that is not active yet, and its executor."""
    context = rclpy.Context()
    rclpy.init(context=context, domain_id=domain)
    values = {'x.publish_period': 0.0, 'state_dir': '', 'autostart': False}
    overrides = [Parameter(name, value=value) for name, value in values.items()]
    node = BallscrewMonitor(context=context, parameter_overrides=overrides)
    executor = kind(context=context)
    try:
        yield node, executor
    finally:
        executor.shutdown()
        node.destroy_node()
        rclpy.shutdown(context=context)


class Client:
    """A machine and whoever calls the services, in a node of its own."""

    def __init__(self, node, spin, wait_for):
        self.node, self.spin, self.wait_for = node, spin, wait_for
        self.states = []
        node.create_subscription(BallScrewState, f'{NAME}/x/state', self.states.append, 1000)
        self.speeds = node.create_publisher(JointState, 'joint_states', 10)
        self.loads = node.create_publisher(WrenchStamped, 'axial_load', 10)

    def send(self):
        """Send a load and a speed, and let both executors work."""
        stamp = self.node.get_clock().now().to_msg()
        load, joints = WrenchStamped(), JointState(name=['x_axis'], velocity=[100.0])
        load.wrench.force.x = -1000.0
        load.header.stamp = joints.header.stamp = stamp
        self.loads.publish(load)
        self.speeds.publish(joints)
        self.work()

    def work(self):
        self.spin(timeout_sec=0.001)
        self.node.executor.spin_once(timeout_sec=0.001)

    def call(self, kind, name, request):
        """Return the answer of a service, while messages come."""
        client = self.node.create_client(kind, f'{NAME}/{name}')
        self.wait_for(client.service_is_ready, f'service {name}', meanwhile=self.work)
        future = client.call_async(request)
        self.wait_for(future.done, f'an answer of {name}', meanwhile=self.send)
        return future.result()

    def change(self, number):
        request = ChangeState.Request(transition=Transition(id=number))
        assert self.call(ChangeState, 'change_state', request).success

    def hear(self):
        """Wait for a state of an input that has come since."""
        self.states.clear()
        self.wait_for(lambda: self.states and self.states[-1].level, meanwhile=self.send)


@pytest.mark.parametrize('kind', [SingleThreadedExecutor, MultiThreadedExecutor])
def test_an_executor_hears_judges_and_answers(kind, wait_for):
    with free_domain() as domain, composed(kind, domain) as (node, executor):
        executor.add_node(node)
        with started_node('machine', domain) as machine:
            client = Client(machine, executor.spin_once, wait_for)
            client.change(Transition.TRANSITION_CONFIGURE)
            for _ in range(ROUNDS):
                client.change(Transition.TRANSITION_ACTIVATE)
                client.hear()
                request = EvaluateOperatingPoint.Request(axis='x')
                assert client.call(EvaluateOperatingPoint, 'evaluate', request).success
                client.change(Transition.TRANSITION_DEACTIVATE)
        assert node._axis_publishers['x'].defect == ''


def test_an_executor_without_a_wait_set_is_refused(refused):
    with free_domain() as domain, composed(EventsExecutor, domain) as (node, executor):
        with refused('without_a_wait_set'):
            executor.add_node(node)
        assert node.executor is None
        assert executor.get_nodes() == []
