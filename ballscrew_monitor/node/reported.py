# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Exceptions in lifecycle transitions are logged, before rclpy swallows them."""

from collections.abc import Callable
import functools
import traceback
from typing import Any

from rclpy.lifecycle import LifecycleNode, LifecycleState


def reported(transition: Callable[..., Any]) -> Callable[..., Any]:
    """Log an exception in a transition; rclpy swallows it and goes to error processing."""

    @functools.wraps(transition)
    def report(self: LifecycleNode, state: LifecycleState) -> Any:
        try:
            return transition(self, state)
        except Exception:
            self.get_logger().error(traceback.format_exc())
            raise

    return report
