# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The parameters of a running node: declared from the table, checked, and taken over."""

from collections.abc import Callable
from typing import Any

from ballscrew_monitor.settings import parameters
from ballscrew_monitor.settings.parameter_row import Change, ParameterRow
from ballscrew_monitor.settings.parameter_table import NODE_ROWS
from rcl_interfaces.msg import SetParametersResult
from rclpy.node import Node
from rclpy.parameter import Parameter
from surrogate.files import InputError

SIMULATED = 'use_sim_time'
"""A parameter of rclpy: another clock is another line of time."""


class ParameterStore:
    """
    The values of all parameters as plain Python, by full name.

    While `locked`, only what may change at any time does, up to the number in `ceilings` if there
    is one; `on_change` is called with the first parts of the names that have changed. `given` is
    what the node was started with.

    """

    def __init__(self, node: Node, on_change: Callable[[set[str]], None]) -> None:
        """Declare every parameter on `node`; raises InputError for a bad one."""
        self.locked = False
        self.ceilings: dict[str, float] = {}
        self.values: dict[str, Any] = {}
        self._on_change = on_change
        # Private to rclpy; without it rclpy refuses bad values itself, in its own words.
        given = getattr(node, '_parameter_overrides', {})
        self.given = {name: _plain(parameter.value) for name, parameter in given.items()}
        self._declare(node, {row.name: row for row in NODE_ROWS})
        self._rows = parameters.table(self.values['axes'])
        self._declare(node, self._rows)
        for name in self.given:  # a slip of the pen must not pass for the default
            if name not in self._rows and not parameters.is_of_ros(name):
                raise InputError(f'parameter {name} is unknown')
        node.add_on_set_parameters_callback(self._check)
        node.add_post_set_parameters_callback(self._take)

    def _declare(self, node: Node, rows: dict[str, ParameterRow]) -> None:
        for name, row in rows.items():
            if name in self.values:
                continue
            value = row.read(self.given.get(name, parameters.default_of(name, row)))
            row.check(name, value)
            declared = node.declare_parameter(name, value, row.descriptor(), ignore_override=True)
            self.values[name] = _plain(declared.value)

    def _check(self, changed: list[Parameter]) -> SetParametersResult:
        try:
            for parameter in changed:
                name, row = parameter.name, self._rows.get(parameter.name)
                if row is None and name != SIMULATED:
                    continue
                value = _plain(parameter.value)
                if row is not None:
                    row.check(name, value)
                if self.locked and (row is None or row.change is Change.UNCONFIGURED):
                    raise InputError(
                        f'parameter {name} changes only while the node is unconfigured, clean it '
                        'up first'
                    )
                if self.locked and name in self.ceilings and value > self.ceilings[name]:
                    raise InputError(
                        f'parameter {name} is {value:g} s, while the node is configured at most '
                        f'{self.ceilings[name]:g} s, which its publisher promises: clean it up '
                        'first'
                    )
        except InputError as error:
            return SetParametersResult(successful=False, reason=str(error))
        return SetParametersResult(successful=True)

    def _take(self, changed: list[Parameter]) -> None:
        known = [parameter for parameter in changed if parameter.name in self._rows]
        self.values |= {parameter.name: _plain(parameter.value) for parameter in known}
        self._on_change({parameter.name.partition('.')[0] for parameter in known})


def is_kept(node: Node, parameter: Parameter) -> bool:
    """Return True if a node has the value that a parameter is to be set to."""
    if not node.has_parameter(parameter.name):
        return False
    now = node.get_parameter(parameter.name)
    return now.type_ == parameter.type_ and _plain(now.value) == _plain(parameter.value)


def _plain(value: Any) -> Any:
    """Return a parameter value as plain Python: rclpy hands out some lists as other sequences."""
    return value if value is None or isinstance(value, (bool, str, float, int)) else list(value)
