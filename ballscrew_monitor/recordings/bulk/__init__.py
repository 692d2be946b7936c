# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The messages of a recording as arrays of entries, in the order of judging."""
