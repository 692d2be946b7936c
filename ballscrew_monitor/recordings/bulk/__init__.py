# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Events of recordings: found, decoded and ordered by arrays."""
