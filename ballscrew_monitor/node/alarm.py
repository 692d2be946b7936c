# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The warning of one axis: its topic, its log, what people do to it; topics that stay."""

from collections.abc import Callable, Mapping
import functools
from typing import Any

from ballscrew_monitor.core.conversions import clock_text, seconds
from ballscrew_monitor.core.judgement import EventEnd, Level
from ballscrew_monitor.core.state import Ending, NAMELESS, NOT_SHELVED, Shelving
from ballscrew_monitor.health.records import Health
from ballscrew_monitor.health.usual import is_usual
from ballscrew_monitor.judge.records import Row
from ballscrew_monitor.judge.zone import ACTIVE
from ballscrew_monitor.messages.state_messages import advice_text, event_cause, out_of_zone_message
from ballscrew_monitor.node.kept_axes import KeptAxes
from ballscrew_monitor.node.state_records import event_facts, Kind, point_facts, totals_facts
from ballscrew_monitor.settings.axis import Axis
from ballscrew_monitor.settings.qos import LATCHED_QOS
from ballscrew_msgs.msg import AxisHealth, OutOfZone, SurfaceInfo
from rclpy.duration import Duration
from rclpy.event_handler import PublisherEventCallbacks
from rclpy.lifecycle import LifecycleNode
from rclpy.publisher import Publisher


def quiet_publishers(node: LifecycleNode) -> functools.partial[Any]:
    """
    Return what makes publishers without events.

    rclpy looks at every event of every publisher in every round. What these would warn of, a
    subscriber with QoS that does not fit, its own node warns of too.

    """
    quiet = PublisherEventCallbacks(use_default_callbacks=False)
    return functools.partial(node.create_lifecycle_publisher, event_callbacks=quiet)


class LatchedTopics:
    """Publishers that live as long as the node, so that the end of an event outlives its axis."""

    def __init__(self, node: LifecycleNode, axis: str) -> None:
        """Make them; they stay silent until the node is active."""
        make = quiet_publishers(node)
        self.event = make(OutOfZone, f'~/{axis}/out_of_zone', LATCHED_QOS)
        self.info = make(SurfaceInfo, f'~/{axis}/surface_info', LATCHED_QOS)
        self.health = make(AxisHealth, f'~/{axis}/health', LATCHED_QOS)


class Alarm:
    """Speaks of the events of one axis, and keeps them."""

    def __init__(
        self,
        node: LifecycleNode,
        axis: Axis,
        publisher: Publisher,
        kept: KeptAxes,
        record: Callable[[str, Any], None],
    ) -> None:
        """Speak through a `publisher` of the node; `record` is given each message and topic."""
        self._node, self._axis, self._publisher = node, axis, publisher
        self._kept, self._record = kept, record
        self.health: Health | None = None  # as it was assessed last

    def publish(self) -> None:
        """Publish the event that is active, or the last one."""
        self._speak(self._publisher.publish)

    def _speak(self, publish: Callable[[OutOfZone], None]) -> None:
        monitor = self._axis.monitor
        shelved = bool(monitor.shelving.at(self._now).until)
        message = out_of_zone_message(
            monitor, shelved=shelved, health=self.health, usual=self.is_usual
        )
        publish(message)
        self._record(f'~/{self._axis.name}/out_of_zone', message)

    @property
    def is_usual(self) -> bool:
        """Return True if the baseline of the axis already had the last warning."""
        return self._axis.monitor.memory.event_number in self._axis.monitor.usual

    @property
    def advice(self) -> str:
        """Return what to do about the last warning, empty where nothing is known to help."""
        target = self._axis.monitor.target_speed
        return advice_text(target, self.health, usual=self.is_usual)

    def follow(self, row: Row, frame: Mapping[str, list[float]]) -> None:
        """Keep the event that a row has begun, with a freeze frame, or ended, and then speak."""
        monitor = self._axis.monitor
        memory = monitor.memory
        active, number = memory.event_active, memory.event_number
        self._note_usual()
        # First: who is killed meanwhile must not have said a number that is not kept.
        kind = Kind.EVENT_BEGIN if active else Kind.EVENT_END
        before = {'freeze_frame': frame} if active else {}
        self._note_event(kind, point=point_facts(row), **before)
        self.publish()
        if active:
            texts = event_cause(memory).text, self.advice
            self._warn(f'event {number}: {"; ".join(filter(None, texts))}')
        elif monitor.level is Level.OK:
            self._say(f'event {number} is over')

    def hear(self, health: Health) -> None:
        """Take an assessment; the warning that is on may be a usual one, as is known only now."""
        self.health = health
        if self._note_usual():
            self.publish()
            self.remember()

    def _note_usual(self) -> bool:
        """Note the active event if the baseline already had it; return True if that is news."""
        monitor = self._axis.monitor
        memory = monitor.memory
        if self.health is None or not memory.event_active or self.is_usual:
            return False
        speed, load = (float(each[ACTIVE]) for each in (memory.event_speed, memory.event_load))
        known = is_usual(self.health, monitor.event_code, speed=speed, axial_load=load)
        if known:
            monitor.usual.append(memory.event_number)
        return known

    def end(self, reason: str) -> bool:
        """End the active event, as nothing is judged any more; return True if there was one."""
        monitor = self._axis.monitor
        ending = Ending(EventEnd.STOPPED, reason=reason)
        ended = monitor.acknowledge(self._now, ending)
        if ended:
            # Past the lifecycle: the publisher of an inactive node is mute.
            self._speak(functools.partial(Publisher.publish, self._publisher))
            self._warn(f'event {monitor.memory.event_number}: {ending.text}')
            self._note_event(Kind.EVENT_END)
        self.remember()
        return ended

    def wait(self, duration: Duration) -> None:
        """Wait until all subscribers have the last message, at most for a `duration`."""
        self._publisher.wait_for_all_acked(duration)

    def acknowledge(self, by: Ending = NAMELESS) -> None:
        """Set the level back to UNKNOWN and end the event, because somebody has seen it."""
        ended = self._axis.monitor.acknowledge(self._now, by)
        number = self._axis.monitor.memory.event_number
        self._note(Kind.ACKNOWLEDGE, event=number, name=by.name, reason=by.reason)
        if ended:
            self.publish()
            self._note_event(Kind.EVENT_END)

    def reset_totals(self) -> None:
        """Set the sums to zero; what they were is in the log."""
        totals = totals_facts(self._axis.monitor.memory)
        self._axis.monitor.reset_totals()
        self._note(Kind.RESET_TOTALS, totals=totals)

    def shelve(self, shelving: Shelving) -> None:
        """Shelve the warning, or no longer."""
        before, self._axis.monitor.shelving = self._axis.monitor.shelving, shelving
        if shelving.until:
            until = clock_text(shelving.until)
            self._warn(f'the warning is shelved until {until}: {shelving.reason}')
            duration = seconds(shelving.until - self._now)
            when = {'duration_s': duration, 'until': until, 'until_ns': shelving.until}
            self._note(Kind.SHELVE, **when, reason=shelving.reason)
        elif before.until:
            self._say('the warning is no longer shelved')
            self._note(Kind.UNSHELVE, reason=before.reason)
        self.publish()
        self.remember()

    def end_shelving(self) -> bool:
        """End the shelving if its time is over, or begin it; return True if it has changed."""
        monitor, now = self._axis.monitor, self._now
        begun = monitor.shelving.started(now)
        if begun != monitor.shelving:
            monitor.shelving = begun
            return True
        over = begun.is_over(now)
        if over:
            self.shelve(NOT_SHELVED)
        return over

    def remember(self) -> None:
        """Keep the sums, the event and the shelving."""
        self._kept.remember(self._axis.monitor.kept(self._now))

    @property
    def _now(self) -> int:
        return self._node.get_clock().now().nanoseconds

    def _note_event(self, kind: Kind, **facts: Any) -> None:
        monitor = self._axis.monitor
        event = event_facts(monitor.memory, monitor.ending, self.advice)
        self._note(kind, stamp=monitor.memory.event_stamp, **event, **facts)

    def _note(self, kind: Kind, **facts: Any) -> None:
        self._kept.note(kind, self._axis.name, record=self._axis.monitor.kept(self._now), **facts)

    # Two functions: rclpy ties one severity to one place in the code.
    def _say(self, text: str) -> None:
        self._node.get_logger().info(f'axis {self._axis.name}: {text}')

    def _warn(self, text: str) -> None:
        self._node.get_logger().warning(f'axis {self._axis.name}: {text}')
