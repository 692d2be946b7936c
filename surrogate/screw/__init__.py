# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""One point of the full tier: four contacts, traction, balance of the balls, torque."""

from surrogate.screw.contacts import ScrewSettings
from surrogate.screw.solve import rebalance_screw, ScrewSolution, solve_screw

__all__ = ['rebalance_screw', 'ScrewSettings', 'ScrewSolution', 'solve_screw']
