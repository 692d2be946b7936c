# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""What a first map says of a log: columns, times, units, signs, machine, and what it asks."""
