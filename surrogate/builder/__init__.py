# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""From a datasheet to a surface: the tiers, and sweeps over a catalogue."""
