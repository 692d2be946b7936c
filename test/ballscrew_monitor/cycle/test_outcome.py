# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The words for what was lost."""

from collections import Counter
from pathlib import Path

from ballscrew_monitor.cycle.outcome import loss, Outcome, unjudged
from ballscrew_msgs.msg import BallScrewState, InputHealth, PointResult


def make_outcome(**states):
    """Return the outcome of a run with the last states by axis."""
    return Outcome(
        recording=Path('cycle.mcap'),
        sent=Counter(),
        recorded=1,
        states=states,
        lateness=0.0,
        cpu_time=1.0,
        failures=(),
    )


def last_state(*, received, judged, dropped=0):
    """Return the last state of an axis."""
    health = InputHealth(name='speed', received=received, dropped=dropped)
    return BallScrewState(judged=judged, inputs=[health])


def words(state, *, sent=10, expected=10, reasons=None, rate=1.0):
    """Return the sentence on axis x."""
    return loss(
        make_outcome(x=state), 'x', sent=sent, expected=expected, unjudged=reasons or {}, rate=rate
    )


def test_nothing_lost_is_nothing_said():
    assert words(last_state(received=10, judged=10)) == ''
    assert words(last_state(received=12, judged=10, dropped=2), sent=12) == ''


def test_it_says_what_did_not_arrive_what_was_refused_and_what_had_no_verdict():
    state = last_state(received=9, judged=3, dropped=1)
    reasons = {'no valid sample of load': 3, 'speed above the surface': 2}
    assert words(state, reasons=reasons) == (
        'axis x: 3 of 10 speed messages were judged; 1 did not reach the node, the node refused '
        '1, 3 had no verdict (no valid sample of load), 2 had no verdict (speed above the surface)'
    )


def test_messages_of_other_joints_are_not_called_refused():
    state = last_state(received=12, judged=9, dropped=2)
    assert words(state, sent=12, reasons={'load outside the surface': 1}) == (
        'axis x: 9 of 10 speed messages were judged; 1 had no verdict (load outside the surface)'
    )


def test_a_fast_run_is_told_why_messages_were_lost():
    assert words(last_state(received=9, judged=9), rate=20.0).endswith(
        '1 did not reach the node; at 20x messages may be lost, a lower rate helps'
    )
    assert 'lower rate' not in words(last_state(received=10, judged=9), rate=20.0)


def test_a_silent_axis_has_lost_everything():
    sentence = loss(make_outcome(), 'y', sent=3, expected=3, unjudged={}, rate=1.0)
    assert sentence == 'axis y: 0 of 3 speed messages were judged; 3 did not reach the node'


def recorded(zone, validity, reason='', *, gates=(), speed=InputHealth.STATE_OK):
    """Return a recorded state."""
    health = InputHealth(name='speed', state=speed)
    state = BallScrewState(zone=zone, active_gates=list(gates), inputs=[health])
    state.result.validity, state.result.reason = validity, reason
    return state


def test_only_speed_samples_without_a_verdict_are_counted_and_grouped_by_reason():
    unknown, optimal = BallScrewState.ZONE_UNKNOWN, BallScrewState.ZONE_OPTIMAL
    no_input, masked = PointResult.VALIDITY_NO_INPUT, PointResult.VALIDITY_MASKED
    hot = PointResult.VALIDITY_TEMPERATURE_OUT_OF_RANGE
    states = [
        recorded(optimal, PointResult.VALIDITY_VALID),
        recorded(unknown, no_input, 'no load', gates=[BallScrewState.GATE_STANDSTILL]),
        recorded(unknown, no_input, 'no speed', speed=InputHealth.STATE_STALE),
        recorded(unknown, no_input, 'no load', gates=[BallScrewState.GATE_LIGHT_LOAD]),
        recorded(unknown, masked, 'no convergence'),
        recorded(unknown, hot, '90 degC is too hot'),
        recorded(unknown, hot, '91 degC is too hot'),
    ]
    assert unjudged(states) == {
        'no load': 1,
        'no convergence': 1,
        'oil temperature outside the surface': 2,
    }
