# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Status of an input: what was received, what is wrong with it, and how fresh it is."""

import collections
import dataclasses
import enum
import math

from ballscrew_monitor.core.conversions import SECOND, seconds
from ballscrew_monitor.core.fields import OtherJoints
from ballscrew_monitor.core.inputs import InputSample, Refusal, Source, StampSource, Why, YEAR

RATE_SAMPLES = 20  # samples over which the rate is averaged
SLOW_GAPS = 2  # gaps above the timeout in a row from which on the input is slow, not interrupted
LOSS_SHOWN = 10 * SECOND  # [ns] for which a loss is warned of
GLITCH_SHOWN = 10 * SECOND  # [ns] for which an implausible sample is warned of
MOST_OTHERS = 16  # kinds of messages about other joints that are told apart


class InputState(enum.IntEnum):
    """State of an input; the numbers of InputHealth.STATE_."""

    UNKNOWN = 0
    OK = 1
    STALE = 2
    MISSING = 3
    BAD = 4
    NOT_CONFIGURED = 5
    DERIVED = 6  # from the other inputs


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class InputStatus:
    """
    State of one input at one instant.

    age since the arrival [s], rate [Hz] and lag [s], by how much the stamps lie behind the arrival
    at least, are NaN while unknown; an input is `lagging` from a stated lag on; a `slow` one is
    stale between its samples, and a timeout of `longest_gap` [s] would do, NaN for any other.
    `lost` messages never arrived, None: not known; `losing` since not long ago.
    `implausible` samples were refused, `glitching` not long ago. `refusal` is why
    the last message was refused, while it is the last; `joints` are what messages about other
    joints have named since the last sample.

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
    implausible: int = 0
    glitching: bool = False
    longest_gap: float = math.nan
    why: Why | None = None
    refusal: str = ''
    joints: OtherJoints | None = None


class Tracker:
    """The last sample of one input, and what is needed to say how well it does."""

    def __init__(
        self,
        source: Source,
        *,
        configured: bool,
        timeout: int,
        max_lag: int = YEAR,
        derived: bool = False,
    ) -> None:
        """Begin without a sample; `timeout` and `max_lag` [ns]; a `derived` one gets none."""
        self.source = source
        self.configured = configured
        self._absent = InputState.DERIVED if derived else InputState.NOT_CONFIGURED
        self.timeout = timeout
        self.max_lag = max_lag
        self.received = 0
        self.dropped = 0
        self.refused: dict[Why, int] = {}  # how many messages, by why
        self._lost, self._lost_known, self._lost_last = 0, True, -LOSS_SHOWN
        self._implausible, self._implausible_last = 0, -GLITCH_SHOWN
        self.refusal: Refusal | None = None  # why the last message was refused, if it was
        self.last: InputSample | None = None
        self._stamps: collections.deque[int] = collections.deque(maxlen=RATE_SAMPLES)
        self._lags: collections.deque[int] = collections.deque(maxlen=RATE_SAMPLES)
        self._long_gaps = 0  # in a row
        self._longest_gap = 0  # [ns] of those
        self._others: dict[OtherJoints, None] = {}  # since the last sample

    def accept(self, sample: InputSample) -> None:
        """Take a good sample."""
        self.received += 1
        self.refusal = None
        gap = 0 if self.last is None else sample.stamp - self.last.stamp
        self._long_gaps = self._long_gaps + 1 if gap > self.timeout else 0
        self._longest_gap = max(self._longest_gap, gap) if self._long_gaps else 0
        self._others.clear()
        self.last = sample
        self._stamps.append(sample.stamp)
        if sample.stamp_source is StampSource.HEADER and sample.arrival:
            self._lags.append(sample.arrival - sample.stamp)

    def drop(self, others: OtherJoints | None = None) -> None:
        """Count a message that is left out, with no harm to the input; `others` are its joints."""
        self.received += 1
        self.dropped += 1
        if others is not None:
            self.hear_of(others)

    def hear_of(self, others: OtherJoints) -> None:
        """Note other joints, of which a message that is counted already has told."""
        if len(self._others) < MOST_OTHERS:
            self._others[others] = None

    def refuse(self, refusal: Refusal) -> None:
        """Count a bad message; the input stays bad until the next good one."""
        self.drop()
        self.refused[refusal.why] = self.refused.get(refusal.why, 0) + 1
        self.refusal = refusal
        if refusal.why is Why.IMPLAUSIBLE:
            self._implausible += 1
            self._implausible_last = refusal.arrival

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
        self._others.clear()

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
            return self._absent
        if self.refusal is not None:
            return InputState.BAD
        if self.last is None:
            return InputState.MISSING
        return InputState.OK if now - self.last.arrival <= self.timeout else InputState.STALE

    def status(self, now: int) -> InputStatus:
        """Return the status at `now` [ns]."""
        last, lag, refusal = self.last, self.lag, self.refusal
        return InputStatus(
            source=self.source,
            state=self.state(now),
            rate=self._rate(),
            stamp_source=StampSource.UNKNOWN if last is None else last.stamp_source,
            age=math.nan if last is None else max(0.0, seconds(now - last.arrival)),
            received=self.received,
            dropped=self.dropped,
            slow=self.slow,
            longest_gap=seconds(self._longest_gap) if self.slow else math.nan,
            lag=lag,
            lagging=self.lagging,
            lost=self._lost if self._lost_known else None,
            losing=0 <= now - self._lost_last < LOSS_SHOWN,
            implausible=self._implausible,
            glitching=0 <= now - self._implausible_last < GLITCH_SHOWN,
            why=None if refusal is None else refusal.why,
            refusal='' if refusal is None else refusal.text,
            joints=self._joints(),
        )

    def _joints(self) -> OtherJoints | None:
        """Return the joints of all messages about others, of however many publishers."""
        if not self._others:
            return None
        names = sorted({name for others in self._others for name in others.names})
        return dataclasses.replace(next(iter(self._others)), names=tuple(names))

    def _rate(self) -> float:
        if len(self._stamps) < 2 or self._stamps[-1] <= self._stamps[0]:
            return math.nan
        return (len(self._stamps) - 1) / seconds(self._stamps[-1] - self._stamps[0])
