# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The judgement of one axis: events, memory, step and rows; nothing else judges."""
