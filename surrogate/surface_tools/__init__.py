# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Tools for a surface file: check, describe, query, compare, export, draw."""
