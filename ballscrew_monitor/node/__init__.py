# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The lifecycle node of one axis or many: intake, publishers, services and action."""
