# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Online monitor of the lubrication and efficiency of a ball screw."""
