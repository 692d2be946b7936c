# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""What people do with a surface file: check, describe, query, compare, export, draw."""
