# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
`ballscrew doctor`: the running ROS graph against a parameter file, without the `ros2` command.

Listens for some seconds as the node would, and hands what it has seen to the pure half.

"""

from collections.abc import Callable, Iterator, Mapping
import contextlib
import functools
import math
from pathlib import Path
import threading
import time
from typing import Any

from ballscrew_monitor.clients.surroundings import Hearing, surroundings
from ballscrew_monitor.core.conversions import nanoseconds
from ballscrew_monitor.core.fields import message_class, number_fields
from ballscrew_monitor.core.inputs import Input, make_input, Source
from ballscrew_monitor.core.interrupts import interrupts, SIGNALLED
from ballscrew_monitor.core.links import Link, types_of
from ballscrew_monitor.messages.doctor import findings, InputFacts, known_range, Surroundings
from ballscrew_monitor.settings import parameters
from ballscrew_monitor.settings.axis import (
    derivation_of,
    is_configured,
    load_surface,
    scaling_of,
    scalings_of,
)
from ballscrew_monitor.settings.middleware import notice
from ballscrew_monitor.settings.qos import check_overrides, input_qos, overridden, publishers_on
from ballscrew_monitor.settings.topics import absolute
import rclpy
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.signals import SignalHandlerOptions
from surrogate.files import InputError, json_text
from surrogate.surface import Surface

HEALTHY, ILL = 0, 1
DISCOVERY = 3.0  # [s] longest wait for the publishers
POLL = 0.05  # [s]


def doctor(params: Path, *, seconds: float, as_json: bool = False) -> int:
    """
    Look at the graph for `seconds` [s], print what is found, and return the exit code.

    Raises InputError for a parameter file that the node would refuse.

    """
    if not 0.1 <= seconds <= 3600.0:
        raise InputError(f'--seconds is {seconds:g} s, allowed is 0.1 to 3600 s')
    values, given = parameters.read_file(params), parameters.read_ros_parameters(params)
    stop = threading.Event()
    with interrupts(stop) as interrupted, _node(bool(given.get('use_sim_time', False))) as node:
        examination = Examination(node, values, given, stop)
        facts = examination.listen(seconds)
        around = surroundings(node)
    if interrupted:
        return SIGNALLED + interrupted[0]
    found = [*filter(None, [notice()]), *examination.refused, *findings(around, facts, seconds)]
    print(_record(found, facts) if as_json else _page(found, facts, around))
    return ILL if found else HEALTHY


@contextlib.contextmanager
def _node(simulated: bool) -> Iterator[Node]:
    try:
        rclpy.init(signal_handler_options=SignalHandlerOptions.NO)
    except RuntimeError as error:  # such as a domain that is no number
        raise InputError(f'ROS cannot start: {" ".join(str(error).split())}') from None
    node = rclpy.create_node(
        'ballscrew_doctor',
        enable_rosout=False,
        start_parameter_services=False,
        parameter_overrides=[Parameter('use_sim_time', value=simulated)],
    )
    try:
        yield node
    finally:
        node.destroy_node()
        rclpy.shutdown()


class Examination:
    """What the parameters ask for, listened to; `refused` is what the node would not take."""

    def __init__(
        self,
        node: Node,
        values: Mapping[str, Any],
        given: Mapping[str, Any],
        stop: threading.Event,
    ) -> None:
        """Read the surfaces and find the publishers; no longer than until `stop` is set."""
        self.refused: list[str] = []
        self._stop = stop
        self._node, self._values, self._given = node, values, given
        self._wanted = [
            (axis, source)
            for axis in values['axes']
            for source in reversed(Source)
            if is_configured(axis, values, source)
        ]
        self._wanted = [one for one in self._wanted if self._can_scale(*one)]
        for axis in values['axes']:
            self._try(functools.partial(derivation_of, axis, values))
        topics = {self._topic(*wanted) for wanted in self._wanted}
        self._try(lambda: check_overrides(given, topics))
        self._surfaces: dict[str, Surface | None] = {
            axis: self._try(functools.partial(load_surface, axis, values))
            for axis in values['axes']
        }
        self._executor = SingleThreadedExecutor()
        self._executor.add_node(node)
        self._spin(DISCOVERY, lambda: all(map(node.count_publishers, topics)))

    def _try(self, make: Callable[[], Any]) -> Any:
        """Return what is made, or None and note why it cannot be."""
        try:
            return make()
        except InputError as error:
            if str(error) not in self.refused:
                self.refused.append(str(error))
            return None

    def _can_scale(self, axis: str, source: Source) -> bool:
        """Tell whether the unit of an input is complete, and note why it is not."""
        scale = functools.partial(scaling_of, axis, self._values, source, 1.0)
        return self._try(scale) is not None

    def _spin(self, seconds: float, over: Callable[[], bool] = lambda: False) -> None:
        end = time.monotonic() + seconds
        while time.monotonic() < end and not (over() or self._stop.is_set()):
            self._executor.spin_once(timeout_sec=POLL)

    def _value(self, axis: str, source: Source, leaf: str) -> Any:
        return self._values[f'{axis}.{source.name.lower()}.{leaf}']

    def _topic(self, axis: str, source: Source) -> str:
        """Return the full name of a topic; raises InputError for what is no name."""
        topic = absolute(self._value(axis, source, 'topic'))
        try:
            return str(self._node.resolve_topic_name(topic))
        except RuntimeError:
            raise InputError(
                f'parameter {axis}.{source.name.lower()}.topic is {topic!r}, no topic name'
            ) from None

    def listen(self, seconds: float) -> list[InputFacts]:
        """Return the facts of every input after listening to those that can be."""
        hearings = {wanted: self._hearing(*wanted) for wanted in self._wanted}
        # The way to a publisher takes its time on a busy machine; none of it is silence.
        open_ones = [one for one in hearings.values() if one is not None]
        self._spin(DISCOVERY, lambda: all(one.messages for one in open_ones))
        self._spin(seconds)
        self._executor.shutdown()
        return [self._facts(*wanted, hearings[wanted]) for wanted in self._wanted]

    def _link(self, axis: str, source: Source) -> Link:
        topic = self._topic(axis, source)
        return Link(
            topic=topic,
            type_name=self._value(axis, source, 'type'),
            publishers=publishers_on(self._node, topic),
            reliability=overridden(self._given, topic, 'reliability'),
            durability=overridden(self._given, topic, 'durability'),
        )

    def _type(self, link: Link) -> str:
        """Return the type that is asked for, or that of the publishers; empty if not known."""
        types = types_of(link)
        return link.type_name or (types[0] if len(types) == 1 else '')

    def _input(self, axis: str, source: Source, type_name: str) -> Input:
        """Return the input as the node would make it; raises InputError where it would not."""
        surface = self._surfaces[axis]
        return make_input(
            source,
            topic=self._topic(axis, source),
            type_name=type_name,
            field=self._value(axis, source, 'field'),
            scaling=scaling_of(axis, self._values, source, surface.lead if surface else 1.0),
        )

    def _hearing(self, axis: str, source: Source) -> Hearing | None:
        """Begin to listen to an input, if it can be."""
        link = self._link(axis, source)
        type_name = self._type(link)
        if type_name not in types_of(link) or self._problem(axis, source, type_name)[0]:
            return None
        made = self._input(axis, source, type_name)
        hearing = Hearing(
            made,
            self._node.get_clock(),
            timeout=nanoseconds(self._value(axis, source, 'timeout')),
            max_future=nanoseconds(self._values[f'{axis}.max_future']),
            max_lag=nanoseconds(self._values[f'{axis}.max_lag']),
        )
        self._node.create_subscription(made.message_type, link.topic, hearing.take, input_qos())
        return hearing

    def _facts(self, axis: str, source: Source, hearing: Hearing | None) -> InputFacts:
        surface, link = self._surfaces[axis], self._link(axis, source)
        problem, numbers = self._problem(axis, source, self._type(link))
        return InputFacts(
            axis=axis,
            source=source,
            link=link,
            timeout=self._value(axis, source, 'timeout'),
            unit=self._value(axis, source, 'unit'),
            scalings=self._scalings(axis, source),
            known=known_range(surface, source, self._value(axis, source, 'unit')),
            heard=hearing.heard() if hearing else None,
            problem=problem,
            numbers=numbers,
        )

    def _problem(self, axis: str, source: Source, type_name: str) -> tuple[str, tuple[str, ...]]:
        """Return why the field cannot be read of a type, and what could; empty if it can."""
        try:
            if type_name:
                self._input(axis, source, type_name)
        except InputError as error:
            return str(error), _numbers_of(type_name)
        return '', ()

    def _scalings(self, axis: str, source: Source) -> dict[str, Any]:
        surface = self._surfaces[axis]
        if surface is None or source is Source.TORQUE:
            return {}
        return scalings_of(axis, self._values, source, surface.lead)


def _numbers_of(type_name: str) -> tuple[str, ...]:
    try:
        return number_fields(message_class(type_name))
    except InputError:
        return ()


def _page(found: list[str], facts: list[InputFacts], around: Surroundings) -> str:
    """Return what was seen and found, for a person."""
    lines = [
        f'ROS domain {around.domain}, discovery range {around.discovery}: '
        f'nodes {len(around.nodes)}, topics {len(around.topics)}'
    ]
    lines += [_line(one) for one in facts]
    lines.append(f'findings: {len(found) or "none"}')
    return '\n'.join(lines + [f'* {text}' for text in found])


def _line(facts: InputFacts) -> str:
    types = ', '.join(types_of(facts.link)) or 'no publisher'
    head = f'{facts.parameter}: {facts.link.topic} ({types})'
    if facts.heard is None:
        return head
    heard, status = facts.heard, facts.heard.status
    parts = [f'{head}: {status.received} messages']
    parts += [f'{status.rate:.4g} Hz'] if math.isfinite(status.rate) else []
    parts += [f'stamps {1e3 * status.lag:.2g} ms behind'] if math.isfinite(status.lag) else []
    if math.isfinite(heard.low):
        parts.append(f'{heard.low:.4g} to {heard.high:.4g} {facts.unit}')
    return ', '.join(parts)


def _record(found: list[str], facts: list[InputFacts]) -> str:
    """Return the same as JSON."""
    inputs = {
        one.parameter: {
            'topic': one.link.topic,
            'types': types_of(one.link),
            'received': one.heard.status.received if one.heard else 0,
            'rate_Hz': one.heard.status.rate if one.heard else None,
            'lag_s': one.heard.status.lag if one.heard else None,
        }
        for one in facts
    }
    return json_text({'findings': found, 'inputs': inputs})
