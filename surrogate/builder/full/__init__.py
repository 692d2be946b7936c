# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Surfaces of the full tier: which points are solved, and what becomes of them."""
