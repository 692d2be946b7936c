# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Sentences, diagnostics and messages made from what was judged; nothing is sent here."""
