# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Frames from a node to the process that writes its recording: topics, messages, events.

A frame is a head of fixed length and a body. The way from the node never blocks: what the pipe
does not take waits in a backlog of bounded size, and beyond that frames are dropped.

"""

import collections
from collections.abc import Iterator
import dataclasses
import enum
import os
import struct
from typing import BinaryIO

HEAD = struct.Struct('<BHqqII')  # kind, topic, log time, publish time, sequence, length of body
MOST_BACKLOG = 16 * 2**20  # [B]
LONGEST_BODY = 64 * 2**20  # [B]
MOST_SEQUENCE = 2**32
EVENTS = 'ballscrew_msgs/msg/JudgeEvents'  # type of the topic of events
BEGIN, PERIODIC, HOLE = 'begin', 'time', 'hole'
"""Reasons for snapshots of all axes; any other tells what has changed some."""


class FrameKind(enum.IntEnum):
    """What a frame is."""

    TOPIC = 0  # body: JSON of name, type and offer; its number is that of the frame
    MESSAGE = 1  # body: the serialised message
    TRIGGER = 2  # something has happened that a recording around events is to show
    EVENTS = 3  # body: the events of a turn, an array of EVENT, for the topic of events
    NOTE = 4  # body: the text of a note of events, whose number is that of the frame
    SNAPSHOT = 5  # body: JSON, a list of snapshots; its topic is that of events
    BEGIN = 6  # the same of all axes: a recording may begin here


@dataclasses.dataclass(frozen=True, slots=True)
class Frame:
    """A frame; times [ns], `sequence` modulo 2**32."""

    kind: FrameKind
    topic: int = 0
    log_time: int = 0
    publish_time: int = 0
    sequence: int = 0
    body: bytes = b''

    def packed(self) -> bytes:
        """Return the frame as it is sent."""
        head = HEAD.pack(
            self.kind, self.topic, self.log_time, self.publish_time, self.sequence, len(self.body)
        )
        return head + self.body


def read_frames(stream: BinaryIO) -> Iterator[Frame]:
    """Yield frames until the stream ends; one that is cut off is dropped."""
    while len(head := stream.read(HEAD.size)) == HEAD.size:
        kind, topic, log_time, publish_time, sequence, length = HEAD.unpack(head)
        if length > LONGEST_BODY:
            return
        body = stream.read(length)
        if len(body) == length:
            yield Frame(FrameKind(kind), topic, log_time, publish_time, sequence, body)


class FrameSender:
    """Sends frames into a pipe without ever waiting for it."""

    def __init__(self, pipe: int, *, most: int = MOST_BACKLOG) -> None:
        """Send into the descriptor `pipe`, keeping at most `most` [B] that it does not take."""
        os.set_blocking(pipe, False)
        self._pipe = pipe
        self._most = most
        self._backlog: collections.deque[bytes] = collections.deque()
        self._size = 0
        self.broken = False

    def put(self, frame: Frame) -> bool:
        """Queue a frame; return False if there is no room for it."""
        data = frame.packed()
        if self._size + len(data) > self._most or self.broken:
            return False
        self._backlog.append(data)
        self._size += len(data)
        return True

    def flush(self) -> bool:
        """Send as much as the pipe takes now; return whether nothing is left."""
        if not self._backlog:
            return True
        data = b''.join(self._backlog)
        self._backlog.clear()
        try:
            sent = os.write(self._pipe, data)
        except BlockingIOError:
            sent = 0
        except OSError:
            self.broken, sent = True, len(data)
        if sent < len(data):
            self._backlog.append(data[sent:])
        self._size = len(data) - sent
        return not self._backlog
