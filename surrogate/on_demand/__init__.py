# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""A full solve for whoever asks: one function, and a process that does it for the running node."""
