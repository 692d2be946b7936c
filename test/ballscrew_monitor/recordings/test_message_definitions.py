# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Definition and hash of message types from the installed files."""

import re

from ballscrew_monitor.recordings.message_definitions import (
    message_definition,
    SEPARATOR,
    type_hash,
)
import pytest
from surrogate.files import InputError


def test_dependencies_follow_the_definition_once_with_their_names():
    parts = message_definition('sensor_msgs/msg/JointState').split(f'{SEPARATOR}\n')
    assert 'float64[] velocity' in parts[0]
    expected = ['MSG: builtin_interfaces/Time', 'MSG: std_msgs/Header']
    assert [part.splitlines()[0] for part in parts[1:]] == expected
    assert all(part.endswith('\n') for part in parts)
    text = message_definition('ballscrew_msgs/msg/BallScrewState')
    names = re.findall('^MSG: (.*)$', text, flags=re.MULTILINE)
    assert len(names) == len(set(names))
    assert {'ballscrew_msgs/PointResult', 'builtin_interfaces/Time'} <= set(names)


def test_the_hash_is_that_of_the_generated_description():
    # Published for ROS 2 Jazzy: std_msgs/msg/Header.
    expected = 'RIHS01_f49fb3ae2cf070f793645ff749683ac6b06203e41c891e17701b1cb597ce6a01'
    assert type_hash('std_msgs/msg/Header') == expected


@pytest.mark.parametrize('name', ['std_msgs/msg/Nothing', 'Header', 'no_msgs/msg/Header'])
def test_an_unknown_type_is_one_sentence(name):
    with pytest.raises(InputError, match=f'message type .?{name}'):
        type_hash(name)
