# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Contact whose rough raceway rolls through it: marched in time, averaged over many transits.

interface holds settings and result. feed hands the raceway to the grid, row by row; step solves
one step after the other; sums measures each and averages them; run goes from place to place;
march puts them together, at one speed, ramp while it changes. line is a strip of a long contact,
for waves that are too short for a grid over the whole.

"""

from surrogate.ehl.moving.interface import MarchSettings, MarchStatus, MovingSolution
from surrogate.ehl.moving.line import strip_at, StripContact
from surrogate.ehl.moving.march import march_contact, march_strip
from surrogate.ehl.moving.ramp import ramp_contact, ramp_strip, SpeedRamp

__all__ = [
    'MarchSettings',
    'MarchStatus',
    'MovingSolution',
    'SpeedRamp',
    'StripContact',
    'march_contact',
    'march_strip',
    'ramp_contact',
    'ramp_strip',
    'strip_at',
]
