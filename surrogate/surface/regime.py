# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The lubrication regimes by the film ratio: their words and their limits."""

from bisect import bisect_right
import enum
import math


class Regime(enum.IntEnum):
    """Lubrication regime by the film ratio; the numbers of PointResult.REGIME_."""

    UNKNOWN = 0
    BOUNDARY = 1
    MIXED = 2
    HYDRODYNAMIC = 3

    @property
    def word(self) -> str:
        """Return the name in lower case."""
        return self.name.lower()


REGIMES = (Regime.BOUNDARY, Regime.MIXED, Regime.HYDRODYNAMIC)
"""The regimes of a known film ratio, from the thinnest film to the thickest."""
FILM_RATIO_LIMITS = (1.0, 3.0)
"""Film ratios [-] from which on the film is mixed and hydrodynamic."""


def regime_of(film_ratio: float) -> Regime:
    """Return the regime of a film ratio [-]: below 1, from 1 to below 3, from 3; NaN unknown."""
    if math.isnan(film_ratio):
        return Regime.UNKNOWN
    return REGIMES[bisect_right(FILM_RATIO_LIMITS, film_ratio)]
