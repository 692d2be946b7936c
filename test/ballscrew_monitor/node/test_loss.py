# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Messages that are sent and never arrive, over the real middleware: each of them is counted."""

import dataclasses
import math
import signal

from diagnostic_msgs.msg import DiagnosticStatus
from geometry_msgs.msg import WrenchStamped
import pytest
from rclpy.qos import QoSProfile, QoSReliabilityPolicy
from sensor_msgs.msg import JointState

FAST = 100.0  # [rad/s]
STEP = 2.0**-10  # [rad/s] from one speed to the next, which tells them apart
TIMEOUTS = {'x__speed__timeout': 60.0, 'x__load__timeout': 60.0}
BURST = 5000
LOSES = 'speed messages are lost on the way: lower their rate, raise publish_period, or give'
STALE = DiagnosticStatus.STALE
GOOD = DiagnosticStatus.OK, 'all inputs arrive'
BEST_EFFORT = QoSProfile(depth=10, reliability=QoSReliabilityPolicy.BEST_EFFORT)


@dataclasses.dataclass
class Machine:
    """Publishers of speed and load, without stamps, and what the node says."""

    node: object

    def __post_init__(self):
        make = self.node.node.create_publisher
        self.speeds = make(JointState, 'joint_states', BEST_EFFORT)
        self.loads = make(WrenchStamped, 'axial_load', BEST_EFFORT)
        self.states = self.node.states()
        self.node.until_matched(self.speeds, self.loads)
        self.sent = 0
        self.loads.publish(WrenchStamped())

    def publish(self, publisher=None):
        self.sent += 1
        speed = FAST + STEP * self.sent
        (publisher or self.speeds).publish(JointState(name=['x_axis'], velocity=[speed]))

    @property
    def judged(self):
        """Return the states about a speed; those of ticks before the first one are about none."""
        return [state for state in self.states if not math.isnan(state.point.speed)]

    @staticmethod
    def number(state):
        """Return the number of the speed that a state is about: the first one is 1."""
        return round((state.point.speed - FAST) / STEP)

    @property
    def speed(self):
        return self.states[-1].inputs[0] if self.states else None

    def has(self, condition):
        return self.speed is not None and condition(self.speed)

    def judge(self, publisher=None):
        """Publish a speed, again with each of the diagnostics, until there is a state of one."""
        before, told = self.states[-1].judged if self.states else 0, 0

        def is_judged():
            nonlocal told
            if told != len(self.node.told):
                told = len(self.node.told)
                self.publish(publisher)
            return self.states and self.states[-1].judged > before

        self.node.until(is_judged, 'a state')

    def is_said(self, sentence):
        return any(
            level == DiagnosticStatus.WARN and message.startswith(sentence)
            for level, message in self.node.levels()
        )


def test_each_message_of_a_burst_is_received_or_counted_as_lost(node):
    node.start(**TIMEOUTS)
    machine = Machine(node)
    machine.judge()
    # A node that gets no processor time takes nothing out of its queue.
    node.process.send_signal(signal.SIGSTOP)
    for _ in range(BURST):
        machine.publish()
    node.process.send_signal(signal.SIGCONT)
    # What was sent last may be lost too, which the next ones tell.
    node.until(
        lambda: machine.publish() or machine.number(machine.judged[-1]) > BURST,
        'a speed after the burst',
    )
    for state in machine.judged:
        assert state.inputs[0].received + state.inputs[0].lost == machine.number(state)
    assert machine.speed.lost_known
    assert machine.speed.lost > 0
    node.until(lambda: machine.is_said(LOSES), 'the warning')
    assert len({one for one in node.levels() if one[1].startswith(LOSES)}) == 1


def test_honest_second_publishers_of_other_joints_leave_the_loss_known(node):
    node.start(**TIMEOUTS)
    machine = Machine(node)
    machine.judge()
    second = node.node.create_publisher(JointState, 'joint_states', BEST_EFFORT)
    node.until(second.get_subscription_count, 'the match')

    def is_known():
        second.publish(JointState(name=['gripper'], velocity=[1.0]))
        machine.publish()
        return machine.has(lambda speed: speed.dropped > 20 and speed.lost_known)

    node.until(is_known, 'the loss')
    node.until(lambda: is_known() and node.levels()[-1] == GOOD, 'the end of the doubt')
    node.until(lambda: is_known() and machine.speed.dropped > 100, 'more of both')
    assert node.levels()[-1] == GOOD
    assert machine.speed.lost == 0


@pytest.mark.parametrize('one_source', [True, False])
def test_two_publishers_of_one_joint_are_named_and_judged_only_where_that_is_allowed(
    node, one_source, says
):
    soon = {'x__speed__timeout': 0.5, 'x__load__timeout': 60.0}
    node.start(**soon, x__one_source=str(one_source).lower())
    machine = Machine(node)
    machine.judge()
    second = node.node.create_publisher(JointState, 'joint_states', BEST_EFFORT)
    node.until(second.get_subscription_count, 'the match')
    told = STALE, says('several_refused')
    if not one_source:
        told = DiagnosticStatus.OK, says('several_allowed')

    begun = len(node.told)

    def go_on():
        """Publish no faster than a busy node hears: so many for each of its diagnostics."""
        if machine.sent <= 20 * (len(node.told) - begun):
            second.publish(JointState(name=['x_axis'], velocity=[5.0]))
            machine.publish()
        return True

    node.until(lambda: go_on() and node.levels()[-1:] == [told], 'the sentence')
    judged, before = machine.states[-1].judged, machine.sent
    node.until(lambda: go_on() and machine.sent > before + 100 and node.levels()[-1] == told)
    node.until(lambda: machine.speed.received > before, 'the last samples')
    assert (machine.states[-1].judged == judged) is one_source
    node.node.destroy_publisher(second)

    def is_judged():
        machine.publish()
        return machine.states[-1].judged > judged and machine.speed.state == machine.speed.STATE_OK

    node.until(is_judged, 'the judgement of the one that is left')


@pytest.mark.parametrize('count', [1, 50])
def test_a_publisher_that_returns_begins_anew(node, count):
    node.start(**TIMEOUTS)
    machine = Machine(node)
    for _ in range(count):
        machine.judge()
    node.node.destroy_publisher(machine.speeds)
    machine.speeds = node.node.create_publisher(JointState, 'joint_states', BEST_EFFORT)
    before, received = len(node.told), machine.speed.received

    def is_back():
        machine.publish()
        return machine.has(lambda speed: speed.received > received + 100)

    node.until(is_back, 'samples of the new publisher')
    node.until(lambda: len(node.told) > before, 'a diagnostic')
    assert (machine.speed.lost_known, machine.speed.lost) == (True, 0)
