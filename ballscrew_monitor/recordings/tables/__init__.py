# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Machine logs that are tables, CSV or Parquet: read, guessed at, made into bags."""
