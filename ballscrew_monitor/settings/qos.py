# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
QoS of the inputs, what `qos_overrides` may change of it, and what publishers offer.

And a node of a command in the graph, from its start to its end.

"""

from collections.abc import Collection, Iterator, Mapping
import contextlib
from typing import Any

from ballscrew_monitor.core.links import Publisher
import rclpy
from rclpy import qos
from rclpy.duration import Duration
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from rclpy.qos_overriding_options import QoSOverridingOptions
from rclpy.signals import SignalHandlerOptions
from surrogate.files import InputError

DEPTH, MOST_DEPTH = 1000, 100_000
POLICIES = {
    'history': ('keep_last', 'keep_all'),
    'depth': (),
    'reliability': ('best_effort', 'reliable'),
    'durability': ('volatile', 'transient_local'),
}
"""What may be overridden, and the values of it that are words."""
OF_ROS = frozenset({'/clock', '/parameter_events', '/rosout'})
PREFIX = 'qos_overrides'
LATCHED_QOS = qos.QoSProfile(
    depth=1,
    reliability=qos.QoSReliabilityPolicy.RELIABLE,
    durability=qos.QoSDurabilityPolicy.TRANSIENT_LOCAL,
)
"""QoS of what a late joiner is to hear too."""


STEADY_PERIOD = 1.0  # [s] to which `publish_period` may rise without a change of the promise


def longest_period(axis: str, values: Mapping[str, Any]) -> float:
    """Return the longest publish period [s] for which the deadline of a state still holds."""
    return max(STEADY_PERIOD, float(values[f'{axis}.publish_period']))


def state_qos(axis: str, values: Mapping[str, Any], *, simulated: bool) -> qos.QoSProfile:
    """
    Return the QoS of the state of an axis: while the node is active, one comes by the deadline.

    After the last sample it takes the timeout until the ticks speak, and they keep the period.
    Simulated time may stand, so that nothing can be promised in it.

    """
    promise = qos.QoSProfile(depth=10, reliability=qos.QoSReliabilityPolicy.RELIABLE)
    if not simulated:
        ticks = 3.0 * values['tick_period']
        longest = longest_period(axis, values) + values[f'{axis}.speed.timeout'] + ticks
        promise.deadline = Duration(seconds=longest)
    return promise


def input_qos() -> qos.QoSProfile:
    """Return the QoS of an input, which suits every publisher; rclpy writes overrides into it."""
    return qos.QoSProfile(
        history=qos.QoSHistoryPolicy.KEEP_LAST,
        depth=DEPTH,
        reliability=qos.QoSReliabilityPolicy.BEST_EFFORT,
        durability=qos.QoSDurabilityPolicy.VOLATILE,
    )


def overriding_options() -> QoSOverridingOptions:
    """Return what rclpy declares as parameters of a subscription."""
    return QoSOverridingOptions([qos.QoSPolicyKind[name.upper()] for name in POLICIES])


def check_overrides(given: Mapping[str, Any], topics: Collection[str]) -> None:
    """Raise InputError for an override that is of no input on the full names `topics`, or bad."""
    for name, value in given.items():
        prefix, _, rest = name.partition('.')
        topic, _, rest = rest.partition('.')
        if prefix != PREFIX or topic in OF_ROS:
            continue
        entity, _, policy = rest.partition('.')
        if topic not in topics or entity != 'subscription' or policy not in POLICIES:
            raise InputError(
                f'parameter {name} is of no input, allowed is {PREFIX}.TOPIC.subscription.POLICY '
                f'with TOPIC of {", ".join(sorted(topics))} and POLICY of {", ".join(POLICIES)}'
            )
        if words := POLICIES[policy]:
            good, allowed = value in words, f'one of {", ".join(words)}'
        else:
            good = type(value) is int and 1 <= value <= MOST_DEPTH
            allowed = f'a whole number, 1 to {MOST_DEPTH}'
        if not good:
            raise InputError(f'parameter {name} is {value!r}, allowed is {allowed}')


def overridden(given: Mapping[str, Any], topic: str, policy: str) -> str:
    """Return the word that is asked for in a `policy` of the input on `topic`."""
    default = POLICIES[policy][0]
    return str(given.get(f'{PREFIX}.{topic}.subscription.{policy}', default))


def publishers_on(node: Node, topic: str) -> tuple[Publisher, ...]:
    """Return the publishers on the full name `topic` that the ROS graph shows."""
    return tuple(
        Publisher(
            type_name=info.topic_type,
            reliability=info.qos_profile.reliability.name.lower(),
            durability=info.qos_profile.durability.name.lower(),
            node=f'{info.node_namespace.rstrip("/")}/{info.node_name}',
        )
        for info in node.get_publishers_info_by_topic(topic)
    )


@contextlib.contextmanager
def started_node(name: str, domain: int | None = None, **options: Any) -> Iterator[Node]:
    """
    Start ROS and a node with an executor, until the end; raises InputError where that fails.

    The `domain` is that of the environment unless stated.

    """
    context = rclpy.Context()
    try:
        rclpy.init(
            context=context, domain_id=domain, signal_handler_options=SignalHandlerOptions.NO
        )
    except RuntimeError as error:  # such as a domain that is no number
        raise InputError(f'ROS cannot start: {" ".join(str(error).split())}') from None
    quiet = {'enable_rosout': False, 'start_parameter_services': False}
    node = rclpy.create_node(name, context=context, **(quiet | options))
    executor = SingleThreadedExecutor(context=context)
    executor.add_node(node)
    try:
        yield node
    finally:
        executor.shutdown()
        node.destroy_node()
        rclpy.shutdown(context=context)
