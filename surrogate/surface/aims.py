# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Aims: the optimal zone of a screw, and the accuracy of a surface."""

RCS_LIMIT, EFFICIENCY_LIMIT = 0.01, 0.85
"""Limits of the optimal zone unless others are stated [-]."""
LIGHT_LOAD = 0.25
"""Load below which no efficiency is judged, over the preload [-]."""
EFFICIENCY_TOLERANCE = 0.003
"""Error of the efficiency that is aimed at [-]."""
RCS_TOLERANCE, RCS_RELATIVE_TOLERANCE = 0.005, 0.1
"""Error of RCS that is aimed at [-]: absolute, and relative where that is more."""


def rcs_tolerance(rcs: float) -> float:
    """Return the error that is aimed at for an RCS [-]."""
    return max(RCS_TOLERANCE, RCS_RELATIVE_TOLERANCE * rcs)
