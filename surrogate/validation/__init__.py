# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Published numbers beside those of this model: sources, our numbers, and the page of both."""
