# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Field paths and message types by name."""

from ballscrew_monitor.core import fields
from ballscrew_monitor.core.fields import check_path, compile_field, message_class, number_fields
from geometry_msgs.msg import WrenchStamped
import pytest
from sensor_msgs.msg import Imu, JointState
from std_msgs import msg as std
from surrogate.files import InputError


def joints(*names, velocity=()):
    return JointState(name=list(names), velocity=list(velocity))


def test_paths_that_lead_to_a_number():
    wrench = WrenchStamped()
    wrench.wrench.force.x = 2.5
    assert compile_field('wrench.force.x', WrenchStamped)(wrench) == 2.5
    assert compile_field('data', std.Float64)(std.Float64(data=-1.5)) == -1.5
    assert (
        compile_field('data[1]', std.Float64MultiArray)(std.Float64MultiArray(data=[1.0, 2.0]))
        == 2.0
    )
    assert (
        compile_field('layout.dim[0].size', std.Float64MultiArray)(std.Float64MultiArray()) != 0.0
    )
    assert compile_field('orientation_covariance[8]', Imu)(Imu()) == 0.0
    assert compile_field('header.stamp.sec', WrenchStamped)(wrench) == 0.0


def test_an_integer_becomes_a_float():
    value = compile_field('data', std.Int32)(std.Int32(data=7))
    assert (value, type(value)) == (7.0, float)


@pytest.mark.parametrize('number', [0, 7, 53, 255])
def test_a_byte_becomes_a_float(number):
    byte = bytes([number])
    assert compile_field('data', std.Byte)(std.Byte(data=byte)) == number
    assert (
        compile_field('data[1]', std.ByteMultiArray)(std.ByteMultiArray(data=[b'x', byte]))
        == number
    )
    assert compile_field('data', std.Char)(std.Char(data=number)) == number


@pytest.mark.parametrize(
    'kind', [std.Byte, std.Char, std.Float32, std.Float64, std.Int32, std.Int64, std.UInt64]
)
def test_every_type_of_number_is_read(kind):
    assert compile_field('data', kind)(kind()) == 0.0


def test_joints_are_found_by_name_and_other_joints_and_short_arrays_are_told_apart():
    read = compile_field('velocity[x_axis]', JointState)
    assert read(joints('x_axis', 'y_axis', velocity=[1.0, 2.0])) == 1.0
    assert read(joints('y_axis', 'x_axis', velocity=[1.0, 2.0])) == 2.0
    read = compile_field('velocity[robot.x]', JointState)  # a dot in its name
    assert read(joints('robot', 'robot.x', velocity=[1.0, 2.0])) == 2.0
    read = compile_field('velocity[x_axis]', JointState)
    expected = fields.OtherJoints('velocity', 'x_axis', ('y_axis',))
    assert read(joints('y_axis', velocity=[1.0])) == expected
    assert read(joints('x_axis')) == fields.TooShort('velocity', 'x_axis', 0)
    short = compile_field('position[3]', JointState)(joints('x_axis'))
    assert short == fields.TooShort('position', '3', 0)


def test_the_numbers_of_a_message_are_paths_that_lead_to_one():
    assert number_fields(JointState) == ('position[0]', 'velocity[0]', 'effort[0]')
    assert number_fields(std.Float64) == ('data',)
    for kind in (WrenchStamped, JointState, Imu, std.Float64MultiArray):
        for path in number_fields(kind):
            compile_field(path, kind)


def test_the_form_of_a_path_is_checked_without_a_type(refused):
    check_path('velocity[robot.x].y')
    for bad in ('velocity[-1]', 'wrench..x', 'velocity['):
        refused('field', check_path, bad)


@pytest.mark.parametrize(
    ('path', 'kind', 'match'),
    [
        ('velocity[x]', WrenchStamped, 'wrenchstamped_has_field'),
        ('wrench.force', WrenchStamped, 'vector3_number'),
        ('wrench.force.x.y', WrenchStamped, 'y_asked_double'),
        ('velocity', JointState, 'sequence_double_number'),
        ('name[0]', JointState, 'string_number'),
        ('header.frame_id', JointState, 'string_number'),
        ('wrench..x', WrenchStamped, 'name_name_index'),
        ('velocity[', JointState, 'name_name'),
        ('', std.Float64, 'name_2'),
        ('data[0]', std.Float64, 'data_float64_double'),
        ('data[x]', std.Float64MultiArray, 'has_list_names'),
        ('velocity[-1]', JointState, 'index_1_has'),
        ('data[+1]', std.Float64MultiArray, 'index_1'),
    ],
)
def test_paths_that_lead_nowhere_are_refused(path, kind, match, refused):
    refused(match, compile_field, path, kind)


@pytest.mark.parametrize(
    ('name', 'match'),
    [
        ('sensor_msgs/JointState', 'is not of the form package/msg/Name'),
        ('std_srvs/srv/Trigger', 'is not of the form'),
        ('no_such_msgs/msg/Float64', 'is not installed'),
        ('std_msgs/msg/NoSuch', 'is not installed'),
        ('', 'is not of the form'),
    ],
)
def test_types_that_are_no_types_are_refused(name, match):
    with pytest.raises(InputError, match=match):
        message_class(name)
