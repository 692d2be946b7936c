# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Totals and windows over the rows of a stretch.

What `Account` and `WindowTally` add up sample by sample, in the same order: the same sums to the
last bit.

"""

import dataclasses

from ballscrew_monitor.core.conversions import SECOND
from ballscrew_monitor.core.estimate import PointValidity
from ballscrew_monitor.core.judgement import Zone
from ballscrew_monitor.core.tally import Account, Moment, WindowTally
from ballscrew_monitor.recordings.bulk.estimates import Judgements, Points
from ballscrew_monitor.recordings.bulk.stretch import Rows
from ballscrew_monitor.recordings.columns import LIGHT_LOAD, STANDSTILL
import numpy as np
from numpy.typing import NDArray
from surrogate.surface import Regime


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class Moments:
    """
    What the totals need to know of rows, and which of them are samples; see `tally.Moment`.

    stamp [ns], speed, an amount [rad/s], power_lost [W].

    """

    sample: NDArray[np.bool_]

    stamp: NDArray[np.int64]
    speed: NDArray[np.float64]
    power_lost: NDArray[np.float64]
    regime: NDArray[np.uint8]
    zone: NDArray[np.uint8]

    def part(self, rows: slice) -> 'Moments':
        """Return those of some rows that are samples."""
        at = np.flatnonzero(self.sample[rows]) + rows.start
        return Moments(**{name: getattr(self, name)[at] for name in self.__slots__})

    def moment(self, at: int) -> Moment:
        """Return one of them."""
        return Moment(
            stamp=int(self.stamp[at]),
            speed=float(self.speed[at]),
            power_lost=float(self.power_lost[at]),
            regime=Regime(int(self.regime[at])),
            zone=Zone(int(self.zone[at])),
        )


def moments(rows: Rows, points: Points, judged: Judgements) -> Moments:
    """Return what the totals need to know of rows."""
    speed = np.where(judged.gates & STANDSTILL != 0, 0.0, np.abs(points.speed))
    with np.errstate(invalid='ignore', over='ignore'):
        power = judged.friction_torque * speed
    return Moments(
        sample=~rows.tick,
        stamp=rows.stamp,
        speed=speed,
        power_lost=np.where(np.isfinite(power), power, 0.0),
        regime=judged.regime,
        zone=judged.zone,
    )


def add_moments(account: Account, now: Moments, max_gap: int) -> None:
    """Add samples to the totals, each until the next one or a gap above `max_gap` [ns]."""
    if not len(now.stamp):
        return
    if account.last is not None:
        account.add(now.moment(0), max_gap=max_gap)
    span = np.diff(now.stamp)
    counts = (now.speed[:-1] != 0.0) & (span > 0) & (span <= max_gap)
    span = np.where(counts, span, 0)
    time = span / SECOND
    zone, regime = now.zone[:-1], now.regime[:-1]
    known = np.where(zone == Zone.UNKNOWN, 0, span)
    account.add_sums(
        running=int(span.sum()),
        unjudged=int(span[zone == Zone.UNKNOWN].sum()),
        in_regime={each: int(known[regime == each].sum()) for each in Regime},
        in_zone={each: int(known[zone == each].sum()) for each in Zone},
        angles=(now.speed[:-1] * time).tolist(),
        energies=(now.power_lost[:-1] * time).tolist(),
        first=int(now.stamp[0]),
        last=now.moment(-1),
    )


def add_to_window(window: WindowTally, points: Points, judged: Judgements, rows: slice) -> None:
    """Add some rows to the statistics of the window."""
    counts = (judged.zone[rows] != Zone.UNKNOWN) & (judged.validity[rows] == PointValidity.VALID)
    at = np.flatnonzero(counts) + rows.start
    heavy = at[judged.gates[at] & LIGHT_LOAD == 0]
    window.add_many(
        speed=points.speed[at].tolist(),
        axial_load=points.axial_load[at].tolist(),
        rcs=judged.rcs[at].tolist(),
        film_ratio=judged.film_ratio[at].tolist(),
        efficiency=judged.efficiency[heavy].tolist(),
    )
