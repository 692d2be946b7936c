# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Decoding of serialised messages; one that does not decode is counted and named."""

from collections.abc import Sequence
import itertools
from typing import Any

from ballscrew_monitor.core.conversions import seconds
from ballscrew_monitor.core.fields import OtherJoints, TooShort
from ballscrew_monitor.core.inputs import Input, short_text
from ballscrew_monitor.messages.reasons import joint_reason, slow_reason
from ballscrew_monitor.recordings.bag import Bag, Message
from ballscrew_monitor.settings.axis import Axis
from ballscrew_monitor.settings.topics import absolute
from rclpy.serialization import deserialize_message

# What deserialising is known to raise; that of the middleware is a RuntimeError.
UNDECODABLE = (RuntimeError, ValueError, MemoryError, OverflowError)
SEEN = 100  # messages of a topic that tell what it holds


def decode(bag: Bag, message: Message, message_type: Any) -> tuple[Any, str]:
    """Return a decoded message, or None and why there is none; `bag` counts those."""
    decoded = _decoded(message, message_type)
    if decoded is not None:
        return decoded, ''
    reason = 'it is truncated, or of another type' if message.data else 'it is empty'
    return None, bag.refuse(message, reason)


def _decoded(message: Message, message_type: Any) -> Any:
    try:
        return deserialize_message(message.data, message_type) if message.data else None
    except UNDECODABLE:
        return None


def silence(bag: Bag, axis: Axis) -> str:
    """Return why nothing of `axis` could be judged of `bag`, as far as its messages tell."""
    reasons = [_fault(bag, axis, one) for one in axis.inputs]
    return '; '.join(filter(None, reasons))


def _fault(bag: Bag, axis: Axis, one: Input) -> str:
    """Return what is wrong with an input of an axis, nothing if it has samples often enough."""
    name = one.source.name.lower()
    parameter = f'{axis.name}.{name}'
    absent = _absence(bag, one)
    if isinstance(absent, OtherJoints):
        return joint_reason(absent, parameter)
    if absent is not None:
        return short_text(absent)
    gap = _usual_gap(bag, absolute(one.topic))
    if gap <= axis.monitor.settings.timeouts[one.source]:
        return ''
    return f'{name} {slow_reason(seconds(gap), parameter)}'


def _usual_gap(bag: Bag, topic: str) -> int:
    """Return the time between two messages of a topic [ns] that half of the first keep."""
    times = [message.log_time for message in itertools.islice(bag.messages([topic]), SEEN)]
    gaps = sorted(after - before for before, after in itertools.pairwise(times))
    return gaps[len(gaps) // 2] if gaps else 0


def named_instead(bag: Bag, one: Input) -> str:
    """Return which joints the messages of an input name instead of its own, if they do."""
    absent = _absence(bag, one)
    if not isinstance(absent, OtherJoints):
        return ''
    return f'; they name {", ".join(absent.names) or "no joints"} and no joint {absent.joint}'


def _absence(bag: Bag, one: Input) -> OtherJoints | TooShort | None:
    """Return what the first messages of the topic of an input hold, if not its field."""
    readings: list[OtherJoints | TooShort] = []
    for message in bag.messages([absolute(one.topic)]):
        decoded = _decoded(message, one.message_type)
        if decoded is not None:
            reading = one.read_field(decoded)
            if isinstance(reading, float):
                return None
            readings.append(reading)
        if len(readings) == SEEN:
            break
    return _joined(readings) if readings else None


def _joined(readings: Sequence[OtherJoints | TooShort]) -> OtherJoints | TooShort:
    """Return one absence for all: the joints of all messages, or the first array."""
    first = readings[0]
    others = [one for one in readings if isinstance(one, OtherJoints)]
    if not isinstance(first, OtherJoints):
        return first
    names = sorted({name for one in others for name in one.names})
    return OtherJoints(first.array, first.joint, tuple(names))
