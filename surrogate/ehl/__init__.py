# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Mixed elastohydrodynamic point contact: smooth, rough and dry in one solver.

case scales a contact (scales) to its domain (domain) and grid. half_space (deformation) and
kernels.reynolds (film) make the system of one grid, which newton iterates with linear:
kernels.krylov over kernels.level, whose lines and bands (kernels.line, kernels.bands) precondition
it, and kernels.transfer to coarser grids; kernels.fft convolves. search finds the way to the case,
solver judges the solution, results returns it in SI units, friction integrates it. interface holds
inputs and result.

"""

from surrogate.ehl.interface import Condition, ContactLubricant, ContactSolution, Settings, Status
from surrogate.ehl.results import punctured_nodes
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
