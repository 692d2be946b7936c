# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""A replayed recording as a page, tables and a judged bag; of many recordings an overview."""
