# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Closed-form tier: published laws of the ball screw, each a function with author and year."""
