# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Parameters declared once, the axes built from them, names and QoS of topics, middleware."""
