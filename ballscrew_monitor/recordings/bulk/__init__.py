# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Entries of recordings: read, decoded and ordered by arrays."""
