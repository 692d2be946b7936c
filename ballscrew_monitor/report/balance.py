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
sums over all rows in motion, so that a recording need not fit into memory.

"""

import dataclasses
import math

from ballscrew_monitor.core.conversions import Direction
from ballscrew_monitor.core.inputs import Source
from ballscrew_monitor.core.judgement import PointSource
from ballscrew_monitor.recordings.columns import Floats, JudgedColumns
import numpy as np
from surrogate.units import TURN

FEWEST = 50
"""Rows in motion, and in each direction, from which on a sign is told."""
CLEAR, SURE = 0.5, 0.8
"""Part of a variance from which on its reason is clear, and its amount is sure [-]."""
LARGEST = 3.0
"""Factor up to which losses, an accelerated mass or a rough lead may be the reason [-]."""
ROUNDING = 1e-9
"""Part of a sum of squares that rounding leaves [-]."""
MOTION = np.array(
    [{Direction.POSITIVE: 1.0, Direction.NEGATIVE: -1.0}.get(one, 0.0) for one in Direction]
)
"""Sign of the motion by direction."""
_LOAD, _MOTION, _ONE, _TORQUE = range(4)


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


class Balancer:
    """Sums of load, motion and motor torque over the rows of an axis in motion."""

    def __init__(self, *, lead: float, standstill: float) -> None:
        """Begin with no row; lead [m], the screw moves from a speed `standstill` [rad/s] on."""
        self._lead, self._standstill = lead, standstill
        # All by all of load torque, motion, one and motor torque: where load and torque are known,
        # where the load is, and where the torque is.
        self._both, self._load, self._torque = (np.zeros((4, 4)) for _ in range(3))
        # Friction by the model [N m] where both are known, and in how many rows it is.
        self._modelled, self._judged = 0.0, 0

    def add(self, block: JudgedColumns) -> None:
        """Take the next rows."""
        # A load that was derived from the torque says nothing new.
        derived = block.axial_load_source == PointSource.DERIVED
        load = np.where(derived, np.nan, -self._lead / TURN * block.axial_load)
        motion = MOTION[block.direction]
        moving = (np.abs(block.speed) >= self._standstill) & (motion != 0.0)
        rows = np.stack([load, motion, np.ones(len(block)), block.measured_torque])[:, moving]
        load_known, torque_known = np.isfinite(rows[_LOAD]), np.isfinite(rows[_TORQUE])
        both = load_known & torque_known
        self._load += _sums(rows[:, load_known])
        self._torque += _sums(rows[:, torque_known])
        self._both += _sums(rows[:, both])
        friction = block.friction_torque[moving][both]
        self._modelled += float(np.nansum(friction))
        self._judged += int(np.isfinite(friction).sum())

    def result(self) -> Balance:
        """Return what contradicts itself, by all rows so far."""
        load = _slope(self._both, _LOAD, (_MOTION, _ONE))
        if self._both[_ONE, _ONE] < FEWEST or not load.is_clear:
            return Balance(turned=self._turned_by_motion())
        friction = _slope(self._both, _MOTION, (_LOAD, _ONE))
        backward = friction.is_negative and _goes_both_ways(self._both)
        if load.value < 0.0:
            return Balance(turned=Source.TORQUE if backward else Source.LOAD)
        if backward:
            return Balance(turned=Source.SPEED)
        if load.explained < SURE or 1.0 / LARGEST < load.value < LARGEST:
            return Balance()
        if not self._judged:
            return Balance(factor=load.value)
        modelled = self._modelled / self._judged
        return Balance(factor=load.value, friction=friction.value / modelled)

    def _turned_by_motion(self) -> Source | None:
        """Return whose sign looks turned where the load goes with the motion, or is not known."""
        torque = _slope(self._torque, _MOTION, (_ONE,), ways=True)
        load = _slope(self._load, _MOTION, (_ONE,), of=_LOAD, ways=True)
        mean = self._load[_LOAD, _ONE] / max(self._load[_ONE, _ONE], 1.0)
        aids = load.is_negative and abs(mean) < abs(load.value)  # in both directions
        if torque.is_negative and aids:  # so it is if the load drives the screw, but for friction
            return Source.SPEED if torque.value < load.value else None
        if torque.is_negative:
            return Source.TORQUE
        return Source.LOAD if aids else None


def _sums(rows: Floats) -> Floats:
    return np.asarray(rows @ rows.T)


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
