# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Start the monitor as a lifecycle node.

With `autostart:=true` the node configures and activates itself; with `false` a lifecycle manager
does so. `params_file` may be left out: every parameter has a default. An argument that is given
goes before the parameter file, one that is not leaves it alone. A `params_file` that is not there
is an error: the defaults must not pass for it. The launch ends on Ctrl-C and when the node ends,
with an error if the node does; with `respawn:=true` the node is started again instead. With
`page:=true` a live page is served at http://127.0.0.1:8090/. If the page ends, the launch says so
and the node goes on.

"""

# ruff takes `launch` for the folder of that name, and not for the package.
# ruff: noqa: I001
from pathlib import Path
import sys

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, ExecuteProcess, LogInfo, OpaqueFunction, Shutdown
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import LifecycleNode
from launch_ros.parameter_descriptions import ParameterValue
from surrogate.files import InputError

ARGUMENTS = (
    ('params_file', '', 'Parameter file; empty: the defaults.'),
    ('namespace', '', 'Namespace of the node.'),
    ('use_sim_time', '', 'true: take the time from /clock; empty: as the parameter file says.'),
    ('log_level', 'info', 'debug, info, warn, error or fatal.'),
    ('autostart', '', 'true: configure and activate at start; empty: as the parameter file says.'),
    ('respawn', 'false', 'true: start the node again when it has ended.'),
    ('page', 'false', 'true: serve a live page to browsers on this machine.'),
    ('respawn_delay', '2.0', 'Time after which it is started again [s].'),
)


def find_file(context):
    """Return the parameter file, empty if none is named; raises InputError if it is not there."""
    file = LaunchConfiguration('params_file').perform(context)
    if file and not Path(file).is_file():
        raise InputError(
            f'params_file is {file}, there is no such file seen from {Path.cwd()}: '
            'give the path of a file, or leave params_file out for the defaults'
        )
    return file


def end(event, context):
    """Return what ends the launch, if it is not ending; raises RuntimeError if the node failed."""
    if event.returncode:
        raise RuntimeError(f'{event.process_name} has ended with exit code {event.returncode}')
    if context.is_shutdown:  # by Ctrl-C: launch fails at a second end
        return None
    return Shutdown(reason=f'{event.process_name} has ended')


def miss_page(event, context):
    """Return what says that the page has ended before the launch; nothing else ends with it."""
    if context.is_shutdown:
        return None
    return LogInfo(
        msg=f'{event.process_name} has ended with exit code {event.returncode}: there is no live '
        'page any more, the node goes on; `ballscrew page` serves it again'
    )


def make_page(context):
    """Return the process that serves the page, if it is asked for."""
    if LaunchConfiguration('page').perform(context).lower() != 'true':
        return []
    command = [sys.executable, '-m', 'ballscrew_monitor', 'page']
    return [ExecuteProcess(cmd=command, output='screen', on_exit=miss_page)]


def make_node(context):
    """Return the node, and the page; a parameter file counts only if one is named."""
    file = find_file(context)
    switches = {
        name: ParameterValue(LaunchConfiguration(name), value_type=bool)
        for name in ('use_sim_time', 'autostart')
        if LaunchConfiguration(name).perform(context)
    }
    again = LaunchConfiguration('respawn').perform(context).lower() == 'true'
    node = LifecycleNode(
        package='ballscrew_monitor',
        executable='ballscrew_monitor',
        name='ballscrew_monitor',
        namespace=LaunchConfiguration('namespace'),
        output='screen',
        respawn=again,
        respawn_delay=float(LaunchConfiguration('respawn_delay').perform(context)),
        on_exit=None if again else end,
        parameters=[*filter(None, [file, switches])],
        arguments=['--ros-args', '--log-level', LaunchConfiguration('log_level')],
    )
    return [node, *make_page(context)]


def generate_launch_description():
    """Return the arguments and the node."""
    declared = [
        DeclareLaunchArgument(name, default_value=default, description=text)
        for name, default, text in ARGUMENTS
    ]
    return LaunchDescription([*declared, OpaqueFunction(function=make_node)])
