# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Window statistics and totals."""

import math

from ballscrew_monitor.core.conversions import SECOND
from ballscrew_monitor.core.estimate import estimate
from ballscrew_monitor.core.judgement import judge
from ballscrew_monitor.core.tally import Account, Extremes, moment, Totals, WindowTally
from hypothesis import given
from hypothesis import strategies as st
import pytest
from surrogate.units import TURN

GAP = SECOND // 2
BEGIN = 1000 * SECOND


def seen(core, point, **numbers):
    result = estimate(point, core.surface(**numbers), rcs_limit=0.25)
    return point, result, judge(point, result, core.limits())


def test_an_empty_window_has_no_numbers():
    taken = WindowTally().take()
    assert taken.count == 0
    assert math.isnan(taken.speed.low)


def test_a_window_holds_what_was_judged_and_is_emptied_when_taken(core):
    window = WindowTally()
    for speed in (10.0, -30.0, 20.0):
        window.add(*seen(core, core.point(speed=speed), rcs=speed**2 / 1e4))
    window.add(*seen(core, core.point(speed=0.2)))
    window.add(*seen(core, core.point(speed=1e3)))
    taken = window.take()
    assert taken.count == 3
    assert taken.speed == Extremes(low=-30.0, mean=0.0, high=20.0)
    assert taken.rcs.high == 0.09
    assert taken.efficiency == Extremes(low=0.9, mean=pytest.approx(0.9), high=0.9)
    assert window.take().count == 0


def test_efficiency_counts_only_where_it_was_judged(core):
    window = WindowTally()
    window.add(*seen(core, core.point(axial_load=10.0), efficiency=0.01))
    taken = window.take()
    assert taken.count == 1
    assert math.isnan(taken.efficiency.mean)
    assert taken.film_ratio.mean == 3.0


def add_up(core, stream):
    account = Account()
    for stamp, point, numbers in stream:
        account.add(moment(BEGIN + stamp, *seen(core, point, **numbers)), max_gap=GAP)
    return account.totals()


def test_each_sample_lasts_until_the_next(core):
    totals = add_up(
        core,
        [
            (0, core.point(speed=TURN), {'rcs': 0.5, 'film_ratio': 0.5}),
            (GAP, core.point(speed=-2.0 * TURN), {'film_ratio': 2.0}),
            (2 * GAP, core.point(speed=5.0), {}),
        ],
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


def test_a_gap_and_a_standstill_add_nothing(core):
    nothing = Totals(since=BEGIN)
    assert add_up(core, [(0, core.point(), {}), (GAP + 1, core.point(), {})]) == nothing
    assert add_up(core, [(0, core.point(speed=0.2), {}), (GAP, core.point(), {})]) == nothing


def test_motion_that_is_not_judged_is_counted_as_such(core):
    totals = add_up(core, [(0, core.point(speed=150.0), {}), (GAP, core.point(), {})])
    assert (totals.running_time, totals.unjudged_time) == (GAP, GAP)
    assert totals.revolutions == 75.0 / TURN
    assert totals.energy_lost == 0.0


speeds = st.floats(-200.0, 200.0)
steps = st.integers(0, 2 * GAP)


@given(st.lists(st.tuples(steps, speeds, st.floats(0.0, 1.0), st.floats(0.0, 5.0)), max_size=30))
def test_the_parts_add_up_exactly(core, stream):
    stamp, events = 0, []
    for step, speed, rcs, film_ratio in stream:
        stamp += step
        events.append((stamp, core.point(speed=speed), {'rcs': rcs, 'film_ratio': film_ratio}))
    totals = add_up(core, events)
    judged = totals.running_time - totals.unjudged_time
    assert judged == totals.optimal_time + totals.outside_time
    assert judged == totals.boundary_time + totals.mixed_time + totals.hydrodynamic_time
    assert 0 <= totals.running_time <= stamp


def test_a_reset_begins_at_zero_and_loses_no_time(core):
    account = Account()
    account.add(moment(0, *seen(core, core.point())), max_gap=GAP)
    account.add(moment(GAP, *seen(core, core.point())), max_gap=GAP)
    account.reset()
    assert account.totals() == Totals()
    account.add(moment(2 * GAP, *seen(core, core.point())), max_gap=GAP)
    assert (account.totals().running_time, account.totals().since) == (GAP, 2 * GAP)


@given(st.lists(st.tuples(st.integers(0, GAP), speeds), min_size=2, max_size=20), st.data())
def test_sums_that_are_kept_and_taken_up_are_the_same_bit_for_bit(core, stream, data):
    """Taken over by another account between any two samples."""
    account, other, stamp = Account(), Account(), BEGIN
    cut = data.draw(st.integers(0, len(stream) - 1))
    for number, (step, speed) in enumerate(stream):
        stamp += step
        for one in (account, other):
            one.add(moment(stamp, *seen(core, core.point(speed=speed))), max_gap=GAP)
        if number == cut:
            kept, other = other.totals(), Account()
            other.take_up(kept)
            assert other.totals() == kept == account.totals()
            account.forget()
    assert other.totals() == account.totals()


def test_the_beginning_moves_with_the_clock(core):
    account = Account()
    account.move(-GAP)
    assert account.totals().since == 0
    account.add(moment(3 * GAP, *seen(core, core.point())), max_gap=GAP)
    account.move(-GAP)
    assert account.totals().since == 2 * GAP
