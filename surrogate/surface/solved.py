# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Solution of one operating point, whatever the tier: surfaces are made of these."""

from dataclasses import dataclass
import math


@dataclass(frozen=True, kw_only=True, slots=True)
class SolvedPoint:
    """
    One solved operating point; its numbers hold if it `converged`, else `status` says why not.

    Friction torque [N m]; RCS and asperity share of the worst contact [-]; film ratio [-], central
    and minimum film [m] of the thinnest; friction coefficient over all normal forces [-]; largest
    pressure [Pa]; worst contact, 0 to 3 as in a surface file, -1 if not known; standard deviation
    of RCS between strips of the raceway [-], NaN if not known.

    """

    converged: bool
    status: str = ''
    friction_torque: float = math.nan
    rcs: float = math.nan
    asperity_share: float = math.nan
    film_ratio: float = math.nan
    central_film: float = math.nan
    minimum_film: float = math.nan
    friction_coefficient: float = math.nan
    max_pressure: float = math.nan
    worst_contact: int = -1
    rcs_deviation: float = math.nan
