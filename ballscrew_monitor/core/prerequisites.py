# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Packages that a machine may lack, and how to get them."""

from importlib.util import find_spec
import sys
from typing import Any

from ballscrew_monitor.core.interrupts import BAD_INPUT

ROSDEP = 'rosdep install --from-paths src --ignore-src in the workspace'


def _pip(names: str) -> str:
    return f'pip install {names}, on a machine with ROS 2 in a venv (docs/guide/start.md)'


BAGS, REPORTS = _pip('mcap zstandard'), _pip('polars contourpy')
# The lowest versions are above those of Ubuntu 24.04.
WEB = _pip("starlette 'uvicorn>=0.40' 'websockets>=14.0' prometheus-client")
CURES = {
    'SurfaceTopography': _pip('SurfaceTopography'),
    'contourpy': REPORTS,
    'distributed': _pip('distributed'),
    'fastexcel': f'{_pip("fastexcel")}, or save the sheet as CSV',
    'lz4': _pip('lz4'),
    'mcap': BAGS,
    'numba': _pip('numba'),
    'polars': REPORTS,
    'zstandard': BAGS,
    **dict.fromkeys(('h11', 'prometheus_client', 'starlette', 'uvicorn', 'websockets'), WEB),
    'matplotlib': f'{ROSDEP}, or without ROS 2 pip install matplotlib',
    'numpy': f'{ROSDEP}, or without ROS 2 pip install numpy',
    'scipy': f'{ROSDEP}, or without ROS 2 pip install scipy',
    'yaml': f'{ROSDEP}, or without ROS 2 pip install PyYAML',
    **dict.fromkeys(
        (
            *('action_msgs', 'builtin_interfaces', 'diagnostic_msgs', 'geometry_msgs'),
            *('rcl_interfaces', 'rclpy', 'rosgraph_msgs', 'rosidl_parser', 'sensor_msgs'),
            *('std_msgs', 'std_srvs'),
        ),
        f'source the set-up file of ROS 2, else {ROSDEP}',
    ),
    'ballscrew_msgs': 'in the workspace ln -s ballscrew_monitor/msg_defs src/ballscrew_msgs, '
    'colcon build and source install/setup.bash',
}
"""How to get what a package imports, by the name of the module."""
LAST_FIELDS = {
    'AxisHealth': 'since',
    'BallScrewState': 'shelve_reason',
    'Finding': 'target_load',
    'HealthCause': 'text',
    'HealthQuantity': 'reason',
    'InputHealth': 'refusal',
    'JudgeEvents': 'notes',
    'OperatingPoint': 'axial_load_uncertainty',
    'OutOfZone': 'acknowledge_reason',
    'PointResult': 'contact_state',
    'SurfaceInfo': 'numerical_factor_high',
    'Totals': 'since',
    'WindowStatistics': 'film_ratio_max',
}
"""The last field of each message; messages grow at their end, so an older package lacks one."""


def require(*modules: str) -> None:
    """Raise ModuleNotFoundError for the first that is not installed, without importing any."""
    for name in modules:
        if find_spec(name) is None:
            raise ModuleNotFoundError(f'No module named {name!r}', name=name)


def check_interfaces(messages: Any) -> None:
    """Raise ImportError if `messages`, the module of them, is older than this package."""
    for name, field in LAST_FIELDS.items():
        kind = getattr(messages, name, None)
        if kind is None or field not in kind.get_fields_and_field_types():
            raise ImportError(f'{name} has no {field}', name='ballscrew_msgs')


def refuse(program: str, error: ImportError) -> int:
    """
    Print which package is missing and how to get it; return the exit code.

    Raises the error again if it is about none of `CURES`.

    """
    module = (error.name or '').split('.')[0]
    if module not in CURES:
        raise error
    missing = isinstance(error, ModuleNotFoundError) and error.name == module
    state = 'is not installed' if missing else 'is too old or damaged'
    print(f'{program}: {module} {state}, this command needs it: {CURES[module]}', file=sys.stderr)
    return BAD_INPUT
