# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The states of a run as columns, for pictures."""

import array
import dataclasses
import math

from ballscrew_monitor.core.conversions import Direction, opposing_load
from ballscrew_monitor.core.fields import stamp_of
from ballscrew_msgs.msg import BallScrewState, PointResult
import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class LimitsInForce:
    """Limits in force: RCS [-], efficiency [-], light load [N], standstill [rad/s]."""

    rcs: float
    efficiency: float
    light_load: float
    standstill: float


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class Trace:
    """
    One row for each state.

    time [s] from the first state; speed [rad/s] and axial_load [N] in the machine frame,
    opposing_load [N] positive against the motion, the last one at standstill and NaN before the
    first one; temperature [degC]; efficiency [-], NaN where it is not judged; rcs and film_ratio
    [-], NaN at standstill; zone and level as in BallScrewState.

    """

    axis: str
    time: Array
    speed: Array
    axial_load: Array
    opposing_load: Array
    temperature: Array
    efficiency: Array
    rcs: Array
    film_ratio: Array
    zone: Array
    level: Array
    limits: LimitsInForce
    tier: int


class Tracer:
    """Collects the states of one axis."""

    COLUMNS = (
        'speed',
        'axial_load',
        'opposing_load',
        'temperature',
        'efficiency',
        'rcs',
        'film_ratio',
        'zone',
        'level',
    )

    def __init__(self) -> None:
        """Begin with nothing."""
        self._stamps = array.array('q')
        self._columns = {name: array.array('d') for name in self.COLUMNS}
        self._axis, self._tier = '', PointResult.TIER_UNKNOWN
        self._limits: LimitsInForce | None = None

    def add_state(self, state: BallScrewState) -> None:
        """Take a state."""
        self._stamps.append(stamp_of(state))
        for name, value in zip(self.COLUMNS, _row(state), strict=True):
            self._columns[name].append(value)
        if self._limits is None:
            self._axis, self._tier = state.axis, state.result.tier
        self._limits = LimitsInForce(
            rcs=state.rcs_limit,
            efficiency=state.efficiency_limit,
            light_load=state.light_load_limit,
            standstill=state.standstill_limit,
        )

    def result(self) -> Trace | None:
        """Return the columns, None without a state."""
        if self._limits is None:
            return None
        stamps = np.array(self._stamps, dtype=np.int64)
        return Trace(
            axis=self._axis,
            tier=self._tier,
            limits=self._limits,
            time=(stamps - stamps[0]) * 1e-9,
            **{name: np.array(column) for name, column in self._columns.items()},
        )


def _row(state: BallScrewState) -> tuple[float, ...]:
    point, result, gates = state.point, state.result, set(state.active_gates)
    direction = Direction(point.direction)
    known = direction is not Direction.UNKNOWN
    still = BallScrewState.GATE_STANDSTILL in gates
    unjudged = still or BallScrewState.GATE_LIGHT_LOAD in gates
    return (
        point.speed,
        point.axial_load,
        opposing_load(point.axial_load, direction) if known else math.nan,
        point.temperature,
        math.nan if unjudged else result.efficiency,
        math.nan if still else result.rcs,
        math.nan if still else result.film_ratio,
        state.zone,
        state.level,
    )
