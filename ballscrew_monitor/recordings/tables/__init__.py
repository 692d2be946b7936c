# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Machine logs that are tables, CSV, Parquet or xlsx: read, guessed at, made into bags."""
