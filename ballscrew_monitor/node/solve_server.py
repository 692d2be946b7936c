# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
The action `~/solve`: goals in, full solves by another process, results and corrections out.

No goal is ever awaited on the executor, which would spin: a timer looks after the goals while
there are any, and the answer of a goal is handed to the executor when it is ready.

"""

from collections.abc import Callable, Mapping
import dataclasses
import functools
import math
import time
from typing import Any

from ballscrew_monitor.core.conversions import celsius, kelvin, machine_nut
from ballscrew_monitor.judge.full_point import compare, request_of, solved_at, with_numbers
from ballscrew_monitor.judge.records import Row
from ballscrew_monitor.messages.state_messages import fill_result, read_point, TIERS
from ballscrew_monitor.messages.unjudged import reason_of
from ballscrew_monitor.node.axis_publisher import AxisPublisher
from ballscrew_monitor.node.solver import End, Job, MOST_WAITING, Solver, Step
from ballscrew_monitor.settings.parameters import REFUSALS
from ballscrew_msgs.action import SolveOperatingPoint
from ballscrew_msgs.msg import PointResult
from rclpy.action import ActionServer, CancelResponse, GoalResponse
from rclpy.action.server import ServerGoalHandle
from rclpy.clock import Clock, ClockType
from rclpy.node import Node
from rclpy.qos import QoSProfile
from surrogate.files.limits import COLDEST, HOTTEST, LOAD, SPEED
from surrogate.surface import FIELDS, solved_point, SurfacePoint
from surrogate.units import RPM

DEFAULT_TIMEOUT, LONGEST_TIMEOUT = 300.0, 3600.0  # [s]
SLOWEST = 1e-3  # [rad/s], a turn in two hours
POLL = 0.1  # [s]
FEEDBACK_PERIOD = 0.5  # [s]
MOST_SOLVES = 1 + MOST_WAITING
# With the ten of the default a burst of goals loses some, and who sent them waits for ever.
SERVICE_QOS = QoSProfile(depth=100)


@dataclasses.dataclass(kw_only=True, eq=False, slots=True)
class _Goal:
    """A goal at work; `handle` is None for a solve that the node has asked for itself."""

    axis: AxisPublisher
    row: Row  # of the point
    job: Job
    handle: ServerGoalHandle | None = None
    sent: float = -math.inf  # when feedback was last sent [s]


class _Server(ActionServer):
    """An action server whose goals are executed when their answer is there."""

    def notify_execute(
        self, goal_handle: ServerGoalHandle, execute_callback: Callable[..., Any] | None
    ) -> None:
        """Run the callback that answers a goal; without one the goal is just marked as begun."""
        if execute_callback is not None:
            super().notify_execute(goal_handle, execute_callback)


class SolveServer:
    """The goals of a node and the process that solves them."""

    def __init__(self, node: Node, find_axis: Callable[[str], AxisPublisher | str]) -> None:
        """Offer the action; `find_axis` returns an axis, or why it cannot be solved for."""
        self._node = node
        self._find_axis = find_axis
        self.solver = Solver()
        self._goals: dict[Job, _Goal] = {}
        self._timer: Any = None
        self._server = _Server(
            node,
            SolveOperatingPoint,
            '~/solve',
            execute_callback=lambda handle: SolveOperatingPoint.Result(),  # never asked for
            goal_callback=self._on_goal,
            handle_accepted_callback=self._on_accepted,
            cancel_callback=lambda handle: CancelResponse.ACCEPT,
            goal_service_qos_profile=SERVICE_QOS,
            result_service_qos_profile=SERVICE_QOS,
            cancel_service_qos_profile=SERVICE_QOS,
        )

    def close(self, reason: str) -> None:
        """Stop all solves; their goals end with the reason."""
        self.solver.close()
        for goal in list(self._goals.values()):
            goal.job.end, goal.job.sentence = End.FAILED, reason
            self._finish(goal)
        self._rest()

    def solve(self, axis: AxisPublisher, row: Row) -> None:
        """Solve a point for the node itself, to correct the surface; the outcome is logged."""
        self._begin(axis, row, DEFAULT_TIMEOUT, None)

    def _on_goal(self, request: Any) -> GoalResponse:
        row = self._wanted(request)[1]
        refusal = row if isinstance(row, str) else self.solver.refusal
        if not refusal:
            return GoalResponse.ACCEPT
        # Each is logged, since who has sent the goal reads the reason there.
        logger = self._node.get_logger().get_child(REFUSALS)
        logger.warning(f'solve of axis {request.axis} rejected: {refusal}')
        return GoalResponse.REJECT

    def _wanted(self, request: Any) -> tuple[AxisPublisher | str, Row | str]:
        """Return the axis and the point that a goal asks for, or why there is none."""
        axis = self._find_axis(request.axis)
        return axis, axis if isinstance(axis, str) else requested_point(request, axis)

    def _on_accepted(self, handle: ServerGoalHandle) -> None:
        request = handle.request
        axis, row = self._wanted(request)
        handle.execute()
        if isinstance(axis, str) or isinstance(row, str):
            self._answer(handle, empty_result(str(row)), End.FAILED)
        else:
            self._begin(axis, row, request.timeout or DEFAULT_TIMEOUT, handle)

    def _begin(
        self, axis: AxisPublisher, row: Row, timeout: float, handle: ServerGoalHandle | None
    ) -> None:
        job = Job(request=request_of(axis.surface, row), timeout=timeout)
        self._goals[job] = _Goal(axis=axis, row=row, job=job, handle=handle)
        self.solver.submit(job)
        if self._timer is None:
            # On the steady clock: simulated time may stand, and the solver does not.
            self._timer = self._node.create_timer(
                POLL, self._poll, clock=Clock(clock_type=ClockType.STEADY_TIME)
            )
        self._poll()

    def _poll(self) -> None:
        now = time.monotonic()
        for goal in self._goals.values():
            taken_back = goal.handle is not None and goal.handle.is_cancel_requested
            if taken_back and math.isnan(goal.job.cancelled):
                self.solver.cancel(goal.job, now)
        for job in self.solver.poll(now):
            self._finish(self._goals[job])
        for goal in self._goals.values():
            self._tell(goal, now)
        if not self._goals:
            self._rest()

    def _rest(self) -> None:
        """Do nothing until the next goal; the process stays, it has loaded the solver."""
        if self._timer is not None:
            self._node.destroy_timer(self._timer)
            self._timer = None

    def _tell(self, goal: _Goal, now: float) -> None:
        """Send feedback, if it is time."""
        if goal.handle is None or now - goal.sent < FEEDBACK_PERIOD:
            return
        goal.sent = now
        message = feedback_message(goal.job.step, goal.row)
        goal.handle.publish_feedback(message)

    def _finish(self, goal: _Goal) -> None:
        del self._goals[goal.job]
        result = result_message(goal.axis, goal.row, goal.job)
        end = End.FAILED if goal.job.end is End.SOLVED and not result.success else goal.job.end
        if goal.handle is not None:
            self._answer(goal.handle, result, end)
        else:
            sentence = result.correction if result.success else result.status
            self._node.get_logger().info(
                f'axis {goal.axis.name}: solved where it dwells: {sentence}'
            )

    def _answer(self, handle: ServerGoalHandle, result: Any, end: End | None) -> None:
        """Hand the answer of a goal to the executor."""
        self._server.notify_execute(handle, functools.partial(_end_goal, result=result, end=end))


def _end_goal(handle: ServerGoalHandle, *, result: Any, end: End | None) -> Any:
    if end is End.SOLVED:
        handle.succeed()
    elif end is End.CANCELLED and handle.is_cancel_requested:
        handle.canceled()
    else:
        handle.abort()
    return result


def requested_point(request: Any, axis: AxisPublisher) -> Row | str:
    """Return the point that a goal asks for, or what is wrong with the goal."""
    if not 0.0 <= request.timeout <= LONGEST_TIMEOUT:
        return f'timeout is {request.timeout:g} s, allowed is 0 to {LONGEST_TIMEOUT:g} s'
    if request.use_current:
        return axis.current_point()
    row = read_point(request.point, default_temperature=axis.settings.default_temperature)
    if not math.isfinite(row.speed + row.axial_load + row.temperature):
        return 'speed, axial load and temperature of the point must be finite'
    if row.speed == 0.0:
        return 'the speed of the point is 0 rad/s, a solve needs motion'
    if not SLOWEST <= abs(row.speed) <= SPEED * RPM:
        allowed = f'{SLOWEST:g} to {SPEED * RPM:g} rad/s in either direction'
        return f'the speed of the point is {row.speed:g} rad/s, allowed is {allowed}'
    if abs(row.axial_load) > LOAD:
        allowed = f'0 to {LOAD:g} N in either direction'
        return f'the axial load of the point is {row.axial_load:g} N, allowed is {allowed}'
    if not kelvin(COLDEST) <= row.temperature <= kelvin(HOTTEST):
        given = f'{celsius(row.temperature):g} degC'
        return (
            f'the temperature of the point is {given}, allowed is {COLDEST:g} to {HOTTEST:g} degC'
        )
    return row


def feedback_message(step: Step, row: Row) -> Any:
    """Return how far a solve is, its nut in the machine frame."""
    return SolveOperatingPoint.Feedback(
        stage=step.stage,
        nut=int(machine_nut(step.nut, row.axial_load)),
        side=step.side,
        iteration=step.iteration,
        residual=float(step.residual),
        fraction=float(step.fraction),
        seconds_left=float(step.seconds_left),
    )


def empty_result(status: str) -> Any:
    """Return a result that knows nothing but why."""
    result = SolveOperatingPoint.Result(status=status, wall_time=math.nan)
    for part in (result.full, result.surface):
        fill_result(part, Row(), 0, status)
    result.efficiency_stderr = result.rcs_stderr = math.nan
    result.efficiency_difference = result.rcs_difference = math.nan
    return result


def result_message(axis: AxisPublisher, row: Row, job: Job) -> Any:
    """Return the result of a solve that has ended; one that is worth it corrects the surface."""
    status = job.sentence or str(job.result.get('status', ''))
    result = empty_result('cancelled' if job.end is End.CANCELLED else status)
    result.wall_time = float(job.wall_time)
    answer = axis.answer(row)
    reason = reason_of(answer, axis.surface)
    fill_result(result.surface, answer, TIERS[axis.surface.tier], reason)
    if job.end is End.SOLVED and job.result['converged']:
        load = solved_at(row).opposing_load
        full = read_solved(job.result, opposing_load=load, lead=axis.surface.lead)
        solved = with_numbers(answer, full, rcs_limit=axis.settings.limits.rcs)
        fill_result(result.full, solved, PointResult.TIER_FULL, '')
        differences, result.within_stated_error = compare(full, answer)
        result.efficiency_difference = float(differences['efficiency'])
        result.rcs_difference = float(differences['rcs'])
        result.efficiency_stderr = float(full.efficiency_stderr)
        result.rcs_stderr = float(full.rcs_stderr)
        result.success = True
        result.corrected, result.correction = axis.correct(answer, full)
    return result


def read_solved(solved: Mapping[str, Any], *, opposing_load: float, lead: float) -> SurfacePoint:
    """Return the point [N, m] that the solver has found, a `SolvedPoint` as plain JSON."""
    spread = dict.fromkeys(FIELDS, math.nan) | {'rcs': solved['rcs_deviation']}
    worst, means = solved['worst_contact'], {name: solved[name] for name in FIELDS}
    return solved_point(
        *(means, spread, spread), worst_contact=worst, opposing_load=opposing_load, lead=lead
    )
