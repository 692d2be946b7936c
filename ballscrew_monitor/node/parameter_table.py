# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Every parameter of the node, declared once: its default, what is allowed, and a sentence."""

from ballscrew_monitor.node.axis_parameters import AXIS_ROWS
from ballscrew_monitor.node.node_parameters import NODE_ROWS

__all__ = ['AXIS_ROWS', 'NODE_ROWS']
