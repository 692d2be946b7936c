# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Datasheets out of a few values of a catalogue; the rest is derived, or typical with a range."""
