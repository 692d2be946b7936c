# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The bag of a generator appears whole or not at all; its messages are what ROS reads."""

import itertools

from geometry_msgs.msg import WrenchStamped
import pytest
from rclpy.serialization import deserialize_message
import recording
from sensor_msgs.msg import JointState, Temperature

STAMP = recording.BEGIN + 250_000_000


def some_records():
    for number in itertools.count():
        stamp = STAMP + number
        yield recording.Record(
            topic='/axial_load', stamp=stamp, log_time=stamp, data=recording.wrench(stamp, 1.0)
        )


def test_a_failure_leaves_the_old_bag_and_nothing_else(tmp_path):
    recording.write_bag(tmp_path / 'bag', itertools.islice(some_records(), 3))
    before = {path.name: path.read_bytes() for path in (tmp_path / 'bag').iterdir()}
    broken = itertools.chain(itertools.islice(some_records(), 5), (1 / 0 for _ in 'x'))
    with pytest.raises(ZeroDivisionError):
        recording.write_bag(tmp_path / 'bag', broken)
    assert {path.name: path.read_bytes() for path in (tmp_path / 'bag').iterdir()} == before
    assert [path.name for path in tmp_path.iterdir()] == ['bag']


@pytest.mark.parametrize('effort', [(), (1.75,)])
def test_a_joint_state_has_the_torque_that_it_is_given(effort):
    message = deserialize_message(recording.joint_state(STAMP, 0.5, -2.5, *effort), JointState)
    assert (list(message.name), list(message.position)) == (['x_axis'], [0.5])
    assert (list(message.velocity), list(message.effort)) == ([-2.5], list(effort))
    assert message.header.stamp.nanosec == STAMP % 1_000_000_000


def test_a_force_and_a_temperature_are_read_back():
    assert deserialize_message(recording.wrench(STAMP, -7.5), WrenchStamped).wrench.force.x == -7.5
    oil = deserialize_message(recording.temperature(STAMP, 41.5), Temperature)
    assert (oil.temperature, oil.header.frame_id) == (41.5, 'x_nut')
