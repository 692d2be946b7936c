# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Recordings judged by arrays: the same judgements as sample by sample, many at once."""
