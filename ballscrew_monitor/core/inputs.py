# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""From messages to samples in the machine frame, and the health of each input."""

import collections
import dataclasses
import enum
import math
from typing import Any

from ballscrew_monitor.core.conversions import Scaling, SECOND, seconds
from ballscrew_monitor.core.fields import (
    compile_field,
    FieldReader,
    message_class,
    MessageClass,
    stamp_of,
)

RATE_SAMPLES = 20  # samples over which the rate is averaged
SLOW_GAPS = 2  # gaps above the timeout in a row from which on the input is slow, not interrupted
UNSTATED = -1
LOSS_SHOWN = 10 * SECOND  # [ns] for which a loss is warned of
YEAR = (
    31_536_000 * SECOND
)  # [ns] stamps that far from the clock are those of another kind of clock


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
    OTHER_CLOCK = 3  # stamps of the wall clock, far ahead of simulated time


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class InputSample:
    """
    A number [SI, machine frame], the time that it speaks of and that of its arrival [ns].

    Samples of one input are ordered by `stamp`; `arrival`, on the clock of the node, tells how
    fresh they are. Without an arrival the stamp stands for it. `lost` messages were sent just
    before and never arrived; None: how many is not known.

    """

    source: Source
    value: float
    stamp: int
    stamp_source: StampSource = StampSource.HEADER
    arrival: int = UNSTATED
    lost: int | None = 0

    def __post_init__(self) -> None:
        """Let the stamp stand for an arrival that is not stated."""
        if self.arrival == UNSTATED:
            object.__setattr__(self, 'arrival', self.stamp)


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class Refusal:
    """A message that gave no sample, and as `text` why and what mends it; see `InputSample`."""

    source: Source
    why: Why
    text: str = ''
    arrival: int = 0
    lost: int | None = 0


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

    def read(
        self, message: Any, *, now: int, max_future: int, lost: int | None = 0
    ) -> InputSample | Refusal:
        """
        Return the sample in `message`, received at `now` [ns] after `lost` others.

        A stamp more than `max_future` [ns] ahead of `now` is refused, unless `now` is zero: then
        the clock has not started and cannot say. A zero stamp means that there is none.

        """
        value = self.read_field(message)
        if value is None:
            return self._refuse(Why.OTHER_JOINTS, '', now, lost)
        stamp = stamp_of(message) if self.stamped else 0
        if now and stamp - now > max_future:
            why = Why.OTHER_CLOCK if stamp - now > YEAR else Why.FUTURE
            return self._refuse(why, _future_text(stamp - now, max_future), now, lost)
        si_value = self.scaling(value)
        if not math.isfinite(si_value):
            text = f'the field holds {value}, it must be a finite number'
            return self._refuse(Why.NOT_A_NUMBER, text, now, lost)
        return InputSample(
            source=self.source,
            value=si_value,
            stamp=stamp or now,
            stamp_source=StampSource.HEADER if stamp else StampSource.RECEIVE,
            # A clock that has not started times nothing: the stamp is all there is.
            arrival=now or stamp,
            lost=lost,
        )

    def _refuse(self, why: Why, text: str, now: int, lost: int | None) -> Refusal:
        return Refusal(source=self.source, why=why, text=text, arrival=now, lost=lost)


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


def _future_text(ahead: int, allowed: int) -> str:
    """Return why a stamp so far ahead of the clock [ns] is refused, and the cure."""
    if ahead > YEAR:
        return (
            'the stamps are of the wall clock and the node runs on simulated time: '
            'set use_sim_time to false, or stamp with /clock'
        )
    return (
        f'the stamp is {seconds(ahead):.3g} s ahead of the clock, allowed is max_future, '
        f'{seconds(allowed):.3g} s: set the clocks of both machines alike, or raise max_future'
    )


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class Health:
    """
    State of one input at one instant.

    age since the arrival [s], rate [Hz] and lag [s], by how much the stamps lie behind the arrival
    at least, are NaN while unknown; an input is `lagging` from a stated lag on; a `slow` one is
    stale between its samples. `lost` messages never arrived, None: not known; `losing` since not
    long ago. `refusal` is why the last message was refused, while it is the last.

    """

    source: Source
    state: InputState
    stamp_source: StampSource
    age: float
    rate: float
    received: int
    dropped: int
    slow: bool = False
    lag: float = math.nan
    lagging: bool = False
    lost: int | None = 0
    losing: bool = False
    why: Why | None = None
    refusal: str = ''


class Tracker:
    """The last sample of one input, and what is needed to say how well it does."""

    def __init__(
        self, source: Source, *, configured: bool, timeout: int, max_lag: int = YEAR
    ) -> None:
        """Begin without a sample; `timeout` and `max_lag` [ns]."""
        self.source = source
        self.configured = configured
        self.timeout = timeout
        self.max_lag = max_lag
        self.received = 0
        self.dropped = 0
        self._lost, self._lost_known, self._lost_last = 0, True, -LOSS_SHOWN
        self.refusal: Refusal | None = None  # why the last message was refused, if it was
        self.last: InputSample | None = None
        self._stamps: collections.deque[int] = collections.deque(maxlen=RATE_SAMPLES)
        self._lags: collections.deque[int] = collections.deque(maxlen=RATE_SAMPLES)
        self._long_gaps = 0  # in a row

    def accept(self, sample: InputSample) -> None:
        """Take a good sample."""
        self.received += 1
        self.refusal = None
        gap = 0 if self.last is None else sample.stamp - self.last.stamp
        self._long_gaps = self._long_gaps + 1 if gap > self.timeout else 0
        self.last = sample
        self._stamps.append(sample.stamp)
        if sample.stamp_source is StampSource.HEADER and sample.arrival:
            self._lags.append(sample.arrival - sample.stamp)

    def drop(self) -> None:
        """Count a message that is left out, with no harm to the input."""
        self.received += 1
        self.dropped += 1

    def refuse(self, refusal: Refusal) -> None:
        """Count a bad message; the input stays bad until the next good one."""
        self.drop()
        self.refusal = refusal

    def lose(self, count: int | None, arrival: int) -> None:
        """Count messages that never arrived before one at `arrival` [ns]; None: not known."""
        self._lost_known = count is not None
        if count:
            self._lost += count
            self._lost_last = arrival

    def forget(self) -> None:
        """Forget the samples, not the counts: they belong to another time line."""
        self.last = None
        self.refusal = None
        self._stamps.clear()
        self._lags.clear()
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

    @property
    def lag(self) -> float:
        """Return by how much stamps lie behind arrivals [s], the least of the last; NaN: none."""
        return seconds(min(self._lags)) if self._lags else math.nan

    @property
    def lagging(self) -> bool:
        """Tell whether stamps lie too far behind arrivals."""
        return self.lag > seconds(self.max_lag)

    def rebase(self, now: int) -> None:
        """Let what arrived later than `now` [ns] have arrived now: the clock was set back."""
        if self.last is not None and self.last.arrival > now:
            self.last = dataclasses.replace(self.last, arrival=now)

    def state(self, now: int) -> InputState:
        """
        Return the state at `now` [ns] of the clock that arrivals are timed by.

        A sample that arrived exactly the timeout ago is still good.

        """
        if not self.configured:
            return InputState.NOT_CONFIGURED
        if self.refusal is not None:
            return InputState.BAD
        if self.last is None:
            return InputState.MISSING
        return InputState.OK if now - self.last.arrival <= self.timeout else InputState.STALE

    def health(self, now: int) -> Health:
        """Return the health at `now` [ns]."""
        last, lag, refusal = self.last, self.lag, self.refusal
        return Health(
            source=self.source,
            state=self.state(now),
            rate=self._rate(),
            stamp_source=StampSource.UNKNOWN if last is None else last.stamp_source,
            age=math.nan if last is None else max(0.0, seconds(now - last.arrival)),
            received=self.received,
            dropped=self.dropped,
            slow=self.slow,
            lag=lag,
            lagging=self.lagging,
            lost=self._lost if self._lost_known else None,
            losing=0 <= now - self._lost_last < LOSS_SHOWN,
            why=None if refusal is None else refusal.why,
            refusal='' if refusal is None else refusal.text,
        )

    def _rate(self) -> float:
        if len(self._stamps) < 2 or self._stamps[-1] <= self._stamps[0]:
            return math.nan
        return (len(self._stamps) - 1) / seconds(self._stamps[-1] - self._stamps[0])
