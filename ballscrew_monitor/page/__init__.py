# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The live page of running nodes, or of a recording, in a process of its own."""
