# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""A topic: its queue while publishers come and go."""

import contextlib
import types

from ballscrew_monitor.node.sources import LossCounter
from ballscrew_monitor.node.topic import _count, Topic
import pytest
from sensor_msgs.msg import JointState
from std_msgs.msg import Float64


@pytest.mark.parametrize(('before', 'after'), [(2, 1), (1, 0), (0, 1), (1, 2)])
def test_what_waits_while_the_publishers_change_has_no_number(before, after):
    """The numbers of a publisher that left and of the one that stays show no loss."""
    queue = []
    handle = contextlib.nullcontext()
    handle.take_message = lambda kind, raw: queue.pop(0) if queue else None
    subscription = types.SimpleNamespace(
        handle=handle, msg_type=Float64, raw=False, get_publisher_count=lambda: after
    )
    topic = Topic(name='/a', readers=[], loss=LossCounter(), subscription=subscription)
    topic.loss.match(before)

    def losses(*numbers):
        queue.extend(
            (None, {'received_timestamp': 1, 'publication_sequence_number': number})
            for number in numbers
        )
        return [topic.loss.take(arrival.number) for arrival in topic.waiting()]

    assert losses() == []
    assert topic.loss.publishers == before  # until there is a message to count
    assert losses(3, 41) == [None, None]
    assert losses(42, 44) == ([None, None] if after > 1 else [0, 1])


@pytest.mark.parametrize(('current', 'total', 'lost'), [(1, 1, 520), (1, 2, 0), (2, 2, None)])
def test_the_first_publisher_of_all_is_no_change_however_late_it_is_told(current, total, lost):
    counter = LossCounter()
    assert counter.take(2) == 0
    _count(counter, types.SimpleNamespace(current_count=current, total_count=total))
    assert counter.take(523) == lost


def test_bytes_that_do_not_decode_are_a_message_that_is_none():
    """A publisher with another definition of the type must not end the node."""
    subscription = types.SimpleNamespace(msg_type=JointState, raw=True)
    topic = Topic(name='/a', readers=[], loss=LossCounter(), subscription=subscription)
    info = {'received_timestamp': 1, 'publication_sequence_number': 1}
    garbage = b'\0\1\0\0' + b'\xff' * 12
    found = topic.arrival(garbage, info)
    assert (found.message, found.data) == (None, garbage)
