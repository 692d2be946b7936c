# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Bags in and out: read, write, play, record, replay, sum up."""

import os

# Each thread of the reader of tables holds about 100 MB, however many processors there are.
os.environ.setdefault('POLARS_MAX_THREADS', '2')
