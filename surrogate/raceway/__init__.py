# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Rough raceways: fractal and measured surfaces, and how a fractal one is identified."""
