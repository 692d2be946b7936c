# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Numbers are read at their places in serialised messages, whatever stands before them."""

from ballscrew_monitor.core.cdr import HEADER, serialized
from ballscrew_monitor.core.conversions import Scaling
from ballscrew_monitor.core.inputs import OpenInput, Source
from ballscrew_monitor.recordings.bulk.layout import Layout, NoLayout, Outcome, walk_many, WALKED
from geometry_msgs.msg import PoseWithCovarianceStamped, WrenchStamped
from hypothesis import given
from hypothesis import strategies as st
import numpy as np
import pytest
from rclpy.serialization import deserialize_message, serialize_message
from sensor_msgs.msg import BatteryState, Imu, JointState, Temperature
from std_msgs.msg import (
    Byte,
    Float32,
    Float64,
    Float64MultiArray,
    Int64,
    MultiArrayDimension,
    UInt64,
)

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


def walk(source, *messages):
    """Return the layout of an input, and what it finds in messages one behind the other."""
    parts = [each if isinstance(each, bytes) else serialize_message(each) for each in messages]
    size = np.array([len(part) for part in parts])
    layout = Layout(source)
    return layout, layout.walk(b''.join(parts), np.cumsum(size) - size, size)


@pytest.mark.parametrize(('field', 'message'), CASES)
def test_a_number_is_read_as_from_the_message(field, message):
    source = reader(name_of(message), field)
    layout, walked = walk(source, message)
    assert walked['outcome'] == Outcome.NUMBER
    (found,) = layout.numbers(walked)
    decoded = deserialize_message(serialize_message(message), type(message))
    np.testing.assert_equal(found, source.read_field(decoded))


def test_what_is_not_there_is_said_as_from_the_message():
    message = JointState(name=['a', 'bc'], velocity=[])
    _, (other,) = walk(reader(JOINT, 'velocity[x]'), message)
    assert other['outcome'] == Outcome.OTHER_JOINTS
    begin, end = other['names_begin'], other['names_end']
    names = serialized(message)[begin:end]  # rclpy leaves what is between them as it was
    assert names.replace(b'\0', b'') == b'\x02a\x03bc'
    for field, array in (('velocity[a]', 0), ('velocity[2]', 0)):
        layout, (short,) = walk(reader(JOINT, field), message)
        assert (short['outcome'], short['bits']) == (Outcome.TOO_SHORT, 0)
        assert layout.array == array
    _, (short,) = walk(reader(JOINT, 'velocity[bc]'), JointState(name=['bc'] * 3, velocity=[1.0]))
    assert short['outcome'] == Outcome.NUMBER
    _, (short,) = walk(reader(JOINT, 'effort[2]'), JointState(effort=[1.0, 2.0]))
    assert (short['outcome'], short['bits']) == (Outcome.TOO_SHORT, 2)


def test_stamps_are_in_the_header():
    message = wrench(1.0)
    message.header.stamp.sec, message.header.stamp.nanosec = -5, 999_999_999
    _, (walked,) = walk(reader('geometry_msgs/msg/WrenchStamped', 'wrench.force.x'), message)
    assert (walked['seconds'], walked['nanoseconds']) == (-5, 999_999_999)


@pytest.mark.parametrize('dimensions', [0, 1, 3])
def test_a_number_behind_a_list_of_messages_is_found(dimensions):
    message = Float64MultiArray(data=[1.0, 2.5])
    message.layout.dim = [
        MultiArrayDimension(label='abc'[:at], size=at) for at in range(dimensions)
    ]
    source = reader('std_msgs/msg/Float64MultiArray', 'data[1]')
    whole = serialize_message(message)
    layout, walked = walk(source, message, whole[:-9])
    assert layout.numbers(walked)[0] == 2.5
    assert walked['outcome'].tolist() == [Outcome.NUMBER, Outcome.UNREADABLE]


@pytest.mark.parametrize(
    ('kind', 'field'),
    [
        ('sensor_msgs/msg/MultiDOFJointState', 'wrench[0].force.x'),
        ('visualization_msgs/msg/InteractiveMarkerControl', 'interaction_mode'),
    ],
    ids=['a number within a list of messages', 'lists within lists'],
)
def test_a_type_that_the_steps_do_not_reach_has_no_layout(kind, field):
    with pytest.raises(NoLayout):
        Layout(reader(kind, field))


UNREADABLE = {
    'cut off': serialize_message(JointState(velocity=[1.0], effort=[2.0]))[:-5],
    'empty': b'',
    'another form': b'\0\0' + serialize_message(JointState(velocity=[1.0]))[2:],
    'absurd length': serialize_message(JointState())[:16] + b'\xff' * 12,
    'no ASCII': serialize_message(JointState(name=['\u00e9'], velocity=[1.0])),
}


@pytest.mark.parametrize('data', UNREADABLE.values(), ids=UNREADABLE)
def test_what_a_walk_does_not_understand_is_left_to_the_decoder(data):
    _, walked = walk(reader(JOINT, 'velocity[0]'), JointState(velocity=[3.0]), data)
    assert walked['outcome'].tolist() == [Outcome.NUMBER, Outcome.UNREADABLE]


@given(st.binary(max_size=120), st.sampled_from(['velocity[0]', 'velocity[a]', 'effort[3]']))
def test_any_bytes_are_walked_within_their_bounds(data, field):
    """Interpreted, so that a place out of bounds is an error; the compiled walk says the same."""
    data = HEADER + data
    layout = Layout(reader(JOINT, field))
    told = np.zeros(1, dtype=WALKED)
    walk_many(
        np.frombuffer(data, np.uint8),
        np.zeros(1, np.int64),
        np.array([len(data)]),
        layout.steps,
        layout.joint,
        told.view(np.recarray),
    )
    compiled = layout.walk(data, np.zeros(1, np.int64), np.array([len(data)]))
    assert told.tobytes() == compiled.tobytes()
