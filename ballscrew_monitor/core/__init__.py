# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The pure part of the online half: no ROS, no clock; time is an argument."""
