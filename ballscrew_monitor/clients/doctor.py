# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
`ballscrew doctor`: the running ROS graph against a parameter file, without the `ros2` command.

Looks around, listens for some seconds as the node would, and hands what it has seen to the pure
half.

"""

from collections.abc import Callable, Mapping, Sequence
import contextlib
import functools
import math
import os
from pathlib import Path
import threading
import time
from typing import Any

from ballscrew_monitor.core.conversions import nanoseconds, Scaling, seconds
from ballscrew_monitor.core.fields import message_class, number_fields
from ballscrew_monitor.core.inputs import Input, InputSample, OpenInput, Source
from ballscrew_monitor.core.interrupts import interrupts, SIGNALLED
from ballscrew_monitor.core.links import Link, types_of
from ballscrew_monitor.judge.inputs import accept, take_refusal
from ballscrew_monitor.judge.monitor import fill, JointNames
from ballscrew_monitor.judge.records import Event, Memory, Settings
from ballscrew_monitor.judge.views import input_status_of
from ballscrew_monitor.messages.doctor import (
    findings,
    Heard,
    InputFacts,
    known_range,
    Surroundings,
)
from ballscrew_monitor.recordings.positions import MOVED, position_beside
from ballscrew_monitor.settings import axis as axis_settings
from ballscrew_monitor.settings import parameters, qos
from ballscrew_monitor.settings.parameters import absolute
import numpy as np
from rclpy.clock import Clock
from rclpy.node import Node
from rclpy.parameter import Parameter
from surrogate.files import InputError, json_text
from surrogate.units import digits

UDP = Path('/proc/net/udp')
PORTS, PER_DOMAIN, OFFSETS = 7400, 250, range(10, 60)  # DDSI-RTPS 2.3, 9.6.1
POLL = 0.05  # [s] longest wait before a signal is noticed
MOST_DOMAIN = 101  # above, the ports may be those of any client


def spun(
    node: Node, condition: Callable[[], Any], seconds: float, interrupted: Sequence[int] = ()
) -> Any:
    """Spin for some `seconds` [s] until a condition gives something, or until interrupted."""
    assert node.executor is not None
    end = time.monotonic() + seconds
    while not (value := condition()) and time.monotonic() < end and not interrupted:
        node.executor.spin_once(timeout_sec=POLL)
    return value


def surroundings(node: Node) -> Surroundings:
    """Return what is seen around the node."""
    domain, udp_table = node.context.get_domain_id(), ''
    with contextlib.suppress(OSError):
        udp_table = UDP.read_text()
    published = {
        name: tuple(types)
        for name, types in node.get_topic_names_and_types()
        if node.count_publishers(name)
    }
    return Surroundings(
        domain=domain,
        discovery=os.environ.get('ROS_AUTOMATIC_DISCOVERY_RANGE', 'SUBNET').upper(),
        localhost_only=os.environ.get('ROS_LOCALHOST_ONLY') == '1',
        nodes=tuple(sorted(name for name in node.get_node_names() if name != node.get_name())),
        topics=published,
        domains=tuple(other for other in domains_of(udp_table) if other != domain),
        use_sim_time=bool(node.get_parameter('use_sim_time').value),
    )


def domains_of(udp_table: str) -> list[int]:
    """Return the ROS domains whose ports a table of UDP sockets, as Linux writes it, shows."""
    domains = set()
    for line in udp_table.splitlines()[1:]:
        port = int(line.split()[1].rpartition(':')[2], 16) - PORTS
        domain, offset = divmod(port, PER_DOMAIN)
        if 0 <= domain <= MOST_DOMAIN and offset in OFFSETS:
            domains.add(domain)
    return sorted(domains)


class Hearing:
    """The messages of one input: their status, their numbers, and the time between them."""

    def __init__(
        self,
        source: Input,
        clock: Clock,
        *,
        timeout: int,
        max_future: int,
        max_lag: int,
        position: Input | None = None,
    ) -> None:
        """Begin to listen on a clock; times [ns]. A `position` may stand beside a velocity."""
        self._position = position
        self._positions: list[float] = []
        self._source, self._clock, self._max_future = source, clock, max_future
        self._memory, self._settings, self._joints = Memory(), Settings(), JointNames()
        self._settings.configured[source.source] = 1
        self._settings.timeout[source.source] = timeout
        self._settings.max_lag = max_lag
        self._record = Event()
        self.messages = 0
        self._numbers: list[float] = []
        self._last: int | None = None  # [ns]
        self._longest_gap = 0  # [ns]

    def take(self, message: Any) -> None:
        """Take a message."""
        self.messages += 1
        now = self._clock.now().nanoseconds
        event = self._source.read(message, now=now, max_future=self._max_future)
        fill(self._record, event)
        if self._position is not None:
            place = self._position.read(message, now=now, max_future=self._max_future)
            self._positions += [place.value] if isinstance(place, InputSample) else []
        if isinstance(event, InputSample):
            accept(self._memory, self._settings, self._record, event.value)
            scaling = self._source.scaling
            self._numbers.append((event.value - scaling.shift) / scaling.factor)
            self._longest_gap = max(self._longest_gap, self._silence(now))
            self._last = now
        else:
            self._joints.hear(event, self._memory)
            take_refusal(self._memory, self._record)

    def _silence(self, now: int) -> int:
        """Return the time since the last sample [ns], 0 before the first."""
        return 0 if self._last is None else now - self._last

    def heard(self) -> Heard:
        """Return what has come until now."""
        now = self._clock.now().nanoseconds
        source, joints = self._source.source, self._joints.of(self._source.source)
        return Heard(
            status=input_status_of(
                self._memory, self._settings, source, now, self._source.field, joints
            ),
            low=min(self._numbers, default=math.nan),
            high=max(self._numbers, default=math.nan),
            longest_gap=seconds(max(self._longest_gap, self._silence(now))),
            moved=bool(self._positions) and np.ptp(self._positions) > MOVED,
        )


HEALTHY, ILL = 0, 1
DISCOVERY = 3.0  # [s] longest wait for the publishers


def doctor(params: Path, *, seconds: float, as_json: bool = False) -> int:
    """
    Look at the graph for `seconds` [s], print what is found, and return the exit code.

    Raises InputError for a parameter file that the node would refuse.

    """
    if not 0.1 <= seconds <= 3600.0:
        raise InputError(f'--seconds is {seconds:g} s, allowed is 0.1 to 3600 s')
    values, given = parameters.read_file(params), parameters.read_ros_parameters(params)
    simulated = Parameter('use_sim_time', value=bool(given.get('use_sim_time', False)))
    started = qos.started_node('ballscrew_doctor', parameter_overrides=[simulated])
    with interrupts(threading.Event()) as interrupted, started as node:
        examination = Examination(node, values, given, interrupted)
        facts = examination.listen(seconds)
        around = surroundings(node)
    if interrupted:
        return SIGNALLED + interrupted[0]
    wrong = [*examination.refused, *findings(around, facts, seconds)]
    print(_record(wrong, facts) if as_json else _page(wrong, facts, around))
    return ILL if wrong else HEALTHY


class Examination:
    """What the parameters ask for, listened to; `refused` is what the node would not take."""

    def __init__(
        self,
        node: Node,
        values: Mapping[str, Any],
        given: Mapping[str, Any],
        interrupted: Sequence[int],
    ) -> None:
        """Read the surfaces and find the publishers; no longer than until interrupted."""
        self.refused: list[str] = []
        self._spin = functools.partial(spun, node, interrupted=interrupted)
        self._node, self._values, self._given = node, values, given
        self._wanted = [
            (axis, source)
            for axis in values['axes']
            for source in reversed(Source)
            if parameters.is_configured(axis, values, source)
            and self._try(axis_settings.scaling_of, axis, values, source, 1.0) is not None
        ]
        for axis in values['axes']:
            self._try(axis_settings.derivation_of, axis, values)
        topics = {self._topic(*wanted) for wanted in self._wanted}
        self._try(qos.check_overrides, given, topics)
        self._surfaces = {
            axis: self._try(axis_settings.load_surface, axis, values) for axis in values['axes']
        }
        self._spin(lambda: all(map(node.count_publishers, topics)), DISCOVERY)

    def _try(self, make: Callable[..., Any], *given: Any) -> Any:
        """Return what is made, or None and note why it cannot be."""
        try:
            return make(*given)
        except InputError as error:
            if str(error) not in self.refused:
                self.refused.append(str(error))
            return None

    def _value(self, axis: str, source: Source, leaf: str) -> Any:
        return self._values[f'{axis}.{source.name.lower()}.{leaf}']

    def _topic(self, axis: str, source: Source) -> str:
        topic = absolute(self._value(axis, source, 'topic'))
        return axis_settings.resolved_topic(axis, source, topic, self._node.resolve_topic_name)

    def listen(self, seconds: float) -> list[InputFacts]:
        """Return the facts of every input after listening to those that can be."""
        hearings: dict[tuple[str, Source], Hearing] = {}
        for axis, source in self._wanted:
            link, type_name, opened = self._look(axis, source)
            if not isinstance(opened, Input) or type_name not in types_of(link):
                continue
            hearing = hearings[axis, source] = Hearing(
                opened,
                self._node.get_clock(),
                timeout=nanoseconds(self._value(axis, source, 'timeout')),
                max_future=nanoseconds(self._values[f'{axis}.max_future']),
                max_lag=nanoseconds(self._values[f'{axis}.max_lag']),
                position=self._position(axis, source, type_name, opened.scaling),
            )
            self._node.create_subscription(
                opened.message_type, link.topic, hearing.take, qos.input_qos()
            )
        # The way to a publisher takes its time on a busy machine; none of it is silence.
        self._spin(lambda: all(hearing.messages for hearing in hearings.values()), DISCOVERY)
        self._spin(lambda: False, seconds)
        return [self._facts(*wanted, hearings.get(wanted)) for wanted in self._wanted]

    def _look(self, axis: str, source: Source) -> tuple[Link, str, Input | str | None]:
        """
        Return how an input is connected, its message type, and the input or why there is none.

        The type is that of the publishers unless one is asked for, empty while it is not known.

        """
        topic, surface = self._topic(axis, source), self._surfaces[axis]
        link = Link(
            topic=topic,
            type_name=self._value(axis, source, 'type'),
            publishers=qos.publishers_on(self._node, topic),
            reliability=qos.overridden(self._given, topic, 'reliability'),
            durability=qos.overridden(self._given, topic, 'durability'),
        )
        types = types_of(link)
        type_name = link.type_name or (types[0] if len(types) == 1 else '')
        if not type_name:
            return link, '', None
        lead, field = surface.lead if surface else 1.0, self._value(axis, source, 'field')
        try:
            scaling = axis_settings.scaling_of(axis, self._values, source, lead)
            opened = OpenInput(source=source, topic=topic, field=field, scaling=scaling)
            return link, type_name, opened.close(type_name)
        except InputError as error:
            return link, type_name, str(error)

    def _position(
        self, axis: str, source: Source, type_name: str, scaling: Scaling
    ) -> Input | None:
        """Return what reads the position beside the velocity of an axis, if there is one."""
        beside = position_beside(self._values, axis, type_name) if source is Source.SPEED else None
        if beside is None:
            return None
        line = Scaling(factor=scaling.factor, shift=0.0)
        topic = self._topic(axis, source)
        return OpenInput(source=source, topic=topic, field=beside[0], scaling=line).close(
            type_name
        )

    def _facts(self, axis: str, source: Source, hearing: Hearing | None) -> InputFacts:
        surface, unit = self._surfaces[axis], self._value(axis, source, 'unit')
        link, type_name, opened = self._look(axis, source)
        scaled = surface is not None and source is not Source.TORQUE
        numbers: tuple[str, ...] = ()
        if isinstance(opened, str):
            with contextlib.suppress(InputError):
                numbers = number_fields(message_class(type_name))
        return InputFacts(
            axis=axis,
            source=source,
            link=link,
            timeout=self._value(axis, source, 'timeout'),
            unit=unit,
            scalings=axis_settings.scalings_of(axis, self._values, source, surface.lead)
            if scaled
            else {},
            known=known_range(surface, source, unit),
            heard=hearing.heard() if hearing else None,
            problem=opened if isinstance(opened, str) else '',
            numbers=numbers,
            beside=(position_beside(self._values, axis, type_name) or ('', ''))
            if source is Source.SPEED
            else ('', ''),
        )


def _page(wrong: list[str], facts: list[InputFacts], around: Surroundings) -> str:
    lines = [
        f'ROS domain {around.domain}, discovery range {around.discovery}: '
        f'nodes {len(around.nodes)}, topics {len(around.topics)}'
    ]
    lines += [_line(input_facts) for input_facts in facts]
    lines.append(f'findings: {len(wrong) or "none"}')
    return '\n'.join(lines + [f'* {text}' for text in wrong])


def _line(facts: InputFacts) -> str:
    types = ', '.join(types_of(facts.link)) or 'no publisher'
    head = f'{facts.parameter}: {facts.link.topic} ({types})'
    if facts.heard is None:
        return head
    heard, status = facts.heard, facts.heard.status
    parts = [f'{head}: {status.received} messages']
    parts += [f'{status.rate:.4g} Hz'] if math.isfinite(status.rate) else []
    parts += (
        [f'stamps {digits(1e3 * status.lag, 2)} ms behind'] if math.isfinite(status.lag) else []
    )
    if math.isfinite(heard.low):
        parts.append(f'{heard.low:.4g} to {heard.high:.4g} {facts.unit}')
    return ', '.join(parts)


def _record(wrong: list[str], facts: list[InputFacts]) -> str:
    inputs = {
        each.parameter: {
            'topic': each.link.topic,
            'types': types_of(each.link),
            'received': each.heard.status.received if each.heard else 0,
            'rate_Hz': each.heard.status.rate if each.heard else None,
            'lag_s': each.heard.status.lag if each.heard else None,
        }
        for each in facts
    }
    return json_text({'findings': wrong, 'inputs': inputs})
