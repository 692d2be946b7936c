# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Messages of several types are read in one go, each by its own layout."""

from ballscrew_monitor.core.conversions import Scaling, SECOND
from ballscrew_monitor.core.inputs import OpenInput, Source
from ballscrew_monitor.recordings.bulk import ways as ways_module
from ballscrew_monitor.recordings.bulk.layout import Layout
from ballscrew_monitor.recordings.bulk.ways import compiled_walk_each, prepare, walk_each, Ways
from geometry_msgs.msg import WrenchStamped
import numpy as np
import pytest
from rclpy.serialization import serialize_message
from sensor_msgs.msg import JointState
from std_msgs.msg import Float32, Int64

STAMP = 1_700_000_000 * SECOND + 5


def layout(type_name, field):
    scaling = Scaling(factor=1.0, shift=0.0)
    return Layout(
        OpenInput(source=Source.SPEED, topic='t', field=field, scaling=scaling).close(type_name)
    )


def stamped(message):
    message.header.stamp.sec, message.header.stamp.nanosec = divmod(STAMP, SECOND)
    return message


LAYOUTS = [
    ('sensor_msgs/msg/JointState', 'velocity[x]'),
    ('geometry_msgs/msg/WrenchStamped', 'wrench.force.x'),
    ('sensor_msgs/msg/JointState', 'effort[yy]'),
    ('std_msgs/msg/Float32', 'data'),
    ('std_msgs/msg/Int64', 'data'),
]


@pytest.mark.parametrize('compiled', [True, False])
def test_each_message_is_read_by_its_own_layout(compiled, monkeypatch):
    if not compiled:
        monkeypatch.setattr(ways_module, 'compiled_walk_each', lambda: walk_each)
    wrench = stamped(WrenchStamped())
    wrench.wrench.force.x = -7.5
    joints = JointState(name=['x', 'yy'], velocity=[1.5, 2.5], effort=[3.5, 4.5])
    messages = [
        serialize_message(message)
        for message in (Int64(data=-(2**53) - 1), stamped(joints), Float32(data=0.25), wrench)
    ]
    messages.append(messages[1][:-1])
    which, way = np.array([1, 3, 1, 4, 0, 2, 3]), np.array([2, 1, 0, 0, 4, 3, 0])
    ways = Ways([layout(*each) for each in LAYOUTS])
    is_plain, number, stamp = ways.walk(messages, which, way)
    assert is_plain.tolist() == [True, True, True, False, True, True, False]
    wanted = [4.5, -7.5, 1.5, float(-(2**53) - 1), 0.25]
    assert number[is_plain].tolist() == wanted
    assert stamp[is_plain].tolist() == [STAMP, STAMP, STAMP, 0, 0]


def test_no_messages_and_no_ways_give_nothing():
    nothing = np.empty(0, np.intp)
    assert [column.tolist() for column in Ways([]).walk([], nothing, nothing)] == [[], [], []]


def test_once_prepared_messages_are_read_without_a_compilation():
    prepare()
    entry = compiled_walk_each()
    before = list(entry.signatures)
    message = serialize_message(Float32(data=2.0))
    Ways([layout(*LAYOUTS[3])]).walk([message], np.array([0]), np.array([0]))
    assert list(entry.signatures) == before
