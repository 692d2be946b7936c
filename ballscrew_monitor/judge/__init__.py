# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The judgement of one axis, in plain functions over records that are interpreted or compiled."""
