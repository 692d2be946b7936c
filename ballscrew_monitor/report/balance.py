# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Balance of load, motor torque and friction of an axis, by which wrong signs and units are known.

In the machine frame the motor torque is

    torque = factor load_torque + friction sign(motion) + constant,
    load_torque = -lead load / 2 pi,

whose factor is 1 but for the losses, and whose friction is positive; the constant is weight or a
wrong zero. A negative factor is a wrong sign of the load, or of the torque if friction is negative
too; negative friction alone is a wrong sign of the motion. The three follow by least squares from
the products that the survey sums over all rows in motion.

"""

import dataclasses
import math

from ballscrew_monitor.core.inputs import Source
from ballscrew_monitor.report.survey import RowSums, TERMS
import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

FEWEST = 50
"""Rows in motion, and in each direction, from which on a sign is told."""
CLEAR, SURE = 0.5, 0.8
"""Part of a variance from which on its reason is clear, and its amount is sure [-]."""
LARGEST = 3.0
"""Factor up to which losses, an accelerated mass or a rough lead may be the reason [-]."""
ROUNDING = 1e-9
"""Part of a sum of squares that rounding leaves [-]."""
_LOAD, _MOTION, _ONE, _TORQUE = range(TERMS)


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class Balance:
    """
    What contradicts itself: the input whose sign looks `turned`, and a wrong amount.

    `factor` is the torque over what the load needs [-], NaN where they agree or nothing tells;
    `friction` is that of the torque over that of the model [-], NaN where nothing tells.

    """

    turned: Source | None = None
    factor: float = math.nan
    friction: float = math.nan


def balance_of(sums: RowSums) -> Balance:
    """Return what contradicts itself, by the sums over all rows of an axis."""
    loads, torques, both = (
        np.reshape(products, (TERMS, TERMS))
        for products in (sums.of_load, sums.of_torque, sums.of_both)
    )
    factor, explained = _slope(both, _LOAD, (_MOTION, _ONE))
    if both[_ONE, _ONE] < FEWEST or explained < CLEAR:
        # The load goes with the motion, or is not known.
        drag, explained = _slope(torques, _MOTION, (_ONE,))
        brakes = drag < 0.0 and explained >= CLEAR and _goes_both_ways(torques)
        load, explained = _slope(loads, _MOTION, (_ONE,), of=_LOAD)
        mean = loads[_LOAD, _ONE] / max(loads[_ONE, _ONE], 1.0)
        aids = load < 0.0 and explained >= CLEAR and _goes_both_ways(loads)
        aids &= abs(mean) < abs(load)  # in both directions
        if brakes and aids:  # so it is if the load drives the screw, but for friction
            return Balance(turned=Source.SPEED if drag < load else None)
        return Balance(turned=Source.TORQUE if brakes else Source.LOAD if aids else None)
    friction, friction_explained = _slope(both, _MOTION, (_LOAD, _ONE))
    backward = friction < 0.0 and friction_explained >= CLEAR and _goes_both_ways(both)
    if factor < 0.0:
        return Balance(turned=Source.TORQUE if backward else Source.LOAD)
    if backward:
        return Balance(turned=Source.SPEED)
    if explained < SURE or 1.0 / LARGEST < factor < LARGEST:
        return Balance()
    if not sums.friction_rows:
        return Balance(factor=factor)
    return Balance(factor=factor, friction=friction / (sums.friction / sums.friction_rows))


def _goes_both_ways(sums: Floats) -> bool:
    rows, balance = float(sums[_ONE, _ONE]), abs(float(sums[_MOTION, _ONE]))
    return 0.5 * (rows - balance) >= FEWEST


def _slope(
    sums: Floats, by: int, others: tuple[int, ...], *, of: int = _TORQUE
) -> tuple[float, float]:
    """
    Return the slope of one quantity by another, without what both have of the others.

    Beside it is the part of the variance that it explains [-]; NaN and 0 where nothing varies.

    """
    two, rest = [by, of], list(others)
    across = sums[np.ix_(two, rest)]
    left = sums[np.ix_(two, two)] - across @ np.linalg.pinv(sums[np.ix_(rest, rest)]) @ across.T
    (own, product), (_, whole) = left.tolist()
    if own <= ROUNDING * sums[by, by] or whole <= ROUNDING * sums[of, of]:
        return math.nan, 0.0
    return product / own, product**2 / (own * whole)
