# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The lifecycle node: declare, subscribe, call the monitor, publish. It decides nothing itself."""

from collections.abc import Callable, Iterable, Sequence
import functools
import traceback
from typing import Any

from ballscrew_monitor.core.conversions import nanoseconds, seconds
from ballscrew_monitor.core.fault_codes import Fault
from ballscrew_monitor.core.inputs import InputSample, Refusal
from ballscrew_monitor.core.tick_grid import ClockSteps, TickGrid
from ballscrew_monitor.judge.records import Row
from ballscrew_monitor.messages import diagnostics
from ballscrew_monitor.node.alarm import LatchedTopics
from ballscrew_monitor.node.axis_healths import AxisHealths
from ballscrew_monitor.node.axis_publisher import AxisPublisher, end_all, STATE_QOS
from ballscrew_monitor.node.axis_services import AxisServices, not_built
from ballscrew_monitor.node.compiled_turns import CompiledTurns
from ballscrew_monitor.node.event_recorder import NodeRecorder
from ballscrew_monitor.node.heartbeat import Heartbeat
from ballscrew_monitor.node.intake import Intake, system_step
from ballscrew_monitor.node.kept_axes import KeptAxes
from ballscrew_monitor.node.parameter_store import is_kept, ParameterStore
from ballscrew_monitor.node.printable_log import printable_logger
from ballscrew_monitor.node.restart_state import RestartState, state_directory
from ballscrew_monitor.node.solve_server import SolveServer
from ballscrew_monitor.node.state_records import Kind, step_text
from ballscrew_monitor.node.turn import AxisTurn
from ballscrew_monitor.recordings.bulk.events import ticks
from ballscrew_monitor.settings import parameters
from ballscrew_monitor.settings.axis import Axis, build_axes, named_topics, start_text
from ballscrew_monitor.settings.qos import check_overrides, longest_period
from ballscrew_msgs.srv import EvaluateOperatingPoint
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from rcl_interfaces.msg import SetParametersResult
from rclpy.clock import Clock, ClockType
from rclpy.executors import Executor
from rclpy.lifecycle import LifecycleNode, LifecycleState, TransitionCallbackReturn
from rclpy.parameter import Parameter
from surrogate.files import InputError

SUCCESS, FAILURE = TransitionCallbackReturn.SUCCESS, TransitionCallbackReturn.FAILURE
MEGABYTE = 1e6  # [B]


def _reported(transition: Callable[..., Any]) -> Callable[..., Any]:
    """Log an exception in a transition; rclpy swallows it and goes to error processing."""

    @functools.wraps(transition)
    def report(self: LifecycleNode, state: LifecycleState) -> Any:
        try:
            return transition(self, state)
        except Exception:
            self.get_logger().error(traceback.format_exc())
            raise

    return report


class BallscrewMonitor(LifecycleNode):
    """Lifecycle node that judges the lubrication and efficiency of one or more axes."""

    def __init__(self, **kwargs: Any) -> None:
        """Declare everything; raises InputError for a bad parameter."""
        super().__init__(parameters.NODE_NAME, **kwargs)
        printable_logger(self.get_logger())
        # Held by others too, so both are filled and cleared and never replaced.
        self._axis_publishers: dict[str, AxisPublisher] = {}
        self._active = self._finalized = False
        self._reason = 'not configured'
        self._failed: dict[str, str] = {}  # axes that could not be built, and why
        self._intake: Intake | None = None
        self._tick_timer: Any = None
        self._steady = Clock(clock_type=ClockType.STEADY_TIME)
        self._store = ParameterStore(self, self._on_parameters)
        self._values = self._store.values
        self._recording = NodeRecorder(self, self._values, self._axis_publishers)
        self._grid = TickGrid(nanoseconds(self._values['tick_period']))
        self._compiled = CompiledTurns(self.get_logger().warning)
        self._steps = ClockSteps()  # of the system, also while the node is inactive
        self._heartbeat = Heartbeat(self, clock=self._steady)
        self._diagnostics = self.create_publisher(DiagnosticArray, '/diagnostics', STATE_QOS)
        # On the steady clock: it speaks while a simulated one stands.
        self.create_timer(
            self._values['diagnostics_period'], self._publish_diagnostics, clock=self._steady
        )
        self.create_service(EvaluateOperatingPoint, '~/evaluate', self._on_evaluate)
        self._latched = {name: LatchedTopics(self, name) for name in self._values['axes']}
        state = RestartState(
            state_directory(self._values['state_dir'], self.get_fully_qualified_name()),
            limit=round(self._values['state_limit'] * MEGABYTE),
        )
        publishers = self._axis_publishers
        self._kept = KeptAxes(
            self, state, publishers, self._on_kept, clock=self._steady, catch_up=self._catch_up
        )
        self._solves = SolveServer(self, self._find_publisher)
        AxisServices(
            self,
            self._values,
            publishers,
            self._failed,
            self._unknown,
            self._on_service,
            self._catch_up,
        )
        self._healths = AxisHealths(
            self,
            self._values,
            publishers,
            self._latched,
            self._kept,
            self._recording.record,
            clock=self._steady,
        )

    @property
    def executor(self) -> Executor | None:
        """Return the executor, None while the node has none."""
        return super().executor

    @executor.setter
    def executor(self, executor: Any) -> None:
        """Take an executor that waits in a wait set; raises InputError for any other one."""
        if executor is not None and not isinstance(executor, Executor):
            executor.remove_node(self)
            raise InputError(
                f'{type(executor).__name__} cannot spin {parameters.NODE_NAME}, whose inputs it '
                'would never hear: spin it with a SingleThreadedExecutor or a '
                'MultiThreadedExecutor'
            )
        spun: Any = LifecycleNode.executor
        spun.fset(self, executor)

    def set_parameters_atomically(self, parameter_list: list[Parameter]) -> SetParametersResult:
        """Set parameters; one that keeps its value is no change: a node takes its own dump."""
        changed = [parameter for parameter in parameter_list if not is_kept(self, parameter)]
        if not changed:
            return SetParametersResult(successful=True)
        return super().set_parameters_atomically(changed)

    def start(self) -> None:
        """Configure and activate, if the node is to do so itself."""
        if self._values['autostart'] and self.trigger_configure() == SUCCESS:
            self.trigger_activate()

    def finish(self) -> None:
        """Go to the final lifecycle state, if the node is not there yet."""
        if not self._finalized:
            self.trigger_shutdown()

    def _on_parameters(self, groups: set[str]) -> None:
        for name in groups & self._axis_publishers.keys():
            publisher = self._axis_publishers[name]
            publisher.guarded('new parameters', publisher.adapt)
            self._recording.snapshot([name], 'parameters')

    @_reported
    def on_configure(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Load the surfaces, compile the inputs; without one axis that works stay unconfigured."""
        try:
            resolve = self.resolve_topic_name
            check_overrides(self._store.given, named_topics(self._values, resolve))
            axes, reasons = build_axes(self._values, resolve)
            self._recording.configure(self._kept.state.folder)
        except InputError as error:
            axes, reasons = [], dict.fromkeys(self._values['axes'], str(error))
        self._failed.clear()
        self._failed |= {name: f'not configured: {why}' for name, why in reasons.items()}
        for reason in dict.fromkeys(self._failed.values()):
            self.get_logger().error(reason)
        if not axes:
            self._publish_diagnostics()
            return FAILURE
        self._axis_publishers |= {
            axis.name: AxisPublisher(
                self,
                axis,
                self._values,
                latched=self._latched[axis.name],
                kept=self._kept,
                recording=self._recording,
            )
            for axis in axes
        }
        self._kept.restore()
        name, folder = self.get_fully_qualified_name(), self._kept.state.folder
        for axis in axes:
            self.get_logger().info(start_text(axis, name, resolve, folder))
        self._store.ceilings = {
            f'{axis.name}.publish_period': longest_period(axis.name, self._values) for axis in axes
        }
        self._store.locked = True
        self._publish_diagnostics()
        return super().on_configure(state)

    def _find_publisher(self, axis: str) -> AxisPublisher | str:
        """Return what a solve of an axis needs, or why there is none."""
        if axis not in self._axis_publishers:
            return self._unknown(axis)
        if not self._active:
            return 'the node is inactive, activate it first'
        return self._axis_publishers[axis]

    def _unknown(self, axis: str) -> str:
        if axis in self._failed:
            return not_built(axis, self._failed[axis])
        known = ', '.join(self._axis_publishers) or 'none, the node is not configured'
        return f'axis {axis!r} is unknown, known are: {known}'

    @_reported
    def on_activate(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Subscribe and begin to judge."""
        result = super().on_activate(state)
        self._active = True
        self._recording.begin()
        for publisher in self._axis_publishers.values():
            publisher.publish_info()
            publisher.guarded('its activation', publisher.alarm.publish)
        axes = [publisher.axis for publisher in self._axis_publishers.values()]
        self._healths.begin()
        self._intake = Intake(
            self,
            axes,
            self._on_event,
            self._recording.events,
            self._guard,
            self._heartbeat.vitals.work,
            self._on_step,
            self._steps,
            self._compiled,
            self._on_turn,
        )
        # A timer on the system clock stops when that is set back, for as long as it was set back.
        clock = self.get_clock() if self.get_parameter('use_sim_time').value else self._steady
        self._tick_timer = self.create_timer(
            self._values['tick_period'], self._on_tick, clock=clock
        )
        self._publish_diagnostics()
        return result

    @_reported
    def on_deactivate(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Stop to judge; levels, events and totals stand."""
        self._stop()
        self._kept.remember_all()
        self._kept.state.flush()
        result = super().on_deactivate(state)
        self._publish_diagnostics()
        return result

    @_reported
    def on_cleanup(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Forget the axes."""
        self._clear('not configured')
        return SUCCESS

    @_reported
    def on_shutdown(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Stop and forget the axes."""
        self._finalized = True
        self._clear('shut down')
        self._kept.close()
        return SUCCESS

    def on_error(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Fall back to unconfigured after an exception in a transition."""
        self._clear('not configured: a transition failed unexpectedly')
        return SUCCESS

    def _on_kept(self, axes: Iterable[str]) -> None:
        """Say what has changed by itself in what is kept of some axes."""
        self._recording.snapshot(axes, 'kept')
        self._publish_diagnostics(list(axes))

    def _on_service(self, axes: Iterable[str], name: str) -> str:
        """Keep what a service has changed at once; return why that failed, or nothing."""
        self._recording.snapshot(axes, name)
        self._publish_diagnostics(list(axes))
        return self._kept.state.flush()

    def _stop(self, reason: str = '') -> None:
        """Judge no longer; for a `reason` events end, while they are still recorded."""
        self._catch_up()
        self._active = False
        self._solves.close('stopped, the node is no longer active')
        self._healths.end()
        if self._intake is not None:
            self._intake.close()
            self._intake = None
        if reason:
            end_all(self._axis_publishers.values(), reason, self._steady)
        self._recording.close()
        if self._tick_timer is not None:
            self.destroy_timer(self._tick_timer)
            self._tick_timer = None

    def _clear(self, reason: str) -> None:
        self._stop(reason)
        for publisher in self._axis_publishers.values():
            publisher.close()
        self._axis_publishers.clear()
        self._failed.clear()
        self._kept.state.flush()
        self._kept.state.forget_problems()
        self._store.locked = False
        self._reason = reason
        self._publish_diagnostics()

    def _on_event(self, axis: Axis, event: InputSample | Refusal) -> None:
        self._judge(self._axis_publishers[axis.name], axis.monitor.update, event)

    def _on_step(self, step: int, now: int) -> None:
        """Note by how much [ns] the clock of the node was set to `now` [ns]."""
        text = f'the clock was set {step_text(step)}'
        self.get_logger().warning(text)
        self._kept.note(Kind.CLOCK_STEP, stamp=now, by_s=seconds(step), text=text)
        self._heartbeat.set_clock(step)
        self._healths.set_clock(step, now)
        self._publish_diagnostics()

    def _catch_up(self) -> None:
        """Take what waits, and any step of the clock, before something else than an event."""
        if self._intake is not None:
            self._intake.drain()
        elif not self.get_parameter('use_sim_time').value and (step := system_step(self._steps)):
            now = self.get_clock().now().nanoseconds
            for publisher in self._axis_publishers.values():
                set_clock = publisher.axis.monitor.set_clock
                publisher.guarded('a step of the clock', set_clock, now - step, now)
            self._on_step(step, now)

    def _guard(
        self, axis: Axis, place: str, call: Callable[..., Any], *args: Any, **named: Any
    ) -> Any:
        return self._axis_publishers[axis.name].guarded(place, call, *args, **named)

    def _judge(
        self, publisher: AxisPublisher, judge: Callable[[Any], Row | None], event: Any
    ) -> None:
        """Judge a sample, a refusal or a tick; a defect is an error of its axis alone."""
        known = publisher.defect
        publisher.guarded(event, self._judge_one, publisher, judge, event)
        self._healths.take(publisher.name, publisher.axis.monitor.row)
        if publisher.defect != known:
            self._publish_diagnostics([publisher.name])

    def _on_turn(self, turn: AxisTurn) -> None:
        """Judge the events of a turn, compiled; a defect is an error of their axis alone."""
        publisher = self._axis_publishers[turn.axis.name]
        known = publisher.defect
        publisher.guarded(f'{len(turn.events)} events', self._judge_many, publisher, turn)
        if publisher.defect != known:
            self._publish_diagnostics([publisher.name])

    def _judge_many(self, publisher: AxisPublisher, turn: AxisTurn) -> None:
        judge, begin = publisher.many, 0
        for judged in judge.judge(turn.events, states=True):
            for at, row in judge.told(judged):
                turn.hear_joints(int(judged.places[at]))
                self._note_leap(publisher)
                end = at + 1
                publisher.frame.take_many(judged.rows[begin:end])
                begin = end
                place = f'the state of {row.stamp} ns'
                publisher.guarded(place, self._publish, publisher, row)
            self._note_leap(publisher)
            publisher.frame.take_many(judged.rows[begin:])
            self._healths.take_many(publisher.name, judged.rows)
            begin = 0
        turn.hear_joints(len(turn.events))

    def _note_leap(self, publisher: AxisPublisher) -> None:
        if (moved := publisher.axis.monitor.moved) and publisher.may_note_leap():
            text = f'the stamps of the speed leap {step_text(moved)} in a warning'
            self._kept.note(Kind.CLOCK_STEP, publisher.name, by_s=seconds(moved), text=text)

    def _judge_one(
        self, publisher: AxisPublisher, judge: Callable[[Any], Row | None], event: Any
    ) -> None:
        row = judge(event)
        self._note_leap(publisher)
        publisher.frame.take(publisher.axis.monitor.row)
        self._publish(publisher, row)

    def _on_tick(self) -> None:
        """Tick on the grid of stamps, when that is due; what has arrived by then comes first."""
        if self._intake is None:
            return
        self._intake.discover()
        self._intake.drain()
        now = self._intake.now
        grid = self._grid.tick(now)
        if grid is None:
            return
        steady = self._steady.now().nanoseconds
        self._recording.events.tick(grid, now, steady)
        self._recording.events.flush()
        for publisher in self._axis_publishers.values():
            if self._intake.is_compiled:
                self._on_turn(AxisTurn(publisher.axis, ticks([grid], place=0), {}))
            else:
                self._judge(publisher, publisher.axis.monitor.tick, grid)
        self._recording.renew(steady, now)

    def _publish(self, publisher: AxisPublisher, row: Row | None) -> None:
        """Publish a state, and diagnostics for what it changes, though these not in a flood."""
        if row is None:
            return
        publisher.publish_state(row)
        if publisher.is_dwelling(row) and not self._solves.solver.busy:
            self.get_logger().info(f'axis {publisher.name}: solving the point where it dwells')
            self._solves.solve(publisher, row)
        now = self._steady.now().nanoseconds
        if publisher.has_news(now):  # what comes too soon is sent with the next state or the timer
            publisher.say_news(now)
            self._publish_diagnostics([publisher.name])

    def _publish_diagnostics(self, axes: Sequence[str] | None = None) -> None:
        """Publish the diagnostics of some axes, or of all."""
        now = self.get_clock().now()
        for publisher in self._axis_publishers.values():
            publisher.log_inputs(self._steady.now().nanoseconds)
        stood = self._grid.stood(now.nanoseconds, self._steady.now().nanoseconds)
        statuses = self._statuses(self._values['axes'] if axes is None else axes, stood)
        if axes is None:
            statuses += self._kept.statuses() + self._heartbeat.statuses()
        message = DiagnosticArray(status=statuses)
        message.header.stamp = now.to_msg()
        self._diagnostics.publish(message)
        self._recording.record('/diagnostics', message)

    def _statuses(self, axes: Sequence[str], stood: int) -> list[DiagnosticStatus]:
        statuses, node = [], self.get_fully_qualified_name()
        for name in axes:
            if name in self._axis_publishers:
                publisher = self._axis_publishers[name]
                links = self._intake.links(publisher.axis) if self._intake else None
                statuses += publisher.statuses(links=links, stood=stood)
            else:
                code = Fault.NOT_BUILT if name in self._failed else Fault.NOT_CONFIGURED
                statuses += diagnostics.failed(
                    node, name, self._failed.get(name, self._reason), code
                )
        return statuses + self._healths.statuses(axes) + self._recording.statuses()

    def _on_evaluate(self, request: Any, response: Any) -> Any:
        """Answer what the surface says of the points; what arrives meanwhile is judged."""
        publisher = self._axis_publishers.get(request.axis)
        if publisher is None:
            response.message = self._unknown(request.axis)
        else:
            publisher.evaluate(request.points, response, self._on_tick)
        return response
