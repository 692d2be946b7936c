# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Dry contact of a tile with a smooth flat, elastic or with a bounded pressure.

Conjugate gradients with 0 <= p <= H: Polonsky, Keer, Wear 231 (1999) 206, with the second bound of
Almqvist, Sahlin, Larsson, Glavatskih, Tribol. Int. 40 (2007) 574. Where the pressure reaches H the
material gives way, and what is left of the interference there stays. It piles up nowhere.

Where nearly all yields few nodes are free and their directions are lost. The energy is convex, so
projected gradients find its minimum there: Beck, Teboulle, SIAM J. Imaging Sci. 2 (2009) 183, with
the restart of O'Donoghue, Candes, Found. Comput. Math. 15 (2015) 715.

"""

from collections.abc import Callable
from dataclasses import dataclass, replace
import math

import numpy as np
from numpy.typing import NDArray
from scipy.fft import irfft2, rfft2
from surrogate.files import InputError
from surrogate.raceway.tile import Tile
from surrogate.units import GIGA

Array = NDArray[np.float64]
TOLERANCE = 1e-4
"""Change of the pressure in an iteration, over the load, below which it has converged [-]."""
LEAST, MOST = 10, 500
"""Fewest and most iterations [-]."""
HALVINGS = 50
"""Halvings of the range in which the shift lies that makes up the load [-]."""


@dataclass(frozen=True, kw_only=True, slots=True)
class DryContact:
    """
    A tile pressed on a flat: pressure [Pa] and gap [m] at its nodes, below 0 where it yields.

    Iterations that it took, and whether they converged.

    """

    pressure: Array
    gap: Array
    iterations: int
    converged: bool

    @property
    def separation(self) -> float:
        """Mean gap [m]."""
        return float(np.maximum(self.gap, 0.0).mean())

    @property
    def contact_share(self) -> float:
        """Share of the area that touches [-]."""
        return float((self.pressure > 0).mean())


def press(
    tile: Tile,
    modulus: float,
    mean_pressure: float,
    *,
    hardness: float = math.inf,
    tolerance: float = TOLERANCE,
) -> DryContact:
    """
    Return a tile pressed on a flat by a mean pressure [Pa], nowhere by more than `hardness` [Pa].

    `modulus` [Pa] is E/(1 - nu^2) of the contact, half the reduced modulus of `Contact`. Raises
    InputError for a mean pressure that is not below the hardness.

    """
    if not 0 < mean_pressure < hardness:
        raise InputError(
            f'raceway: the mean pressure is {GIGA * mean_pressure:.3g} GPa, allowed is above 0 '
            f'and below that at which summits are cut, {GIGA * hardness:.3g} GPa'
        )
    wave_number = tile.wave_number.copy()
    wave_number[0, 0] = math.inf
    compliance = 2 / (modulus * wave_number)
    shape, heights = tile.heights.shape, tile.heights

    def lift(load: Array) -> Array:
        return np.asarray(irfft2(compliance * rfft2(load), s=shape))

    pressure = np.full(shape, mean_pressure)
    way, last_square, keep = np.zeros(shape), 1.0, 0.0
    converged = False
    for count in range(1, MOST + 1):
        free = (pressure > 0) & (pressure < hardness)
        if np.count_nonzero(free) < 2:
            break
        gap = lift(pressure) - heights
        gap -= gap[free].mean()
        square = float(gap[free] @ gap[free])
        way = np.where(free, gap + keep * square / last_square * way, 0.0)
        answer = lift(way)
        answer -= answer[free].mean()
        work = float(answer[free] @ way[free])
        if not work > 0:
            converged = True  # nothing is left to move
            break
        step = float(gap[free] @ way[free]) / work
        before, last_square = pressure, square
        pressure = np.clip(np.where(free, pressure - step * way, pressure), 0.0, hardness)
        # Nodes at a bound whose gap pulls them away from it are free again.
        back = ((before == 0) & (gap < 0)) | ((before >= hardness) & (gap > 0))
        pressure = np.where(back, np.clip(pressure - step * gap, 0.0, hardness), pressure)
        keep = 0.0 if back.any() else 1.0
        pressure = _balanced(pressure, mean_pressure, hardness)
        change = np.abs(pressure - before).sum()
        converged = bool(change < tolerance * mean_pressure * pressure.size)
        if converged and count >= LEAST:
            break
    if not converged:
        pressure, more, converged = _descend(
            lambda load: lift(load) - heights,
            float(compliance.max()),
            np.full(shape, mean_pressure),
            hardness=hardness,
            tolerance=0.1 * tolerance,  # its steps are shorter
        )
        count += more
    free = (pressure > 0) & (pressure < hardness)
    gap = lift(pressure) - heights
    # Without a free node all that carries is at the hardness: the last of it just touches.
    gap -= gap[free].mean() if free.any() else gap[pressure > 0].max()
    return DryContact(pressure=pressure, gap=gap, iterations=count, converged=converged)


def _balanced(pressure: Array, mean_pressure: float, hardness: float) -> Array:
    """
    Return the pressures [Pa] with those between the bounds scaled to the mean [Pa].

    Where they cannot make it up, all that a bound does not hold back are shifted by the same.

    """
    free = (pressure > 0) & (pressure < hardness)
    load = mean_pressure * pressure.size
    wanted = load - float(pressure[~free].sum())
    if wanted > 0 and free.any():
        scale = wanted / float(pressure[free].sum())
        return np.where(free, np.minimum(pressure * scale, hardness), pressure)
    missing = load - float(pressure.sum())
    moved = pressure < hardness if missing > 0 else pressure > 0
    shifted = pressure + missing / np.count_nonzero(moved)
    return np.where(moved, np.clip(shifted, 0.0, hardness), pressure)


def _descend(
    slope: Callable[[Array], Array],
    steepest: float,
    pressure: Array,
    *,
    hardness: float,
    tolerance: float,
) -> tuple[Array, int, bool]:
    """
    Return pressures [Pa] of least energy with the mean of these, iterations, whether converged.

    By the `slope` of the energy at a pressure [m], which changes by `steepest` [m/Pa] at most.

    """
    mean_pressure, ahead, pace = float(pressure.mean()), pressure, 1.0
    for count in range(1, MOST + 1):
        before = pressure
        # The nearest pressures between the bounds with the mean pressure.
        free = ahead - slope(ahead) / steepest
        low, high = float(free.min()) - mean_pressure, float(free.max())
        for _ in range(HALVINGS):
            shift = 0.5 * (low + high)
            heavy = np.clip(free - shift, 0.0, hardness).mean() > mean_pressure
            low, high = (shift, high) if heavy else (low, shift)
        pressure = np.clip(free - high, 0.0, hardness)
        step = pressure - before
        if count >= LEAST and np.abs(step).sum() < tolerance * mean_pressure * step.size:
            return pressure, count, True
        last = 1.0 if np.sum((ahead - pressure) * step) > 0 else pace
        pace = 0.5 * (1 + math.sqrt(1 + 4 * last**2))
        ahead = pressure + (last - 1) / pace * step
    return pressure, MOST, False


def run_in(
    tile: Tile, modulus: float, mean_pressure: float, hardness: float
) -> tuple[Tile, DryContact]:
    """
    Return a tile after a pass under a mean pressure [Pa], and the contact in that pass.

    Summits persist, for what surrounds them is pressed too: nothing carries more than the hardness
    [Pa] above the mean pressure, so that summits that all yield have the area p/(p + H) which
    Pullen, Williamson, Proc. R. Soc. Lond. A 327 (1972) 159, measured on confined specimens. What
    yields is levelled to the deformed surface, and all rises evenly by the same volume: what is
    apart lifts the flat with it, so that the load decides its gap. A second pass is elastic.
    `modulus` as `press` has it.

    """
    bound = hardness + mean_pressure
    contact = press(tile, modulus, mean_pressure, hardness=bound, tolerance=1e-3)
    yields = (contact.pressure >= bound) & (contact.gap < 0)
    levelled = np.where(yields, contact.gap, 0.0)
    return replace(tile, heights=tile.heights + levelled - levelled.mean()), contact
