# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The few numbers of a state that most consumers want, each as a topic of a standard type."""

from collections.abc import Callable
from typing import Any

from ballscrew_monitor.core.judgement import Level
from ballscrew_monitor.core.state import State
from rclpy.lifecycle import LifecycleNode
from std_msgs.msg import Bool, Float64, String

TYPES = {
    'efficiency': Float64,
    'rcs': Float64,
    'film_ratio': Float64,
    'regime': String,
    'out_of_zone': Bool,
}


def plain_values(state: State) -> dict[str, float | str | bool]:
    """Return what each plain topic says of a state; numbers that are not known are NaN."""
    result = state.estimate
    return {
        'efficiency': float(result.efficiency),
        'rcs': float(result.rcs),
        'film_ratio': float(result.film_ratio),
        'regime': result.regime.name,
        'out_of_zone': state.level is Level.WARN and not state.shelving.until,
    }


class PlainTopics:
    """The plain topics of one axis."""

    def __init__(self, node: LifecycleNode, axis: str, make: Callable[..., Any], qos: Any) -> None:
        """Make the publishers by `make`, which is given type, name and `qos`."""
        self._node = node
        self._publishers = {
            name: make(kind, f'~/{axis}/plain/{name}', qos) for name, kind in TYPES.items()
        }

    def publish(self, state: State) -> None:
        """Publish a state."""
        for name, value in plain_values(state).items():
            self._publishers[name].publish(TYPES[name](data=value))

    def close(self) -> None:
        """Destroy the publishers."""
        for publisher in self._publishers.values():
            self._node.destroy_lifecycle_publisher(publisher)
