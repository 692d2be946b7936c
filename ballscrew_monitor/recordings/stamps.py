# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Serialised messages made later: every stamp in them, wherever it stands."""

from collections.abc import Iterator
from typing import Any

from ballscrew_monitor.core.conversions import SECOND
from builtin_interfaces.msg import Time
from rclpy.serialization import deserialize_message, serialize_message

LAST = 2**31 * SECOND  # [ns] first stamp that a message cannot hold


def shifted(data: bytes, message_type: Any, by: int) -> bytes:
    """
    Return a serialised message whose stamps are later `by` [ns].

    A stamp of 0 is none, and stays.

    """
    message = deserialize_message(data, message_type)
    for time in _times(message):
        stamp = time.sec * SECOND + time.nanosec
        if stamp and stamp + by < LAST:
            time.sec, time.nanosec = divmod(stamp + by, SECOND)
    return bytes(serialize_message(message))


def _times(part: Any) -> Iterator[Time]:
    """Yield every time in a message, in a list of them, or in anything else, which holds none."""
    if isinstance(part, Time):
        yield part
    elif isinstance(part, list):
        for one in part:
            yield from _times(one)
    elif hasattr(part, 'get_fields_and_field_types'):
        for name in part.get_fields_and_field_types():
            yield from _times(getattr(part, name))
