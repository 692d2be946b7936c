# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Builders of surfaces from datasheets: the tiers, and sweeps over a catalogue."""
