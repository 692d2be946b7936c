# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Journal of all that the node heard, did and said, in that order, for its recording.

Messages go in as they came, with the arrival on the clock of the node as their log time and the
number of the burst in which they were taken as their sequence. Beside them lies the topic
`~/journal`, which is recorded and never published: JSON entries for all else that a judgement
depends on. An `axis` entry holds everything about one axis, so a replay begins wherever there is
one, and each of those that come with time alone proves the replay up to there.

"""

from collections.abc import Callable, Iterable, Mapping, Sequence
import json
from pathlib import Path
from typing import Any

from ballscrew_monitor.core.cdr import serialized
from ballscrew_monitor.core.conversions import nanoseconds
from ballscrew_monitor.core.fields import type_name_of
from ballscrew_monitor.judge.dump import dump
from ballscrew_monitor.messages import diagnostics
from ballscrew_monitor.node.recording_process import recording, RecordingProcess
from ballscrew_monitor.node.sources import Reading
from ballscrew_monitor.node.topic import Arrival
from ballscrew_monitor.recordings.frames import Frame, FrameKind, MOST_SEQUENCE, STRING, VERSION
from ballscrew_monitor.settings.axis import Axis
from ballscrew_msgs.msg import AxisHealth, OutOfZone, SurfaceInfo
from diagnostic_msgs.msg import DiagnosticStatus
from rclpy.node import Node
from std_msgs.msg import String

LATCHED = (AxisHealth, OutOfZone, SurfaceInfo)
CORRECTION = ('speed', 'opposing_load', 'temperature', 'solved')  # of a full solve
AXIS_PERIOD = nanoseconds(10.0)  # [ns] after which all is said of an axis again
# [ns] after which a lost process is started again; twice as long if it is lost soon after.
RESTART, LONGEST_RESTART = nanoseconds(2.0), nanoseconds(60.0)
HOLE_SHOWN = nanoseconds(10.0)  # [ns] for which a hole is warned of
Heard = tuple[Arrival, int, int | None]
"""A message, its arrival [ns] on the clock of the node, and how many were lost before it."""


class Journal:
    """Hands all on to the process that records; without one it costs nothing."""

    def __init__(self, name: str, start: Callable[[], RecordingProcess] | None) -> None:
        """Write entries to the topic `name`; `start` makes the process, None: nothing is kept."""
        self.on = start is not None
        self._name = name
        self._start = start
        self._process = None if start is None else start()
        self._lost_at: int | None = None  # the process, on the steady clock
        self._topics: dict[str, int] = {}
        self._unknown_loss: set[str] = set()  # topics whose loss was last said to be unknown
        self._reading = Reading()
        self._burst = 0
        self._pause = RESTART
        self._started_at = 0  # the process, on the steady clock, again
        self._begun = False  # an axis has been described
        self._hole = False  # frames were dropped: all must be said again
        self._hole_shown = False
        self._hole_over = -HOLE_SHOWN  # on the steady clock
        self._said: dict[str, int] = {}  # when each axis was, on the steady clock

    @property
    def problem(self) -> str:
        """Return why nothing is recorded, in a sentence, or nothing."""
        if self._process is None:
            return ''
        return self._process.problem or ('the recording has a hole' if self._hole_shown else '')

    def hear(self, batch: Sequence[Heard]) -> None:
        """Take messages that were taken in one burst."""
        if not self.on:
            return
        self._burst = (self._burst + 1) % MOST_SEQUENCE
        for arrival, now, lost in batch:
            name, kind = arrival.topic.name, arrival.topic.type_name
            self._tell_loss(name, lost, now)
            times = (now, arrival.received, self._burst)
            self._put(name, kind, 'SENSOR', arrival.data, times)
        self.flush()  # whatever becomes of the node with these messages

    def read(self, reading: Reading, now: int) -> None:
        """Say how the messages from `now` [ns] on are read, when that has changed."""
        if not self.on or reading == self._reading:
            return
        self._reading = reading
        self._note(now, {'kind': 'reading', **_stated(reading)})

    def flush(self) -> None:
        """Hand over what was taken so far."""
        if self._process is not None:
            self._process.flush()

    def _tell_loss(self, topic: str, lost: int | None, now: int) -> None:
        """Say how many messages were lost before the next; that it is unknown, just once."""
        known = topic not in self._unknown_loss
        if lost == 0 and known or lost is None and not known:
            return
        (self._unknown_loss.add if lost is None else self._unknown_loss.discard)(topic)
        self._note(now, {'kind': 'lost', 'topic': topic, 'count': lost})

    def tick(self, grid: int, now: int) -> None:
        """Note a tick of all axes at `grid` [ns]."""
        self._note(now, {'kind': 'tick', 'stamp': grid})

    def say(self, topic: str, message: Any, now: int) -> None:
        """Take a message that the node publishes at `now` [ns] of its clock."""
        offer = 'LATCHED' if isinstance(message, LATCHED) else 'RELIABLE'
        self._put(topic, type_name_of(message), offer, serialized(message), (now, now, 0))

    def trigger(self, now: int) -> None:
        """Let a recording around events show what has just happened."""
        if self._process is not None:
            self._process.put(Frame(FrameKind.TRIGGER, log_time=now))

    def describe(
        self,
        axis: Axis,
        values: Mapping[str, Any],
        topics: Mapping[str, str],
        because: str,
        now: int,
    ) -> None:
        """
        Say all about an axis: its parameters, the full names of its topics, what it remembers.

        `because` is what has changed it, `time` if nothing has. Until the first `/clock` simulated
        time stands at 0, which is no time: a recording begins after that.

        """
        if self._process is None or not now:
            return
        self._begun = True
        mine = {name: one for name, one in values.items() if name.startswith(f'{axis.name}.')}
        entry = {
            'kind': 'axis',
            'version': VERSION,
            'axis': axis.name,
            'because': because,
            'values': mine | {'axes': [axis.name], 'tick_period': values['tick_period']},
            'topics': dict(topics),
            'loss_unknown': sorted(self._unknown_loss),
            'reading': _stated(self._reading),
            'surface': {
                'base_sha256': axis.surface.base_sha256,
                'corrections': [
                    {name: getattr(one, name) for name in CORRECTION}
                    for one in axis.surface.corrections
                ],
            },
            'monitor': dump(axis.monitor),
        }
        self._note(now, entry)

    def due(self, axes: Iterable[str], steady: int, now: int) -> list[str]:
        """Return which axes are to be described again at `steady` [ns]: one; all after a hole."""
        if self._process is None or not now:
            return []
        if not self._process.lost and steady - self._started_at >= LONGEST_RESTART:
            self._pause = RESTART
        if self._process.lost:
            self._lost_at = steady if self._lost_at is None else self._lost_at
            if steady - self._lost_at < self._pause:
                return []
            self._restart(steady)
        if self._hole and not self._process.lost and self._process.flush():
            self._hole, self._hole_over = False, steady
            self._said.clear()
            self._note(now, {'kind': 'hole'})
        self._hole_shown = self._hole or steady - self._hole_over < HOLE_SHOWN
        late = [
            name for name in axes if steady - self._said.get(name, -AXIS_PERIOD) >= AXIS_PERIOD
        ]
        chosen = late if not self._said else late[:1]
        self._said |= dict.fromkeys(chosen, steady)
        return chosen

    def close(self) -> None:
        """Finish the recording."""
        if self._process is not None:
            self._process.close()
            self._process = None

    def _restart(self, steady: int) -> None:
        assert self._start is not None
        self._started_at = steady
        self.close()
        self._process, self._lost_at = self._start(), None
        self._pause = min(2 * self._pause, LONGEST_RESTART)
        self._topics.clear()
        self._hole = True

    def _note(self, now: int, entry: Mapping[str, Any]) -> None:
        if self._process is None:
            return
        text = json.dumps(entry, allow_nan=False, separators=(',', ':'))
        self._put(self._name, STRING, 'RELIABLE', serialized(String(data=text)), (now, now, 0))

    def _put(
        self, topic: str, type_name: str, offer: str, data: bytes, times: tuple[int, int, int]
    ) -> None:
        """Put a message; its times are log time and publish time [ns], and its burst."""
        # What is heard before all is said of an axis means nothing.
        if self._process is None or self._hole or not self._begun:
            return
        number = self._topics.get(topic)
        if number is None:
            number = self._topics[topic] = len(self._topics)
            stated = json.dumps({'name': topic, 'type': type_name, 'offer': offer})
            if not self._process.put(Frame(FrameKind.TOPIC, number, body=stated.encode())):
                del self._topics[topic]
                self._hole = True
                return
        self._hole = not self._process.put(Frame(FrameKind.MESSAGE, number, *times, data))


def _stated(reading: Reading) -> dict[str, Any]:
    several = sorted([axis, source.name.lower()] for axis, source in reading.several)
    return {'ahead': reading.ahead, 'several': several}


SILENT = Journal('', None)
"""Keeps nothing."""


class NodeJournal:
    """The journal of a node while it is active: what the node says, and how its axes are."""

    def __init__(
        self, node: Node, values: Mapping[str, Any], publishers: Mapping[str, Any]
    ) -> None:
        """Keep silent at first; `publishers` have the axes by name."""
        self.journal = SILENT
        self._node, self._values, self._publishers = node, values, publishers
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
        for name in axes if self.journal.on else ():
            publisher = self._publishers[name]
            publisher.guarded('its record', self._describe, publisher.axis, because)

    def _describe(self, axis: Axis, because: str) -> None:
        topics = {
            source.name.lower(): self._node.resolve_topic_name(topic)
            for source, topic in axis.topics.items()
        }
        self.journal.describe(axis, self._values, topics, because, self._now)

    def record(self, topic: str, message: Any) -> None:
        """Let a recording show what the node publishes; a warning is an event of it."""
        if self.journal.on:
            self.journal.say(self._node.resolve_topic_name(topic), message, self._now)
            if isinstance(message, OutOfZone) and message.event_id:
                self.journal.trigger(self._now)

    def statuses(self) -> list[DiagnosticStatus]:
        """Return how the recording is, if there is one."""
        name = self._node.get_fully_qualified_name()
        return [diagnostics.recording(name, self.journal.problem)] if self.journal.on else []

    @property
    def _now(self) -> int:
        return self._node.get_clock().now().nanoseconds
