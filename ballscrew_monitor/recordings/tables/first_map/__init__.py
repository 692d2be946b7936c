# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Parts of a first map of a log: columns, times, units, signs, the machine and its questions."""
