# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The words for what was lost."""

from ballscrew_monitor.outcome import losses
from ballscrew_msgs.msg import BallScrewState, InputHealth


def last_state(*, received, judged):
    """Return the last state of an axis."""
    return BallScrewState(judged=judged, inputs=[InputHealth(name='speed', received=received)])


def test_nothing_lost_is_nothing_said():
    assert losses({'x': last_state(received=10, judged=10)}, {'x': 10}, rate=1.0) == []


def test_it_says_what_did_not_arrive_and_what_was_left_out():
    states = {'x': last_state(received=9, judged=7)}
    assert losses(states, {'x': 10}, rate=1.0) == [
        'axis x: 7 of 10 speed messages were judged; 1 did not reach the node, which left out 2'
    ]


def test_a_fast_run_is_told_why():
    [sentence] = losses({'x': last_state(received=9, judged=9)}, {'x': 10}, rate=20.0)
    assert sentence.endswith('left out 0; at 20x messages may be lost, a lower rate helps')


def test_a_silent_axis_has_lost_everything():
    [sentence] = losses({}, {'y': 3}, rate=1.0)
    assert sentence.startswith('axis y: 0 of 3 speed messages were judged; 3 did not reach')
