# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Goals of full solves as points, and their outcomes as results."""

from collections.abc import Mapping
import math
from typing import Any, Protocol

from ballscrew_monitor.core.conversions import machine_nut
from ballscrew_monitor.core.estimate import (
    estimate,
    estimate_from,
    MachinePoint,
    PointEstimate,
    PointValidity,
)
from ballscrew_monitor.core.full_point import compare, Comparison, solved_at
from ballscrew_monitor.core.solver import Done, End, Step
from ballscrew_monitor.core.state import MonitorSettings
from ballscrew_monitor.messages.state_messages import fill_result, read_point, TIERS
from ballscrew_msgs.action import SolveOperatingPoint
from ballscrew_msgs.msg import PointResult
from surrogate.surface import solved_point, Surface, SurfacePoint

LONGEST_TIMEOUT = 3600.0  # [s]
NAN = math.nan


class SolvableAxis(Protocol):
    """What a full solve needs of an axis."""

    @property
    def name(self) -> str:
        """Return the name of the axis."""

    @property
    def surface(self) -> Surface:
        """Return the surface that is judged with."""

    @property
    def settings(self) -> MonitorSettings:
        """Return limits and parameters in force."""

    def current_point(self) -> MachinePoint | str:
        """Return the operating point of now, or why there is none."""

    def correct(self, point: MachinePoint, full: SurfacePoint) -> tuple[bool, str]:
        """Correct the surface by a full solve, or not; return whether, and what or why not."""


def requested_point(request: Any, axis: SolvableAxis) -> MachinePoint | str:
    """Return the point that a goal asks for, or what is wrong with the goal."""
    if not 0.0 <= request.timeout <= LONGEST_TIMEOUT:
        return f'timeout is {request.timeout:g} s, allowed is 0 to {LONGEST_TIMEOUT:g} s'
    if request.use_current:
        return axis.current_point()
    point = read_point(request.point, default_temperature=axis.settings.default_temperature)
    if not math.isfinite(point.speed + point.axial_load + point.temperature):
        return 'speed, axial load and temperature of the point must be finite'
    if point.speed == 0.0:
        return 'the speed of the point is 0 rad/s, a solve needs motion'
    return point


def feedback_message(step: Step, point: MachinePoint) -> Any:
    """Return how far a solve is, its nut in the machine frame."""
    return SolveOperatingPoint.Feedback(
        stage=step.stage,
        nut=int(machine_nut(step.nut, point.axial_load)),
        side=step.side,
        iteration=step.iteration,
        residual=float(step.residual),
        fraction=float(step.fraction),
        seconds_left=float(step.seconds_left),
    )


def empty_result(status: str) -> Any:
    """Return a result that knows nothing but why."""
    result = SolveOperatingPoint.Result(status=status, wall_time=NAN)
    for part in (result.full, result.surface):
        fill_result(part, PointEstimate(validity=PointValidity.UNKNOWN, reason=status), 0)
    result.efficiency_stderr = result.rcs_stderr = NAN
    _fill_comparison(result, Comparison())
    return result


def result_message(axis: SolvableAxis, point: MachinePoint, done: Done) -> Any:
    """Return the result of a solve that has ended; one that is worth it corrects the surface."""
    result = empty_result(_status(done))
    result.wall_time = float(done.wall_time)
    answer = estimate(point, axis.surface, rcs_limit=axis.settings.limits.rcs)
    fill_result(result.surface, answer, TIERS[axis.surface.tier])
    if done.end is End.SOLVED and done.result['converged']:
        load = solved_at(point).opposing_load
        full = read_solved(done.result, opposing_load=load, lead=axis.surface.lead)
        _fill_full(result, axis, point, full, answer)
    return result


def read_solved(frame: Mapping[str, Any], *, opposing_load: float, lead: float) -> SurfacePoint:
    """Return the point [N, m] that a frame of the solver holds; JSON knows no NaN."""
    groups = [
        {name: NAN if value is None else float(value) for name, value in frame[part].items()}
        for part in ('means', 'deviations', 'standard_errors')
    ]
    worst = int(frame['worst_contact'])
    return solved_point(*groups, worst_contact=worst, opposing_load=opposing_load, lead=lead)


def _fill_full(
    result: Any, axis: SolvableAxis, point: MachinePoint, full: SurfacePoint, answer: PointEstimate
) -> None:
    found = estimate_from(point, full, rcs_limit=axis.settings.limits.rcs)
    fill_result(result.full, found, PointResult.TIER_FULL)
    _fill_comparison(result, compare(full, answer.numbers))
    result.efficiency_stderr = float(full.efficiency_stderr)
    result.rcs_stderr = float(full.rcs_stderr)
    result.success = True
    result.corrected, result.correction = axis.correct(point, full)


def _fill_comparison(result: Any, comparison: Comparison) -> None:
    result.efficiency_difference = float(comparison.efficiency)
    result.rcs_difference = float(comparison.rcs)
    result.within_stated_error = comparison.within_stated_error


def _status(done: Done) -> str:
    if done.end is End.CANCELLED:
        return 'cancelled'
    return done.sentence or str(done.result.get('status', ''))
