# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Lookup of the screw over speed, opposing load and temperature; all that the node loads.

Needs numpy alone.

"""

from surrogate.surface.aims import EFFICIENCY_LIMIT, LIGHT_LOAD, RCS_LIMIT
from surrogate.surface.batch import look_up_many
from surrogate.surface.contact_onset import ContactOnset, onset_of_surface, ZoneLimits
from surrogate.surface.correction import Correction, HasOperatingPoint
from surrogate.surface.fields import FIELDS
from surrogate.surface.file import SurfaceError
from surrogate.surface.interpolate import Found, leave, look_up, look_up_rest
from surrogate.surface.load_scan import is_inside, scan, scan_part
from surrogate.surface.lookup import Surface
from surrogate.surface.point import solved_point, SurfacePoint, Validity
from surrogate.surface.regime import FILM_RATIO_LIMITS, Regime, regime_of, REGIMES
from surrogate.surface.shipped import companion_path, find_surface, PRELOAD_SHARES, shipped_surface
from surrogate.surface.solved import SolvedPoint
from surrogate.surface.tables import SurfaceTables

__all__ = [
    'ContactOnset',
    'Correction',
    'EFFICIENCY_LIMIT',
    'FIELDS',
    'FILM_RATIO_LIMITS',
    'Found',
    'companion_path',
    'find_surface',
    'HasOperatingPoint',
    'is_inside',
    'leave',
    'LIGHT_LOAD',
    'look_up',
    'look_up_many',
    'look_up_rest',
    'onset_of_surface',
    'scan',
    'scan_part',
    'SurfaceTables',
    'PRELOAD_SHARES',
    'RCS_LIMIT',
    'Regime',
    'regime_of',
    'REGIMES',
    'shipped_surface',
    'solved_point',
    'SolvedPoint',
    'Surface',
    'SurfaceError',
    'SurfacePoint',
    'Validity',
    'ZoneLimits',
]
