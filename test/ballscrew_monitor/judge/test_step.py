# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The monitor as a function of an ordered list of events."""

import dataclasses
import math

from ballscrew_monitor.core.conversions import Direction, SECOND
from ballscrew_monitor.core.estimate import PointSource, PointValidity
from ballscrew_monitor.core.input_status import InputState
from ballscrew_monitor.core.inputs import InputSample, Refusal, Source, Why
from ballscrew_monitor.core.judgement import Code, Gate, Level, Zone
from ballscrew_monitor.core.monitor import BACKWARD_JUMP, Monitor
from ballscrew_monitor.core.state import Event
from hypothesis import given
from hypothesis import strategies as st
import pytest

STEP = SECOND // 100
TIMEOUT = SECOND // 2
START = 1000 * SECOND
TICK = 'tick'


def speed(value, stamp):
    return InputSample(source=Source.SPEED, value=value, stamp=stamp)


def load(value, stamp):
    return InputSample(source=Source.LOAD, value=value, stamp=stamp)


def feed(monitor, events):
    """Return the states that the events give."""
    states = [
        monitor.tick(event[1]) if isinstance(event, tuple) else monitor.update(event)
        for event in events
    ]
    return [state for state in states if state is not None]


def motion(value, *, start=START, count=1, force=-1000.0, step=STEP):
    """Return pairs of a load and a speed sample."""
    stamps = [start + i * step for i in range(count)]
    return [
        make(number, stamp) for stamp in stamps for make, number in ((load, force), (speed, value))
    ]


def test_every_speed_sample_is_judged_once(core):
    states = feed(core.monitor(), motion(10.0, count=5))
    assert [state.judged for state in states] == [1, 2, 3, 4, 5]
    assert [state.stamp for state in states] == [START + i * STEP for i in range(5)]


def test_only_samples_that_led_to_a_verdict_count_as_judged(core):
    monitor = core.monitor()
    counts = [monitor.update(speed(10.0, START)).judged]  # no load yet
    for i, (value, force) in enumerate(
        [(0.1, -1e3), (10.0, -1e3), (1e3, -1e3), (10.0, 1e5), (0.1, 1e5), (-10.0, 0.0)]
    ):
        counts.append(feed(monitor, motion(value, start=START + i * STEP, force=force))[-1].judged)
    assert counts == [0, 1, 2, 2, 2, 3, 4]
    assert monitor.update(Refusal(source=Source.LOAD, why=Why.NOT_A_NUMBER)) is None
    assert monitor.update(speed(10.0, START + SECOND)).judged == 4


def test_other_samples_are_kept_and_not_judged(core):
    monitor = core.monitor()
    assert monitor.update(load(5.0, START)) is None
    state = monitor.update(speed(10.0, START))
    assert state.point.axial_load == 5.0
    assert state.point.axial_load_source is PointSource.MEASURED


def test_before_the_load_arrives_nothing_can_be_judged(core):
    state = core.monitor().update(speed(10.0, START))
    assert state.estimate.validity is PointValidity.NO_INPUT
    assert state.verdict.findings[0].code is Code.INPUT_LOST
    assert math.isnan(state.point.axial_load)
    assert (state.level, state.judged) == (Level.UNKNOWN, 0)


def test_a_load_exactly_as_old_as_its_timeout_is_judged(core):
    monitor = core.monitor()
    monitor.update(load(-1000.0, START))
    assert monitor.update(speed(10.0, START + TIMEOUT)).verdict.zone is Zone.OPTIMAL
    stale = monitor.update(speed(10.0, START + TIMEOUT + 1))
    assert stale.point.axial_load_source is PointSource.HELD
    assert stale.point.axial_load == -1000.0
    assert stale.estimate.validity is PointValidity.NO_INPUT


def test_the_default_temperature_is_used_without_a_topic(core):
    state = feed(core.monitor(), motion(10.0))[-1]
    assert state.point.temperature == 313.15
    assert state.point.temperature_source is PointSource.DEFAULT


def test_a_configured_temperature_is_waited_for(core):
    timeouts = dict.fromkeys((Source.SPEED, Source.LOAD, Source.TEMPERATURE), TIMEOUT)
    monitor = core.monitor(timeouts=timeouts)
    assert feed(monitor, motion(10.0))[-1].estimate.validity is PointValidity.NO_INPUT
    monitor.update(InputSample(source=Source.TEMPERATURE, value=300.0, stamp=START))
    assert feed(monitor, motion(10.0, start=START + STEP))[-1].point.temperature == 300.0


def test_the_measured_torque_is_compared_and_never_judged(core):
    timeouts = dict.fromkeys((Source.SPEED, Source.LOAD, Source.TORQUE), TIMEOUT)
    monitor = core.monitor(timeouts=timeouts)
    before = feed(monitor, motion(-10.0))[-1]
    assert math.isnan(before.measured_torque)
    assert before.verdict.zone is Zone.OPTIMAL
    monitor.update(InputSample(source=Source.TORQUE, value=-2.5, stamp=START))
    after = feed(monitor, motion(-10.0, start=START + STEP))[-1]
    assert (after.measured_torque, after.torque_residual) == (-2.5, -0.5)


@pytest.mark.parametrize('glitch', [1e12, -1e12, math.nextafter(300.0, math.inf)])
def test_a_glitch_is_counted_and_never_reaches_the_totals(core, glitch):
    clean, glitched = (core.monitor(plausible={Source.SPEED: 300.0}) for _ in range(2))
    feed(clean, motion(10.0, count=5))
    feed(glitched, [*motion(10.0, count=2), speed(glitch, START + 3 * STEP // 2)])
    last = feed(glitched, motion(10.0, start=START + 2 * STEP, count=3))[-1]
    assert last.totals == feed(clean, [speed(10.0, START + 4 * STEP)])[-1].totals
    assert last.window.speed.high == 10.0
    health = last.inputs[0]
    assert (health.implausible, health.dropped, health.glitching) == (1, 1, True)
    assert health.state is InputState.OK


def test_the_plausible_limit_itself_is_plausible(core):
    monitor = core.monitor(plausible={Source.SPEED: 300.0, Source.LOAD: 5e3})
    state = feed(monitor, motion(-300.0, force=-5e3))[-1]
    assert [health.dropped for health in state.inputs[:2]] == [0, 0]
    later = feed(monitor, motion(10.0, start=START + STEP, force=5001.0))[-1]
    assert later.estimate.validity is PointValidity.NO_INPUT
    assert later.inputs[1].refusal == (
        'load 5001 N is beyond the plausible 5000 N: mend the source, its unit or scale, '
        'or raise limits.plausible_load'
    )


@pytest.mark.parametrize('bad', [math.nan, math.inf])
def test_a_bad_speed_is_refused_and_counted(core, bad):
    monitor = core.monitor()
    feed(monitor, motion(10.0))
    assert monitor.update(speed(bad, START + STEP)) is None
    health = feed(monitor, motion(10.0, start=START + 2 * STEP))[-1].inputs[0]
    assert (health.source, health.received, health.dropped) == (Source.SPEED, 3, 1)
    assert health.state is InputState.OK


def test_a_bad_load_stops_the_judgement_until_the_next_good_one(core):
    monitor = core.monitor()
    feed(monitor, motion(10.0))
    monitor.update(Refusal(source=Source.LOAD, why=Why.NOT_A_NUMBER))
    state = monitor.update(speed(10.0, START + STEP))
    assert state.estimate.validity is PointValidity.NO_INPUT
    assert state.inputs[1].state is InputState.BAD
    assert feed(monitor, motion(10.0, start=START + 2 * STEP))[-1].verdict.zone is Zone.OPTIMAL


def test_messages_about_other_joints_do_not_stop_the_judgement(core):
    monitor = core.monitor()
    feed(monitor, motion(10.0))
    monitor.update(Refusal(source=Source.LOAD, why=Why.OTHER_JOINTS))
    state = monitor.update(speed(10.0, START + STEP))
    assert state.verdict.zone is Zone.OPTIMAL
    assert state.inputs[1].dropped == 1


def test_a_sample_out_of_order_is_dropped_and_one_of_equal_stamp_is_judged(core):
    monitor = core.monitor()
    feed(monitor, motion(10.0, count=3))
    assert monitor.update(speed(10.0, START + STEP)) is None
    state = monitor.update(speed(10.0, START + 2 * STEP))
    assert (state.judged, state.inputs[0].dropped) == (4, 1)


def test_the_direction_is_held_at_standstill(core):
    monitor = core.monitor()
    still = feed(monitor, motion(0.1))[-1]
    assert still.point.direction is Direction.UNKNOWN
    assert not still.point.direction_held
    assert still.estimate.validity is PointValidity.UNKNOWN
    moving = feed(monitor, motion(-10.0, start=START + STEP))[-1]
    assert (moving.point.direction, moving.point.direction_held) == (Direction.NEGATIVE, False)
    still = feed(monitor, motion(0.1, start=START + 2 * STEP))[-1]
    assert (still.point.direction, still.point.direction_held) == (Direction.NEGATIVE, True)
    assert still.verdict.gates == (Gate.STANDSTILL,)


def test_a_standing_warning_is_not_cleared_by_standstill_or_silence(core):
    monitor = core.monitor(core.surface(rcs=lambda speed, load: 1.0 if speed < 30.0 else 0.0))
    feed(monitor, motion(10.0, count=60))
    assert monitor.level is Level.WARN
    feed(monitor, motion(0.0, start=START + SECOND, count=300))
    feed(monitor, [(TICK, START + i * SECOND) for i in range(5, 60)])
    assert monitor.level is Level.WARN
    state = feed(monitor, motion(40.0, start=START + 100 * SECOND, count=101))[-1]
    assert (state.level, state.level_since) == (Level.OK, START + 101 * SECOND)


def test_ticks_speak_only_while_the_speed_is_missing(core):
    monitor = core.monitor()
    state = monitor.tick(START)
    assert (state.stamp, state.estimate.validity) == (START, PointValidity.NO_INPUT)
    assert state.point.speed_source is PointSource.UNKNOWN
    feed(monitor, motion(10.0, start=START + STEP))
    assert monitor.tick(START + STEP + TIMEOUT) is None
    state = monitor.tick(START + STEP + TIMEOUT + 1)
    assert state.point.speed_source is PointSource.HELD
    assert (state.point.speed, state.judged) == (10.0, 1)
    assert state.inputs[0].state is InputState.STALE


def slow_is_bad(core, **changes):
    surface = core.surface(rcs=lambda speed, load: 1.0 if speed < 30.0 else 0.0)
    return core.monitor(surface, **changes)


def test_an_event_begins_and_ends_with_its_facts(core):
    monitor = slow_is_bad(core)
    states = feed(monitor, motion(40.0, count=120))
    assert all(state.event is None for state in states)
    states = feed(monitor, motion(10.0, start=START + 2 * SECOND, count=80))
    edges = [state for state in states if state.event is not None]
    assert len(edges) == 1
    event = edges[0].event
    assert (event.number, event.active, event.start) == (1, True, START + 2 * SECOND)
    assert event.stamp == edges[0].stamp == START + 2 * SECOND + SECOND // 2
    assert (event.cause.code, event.worst_value) == (Code.RCS_HIGH, 1.0)
    assert event.advice.target_speed == pytest.approx(30.0, rel=1e-5)
    assert event.advice.text.startswith('at this load run at 30 rad/s (286 rev/min)')
    states = feed(monitor, motion(40.0, start=START + 3 * SECOND, count=120))
    (over,) = [state.event for state in states if state.event is not None]
    assert (over.number, over.active, over.start) == (1, False, START + 2 * SECOND)
    assert over.stamp == START + 4 * SECOND
    assert {state.event_id for state in states} == {1}


def test_the_state_that_raises_does_not_wait_for_the_advice(core):
    """One lookup for a sample, as ever; the scan of the surface comes when it is asked for."""
    monitor = core.monitor(core.surface(rcs=1.0), core.limits(raise_delay=0))
    (state,) = feed(monitor, motion(10.0))
    assert state.event.active
    assert len(monitor.surface.asked) == 1
    assert math.isnan(state.event.advice.target_speed)  # bad everywhere
    asked = len(monitor.surface.asked)
    assert asked > 100
    assert monitor.event.advice is state.event.advice
    assert len(monitor.surface.asked) == asked


def test_an_efficiency_that_is_not_judged_is_no_worst_one(core):
    surface = core.surface(
        rcs=lambda speed, load: 0.5 if speed < 30.0 else 0.0,
        efficiency=lambda speed, load: 0.1 if load < 100.0 else 0.7,
    )
    monitor = core.monitor(surface)
    feed(monitor, motion(40.0, count=60))
    assert (monitor.event.cause.code, monitor.event.worst_value) == (Code.EFFICIENCY_LOW, 0.7)
    light = feed(monitor, motion(10.0, start=START + 60 * STEP, force=-50.0))[-1]
    assert (light.verdict.zone, light.estimate.efficiency) == (Zone.OUTSIDE, 0.1)
    assert monitor.event.active
    assert monitor.event.worst_value == 0.7


def test_the_worst_value_counts_from_the_first_sample_outside(core):
    rcs = iter([0.5, 0.9, 0.4, 0.3] + [0.3] * 100)
    monitor = core.monitor(
        core.surface(rcs=lambda speed, load: next(rcs)), core.limits(raise_delay=3 * STEP)
    )
    surface, numbers = monitor.surface, monitor.surface.numbers
    feed(monitor, motion(10.0, count=3))
    assert monitor.event == Event()
    # The advice scans the surface: from here on it is constant.
    surface.numbers = numbers | {'rcs': 0.3}
    (state,) = feed(monitor, motion(10.0, start=START + 3 * STEP))
    assert (state.event.cause.value, state.event.worst_value) == (0.5, 0.9)


def test_the_worst_efficiency_is_the_smallest(core):
    monitor = core.monitor(core.surface(efficiency=0.5), core.limits(raise_delay=0))
    feed(monitor, motion(10.0))
    assert (monitor.event.cause.code, monitor.event.worst_value) == (Code.EFFICIENCY_LOW, 0.5)
    monitor.surface.numbers = {'efficiency': 0.25}
    feed(monitor, motion(10.0, start=START + STEP))
    monitor.surface.numbers = {'efficiency': 0.5, 'rcs': 1.0}
    feed(monitor, motion(10.0, start=START + 2 * STEP))
    assert monitor.event.worst_value == 0.25


def test_a_stay_too_short_is_no_event(core):
    monitor = slow_is_bad(core)
    feed(
        monitor,
        motion(10.0, count=50)
        + motion(40.0, start=START + SECOND // 2, count=3)
        + motion(10.0, start=START + SECOND, count=50),
    )
    assert monitor.event == Event()
    feed(monitor, motion(10.0, start=START + SECOND + SECOND // 2))
    assert (monitor.event.number, monitor.event.start) == (1, START + SECOND)


def test_an_acknowledged_warning_comes_back_as_a_new_event(core):
    monitor = slow_is_bad(core)
    feed(monitor, motion(10.0, count=51))
    ended = monitor.acknowledge(START + SECOND)
    assert (ended.number, ended.active, ended.stamp) == (1, False, START + SECOND)
    assert monitor.level is Level.UNKNOWN
    assert monitor.acknowledge(START + SECOND) is None
    feed(monitor, motion(10.0, start=START + SECOND, count=51))
    assert (monitor.event.number, monitor.event.active) == (2, True)


def test_an_event_whose_stamps_run_ahead_of_the_clock_ends_after_it_began(core):
    monitor = slow_is_bad(core)
    samples = motion(10.0, count=51)
    feed(monitor, samples)
    ended = monitor.acknowledge(START - 10 * SECOND)
    assert ended.start == START
    assert ended.stamp == samples[-1].stamp
    (state,) = feed(monitor, motion(40.0, start=samples[-1].stamp + STEP))
    assert state.level_since <= state.stamp


def test_states_are_thinned_to_a_grid_but_edges_are_not(core):
    monitor = slow_is_bad(core, publish_period=SECOND)
    states = feed(monitor, motion(40.0, start=START + STEP, count=299))
    assert [state.stamp for state in states] == [
        START + STEP,
        START + SECOND,
        START + SECOND + STEP,
        START + 2 * SECOND,
    ]
    assert states[2].level is Level.OK
    assert [state.window.count for state in states] == [1, 99, 1, 99]
    assert sum(state.window.count for state in states) == states[-1].judged


def test_a_loop_of_the_clock_starts_the_filters_anew_and_keeps_the_level(core):
    monitor = slow_is_bad(core)
    first = feed(monitor, motion(10.0, count=71))[-1]
    states = feed(monitor, motion(40.0, start=SECOND, count=100))
    assert [state.level for state in states] == [Level.WARN] * 100
    assert states[0].level_since == SECOND - (first.stamp - first.level_since)
    since = SECOND - (first.stamp - first.totals.since)
    assert states[0].totals == dataclasses.replace(first.totals, since=since)
    assert states[0].estimate.validity is PointValidity.VALID
    assert states[-1].judged == 171
    over = feed(monitor, motion(40.0, start=2 * SECOND))[-1]
    assert over.level is Level.OK
    assert over.event.start <= over.event.stamp


def test_a_tick_of_an_earlier_time_forgets_the_future(core):
    monitor = core.monitor()
    feed(monitor, [(TICK, START), *motion(10.0)])
    state = monitor.tick(START - BACKWARD_JUMP - 1)
    assert state.estimate.validity is PointValidity.NO_INPUT
    assert state.point.speed_source is PointSource.UNKNOWN
    assert monitor.tick(START - BACKWARD_JUMP) is not None


def test_stamps_that_run_ahead_of_the_clock_are_no_jump(core):
    monitor = slow_is_bad(core, max_future=START)
    for i in range(51):
        feed(monitor, [*motion(10.0, start=START + i * STEP), (TICK, START // 2 + i * STEP)])
    assert monitor.level is Level.WARN


@pytest.mark.parametrize('early', [Source.SPEED, Source.LOAD])
def test_a_sample_taken_before_the_clock_began_goes_stale_too(core, early):
    """A clock at zero refuses no stamp, so one may lie any distance ahead."""
    monitor = core.monitor(max_future=SECOND)
    feed(monitor, [(TICK, 0), load(-1000.0, START), speed(10.0, START)])
    here = START // 2
    state = monitor.tick(here)
    assert state.estimate.validity is PointValidity.NO_INPUT
    late = [event for event in motion(10.0, start=here) if event.source is not early]
    feed(monitor, [*late, (TICK, here)])
    states = feed(monitor, [speed(10.0, here + STEP)])
    if early is Source.LOAD:
        assert states[-1].inputs[1].state is InputState.MISSING
    else:
        assert states[-1].verdict.zone is Zone.OPTIMAL


def test_a_load_alone_from_before_the_clock_began_is_forgotten(core):
    monitor = core.monitor(max_future=SECOND)
    feed(monitor, [(TICK, 0), load(-1000.0, START)])
    here = START // 2
    assert feed(monitor, [speed(10.0, here)])[-1].verdict.zone is Zone.OPTIMAL
    monitor.tick(here)
    assert monitor.update(speed(10.0, here + STEP)).inputs[1].state is InputState.MISSING


def test_stamps_as_far_ahead_as_is_allowed_are_kept(core):
    """A tick lies on its grid, which the clock may have left by almost a period."""
    monitor = core.monitor(max_future=SECOND, tick_period=10 * SECOND)
    ahead = START + 11 * SECOND
    feed(monitor, [(TICK, START), *motion(10.0, start=ahead), (TICK, START)])
    state = monitor.update(speed(10.0, ahead))
    assert state.verdict.zone is Zone.OPTIMAL


@pytest.mark.parametrize('period', [TIMEOUT + SECOND // 10, 2 * TIMEOUT])
def test_a_speed_slower_than_its_timeout_is_warned_of(core, period):
    monitor = slow_is_bad(core)
    for i in range(5):
        feed(monitor, motion(10.0, start=START + i * period))
        feed(monitor, [(TICK, START + (i + 1) * period - 1)])
    assert monitor.level is Level.WARN
    # The first hole may be an interruption; from the second on the input is slow.
    assert monitor.event.start == START + period


def test_a_slow_speed_that_stands_in_between_is_outside_anew(core):
    monitor = slow_is_bad(core)
    for i in range(20):
        feed(monitor, motion(0.0 if i % 2 else 10.0, start=START + i * SECOND))
    assert monitor.level is Level.UNKNOWN


def test_one_hole_between_two_short_stays_outside_is_no_warning(core):
    monitor = slow_is_bad(core)
    feed(monitor, motion(10.0, count=20) + motion(10.0, start=START + 60 * SECOND, count=20))
    assert monitor.level is Level.UNKNOWN


def test_a_slow_speed_never_brings_ok(core):
    monitor = slow_is_bad(core)
    state = feed(monitor, motion(40.0, count=20, step=SECOND))[-1]
    assert state.inputs[0].slow
    assert monitor.level is Level.UNKNOWN
    state = feed(monitor, motion(40.0, start=START + 20 * SECOND, count=102))[-1]
    assert not state.inputs[0].slow
    assert monitor.level is Level.OK


def test_a_load_of_an_earlier_time_line_leaves_the_filters_alone(core):
    monitor = slow_is_bad(core)
    for i in range(51):
        skew = i % 2 * 10 * SECOND
        feed(monitor, motion(10.0, start=START + i * STEP))
        feed(monitor, [load(-1000.0, START + i * STEP - skew)])
    assert monitor.level is Level.WARN


def lagging(events, lag):
    """Return samples whose stamps lie `lag` [ns] behind their arrivals, which stay."""
    return [
        dataclasses.replace(event, stamp=event.stamp - lag, arrival=event.stamp)
        for event in events
    ]


@pytest.mark.parametrize('lag', [6 * SECOND // 10, 3 * SECOND, -SECOND // 20])
def test_a_source_with_a_constant_offset_is_judged_like_any_other(core, lag):
    """Whatever the stamps say, with the ticks of a node between the samples."""
    monitor, plain = slow_is_bad(core, max_lag=SECOND // 5), slow_is_bad(core)
    states = []
    for i in range(300):
        number = 40.0 if i > 120 else 10.0
        pair = motion(number, start=START + i * STEP)
        ticks = [(TICK, START + i * STEP)] if i and i % 10 == 0 else []
        states += feed(monitor, [*lagging(pair, lag), *ticks])
        feed(plain, [*pair, *ticks])
        assert monitor.level is plain.level
    assert [state.stamp for state in states] == [START - lag + i * STEP for i in range(300)]
    assert {state.estimate.validity for state in states} == {PointValidity.VALID}
    assert monitor.level is Level.OK
    assert monitor.event.number == 1
    assert states[-1].inputs[0].lag == pytest.approx(lag / SECOND)
    assert states[-1].inputs[0].lagging is (lag > SECOND // 5)


def test_a_warning_clears_though_the_stamps_drift(core):
    monitor = slow_is_bad(core)
    feed(monitor, motion(10.0, count=60))
    for i in range(210):
        pair = motion(40.0, start=START + SECOND + i * STEP)
        feed(monitor, [*lagging(pair, i * STEP // 2), (TICK, START + SECOND + i * STEP)])
    assert monitor.level is Level.OK


def test_a_stamped_speed_goes_with_a_load_that_is_timed_by_its_arrival(core):
    monitor = core.monitor()
    late = SECOND
    for i in range(20):
        force, fast = motion(10.0, start=START + i * STEP)
        state = feed(monitor, [force, *lagging([fast], late)])[-1]
        assert state.verdict.zone is Zone.OPTIMAL


def test_a_lagging_speed_that_dies_goes_stale_by_its_arrival_on_its_own_time_line(core):
    monitor = slow_is_bad(core, max_lag=SECOND // 5)
    lag = SECOND
    feed(monitor, lagging(motion(10.0, count=60), lag))
    last = START + 59 * STEP
    assert monitor.tick(last + TIMEOUT) is None
    state = monitor.tick(last + TIMEOUT + 1)
    assert state.estimate.validity is PointValidity.NO_INPUT
    assert state.stamp == last + TIMEOUT + 1 - lag
    assert state.level is Level.WARN


def test_a_clock_that_is_set_back_does_not_hide_a_dead_speed(core):
    """The stamps come from another machine, whose clock runs on."""
    monitor = core.monitor()
    feed(monitor, [(TICK, START), *lagging(motion(10.0), 5 * SECOND)])
    back = START - 4 * SECOND
    assert monitor.tick(back) is None
    assert monitor.tick(back + TIMEOUT + 1).estimate.validity is PointValidity.NO_INPUT


def test_what_was_lost_is_told_with_the_next_state(core):
    monitor = core.monitor()
    force, fast = motion(10.0)
    feed(monitor, [force])
    state = monitor.update(dataclasses.replace(fast, lost=7))
    assert (state.inputs[0].lost, state.inputs[0].losing) == (7, True)
    assert (state.inputs[1].lost, state.inputs[1].losing) == (0, False)


def test_totals_reset(core):
    monitor = core.monitor()
    assert feed(monitor, motion(10.0, count=11))[-1].totals.running_time == 10 * STEP
    monitor.reset_totals()
    state = feed(monitor, motion(10.0, start=START + 11 * STEP))[-1]
    assert (state.totals.running_time, state.judged) == (STEP, 12)


def test_new_limits_hold_from_the_next_sample(core):
    monitor = core.monitor(core.surface(rcs=0.5), core.limits(raise_delay=0))
    assert feed(monitor, motion(10.0))[-1].verdict.zone is Zone.OUTSIDE
    monitor.settings = dataclasses.replace(
        monitor.settings, limits=core.limits(rcs=0.625, raise_delay=0)
    )
    assert feed(monitor, motion(10.0, start=START + STEP))[-1].verdict.zone is Zone.OPTIMAL


stamps = st.integers(0, 40).map(lambda i: START + i * SECOND // 10)
values = st.sampled_from([0.0, 0.2, 5.0, -5.0, 40.0, -40.0, 500.0, math.nan])
events = st.one_of(
    st.builds(speed, values, stamps),
    st.builds(load, values.map(lambda v: 50.0 * v), stamps),
    st.builds(Refusal, source=st.sampled_from(Source), why=st.sampled_from(Why)),
    stamps.map(lambda stamp: (TICK, stamp)),
)


def by_text(states):
    """Return states in a form in which NaN equals NaN."""
    return [repr(state) for state in states]


@given(st.lists(events, max_size=60))
def test_the_same_events_give_the_same_states(core, stream):
    first = slow_is_bad(core)
    second = Monitor(first.surface, first.settings)  # the text of an event names its surface
    assert by_text(feed(first, stream)) == by_text(feed(second, stream))


@given(st.lists(events, max_size=60))
def test_the_level_changes_on_judged_speed_samples_only(core, stream):
    monitor, judged = slow_is_bad(core, limits=core.limits(raise_delay=0, clear_delay=0)), 0
    for event in stream:
        before = monitor.level
        state = (feed(monitor, [event]) or [None])[0]
        if isinstance(event, InputSample) and event.source is Source.SPEED and state is not None:
            judged += state.verdict.zone is not Zone.UNKNOWN or state.verdict.gates[:1] == (
                Gate.STANDSTILL,
            )
            assert state.judged == judged
        if monitor.level is not before:
            assert state.estimate.validity is PointValidity.VALID
            assert monitor.level is (
                Level.WARN if state.verdict.zone is Zone.OUTSIDE else Level.OK
            )


@given(st.lists(events, max_size=60))
def test_the_event_is_active_exactly_while_the_level_warns(core, stream):
    monitor, last = slow_is_bad(core, limits=core.limits(raise_delay=SECOND // 10)), 0
    for event in stream:
        feed(monitor, [event])
        assert monitor.event.active is (monitor.level is Level.WARN)
        assert monitor.event.number >= last
        last = monitor.event.number
