# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Our results beside those of the published study: what is solved, drawn and said of it."""
