# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
The action `~/solve`: goals in, full solves by another process, results and corrections out.

No goal is ever awaited on the executor, which would spin: a timer looks after the goals while
there are any, and the answer of a goal is handed to the executor when it is ready.

"""

from collections.abc import Callable
import dataclasses
import functools
import math
import time
from typing import Any

from ballscrew_monitor.core.estimate import MachinePoint
from ballscrew_monitor.core.full_point import request_of
from ballscrew_monitor.core.solver import Done, End, Job, MOST_WAITING, Process, Solver
from ballscrew_monitor.messages import solve_messages
from ballscrew_monitor.messages.solve_messages import SolvableAxis
from ballscrew_msgs.action import SolveOperatingPoint
from rclpy.action import ActionServer, CancelResponse, GoalResponse
from rclpy.action.server import ServerGoalHandle
from rclpy.clock import Clock, ClockType
from rclpy.node import Node
from rclpy.qos import QoSProfile

DEFAULT_TIMEOUT = 300.0  # [s]
POLL = 0.1  # [s]
FEEDBACK_PERIOD = 0.5  # [s]
MOST_SOLVES = 1 + MOST_WAITING
# With the ten of the default a burst of goals loses some, and who sent them waits for ever.
SERVICE_QOS = QoSProfile(depth=100)


@dataclasses.dataclass(kw_only=True, eq=False, slots=True)
class _Goal:
    """A goal at work; `handle` is None for a solve that the node has asked for itself."""

    axis: SolvableAxis
    point: MachinePoint
    job: Job
    handle: ServerGoalHandle | None = None
    told: float = -math.inf  # when feedback was last sent [s]


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

    def __init__(
        self,
        node: Node,
        start: Callable[[], Process],
        find_axis: Callable[[str], SolvableAxis | str],
    ) -> None:
        """Offer the action; `find_axis` returns an axis, or why it cannot be solved for."""
        self._node = node
        self._find_axis = find_axis
        self._solver = Solver(start)
        self._goals: dict[Job, _Goal] = {}
        self._timer: Any = None
        self._server = _Server(
            node,
            SolveOperatingPoint,
            '~/solve',
            execute_callback=_answer_nothing,
            goal_callback=self._on_goal,
            handle_accepted_callback=self._on_accepted,
            cancel_callback=lambda handle: CancelResponse.ACCEPT,
            goal_service_qos_profile=SERVICE_QOS,
            result_service_qos_profile=SERVICE_QOS,
            cancel_service_qos_profile=SERVICE_QOS,
        )

    def close(self, reason: str) -> None:
        """Stop all solves; their goals end with the reason."""
        self._solver.close()
        for goal in list(self._goals.values()):
            self._finish(goal, Done(job=goal.job, end=End.FAILED, sentence=reason))
        self._rest()

    @property
    def busy(self) -> bool:
        """Tell whether a solve is at work or waits."""
        return self._solver.busy

    def solve(self, axis: SolvableAxis, point: MachinePoint) -> None:
        """Solve a point for the node itself, to correct the surface; the outcome is logged."""
        self._begin(axis, point, DEFAULT_TIMEOUT, None)

    def _on_goal(self, request: Any) -> GoalResponse:
        refusal = self._solver.refusal
        if not refusal:
            return GoalResponse.ACCEPT
        self._node.get_logger().warning(
            f'solve of axis {request.axis} rejected: {refusal}', throttle_duration_sec=1.0
        )
        return GoalResponse.REJECT

    def _on_accepted(self, handle: ServerGoalHandle) -> None:
        request = handle.request
        axis = self._find_axis(request.axis)
        point = axis if isinstance(axis, str) else solve_messages.requested_point(request, axis)
        handle.execute()
        if isinstance(axis, str) or isinstance(point, str):
            self._answer(handle, solve_messages.empty_result(str(point)), End.FAILED)
        else:
            self._begin(axis, point, request.timeout or DEFAULT_TIMEOUT, handle)

    def _begin(
        self,
        axis: SolvableAxis,
        point: MachinePoint,
        timeout: float,
        handle: ServerGoalHandle | None,
    ) -> None:
        job = Job(request=request_of(axis.surface, point), timeout=timeout)
        self._goals[job] = _Goal(axis=axis, point=point, job=job, handle=handle)
        self._solver.submit(job)
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
                self._solver.cancel(goal.job, now)
        for done in self._solver.poll(now):
            self._finish(self._goals[done.job], done)
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
        if goal.handle is None or now - goal.told < FEEDBACK_PERIOD:
            return
        goal.told = now
        message = solve_messages.feedback_message(goal.job.step, goal.point)
        goal.handle.publish_feedback(message)

    def _finish(self, goal: _Goal, done: Done) -> None:
        del self._goals[goal.job]
        result = solve_messages.result_message(goal.axis, goal.point, done)
        end = End.FAILED if done.end is End.SOLVED and not result.success else done.end
        if goal.handle is not None:
            self._answer(goal.handle, result, end)
        else:
            said = result.correction if result.success else result.status
            self._node.get_logger().info(f'axis {goal.axis.name}: solved where it dwells: {said}')

    def _answer(self, handle: ServerGoalHandle, result: Any, end: End) -> None:
        """Hand the answer of a goal to the executor."""
        self._server.notify_execute(handle, functools.partial(_end_goal, result=result, end=end))


def _answer_nothing(handle: ServerGoalHandle) -> Any:
    """Stand where rclpy wants a callback; goals are answered by `SolveServer`."""
    return SolveOperatingPoint.Result()


def _end_goal(handle: ServerGoalHandle, *, result: Any, end: End) -> Any:
    if end is End.SOLVED:
        handle.succeed()
    elif end is End.CANCELLED and handle.is_cancel_requested:
        handle.canceled()
    else:
        handle.abort()
    return result
