# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Log times of 0: a recorder on simulated time logs so what comes before the first word of /clock.

Log times near 0 in a bag that goes on years later are those of a clock that was set meanwhile.
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

LONGEST = 10 * 31_557_600 * SECOND  # [ns] that a bag may last
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

    Raises InputError if no message of a bag tells a time, or if it lasts more than ten years.

    """
    held = [storage for storage in storages if any(info.count for info in storage.topics.values())]
    first, last = _span(held)
    if first and last - first <= LONGEST:
        return storages, ''
    times = _HeldTimes(held, LONGEST if last - first > LONGEST else 1)
    if not times.first:
        raise InputError(
            f'bag {path}: the log times of all its {times.count} messages are 0 and none holds '
            'a stamp, times are needed: record it again once /clock is published'
        )
    retimed = [_Retimed(storage, times) for storage in storages]
    first, last = _span(retimed)
    if last - first > LONGEST:
        raise InputError(
            f'bag {path}: its log times go from {first / SECOND:.12g} s to {last / SECOND:.12g} '
            's, more than ten years, and stamps tell no others: its clock was set meanwhile, '
            'record it again'
        )
    wrong = sum(storage.wrong for storage in retimed)
    if not wrong:
        return storages, ''
    is_zero = not any(storage.latest for storage in retimed)
    where = '0' if is_zero else 'before 1980, more than ten years before its last,'
    return retimed, (
        f'bag {path}: the log times of {wrong} of its {times.count} messages are {where} and were '
        'not believed: the stamps of these messages stand in their place'
    )


def _span(storages: Sequence[Storage]) -> tuple[int, int]:
    """Return the first and the last log time of messages [ns]."""
    spans = [
        storage.span for storage in storages if any(info.count for info in storage.topics.values())
    ]
    return min(span[0] for span in spans), max(span[1] for span in spans)


class _HeldTimes:
    """
    What messages hold as a time, and how much later the messages of their topics are logged.

    Log times below the `least` [ns] are not believed.

    """

    def __init__(self, storages: Sequence[Storage], least: int) -> None:
        self.count, self.least, first = 0, least, 0
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
                is_right = message.log_time >= least
                held = self._held(message)
                first = first or (message.log_time if is_right else held)
                if is_right and held:
                    self._shifts.setdefault(message.topic, message.log_time - held)
        self._usual = statistics.median_low(self._shifts.values()) if self._shifts else 0
        self.first = first

    def log_time(self, message: Message, before: int) -> int:
        """Return when a message was logged, with the one `before` [ns] if it tells nothing."""
        if message.log_time >= self.least:
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
        # The number of log times that are not right, and the latest of them.
        self.wrong, self.latest, span = 0, 0, list[int]()
        for message, log_time in self._timed(storage.topics):
            if log_time - message.log_time > RIGHT:
                self.wrong += 1
                self.latest = max(self.latest, message.log_time)
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
