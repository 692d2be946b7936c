# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""A number is found in the bytes of a message where the decoder of the middleware reads it."""

from ballscrew_monitor.core.cdr import HEADER
from ballscrew_monitor.core.conversions import Scaling, SECOND
from ballscrew_monitor.core.inputs import OpenInput, Source
from ballscrew_monitor.node.raw_field import MOST_FORMS, RawField
from ballscrew_monitor.recordings.bulk.layout import NoLayout
from geometry_msgs.msg import WrenchStamped
from hypothesis import given
from hypothesis import strategies as st
import pytest
from rclpy.serialization import deserialize_message, serialize_message
from sensor_msgs.msg import BatteryState, Imu, JointState, Temperature
from std_msgs.msg import Byte, Float32, Float64, Int64, UInt64

JOINT = 'sensor_msgs/msg/JointState'
FIELDS = ['velocity[0]', 'velocity[x_axis]', 'effort[1]']


def source_of(type_name, field):
    scaling = Scaling(factor=1.0, shift=0.0)
    return OpenInput(source=Source.SPEED, topic='t', field=field, scaling=scaling).close(type_name)


def joints(*names, frame='', **arrays):
    message = JointState(name=names, **arrays)
    message.header.frame_id = frame
    message.header.stamp.sec, message.header.stamp.nanosec = 1_700_000_000, 123_456_789
    return message


def decoded(source, data):
    """Return number and stamp of a message by the middleware, None without a number."""
    try:
        message = deserialize_message(data, source.message_type)
    except Exception:  # whatever it says of the bytes
        return None
    number = source.read_field(message)
    if not isinstance(number, float):
        return None
    stamp = message.header.stamp if source.stamped else None
    return number, stamp.sec * SECOND + stamp.nanosec if stamp else 0


def named(message):
    return f'{type(message).__module__.split(".")[0]}/msg/{type(message).__name__}'


MESSAGES = [
    ('data', Float64(data=2.5)),
    ('data', Float32(data=0.1)),
    ('data', Byte(data=b'\x85')),
    ('data', Int64(data=-(2**60) - 1)),
    ('data', UInt64(data=2**64 - 1)),
    ('temperature', Temperature(temperature=41.0)),
    ('wrench.torque.z', WrenchStamped()),
    ('linear_acceleration.y', Imu()),
    ('velocity[x_axis]', joints('a', 'x_axis', position=[1.0, 2.0], velocity=[3.0, 4.0])),
    ('velocity[1]', joints('a', 'bcd', frame='base', velocity=[3.0, -5e-324])),
    ('cell_voltage[1]', BatteryState(location='a', cell_voltage=[1.5, 2.5, 3.5])),
]


@pytest.mark.parametrize(('field', 'message'), MESSAGES)
def test_the_number_and_the_stamp_are_those_of_the_decoded_message(field, message):
    source, data = source_of(named(message), field), serialize_message(message)
    reader = RawField(source)
    assert reader.find(data) == reader.find(data) == decoded(source, data) is not None


@pytest.mark.parametrize('field', FIELDS)
def test_a_message_of_which_any_byte_is_another_is_read_as_by_the_decoder_or_left_to_it(field):
    """Read by a reader that knows the form of the message, and by one that does not."""
    source = source_of(JOINT, field)
    message = joints('a', 'x_axis', frame='ab', velocity=[3.0, 4.0], effort=[5.0, 6.0])
    whole = serialize_message(message)
    known, found = RawField(source), 0
    for at in range(len(whole)):
        for byte in (0, 1, 2, 0x41, 0x80, 0xFF, whole[at] ^ 1):
            after = at + 1
            data = whole[:at] + bytes([byte]) + whole[after:]
            assert known.find(whole) == decoded(source, whole)
            for reader in (known, RawField(source)):
                number = reader.find(data)
                found += number is not None
                assert number is None or repr(number) == repr(decoded(source, data))
    assert found > len(whole)


@given(st.binary(max_size=100), st.sampled_from(FIELDS))
def test_any_bytes_are_read_as_by_the_decoder_or_left_to_it(data, field):
    source = source_of(JOINT, field)
    number = RawField(source).find(HEADER + data)
    assert number is None or repr(number) == repr(decoded(source, HEADER + data))


def test_messages_of_several_publishers_are_told_apart():
    source = source_of(JOINT, 'velocity[x_axis]')
    reader = RawField(source)
    messages = [
        serialize_message(
            joints(*'abcdefghijkl'[:count], 'x_axis', velocity=[1.0] * count + [7.0])
        )
        for count in range(MOST_FORMS + 2)
    ]
    others = serialize_message(joints('y_axis', velocity=[1.0]))
    short = serialize_message(joints('a', 'x_axis', velocity=[1.0]))
    for _ in range(3):
        assert [reader.find(data)[0] for data in messages] == [7.0] * len(messages)
        assert (reader.find(others), reader.find(short)) == (None, None)
    assert len(reader._forms) == MOST_FORMS


def test_behind_a_list_of_messages_nothing_is_found():
    with pytest.raises(NoLayout):
        RawField(source_of('std_msgs/msg/Float64MultiArray', 'data[0]'))
