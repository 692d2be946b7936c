# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Contact whose rough raceway rolls through it: marched in time, averaged over many transits.

interface holds settings and result. feed hands the raceway to the grid, row by row; step solves
one step after the other; sums measures each and averages them; march puts them together.

"""

from surrogate.ehl.moving.interface import MarchSettings, MarchStatus, Mean, MovingSolution
from surrogate.ehl.moving.march import march_contact

__all__ = ['MarchSettings', 'MarchStatus', 'Mean', 'MovingSolution', 'march_contact']
