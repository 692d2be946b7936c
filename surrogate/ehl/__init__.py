# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Mixed elastohydrodynamic point contact: smooth, rough and dry in one solver.

half_space (deformation) and _reynolds (film) are joined by newton with _krylov and _line (linear
solver) on one grid; case scales a contact, solver finds the way to it, result returns to SI units.

"""

from surrogate.ehl.model import Condition, ContactLubricant, ContactSolution, Settings, Status
from surrogate.ehl.result import punctured_nodes
from surrogate.ehl.solver import solve_contact

__all__ = [
    'Condition',
    'ContactLubricant',
    'ContactSolution',
    'Settings',
    'Status',
    'punctured_nodes',
    'solve_contact',
]
