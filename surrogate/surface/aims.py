# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Accuracy that a surface aims at; builders refine to it, checks judge by it."""

EFFICIENCY_TOLERANCE = 0.003
"""Error of the efficiency that is aimed at [-]."""
RCS_TOLERANCE, RCS_RELATIVE_TOLERANCE = 0.003, 0.05
"""Error of RCS that is aimed at [-]: absolute, and relative where that is more."""


def rcs_tolerance(rcs: float) -> float:
    """Return the error that is aimed at for an RCS [-]."""
    return max(RCS_TOLERANCE, RCS_RELATIVE_TOLERANCE * rcs)
