# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""What a monitor is told and what it says: settings, events and states."""

from collections.abc import Mapping
import dataclasses
import math

from ballscrew_monitor.core.advice import Advice, Advisor
from ballscrew_monitor.core.estimate import MachinePoint, PointEstimate
from ballscrew_monitor.core.input_status import InputStatus
from ballscrew_monitor.core.inputs import Source, YEAR
from ballscrew_monitor.core.judgement import Code, Finding, Level, Limits, Severity, Verdict
from ballscrew_monitor.core.shelving import NOT_SHELVED, Shelving
from ballscrew_monitor.core.tally import Totals, WindowStatistics

NAN = math.nan


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class LoadDerivation:
    """
    How a load is derived from the torque.

    `inertia` [kg m2] of what turns, at the screw; `window` [ns] of the
    acceleration; `torque_uncertainty` [N m] at the screw, a half width; `parts_uncertainty` [-]
    that of inertia torque and drag over themselves; `largest_share` [-] of inertia torque and drag
    in the measured torque up to which a load is derived.

    """

    inertia: float
    window: int
    torque_uncertainty: float
    parts_uncertainty: float
    largest_share: float


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class PositionSettings:
    """How speeds follow from positions: window [ns], and the turn at which angles wrap [rad]."""

    window: int
    wrap: float = 0.0  # none


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class MonitorSettings:
    """
    What a monitor is told.

    `timeouts` [ns] of the configured inputs only: an input without one has no topic.
    `default_temperature` [K] is used without a temperature topic, `publish_period` [ns] thins out
    the states, 0 keeps all; a stamp may be `max_future` [ns] ahead of the clock, and that is less
    than `tick_period` [ns] ahead of the tick. Stamps more than `max_lag` [ns] behind their arrival
    are warned of. Samples whose amount is above that in `plausible` [SI] are refused.
    With a `derivation` the load is derived from the motor torque, with `positions` the samples of
    the speed are positions.

    """

    axis: str
    limits: Limits
    timeouts: Mapping[Source, int]
    default_temperature: float
    publish_period: int = 0
    max_future: int = 0
    max_lag: int = YEAR
    tick_period: int = 0
    plausible: Mapping[Source, float] = dataclasses.field(default_factory=dict)
    derivation: LoadDerivation | None = None
    positions: PositionSettings | None = None


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class Event:
    """
    One stay outside the optimal zone; stamps [ns], event 0 is none yet.

    `ending` says why the node ended it, empty if the axis came back. The first reading of
    `advice` takes milliseconds.

    """

    number: int = 0
    active: bool = False
    stamp: int = 0
    start: int = 0
    worst_value: float = NAN
    cause: Finding = Finding(code=Code.UNKNOWN, severity=Severity.UNKNOWN)
    advisor: Advisor | None = None
    ending: str = ''

    @property
    def advice(self) -> Advice:
        """Return where the warning would clear."""
        return Advice() if self.advisor is None else self.advisor.advice


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class State:
    """
    Judgement of one axis at one instant.

    `event` is that which began or ended at this state, else None; `event_id` is that of the
    active event or of the last one. `shelving` is that in force. Torques [N m] in the machine
    frame.

    """

    axis: str
    stamp: int
    point: MachinePoint
    estimate: PointEstimate
    verdict: Verdict
    level: Level
    level_since: int
    event_id: int
    event: Event | None
    limits: Limits
    window: WindowStatistics
    inputs: tuple[InputStatus, ...]
    totals: Totals
    judged: int
    measured_torque: float
    torque_residual: float
    surface_id: str
    shelving: Shelving = NOT_SHELVED
