# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
The ROS side of the page: a thread that follows every node of ballscrew_msgs in the graph.

It finds axes by the types of topics, turns messages into records, and hands these to the thread of
the hub. It reads states best effort, and reliably what comes seldom: events, surface, health and
diagnostics. A node whose messages are of another version of ballscrew_msgs is named and not
listened to: its bytes would be read as other numbers.

A wake-up of the executor costs more than to read a message. So the thread takes all that waits, as
often as the hub sends frames, hands it over as one, and lets the executor wait only for answers.

"""

from collections.abc import Callable, Iterable
import functools
import logging
import threading
import time
from typing import Any

from ballscrew_monitor.core.fault_codes import Fault
from ballscrew_monitor.messages.diagnostics import code_of, HOST, NODE_PART, PARTS, usual_of
from ballscrew_monitor.node.topic import Apart, open_topic
from ballscrew_monitor.page import records
from ballscrew_monitor.page.axis_view import AxisView
from ballscrew_monitor.page.hub import Hub, MOST_AXES, PERIOD
from ballscrew_monitor.page.phrases import phrase, Said
from ballscrew_monitor.page.surfaces import PatientClient, SurfaceLink
from ballscrew_monitor.settings.parameters import defaults
from ballscrew_msgs.msg import AxisHealth, BallScrewState, OutOfZone, SurfaceInfo
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from rcl_interfaces.srv import GetParameters
from rclpy.node import Node
from rclpy.parameter import parameter_value_to_python
from rclpy.qos import QoSDurabilityPolicy, QoSProfile
from rclpy.task import Future

LOG = logging.getLogger(__name__)
STATE_TYPE = 'ballscrew_msgs/msg/BallScrewState'
OUTPUTS = ('state', 'out_of_zone', 'surface_info', 'health')  # of an axis that the page reads
LONGEST = 500  # characters of the hosts of nodes of one name
LOOK = 1.0  # [s] between two looks at the graph
DEPTH = 100  # messages of a topic of which few come, that wait for their turn
DIAGNOSTICS_QOS = QoSProfile(depth=DEPTH)
LATE_QOS = QoSProfile(depth=DEPTH, durability=QoSDurabilityPolicy.TRANSIENT_LOCAL)
"""QoS of what is published for late joiners, of which several may come in one turn."""
LEAVES = ('surface', 'speed.unit')
"""Parameters of an axis that go with its surface; a report of a fault tells all others too."""
Post = Callable[..., Any]
"""Calls a function with arguments in the thread of the hub."""


class RosSide:
    """Subscriptions of all axes, read by a thread until closed."""

    def __init__(self, node: Node, hub: Hub, post: Post, *, only: str = '') -> None:
        """Follow the node with the full name `only`, all if that is empty."""
        self._node, self._hub, self._post, self._only = node, hub, post, only
        self._acts: list[tuple[Any, ...]] = []  # functions with arguments, for the hub
        self._links: dict[str, AxisLink] = {}
        self._gone: dict[str, AxisView] = {}  # that have left, the last one last
        self._refused: dict[str, set[str]] = {}  # hashes of another version
        self._twins: dict[str, tuple[str, ...]] = {}  # hosts of nodes of one name
        self.failure: Exception | None = None
        self._stopped = threading.Event()
        self._thread = threading.Thread(target=self._spin, name='ros')
        self._diagnostics = open_topic(
            node, '/diagnostics', DiagnosticArray, Apart(), qos=DIAGNOSTICS_QOS
        )

    def start(self) -> None:
        """Begin to listen."""
        self._thread.start()

    def close(self) -> None:
        """End the thread."""
        self._stopped.set()
        self._thread.join()

    def _spin(self) -> None:
        try:
            while not self._stopped.is_set():
                self._look()
                for _ in range(round(LOOK / PERIOD)):
                    self._pause(PERIOD)
                    self._drain()
        except Exception as error:  # told by the thread that waits for it
            self.failure = error

    def _pause(self, duration: float) -> None:
        """Wait some `duration` [s], in the executor where it has something to do."""
        assert self._node.executor is not None
        end = time.monotonic() + duration
        while not self._stopped.is_set() and (left := end - time.monotonic()) > 0.0:
            if self._hub.acting or any(link.is_asking for link in self._links.values()):
                self._node.executor.spin_once(timeout_sec=left)
            else:
                self._stopped.wait(left)

    def _later(self, *act: Any) -> None:
        self._acts.append(act)

    def _drain(self) -> None:
        """Take all that has come, and let the hub show it at once."""
        for link in self._links.values():
            if lost := link.drain():
                self._later(self._hub.miss, lost)
        for arrival in self._diagnostics.waiting():
            self._on_diagnostics(arrival.message)
        if self._acts:
            self._later(self._hub.tick, time.monotonic())
            self._post(_act_all, self._acts)
            self._acts = []

    def _look(self) -> None:
        """Take up the axes that have come, and let go of those that have left."""
        bases = {
            topic.removesuffix('/state')
            for topic, types in self._node.get_topic_names_and_types()
            if STATE_TYPE in types and topic.endswith('/state')
            if self._node.count_publishers(topic)
            if self._only in ('', node_of(topic.removesuffix('/state')))
        }
        for base in sorted(self._links.keys() - bases):
            self._let_go(base)
        for base in sorted(self._refused.keys() - bases):
            del self._refused[base]
            self._later(self._hub.notice, node_of(base), '')
        for base in sorted(bases - self._links.keys()):
            has_room = len(self._links) < MOST_AXES
            if has_room and self._refused.get(base) != sent_hashes(self._node, base):
                self._take_up(base)
        for link in self._links.values():
            link.ask()

    def _take_up(self, base: str) -> None:
        node = node_of(base)
        view = self._gone.get(base) or AxisView(node, base.rpartition('/')[2])
        link = AxisLink(self._node, view, self._later)
        hashes = link.hashes()
        problem = version_problem(node, hashes)
        self._later(self._hub.notice, node, problem)
        if problem:  # nothing is taken between subscribing and this
            self._refused[base] = hashes[0]
            link.close()
            return
        self._gone.pop(base, None)
        self._links[base] = link
        self._make_room()
        self._later(self._hub.add, view)

    def _let_go(self, base: str) -> None:
        link = self._links.pop(base)
        link.close()
        self._gone[base] = link.view
        self._later(self._hub.lose, base)

    def _make_room(self) -> None:
        """Forget the axes that have been gone longest, where there are too many in all."""
        while self._gone and len(self._links) + len(self._gone) > MOST_AXES:
            oldest = next(iter(self._gone))
            del self._gone[oldest]
            self._later(self._hub.forget, oldest)
            self._node.get_logger().info(
                f'axis {oldest}, which is gone, is not shown any more: '
                f'{MOST_AXES} axes are shown at most'
            )

    def _on_diagnostics(self, message: DiagnosticArray) -> None:
        for status in message.status:
            if place := records.place_of(status.name):
                node, axis, part = place
                if part == NODE_PART:
                    self._hear_node(node, status)
                views = [link.view for link in self._links.values() if link.view.node == node]
                for view in views:
                    if axis in ('', view.axis):
                        self._later(view.hear_code, part, code_of(status))
                        if part == PARTS[0]:
                            self._later(view.hear_usual, usual_of(status))

    def _hear_node(self, node: str, status: DiagnosticStatus) -> None:
        """Show on which hosts nodes of one name run, until one of them says that it is alone."""
        if code_of(status) != Fault.TWO_NODES or self._only not in ('', node):
            if self._twins.pop(node, None):
                self._later(self._hub.notice, f'{node} ', '')
            return
        hosts = tuple(sorted({pair.value for pair in status.values if pair.key == HOST}))
        if self._twins.get(node) != hosts and len(self._twins) < MOST_AXES:
            self._twins[node] = hosts
            words = phrase('two_nodes', node=node, hosts=', '.join(hosts)[:LONGEST])
            self._later(self._hub.notice, f'{node} ', words)


def _act_all(acts: Iterable[tuple[Any, ...]]) -> None:
    for function, *given in acts:
        try:
            function(*given)
        except Exception:  # the acts after it are of other axes
            LOG.exception('the page lost something that it heard')


def node_of(base: str) -> str:
    """Return the full name of the node whose axis has topics below `base`."""
    return base.rpartition('/')[0]


def sent_hashes(node: Node, base: str) -> set[str]:
    """Return the hashes of the types of the outputs below `base`, as they are sent."""
    return {
        str(publisher.topic_type_hash)
        for name in OUTPUTS
        for publisher in node.get_publishers_info_by_topic(f'{base}/{name}')
    }


def version_problem(node: str, hashes: tuple[set[str], set[str]]) -> Said:
    """Return why a node is not heard, by hashes of its types and of ours; empty if it is."""
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
        self._is_due = False  # to ask for the parameters
        kinds = {
            'state': (BallScrewState, self._on_state, None),
            'out_of_zone': (
                OutOfZone,
                lambda event: post(view.hear_event, records.event_record(event)),
                LATE_QOS,
            ),
            'surface_info': (SurfaceInfo, self._on_info, LATE_QOS),
            'health': (
                AxisHealth,
                lambda health: post(view.hear_health, records.health_record(health)),
                LATE_QOS,
            ),
        }
        self._topics = [
            (open_topic(node, f'{view.name}/{name}', kind, Apart(), qos=qos), hear)
            for name, (kind, hear, qos) in kinds.items()
        ]
        self._parameters = PatientClient(node, GetParameters, f'{view.node}/get_parameters')
        self._surface = SurfaceLink(node, view, post)

    def close(self) -> None:
        """Unsubscribe, and ask no more."""
        for topic, _ in self._topics:
            self._node.destroy_subscription(topic.subscription)
        self._parameters.close()
        self._surface.close()

    def drain(self) -> int:
        """Take all that has come; return how many messages were lost before or among it."""
        lost = 0
        for topic, hear in self._topics:
            for arrival in topic.waiting():
                lost += topic.loss.take(arrival.number) or 0
                hear(arrival.message)
        return lost

    def hashes(self) -> tuple[set[str], set[str]]:
        """Return the hashes of the types of the outputs, as they are sent and as we read them."""
        ours = {
            str(reader.topic_type_hash)
            for name in OUTPUTS
            for reader in self._node.get_subscriptions_info_by_topic(f'{self.view.name}/{name}')
            if reader.node_name == self._node.get_name()
        }
        return sent_hashes(self._node, self.view.name), ours

    @property
    def is_asking(self) -> bool:
        """Return True if parameters or corrections that go with the surface are not known yet."""
        return self._is_due or self._surface.is_asking

    def ask(self) -> None:
        """Ask for parameters and corrections until they are known; a first answer may be lost."""
        self._surface.ask()
        if self._is_due:
            names = [f'{self.view.axis}.{leaf}' for leaf in LEAVES]
            tell = functools.partial(self._tell_surface, self._info, names)
            self._parameters.call(GetParameters.Request(names=names), tell)

    def _tell_surface(self, info: SurfaceInfo, names: list[str], future: Future) -> None:
        """Take the parameters that go with a surface, if no other has come since; ask for all."""
        if not self._is_due or info is not self._info:
            return
        answer = future.result()
        if answer is None or len(answer.values) != len(names):
            return
        path, unit = values = [*map(parameter_value_to_python, answer.values)]
        known = dict(zip(names, values, strict=True))
        self._post(self.view.hear_parameters, known)
        self._surface.tell(records.surface_record(info, unit), info, path)
        self._is_due = False
        others = sorted(defaults([self.view.axis]).keys() - {*names})

        def tell_others(future: Future) -> None:
            """Take them; a node of another version may not have all, and says none."""
            answer = future.result()
            if info is self._info and answer is not None and len(answer.values) == len(others):
                rest = dict(zip(others, map(parameter_value_to_python, answer.values)))
                self._post(self.view.hear_parameters, known | rest)

        self._parameters.call(GetParameters.Request(names=others), tell_others)

    def _on_state(self, state: BallScrewState) -> None:
        row, record = records.row_of(state), records.state_record(state)
        limits = records.limits_record(state)
        self._post(self.view.hear, row, record, limits, time.monotonic())

    def _on_info(self, info: SurfaceInfo) -> None:
        """Take a surface; the node has been configured again, maybe with other parameters."""
        self._info, self._is_due = info, True
        self._parameters.drop()
        self.ask()
