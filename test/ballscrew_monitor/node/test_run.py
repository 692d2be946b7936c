# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The one parameter that is read before ROS is there, from wherever ROS takes it."""

from ballscrew_monitor.node.run import wants_localhost
import pytest

LOCAL = 'ros__parameters: {localhost: true}'


@pytest.fixture
def file(tmp_path):
    def write(text):
        (tmp_path / 'parameters.yaml').write_text(text)
        return str(tmp_path / 'parameters.yaml')

    return write


@pytest.mark.parametrize(
    ('text', 'in_root', 'in_line'),
    [
        (f'/**: {{{LOCAL}}}', True, True),
        (f'ballscrew_monitor: {{{LOCAL}}}', True, False),
        (f'/**/ballscrew_monitor: {{{LOCAL}}}', True, True),
        (f'/line/ballscrew_monitor: {{{LOCAL}}}', False, True),
        (f'/*/ballscrew_monitor: {{{LOCAL}}}', False, True),
        (f'line: {{ballscrew_monitor: {{{LOCAL}}}}}', False, True),
        (f'/**/other: {{{LOCAL}}}', False, False),
        ('/**: {ros__parameters: {localhost: false}}', False, False),
        ('/**: {ros__parameters: {localhost: y}}', True, True),
        ('/**: {ros__parameters: {localhost: 1}}', False, False),
        ('/**: [', False, False),
    ],
)
def test_of_a_file_what_is_said_to_the_node_counts(file, text, in_root, in_line):
    arguments = ['--ros-args', '--params-file', file(text)]
    assert wants_localhost(arguments) is in_root
    assert wants_localhost([*arguments, '-r', '__ns:=/line']) is in_line


@pytest.mark.parametrize(
    ('arguments', 'wanted'),
    [
        ([], False),
        (['-p', 'localhost:=true'], False),  # not for ROS
        (['--ros-args', '-p', 'localhost:=true'], True),
        (['--ros-args', '--param', 'ballscrew_monitor:localhost:=true'], True),
        (['--ros-args', '-p', 'other:localhost:=true'], False),
        (['--ros-args', '-p', 'axes:=[x]'], False),
        (['--ros-args', '-p', 'localhost:=['], False),
        (['--ros-args', '-p', 'localhost:=true', '-p', 'localhost:=false'], False),
        (['--ros-args', '--', '-p', 'localhost:=true'], False),
        (['--ros-args', '-p', 'localhost:=true', '--', '--ros-args'], True),
        (['--ros-args', '-p'], False),
    ],
)
def test_of_the_arguments_the_last_one_counts(arguments, wanted):
    assert wants_localhost(arguments) is wanted


def test_a_node_of_another_name_has_its_own(file):
    arguments = ['--ros-args', '--params-file', file(f'/**/other: {{{LOCAL}}}'), '-r']
    assert wants_localhost([*arguments, '__node:=other'])
    assert wants_localhost([*arguments, 'ballscrew_monitor:__name:=other', '-r', '__ns:=/line'])
