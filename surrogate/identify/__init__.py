# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Parasitic torque and more, identified from torque that was measured without load."""
