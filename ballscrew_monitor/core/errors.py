# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Errors that a user can mend."""


class InputError(ValueError):
    """Bad input; the text is one sentence: what, where, value, unit and what is allowed."""
