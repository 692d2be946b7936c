# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Numbers are read at their places in serialised messages, whatever stands before them."""

from ballscrew_monitor.core.conversions import Scaling
from ballscrew_monitor.core.fields import OtherJoints, TooShort
from ballscrew_monitor.core.inputs import OpenInput, Source
from ballscrew_monitor.recordings.bulk.layout import Layout, NoLayout, reads_alike
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue
from geometry_msgs.msg import PoseWithCovarianceStamped, WrenchStamped
import numpy as np
import pytest
from rclpy.serialization import deserialize_message, serialize_message
from sensor_msgs.msg import BatteryState, Imu, JointState, Temperature
from std_msgs.msg import Byte, Empty, Float32, Float64, Int64, UInt64

JOINT = 'sensor_msgs/msg/JointState'


def reader(type_name, field):
    scaling = Scaling(factor=1.0, shift=0.0)
    return OpenInput(source=Source.SPEED, topic='t', field=field, scaling=scaling).close(type_name)


def wrench(value):
    message = WrenchStamped()
    message.header.frame_id = 'spindle'
    message.wrench.force.z = value
    return message


def covariance(value):
    message = PoseWithCovarianceStamped()
    message.pose.covariance[7] = value
    return message


CASES = [
    ('data', Float64(data=2.5)),
    ('data', Float32(data=0.1)),
    ('data', Byte(data=b'\x85')),
    ('data', Int64(data=-(2**60) - 1)),
    ('data', UInt64(data=2**64 - 1)),
    ('wrench.force.z', wrench(-3.25)),
    ('temperature', Temperature(temperature=41.0)),
    ('linear_acceleration.y', Imu()),
    ('pose.covariance[7]', covariance(7.5)),
    ('velocity[b]', JointState(name=['a', 'b'], position=[1.0, 2.0], velocity=[3.0, 4.0])),
    ('velocity[b]', JointState(name=['a', 'b'], velocity=[3.0, float('nan')])),
    ('effort[1]', JointState(name=['a', 'bcd', ''], velocity=[3.0], effort=[1.0, 2.0])),
    ('cell_voltage[1]', BatteryState(location='a', cell_voltage=[1.5, 2.5, 3.5])),
]


def name_of(message):
    return f'{type(message).__module__.split(".")[0]}/msg/{type(message).__name__}'


@pytest.mark.parametrize(('field', 'message'), CASES)
def test_a_number_is_read_as_from_the_message(field, message):
    data = serialize_message(message)
    source = reader(name_of(message), field)
    layout = Layout(data, type(message))
    assert isinstance(layout.find(source), int)
    assert reads_alike(layout, data, deserialize_message(data, type(message)), source)


def test_what_is_not_there_is_said_as_from_the_message():
    message = JointState(name=['a'], velocity=[])
    layout = Layout(serialize_message(message), JointState)
    assert layout.find(reader(JOINT, 'velocity[x]')) == OtherJoints('velocity', 'x', ('a',))
    assert layout.find(reader(JOINT, 'velocity[a]')) == TooShort('velocity', 'a', 0)


def fits(layout, *messages):
    """Return which messages that stand one behind the other fit."""
    parts = [each if isinstance(each, bytes) else serialize_message(each) for each in messages]
    size = np.array([len(part) for part in parts])
    return layout.fits(b''.join(parts), np.cumsum(size) - size, size).tolist()


def test_only_messages_with_equal_lengths_and_texts_fit():
    first = JointState(name=['a', 'b'], velocity=[3.0, 4.0])
    layout = Layout(serialize_message(first), JointState)
    others = JointState(name=['a', 'b'], velocity=[-1.0, 5.0])
    others.header.stamp.sec = 7
    renamed = JointState(name=['a', 'c'], velocity=[3.0, 4.0])
    moved = JointState(name=['a', 'b'], position=[3.0, 4.0])
    longer = JointState(name=['a', 'b'], velocity=[3.0, 4.0, 5.0])
    big_endian = b'\0\0' + serialize_message(first)[2:]
    different = (renamed, moved, longer, big_endian, b'')
    assert fits(layout, first, others, *different) == [True] * 2 + [False] * 5


def test_stamps_are_in_the_header_and_nested_messages_have_places():
    message = wrench(1.0)
    message.header.stamp.sec, message.header.stamp.nanosec = -5, 999_999_999
    data = serialize_message(message)
    layout = Layout(data, WrenchStamped)
    stamps = layout.stamps(data, np.zeros(1, dtype=np.int64))
    assert stamps.tolist() == [-5 * 10**9 + 999_999_999]
    status = DiagnosticStatus(name='n', values=[KeyValue(key='k', value='v')])
    message = DiagnosticArray(status=[status, status])
    layout = Layout(serialize_message(message), DiagnosticArray)
    assert fits(layout, message) == [True]


@pytest.mark.parametrize(
    ('kind', 'data'),
    [
        (WrenchStamped, serialize_message(WrenchStamped())[:-4]),
        (WrenchStamped, b''),
        (Float64, b'\0\0\0\0' + bytes(8)),
        (JointState, serialize_message(JointState())[:16] + b'\xff' * 12),
        (Empty, serialize_message(Empty())),
    ],
    ids=['cut off', 'empty', 'another form', 'absurd length', 'no field'],
)
def test_a_message_without_places_has_no_layout(kind, data):
    with pytest.raises(NoLayout):
        Layout(data, kind)
