# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Recorder of the node: it hands each turn of events to a process before they are judged.

Beside the events go the messages of the inputs and of the node itself, and snapshots of the axes:
at activation, every ten seconds, after a hole, and whenever something else than an event has
changed an axis. So a replay begins at any snapshot, and judges what the node judged.

"""

from collections.abc import Callable, Iterable, Mapping, Sequence
import json
from pathlib import Path
import struct
from typing import Any

from ballscrew_monitor.core.cdr import serialized
from ballscrew_monitor.core.conversions import nanoseconds
from ballscrew_monitor.core.fields import OtherJoints, type_name_of
from ballscrew_monitor.core.inputs import InputSample, Refusal
from ballscrew_monitor.judge.monitor import fill, within
from ballscrew_monitor.judge.records import ALL_AXES, EVENT, Event, NOT_KNOWN, STEP, TICK
from ballscrew_monitor.judge.snapshot import snapshot
from ballscrew_monitor.messages import diagnostics
from ballscrew_monitor.node.recording_process import recording, RecordingProcess
from ballscrew_monitor.node.topic import Arrival
from ballscrew_monitor.recordings.bulk.events import Events, MOST_NAMED, some, TICK_SOURCE
from ballscrew_monitor.recordings.event_messages import note_text
from ballscrew_monitor.recordings.frames import BEGIN, EVENTS, Frame, FrameKind, HOLE, PERIODIC
from ballscrew_monitor.settings.axis import Axis
from ballscrew_msgs.msg import AxisHealth, OutOfZone, SurfaceInfo
from diagnostic_msgs.msg import DiagnosticStatus
import numpy as np
from rclpy.node import Node

LATCHED = (AxisHealth, OutOfZone, SurfaceInfo)
CORRECTION = ('speed', 'opposing_load', 'temperature', 'solved')  # of a full solve
SNAPSHOT_PERIOD = nanoseconds(10.0)  # [ns]
# [ns] after which a lost process is started again; twice as long if it is lost soon after.
RESTART, LONGEST_RESTART = nanoseconds(2.0), nanoseconds(60.0)
HOLE_SHOWN = nanoseconds(10.0)  # [ns] for which a hole is warned of
Heard = tuple[Arrival, int, int | None]
"""A message, its arrival [ns] on the clock of the node, and how many were lost before it."""
AxisEvent = tuple[Axis, InputSample | Refusal]
RECORD = struct.Struct('@' + ''.join(EVENT[name].char for name in EVENT.names or ()))
"""An event as an element of an array of EVENT."""


class EventRecorder:
    """Hands all on to the process that records; without one it costs nothing."""

    def __init__(
        self, topic: str, start: Callable[[], RecordingProcess] | None, *, raw: bool = True
    ) -> None:
        """
        Record events as a `topic`; `start` makes the process, None: nothing is recorded.

        Messages of the inputs are recorded `raw` beside their events, or not at all.

        """
        self.on = start is not None
        self.raw = self.on and raw
        self._topic, self._start = topic, start
        self._process = None if start is None else start()
        self._lost_at: int | None = None  # the process, on the steady clock
        self._topics: dict[str, int] = {}
        self._notes: dict[OtherJoints, int] = {}
        self._axes: dict[str, int] = {}  # numbers by name
        self._pause = RESTART
        self._started_at = 0  # the process, on the steady clock, again
        self._hole = False  # frames were dropped: a snapshot must come first
        self._hole_shown = False
        self._hole_over = -HOLE_SHOWN  # on the steady clock
        self._snapshot_at = 0  # the last one of all axes, on the steady clock

    @property
    def problem(self) -> str:
        """Return why nothing is recorded, in a sentence, or nothing."""
        if self._process is None:
            return ''
        return self._process.problem or ('the recording has a hole' if self._hole_shown else '')

    def hear(self, batch: Sequence[Heard]) -> None:
        """Take the messages of a turn as they came."""
        for arrival, now, _ in batch if self.raw else ():
            name, kind = arrival.topic.name, arrival.topic.type_name
            self._put(name, kind, 'SENSOR', arrival.data, now)

    def take(self, turn: Sequence[AxisEvent], now: int, steady: int) -> None:
        """Take the events of a turn in the order of judging, at `now` of both clocks [ns]."""
        if self._process is None or not self._axes:
            return
        parts = []
        for axis, event in turn:
            if (number := self._axes.get(axis.name)) is None:  # no snapshot could be made of it
                continue
            record = Event(axis=number, steady=steady)
            fill(record, event)
            joints = event.joints if isinstance(event, Refusal) else None
            record.note = NOT_KNOWN if joints is None else self._note(joints)
            parts.append(_packed(record))
        self._put_events(b''.join(parts), now)

    def take_many(
        self,
        events: Events,
        axes: Sequence[str],
        joints: Mapping[int, OtherJoints],
        now: int,
        steady: int,
    ) -> None:
        """Take the same as an array, with the axis of each, and the joints named at places."""
        if self._process is None or not self._axes:
            return
        numbers = np.array([self._axes.get(axis, -1) for axis in axes])
        kept = some(events, numbers >= 0)
        kept['axis'], kept['steady'] = numbers[numbers >= 0], steady
        left = np.cumsum(numbers >= 0) - 1
        for place, named in joints.items():
            if numbers[place] >= 0:
                kept['note'][left[place]] = self._note(named)
        self._put_events(kept.tobytes(), now)

    def tick(self, grid: int, now: int, steady: int) -> None:
        """Take a tick of all axes at `grid` [ns]."""
        self._take_of_all(TICK, grid, now, steady)

    def set_clock(self, due: int, now: int, steady: int) -> None:
        """Take that the clock of the node shows `now` and was to show `due` [ns]."""
        self._take_of_all(STEP, due, now, steady)

    def _take_of_all(self, kind: int, stamp: int, now: int, steady: int) -> None:
        if self._process is None or not self._axes:
            return
        event = Event(kind=kind, source=TICK_SOURCE, axis=ALL_AXES, stamp=within(stamp))
        event.arrival, event.steady = within(now), steady
        self._put_events(_packed(event), now)

    def flush(self) -> None:
        """Hand over what was taken so far, whatever becomes of the node with it."""
        if self._process is not None:
            self._process.flush()

    def say(self, topic: str, message: Any, now: int) -> None:
        """Take a message that the node publishes at `now` [ns] of its clock."""
        offer = 'LATCHED' if isinstance(message, LATCHED) else 'RELIABLE'
        self._put(topic, type_name_of(message), offer, serialized(message), now)

    def trigger(self, now: int) -> None:
        """Let a recording around events show what has just happened."""
        if self._process is not None:
            self._process.put(Frame(FrameKind.TRIGGER, log_time=now))

    def snapshot(self, axes: Mapping[str, Mapping[str, Any]], because: str, now: int) -> None:
        """
        Take snapshots of some axes, by their names, and what has changed these.

        Until the first `/clock` simulated time stands at 0, which is no time: a recording begins
        after that.

        """
        whole = because in (BEGIN, PERIODIC, HOLE)
        if self._process is None or not now or not (whole or self._axes):
            return
        for name in axes if whole else ():
            self._axes.setdefault(name, len(self._axes))
        texts = [
            json.dumps(
                {'axis': name, 'number': self._axes[name], 'because': because, **taken},
                allow_nan=False,
                separators=(',', ':'),
            )
            for name, taken in axes.items()
            if name in self._axes
        ]
        kind = FrameKind.BEGIN if whole else FrameKind.SNAPSHOT
        if (number := self._number(self._topic, EVENTS, 'RELIABLE')) is not None:
            body = json.dumps(texts).encode()
            self._send(Frame(kind, number, now, body=body))

    def due(self, steady: int, now: int) -> str:
        """Return why a snapshot of all axes is due at `steady` [ns], empty if none is."""
        if self._process is None or not now:
            return ''
        if not self._process.lost and steady - self._started_at >= LONGEST_RESTART:
            self._pause = RESTART
        if self._process.lost:
            self._lost_at = steady if self._lost_at is None else self._lost_at
            if steady - self._lost_at < self._pause:
                return ''
            assert self._start is not None
            self._started_at = steady
            self.close()
            self._process, self._lost_at = self._start(), None
            self._pause = min(2 * self._pause, LONGEST_RESTART)
            self._topics.clear()
            self._notes.clear()
            self._hole = True
        mended = self._hole and not self._process.lost and self._process.flush()
        if mended:
            self._hole, self._hole_over = False, steady
        self._hole_shown = self._hole or steady - self._hole_over < HOLE_SHOWN
        if not (mended or not self._axes or steady - self._snapshot_at >= SNAPSHOT_PERIOD):
            return ''
        self._snapshot_at = steady
        return HOLE if mended else PERIODIC if self._axes else BEGIN

    def close(self) -> None:
        """Finish the recording."""
        if self._process is not None:
            self._process.close()
            self._process = None

    def _note(self, joints: OtherJoints) -> int:
        """Return the number of the joints that a message names; one kind too many has none."""
        number = self._notes.get(joints)
        if number is None and len(self._notes) < MOST_NAMED:
            body = note_text(joints).encode()
            if self._send(Frame(FrameKind.NOTE, len(self._notes), body=body)):
                number = self._notes[joints] = len(self._notes)
        return NOT_KNOWN if number is None else number

    def _put_events(self, body: bytes, now: int) -> None:
        number = self._number(self._topic, EVENTS, 'RELIABLE')
        if number is not None:
            self._send(Frame(FrameKind.EVENTS, number, now, body=body))

    def _put(self, topic: str, type_name: str, offer: str, data: bytes, now: int) -> None:
        # What comes before the first snapshot belongs to no recording.
        if self._axes and (number := self._number(topic, type_name, offer)) is not None:
            self._send(Frame(FrameKind.MESSAGE, number, now, now, body=data))

    def _number(self, topic: str, type_name: str, offer: str) -> int | None:
        """Return the number of a topic, which is announced before; None while there is a hole."""
        number = self._topics.get(topic)
        if number is None:
            stated = json.dumps({'name': topic, 'type': type_name, 'offer': offer})
            number = len(self._topics)
            if not self._send(Frame(FrameKind.TOPIC, number, body=stated.encode())):
                return None
            self._topics[topic] = number
        return number

    def _send(self, frame: Frame) -> bool:
        """Send a frame; return False in a hole, which the first one that is lost begins."""
        if self._process is not None and not self._hole:
            self._hole = not self._process.put(frame)
        return self._process is not None and not self._hole


def _packed(event: Event) -> bytes:
    return RECORD.pack(
        event.kind,
        event.source,
        event.why,
        event.stamp_source,
        event.axis,
        event.note,
        event.stamp,
        event.arrival,
        event.steady,
        event.lost,
        event.value,
        event.first,
        event.second,
        event.log_time,
        event.place,
    )


SILENT = EventRecorder('', None)
"""Records nothing."""


class NodeRecorder:
    """The recorder of a node while it is active: what the node says, and how its axes stand."""

    def __init__(
        self, node: Node, values: Mapping[str, Any], publishers: Mapping[str, Any]
    ) -> None:
        self.events = SILENT
        self._node, self._values, self._publishers = node, values, publishers
        self._start: Callable[[], RecordingProcess] | None = None

    def configure(self, folder: Path | None) -> None:
        """Take over the parameters; raises InputError when there is no place for a recording."""
        self._start = recording(self._values, folder)

    def begin(self) -> None:
        """Begin a recording, if there is to be one."""
        topic = self._node.resolve_topic_name('~/judge_events')
        self.events = EventRecorder(topic, self._start, raw=self._values['record_inputs'])
        self.snapshot(self._publishers, BEGIN)

    def close(self) -> None:
        """Let the recording be finished."""
        self.events.close()
        self.events = SILENT

    def renew(self, steady: int, now: int) -> None:
        """Record how all axes stand, if that is due at `now` of both clocks [ns]."""
        if because := self.events.due(steady, now):
            self.snapshot(self._publishers, because)
        self.events.flush()

    def snapshot(self, axes: Iterable[str], because: str) -> None:
        """Record how some axes stand now, and what has changed them."""
        snapshots = {}
        for name in axes if self.events.on else ():
            publisher = self._publishers[name]
            if taken := publisher.guarded('its snapshot', self._snapshot_of, publisher.axis):
                snapshots[name] = taken
        if snapshots:
            self.events.snapshot(snapshots, because, self._now)

    def _snapshot_of(self, axis: Axis) -> Mapping[str, Any]:
        topics = {
            source.name.lower(): self._node.resolve_topic_name(topic)
            for source, topic in axis.topics.items()
        }
        return axis_snapshot(axis, self._values, topics)

    def record(self, topic: str, message: Any) -> None:
        """Let a recording show what the node publishes; a warning is an event of it."""
        if self.events.on:
            self.events.say(self._node.resolve_topic_name(topic), message, self._now)
            if isinstance(message, OutOfZone) and message.event_id:
                self.events.trigger(self._now)

    def statuses(self) -> list[DiagnosticStatus]:
        """Return how the recording is, if there is one."""
        name = self._node.get_fully_qualified_name()
        return [diagnostics.recording(name, self.events.problem)] if self.events.on else []

    @property
    def _now(self) -> int:
        return self._node.get_clock().now().nanoseconds


def axis_snapshot(
    axis: Axis, values: Mapping[str, Any], topics: Mapping[str, str]
) -> dict[str, Any]:
    """Return the settings of an axis, of parameters `values` and full names, and its memory."""
    mine = {name: value for name, value in values.items() if name.startswith(f'{axis.name}.')}
    return {
        'values': mine | {'axes': [axis.name], 'tick_period': values['tick_period']},
        'topics': dict(topics),
        'surface': {
            'base_sha256': axis.surface.base_sha256,
            'corrections': [
                {name: getattr(correction, name) for name in CORRECTION}
                for correction in axis.surface.corrections
            ],
        },
        'memory': snapshot(axis.monitor),
    }
