# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The topics that a run records: what the node reads and what it says."""

from collections.abc import Mapping
from typing import Any

from ballscrew_monitor.recordings.bag_writer import Offer, Topic
from ballscrew_monitor.settings.topics import input_topics, output

DIAGNOSTICS = Topic(
    name='/diagnostics', type_name='diagnostic_msgs/msg/DiagnosticArray', offer=Offer.RELIABLE
)
LATCHED = {'out_of_zone': 'OutOfZone', 'surface_info': 'SurfaceInfo'}


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
