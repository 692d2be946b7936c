# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Window statistics and totals."""

import math

from ballscrew_monitor.core.conversions import SECOND
from ballscrew_monitor.core.state import Extremes, Totals
from ballscrew_monitor.judge.records import LIGHT_LOAD, Memory, Row, STANDSTILL
from ballscrew_monitor.judge.sums import add_to_totals, add_to_window, clear_window
from ballscrew_monitor.judge.views import add_totals, clear_totals, totals_of, window_of
from hypothesis import given
from hypothesis import strategies as st
import pytest
from surrogate.units import TURN

GAP = SECOND // 2
BEGIN = 1000 * SECOND


def row(stamp=0, **changes):
    values = {'speed': 10.0, 'axial_load': -1000.0, 'rcs': 0.0, 'efficiency': 0.9, 'zone': 1}
    values |= {'validity': 1, 'film_ratio': 3.0, 'friction_torque': 0.125, 'regime': 3}
    return Row(**(values | {'stamp': BEGIN + stamp} | changes))


def add_up(*rows, memory=None):
    memory = memory or Memory()
    for one in rows:
        add_to_totals(memory, one, GAP)
    return totals_of(memory)


def test_a_window_holds_what_was_judged_until_it_was_told():
    memory = Memory()
    assert window_of(memory).count == 0
    assert math.isnan(window_of(memory).speed.low)
    for one in (row(speed=10.0, rcs=0.01), row(speed=-30.0, rcs=0.09), row(speed=20.0)):
        add_to_window(memory, one)
    add_to_window(memory, row(speed=0.2, zone=0, gates=STANDSTILL))
    clear_window(memory)
    found = window_of(memory)
    assert found.count == 3
    assert found.speed == Extremes(low=-30.0, mean=0.0, high=20.0)
    assert found.rcs.high == 0.09
    assert found.efficiency == Extremes(low=0.9, mean=pytest.approx(0.9), high=0.9)
    memory.window_told = True
    clear_window(memory)
    assert window_of(memory).count == 0
    assert math.isnan(window_of(memory).speed.low)


def test_efficiency_counts_only_where_it_was_judged():
    memory = Memory()
    add_to_window(memory, row(gates=LIGHT_LOAD, efficiency=0.01))
    found = window_of(memory)
    assert found.count == 1
    assert math.isnan(found.efficiency.mean)
    assert found.film_ratio.mean == 3.0


def test_each_sample_lasts_until_the_next():
    totals = add_up(
        row(speed=TURN, zone=2, regime=1), row(GAP, speed=-2.0 * TURN, regime=2), row(2 * GAP)
    )
    assert totals == Totals(
        running_time=2 * GAP,
        boundary_time=GAP,
        outside_time=GAP,
        mixed_time=GAP,
        optimal_time=GAP,
        angle=1.5 * TURN,
        energy_lost=pytest.approx(1.5 * TURN * 0.125),
        since=BEGIN,
    )
    assert totals.revolutions == 1.5


def test_what_adds_nothing_is_not_judged_or_is_reset():
    nothing = Totals(since=BEGIN)
    assert add_up(row(), row(GAP + 1)) == nothing
    assert add_up(row(speed=0.2, gates=STANDSTILL), row(GAP)) == nothing
    assert add_up(row(), row(-1)) == nothing
    totals = add_up(row(speed=150.0, validity=3, zone=0, regime=0), row(GAP))
    assert (totals.running_time, totals.unjudged_time) == (GAP, GAP)
    assert (totals.revolutions, totals.energy_lost) == (75.0 / TURN, 0.0)
    memory = Memory()
    add_up(row(), row(GAP), memory=memory)
    clear_totals(memory)
    assert totals_of(memory) == Totals()
    totals = add_up(row(2 * GAP), memory=memory)
    assert (totals.running_time, totals.since) == (GAP, BEGIN + 2 * GAP)


streams = st.lists(
    st.builds(
        lambda step, zone, regime, **values: (
            step,
            {'zone': zone, 'regime': regime if zone else 0, **values},
        ),
        st.integers(0, 2 * GAP),
        st.integers(0, 2),
        st.integers(1, 3),
        speed=st.floats(-200.0, 200.0),
        friction_torque=st.floats(0.0, 5.0) | st.just(math.nan),
        gates=st.sampled_from([0, 0, 0, STANDSTILL, LIGHT_LOAD]),
    ),
    min_size=1,
    max_size=30,
)


@given(streams, st.data())
def test_parts_add_up_exactly_and_are_kept_bit_for_bit(stream, data):
    """Another memory takes the sums over between any two samples."""
    memory, other, stamp = Memory(), Memory(), 0
    cut = data.draw(st.integers(0, len(stream) - 1))
    for number, (step, changes) in enumerate(stream):
        stamp += step
        for one in (memory, other):
            add_to_totals(one, row(stamp, **changes), GAP)
        if number == cut:
            kept, other = totals_of(other), Memory()
            add_totals(other, kept)
            assert totals_of(other) == kept
            memory.moment = False  # as a restart does
    totals = totals_of(memory)
    assert totals_of(other) == totals
    judged = totals.running_time - totals.unjudged_time
    assert judged == totals.optimal_time + totals.outside_time
    assert judged == totals.boundary_time + totals.mixed_time + totals.hydrodynamic_time
    assert 0 <= totals.running_time <= stamp
