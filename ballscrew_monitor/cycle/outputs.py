# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The topics of a run: what the node reads and what it says."""

from collections.abc import Mapping
from typing import Any

from ballscrew_monitor.node.parameters import NODE_NAME
from ballscrew_monitor.recordings.bag_writer import Offer, Topic
from ballscrew_monitor.recordings.replay import absolute, input_topics

DIAGNOSTICS = Topic(
    name='/diagnostics', type_name='diagnostic_msgs/msg/DiagnosticArray', offer=Offer.RELIABLE
)
LATCHED = {'out_of_zone': 'OutOfZone', 'surface_info': 'SurfaceInfo'}


def output(axis: str, name: str) -> str:
    """Return the full name of an output of the node, such as `state`."""
    return absolute(f'{NODE_NAME}/{axis}/{name}')


def recorded_topics(values: Mapping[str, Any]) -> list[Topic]:
    """Return what a run records: inputs, outputs, and the latched outputs last."""
    inputs = [
        Topic(name=name, type_name=kind, offer=Offer.SENSOR)
        for name, kind in input_topics(values).items()
    ]
    states = [_topic(axis, 'state', 'BallScrewState', Offer.RELIABLE) for axis in values['axes']]
    latched = [
        _topic(axis, name, kind, Offer.LATCHED)
        for name, kind in LATCHED.items()
        for axis in values['axes']
    ]
    return [*inputs, *states, DIAGNOSTICS, *latched]


def _topic(axis: str, name: str, kind: str, offer: Offer) -> Topic:
    return Topic(name=output(axis, name), type_name=f'ballscrew_msgs/msg/{kind}', offer=offer)
