# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The one parameter that is read before ROS is there, from wherever ROS takes it."""

from ballscrew_monitor.node.run import wants_localhost
import pytest

FILES = {
    'all': '/**:\n  ros__parameters: {localhost: true}\n',
    'name': 'ballscrew_monitor:\n  ros__parameters: {localhost: true}\n',
    'any_place': '/**/ballscrew_monitor:\n  ros__parameters: {localhost: true}\n',
    'full': '/line/ballscrew_monitor:\n  ros__parameters: {localhost: true}\n',
    'one_part': '/*/ballscrew_monitor:\n  ros__parameters: {localhost: true}\n',
    'nested': 'line:\n  ballscrew_monitor:\n    ros__parameters: {localhost: true}\n',
    'other': '/**/other:\n  ros__parameters: {localhost: true}\n',
    'false': '/**:\n  ros__parameters: {localhost: false}\n',
    'letter': '/**:\n  ros__parameters: {localhost: y}\n',
    'number': '/**:\n  ros__parameters: {localhost: 1}\n',
    'damaged': '/**: [\n',
}


@pytest.fixture
def file(tmp_path):
    """Return a function that writes one of the files and gives its path."""

    def write(name):
        path = tmp_path / f'{name}.yaml'
        path.write_text(FILES[name])
        return str(path)

    return write


@pytest.mark.parametrize(
    ('name', 'in_root', 'in_line'),
    [
        ('all', True, True),
        ('name', True, False),
        ('any_place', True, True),
        ('full', False, True),
        ('one_part', False, True),
        ('nested', False, True),
        ('other', False, False),
        ('false', False, False),
        ('letter', True, True),
        ('number', False, False),
        ('damaged', False, False),
    ],
)
def test_of_a_file_what_is_said_to_the_node_counts(file, name, in_root, in_line):
    arguments = ['--ros-args', '--params-file', file(name)]
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
    arguments = ['--ros-args', '--params-file', file('other'), '-r']
    assert wants_localhost([*arguments, '__node:=other'])
    assert wants_localhost([*arguments, 'ballscrew_monitor:__name:=other', '-r', '__ns:=/line'])
