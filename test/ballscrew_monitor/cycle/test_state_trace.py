# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""States as columns."""

from ballscrew_monitor.cycle.state_trace import Tracer
from ballscrew_msgs.msg import BallScrewState, OperatingPoint
import numpy as np


def make_trace(*gates, speed=-20.0, direction=OperatingPoint.DIRECTION_NEGATIVE):
    """Return the columns of states that move back against a load, gated as asked."""
    tracer = Tracer()
    for number, shut in enumerate(gates):
        state = BallScrewState(axis='x', active_gates=shut, zone=number, level=1)
        state.header.stamp.sec = 50 + number
        state.point.speed, state.point.axial_load = speed, 500.0
        state.point.direction = direction
        state.result.efficiency, state.result.rcs, state.result.film_ratio = 0.9, 0.1, 2.0
        state.rcs_limit = 0.01
        tracer.add_state(state)
    return tracer.result()


def test_times_begin_at_zero_and_the_load_is_seen_from_the_motion():
    trace = make_trace([], [])
    assert trace.time.tolist() == [0.0, 1.0]
    assert trace.opposing_load.tolist() == [500.0, 500.0]
    assert (trace.zone.tolist(), trace.limits.rcs) == ([0.0, 1.0], 0.01)


def test_at_standstill_the_direction_is_the_last_one():
    # The noise of a speed sensor says nothing.
    assert make_trace([], speed=0.01).opposing_load.tolist() == [500.0]
    ahead = make_trace([], speed=-0.01, direction=OperatingPoint.DIRECTION_POSITIVE)
    assert ahead.opposing_load.tolist() == [-500.0]


def test_before_the_first_motion_no_load_opposes_it():
    trace = make_trace([], speed=0.01, direction=OperatingPoint.DIRECTION_UNKNOWN)
    np.testing.assert_array_equal(trace.opposing_load, [np.nan])


def test_what_is_gated_is_not_shown():
    standstill, light = BallScrewState.GATE_STANDSTILL, BallScrewState.GATE_LIGHT_LOAD
    trace = make_trace([], [light], [standstill])
    np.testing.assert_array_equal(trace.efficiency, [0.9, np.nan, np.nan])
    np.testing.assert_array_equal(trace.rcs, [0.1, 0.1, np.nan])
    np.testing.assert_array_equal(trace.film_ratio, [2.0, 2.0, np.nan])


def test_without_a_state_there_is_none():
    assert Tracer().result() is None
