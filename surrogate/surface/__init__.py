# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Lookup of the screw over speed, opposing load and temperature; all that the node loads.

Needs numpy alone.

"""

from surrogate.surface.correction import Correction
from surrogate.surface.lookup import (
    FIELDS,
    find_surface,
    shipped_surface,
    Surface,
    SurfaceError,
    SurfacePoint,
    Validity,
)
from surrogate.surface.point import solved_point
from surrogate.surface.regime import FILM_RATIO_LIMITS, Regime, regime_of, REGIMES

__all__ = [
    'Correction',
    'solved_point',
    'FIELDS',
    'FILM_RATIO_LIMITS',
    'find_surface',
    'Regime',
    'regime_of',
    'REGIMES',
    'shipped_surface',
    'Surface',
    'SurfaceError',
    'SurfacePoint',
    'Validity',
]
