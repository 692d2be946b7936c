# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
A film that is not fully flooded, as the datasheet of the oil or grease states it.

The contact is taken at the slower entrainment whose flooded film is that of the inlet as it is.

"""

from typing import TypeVar

import numpy as np
from numpy.typing import NDArray
from surrogate.formulas.inlet_heating import SPEED_EXPONENT
from surrogate.parameters import Lubricant

Speed = TypeVar('Speed', float, NDArray[np.float64])


def starved_speed(lubricant: Lubricant, speed: Speed) -> Speed:
    """
    Return the speed whose flooded central film is `film_factor` of that at `speed`.

    Entrainment [m/s] or rotation [rad/s]: the one is proportional to the other.

    """
    slower: float = lubricant.film_factor ** (1 / SPEED_EXPONENT)
    return speed * slower
