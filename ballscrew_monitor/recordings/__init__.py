# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Bags in and out: read, write, play, record, replay, sum up."""
