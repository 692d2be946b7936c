# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""What the node tells its recording: the beginning, what it says, and how its axes are."""

from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from typing import Any

from ballscrew_monitor.messages import diagnostics
from ballscrew_monitor.node.axis_publisher import AxisPublisher
from ballscrew_monitor.node.journal import Journal, SILENT
from ballscrew_monitor.node.recording_process import recording, RecordingProcess
from ballscrew_msgs.msg import OutOfZone
from diagnostic_msgs.msg import DiagnosticStatus
from rclpy.node import Node

Publishers = Mapping[str, AxisPublisher]


class Chronicle:
    """The journal of the node while it is active, and none before and after."""

    def __init__(
        self, node: Node, values: Mapping[str, Any], find: Callable[[], Publishers]
    ) -> None:
        """Keep silent at first; `find` returns the axes."""
        self.journal = SILENT
        self._node, self._values, self._find = node, values, find
        self._start: Callable[[], RecordingProcess] | None = None

    def configure(self, folder: Path | None) -> None:
        """Take over the parameters; raises InputError when there is no place for a recording."""
        self._start = recording(self._values, folder)

    def begin(self) -> None:
        """Begin a recording, if there is to be one."""
        self.journal = Journal(self._node.resolve_topic_name('~/journal'), self._start)

    def close(self) -> None:
        """Let the recording be finished."""
        self.journal.close()
        self.journal = SILENT

    def describe(self, axes: Iterable[str], because: str) -> None:
        """Let a recording know all about some axes."""
        now = self._node.get_clock().now().nanoseconds
        for name in axes if self.journal.on else ():
            axis = self._find()[name].axis
            topics = {
                source.name.lower(): self._node.resolve_topic_name(topic)
                for source, topic in axis.topics.items()
            }
            self.journal.describe(axis, self._values, topics, because, now)

    def record(self, topic: str, message: Any) -> None:
        """Let a recording show what the node publishes; a warning is an event of it."""
        if self.journal.on:
            now = self._node.get_clock().now().nanoseconds
            self.journal.say(self._node.resolve_topic_name(topic), message, now)
            if isinstance(message, OutOfZone) and message.event_id:
                self.journal.trigger(now)

    def statuses(self) -> list[DiagnosticStatus]:
        """Return how the recording is, if there is one."""
        if not self.journal.on:
            return []
        return [diagnostics.recording(self._node.get_fully_qualified_name(), self.journal.problem)]
