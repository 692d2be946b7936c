# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Inputs that do not work, over the real middleware: diagnostics and log name what mends them."""

import math

from ballscrew_monitor.messages import diagnostics
from geometry_msgs.msg import WrenchStamped
from rcl_interfaces.srv import GetParameters
from rclpy.qos import QoSProfile, QoSReliabilityPolicy
from sensor_msgs.msg import JointState
from std_msgs.msg import Float64

LONG = {'x__speed__timeout': 60.0, 'x__load__timeout': 60.0}
SECOND = 10**9  # [ns]
PERIOD = 4 * SECOND // 10  # [ns]
JOINTS = 'sensor_msgs/msg/JointState'


class Source:
    """One publisher, and what the node says of its inputs."""

    def __init__(self, node, kind=JointState, topic='joint_states', qos=10):
        self.node = node
        self.publisher = node.node.create_publisher(kind, topic, qos)

    def joints(self, name='x_axis', *velocity, ahead=0):
        message = JointState(name=[name], position=[0.0], velocity=list(velocity))
        return self.node.stamped(message, self.node.now() + ahead)

    def says(self):
        levels = self.node.levels()
        sentences = levels[-1][1].split('; ') if levels else []
        of_speed = [text for text in sentences if text.startswith('speed')]
        assert len(of_speed) <= 1, 'one fault has one sentence'
        return sentences

    def until_told(self, text, make=lambda: None):
        """Publish what `make` gives until the node says a text, which then is in its log too."""

        def told():
            message = make()
            if message is not None:
                self.publisher.publish(message)
            return text in self.says() and text in self.node.output.read_text()

        self.node.until(told, text)


def test_joints_position_only_numbers_and_stamps(node, says):
    node.start(**LONG)
    source, nothing = Source(node), says('load_without_publisher')
    other = JointState(name=['arm', 'x_joint'], velocity=[1.0, 2.0])
    source.until_told(says('joints_of_others'), lambda: other)
    source.until_told(says('velocity_is_empty'), lambda: source.joints('x_axis'))
    for number in (math.nan, math.inf, -math.inf):
        source.until_told(says('absurd'), lambda: source.joints('x_axis', 1e300))
        source.until_told(
            says('not_a_number'), lambda number=number: source.joints('x_axis', number)
        )
    source.until_told(
        says('stamps_ahead'), lambda: source.joints('x_axis', 1.0, ahead=3600 * SECOND)
    )
    assert nothing in source.says()
    node.until(
        lambda: (
            source.publisher.publish(source.joints('x_axis', 100.0)) or source.says() == [nothing]
        ),
        'the speed to be well',
    )


def test_no_publisher_another_type_and_a_publisher_that_is_gone(node, says):
    node.start(x__load__timeout=1.0)
    source = Source(node, kind=Float64)
    source.until_told(says('another_type', expected=JOINTS))
    source.until_told(says('load_without_publisher'))
    load = Source(node, kind=WrenchStamped, topic='axial_load')
    load.until_told(says('load_not_sent'))
    node.until(
        lambda: (
            load.publisher.publish(WrenchStamped())
            or not any(text.startswith('load') for text in load.says())
        ),
        'the load to arrive',
    )
    node.node.destroy_publisher(load.publisher)
    source.until_told(says('load_publisher_gone'))


def test_a_timeout_shorter_than_the_period_is_told_with_one_that_would_do(node):
    node.start(x__speed__timeout=0.05, x__max_future=3600.0)
    source = Source(node)
    begin, sent = node.now(), []

    def publish():
        due = begin + len(sent) * PERIOD
        if node.now() < due:
            return None
        sent.append(due)
        return node.stamped(JointState(name=['x_axis'], velocity=[100.0]), due)

    cure = 'set x.speed.timeout to 1.0 or more'

    def told():
        message = publish()
        if message is not None:
            source.publisher.publish(message)
        return any(cure in text for text in source.says())

    node.until(told, cure)


def test_qos_that_does_not_fit_is_told_and_overrides_are_parameters(node, says):
    name = 'qos_overrides./joint_states.subscription'
    node.start('-p', f'{name}.reliability:=reliable', '-p', f'{name}.depth:=7')
    qos = QoSProfile(depth=10, reliability=QoSReliabilityPolicy.BEST_EFFORT)
    source = Source(node, qos=qos)
    source.until_told(says('qos_does_not_fit', name=name))
    names = [f'{name}.{policy}' for policy in ('reliability', 'depth', 'history', 'durability')]
    values = node.call(GetParameters, 'get_parameters', names=names).values
    found = [value.string_value or value.integer_value for value in values]
    assert found == ['reliable', 7, 'keep_last', 'volatile']
    (info,) = node.node.get_subscriptions_info_by_topic('/joint_states')
    assert info.qos_profile.reliability == QoSReliabilityPolicy.RELIABLE


def test_an_empty_type_is_that_of_the_publisher_that_comes(node, says):
    node.start('-p', "x.speed.type:=''", x__speed__field='data')
    told = Source(node, kind=WrenchStamped, topic='axial_load')
    told.until_told(says('speed_without_publisher'))
    states, source = node.states(), Source(node, kind=Float64)

    def judged():
        told.publisher.publish(WrenchStamped())
        source.publisher.publish(Float64(data=100.0))
        return states and states[-1].judged

    node.until(judged, 'a judged sample')
    assert states[-1].point.speed == 100.0


def test_a_negative_index_ends_the_start_in_one_sentence(node, says):
    node.start('-p', 'x.speed.field:=velocity[-1]')
    assert node.end() == 2
    assert node.output.read_text() == says('speed_field_field')


def test_an_override_of_no_input_is_not_configured(node, says):
    node.start('-p', 'qos_overrides./joint_state.subscription.depth:=7')
    reason = says('override_of_no_input')

    def levels():
        """Return the levels with which the reason is told."""
        found = [status for message in node.told for status in message.status]
        return {status.level for status in found if status.message.startswith(reason)}

    assert node.until(levels, reason) == {diagnostics.ERROR}
