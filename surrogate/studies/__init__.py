# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Our results beside published ones: all figures of one study, and numbers of others."""
