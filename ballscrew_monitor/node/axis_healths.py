# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Health of the axes of one node: handed over now and then, published, and named a baseline."""

from collections.abc import Callable, Iterable, Mapping
import functools
import math
from typing import Any

from ballscrew_monitor.core.judgement import WarningPolicy
from ballscrew_monitor.health.assess import HealthSettings
from ballscrew_monitor.health.keeper import HealthKeeper
from ballscrew_monitor.health.life import HOUR
from ballscrew_monitor.health.records import Health
from ballscrew_monitor.health.rows import DAY
from ballscrew_monitor.health.store import HealthStore
from ballscrew_monitor.messages.health_messages import health_status, stamp_of
from ballscrew_monitor.node.alarm import LatchedTopics
from ballscrew_monitor.node.axis_publisher import AxisPublisher
from ballscrew_monitor.node.health_worker import Gatherer, HealthWorker, Job
from ballscrew_monitor.node.heartbeat import clock_is_set
from ballscrew_monitor.node.kept_axes import KeptAxes
from ballscrew_monitor.node.state_records import Kind
from ballscrew_monitor.settings.axis import gathering_of
from ballscrew_msgs.srv import SetBaseline
from diagnostic_msgs.msg import DiagnosticStatus
from numpy.typing import NDArray
from rclpy.clock import Clock
from rclpy.node import Node
from surrogate.files import InputError

LOOK = 1.0  # [s] between two looks
PERIOD = 30  # looks between two writes of the store
KEPT_FOR = HOUR  # [s] that a clock must keep a time that it was set to
CLOCK_SET = 'the clock was set by more than a day, motion counts again after an hour'
CLOCK_UNSET = 'the clock of the machine is not set, motion counts an hour after it is'


class AxisHealths:
    """The health of those axes whose parameters ask for it, while the node is active."""

    def __init__(
        self,
        node: Node,
        values: Mapping[str, Any],
        publishers: Mapping[str, AxisPublisher],
        latched: Mapping[str, LatchedTopics],
        kept: KeptAxes,
        record: Callable[[str, Any], None],
        *,
        clock: Clock,
    ) -> None:
        """
        Make the services, and look now and then on a steady `clock`.

        `publishers` have the axes; `latched` the topics to speak on; `kept` has the folder of the
        store; `record` is given each message and topic.

        """
        self._node, self._values, self._publishers = node, values, publishers
        self._latched, self._kept, self._record = latched, kept, record
        self._gatherers: dict[str, Gatherer] = {}
        self._keepers: dict[str, HealthKeeper] = {}
        self._last: dict[str, Health] = {}
        self._due: dict[str, float] = {}  # looks until the next assessment
        self._worker: HealthWorker | None = None
        self._looks, self._held = 0, 0.0  # [s] for which nothing is gathered
        node.create_timer(LOOK, self._look, clock=clock)
        for axis in values['axes']:
            serve = functools.partial(self._serve, axis)
            node.create_service(SetBaseline, f'~/{axis}/set_baseline', serve)

    def begin(self) -> None:
        """Begin to gather, and assess what is kept; nothing without a folder."""
        folder = self._kept.state.folder
        wanted = [name for name in self._publishers if self._values[f'{name}.health.enabled']]
        if folder is None or not wanted:
            return
        store = HealthStore(folder)
        self._worker = HealthWorker(store, lambda: self._kept.state.is_held)
        for name in wanted:
            settings = gathering_of(name, self._values)
            self._gatherers[name] = Gatherer(self._publishers[name].surface, settings)
            self._keepers[name] = HealthKeeper(name, store)
        self._due |= dict.fromkeys(wanted, 0.0)
        self._look()

    def take(self, axis: str, row: Any) -> None:
        """Take a row of the judgement."""
        if axis in self._gatherers and not self._held:
            self._gatherers[axis].take(row)

    def take_many(self, axis: str, rows: NDArray[Any]) -> None:
        """Take rows of the judgement, an array of them."""
        if axis in self._gatherers and not self._held:
            self._gatherers[axis].take_many(rows)

    def set_clock(self, step: int, now: int) -> None:
        """
        Take that the clock of the node was set by a `step` to `now` [ns].

        After one of more than a day nothing is gathered until the clock has kept its new time:
        motion of days to which it only leapt belongs to no day. What was gathered before it is
        of the time before.

        """
        if self._worker is None or abs(step) <= DAY:
            return
        for name in self._gatherers:
            self._hand_over(name, assesses=False, rows_end=True, now=now - step)
        self._held = KEPT_FOR

    def end(self) -> None:
        """Keep what was gathered, and gather no more."""
        if self._worker is None:
            return
        for name in self._gatherers:
            self._hand_over(name, assesses=False, rows_end=True)
        self._worker.close()
        self._speak()
        self._worker = None
        for part in (self._gatherers, self._keepers, self._last, self._due):
            part.clear()

    def statuses(self, axes: Iterable[str]) -> list[DiagnosticStatus]:
        """Return the diagnostics of some axes, as far as their health is followed."""
        return [self._status(name) for name in axes if name in self._gatherers]

    def _status(self, name: str) -> DiagnosticStatus:
        assert self._worker is not None
        held = (CLOCK_SET if clock_is_set(self._node) else CLOCK_UNSET) if self._held else ''
        return health_status(
            self._node.get_fully_qualified_name(),
            name,
            self._publishers[name].surface.screw_name,
            self._last.get(name),
            self._policy(name),
            problem=self._gatherers[name].defect or self._worker.problem or held,
        )

    def _look(self) -> None:
        """Hand over what is due, and publish what has been assessed."""
        if self._worker is None:
            return
        self._looks += 1
        self._held = max(self._held - LOOK, 0.0) if clock_is_set(self._node) else KEPT_FOR
        for name in self._gatherers:
            # What could not be had is tried again with the next write.
            longest = PERIOD * LOOK if self._worker.problem else math.inf
            self._due[name] = min(self._due[name], longest) - LOOK
            assesses = self._due[name] <= 0.0
            if assesses or self._looks % PERIOD == 0:
                if self._hand_over(name, assesses=assesses) and assesses:
                    self._due[name] = self._values[f'{name}.health.period']
        self._speak()

    def _hand_over(
        self, name: str, *, assesses: bool, rows_end: bool = False, now: int | None = None
    ) -> bool:
        """Let the worker keep what was gathered of an axis; return whether it takes it."""
        publisher, values = self._publishers[name], self._values
        gatherer = self._gatherers[name]
        assert self._worker is not None
        job = Job(
            keeper=self._keepers[name],
            axis=name,
            now=self._now if now is None else now,
            collected=gatherer.hand_over(publisher.surface, rows_end=rows_end),
            surface=publisher.surface,
            settings=HealthSettings(
                limits=publisher.settings.limits,
                speed_allowed=values[f'{name}.advice.speed'],
                baseline_days=values[f'{name}.health.baseline_days'],
            ),
            policy=self._policy(name),
            assesses=assesses,
        )
        taken = self._worker.put(job)
        if not taken:
            gatherer.give_back(job.collected)
        return taken

    def _speak(self) -> None:
        """Publish what has been assessed, and say what was set aside."""
        worker = self._worker
        assert worker is not None
        while worker.damage:
            self._kept.state.damage.append(worker.damage.popleft())
        while worker.done:
            health, message = worker.done.popleft()
            name = health.axis
            self._last[name] = health
            self._publishers[name].alarm.hear(health)
            self._latched[name].health.publish(message)
            self._record(f'~/{name}/health', message)

    def _serve(self, axis: str, request: Any, response: Any) -> Any:
        """Name a baseline, and assess with it soon; answer what was done."""
        try:
            if axis not in self._keepers or self._worker is None:
                raise InputError(
                    f'the health of axis {axis} is not followed: the node must be active, '
                    f'{axis}.health.enabled true, and state_dir not empty'
                )
            self._worker.take_store()
            answer = self._keepers[axis].name_baseline(
                self._now,
                begin=stamp_of(request.begin),
                end=stamp_of(request.end),
                running_in=request.running_in,
                reason=request.reason,
                screw=self._publishers[axis].surface.screw_name,
            )
            self._kept.note(Kind.SET_BASELINE, axis, reason=request.reason)
            self._node.get_logger().info(f'axis {axis}: {answer}: {request.reason}')
            self._due[axis] = 0.0
            response.success, response.message = True, answer
        except InputError as error:
            response.message = str(error)
        except Exception as error:  # noqa: BLE001 such as a store that cannot be written
            response.message = f'the baseline is not kept: {error}'
        return response

    def _policy(self, name: str) -> WarningPolicy:
        return WarningPolicy(self._values[f'{name}.warning.policy'])

    @property
    def _now(self) -> int:
        return self._node.get_clock().now().nanoseconds
