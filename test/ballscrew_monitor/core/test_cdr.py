# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Messages as bytes: what ROS reads, no byte more, zeros between."""

from ballscrew_monitor.core.cdr import serialized
from ballscrew_monitor.core.fields import message_class
import pytest
from rclpy.serialization import deserialize_message, serialize_message
from rosidl_parser import definition
from sensor_msgs.msg import JointState
from std_msgs.msg import Empty, UInt8

TYPES = (
    'ballscrew_msgs/msg/BallScrewState',
    'ballscrew_msgs/msg/OutOfZone',
    'ballscrew_msgs/msg/SurfaceInfo',
    'diagnostic_msgs/msg/DiagnosticArray',
    'geometry_msgs/msg/PoseWithCovarianceStamped',
    'sensor_msgs/msg/CameraInfo',
    'sensor_msgs/msg/JointState',
    'sensor_msgs/msg/PointCloud2',
    'sensor_msgs/msg/Temperature',
    'std_msgs/msg/Byte',
    'std_msgs/msg/ByteMultiArray',
)


@pytest.mark.parametrize('name', TYPES)
def test_ros_reads_the_message_that_was_written(filled, name):
    message = filled(message_class(name))
    assert repr(deserialize_message(serialized(message), type(message))) == repr(message)


@pytest.mark.parametrize('name', TYPES)
def test_it_is_what_ros_writes_but_for_padding_and_end(filled, name):
    for message in (message_class(name)(), filled(message_class(name))):
        ours, theirs = serialized(message), bytes(serialize_message(message))
        assert len(ours) <= len(theirs)
        # Bytes that differ are zero here: the padding.
        assert not any(mine for mine, other in zip(ours, theirs) if mine != other)


def test_empty_arrays_messages_without_fields_and_wide_characters(refused):
    assert serialized(JointState())[-16:] == bytes(16)
    assert len(serialized(JointState())) == 36
    assert serialized(Empty()) == b'\0\1\0\0\0'
    assert serialized(UInt8(data=7)) == b'\0\1\0\0\7'
    refused('unboundedwstring_cannot', serialized, Wide())


class Wide:
    SLOT_TYPES = (definition.UnboundedWString(),)

    @staticmethod
    def get_fields_and_field_types():
        return {'data': 'wstring'}
