# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Log times of 0: a recorder on simulated time logs so what comes before the first word of /clock.

Such a message is taken to be logged at the time that it holds, and as much later as the first
message of its topic whose log time is another one. What counts is the stamp, of messages without
one when they were published. One that holds no time comes with the message before it.

"""

from collections.abc import Collection, Iterator, Sequence
import contextlib
import dataclasses
from pathlib import Path
import statistics
import struct

from ballscrew_monitor.core.conversions import SECOND
from ballscrew_monitor.core.fields import message_class
from ballscrew_monitor.recordings.storages import by_log_time, Message, Storage, Stream, whole
from surrogate.files import InputError

RIGHT = SECOND  # [ns] after 0 up to which a log time of 0 is right: simulated time begins so
STAMPED = ('std_msgs/Header', 'builtin_interfaces/Time')
"""Types of a first field that begins with a stamp."""
STAMP = 4  # [bytes] before the first field
TIMES = struct.Struct('>iI'), struct.Struct('<iI')  # by the order of bytes that a message states


def with_believed_log_times(
    path: Path, storages: Sequence[Storage]
) -> tuple[Sequence[Storage], str]:
    """
    Return the files of a bag with log times to believe, and a sentence of those that are not.

    Raises InputError if no message of a bag tells a time.

    """
    held = [storage for storage in storages if any(info.count for info in storage.topics.values())]
    if all(storage.span[0] for storage in held):
        return storages, ''
    times = _HeldTimes(held)
    if not times.first:
        raise InputError(
            f'bag {path}: the log times of all its {times.count} messages are 0 and none holds '
            'a stamp, times are needed: record it again once /clock is published'
        )
    retimed = [_Retimed(storage, times) for storage in storages]
    zeros = sum(storage.zeros for storage in retimed)
    if not zeros:
        return storages, ''
    return retimed, (
        f'bag {path}: the log times of {zeros} of its {times.count} messages are 0 and were not '
        'believed: the stamps of these messages stand in their place'
    )


class _HeldTimes:
    """What messages hold as a time, and how much later the messages of their topics are logged."""

    def __init__(self, storages: Sequence[Storage]) -> None:
        self.count, first = 0, 0
        self._shifts: dict[str, int] = {}
        self._stamped = set[str]()  # topics whose messages begin with a stamp
        for name, info in (pair for storage in storages for pair in storage.topics.items()):
            with contextlib.suppress(InputError):
                fields = message_class(info.type_name).get_fields_and_field_types()
                if next(iter(fields.values()), '') in STAMPED:
                    self._stamped.add(name)
        for storage in storages:
            for message in map(whole, storage.messages(storage.topics, as_written=True)):
                self.count += 1
                first = first or message.log_time or self._held(message)
                if message.log_time and (held := self._held(message)):
                    self._shifts.setdefault(message.topic, message.log_time - held)
        self._usual = statistics.median_low(self._shifts.values()) if self._shifts else 0
        self.first = first

    def log_time(self, message: Message, before: int) -> int:
        """Return when a message was logged, with the one `before` [ns] if it tells nothing."""
        if message.log_time:
            return message.log_time
        held = self._held(message)
        shift = self._shifts.get(message.topic, self._usual)
        return max(held + shift, 0) if held else before or self.first

    def _held(self, message: Message) -> int:
        data = message.data
        if message.topic not in self._stamped:
            return message.publish_time
        if len(data) < STAMP + TIMES[0].size:
            return 0
        seconds, nanoseconds = TIMES[data[1] & 1].unpack_from(data, STAMP)
        return max(int(seconds) * SECOND + int(nanoseconds), 0)


class _Retimed(Storage):
    """A file of a bag whose messages come at the times that are believed."""

    def __init__(self, storage: Storage, times: _HeldTimes) -> None:
        self._storage, self._times = storage, times
        self.file, self.topics, self.note = storage.file, storage.topics, storage.note
        self.zeros, span = 0, list[int]()
        for message, log_time in self._timed(storage.topics):
            self.zeros += not message.log_time and log_time > RIGHT
            span = [min(*span, log_time), max(*span, log_time)] if span else [log_time] * 2
        self.span = (span[0], span[1]) if span else storage.span

    def messages(self, wanted: Collection[str], *, as_written: bool = False) -> Stream:
        """Yield the messages, see `Storage`."""
        written = (
            dataclasses.replace(message, log_time=log_time)
            for message, log_time in self._timed(self.topics)
            if message.topic in wanted
        )
        yield from written if as_written else by_log_time(written)
        self.note = self._storage.note

    def _timed(self, wanted: Collection[str]) -> Iterator[tuple[Message, int]]:
        before = 0
        for message in map(whole, self._storage.messages(wanted, as_written=True)):
            before = self._times.log_time(message, before)
            yield message, before
