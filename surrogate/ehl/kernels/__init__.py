# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Compiled kernels of the contact solver: arrays in, arrays out."""
