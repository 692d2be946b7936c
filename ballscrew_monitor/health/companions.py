# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Surfaces of one screw at parts of its preload, beside the surface in use.

They are of published formulas, so their ratio to the one at full preload counts, not their torque.

"""

from collections.abc import Mapping
import math
from pathlib import Path

import numpy as np
from surrogate.files import InputError
from surrogate.surface import companion_path, PRELOAD_SHARES, Surface, SurfaceError

NONE_BUILT = 'preload not known: build the surface with --with-preloads'


class Companions:
    """Surfaces by their share of the preload [-], that at full preload among them."""

    def __init__(self, surfaces: Mapping[float, Surface]) -> None:
        """Take at least three surfaces."""
        self._surfaces = dict(surfaces)
        self._known: dict[tuple[float, float, float], tuple[float, float]] = {}

    def friction_ratio(self, speed: float, load: float, temperature: float, share: float) -> float:
        """
        Return the friction at a `share` of the preload over that at full preload [-].

        ln ratio = a ln share + b (ln share)^2 through the surfaces by least squares; NaN where
        fewer than two of them know the place, |w| [rad/s], opposing load [N], temperature [K].

        """
        place = speed, load, temperature
        if place not in self._known:
            self._known[place] = self._powers(*place)
        first, second = self._known[place]
        step = math.log(share)
        return math.exp(first * step + second * step * step)

    def _powers(self, speed: float, load: float, temperature: float) -> tuple[float, float]:
        torques = {
            share: float(surface.lookup(speed, load, temperature).friction_torque)
            for share, surface in self._surfaces.items()
        }
        full = torques.pop(1.0)
        known = [(math.log(share), t / full) for share, t in torques.items() if t / full > 0.0]
        if len(known) < 2:
            return math.nan, math.nan
        steps = np.array([step for step, _ in known])
        ratios = np.log([ratio for _, ratio in known])
        found = np.linalg.lstsq(np.stack([steps, steps**2], axis=1), ratios, rcond=None)[0]
        return float(found[0]), float(found[1])


def companions_beside(path: Path, surface: Surface) -> Companions | str:
    """Return the companions of the `surface` of a file, or in a sentence why there are none."""
    found: dict[float, Surface] = {}
    for share in PRELOAD_SHARES:
        file = companion_path(path, share)
        if not file.exists():
            return NONE_BUILT
        try:
            found[share] = Surface.load(file, screw=surface.screw_name, oil=surface.oil_name)
            _check(file, found[share], surface, share)
        except (SurfaceError, InputError) as error:
            return f'preload not known: {error}'
    return Companions(found)


def _check(file: Path, companion: Surface, surface: Surface, share: float) -> None:
    wanted = share * surface.preload
    if abs(companion.preload - wanted) > 1e-6 * surface.preload:
        raise InputError(
            f'{file}: built for a preload of {companion.preload:g} N, that of the surface asks '
            f'for {wanted:g} N; build both again with --with-preloads'
        )
