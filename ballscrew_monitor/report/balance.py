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
sums over all rows in motion, added up in one compiled pass as those of the survey.

"""

import dataclasses
import functools
import math
from typing import Any

from ballscrew_monitor.core.inputs import Source
from ballscrew_monitor.judge.inputs import DERIVED, MEASURED
from ballscrew_monitor.judge.point import NO_DIRECTION, POSITIVE
import numpy as np
from numpy.typing import NDArray
from surrogate.surface.compiled import compiled
from surrogate.surface.records import as_array, from_array, many
from surrogate.units import TURN

Floats = NDArray[np.float64]

FEWEST = 50
"""Rows in motion, and in each direction, from which on a sign is told."""
CLEAR, SURE = 0.5, 0.8
"""Part of a variance from which on its reason is clear, and its amount is sure [-]."""
LARGEST = 3.0
"""Factor up to which losses, an accelerated mass or a rough lead may be the reason [-]."""
ROUNDING = 1e-9
"""Part of a sum of squares that rounding leaves [-]."""
TERMS = 4
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


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class _Slope:
    """Slope of one quantity by another, and the part of its variance that this explains [-]."""

    value: float = math.nan
    explained: float = 0.0

    @property
    def is_clear(self) -> bool:
        return self.explained >= CLEAR

    @property
    def is_negative(self) -> bool:
        return self.is_clear and self.value < 0.0


@dataclasses.dataclass(slots=True)
class BalanceSums:
    """
    Sums over the rows in motion, where load and torque are known, the load is, and the torque is.

    Each is of the products of all terms by all: load torque, motion, one and motor torque.
    Friction by the model [N m] where both are known, and in how many rows it is.

    """

    both: list[float] = many(TERMS * TERMS, 0.0)
    load: list[float] = many(TERMS * TERMS, 0.0)
    torque: list[float] = many(TERMS * TERMS, 0.0)
    friction: float = 0.0
    judged: int = 0


def add_products(sums: Any, rows: Any, lead: float, standstill: float) -> None:
    """Add rows to an array of one `BalanceSums`; lead [m] and standstill [rad/s]."""
    for at in range(len(rows)):
        row = rows[at]
        if not abs(row.speed) >= standstill or row.direction == NO_DIRECTION:
            continue
        # A load that was derived from the torque says nothing new.
        known = row.axial_load_source != DERIVED and math.isfinite(row.axial_load)
        load = -lead / TURN * row.axial_load if known else 0.0
        motion = 1.0 if row.direction == POSITIVE else -1.0
        measured = row.motor_torque_source == MEASURED and math.isfinite(row.motor_torque)
        torque = row.motor_torque if measured else 0.0
        if known:
            _add(sums[0].load, load, motion, torque)
        if measured:
            _add(sums[0].torque, load, motion, torque)
        if known and measured:
            _add(sums[0].both, load, motion, torque)
            if math.isfinite(row.friction_torque):
                sums[0].friction += row.friction_torque
                sums[0].judged += 1


def _add(products: Any, load: float, motion: float, torque: float) -> None:
    terms = (load, motion, 1.0, torque)
    for term in range(TERMS):
        for other in range(TERMS):
            products[TERMS * term + other] += terms[term] * terms[other]


@functools.cache
def compiled_products() -> Any:
    """Return `add_products` compiled; raises ImportError without numba."""
    return compiled(add_products)


class Balancer:
    """Sums of load, motion and motor torque over the rows of an axis in motion."""

    def __init__(self, *, lead: float, standstill: float) -> None:
        """Begin with no row; lead [m], the screw moves from a speed `standstill` [rad/s] on."""
        self._lead, self._standstill = lead, standstill
        self.sums = as_array(BalanceSums())

    def add(self, rows: NDArray[Any]) -> None:
        """Take the next rows, an array of ROW."""
        compiled_products()(self.sums, rows, self._lead, self._standstill)

    def result(self) -> Balance:
        """Return what contradicts itself, by all rows so far."""
        sums = from_array(BalanceSums, self.sums[0])
        both = _matrix(sums.both)
        load = _slope(both, _LOAD, (_MOTION, _ONE))
        if both[_ONE, _ONE] < FEWEST or not load.is_clear:
            return Balance(turned=_turned_by_motion(_matrix(sums.load), _matrix(sums.torque)))
        friction = _slope(both, _MOTION, (_LOAD, _ONE))
        backward = friction.is_negative and _goes_both_ways(both)
        if load.value < 0.0:
            return Balance(turned=Source.TORQUE if backward else Source.LOAD)
        if backward:
            return Balance(turned=Source.SPEED)
        if load.explained < SURE or 1.0 / LARGEST < load.value < LARGEST:
            return Balance()
        if not sums.judged:
            return Balance(factor=load.value)
        return Balance(factor=load.value, friction=friction.value / (sums.friction / sums.judged))


def _turned_by_motion(load_sums: Floats, torque_sums: Floats) -> Source | None:
    """Return whose sign looks turned where the load goes with the motion, or is not known."""
    torque = _slope(torque_sums, _MOTION, (_ONE,), ways=True)
    load = _slope(load_sums, _MOTION, (_ONE,), of=_LOAD, ways=True)
    mean = load_sums[_LOAD, _ONE] / max(load_sums[_ONE, _ONE], 1.0)
    aids = load.is_negative and abs(mean) < abs(load.value)  # in both directions
    if torque.is_negative and aids:  # so it is if the load drives the screw, but for friction
        return Source.SPEED if torque.value < load.value else None
    if torque.is_negative:
        return Source.TORQUE
    return Source.LOAD if aids else None


def _matrix(products: list[float]) -> Floats:
    return np.reshape(products, (TERMS, TERMS))


def _goes_both_ways(sums: Floats) -> bool:
    rows, balance = float(sums[_ONE, _ONE]), abs(float(sums[_MOTION, _ONE]))
    return 0.5 * (rows - balance) >= FEWEST


def _slope(
    sums: Floats, by: int, others: tuple[int, ...], *, of: int = _TORQUE, ways: bool = False
) -> _Slope:
    """Return the slope of one quantity by another, without what both have of the others."""
    if ways and not _goes_both_ways(sums):
        return _Slope()
    two, rest = [by, of], list(others)
    across = sums[np.ix_(two, rest)]
    left = sums[np.ix_(two, two)] - across @ np.linalg.pinv(sums[np.ix_(rest, rest)]) @ across.T
    (own, product), (_, whole) = left.tolist()
    if own <= ROUNDING * sums[by, by] or whole <= ROUNDING * sums[of, of]:
        return _Slope()
    return _Slope(value=product / own, explained=product**2 / (own * whole))
