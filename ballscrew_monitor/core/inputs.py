# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""From messages to samples in the machine frame, and the health of each input."""

import collections
import dataclasses
import enum
import math
from typing import Any

from ballscrew_monitor.core.conversions import Scaling, seconds
from ballscrew_monitor.core.fields import (
    compile_field,
    FieldReader,
    message_class,
    MessageClass,
    stamp_of,
)

RATE_SAMPLES = 20  # samples over which the rate is averaged
SLOW_GAPS = 2  # gaps above the timeout in a row from which on the input is slow, not interrupted


class Source(enum.IntEnum):
    """What an input measures; samples of equal stamp are taken in this order, speed last."""

    TEMPERATURE = 0
    LOAD = 1
    TORQUE = 2
    SPEED = 3


class StampSource(enum.IntEnum):
    """Where a stamp comes from; the numbers of InputHealth.STAMP_."""

    UNKNOWN = 0
    HEADER = 1
    RECEIVE = 2


class InputState(enum.IntEnum):
    """State of an input; the numbers of InputHealth.STATE_."""

    UNKNOWN = 0
    OK = 1
    STALE = 2
    MISSING = 3
    BAD = 4
    NOT_CONFIGURED = 5


class Why(enum.IntEnum):
    """Why a message gave no sample."""

    OTHER_JOINTS = 0  # the message speaks of other joints: dropped, and nothing is wrong
    NOT_A_NUMBER = 1
    FUTURE = 2


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class InputSample:
    """A number [SI, machine frame] and its time [ns]."""

    source: Source
    value: float
    stamp: int
    stamp_source: StampSource = StampSource.HEADER


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class Refusal:
    """A message that gave no sample."""

    source: Source
    why: Why


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class Input:
    """One configured input: where it comes from and how it is read."""

    source: Source
    topic: str
    type_name: str
    message_type: MessageClass
    read_field: FieldReader
    scaling: Scaling
    stamped: bool

    def read(self, message: Any, *, now: int, max_future: int) -> InputSample | Refusal:
        """
        Return the sample in `message`, received at `now` [ns].

        A stamp more than `max_future` [ns] ahead of `now` is refused, unless `now` is zero: then
        the clock has not started and cannot say. A zero stamp means that there is none.

        """
        value = self.read_field(message)
        if value is None:
            return Refusal(source=self.source, why=Why.OTHER_JOINTS)
        stamp = stamp_of(message) if self.stamped else 0
        if now and stamp - now > max_future:
            return Refusal(source=self.source, why=Why.FUTURE)
        si_value = self.scaling(value)
        if not math.isfinite(si_value):
            return Refusal(source=self.source, why=Why.NOT_A_NUMBER)
        return InputSample(
            source=self.source,
            value=si_value,
            stamp=stamp or now,
            stamp_source=StampSource.HEADER if stamp else StampSource.RECEIVE,
        )


def make_input(
    source: Source, *, topic: str, type_name: str, field: str, scaling: Scaling
) -> Input:
    """Return a checked input; raises InputError with the reason when it cannot work."""
    message_type = message_class(type_name)
    fields = message_type.get_fields_and_field_types()
    return Input(
        source=source,
        topic=topic,
        type_name=type_name,
        message_type=message_type,
        read_field=compile_field(field, message_type),
        scaling=scaling,
        stamped=fields.get('header') == 'std_msgs/Header',
    )


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class Health:
    """
    State of one input at one instant.

    age [s] and rate [Hz], both NaN while unknown; a `slow` input is stale between its samples.

    """

    source: Source
    state: InputState
    stamp_source: StampSource
    age: float
    rate: float
    received: int
    dropped: int
    slow: bool = False


class Tracker:
    """The last sample of one input, and what is needed to say how well it does."""

    def __init__(self, source: Source, *, configured: bool, timeout: int) -> None:
        """Begin without a sample; `timeout` [ns]."""
        self.source = source
        self.configured = configured
        self.timeout = timeout
        self.received = 0
        self.dropped = 0
        self.refused = False  # the last message was refused
        self.last: InputSample | None = None
        self._stamps: collections.deque[int] = collections.deque(maxlen=RATE_SAMPLES)
        self._long_gaps = 0  # in a row

    def accept(self, sample: InputSample) -> None:
        """Take a good sample."""
        self.received += 1
        self.refused = False
        gap = 0 if self.last is None else sample.stamp - self.last.stamp
        self._long_gaps = self._long_gaps + 1 if gap > self.timeout else 0
        self.last = sample
        self._stamps.append(sample.stamp)

    def drop(self) -> None:
        """Count a message that is left out, with no harm to the input."""
        self.received += 1
        self.dropped += 1

    def refuse(self) -> None:
        """Count a bad message; the input stays bad until the next good one."""
        self.drop()
        self.refused = True

    def forget(self) -> None:
        """Forget the samples, not the counts: they belong to another time line."""
        self.last = None
        self.refused = False
        self._stamps.clear()
        self._long_gaps = 0

    def is_ahead(self, stamp: int) -> bool:
        """Tell whether the last sample is newer than `stamp` [ns]."""
        return self.last is not None and self.last.stamp > stamp

    @property
    def slow(self) -> bool:
        """Tell whether the input comes less often than its timeout asks for."""
        return self._long_gaps >= SLOW_GAPS

    @property
    def slow_period(self) -> int:
        """Return the last period [ns] of a slow input, 0 for any other."""
        return self._stamps[-1] - self._stamps[-2] if self.slow else 0

    def state(self, now: int) -> InputState:
        """Return the state at `now` [ns]; a sample exactly as old as the timeout is still good."""
        if not self.configured:
            return InputState.NOT_CONFIGURED
        if self.refused:
            return InputState.BAD
        if self.last is None:
            return InputState.MISSING
        return InputState.OK if now - self.last.stamp <= self.timeout else InputState.STALE

    def health(self, now: int) -> Health:
        """Return the health at `now` [ns]."""
        last = self.last
        return Health(
            source=self.source,
            state=self.state(now),
            rate=self._rate(),
            stamp_source=StampSource.UNKNOWN if last is None else last.stamp_source,
            age=math.nan if last is None else max(0.0, seconds(now - last.stamp)),
            received=self.received,
            dropped=self.dropped,
            slow=self.slow,
        )

    def _rate(self) -> float:
        if len(self._stamps) < 2 or self._stamps[-1] <= self._stamps[0]:
            return math.nan
        return (len(self._stamps) - 1) / seconds(self._stamps[-1] - self._stamps[0])
