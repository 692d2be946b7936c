# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Samples in the machine frame out of messages, or why a message gives no sample.

The status of an input tells what was received, what is wrong with it, and how fresh it is.

"""

from collections.abc import Sequence
import dataclasses
import enum
import math
from typing import Any, TypeVar

from ballscrew_monitor.core import fields
from ballscrew_monitor.core.conversions import Scaling, SECOND, seconds
from ballscrew_monitor.core.fault_codes import Fault
from ballscrew_monitor.core.fields import FieldReader, MessageClass, OtherJoints, TooShort

Axis = TypeVar('Axis')
UNSTATED = -1
YEAR = 31_536_000 * SECOND
"""Stamps that far from the clock are those of another kind of clock [ns]."""


class Source(enum.IntEnum):
    """What an input measures; samples of equal stamp are taken in this order, speed last."""

    TEMPERATURE = 0
    LOAD = 1
    TORQUE = 2
    SPEED = 3


_UNITS = {Source.SPEED: 'rad/s', Source.LOAD: 'N'}


class StampSource(enum.IntEnum):
    """Where a stamp comes from; the numbers of InputHealth.STAMP_."""

    UNKNOWN = 0
    HEADER = 1
    RECEIVE = 2


class Why(enum.IntEnum):
    """Why a message gave no sample."""

    OTHER_JOINTS = 0  # the message speaks of other joints: dropped, and nothing is wrong
    NOT_A_NUMBER = 1
    FUTURE = 2
    OTHER_CLOCK = 3  # stamps more than a year ahead: of another clock
    TOO_SHORT = 4  # the array of the field is empty, or ends before the element
    IMPLAUSIBLE = 5  # beyond what the machine can do: a glitch, or another unit
    NOT_DECODED = 6  # truncated, or of another definition of its type
    HOLE = 7  # no speed follows from a position and one long before it
    NEGATIVE = 8  # a stamp below zero, which no clock shows
    SEVERAL = 9  # several publishers send the input, and one is allowed

    @property
    def fault(self) -> Fault:
        """Return what is wrong with the input."""
        return Fault[f'INPUT_{self.name}']


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
    """
    A message that gave no sample, and why; see `InputSample`.

    `first` and `second` are the numbers of its sentence, see `refusal_text`; `joints` are those
    that a message about other joints names.

    """

    source: Source
    why: Why
    first: float = math.nan
    second: float = math.nan
    joints: OtherJoints | None = None
    arrival: int = 0
    lost: int | None = 0


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class InputStatus:
    """
    State of one input at one instant.

    age since the arrival [s], rate [Hz] and lag [s], by how much the stamps lie behind the arrival
    at least, are NaN while unknown; an input is `lagging` from a stated lag on; a `slow` one is
    stale between its samples, and a timeout of `longest_gap` [s] would do, NaN for any other.
    `lost` messages never arrived, None: not known; `losing` since not long ago.
    `implausible` samples were refused. `refusing` is why messages were refused not long ago, and
    `refused_share` [-] how many of the latest were. `refusal` is why the last message was refused,
    while it is the last; `joints` are what messages about other joints have named since the last
    sample.

    """

    source: Source
    state: InputState
    stamp_source: StampSource = StampSource.UNKNOWN
    age: float = math.nan
    rate: float = math.nan
    received: int = 0
    dropped: int = 0
    slow: bool = False
    lag: float = math.nan
    lagging: bool = False
    lost: int | None = 0
    losing: bool = False
    implausible: int = 0
    refusing: tuple[Why, ...] = ()
    refused_share: float = 0.0
    longest_gap: float = math.nan
    why: Why | None = None
    refusal: str = ''
    joints: OtherJoints | None = None

    @property
    def glitching(self) -> bool:
        """Return True if implausible samples were refused not long ago."""
        return Why.IMPLAUSIBLE in self.refusing


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class Input:
    """One configured input: where it comes from and how it is read."""

    source: Source
    topic: str
    field: str
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

        A message that did not decode is None.

        A stamp more than `max_future` [ns] ahead of `now` is refused, unless `now` is zero: then
        the clock has not started and cannot say. A zero stamp means that there is none, and a
        negative one is refused.

        """
        if message is None:
            return self._refused(Why.NOT_DECODED, now, lost)
        value = self.read_field(message)
        if isinstance(value, OtherJoints):
            return self._refused(Why.OTHER_JOINTS, now, lost, joints=value)
        if isinstance(value, TooShort):
            place = fields.arrays_of(self.field).index((value.array, value.key))
            length = float(value.length)
            return self._refused(Why.TOO_SHORT, now, lost, first=length, second=float(place))
        stamp = fields.stamp_of(message) if self.stamped else 0
        return self.sample(value, stamp, now=now, max_future=max_future, lost=lost)

    def sample(
        self, value: float, stamp: int, *, now: int, max_future: int, lost: int | None = 0
    ) -> InputSample | Refusal:
        """Return the sample of a number in a message of a `stamp` [ns]; see `read`."""
        if stamp < 0:
            return self._refused(Why.NEGATIVE, now, lost)
        if now and stamp - now > max_future:
            why = Why.OTHER_CLOCK if stamp - now > YEAR else Why.FUTURE
            ahead, allowed = seconds(stamp - now), seconds(max_future)
            return self._refused(why, now, lost, first=ahead, second=allowed)
        si_value = self.scaling(value)
        if not math.isfinite(si_value):
            return self._refused(Why.NOT_A_NUMBER, now, lost, first=value)
        return InputSample(
            source=self.source,
            value=si_value,
            stamp=stamp or now,
            stamp_source=StampSource.HEADER if stamp else StampSource.RECEIVE,
            # A clock that has not started times nothing: the stamp is all there is.
            arrival=now or stamp,
            lost=lost,
        )

    def _refused(self, why: Why, now: int, lost: int | None, **rest: Any) -> Refusal:
        return Refusal(source=self.source, why=why, arrival=now, lost=lost, **rest)


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class OpenInput:
    """A configured input whose message type is that of the publisher on its topic."""

    source: Source
    topic: str
    field: str
    scaling: Scaling

    def close(self, type_name: str) -> Input:
        """Return the input for messages of a type; raises InputError when it cannot work."""
        message_type = fields.message_class(type_name)
        known = message_type.get_fields_and_field_types()
        return Input(
            source=self.source,
            topic=self.topic,
            field=self.field,
            type_name=type_name,
            message_type=message_type,
            read_field=fields.compile_field(self.field, message_type),
            scaling=self.scaling,
            stamped=known.get('header') == 'std_msgs/Header',
        )


def of_several(source: Source, arrival: int, lost: int | None = 0) -> Refusal:
    """Return the refusal of a sample that one of several publishers has sent; see `Refusal`."""
    return Refusal(source=source, why=Why.SEVERAL, arrival=arrival, lost=lost)


def refusal_text(
    source: Source, why: Why, first: float, second: float, *, most: float, field: str
) -> str:
    """
    Return why a message of an input was refused, and the cure; `most` [SI] is plausible.

    The numbers are: the value, of a jump the change [rad] and the time [s] that it takes, of a
    hole its length [s], of a stamp ahead of the clock by how much and what is allowed [s], of an
    array in the path `field` its length and which of these arrays it is.

    """
    name, unit = source.name.lower(), _UNITS.get(source, '')
    if why is Why.IMPLAUSIBLE and not math.isnan(second):
        return (
            f'the position jumps by {first:.4g} rad of the screw within {second:.3g} s, '
            f'plausible is a speed of {most:.4g} rad/s: mend the source, or set speed.wrap to the '
            'position at which it starts over'
        )
    if why is Why.TOO_SHORT:
        arrays = fields.arrays_of(field)
        known = second in range(len(arrays)) and first >= 0.0
        return short_text(TooShort(*arrays[int(second)], int(first))) if known else ''
    if why is Why.IMPLAUSIBLE and not unit:
        return ''
    return why.fault.detail.format(first=first, second=second, most=most, name=name, unit=unit)


def short_text(short: TooShort) -> str:
    """Return why an array gives no number, and the cure."""
    holds = f'has {short.length} elements and no [{short.key}]' if short.length else 'is empty'
    return f'{short.array} {holds} in its messages: let the source fill it, or read another field'


def ordered(
    events: Sequence[tuple[Axis, InputSample | Refusal]],
) -> list[tuple[Axis, InputSample | Refusal]]:
    """
    Return events, each with its axis, in the order in which they came.

    Those of equal stamps follow their sources: the speed is the last of them, so that it is judged
    with what was measured with it.

    """
    first: dict[int, int] = {}
    keys = []
    for place, (_, event) in enumerate(events):
        stamp = event.arrival if isinstance(event, Refusal) else event.stamp
        keys.append((first.setdefault(stamp, place), event.source, place))
    return [events[place] for _, _, place in sorted(keys)]
