# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Health of an axis: normal or worse, by what, and how long still; no ROS, no clock."""
