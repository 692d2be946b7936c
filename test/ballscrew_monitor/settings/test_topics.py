# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The names of topics."""

from pathlib import Path

from ballscrew_monitor.settings.parameters import read_file
from ballscrew_monitor.settings.topics import absolute, input_topics, output, with_types

CONFIG = Path(__file__).resolve().parents[3] / 'config' / 'nominal_cycle.yaml'


def test_the_inputs_are_those_of_the_parameters():
    """A load of the motor torque has no topic."""
    speed = {'/joint_states': 'sensor_msgs/msg/JointState'}
    assert input_topics(read_file(CONFIG)) == speed | {
        '/axial_load': 'geometry_msgs/msg/WrenchStamped',
        '/oil_temperature': 'sensor_msgs/msg/Temperature',
    }
    assert input_topics(read_file(CONFIG.with_name('motor_current.yaml'))) == speed


def test_empty_types_are_filled_in_by_topic():
    values = {
        'axes': ['x'],
        'x.speed.topic': 'speed',
        'x.speed.type': '',
        'x.load.topic': '/load',
        'x.load.type': 'a/msg/B',
        'x.torque.topic': '',
        'x.torque.type': '',
    }
    filled = with_types(values, {'/speed': 'c/msg/D', '/load': 'e/msg/F'})
    assert filled == values | {'x.speed.type': 'c/msg/D'}
    assert with_types(values, {})['x.speed.type'] == ''


def test_names_are_full():
    assert absolute('joint_states') == absolute('/joint_states') == '/joint_states'
    assert output('x', 'state') == '/ballscrew_monitor/x/state'
