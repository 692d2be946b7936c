# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The service that shelves the warning of an axis, or of all, for a stated time."""

from collections.abc import Callable, Mapping
from typing import Any

from ballscrew_monitor.core.conversions import clock_text
from ballscrew_monitor.core.shelving import shelve
from ballscrew_monitor.messages.state_messages import fill_time
from ballscrew_monitor.node.axis_publisher import AxisPublisher
from ballscrew_msgs.srv import ShelveAlarm
from rclpy.node import Node
from surrogate.files import InputError


class ShelveService:
    """Shelves warnings."""

    def __init__(
        self,
        node: Node,
        find: Callable[[], Mapping[str, AxisPublisher]],
        why_unknown: Callable[[str], str],
        changed: Callable[[Mapping[str, AxisPublisher], str], str],
    ) -> None:
        """
        Make the service; `find` returns the publishers, none while the node is unconfigured.

        `why_unknown` says why there is none of a name. `changed` is told which publishers the
        service has changed, and its name; it keeps them and returns why that failed, or nothing.

        """
        self._node = node
        self._find = find
        self._why_unknown = why_unknown
        self._changed = changed
        node.create_service(ShelveAlarm, '~/shelve', self._serve)

    def _serve(self, request: Any, response: Any) -> Any:
        publishers = self._find()
        axes = [request.axis] if request.axis else list(publishers)
        unknown = [axis for axis in axes if axis not in publishers]
        if not publishers:
            response.message = 'the node is not configured'
        elif unknown:
            response.message = self._why_unknown(unknown[0])
        else:
            self._shelve({axis: publishers[axis] for axis in axes}, request, response)
        return response

    def _shelve(
        self, publishers: Mapping[str, AxisPublisher], request: Any, response: Any
    ) -> None:
        now = self._node.get_clock().now().nanoseconds
        try:
            shelving = shelve(now, request.duration, request.reason)
        except InputError as error:
            response.message = str(error)
            return
        for publisher in publishers.values():
            publisher.shelve(shelving)
        names = ', '.join(publishers)
        response.success = True
        response.message = f'no longer shelved: {names}'
        if shelving.until:
            response.message = f'shelved until {clock_text(shelving.until)}: {names}'
        fill_time(response.until, shelving.until)
        problem = self._changed(publishers, 'shelve')
        response.message += f', not kept: {problem}' if problem else ''
