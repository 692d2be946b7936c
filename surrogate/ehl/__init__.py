# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Mixed elastohydrodynamic point contact: smooth, rough and dry in one solver.

half_space (deformation) and kernels.reynolds (film) make the system of one grid, which newton
iterates with linear (kernels.krylov over line and, on coarser grids, level and transfer). case
scales a contact to its domain, search finds the way to it, solver judges it, to_si returns to SI
units.

"""

from surrogate.ehl.interface import Condition, ContactLubricant, ContactSolution, Settings, Status
from surrogate.ehl.solver import solve_contact
from surrogate.ehl.to_si import punctured_nodes

__all__ = [
    'Condition',
    'ContactLubricant',
    'ContactSolution',
    'Settings',
    'Status',
    'punctured_nodes',
    'solve_contact',
]
