# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""A first map of a log: columns, times, units, signs, machine, and questions."""
