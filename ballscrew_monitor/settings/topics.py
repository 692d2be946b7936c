# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Full names of the topics that a node in the root namespace reads and writes."""

from collections.abc import Mapping
from typing import Any

from ballscrew_monitor.core.inputs import Source
from ballscrew_monitor.settings.axis import is_configured
from ballscrew_monitor.settings.parameters import NODE_NAME


def absolute(topic: str) -> str:
    """Return the full name of a topic that a node in the root namespace names."""
    return topic if topic.startswith('/') else f'/{topic}'


def input_topics(values: Mapping[str, Any]) -> dict[str, str]:
    """Return topic and type of every input configured in the parameters `values`."""
    found = {}
    for axis in values['axes']:
        for source in reversed(Source):
            prefix = f'{axis}.{source.name.lower()}'
            topic = values[f'{prefix}.topic']
            if topic and is_configured(axis, values, source):
                found[absolute(topic)] = values[f'{prefix}.type']
    return found


def with_types(values: Mapping[str, Any], types: Mapping[str, str]) -> dict[str, Any]:
    """Return the parameters with each empty message type filled in from `types` by topic."""
    filled = dict(values)
    for name, topic in values.items():
        prefix, _, leaf = name.rpartition('.')
        if leaf == 'topic' and topic and not values[f'{prefix}.type']:
            filled[f'{prefix}.type'] = types.get(absolute(topic), '')
    return filled


def output(axis: str, name: str) -> str:
    """Return the full name of an output of the node, such as `state`."""
    return absolute(f'{NODE_NAME}/{axis}/{name}')
