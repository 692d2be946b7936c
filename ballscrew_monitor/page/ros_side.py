# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
The ROS side of the page: a thread that follows every node of ballscrew_msgs in the graph.

It finds axes by the types of topics, turns messages into records, and hands these to the thread of
the hub. It reads best effort: a page never holds a node up. A node whose messages are of another
version of ballscrew_msgs is named and not listened to: its bytes would be read as other numbers.

"""

from collections.abc import Callable
import threading
import time
from typing import Any

from ballscrew_monitor.page import records
from ballscrew_monitor.page.axis_view import AxisView
from ballscrew_monitor.page.hub import Hub
from ballscrew_monitor.page.phrases import phrase, Said
from ballscrew_monitor.page.surfaces import SurfaceLink
from ballscrew_monitor.settings.qos import LATCHED_QOS
from ballscrew_msgs.msg import AxisHealth, BallScrewState, OutOfZone, SurfaceInfo
from diagnostic_msgs.msg import DiagnosticArray
from rcl_interfaces.srv import GetParameters
from rclpy.clock import Clock, ClockType
from rclpy.node import Node
from rclpy.parameter import parameter_value_to_python
from rclpy.qos import QoSProfile, QoSReliabilityPolicy
from rclpy.task import Future

STATE_TYPE = 'ballscrew_msgs/msg/BallScrewState'
LOOK = 1.0  # [s] between two looks at the graph
POLL = 0.1  # [s] longest wait before the end is noticed
STATE_QOS = QoSProfile(depth=50, reliability=QoSReliabilityPolicy.BEST_EFFORT)
LEAVES = ('surface', 'speed.unit')
"""Parameters of an axis that the page asks for."""
Post = Callable[..., Any]
"""Calls a function with arguments in the thread of the hub."""


class RosSide:
    """Subscriptions of all axes, spun by a thread until closed."""

    def __init__(self, node: Node, hub: Hub, post: Post, *, only: str = '') -> None:
        """Follow the node with the full name `only`, all if that is empty."""
        self._node, self._hub, self._post, self._only = node, hub, post, only
        self._links: dict[str, AxisLink] = {}
        self._views: dict[str, AxisView] = {}
        self._refused: dict[str, set[str]] = {}  # hashes of another version
        self.failure: Exception | None = None
        self._stopped = threading.Event()
        self._thread = threading.Thread(target=self._spin, name='ros')
        node.create_subscription(DiagnosticArray, '/diagnostics', self._on_diagnostics, 10)
        node.create_timer(LOOK, self._look, clock=Clock(clock_type=ClockType.STEADY_TIME))

    def start(self) -> None:
        """Begin to listen."""
        self._thread.start()

    def close(self) -> None:
        """End the thread."""
        self._stopped.set()
        self._thread.join()

    def _spin(self) -> None:
        assert self._node.executor is not None
        try:
            self._look()
            while not self._stopped.is_set():
                self._node.executor.spin_once(timeout_sec=POLL)
        except Exception as error:  # told by the thread that waits for it
            self.failure = error

    def _look(self) -> None:
        """Take up the axes that have come, and let go of those that have left."""
        found = {
            topic.removesuffix('/state')
            for topic, types in self._node.get_topic_names_and_types()
            if STATE_TYPE in types and topic.endswith('/state')
            if self._node.count_publishers(topic)
            if self._only in ('', node_of(topic.removesuffix('/state')))
        }
        for base in sorted(found - self._links.keys()):
            if self._refused.get(base) != sent_hashes(self._node, base):
                self._take_up(base)
        for base in sorted(self._links.keys() - found):
            self._links.pop(base).close()
            self._post(self._hub.lose, base)
        for link in self._links.values():
            link.ask()

    def _take_up(self, base: str) -> None:
        node = node_of(base)
        view = self._views.setdefault(base, AxisView(node, base.rpartition('/')[2]))
        link = AxisLink(self._node, view, self._post)
        hashes = link.hashes()
        problem = version_problem(node, hashes)
        self._post(self._hub.notice, node, problem)
        if problem:  # nothing is spun between subscribing and this
            self._refused[base] = hashes[0]
            link.close()
            return
        self._links[base] = link
        self._post(self._hub.add, view)

    def _on_diagnostics(self, message: DiagnosticArray) -> None:
        for status in message.status:
            found = records.place_of(status.name)
            link = self._links.get('/'.join(found[:2])) if found else None
            if found and link:
                self._post(link.view.hear_code, found[2], records.code_of(status))


def node_of(base: str) -> str:
    """Return the full name of the node whose axis has topics below `base`."""
    return base.rpartition('/')[0]


def sent_hashes(node: Node, base: str) -> set[str]:
    """Return the hashes of the type of the state below `base`, as it is sent."""
    sent = node.get_publishers_info_by_topic(f'{base}/state')
    return {str(one.topic_type_hash) for one in sent}


def version_problem(node: str, hashes: tuple[set[str], set[str]]) -> Said:
    """Return why a node is not listened to, by hashes of its type and of ours; empty if it is."""
    theirs, ours = hashes
    if theirs <= ours:
        return ''
    return phrase('other_version', node=node)


class AxisLink:
    """The subscriptions of one axis."""

    def __init__(self, node: Node, view: AxisView, post: Post) -> None:
        """Subscribe to the outputs of the axis of a `view`."""
        self.view = view
        self._node, self._post = node, post
        self._info: SurfaceInfo | None = None
        self._values: dict[str, Any] = {}
        self._asked: Future | None = None
        kinds = {
            'state': (BallScrewState, self._on_state, STATE_QOS),
            'out_of_zone': (OutOfZone, self._on_event, LATCHED_QOS),
            'surface_info': (SurfaceInfo, self._on_info, LATCHED_QOS),
            'health': (AxisHealth, self._on_health, LATCHED_QOS),
        }
        self._subscriptions = [
            node.create_subscription(kind, f'{view.name}/{name}', hear, qos)
            for name, (kind, hear, qos) in kinds.items()
        ]
        self._parameters = node.create_client(GetParameters, f'{view.node}/get_parameters')
        self._surface = SurfaceLink(node, view, post)

    def close(self) -> None:
        """Unsubscribe, and ask no more."""
        for one in self._subscriptions:
            self._node.destroy_subscription(one)
        self._node.destroy_client(self._parameters)
        self._surface.close()

    def hashes(self) -> tuple[set[str], set[str]]:
        """Return the hashes of the type of the state, as it is sent and as we read it."""
        read = self._node.get_subscriptions_info_by_topic(f'{self.view.name}/state')
        mine = {str(one.topic_type_hash) for one in read if one.node_name == self._node.get_name()}
        return sent_hashes(self._node, self.view.name), mine

    def ask(self) -> None:
        """Ask for parameters and corrections until they are known; a first answer may be lost."""
        self._surface.ask()
        if self._values or not self._parameters.service_is_ready():
            return
        names = [f'{self.view.axis}.{leaf}' for leaf in LEAVES]
        self._asked = self._parameters.call_async(GetParameters.Request(names=names))
        self._asked.add_done_callback(self._on_parameters)

    def _on_parameters(self, future: Future) -> None:
        answer = future.result()
        if answer is not None and len(answer.values) == len(LEAVES):
            self._values = dict(zip(LEAVES, map(parameter_value_to_python, answer.values)))
            self._tell_surface()

    def _on_state(self, state: BallScrewState) -> None:
        row, record = records.row_of(state), records.state_record(state)
        limits = records.limits_record(state)
        self._post(self.view.hear, row, record, limits, time.monotonic())

    def _on_event(self, event: OutOfZone) -> None:
        self._post(self.view.hear_event, records.event_record(event))

    def _on_health(self, health: AxisHealth) -> None:
        self._post(self.view.hear_health, records.health_record(health))

    def _on_info(self, info: SurfaceInfo) -> None:
        self._info = info
        self._tell_surface()

    def _tell_surface(self) -> None:
        if self._info is not None and self._values:
            about = records.surface_record(self._info, self._values['speed.unit'])
            self._surface.tell(about, self._info, self._values['surface'])
