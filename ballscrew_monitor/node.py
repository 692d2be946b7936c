# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The lifecycle node: declare, subscribe, call the monitor, publish. It decides nothing itself."""

import dataclasses
import functools
import signal
import sys
import traceback
from typing import Any, Callable

from ballscrew_msgs.msg import BallScrewState, OutOfZone, PointResult, SurfaceInfo
from ballscrew_msgs.srv import EvaluateOperatingPoint
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from rcl_interfaces.msg import SetParametersResult
import rclpy
from rclpy.clock import Clock, ClockType
from rclpy.exceptions import ParameterException
from rclpy.executors import SingleThreadedExecutor
from rclpy.lifecycle import LifecycleNode, LifecycleState, TransitionCallbackReturn
from rclpy.parameter import Parameter
from rclpy.qos import (
    QoSDurabilityPolicy, QoSHistoryPolicy, QoSProfile, QoSReliabilityPolicy)
from rclpy.signals import SignalHandlerOptions
from std_srvs.srv import Trigger

from ballscrew_monitor import diagnostics, parameters
from ballscrew_monitor.axis import Axis, build_axis, load_surface
from ballscrew_monitor.conversions import nanoseconds
from ballscrew_monitor.errors import InputError
from ballscrew_monitor.estimate import estimate
from ballscrew_monitor.inputs import Input, Source
from ballscrew_monitor.judgement import Level
from ballscrew_monitor.messages import (
    fill_result, out_of_zone_message, read_point, StateWriter, surface_info_message, TIERS)
from ballscrew_monitor.monitor import State

SUCCESS, FAILURE = TransitionCallbackReturn.SUCCESS, TransitionCallbackReturn.FAILURE
INPUT_QOS = QoSProfile(
    history=QoSHistoryPolicy.KEEP_LAST, depth=200, reliability=QoSReliabilityPolicy.BEST_EFFORT,
    durability=QoSDurabilityPolicy.VOLATILE)
STATE_QOS = QoSProfile(depth=10, reliability=QoSReliabilityPolicy.RELIABLE)
LATCHED_QOS = QoSProfile(depth=1, reliability=QoSReliabilityPolicy.RELIABLE,
                         durability=QoSDurabilityPolicy.TRANSIENT_LOCAL)
NEWS_INTERVAL = nanoseconds(0.1)  # [ns] shortest time between two diagnostics sent for a change
POLL = 0.2  # [s] longest wait before a signal is noticed


@dataclasses.dataclass(kw_only=True, slots=True)
class Station:
    """One axis and what the node needs to speak for it."""

    axis: Axis
    writer: StateWriter
    state_publisher: Any
    event_publisher: Any
    info_publisher: Any
    subscriptions: dict[Source, Any] = dataclasses.field(default_factory=dict)
    last: State | None = None
    said: tuple[diagnostics.Summary, ...] = ()


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
        self._stations: dict[str, Station] = {}
        self._active = False
        self._finalized = False
        self._reason = ''  # why the last configure failed
        self._inputs: list[Any] = []
        self._tick_timer: Any = None
        self._last_grid = -1
        self._steady = Clock(clock_type=ClockType.STEADY_TIME)
        self._news_time = 0
        self._declare()
        self._diagnostics = self.create_publisher(DiagnosticArray, '/diagnostics', STATE_QOS)
        self.create_timer(self._values['diagnostics_period'], self._publish_diagnostics,
                          clock=self._steady)
        self.create_service(EvaluateOperatingPoint, '~/evaluate', self._on_evaluate)
        self.create_service(Trigger, '~/reload_surface', self._on_reload)
        self.create_service(Trigger, '~/reset_totals', self._on_reset)
        self.create_service(Trigger, '~/acknowledge', self._on_acknowledge)

    def start(self) -> None:
        """Configure and activate, if the node is to do so itself."""
        if self._values['autostart'] and self.trigger_configure() == SUCCESS:
            self.trigger_activate()

    def finish(self) -> None:
        """Go to the final lifecycle state, if the node is not there yet."""
        if not self._finalized:
            self.trigger_shutdown()

    # Parameters

    def _declare(self) -> None:
        # Private to rclpy; without it rclpy refuses bad values itself, in its own words.
        self._given = {name: _plain(given.value) for name, given in
                       getattr(self, '_parameter_overrides', {}).items()}
        self._values: dict[str, Any] = {}
        self._declare_rows({row.name: row for row in parameters.NODE_ROWS})
        self._rows = parameters.table(self._values['axes'])
        for name in self._given:  # a slip of the pen must not pass for the default
            if name.partition('.')[0] in self._values['axes'] and name not in self._rows:
                raise InputError(f'parameter {name} is unknown')
        self._declare_rows(self._rows)
        self.add_on_set_parameters_callback(self._check_parameters)
        self.add_post_set_parameters_callback(self._take_parameters)

    def _declare_rows(self, rows: dict[str, parameters.Row]) -> None:
        for name, row in rows.items():
            if name in self._values:
                continue
            if name in self._given:
                row.check(name, self._given[name])
            default = parameters.default_of(name, row)
            self._values[name] = _plain(
                self.declare_parameter(name, default, row.descriptor()).value)

    def _check_parameters(self, changed: list[Parameter]) -> SetParametersResult:
        try:
            for parameter in changed:
                self._check_parameter(parameter)
        except InputError as error:
            return SetParametersResult(successful=False, reason=str(error))
        return SetParametersResult(successful=True)

    def _check_parameter(self, parameter: Parameter) -> None:
        row = self._rows.get(parameter.name)
        if row is None:
            return
        row.check(parameter.name, _plain(parameter.value))
        if row.change is parameters.Change.UNCONFIGURED and self._stations:
            raise InputError(f'parameter {parameter.name} changes only while the node is '
                             'unconfigured, clean it up first')

    def _take_parameters(self, changed: list[Parameter]) -> None:
        self._values |= {parameter.name: _plain(parameter.value) for parameter in changed
                         if parameter.name in self._rows}
        touched = {parameter.name.partition('.')[0] for parameter in changed}
        for name, station in self._stations.items():
            if name in touched:
                station.axis.adapt(self._values)
                self._publish_info(station)

    # Lifecycle

    @_reported
    def on_configure(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Load the surfaces and compile the inputs; on failure stay unconfigured, with a reason."""
        try:
            axes = [build_axis(name, self._values) for name in self._values['axes']]
            self._check_topics(axes)
        except InputError as error:
            self._reason = str(error)
            self.get_logger().error(f'not configured: {error}')
            self._publish_diagnostics()
            return FAILURE
        self._reason = ''
        self._stations = {axis.name: self._make_station(axis) for axis in axes}
        self._publish_diagnostics()
        return super().on_configure(state)

    def _check_topics(self, axes: list[Axis]) -> None:
        types: dict[str, str] = {}
        for axis in axes:
            for source in axis.inputs:
                try:
                    topic = self.resolve_topic_name(source.topic)
                except RuntimeError:
                    raise InputError(f'parameter {axis.name}.{source.source.name.lower()}.topic '
                                     f'is {source.topic!r}, no topic name') from None
                if types.setdefault(topic, source.type_name) != source.type_name:
                    raise InputError(f'topic {topic} is configured as {types[topic]} and as '
                                     f'{source.type_name}')

    def _make_station(self, axis: Axis) -> Station:
        make = self.create_lifecycle_publisher
        return Station(
            axis=axis, writer=StateWriter(axis.name, TIERS[axis.surface.tier]),
            state_publisher=make(BallScrewState, f'~/{axis.name}/state', STATE_QOS),
            event_publisher=make(OutOfZone, f'~/{axis.name}/out_of_zone', LATCHED_QOS),
            info_publisher=make(SurfaceInfo, f'~/{axis.name}/surface_info', LATCHED_QOS))

    @_reported
    def on_activate(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Subscribe and begin to judge."""
        result = super().on_activate(state)
        self._active = True
        for station in self._stations.values():
            self._publish_info(station)
            self._publish_event(station)
        self._subscribe()
        self._tick_timer = self.create_timer(self._values['tick_period'], self._on_tick)
        self._publish_diagnostics()
        return result

    def _subscribe(self) -> None:
        """Subscribe once to each topic, however many inputs read it."""
        readers: dict[str, list[tuple[Station, Input]]] = {}
        for station in self._stations.values():
            for source in station.axis.inputs:
                readers.setdefault(self.resolve_topic_name(source.topic), []).append(
                    (station, source))
        for topic, those in readers.items():
            subscription = self.create_subscription(
                those[0][1].message_type, topic, functools.partial(self._on_message, those),
                INPUT_QOS)
            self._inputs.append(subscription)
            for station, source in those:
                station.subscriptions[source.source] = subscription

    @_reported
    def on_deactivate(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Stop to judge; levels, events and totals stand."""
        self._stop()
        result = super().on_deactivate(state)
        self._publish_diagnostics()
        return result

    @_reported
    def on_cleanup(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Forget the axes."""
        self._clear()
        return SUCCESS

    @_reported
    def on_shutdown(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Stop and forget the axes."""
        self._finalized = True
        self._clear()
        return SUCCESS

    def on_error(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Fall back to unconfigured after an exception in a transition."""
        self._reason = 'a transition failed unexpectedly'
        self.get_logger().error(self._reason)
        self._clear()
        return SUCCESS

    def _stop(self) -> None:
        self._active = False
        for subscription in self._inputs:
            self.destroy_subscription(subscription)
        self._inputs = []
        for station in self._stations.values():
            station.subscriptions = {}
        if self._tick_timer is not None:
            self.destroy_timer(self._tick_timer)
            self._tick_timer = None

    def _clear(self) -> None:
        self._stop()
        for station in self._stations.values():
            for publisher in (station.state_publisher, station.event_publisher,
                              station.info_publisher):
                self.destroy_lifecycle_publisher(publisher)
        self._stations = {}
        self._publish_diagnostics()

    # Data

    def _on_message(self, readers: list[tuple[Station, Input]], message: Any) -> None:
        now = self.get_clock().now().nanoseconds
        for station, source in readers:
            axis = station.axis
            event = source.read(message, now=now, max_future=axis.max_future)
            state = axis.monitor.update(event)
            if state is not None:
                self._publish_state(station, state)

    def _on_tick(self) -> None:
        """Tick on the grid of stamps, each grid point once."""
        now = self.get_clock().now().nanoseconds
        grid = now - now % nanoseconds(self._values['tick_period'])
        if grid == self._last_grid:
            return
        self._last_grid = grid
        for station in self._stations.values():
            state = station.axis.monitor.tick(grid)
            if state is not None:
                self._publish_state(station, state)

    def _publish_state(self, station: Station, state: State) -> None:
        station.last = state
        station.state_publisher.publish(station.writer.write(state))
        if state.event is not None:
            self._publish_event(station)
            self._log_event(station)
        summaries = diagnostics.summaries(state, station.axis.monitor.event)
        if summaries != station.said:
            self._tell_news(station, summaries)

    def _tell_news(self, station: Station, summaries: tuple[diagnostics.Summary, ...]) -> None:
        """Publish diagnostics for a change, but not in a flood; the timer sends what is left."""
        now = self._steady.now().nanoseconds
        if now - self._news_time < NEWS_INTERVAL:
            return
        self._news_time = now
        before, station.said = station.said, summaries
        if not before or before[1] != summaries[1]:
            level, text = summaries[1]
            # Two calls: rclpy ties one severity to one place in the code.
            if level == diagnostics.OK:
                self.get_logger().info(f'axis {station.axis.name}: {text}')
            else:
                self.get_logger().warning(f'axis {station.axis.name}: {text}')
        self._publish_diagnostics()

    def _publish_event(self, station: Station) -> None:
        axis = station.axis
        station.event_publisher.publish(out_of_zone_message(axis.name, axis.monitor.event))

    def _log_event(self, station: Station) -> None:
        event, name = station.axis.monitor.event, station.axis.name
        if event.active:
            advice = f'; {event.advice.text}' if event.advice.text else ''
            self.get_logger().warning(f'axis {name}: event {event.id}: {event.cause.text}{advice}')
        elif station.axis.monitor.level is Level.OK:
            self.get_logger().info(f'axis {name}: event {event.id} is over')

    def _publish_info(self, station: Station) -> None:
        axis = station.axis
        settings = axis.monitor.settings
        station.info_publisher.publish(surface_info_message(
            axis.name, axis.surface, settings.limits, stamp=self.get_clock().now().nanoseconds,
            default_temperature=settings.default_temperature))

    def _publish_diagnostics(self) -> None:
        message = DiagnosticArray(status=self._statuses())
        message.header.stamp = self.get_clock().now().to_msg()
        self._diagnostics.publish(message)

    def _statuses(self) -> list[DiagnosticStatus]:
        node, made = self.get_name(), []
        for name in self._values['axes']:
            station = self._stations.get(name)
            if station is not None:
                matched = {source: subscription.get_publisher_count()
                           for source, subscription in station.subscriptions.items()}
                made += diagnostics.statuses(
                    node, name, station.last, station.axis.monitor.event, station.axis.surface,
                    publishers=matched if self._active else None)
            elif self._reason:
                made += diagnostics.failed(node, name, f'not configured: {self._reason}')
            else:
                reason = 'shut down' if self._finalized else 'not configured'
                made += diagnostics.failed(node, name, reason)
        return made

    # Services

    def _on_evaluate(self, request: Any, response: Any) -> Any:
        """Answer what the surface says of the points."""
        station = self._stations.get(request.axis)
        most = EvaluateOperatingPoint.Request.MAX_POINTS
        if station is None:
            known = ', '.join(self._stations) or 'none, the node is not configured'
            response.message = f'axis {request.axis!r} is unknown, known are: {known}'
        elif len(request.points) > most:
            response.message = f'{len(request.points)} points are too many, allowed are {most}'
        else:
            response.success = True
            response.results = [self._evaluate(station.axis, point) for point in request.points]
        return response

    def _evaluate(self, axis: Axis, point: Any) -> PointResult:
        settings = axis.monitor.settings
        result = PointResult()
        fill_result(result, estimate(
            read_point(point, default_temperature=settings.default_temperature), axis.surface,
            rcs_limit=settings.limits.rcs), TIERS[axis.surface.tier])
        return result

    def _on_reload(self, request: Any, response: Any) -> Any:
        """Swap every surface for the file as it is now, if all of them verify."""
        try:
            surfaces = {name: load_surface(name, self._values) for name in self._stations}
        except InputError as error:
            response.message = f'kept the old surface: {error}'
            self.get_logger().error(response.message)
            return response
        for name, station in self._stations.items():
            station.axis.use_surface(surfaces[name], self._values)
            station.writer.tier = TIERS[surfaces[name].tier]
            self._publish_info(station)
        return self._answer(response, 'reloaded the surface')

    def _on_reset(self, request: Any, response: Any) -> Any:
        """Set the totals of every axis to zero."""
        for station in self._stations.values():
            station.axis.monitor.reset_totals()
        return self._answer(response, 'set the totals to zero')

    def _on_acknowledge(self, request: Any, response: Any) -> Any:
        """Set the level of every axis back to UNKNOWN and end its event."""
        now = self.get_clock().now().nanoseconds
        for station in self._stations.values():
            if station.axis.monitor.acknowledge(now) is not None:
                self._publish_event(station)
        return self._answer(response, 'acknowledged')

    def _answer(self, response: Any, what: str) -> Any:
        response.success = bool(self._stations)
        names = ', '.join(self._stations)
        response.message = f'{what} of {names}' if names else 'the node is not configured'
        return response


def _plain(value: Any) -> Any:
    """Return a parameter value as plain Python: rclpy hands out some lists as other sequences."""
    return value if value is None or isinstance(value, (bool, str, float, int)) else list(value)


def main(args: list[str] | None = None) -> int:
    """Run the node until SIGINT or SIGTERM; return 0, or 2 after bad input."""
    stop: list[int] = []
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, lambda received, frame: stop.append(received))
    try:
        # The handlers of rclpy tear the context down while the executor still waits on it.
        rclpy.init(args=args, signal_handler_options=SignalHandlerOptions.NO)
        node = BallscrewMonitor()
    except (InputError, ParameterException, RuntimeError) as error:
        print(f'{parameters.NODE_NAME}: {" ".join(str(error).split())}', file=sys.stderr)
        rclpy.try_shutdown()
        return 2
    executor = SingleThreadedExecutor()
    executor.add_node(node)
    node.start()
    while not stop:
        executor.spin_once(timeout_sec=POLL)
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, signal.SIG_IGN)
    node.finish()
    executor.shutdown()
    node.destroy_node()
    rclpy.shutdown()
    return 0


if __name__ == '__main__':
    sys.exit(main())
