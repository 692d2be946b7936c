# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
A strip of raceway of any length, evaluated row by row as it rolls through a contact.

Across the track the places are fixed, so that the part of each wave along y is worked out once;
each block of rows then costs one matrix product. Heights are positive out of the material.

"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray
from surrogate.raceway.patch import on_plane, Plane

Array = NDArray[np.float64]
Waves = NDArray[np.complex128]


@dataclass(frozen=True, kw_only=True)
class Strip:
    """
    A sum of plane waves at the places `y` [m] across the track, at any place along it.

    Wave numbers along the track [rad/m]; `weight` [m], amplitude and phase; `across` [-], shape
    (waves, ny); plane (offset [m], slopes [-]) and scale [-] as in
    `surrogate.raceway.patch.Raceway`.

    """

    y: Array
    wave_number_x: Array
    weight: Waves
    across: Waves
    plane: Plane
    scale: float

    def rows(self, x: ArrayLike) -> Array:
        """Return heights [m], shape (nx, ny), at the places `x` [m] along the track."""
        x = np.atleast_1d(np.asarray(x, dtype=float))
        along = np.exp(1j * np.outer(x, self.wave_number_x))
        waves = np.sum(self.weight.real) - ((along * self.weight) @ self.across).real
        return np.asarray(self.scale * (waves - on_plane(self.plane, x, self.y)))
