# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Everything that the node keeps of one axis: the axis, its publishers, and its last words."""

from collections.abc import Callable, Iterable, Mapping, Sequence
import functools
import traceback
from typing import Any, TypeVar

from ballscrew_monitor.core.conversions import nanoseconds
from ballscrew_monitor.core.fault_codes import Fault
from ballscrew_monitor.core.inputs import InputSample, InputStatus, Refusal, Source
from ballscrew_monitor.core.judgement import WarningPolicy
from ballscrew_monitor.core.links import Link
from ballscrew_monitor.core.state import MonitorSettings, Shelving
from ballscrew_monitor.judge.full_point import answer, corrected, Dwell, objection, solved_at
from ballscrew_monitor.judge.many import ManyJudge
from ballscrew_monitor.judge.records import Row
from ballscrew_monitor.messages import diagnostics, state_messages
from ballscrew_monitor.messages.state_messages import plain_values, TIERS
from ballscrew_monitor.messages.unjudged import point_or_reason, reason_of
from ballscrew_monitor.node.alarm import Alarm, LatchedTopics, quiet_publishers
from ballscrew_monitor.node.event_recorder import NodeRecorder
from ballscrew_monitor.node.freeze_frame import FreezeFrame
from ballscrew_monitor.node.kept_axes import KeptAxes
from ballscrew_monitor.node.state_records import Corrections, Kind, point_facts
from ballscrew_monitor.settings.axis import Axis
from ballscrew_monitor.settings.qos import state_qos
from ballscrew_msgs.msg import BallScrewState, OperatingPoint, PointResult
from ballscrew_msgs.srv import EvaluateOperatingPoint
from diagnostic_msgs.msg import DiagnosticStatus
from rclpy.clock import Clock
from rclpy.duration import Duration
from rclpy.lifecycle import LifecycleNode
from rclpy.qos import QoSProfile, QoSReliabilityPolicy
from std_msgs.msg import Bool, Float64, String
from surrogate.surface import Surface, SurfaceError, SurfacePoint

STATE_QOS = QoSProfile(depth=10, reliability=QoSReliabilityPolicy.RELIABLE)
LOG_INTERVAL = nanoseconds(1.0)  # [ns] shortest time between two lines about the inputs
MOST_LEAPS = 8  # of the stamps in one warning that the event log tells of
MOST_EVENTS = 512  # of a turn that are judged in one go
AT_ONCE = 50  # points that are evaluated before samples have a turn
LAST_WORD = Duration(seconds=0.5)  # for subscribers to take the end of an event
NEWS_INTERVAL = nanoseconds(0.1)  # [ns] shortest time between two diagnostics sent for a change
PLAIN = dict.fromkeys(('efficiency', 'rcs', 'film_ratio'), Float64)
PLAIN |= {'regime': String, 'out_of_zone': Bool}
"""Types of the plain topics by their names."""
Result = TypeVar('Result')


class AxisPublisher:
    """One axis and what the node needs to speak for it."""

    def __init__(
        self,
        node: LifecycleNode,
        axis: Axis,
        values: Mapping[str, Any],
        *,
        latched: LatchedTopics,
        kept: KeptAxes,
        recording: NodeRecorder,
    ) -> None:
        """
        Make the publishers, which stay silent until the node is active; `latched` are there.

        `values` are the parameters as they are at any time; `kept` keeps corrections and what
        happens, `recording` each message and what has changed the axis.

        """
        self.axis = axis
        self.dwell, self.frame = Dwell(), FreezeFrame()
        self.refused = ''  # why the last reload of the surface was
        self.defect = ''  # of the program, where it failed for this axis first
        self.failed = False  # in what was guarded last
        self._node, self._values, self._kept, self._recording = node, values, kept, recording
        self._message = state_messages.empty_state(axis.name)
        self._last: BallScrewState | None = None  # once it is filled
        self._inputs: tuple[InputStatus, ...] = ()
        self._links: Mapping[Source, Link] = {}
        self._said: tuple[diagnostics.StatusSummary, ...] = ()
        self._said_at = -NEWS_INTERVAL
        self._logged: diagnostics.StatusSummary | None = None
        self._logged_at = -LOG_INTERVAL
        self._leaps = 0, 0  # number of an event, and leaps of the stamps that were noted in it
        make = quiet_publishers(node)
        simulated = node.get_parameter('use_sim_time').value
        promise = state_qos(axis.name, values, simulated=simulated)
        self._state = make(BallScrewState, f'~/{axis.name}/state', promise)
        self.alarm = Alarm(node, axis, latched.event, kept, recording.record)
        self._info = latched.info
        kinds = PLAIN if values[f'{axis.name}.plain_topics'] else {}
        self._plain = {
            name: make(kind, f'~/{axis.name}/plain/{name}', STATE_QOS)
            for name, kind in kinds.items()
        }

    def may_note_leap(self) -> bool:
        """Return True if a leap of the stamps in a warning is one of its first."""
        number, count = self.axis.monitor.memory.event_number, self._leaps[1]
        self._leaps = number, count + 1 if number == self._leaps[0] else 1
        return self._leaps[1] <= MOST_LEAPS

    def adapt(self) -> None:
        """Take over the parameters as they are now; advice by others is said no longer."""
        allowed = self.settings.speed_allowed
        self.axis.adapt(self._values)
        if self.settings.speed_allowed is not allowed:
            self.alarm.health = None
        self.publish_info()

    def close(self) -> None:
        """Destroy the publishers, but for those that outlive the axis."""
        for publisher in (self._state, *self._plain.values()):
            self._node.destroy_lifecycle_publisher(publisher)

    def publish_state(self, row: Row) -> None:
        """Publish the state of a row, and before it the event that it begins or ends."""
        self._last = message = self._message
        self._inputs = state_messages.fill_state(message, row, self.axis.monitor)
        if row.edge:
            self.alarm.follow(row, self.frame.facts(row.stamp))
        self._state.publish(message)
        self._recording.record(f'~/{self.name}/state', message)
        self._publish_plain()

    def _publish_plain(self) -> None:
        for name, value in plain_values(self._message).items() if self._plain else ():
            self._plain[name].publish(PLAIN[name](data=value))

    def shelve(self, shelving: Shelving) -> None:
        """Shelve the warning, or no longer, and let the last state say so."""
        self.alarm.shelve(shelving)
        self._show_shelving()

    def end_shelving(self) -> bool:
        """End a shelving that is over, or begin one; return True if one has changed."""
        changed = self.alarm.end_shelving()
        if changed:
            self._show_shelving()
        return changed

    def _show_shelving(self) -> None:
        if self._last is not None:
            state_messages.fill_shelving(self._message, self.axis.monitor.shelving)
            self._publish_plain()

    def publish_info(self) -> None:
        """Publish what the surface and the limits are."""
        now = self._node.get_clock().now().nanoseconds
        message = state_messages.surface_info_message(
            self.name, self.surface, self.settings, stamp=now
        )
        self._info.publish(message)
        self._recording.record(f'~/{self.name}/surface_info', message)

    @functools.cached_property
    def many(self) -> ManyJudge:
        """Judge of turns that are judged compiled."""
        return ManyJudge(self.axis.monitor, MOST_EVENTS)

    @property
    def name(self) -> str:
        """Name of the axis."""
        return self.axis.name

    @property
    def surface(self) -> Surface:
        """Surface that is judged with."""
        return self.axis.surface

    @property
    def settings(self) -> MonitorSettings:
        """Limits and parameters in force."""
        return self.axis.monitor.settings

    def current_point(self) -> Row | str:
        """Return the operating point of now, or why there is none."""
        now = self._node.get_clock().now().nanoseconds
        return self.guarded('a solve', point_or_reason, self.axis.monitor, now) or self.defect

    def is_dwelling(self, row: Row) -> bool:
        """Return True if the point of a row should be solved; only where that is asked for."""
        wanted = self._values[f'{self.name}.solve_on_dwell']
        return wanted and self.dwell.update(row, self.settings.limits)

    def answer(self, row: Row) -> Row:
        """Return what the surface says of the point of a row."""
        return answer(row, self.surface, rcs_limit=self.settings.limits.rcs)

    def correct(self, row: Row, full: SurfacePoint) -> tuple[bool, str]:
        """
        Correct the surface by a full solve at the point of a row, and keep it.

        Return whether, and what or why not.

        """
        return self.guarded('a correction', self._correct, row, full) or (False, self.defect)

    def _correct(self, row: Row, full: SurfacePoint) -> tuple[bool, str]:
        if not self._values[f'{self.name}.correct_surface']:
            return False, f'parameter {self.name}.correct_surface is false'
        problem = objection(full, row, self.surface)
        if problem:
            return False, problem
        try:
            surface = self.surface.with_correction(solved_at(row), full)
        except SurfaceError as error:
            return False, str(error)
        self.use_surface(surface)
        problem = self._save()
        kept = f'not kept: {problem}' if problem else 'kept'
        self._kept.note(Kind.CORRECTION, self.name, point=point_facts(row), result=kept)
        return True, f'corrected the surface about this point, {kept}'

    def _save(self) -> str:
        """Keep the corrections; return why that failed, or nothing."""
        surface = self.surface
        kept = Corrections.of(self.name, surface.base_sha256, surface.corrections)
        return self._kept.state.keep_corrections(kept)

    def restore(self, *, late: bool) -> str:
        """Take up corrections of before; return what became of them, if there are any."""
        record = self._kept.state.recall(Corrections(self.name), late=late)
        kept = record.read_solves()
        if not kept:
            return ''
        if record.surface != self.surface.base_sha256:
            return f'{len(kept)} kept corrections are of another surface and not used'
        try:
            surface = corrected(self.surface, kept)
        except SurfaceError as error:
            return f'{len(kept)} kept corrections are not used: {error}'
        self.axis.use_surface(surface, self._values)
        if late:
            self._save()
        return f'{len(kept)} kept corrections are in use'

    def reload(self, surface: Surface) -> str:
        """
        Judge with the surface of the file as it is now; return what became of the corrections.

        Those of a file whose content is the same stay, others are dropped.

        """
        before = self.surface.corrections
        same = surface.base_sha256 == self.surface.base_sha256
        if before and same:
            surface = corrected(surface, before)
        self.use_surface(surface)
        self._kept.note(Kind.RELOAD_SURFACE, self.name, sha256=surface.sha256)
        self.refused = ''
        if not before:
            return ''
        if not same:
            self._save()
        return f'{len(before)} corrections {"stay" if same else "dropped"}'

    def use_surface(self, surface: Surface) -> None:
        """Judge with another surface from now on, and say so."""
        self.axis.use_surface(surface, self._values)
        self.publish_info()
        self._recording.snapshot([self.name], 'surface')

    def evaluate(
        self, points: Sequence[OperatingPoint], response: Any, meanwhile: Callable[[], None]
    ) -> None:
        """
        Fill the response with what the surface says of the points, if they are not too many.

        `meanwhile` is called between some points and the next ones.

        """
        most = EvaluateOperatingPoint.Request.MAX_POINTS
        if len(points) > most:
            response.message = f'{len(points)} points are too many, allowed are {most}'
            return
        results: list[PointResult] | None = []
        for begin in range(0, len(points), AT_ONCE):
            end = begin + AT_ONCE
            some: list[PointResult] | None = self.guarded(
                'an evaluation', list, map(self._evaluate, points[begin:end])
            )
            results = None if results is None or some is None else results + some
            meanwhile()
        if results is None:
            response.message = self.defect
        else:
            response.success, response.results = True, results

    def _evaluate(self, point: OperatingPoint) -> PointResult:
        result = PointResult()
        warmth = self.settings.default_temperature
        row = self.answer(state_messages.read_point(point, default_temperature=warmth))
        reason = reason_of(row, self.surface)
        state_messages.fill_result(result, row, TIERS[self.surface.tier], reason)
        return result

    def has_news(self, now: int) -> bool:
        """Return True if at `now` [ns] the last state changes what was said, if not just now."""
        if self._last is None or now - self._said_at < NEWS_INTERVAL:
            return False
        return self._summaries() != self._said

    def say_news(self, now: int) -> None:
        """Take the last state for said at `now` [ns], and log a change of the inputs."""
        if self._last is not None:
            self._said, self._said_at = self._summaries(), now
            self.log_inputs(now)

    def log_inputs(self, now: int) -> None:
        """Log what the inputs are like, when that has changed; an input may alternate fast."""
        if not self._said or self._said[1] == self._logged or now - self._logged_at < LOG_INTERVAL:
            return
        self._logged, self._logged_at = self._said[1], now
        text = f'axis {self.axis.name}: {self._logged.message}'
        # Two calls: rclpy ties one severity to one place in the code.
        if self._logged.level == diagnostics.OK:
            self._node.get_logger().info(text)
        else:
            self._node.get_logger().warning(text)

    def guarded(
        self,
        event: InputSample | Refusal | int | str,
        call: Callable[..., Result],
        *args: Any,
        **named: Any,
    ) -> Result | None:
        """
        Return what a call returns; if the program fails in it, None.

        The first such defect is logged, with the event at which it came, and is an ERROR of this
        axis alone.

        """
        self.failed = False
        try:
            return call(*args, **named)
        except Exception as error:  # the other axes go on, whatever it is
            self.failed = True
            if not self.defect:
                self.defect = diagnostics.defect_text(error, event)
                trace = ''.join(traceback.format_exception(error))
                self._node.get_logger().error(f'axis {self.name}: {self.defect}\n{trace}')
            return None

    def statuses(
        self, *, links: Mapping[Source, Link] | None, stood: int
    ) -> list[DiagnosticStatus]:
        """
        Return the diagnostics of the axis after the clock has stood for `stood` [ns].

        `links` says how each input is connected; None: the node is inactive. If the program fails
        even here, they say just that.

        """
        made = self.guarded('its diagnostics', self._statuses, links, stood)
        node = self._node.get_fully_qualified_name()
        code = Fault.PROGRAM_FAILED
        return made or diagnostics.failed(node, self.name, self.defect, code)

    def _statuses(self, links: Mapping[Source, Link] | None, stood: int) -> list[DiagnosticStatus]:
        self._links = links or {}
        return diagnostics.statuses(
            self._node.get_fully_qualified_name(),
            self.axis.name,
            self._last,
            self._inputs,
            self.axis.monitor.event_code,
            self.axis.surface,
            links=links,
            clock_stands=stood > self.settings.timeouts[Source.SPEED],
            refused=self.refused,
            defect=self.defect,
            policy=self._policy,
            usual=self.axis.monitor.usual,
            health=self.alarm.health,
            advice=self.alarm.advice,
        )

    def _summaries(self) -> tuple[diagnostics.StatusSummary, ...]:
        cause = self.axis.monitor.event_code
        return diagnostics.summaries(
            self._message,
            self._inputs,
            cause,
            self._links,
            self._policy,
            usual=self.alarm.is_usual,
        )

    @property
    def _policy(self) -> WarningPolicy:
        return WarningPolicy(self._values[f'{self.name}.warning.policy'])


def end_all(publishers: Iterable[AxisPublisher], reason: str, clock: Clock) -> None:
    """End what is active; on a steady `clock`, all subscribers together have one time to hear."""
    place = 'the end of its event'
    ended = [axis.alarm for axis in publishers if axis.guarded(place, axis.alarm.end, reason)]
    deadline = (clock.now() + LAST_WORD).nanoseconds
    for alarm in ended:
        left = deadline - clock.now().nanoseconds
        alarm.wait(Duration(nanoseconds=max(left, 0)))  # a negative one never ends
