# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
From any numeric field of any topic to samples in the machine frame, and the health of each input.

A field path names attributes, with an index for an array: `data`, `wrench.force.x`, `position[0]`,
or the name of a joint, `velocity[x_axis]`, looked up in the `name` field beside the array. A path
is checked against the message type when it is compiled.

"""

import collections
import dataclasses
import enum
import importlib
import math
import re
from typing import Any, Callable

from ballscrew_monitor.conversions import Scaling, SECOND, seconds
from ballscrew_monitor.errors import InputError

RATE_SAMPLES = 20  # samples over which the rate is averaged
_SEGMENT = re.compile(r'([A-Za-z]\w*)(?:\[([^\[\]]+)\])?')
_ARRAY = re.compile(r'(?:sequence<(?P<sequence>.+?)(?:, \d+)?>|(?P<array>.+)\[\d+\])')
_NUMBERS = frozenset(
    ['float', 'double', 'octet', 'byte', 'char', 'long double']
    + [f'{sign}int{bits}' for sign in ('', 'u') for bits in (8, 16, 32, 64)])

Step = Callable[[Any], Any]


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
class Sample:
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


def message_class(type_name: str) -> Any:
    """Return the class of a message type such as `sensor_msgs/msg/JointState`."""
    parts = type_name.split('/')
    if len(parts) != 3 or parts[1] != 'msg' or not all(parts):
        raise InputError(f'message type {type_name!r} is not of the form package/msg/Name')
    try:
        return getattr(importlib.import_module(f'{parts[0]}.msg'), parts[2])
    except (ImportError, AttributeError):
        raise InputError(f'message type {type_name!r} is not installed') from None


def compile_field(path: str, message_type: Any) -> Callable[[Any], float | None]:
    """
    Return the function that reads the field `path` of a message of class `message_type`.

    It returns None when the message does not hold the named joint, and NaN when the array is too
    short. Raises InputError when the path does not lead to a number.

    """
    steps: list[Step] = []
    kind = message_type
    for segment in path.split('.'):
        if isinstance(kind, str):
            raise InputError(f'field {path!r}: {segment!r} is asked of a {kind}')
        new_steps, kind = _compile_segment(path, segment, kind)
        steps += new_steps
    if not isinstance(kind, str) or kind not in _NUMBERS:
        raise InputError(f'field {path!r} of {_name(message_type)} is {_name(kind)}, not a number')
    return _chain(steps)


def _compile_segment(path: str, segment: str, kind: Any) -> tuple[list[Step], Any]:
    match = _SEGMENT.fullmatch(segment)
    if match is None:
        raise InputError(f'field {path!r}: {segment!r} is not a name or name[index]')
    name, key = match.groups()
    fields = kind.get_fields_and_field_types()
    if name not in fields:
        raise InputError(f'field {path!r}: {_name(kind)} has no field {name!r}, '
                         f'it has {", ".join(fields)}')
    array = _ARRAY.fullmatch(fields[name])
    if key is None:
        return [_attribute(name)], _resolve(fields[name])
    if array is None:
        raise InputError(f'field {path!r}: {name!r} of {_name(kind)} is {fields[name]}, no array')
    element = _resolve(array['sequence'] or array['array'])
    if key.isdecimal():
        return [_attribute(name), _item(int(key))], element
    if fields.get('name') != 'sequence<string>':
        raise InputError(f'field {path!r}: {_name(kind)} has no list of names to find {key!r} in')
    return [_named_item(name, key)], element


def _resolve(field_type: str) -> Any:
    """Return the class of a nested message; any other type as its text."""
    package, slash, name = field_type.partition('/')
    if not slash or _ARRAY.fullmatch(field_type):
        return field_type
    return message_class(f'{package}/msg/{name}')


def _name(kind: Any) -> str:
    return kind if isinstance(kind, str) else kind.__name__


def _attribute(name: str) -> Step:
    return lambda message: getattr(message, name)


def _item(index: int) -> Step:
    return lambda array: array[index]


def _named_item(name: str, key: str) -> Step:
    def step(message: Any) -> Any:
        try:
            index = message.name.index(key)
        except ValueError:
            return None
        return getattr(message, name)[index]
    return step


def _chain(steps: list[Step]) -> Callable[[Any], float | None]:
    def read(message: Any) -> float | None:
        value = message
        try:
            for step in steps:
                value = step(value)
                if value is None:
                    return None
        except IndexError:
            return math.nan
        return float(value)
    return read


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class Input:
    """One configured input: where it comes from and how it is read."""

    source: Source
    topic: str
    type_name: str
    message_type: Any
    read_field: Callable[[Any], float | None]
    scaling: Scaling
    stamped: bool

    def read(self, message: Any, *, now: int, max_future: int) -> Sample | Refusal:
        """
        Return the sample in `message`, received at `now` [ns].

        A stamp more than `max_future` [ns] ahead of `now` is refused, unless `now` is zero: then
        the clock has not started and cannot say. A zero stamp means that there is none.

        """
        value = self.read_field(message)
        if value is None:
            return Refusal(source=self.source, why=Why.OTHER_JOINTS)
        stamp = _stamp(message) if self.stamped else 0
        if now and stamp - now > max_future:
            return Refusal(source=self.source, why=Why.FUTURE)
        si_value = self.scaling(value)
        if not math.isfinite(si_value):
            return Refusal(source=self.source, why=Why.NOT_A_NUMBER)
        return Sample(source=self.source, value=si_value, stamp=stamp or now,
                      stamp_source=StampSource.HEADER if stamp else StampSource.RECEIVE)


def make_input(source: Source, *, topic: str, type_name: str, field: str,
               scaling: Scaling) -> Input:
    """Return a checked input; raises InputError with the reason when it cannot work."""
    message_type = message_class(type_name)
    fields = message_type.get_fields_and_field_types()
    return Input(source=source, topic=topic, type_name=type_name, message_type=message_type,
                 read_field=compile_field(field, message_type), scaling=scaling,
                 stamped=fields.get('header') == 'std_msgs/Header')


def _stamp(message: Any) -> int:
    stamp = message.header.stamp
    return stamp.sec * SECOND + stamp.nanosec


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class Health:
    """State of one input at one instant; age [s], rate [Hz], both NaN while unknown."""

    source: Source
    state: InputState
    stamp_source: StampSource
    age: float
    rate: float
    received: int
    dropped: int


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
        self.last: Sample | None = None
        self._stamps: collections.deque[int] = collections.deque(maxlen=RATE_SAMPLES)

    def accept(self, sample: Sample) -> None:
        """Take a good sample."""
        self.received += 1
        self.refused = False
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
            source=self.source, state=self.state(now), rate=self._rate(),
            stamp_source=StampSource.UNKNOWN if last is None else last.stamp_source,
            age=math.nan if last is None else max(0.0, seconds(now - last.stamp)),
            received=self.received, dropped=self.dropped)

    def _rate(self) -> float:
        if len(self._stamps) < 2 or self._stamps[-1] <= self._stamps[0]:
            return math.nan
        return (len(self._stamps) - 1) / seconds(self._stamps[-1] - self._stamps[0])
