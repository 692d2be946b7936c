# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The services without a request: for all axes at once, and for each under its name."""

from collections.abc import Callable, Mapping
import functools
from typing import Any

from ballscrew_monitor.node.axis import reload_surface
from ballscrew_monitor.node.station import Station
from rclpy.node import Node
from std_srvs.srv import Trigger
from surrogate.files import InputError

Stations = Mapping[str, Station]
Act = Callable[[Stations], str]


class TriggerServices:
    """Reload of the surface, reset of the totals, acknowledgement of the warning."""

    def __init__(
        self,
        node: Node,
        values: Mapping[str, Any],
        find: Callable[[], Stations],
        changed: Callable[[Stations, str], str],
    ) -> None:
        """
        Make the services; `find` returns the stations, none while the node is unconfigured.

        `changed` is told which stations a service has changed, and its name; it keeps them and
        returns why that failed, or nothing.

        """
        self._node = node
        self._changed = changed
        self._values = values
        self._find = find
        acts: dict[str, Act] = {
            'reload_surface': self._reload,
            'reset_totals': self._reset,
            'acknowledge': self._acknowledge,
        }
        for name, act in acts.items():
            self._make(f'~/{name}', act, values['axes'])
            for axis in values['axes']:
                self._make(f'~/{axis}/{name}', act, [axis])

    def _make(self, name: str, act: Act, axes: list[str]) -> None:
        self._node.create_service(Trigger, name, functools.partial(self._serve, act, axes))

    def _serve(self, act: Act, axes: list[str], request: Any, response: Any) -> Any:
        stations = {name: one for name, one in self._find().items() if name in axes}
        if not stations:
            response.message = 'the node is not configured'
            return response
        try:
            response.message = act(stations)
            problem = self._changed(stations, act.__name__.strip('_'))
            response.message += f', not kept: {problem}' if problem else ''
            response.success = True
        except InputError as error:
            response.message = f'kept the old surface: {error}'
            self._node.get_logger().error(response.message)
        return response

    def _reload(self, stations: Stations) -> str:
        """Swap the surfaces for the files as they are now, if all of them verify."""
        surfaces = {
            name: reload_surface(station.axis, self._values) for name, station in stations.items()
        }
        said = [station.reload(surfaces[name]) for name, station in stations.items()]
        return ', '.join(filter(None, (f'reloaded the surface of {_names(stations)}', *said)))

    def _reset(self, stations: Stations) -> str:
        """Set the totals to zero."""
        for station in stations.values():
            station.alarm.reset_totals()
        return f'set the totals to zero of {_names(stations)}'

    def _acknowledge(self, stations: Stations) -> str:
        """Set the levels back to UNKNOWN and end the events."""
        for station in stations.values():
            station.alarm.acknowledge()
        return f'acknowledged of {_names(stations)}'


def _names(stations: Stations) -> str:
    return ', '.join(stations)
