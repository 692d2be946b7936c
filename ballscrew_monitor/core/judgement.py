# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
From an estimate to a judgement: gates, zone, findings, and the level held over time.

Equality has one side: rcs == limit is outside, efficiency == limit is optimal, speed at the
standstill limit moves, load at the light limit is judged, a delay that is exactly over is over.
Time is an argument.

"""

import dataclasses
import enum
import math

from ballscrew_monitor.core.estimate import MachinePoint, PointEstimate, PointSource, PointValidity
from surrogate.files import InputError
from surrogate.surface import SurfacePoint

NAN = math.nan
FROM_TORQUE = ', efficiency judged from a load derived of the motor torque'


class Level(enum.IntEnum):
    """The held judgement; BallScrewState.LEVEL_."""

    UNKNOWN = 0
    OK = 1
    WARN = 2


class Zone(enum.IntEnum):
    """The judgement of one instant; BallScrewState.ZONE_."""

    UNKNOWN = 0
    OPTIMAL = 1
    OUTSIDE = 2


class Gate(enum.IntEnum):
    """Why a criterion is not applied; BallScrewState.GATE_."""

    UNKNOWN = 0
    STANDSTILL = 1
    LIGHT_LOAD = 2


class Code(enum.IntEnum):
    """What a finding is about; Finding.CODE_."""

    UNKNOWN = 0
    RCS_HIGH = 1
    EFFICIENCY_LOW = 2
    OUT_OF_RANGE = 3
    INPUT_LOST = 4
    MODEL_RANGE = 5  # reserved by the message; no surface says so yet


class Severity(enum.IntEnum):
    """How bad a finding is; Finding.SEVERITY_."""

    UNKNOWN = 0
    INFO = 1
    WARN = 2
    ERROR = 3


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class Limits:
    """
    What an operating point is held against.

    rcs and efficiency [-], light_load [N], standstill_speed [rad/s], raise_delay and clear_delay
    [ns], hysteresis [-]. To clear a warning RCS must be below (1 - hysteresis) of its limit, and
    the loss 1 - efficiency at most (1 - hysteresis) of what the limit allows.

    """

    rcs: float
    efficiency: float
    light_load: float
    standstill_speed: float
    raise_delay: int
    clear_delay: int
    hysteresis: float

    def __post_init__(self) -> None:
        """Refuse limits without meaning."""
        for name in ('rcs', 'efficiency'):
            _check(name, getattr(self, name), 0.0 < getattr(self, name) < 1.0, 'between 0 and 1')
        for name in ('light_load', 'raise_delay', 'clear_delay'):
            value = getattr(self, name)
            _check(name, value, 0.0 <= value < math.inf, 'at least 0')
        _check(
            'standstill_speed',
            self.standstill_speed,
            0.0 < self.standstill_speed < math.inf,
            'above 0',
        )
        _check('hysteresis', self.hysteresis, 0.0 <= self.hysteresis < 1.0, 'from 0 to below 1')

    @property
    def rcs_to_clear(self) -> float:
        """Return the RCS [-] below which a warning may clear."""
        return self.rcs * (1.0 - self.hysteresis)

    @property
    def efficiency_to_clear(self) -> float:
        """Return the efficiency [-] from which a warning may clear."""
        return self.efficiency + (1.0 - self.efficiency) * self.hysteresis


def _check(name: str, value: float, good: bool, allowed: str) -> None:
    if not good:
        raise InputError(f'limit {name} is {value!r}, it must be {allowed}')


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class Finding:
    """One thing worth saying; value and limit in `unit`, NaN is none."""

    code: Code
    severity: Severity
    value: float = NAN
    limit: float = NAN
    unit: str = '-'
    text: str = ''


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class Verdict:
    """Judgement of one instant; `clear` tells whether it counts towards clearing a warning."""

    zone: Zone
    gates: tuple[Gate, ...] = ()
    findings: tuple[Finding, ...] = ()
    clear: bool = False


def gates_of(point: MachinePoint, limits: Limits) -> tuple[Gate, ...]:
    """Return the gates that are shut at a point; numbers that are unknown or held shut none."""
    gates = []
    if abs(point.speed) < limits.standstill_speed and point.speed_source is not PointSource.HELD:
        gates.append(Gate.STANDSTILL)
    if (
        abs(point.axial_load) < limits.light_load
        and point.axial_load_source is not PointSource.HELD
    ):
        gates.append(Gate.LIGHT_LOAD)
    return tuple(gates)


def judge(point: MachinePoint, estimate: PointEstimate, limits: Limits) -> Verdict:
    """
    Return the judgement of one instant.

    UNKNOWN without a VALID estimate and at standstill; OPTIMAL when every criterion that applies
    is met, OUTSIDE when one is not. Under a light load only RCS applies.

    """
    gates = gates_of(point, limits)
    if estimate.validity is PointValidity.NO_INPUT:
        return Verdict(zone=Zone.UNKNOWN, gates=gates, findings=(_unjudged(estimate),))
    if Gate.STANDSTILL in gates:
        return Verdict(zone=Zone.UNKNOWN, gates=gates)
    if estimate.validity is not PointValidity.VALID or math.isnan(
        estimate.rcs + estimate.efficiency
    ):
        return Verdict(zone=Zone.UNKNOWN, gates=gates, findings=(_unjudged(estimate),))
    light = Gate.LIGHT_LOAD in gates
    findings = violations(estimate, limits, light=light, derived=point.derived is not None)
    if findings:
        return Verdict(zone=Zone.OUTSIDE, gates=gates, findings=findings)
    return Verdict(zone=Zone.OPTIMAL, gates=gates, clear=clears(estimate, limits, light=light))


def is_judged(verdict: Verdict) -> bool:
    """Tell whether a verdict was possible; that nothing applies at standstill is one too."""
    return verdict.zone is not Zone.UNKNOWN or Gate.STANDSTILL in verdict.gates


def clears(estimate: PointEstimate | SurfacePoint, limits: Limits, *, light: bool) -> bool:
    """Tell whether an estimate counts towards clearing; efficiency is left out if `light`."""
    return estimate.rcs < limits.rcs_to_clear and (
        light or estimate.efficiency >= limits.efficiency_to_clear
    )


def violations(
    estimate: PointEstimate, limits: Limits, *, light: bool, derived: bool = False
) -> tuple[Finding, ...]:
    """
    Return a finding for each criterion that is not met; efficiency is left out if `light`.

    Under a `derived` load the finding about efficiency says so.

    """
    findings = []
    if estimate.rcs >= limits.rcs:
        findings.append(
            Finding(
                code=Code.RCS_HIGH,
                severity=Severity.WARN,
                value=estimate.rcs,
                limit=limits.rcs,
                text=f'asperities carry too much: RCS {estimate.rcs:.3g}, limit {limits.rcs:.3g}',
            )
        )
    if not light and estimate.efficiency < limits.efficiency:
        findings.append(
            Finding(
                code=Code.EFFICIENCY_LOW,
                severity=Severity.WARN,
                value=estimate.efficiency,
                limit=limits.efficiency,
                text='too much power is lost: efficiency '
                f'{estimate.efficiency:.3g}, limit {limits.efficiency:.3g}'
                f'{FROM_TORQUE if derived else ""}',
            )
        )
    return tuple(findings)


def _unjudged(estimate: PointEstimate) -> Finding:
    if estimate.validity is PointValidity.NO_INPUT:
        return Finding(code=Code.INPUT_LOST, severity=Severity.ERROR, text=estimate.reason)
    return Finding(
        code=Code.OUT_OF_RANGE,
        severity=Severity.WARN,
        text=estimate.reason or 'the surface holds no number here',
    )


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class UnbrokenRun:
    """Stamps [ns] of the first and the last sample of an unbroken run."""

    start: int
    last: int


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class Hold:
    """The held level, since when [ns], and the runs that may change it."""

    level: Level = Level.UNKNOWN
    since: int = 0
    raising: UnbrokenRun | None = None
    clearing: UnbrokenRun | None = None


def hold(
    memory: Hold, verdict: Verdict, stamp: int, limits: Limits, *, max_gap: int, period: int = 0
) -> Hold:
    """
    Return the held level after one more verdict at `stamp` [ns].

    WARN is raised by samples outside for `raise_delay` without an optimal one between them; a
    sample that cannot be judged neither adds nor takes away, a hole of more than `max_gap` [ns]
    and of more than the `period` [ns] of a slow input starts anew. OK needs samples that count
    towards clearing for `clear_delay` and nothing else between them: a sample that cannot be
    judged and any hole start that anew. So an unknown never brings OK nearer and never sends a
    warning away.

    """
    if verdict.zone is Zone.OUTSIDE:
        if memory.level is Level.WARN:
            return memory if memory.clearing is None else _drop_runs(memory)
        run = _extend(memory.raising, stamp, max(max_gap, period))
        if stamp - run.start >= limits.raise_delay:
            return Hold(level=Level.WARN, since=stamp)
        return Hold(level=memory.level, since=memory.since, raising=run)
    if verdict.zone is Zone.OPTIMAL:
        return _towards_ok(memory, verdict, stamp, limits, max_gap)
    return memory if memory.clearing is None else dataclasses.replace(memory, clearing=None)


def _towards_ok(memory: Hold, verdict: Verdict, stamp: int, limits: Limits, max_gap: int) -> Hold:
    if memory.level is Level.OK or (memory.level is Level.WARN and not verdict.clear):
        return memory if memory.raising is memory.clearing is None else _drop_runs(memory)
    run = _extend(memory.clearing, stamp, max_gap)
    if stamp - run.start >= limits.clear_delay:
        return Hold(level=Level.OK, since=stamp)
    return Hold(level=memory.level, since=memory.since, clearing=run)


def _extend(run: UnbrokenRun | None, stamp: int, max_gap: int) -> UnbrokenRun:
    if run is None or stamp - run.last > max_gap:
        return UnbrokenRun(start=stamp, last=stamp)
    return UnbrokenRun(start=run.start, last=stamp)


def _drop_runs(memory: Hold) -> Hold:
    return Hold(level=memory.level, since=memory.since)
