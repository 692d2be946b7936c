# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""One contact as a file: its case, its solve, its record and its pictures."""
