# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""What the node keeps of its axes over restarts and SIGKILL: sums, events, shelving and a log."""

from collections.abc import Mapping
import datetime
from typing import Any

from ballscrew_monitor.core.memory import after_restart, Memory, NOTHING
from ballscrew_monitor.core.state import Event
from ballscrew_monitor.judge.monitor import Monitor
from ballscrew_monitor.messages import diagnostics
from ballscrew_monitor.node.event_log import event_facts, EventLog, Kind, line_of
from ballscrew_monitor.node.ledger import Ledger, Scribe
from ballscrew_monitor.node.memory_store import memory_record, MemoryStore
from ballscrew_monitor.node.state_folder import StateFolder
from diagnostic_msgs.msg import DiagnosticStatus
from rclpy.node import Node
from surrogate.files import InputError, to_json


class Keeping:
    """Remembers for the axes of one node."""

    def __init__(self, node: Node, folder: StateFolder) -> None:
        """Keep in a `folder`."""
        self._node = node
        self._folder = folder
        self._ledger = Ledger(folder)
        self._scribe = Scribe(self._ledger)
        self._store = MemoryStore(folder)
        self._logged = EventLog(folder).last_events()
        self._damage: list[str] = []
        self._unsaved: dict[str, str] = {}  # why the corrections of an axis are not kept
        self._remembered: dict[str, Any] = {}
        self._said = ''

    @property
    def problem(self) -> str:
        """Return what is wrong with what is kept, empty if nothing is."""
        if not self._folder.wanted:
            return ''
        writing = self._folder.reason or self._ledger.problem
        unsaved = [
            f'corrections of {axis} are not kept, {why}'
            for axis, why in self._unsaved.items()
            if why and why != writing
        ]
        return '; '.join(filter(None, [writing, *self._damage, *unsaved]))

    def statuses(self) -> list[DiagnosticStatus]:
        """Return the diagnostics of what is kept, none if nothing is to be."""
        name = self._node.get_fully_qualified_name()
        return [diagnostics.of_folder(name, self.problem)] if self._folder.wanted else []

    def note(
        self, kind: Kind, axis: str | None = None, *, stamp: int | None = None, **facts: Any
    ) -> None:
        """Write a line into the event log; its stamp [ns] is now unless stated."""
        if not self._folder.wanted:
            return
        if stamp is None:
            stamp = self._node.get_clock().now().nanoseconds
        time = datetime.datetime.now(datetime.UTC).isoformat(timespec='milliseconds')
        self._ledger.note(line_of(kind, time=time, stamp=stamp, axis=axis, **facts))
        self._write_from_now_on()

    def remember(self, axis: str, memory: Memory) -> None:
        """Keep what is remembered of an axis, if it has changed."""
        if not self._folder.wanted:
            return
        record = to_json(memory_record(memory))
        if record != self._remembered.get(axis):
            self._remembered[axis] = record
            self._ledger.remember(axis, memory)
            self._write_from_now_on()

    def recall(self, axis: str) -> Memory:
        """Return what is known of an axis from before; an event that was interrupted is over."""
        waiting = self._ledger.waiting(axis)
        if waiting is not None:
            return waiting
        memory = self._read(axis)
        self.remember(axis, memory)
        return memory

    def reopen(self, monitors: Mapping[str, Monitor]) -> bool:
        """Try to take a directory that could not be had; tell whether that has just worked."""
        if not self._folder.wanted or not self._folder.reason:
            return False
        with self._ledger.at_rest():  # what is there must be read before it is replaced
            if not self._folder.take():
                return False
            self._logged = EventLog(self._folder).last_events()
            for axis, monitor in monitors.items():
                monitor.take_up(self._read(axis))
                self.remember(axis, monitor.kept)
        return True

    def flush(self) -> str:
        """Write all that waits, and wait for the disk; return why that failed, or nothing."""
        return self._ledger.flush() if self._folder.wanted else ''

    def note_damage(self, sentence: str) -> None:
        """Say from now on that a file was set aside."""
        self._damage.append(sentence)

    def note_unsaved(self, axis: str, problem: str) -> None:
        """Say from now on why the corrections of an axis are not kept; empty: they are."""
        self._unsaved[axis] = problem

    def forget_damage(self) -> None:
        """Say no more of files that were set aside, nor of corrections that are gone."""
        self._damage.clear()
        self._unsaved.clear()

    def log_problem(self) -> None:
        """Log what is wrong, when that has changed."""
        problem, before = self.problem, self._said
        self._said = problem
        if problem and problem != before:
            self._node.get_logger().warning(f'state_dir: {problem}')
        elif before and not problem:
            self._node.get_logger().info('state_dir: all is kept again')

    def close(self) -> None:
        """Write all that waits, and let another node have the directory."""
        self._scribe.stop()
        self.flush()
        self._folder.close()

    def _read(self, axis: str) -> Memory:
        try:
            kept = self._store.load(axis)
        except InputError as error:
            self.note_damage(str(error))
            kept = NOTHING
        logged = self._logged.pop(axis, Event())
        memory = after_restart(kept, logged)
        if logged.active or (kept.event.active and memory.event.ending):
            event = memory.event
            self.note(Kind.EVENT_END, axis, stamp=event.stamp, **event_facts(event))
        return memory

    def _write_from_now_on(self) -> None:
        if self._scribe.ident is None:
            self._scribe.start()
