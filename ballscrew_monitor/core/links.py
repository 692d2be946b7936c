# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Connections of the inputs in the ROS graph, and why nothing comes over one."""

import dataclasses

BEST_EFFORT, RELIABLE = 'best_effort', 'reliable'
VOLATILE, TRANSIENT_LOCAL = 'volatile', 'transient_local'


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class Publisher:
    """A publisher on a topic: its QoS in the words of a `qos_overrides` parameter, its node."""

    type_name: str
    reliability: str = BEST_EFFORT
    durability: str = VOLATILE
    node: str = ''


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class Link:
    """
    How an input is connected: what it asks for, and which publishers there are.

    An empty `type_name` asks for that of the publisher; `problem` is why that does not serve.
    While publishers are `matched` the others need not be known. `several` tells whether more than
    one of them sends the input, None: not known.

    """

    topic: str
    type_name: str
    matched: int = 0
    publishers: tuple[Publisher, ...] = ()
    reliability: str = BEST_EFFORT
    durability: str = VOLATILE
    problem: str = ''
    several: bool | None = False


def link_reason(link: Link, parameter: str, *, seen: bool = False) -> str:
    """
    Return why nothing comes over the link of the input `parameter` and what mends it.

    Empty when the link is well. An input that was `seen` has lost its publisher, any other has
    none yet.

    """
    if link.problem:
        return f'{link.problem}: set {parameter}.field, or {parameter}.type'
    if link.matched:
        return ''
    if not link.publishers:
        if seen:
            return f'the publisher on {link.topic} is gone'
        return f'no publisher yet on {link.topic}: start it, or set {parameter}.topic'
    types = types_of(link)
    carried = f'{link.topic} carries {" and ".join(types)}'
    if not link.type_name and len(types) != 1:
        return f'{carried}: set {parameter}.type to one of them'
    if link.type_name and link.type_name not in types:
        return f'{carried}, expected is {link.type_name}: set {parameter}.type to {types[0]}'
    # What no publisher of the type offers of the QoS that is asked for.
    policies = (('reliability', RELIABLE, BEST_EFFORT), ('durability', TRANSIENT_LOCAL, VOLATILE))
    unfit = [
        [
            (policy, asked, offered)
            for policy, asked, offered in policies
            if (getattr(link, policy), getattr(publisher, policy)) == (asked, offered)
        ]
        for publisher in link.publishers
        if publisher.type_name == link.type_name
    ]
    if not unfit or not all(unfit):
        return ''
    policy, asked, offered = unfit[0][0]
    return (
        f'QoS does not fit on {link.topic}, offered is {offered} and asked for is {asked}: '
        f'set qos_overrides.{link.topic}.subscription.{policy} to {offered}'
    )


def several_reason(link: Link, parameter: str) -> str:
    """Return which publishers send the input `parameter`, where one is expected, and the cure."""
    axis = parameter.partition('.')[0]
    return f'{senders(link)} send it: stop all but one, or set {axis}.one_source to false'


def senders(link: Link) -> str:
    """Return by whom a topic is published, in words."""
    nodes = ', '.join(sorted({publisher.node for publisher in link.publishers} - {''}))
    return ' '.join(filter(None, ('several publishers on', link.topic, nodes and f'({nodes})')))


def types_of(link: Link) -> list[str]:
    """Return the message types that are published on the topic."""
    return sorted({publisher.type_name for publisher in link.publishers})
