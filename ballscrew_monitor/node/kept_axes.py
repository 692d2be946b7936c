# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Records of the axes of one node: restored at the start, handed over while they are judged."""

from collections.abc import Callable, Iterable, Mapping
from typing import Any, Protocol

from ballscrew_monitor.judge.kept import after_restart, AxisRecord
from ballscrew_monitor.messages import diagnostics
from ballscrew_monitor.node.restart_state import RestartState
from ballscrew_monitor.node.state_records import entry_of, event_facts, Kind
from ballscrew_monitor.settings.axis import Axis
from diagnostic_msgs.msg import DiagnosticStatus
from rclpy.clock import Clock
from rclpy.node import Node

LOOK = 1.0  # [s] between two looks
PERIOD = 4.0  # [s] between two records of the sums: with the write below 5 s


class KeptAxis(Protocol):
    """An axis as its records need it; its publisher is one."""

    axis: Axis

    def guarded(self, event: str, call: Callable[..., Any], *args: Any) -> Any:
        """Return what a call returns; if the program fails in it, None."""

    def restore(self, *, late: bool) -> str:
        """Take up corrections of before; return what became of them, if there are any."""

    def end_shelving(self) -> bool:
        """End a shelving that is over, or begin one; return True if one has changed."""


class KeptAxes:
    """What the axes of some publishers keep; `say` is called with those that have news."""

    def __init__(
        self,
        node: Node,
        state: RestartState,
        publishers: Mapping[str, KeptAxis],
        say: Callable[[list[str]], None],
        *,
        clock: Clock,
        catch_up: Callable[[], None],
    ) -> None:
        """
        Keep it in a `state`, with a look now and then on a steady `clock`.

        `catch_up` takes what waits before that, lest a step of the clock end a shelving.

        """
        self.state = state
        self._node, self._publishers, self._say = node, publishers, say
        self._catch_up, self._looks, self._said = catch_up, 0, ''
        node.create_timer(LOOK, self._look, clock=clock)
        self.note(Kind.NODE_START)
        state.start()

    def statuses(self) -> list[DiagnosticStatus]:
        """Return the diagnostics of what is kept, none if nothing is to be."""
        name = self._node.get_fully_qualified_name()
        kept = self.state.folder is not None
        return [diagnostics.of_folder(name, self.state.problem)] if kept else []

    def note(
        self,
        kind: Kind,
        axis: str | None = None,
        *,
        stamp: int | None = None,
        record: AxisRecord | None = None,
        **facts: Any,
    ) -> None:
        """Write an entry and the record of its axis; its stamp [ns] is now unless stated."""
        if self.state.folder is None:
            return
        if stamp is None:
            stamp = self._now
        self.state.keep(record, entry_of(kind, axis, stamp, facts))

    def remember(self, record: AxisRecord) -> None:
        """Keep the record of an axis."""
        if self.state.folder is not None:
            self.state.keep(record)

    def restore(self, axes: Iterable[str] | None = None) -> None:
        """Take up what was kept of all axes, or late of some, and say what came of that."""
        late = axes is not None
        for name in self._publishers if axes is None else axes:
            publisher = self._publishers[name]
            if sentence := publisher.guarded(
                'what was kept of it', self._restore, publisher, late
            ):
                self._node.get_logger().info(f'axis {name}: {sentence}')
        # What is wrong is logged when that has changed.
        problem, before = self.state.problem, self._said
        self._said = problem
        if problem and problem != before:
            self._node.get_logger().warning(f'state_dir: {problem}')
        elif before and not problem:
            self._node.get_logger().info('state_dir: all is kept again')

    def _restore(self, publisher: KeptAxis, late: bool) -> str:
        """Take up what is known from before; an event that was interrupted is over."""
        axis = publisher.axis
        before = self.state.recall(AxisRecord(axis=axis.name), late=late)
        record = after_restart(before)
        if record is not before:
            memory = record.read_memory()
            facts = event_facts(memory, record.read_ending())
            self.note(Kind.EVENT_END, axis.name, stamp=memory.event_stamp, record=record, **facts)
        axis.monitor.take_up(record, self._now)
        self._remember(axis)
        return publisher.restore(late=late)

    def _remember(self, axis: Axis) -> None:
        self.remember(axis.monitor.kept(self._now))

    def remember_all(self) -> None:
        """Keep the sums, events and shelvings of all axes."""
        for publisher in self._publishers.values():
            publisher.guarded('what is kept of it', self._remember, publisher.axis)

    def close(self) -> None:
        """Write all that waits, and let another node have the directory."""
        self.note(Kind.NODE_STOP)
        self.state.close()

    @property
    def _now(self) -> int:
        return self._node.get_clock().now().nanoseconds

    def _look(self) -> None:
        self._catch_up()
        self.state.look()
        publishers = self._publishers
        late = [name for name in publishers if self.state.is_late(name)]
        self.restore(late)
        over = [
            name
            for name, publisher in publishers.items()
            if publisher.guarded('its shelving', publisher.end_shelving)
        ]
        if over or late:
            self._say([*publishers] if late else over)
        self._looks += 1
        if self._looks % round(PERIOD / LOOK) == 0:
            self.remember_all()
