# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""A node of one axis without DDS, which records what it takes as the node does."""

from collections.abc import Iterable
from pathlib import Path
from types import SimpleNamespace
from typing import Any

from ballscrew_monitor.core.inputs import ordered
from ballscrew_monitor.node.event_recorder import axis_snapshot, EventRecorder
from ballscrew_monitor.node.intake import _events
from ballscrew_monitor.node.topic import Arrival
from ballscrew_monitor.recordings.bag import Bag
from ballscrew_monitor.recordings.frames import Frame
from ballscrew_monitor.recordings.retention import KeepSettings, Retention
from ballscrew_monitor.settings.axis import build_axis
from ballscrew_monitor.settings.parameters import absolute
from rclpy.serialization import serialize_message

ALWAYS = KeepSettings(always=True, before=60.0, after=10.0, longest=1e9, largest=1e9, total=1e12)
TICK = 100_000_000  # [ns]


class KeptFrames:
    """Stands for the process that records: it keeps each frame at once."""

    problem, lost = '', False

    def __init__(self, folder: Path) -> None:
        """Keep recordings in `folder`."""
        self._retention = Retention(folder, ALWAYS)
        self._now = 0.0

    def put(self, frame: Frame) -> bool:
        """Keep a frame."""
        self._now = max(self._now, frame.log_time * 1e-9)
        self._retention.take(frame, self._now)
        return True

    def flush(self) -> bool:
        """Have nothing that waits."""
        return True

    def close(self) -> None:
        """Finish the recording."""
        self._retention.close()


def record_alone(
    folder: Path,
    values: dict[str, Any],
    bursts: Iterable[tuple[int, list[tuple[str, Any]]]],
    *,
    raw: bool = True,
) -> Bag:
    """
    Return what a node of the axis x records of bursts, stamps [ns] and messages by topic.

    The messages of the inputs are recorded too if they are wanted `raw`.

    """
    axis = build_axis('x', values)
    process: Any = KeptFrames(folder)
    recorder = EventRecorder('/ballscrew_monitor/judge_events', lambda: process, raw=raw)
    begun = False
    names = {one.source.name.lower(): absolute(one.topic) for one in axis.inputs}
    topics: dict[str, Any] = {
        absolute(one.topic): SimpleNamespace(
            name=absolute(one.topic), readers=[(axis, one)], type_name=one.type_name
        )
        for one in axis.inputs
    }
    for stamp, messages in bursts:
        if not begun:
            recorder.snapshot({'x': axis_snapshot(axis, values, names)}, 'begin', stamp)
            begun = True
        heard = [
            (Arrival(stamp, message, 0, topics[name], serialize_message(message)), stamp, 0)
            for name, message in messages
        ]
        turn = ordered([event for one in heard for event in _events(*one)])
        recorder.hear(heard)
        recorder.take(turn, stamp, stamp)
        for _, event in turn:
            axis.monitor.update(event)
        if stamp % TICK == 0:
            recorder.tick(stamp, stamp, stamp)
            axis.monitor.tick(stamp)
            if because := recorder.due(stamp, stamp):
                recorder.snapshot({'x': axis_snapshot(axis, values, names)}, because, stamp)
    recorder.close()
    (path,) = folder.iterdir()
    return Bag(path)
