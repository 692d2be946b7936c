# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Solves as tasks: kept by their content, run on processes of this machine or on a cluster."""
