# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""A drive that states angle and current alone, over the real middleware and in a replay."""

import math

from ballscrew_monitor.recordings.bag import Bag
from ballscrew_monitor.recordings.bag_writer import BagWriter, Offer, Topic
from ballscrew_monitor.recordings.replay import replay
from ballscrew_monitor.settings import parameters
from ballscrew_msgs.msg import InputHealth, OperatingPoint, PointResult
import pytest
from rclpy.serialization import serialize_message
from sensor_msgs.msg import JointState

SECOND = 10**9  # [ns]
STEP = SECOND // 100
COUNT = 100
JOINT_STATES = 'sensor_msgs/msg/JointState'
PARAMETERS = {
    'speed__field': 'position[x_axis]',
    'speed__unit': 'rad',
    'speed__wrap': 6.283185307179586,
    'speed__timeout': 1000.0,
    'load__source': 'motor_torque',
    'torque__topic': 'joint_states',
    'torque__type': JOINT_STATES,
    'torque__field': 'effort[x_axis]',
    'torque__unit': 'A',
    'torque__constant': 0.5,
    'torque__uncertainty': 0.2,
    'torque__timeout': 1000.0,
    'inertia': 1e-3,
    'max_future': 1000.0,
    'publish_period': 0.0,
}


def motion(begin):
    """Yield stamps [ns] and messages of a screw that speeds up, runs, and pushes a load."""
    angle = 0.0
    for i in range(COUNT):
        speed = min(30.0 + i, 100.0)
        angle += speed * STEP / SECOND
        current = 5.0 + math.sin(0.1 * i) + (0.2 if speed < 100.0 else 0.0)
        message = JointState(
            name=['x_axis'], position=[math.remainder(angle, math.tau)], effort=[current]
        )
        stamp = begin + i * STEP
        message.header.stamp.sec, message.header.stamp.nanosec = divmod(stamp, SECOND)
        yield stamp, message


def told(state):
    """Return what must be the same of a state in the node and in the replay."""
    point, result = state.point, state.result
    return (
        (state.header.stamp.sec, state.header.stamp.nanosec),
        (point.speed, point.axial_load, point.axial_load_uncertainty, point.motor_torque),
        (point.axial_load_source, result.validity, result.reason, result.efficiency, result.rcs),
        (state.level, state.zone, state.judged, str(state.totals)),
    )


def replayed(folder, messages):
    with BagWriter(folder, 'bag') as writer:
        writer.add_topic(Topic(name='/joint_states', type_name=JOINT_STATES, offer=Offer.SENSOR))
        for stamp, message in messages:
            data = serialize_message(message)
            writer.write('/joint_states', data, log_time=stamp, publish_time=stamp)
    values = parameters.defaults(['x'])
    values |= {f'x.{name.replace("__", ".")}': value for name, value in PARAMETERS.items()}
    return [told(state) for state, _ in replay(Bag(folder), values)]


@pytest.fixture
def drive(node):
    """Return the publisher of a drive that the node listens to, and all states."""
    node.start(**{f'x__{name}': value for name, value in PARAMETERS.items()})
    publisher = node.node.create_publisher(JointState, 'joint_states', COUNT)
    states = node.states()
    node.until_matched(publisher, inputs=('Speed', 'Torque'))
    return publisher, states


def test_the_node_derives_what_a_replay_derives(node, drive, tmp_path):
    (publisher, states), messages = drive, list(motion(node.now() + 100 * SECOND))
    for _, message in messages:
        publisher.publish(message)
    node.until(lambda: states and states[-1].judged >= COUNT - 2, 'the last state')
    last = states[-1]
    assert last.point.axial_load_source == OperatingPoint.SOURCE_DERIVED
    assert last.result.validity == PointResult.VALIDITY_VALID
    assert last.point.speed == pytest.approx(100.0)
    assert 0.0 < last.point.axial_load_uncertainty < abs(last.point.axial_load)
    assert math.isnan(last.torque_residual)
    assert [health.state for health in last.inputs][1] == InputHealth.STATE_DERIVED
    heard = {told(state)[0]: told(state) for state in states if not math.isnan(state.point.speed)}
    found = replayed(tmp_path / 'bag', messages)  # a tick before the first speed is no sample
    expected = [one for one in found if not math.isnan(one[1][0])]
    assert len(expected) == COUNT - 1
    assert [str(heard[one[0]]) for one in expected] == [str(one) for one in expected]
