# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""A node that judges no longer ends the event that is active, and says why."""

import types

from ballscrew_monitor.node.axis_publisher import AxisPublisher, end_all, MOST_LEAPS
import pytest
import rclpy.clock
from rclpy.duration import Duration

SLOW = 0.8  # [rad/s] outside the zone at 1 kN and 40 degC


@pytest.fixture
def outside(node):
    """Start the node and leave the zone; return the node and what it says of events."""
    node.start(x__max_future=3600.0, x__limits__raise_delay=0.0)
    heard = node.events()
    publish = node.machine()
    publish(SLOW)
    node.until(lambda: heard and heard[-1].active, 'the event')
    return node, heard


def last_word(node, heard):
    node.until(lambda: not heard[-1].active, 'the end of the event')
    assert (heard[-1].event_id, heard[-1].cause.text) == (1, heard[-2].cause.text)
    return heard[-1].advice


def test_on_cleanup(outside, says):
    node, heard = outside
    assert node.transition('deactivate')
    assert node.transition('cleanup')
    advice = last_word(node, heard)
    assert advice == says('ended_by_node')
    assert advice in node.output.read_text()
    late = node.events()
    node.until(lambda: late, 'the last word for one who comes late')
    assert (late[0].active, late[0].advice) == (False, advice)
    assert node.transition('configure')
    assert node.transition('activate')
    node.until(lambda: heard[-1].event_id == 0, 'that there has been no event yet')


def test_on_the_way_out(outside):
    node, heard = outside
    assert node.stop() == 0
    assert last_word(node, heard).endswith('nothing is judged any more: shut down')


def test_all_axes_speak_before_any_waits_and_share_one_time():
    clock = rclpy.clock.ROSClock()
    stand, said = [clock.now()], []

    def end(reason):
        said.append(reason)
        return reason != 'nothing to end'

    def wait(duration):
        said.append(duration.nanoseconds)
        stand[0] += Duration(nanoseconds=min(duration.nanoseconds, 200_000_000))

    alarm = types.SimpleNamespace(end=end, wait=wait)
    axis = types.SimpleNamespace(alarm=alarm, guarded=lambda place, call, reason: call(reason))
    standing = types.SimpleNamespace(now=lambda: stand[0])
    end_all([axis] * 4, 'why', standing)
    assert said == [*['why'] * 4, 500_000_000, 300_000_000, 100_000_000, 0]
    end_all([axis], 'nothing to end', standing)
    assert said[8:] == ['nothing to end']


def test_of_two_clocks_that_take_turns_the_first_leaps_in_a_warning_are_noted():
    memory = types.SimpleNamespace(event_number=1)
    axis = types.SimpleNamespace(monitor=types.SimpleNamespace(memory=memory))
    publisher = types.SimpleNamespace(axis=axis, _leaps=(0, 0))
    for number in (1, 2):
        memory.event_number = number
        noted = [AxisPublisher.may_note_leap(publisher) for _ in range(3 * MOST_LEAPS)]
        assert noted == [True] * MOST_LEAPS + [False] * (2 * MOST_LEAPS)
