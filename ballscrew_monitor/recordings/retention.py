# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Retention of a stream of frames on the disk: which part, in which files, for how long.

Run `python -P -m ballscrew_monitor.recordings.retention FOLDER SETTINGS`, the settings as JSON:
this process writes the recording of a node, so that no judgement waits for a disk. Frames come in
on standard input, and each change of what is wrong goes out as a line. The process is deaf to
Ctrl-C, finishes its recording when the node is gone, however that ended, and knows no ROS.

Always: everything, in recordings of limited length. Around events: the last seconds before each
trigger, from memory, and those after it. Either way the oldest recordings make room for new ones.
Each recording is a bag of its own, which begins with snapshots of all axes. Events are gathered
into messages, and once a second the disk has all that came. Time is an argument.

"""

import collections
from collections.abc import Callable, Sequence
import dataclasses
import datetime
import json
import os
from pathlib import Path
import re
import signal
import sys
import time

from ballscrew_monitor.core.conversions import SECOND
from ballscrew_monitor.judge.records import EVENT
from ballscrew_monitor.recordings.bag_writer import (
    ACTIVE,
    BagWriter,
    Offer,
    Topic,
    WHOLE_CHUNK_SIZE,
)
from ballscrew_monitor.recordings.bulk.events import Events
from ballscrew_monitor.recordings.event_messages import packed
from ballscrew_monitor.recordings.frames import Frame, FrameKind, MOST_SEQUENCE, read_frames
import numpy as np
from surrogate.files import InputError

NAME = re.compile(r'\d{8}T\d{6}Z(?:_\d+)?')
OURS = ('.mcap', f'.mcap{ACTIVE}', 'metadata.yaml')  # how files of a recording end
MOST_RING = 64 * 2**20  # [B] of frames in memory
SYNC = 1.0  # [s] between two times that the disk is made to have all
RETRY = 10.0  # [s] after which writing is tried again
NICENESS = 5
NO_EVENTS = np.empty(0, EVENT)


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class KeepSettings:
    """
    What is kept: `always`, or else around triggers.

    before, after and longest [s], the largest recording and all of them [B].

    """

    always: bool
    before: float
    after: float
    longest: float
    largest: float
    total: float


class EventGatherer:
    """Makes messages of the events of many turns, each behind the last snapshots."""

    def __init__(self) -> None:
        self._notes: dict[int, str] = {}
        self._turns: list[Frame] = []
        self._number = 0

    def take(self, frame: Frame) -> list[Frame]:
        """Take a frame; return the messages that are complete with it."""
        if frame.kind is FrameKind.NOTE:
            self._notes[frame.topic] = frame.body.decode()
        elif frame.kind is FrameKind.EVENTS:
            self._turns.append(frame)
        else:
            return [*self.flush(), self._message(frame, NO_EVENTS, json.loads(frame.body))]
        return []

    def flush(self) -> list[Frame]:
        """Return the message of what was gathered, if there is anything."""
        if not self._turns:
            return []
        turns, self._turns = self._turns, []
        events = np.frombuffer(b''.join(turn.body for turn in turns), EVENT)
        return [self._message(turns[-1], events)]

    def clear(self) -> None:
        """Forget what was gathered."""
        self._turns.clear()

    def _message(self, last: Frame, events: Events, snapshots: Sequence[str] = ()) -> Frame:
        """Return the frame of a message that ends with the frame `last`, numbered."""
        number, self._number = self._number, self._number + 1
        body = packed(number, events, self._notes, snapshots)
        kind = FrameKind.BEGIN if last.kind is FrameKind.BEGIN else FrameKind.MESSAGE
        sequence = number % MOST_SEQUENCE
        return Frame(kind, last.topic, last.log_time, last.log_time, sequence, body)


class Segment:
    """The frames of a message from snapshots of all axes up to the next such snapshots."""

    def __init__(self, begin: float) -> None:
        """Begin at a time [s]."""
        self.begin, self.size = begin, 0
        self.frames: list[Frame] = []

    def add(self, frame: Frame) -> None:
        """Add a frame."""
        self.frames.append(frame)
        self.size += len(frame.body)


class Retention:
    """Keeps what is to be kept of the frames that it takes."""

    def __init__(self, folder: Path, settings: KeepSettings) -> None:
        self._folder = folder
        self._settings = settings
        self._topics: dict[int, Topic] = {}
        self._gatherer = EventGatherer()
        self._segments: collections.deque[Segment] = collections.deque()
        self._writer: BagWriter | None = None
        self._opened = 0.0
        self._synced = 0.0
        self._size = 0
        self._part = 0.0, 0  # when the last snapshots were written [s], and the size then
        self._until = 0.0  # when a recording around an event is complete
        self._retry = 0.0
        self.problem = ''

    def take(self, frame: Frame, now: float) -> None:
        """
        Take a frame at `now` [s] of a clock that only runs on.

        Where the disk refuses, recording is tried again later, from the next snapshots on.

        """
        if now < self._retry and frame.kind not in (FrameKind.TOPIC, FrameKind.NOTE):
            return
        try:
            self._take(frame, now)
        except (OSError, InputError) as error:
            text = error.strerror if isinstance(error, OSError) else error
            self.problem = f'nothing is recorded in {self._folder}: {text}'
            self._retry = now + RETRY
            self._segments.clear()  # what follows does not go on from there
            self._gatherer.clear()
            self._finish(BagWriter.abandon)

    def close(self) -> None:
        """Finish the recording that grows."""
        try:
            self._flush(self._synced)
            self._finish()
        except (OSError, InputError) as error:
            text = error.strerror if isinstance(error, OSError) else error
            self.problem = f'the last recording in {self._folder} is unfinished: {text}'

    def _take(self, frame: Frame, now: float) -> None:
        if frame.kind is FrameKind.TOPIC:
            stated = json.loads(frame.body)
            topic = Topic(
                name=stated['name'], type_name=stated['type'], offer=Offer[stated['offer']]
            )
            self._topics[frame.topic] = topic
            if self._writer is not None:
                self._writer.add_topic(topic)
        elif frame.kind is FrameKind.TRIGGER:
            if self._segments and not self._settings.always:
                self._until = now + self._settings.after
                if self._writer is None:
                    self._forget(now)
                    self._open(self._segments[0].frames[0].log_time, now)
                    for kept in [old for segment in self._segments for old in segment.frames]:
                        self._write(kept)
                    self._size = 0  # of what is to come
        elif frame.kind is FrameKind.MESSAGE:
            self._keep(frame, now)
        else:
            for message in self._gatherer.take(frame):
                self._keep(message, now)
        if now - self._synced >= SYNC:
            self._flush(now)

    def _flush(self, now: float) -> None:
        """Let the disk have all: a machine that loses its power loses what follows."""
        for message in self._gatherer.flush():
            self._keep(message, now)
        if self._writer is not None:
            self._writer.sync()
        self._synced = now

    def _keep(self, frame: Frame, now: float) -> None:
        if self._settings.always:
            if frame.kind is FrameKind.BEGIN:
                begun, size = self._part
                longest = 2.0 * now - begun - self._opened > self._settings.longest
                if self._writer is not None and (
                    longest or 2 * self._size - size > self._settings.largest
                ):
                    self._finish()
                if self._writer is None:
                    self._open(frame.log_time, now)
                self._part = now, self._size
            if self._writer is not None:
                self._write(frame)
        else:
            if self._writer is not None:
                self._write(frame)
                if now >= self._until or self._size >= self._settings.largest:
                    self._finish()
            if frame.kind is FrameKind.BEGIN:
                self._segments.append(Segment(now))
                self._forget(now)
            if self._segments:
                self._segments[-1].add(frame)

    def _forget(self, now: float) -> None:
        segments = self._segments
        while len(segments) > 1 and (
            now - segments[1].begin >= self._settings.before
            or sum(segment.size for segment in segments) > MOST_RING
        ):
            segments.popleft()

    def _open(self, log_time: int, now: float) -> None:
        self._make_room()
        moment = datetime.datetime.fromtimestamp(max(log_time, 0) // SECOND, datetime.UTC)
        name = moment.strftime('%Y%m%dT%H%M%SZ')
        number, path = 1, self._folder / name  # of the time of the first message, in UTC
        while True:
            try:
                path.mkdir(parents=True)
                break
            except FileExistsError:  # made before, by another process perhaps
                number += 1
                path = self._folder / f'{name}_{number}'
        self._writer = BagWriter(path, path.name, chunk_size=WHOLE_CHUNK_SIZE)
        for topic in self._topics.values():
            self._writer.add_topic(topic)
        self._opened, self._size, self.problem = now, 0, ''

    def _write(self, frame: Frame) -> None:
        assert self._writer is not None
        self._writer.write(
            self._topics[frame.topic].name,
            frame.body,
            log_time=frame.log_time,
            publish_time=frame.publish_time,
            sequence=frame.sequence,
        )
        self._size += len(frame.body)

    def _finish(self, end: Callable[[BagWriter], None] = BagWriter.close) -> None:
        """End the recording that grows; one that is abandoned stays to be recovered."""
        writer, self._writer = self._writer, None
        if writer is not None:
            end(writer)

    def _make_room(self) -> None:
        sizes = {
            path: sum(file.stat().st_size for file in path.iterdir())
            for path in self._folder.glob('*')
            if path.is_dir() and NAME.fullmatch(path.name)
        }
        room = self._settings.total - self._settings.largest
        for path in sorted(sizes, key=lambda path: path.stat().st_mtime):
            if sum(sizes.values()) <= max(room, 0.0):
                return
            for file in path.iterdir():
                if file.name.endswith(OURS):
                    file.unlink()
            if not any(path.iterdir()):
                path.rmdir()
            del sizes[path]


def main() -> None:
    """Keep what comes until the input ends."""
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, signal.SIG_IGN)
    os.nice(NICENESS)
    retention = Retention(Path(sys.argv[1]), KeepSettings(**json.loads(sys.argv[2])))
    last = ''
    for frame in read_frames(sys.stdin.buffer):
        retention.take(frame, time.monotonic())
        last = _say(retention.problem, last)
    retention.close()
    _say(retention.problem, last)


def _say(problem: str, last: str) -> str:
    """Tell the node of a change; it may be gone."""
    if problem != last:
        try:
            print(problem, flush=True)
        except OSError:
            pass
    return problem


if __name__ == '__main__':
    main()
