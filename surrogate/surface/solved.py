# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Solution of an operating point, whatever the tier: surfaces are made of these."""

from dataclasses import dataclass
import math
from typing import Any, Generic, TypeVar

import numpy as np
from numpy.typing import NDArray
from surrogate.results import number

Number = TypeVar('Number', float, NDArray[np.float64])
"""A number of one point, or an array over many."""


@dataclass(frozen=True, kw_only=True, slots=True)
class SolvedPoint(Generic[Number]):
    """
    A solved operating point; its numbers hold if it `converged`, else `status` says why not.

    Friction torque [N m]; RCS and asperity share of the worst contact [-]; film ratio [-], central
    and minimum film [m] of the thinnest; friction coefficient over all normal forces [-]; largest
    pressure [Pa]; worst contact, 0 to 3 as in a surface file, -1 if not known; standard deviation
    of RCS between strips of the raceway [-], NaN if not known.

    """

    converged: bool
    status: str = ''
    friction_torque: Number = number('Nm')
    rcs: Number = number()
    asperity_share: Number = number()
    film_ratio: Number = number()
    central_film: Number = number('m')
    minimum_film: Number = number('m')
    friction_coefficient: Number = number()
    max_pressure: Number = number('Pa')
    worst_contact: Any = -1
    rcs_deviation: float = math.nan
