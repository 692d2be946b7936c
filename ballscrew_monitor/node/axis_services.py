# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
The services that change axes.

Those without a request act on all axes at once, and on each under its name; `shelve` and
`acknowledge_as` name their axis.

"""

from collections.abc import Callable, Mapping, Sequence
import functools
from typing import Any

from ballscrew_monitor.core.conversions import clock_text
from ballscrew_monitor.core.state import acknowledgement, Ending, NAMELESS, shelve
from ballscrew_monitor.messages.state_messages import fill_time
from ballscrew_monitor.node.axis_publisher import AxisPublisher
from ballscrew_monitor.settings.axis import reload_surface
from ballscrew_msgs.srv import AcknowledgeAlarm, ShelveAlarm
from rclpy.node import Node
from std_srvs.srv import Trigger
from surrogate.files import InputError
from surrogate.surface import Surface

Publishers = Mapping[str, AxisPublisher]
Act = Callable[[Publishers], str]


class AxisServices:
    """Reload of the surface, reset of the totals, acknowledgement and shelving of the warning."""

    def __init__(
        self,
        node: Node,
        values: Mapping[str, Any],
        publishers: Publishers,
        failed: Mapping[str, str],
        why_unknown: Callable[[str], str],
        changed: Callable[[Publishers, str], str],
        catch_up: Callable[[], None],
    ) -> None:
        """
        Make the services.

        `publishers` are those of now, none while the node is unconfigured; `failed` says why other
        axes have none, `why_unknown` why there is none of a name. `changed` takes the publishers
        that a service has changed, and its name; it keeps them and returns why that failed, or
        nothing. `catch_up` takes what waits before each of them, a step of the clock among it.

        """
        self._node, self._values = node, values
        self._publishers, self._failed = publishers, failed
        self._why_unknown, self._changed, self._catch_up = why_unknown, changed, catch_up
        acts: dict[str, Act] = {
            'reload_surface': self._reload,
            'reset_totals': self._reset,
            'acknowledge': self._acknowledge,
        }
        for name, act in acts.items():
            self._make(f'~/{name}', act, values['axes'])
            for axis in values['axes']:
                self._make(f'~/{axis}/{name}', act, [axis])
        shelve_named = functools.partial(self._serve_named, self._shelve)
        node.create_service(ShelveAlarm, '~/shelve', shelve_named)
        acknowledge_named = functools.partial(self._serve_named, self._acknowledge_as)
        node.create_service(AcknowledgeAlarm, '~/acknowledge_as', acknowledge_named)

    def _make(self, name: str, act: Act, axes: list[str]) -> None:
        self._node.create_service(Trigger, name, functools.partial(self._serve, act, axes))

    def _serve(self, act: Act, axes: list[str], request: Any, response: Any) -> Any:
        self._catch_up()
        publishers = {
            name: publisher for name, publisher in self._publishers.items() if name in axes
        }
        failed = [not_built(name, why) for name, why in self._failed.items() if name in axes]
        if not publishers:
            response.message = '; '.join(failed) or 'the node is not configured'
            return response
        try:
            self._answer(response, publishers, act(publishers), act.__name__.strip('_'), failed)
        except InputError as error:
            response.message = f'kept the old surface: {error}'
            self._node.get_logger().error(response.message)
        return response

    def _answer(
        self, response: Any, publishers: Publishers, done: str, name: str, failed: Sequence[str]
    ) -> None:
        """Keep what the service of a name has changed, and say what is done and what is not."""
        broken = [
            f'axis {name}: {publisher.defect}'
            for name, publisher in publishers.items()
            if publisher.failed
        ]
        problem = self._changed(publishers, name)
        done += f', not kept: {problem}' if problem else ''
        response.message = '; '.join([done, *failed, *broken])
        response.success = not broken

    def _reload(self, publishers: Publishers) -> str:
        """Swap the surfaces for the files as they are now, if all of them verify."""
        surfaces = {name: self._load(publisher) for name, publisher in publishers.items()}
        sentences = [
            publisher.guarded('a reload', publisher.reload, surfaces[name])
            for name, publisher in publishers.items()
        ]
        return ', '.join(
            filter(None, (f'reloaded the surface of {_names(publishers)}', *sentences))
        )

    def _load(self, publisher: AxisPublisher) -> Surface:
        """Return the surface of the file as it is now; a refusal stays in the diagnostics."""
        try:
            return reload_surface(publisher.axis, self._values)
        except InputError as error:
            publisher.refused = str(error)
            raise

    def _reset(self, publishers: Publishers) -> str:
        for publisher in publishers.values():
            publisher.guarded('a reset of its totals', publisher.alarm.reset_totals)
        return f'set the totals to zero of {_names(publishers)}'

    def _acknowledge(self, publishers: Publishers, by: Ending = NAMELESS) -> str:
        """Set the levels back to UNKNOWN and end the events."""
        for publisher in publishers.values():
            publisher.guarded('an acknowledgement', publisher.alarm.acknowledge, by)
        return f'acknowledged of {_names(publishers)}'

    def _serve_named(
        self, act: Callable[[Publishers, Any, Any], None], request: Any, response: Any
    ) -> Any:
        """Act on the axis that a request names, or on all; answer an InputError by its text."""
        self._catch_up()
        publishers = self._publishers
        axes = [request.axis] if request.axis else list(publishers)
        unknown = [axis for axis in axes if axis not in publishers]
        if not publishers:
            response.message = 'the node is not configured'
        elif unknown:
            response.message = self._why_unknown(unknown[0])
        else:
            try:
                act({axis: publishers[axis] for axis in axes}, request, response)
            except InputError as error:
                response.message = str(error)
        return response

    def _acknowledge_as(self, publishers: Publishers, request: Any, response: Any) -> None:
        by = acknowledgement(request.name, request.reason)
        done = f'{self._acknowledge(publishers, by)} by {by.name}'
        self._answer(response, publishers, done, 'acknowledge', ())

    def _shelve(self, publishers: Publishers, request: Any, response: Any) -> None:
        now = self._node.get_clock().now().nanoseconds
        shelving = shelve(now, request.duration, request.reason)
        for publisher in publishers.values():
            publisher.guarded('its shelving', publisher.shelve, shelving)
        until = f'shelved until {clock_text(shelving.until)}' if shelving.until else ''
        fill_time(response.until, shelving.until)
        done = f'{until or "no longer shelved"}: {_names(publishers)}'
        self._answer(response, publishers, done, 'shelve', ())


def not_built(axis: str, reason: str) -> str:
    """Return what a service says of an axis that could not be built for `reason`."""
    return f'axis {axis} is {reason}; mend it and configure the node again'


def _names(publishers: Publishers) -> str:
    return ', '.join(name for name, publisher in publishers.items() if not publisher.failed)
