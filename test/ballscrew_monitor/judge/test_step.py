# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The judgement as a function of an ordered list of events; numbers among them are ticks."""

import copy
import dataclasses
import math

from ballscrew_monitor.core.conversions import Direction, SECOND
from ballscrew_monitor.core.inputs import (
    InputSample,
    InputState,
    Refusal,
    Source,
    StampSource,
    Why,
)
from ballscrew_monitor.core.judgement import Code, Level, PointSource, PointValidity, Zone
from ballscrew_monitor.judge.monitor import fill, Monitor
from ballscrew_monitor.judge.records import Event, LIGHT_LOAD, Row, STANDSTILL
from ballscrew_monitor.judge.step import BACKWARD_JUMP, NOTHING, STATE, step, step_many
from ballscrew_monitor.judge.zone import ACTIVE
from hypothesis import given
from hypothesis import strategies as st
import pytest

STEP, TIMEOUT = SECOND // 100, SECOND // 2
START = 1000 * SECOND
THREE = (Source.SPEED, Source.LOAD, Source.TEMPERATURE)


def speed(value, stamp=START):
    return InputSample(source=Source.SPEED, value=value, stamp=stamp)


def load(value, stamp=START):
    return InputSample(source=Source.LOAD, value=value, stamp=stamp)


def slow_is_bad(core, **changes):
    surface = core.surface(rcs=lambda speed, load: 1.0 if speed < 30.0 else 0.0)
    return core.monitor(surface, **changes)


def test_every_speed_sample_in_order_is_judged_once_and_no_other(core):
    monitor = core.monitor()
    assert monitor.update(load(5.0)) is None
    states = core.feed(monitor, core.motion(10.0, count=5))
    assert [state.judged for state in states] == [1, 2, 3, 4, 5]
    assert [state.stamp for state in states] == [START + i * STEP for i in range(5)]
    monitor = core.monitor()
    core.feed(monitor, core.motion(10.0, count=3))
    assert monitor.update(speed(10.0, START + STEP)) is None
    state = core.feed(monitor, [speed(10.0, START + 2 * STEP)])[-1]
    assert (state.judged, state.inputs[0].dropped) == (4, 1)


def test_only_samples_that_led_to_a_verdict_count_as_judged(core):
    monitor = core.monitor()
    counts = [core.feed(monitor, [speed(10.0)])[-1].judged]  # no load yet
    for i, (value, force) in enumerate(
        [(0.1, -1e3), (10.0, -1e3), (1e3, -1e3), (10.0, 1e5), (0.1, 1e5), (-10.0, 0.0)]
    ):
        pair = core.motion(value, start=START + i * STEP, force=force)
        counts.append(core.feed(monitor, pair)[-1].judged)
    assert counts == [0, 1, 2, 2, 2, 3, 4]
    assert monitor.update(Refusal(source=Source.LOAD, why=Why.NOT_A_NUMBER)) is None
    assert core.feed(monitor, [speed(10.0, START + SECOND)])[-1].judged == 4


def test_before_the_load_and_a_configured_temperature_nothing_can_be_judged(core):
    state = core.feed(core.monitor(), [speed(10.0)])[-1]
    assert state.validity == PointValidity.NO_INPUT
    assert state.message.findings[0].code == Code.INPUT_LOST
    assert math.isnan(state.axial_load)
    assert (state.level, state.judged) == (Level.UNKNOWN, 0)
    point = core.feed(core.monitor(), core.motion(10.0))[-1]
    assert (point.temperature, point.temperature_source) == (313.15, PointSource.DEFAULT)
    monitor = core.monitor(timeouts=dict.fromkeys(THREE, TIMEOUT))
    state = core.feed(monitor, core.motion(10.0))[-1]
    assert state.validity == PointValidity.NO_INPUT
    monitor.update(core.sample(Source.TEMPERATURE, 300.0))
    point = core.feed(monitor, core.motion(10.0, start=START + STEP))[-1]
    assert (point.temperature, point.temperature_source) == (300.0, PointSource.MEASURED)


def test_a_load_exactly_as_old_as_its_timeout_is_judged(core):
    monitor = core.monitor()
    monitor.update(load(-1000.0))
    assert core.feed(monitor, [speed(10.0, START + TIMEOUT)])[-1].zone == Zone.OPTIMAL
    stale = core.feed(monitor, [speed(10.0, START + TIMEOUT + 1)])[-1]
    assert stale.axial_load_source == PointSource.HELD
    assert stale.axial_load == -1000.0
    assert stale.validity == PointValidity.NO_INPUT


def test_the_measured_torque_is_compared_and_never_judged(core):
    timeouts = dict.fromkeys((Source.SPEED, Source.LOAD, Source.TORQUE), TIMEOUT)
    monitor = core.monitor(timeouts=timeouts)
    before = core.feed(monitor, core.motion(-10.0))[-1]
    assert math.isnan(before.message.measured_torque)
    assert before.zone == Zone.OPTIMAL
    monitor.update(core.sample(Source.TORQUE, -2.5))
    after = core.feed(monitor, core.motion(-10.0, start=START + STEP))[-1]
    assert (after.message.measured_torque, after.message.torque_residual) == (-2.5, -0.5)


@pytest.mark.parametrize('glitch', [1e12, -1e12, math.nextafter(300.0, math.inf)])
def test_a_glitch_is_counted_and_never_reaches_the_totals(core, glitch):
    clean, glitched = (core.monitor(plausible={Source.SPEED: 300.0}) for _ in range(2))
    core.feed(clean, core.motion(10.0, count=5))
    odd = [*core.motion(10.0, count=2), speed(glitch, START + 3 * STEP // 2)]
    core.feed(glitched, odd)
    last = core.feed(glitched, core.motion(10.0, start=START + 2 * STEP, count=3))[-1]
    assert last.totals == core.feed(clean, [speed(10.0, START + 4 * STEP)])[-1].totals
    assert last.window.speed_max == 10.0
    health = last.inputs[0]
    assert (health.implausible, health.dropped, health.glitching) == (1, 1, True)
    assert health.state is InputState.OK


def test_the_plausible_limit_itself_is_plausible(core, says):
    monitor = core.monitor(plausible={Source.SPEED: 300.0, Source.LOAD: 5e3})
    state = core.feed(monitor, core.motion(-300.0, force=-5e3))[-1]
    assert [health.dropped for health in state.inputs[:2]] == [0, 0]
    later = core.feed(monitor, core.motion(10.0, start=START + STEP, force=5001.0))[-1]
    assert later.validity == PointValidity.NO_INPUT
    assert later.inputs[1].refusal == says('load_5001_n')


@pytest.mark.parametrize('bad', [math.nan, math.inf, -math.inf])
def test_a_bad_speed_is_refused_and_counted(core, bad):
    monitor = core.monitor()
    core.feed(monitor, core.motion(10.0))
    assert monitor.update(speed(bad, START + STEP)) is None
    health = core.feed(monitor, core.motion(10.0, start=START + 2 * STEP))[-1].inputs[0]
    assert (health.source, health.received, health.dropped) == (Source.SPEED, 3, 1)
    assert health.state is InputState.OK


@pytest.mark.parametrize('why', [Why.NOT_A_NUMBER, Why.OTHER_JOINTS])
def test_a_bad_load_stops_the_judgement_and_one_of_other_joints_does_not(core, why):
    monitor = core.monitor()
    core.feed(monitor, core.motion(10.0))
    monitor.update(Refusal(source=Source.LOAD, why=why))
    state = core.feed(monitor, [speed(10.0, START + STEP)])[-1]
    bad = why is Why.NOT_A_NUMBER
    assert (state.validity == PointValidity.NO_INPUT) is bad
    assert state.inputs[1].state is (InputState.BAD if bad else InputState.OK)
    assert state.inputs[1].dropped == 1
    state = core.feed(monitor, core.motion(10.0, start=START + 2 * STEP))[-1]
    assert state.zone == Zone.OPTIMAL


def test_the_direction_is_held_at_standstill(core):
    monitor, told = core.monitor(), []
    for i, value in enumerate((0.1, -10.0, 0.1)):
        state = core.feed(monitor, core.motion(value, start=START + i * STEP))[-1]
        told.append((state.direction, state.direction_held, state.gates))
        assert (state.validity == PointValidity.UNKNOWN) == (i == 0)
    still = STANDSTILL
    assert told == [
        (Direction.UNKNOWN, False, still),
        (Direction.NEGATIVE, False, 0),
        (Direction.NEGATIVE, True, still),
    ]


def test_a_standing_warning_is_not_cleared_by_standstill_or_silence(core):
    monitor = slow_is_bad(core)
    core.feed(monitor, core.motion(10.0, count=60))
    assert monitor.level == Level.WARN
    core.feed(monitor, core.motion(0.0, start=START + SECOND, count=300))
    core.feed(monitor, [START + i * SECOND for i in range(5, 60)])
    assert monitor.level == Level.WARN
    state = core.feed(monitor, core.motion(40.0, start=START + 100 * SECOND, count=101))[-1]
    assert (state.level, state.level_since) == (Level.OK, START + 101 * SECOND)


def test_ticks_speak_only_while_the_speed_is_missing(core):
    monitor = core.monitor()
    state = core.feed(monitor, [START])[-1]
    assert (state.stamp, state.validity) == (START, PointValidity.NO_INPUT)
    assert state.speed_source == PointSource.UNKNOWN
    core.feed(monitor, core.motion(10.0, start=START + STEP))
    assert monitor.tick(START + STEP + TIMEOUT) is None
    state = core.feed(monitor, [START + STEP + TIMEOUT + 1])[-1]
    assert state.speed_source == PointSource.HELD
    assert (state.speed, state.judged) == (10.0, 1)
    assert state.inputs[0].state is InputState.STALE


def test_states_are_thinned_to_a_grid_but_edges_are_not(core):
    monitor = slow_is_bad(core, publish_period=SECOND)
    states = core.feed(monitor, core.motion(40.0, start=START + STEP, count=299))
    stamps = [START + STEP, START + SECOND, START + SECOND + STEP, START + 2 * SECOND]
    assert [state.stamp for state in states] == stamps
    assert states[2].level == Level.OK
    assert [state.window.count for state in states] == [1, 99, 1, 99]
    assert sum(state.window.count for state in states) == states[-1].judged


def test_a_loop_of_the_clock_starts_the_filters_over_and_keeps_the_level(core):
    monitor = slow_is_bad(core)
    first = core.feed(monitor, core.motion(10.0, count=71))[-1]
    states = core.feed(monitor, core.motion(40.0, start=SECOND, count=100))
    assert [state.level for state in states] == [Level.WARN] * 100
    assert states[0].level_since == SECOND - (first.stamp - first.level_since)
    since = SECOND - (first.stamp - first.totals.since)
    assert vars(states[0].totals) == vars(first.totals) | {'since': since}
    assert states[0].validity == PointValidity.VALID
    assert states[-1].judged == 171
    over = core.feed(monitor, core.motion(40.0, start=2 * SECOND))[-1]
    assert over.level == Level.OK
    assert over.event.event_start[ACTIVE] <= over.event.event_stamp


def test_a_loop_of_the_clock_has_its_first_state_at_once(core):
    monitor = core.monitor(publish_period=4 * SECOND)
    told = [3 * SECOND, 3 * SECOND + STEP, SECOND]  # all in one period
    states = [core.feed(monitor, core.motion(10.0, start=START + at)) for at in told]
    assert [len(each) for each in states] == [1, 0, 1]


def test_a_loop_of_the_clock_opens_the_gates(core):
    """A direction and a light load of another time line hold no more."""
    monitor = core.monitor()
    core.feed(monitor, core.motion(10.0, force=-100.0))
    state = core.feed(monitor, core.motion(10.0, start=START + STEP, force=-300.0))[-1]
    assert state.gates == LIGHT_LOAD
    assert core.feed(monitor, core.motion(10.0, start=SECOND, force=-300.0))[-1].gates == 0


def test_a_tick_of_an_earlier_time_forgets_the_future_but_one_that_is_allowed(core):
    monitor = core.monitor()
    core.feed(monitor, [START, *core.motion(10.0)])
    state = core.feed(monitor, [START - BACKWARD_JUMP - 1])[-1]
    assert state.validity == PointValidity.NO_INPUT
    assert state.speed_source == PointSource.UNKNOWN
    assert monitor.tick(START - BACKWARD_JUMP) is not None
    monitor = slow_is_bad(core, max_future=START)
    for i in range(51):
        pair = core.motion(10.0, start=START + i * STEP)
        core.feed(monitor, [*pair, START // 2 + i * STEP])
    assert monitor.level == Level.WARN


@pytest.mark.parametrize('early', [Source.SPEED, Source.LOAD])
def test_a_sample_taken_before_the_clock_began_goes_stale_too(core, early):
    """A clock at zero refuses no stamp, so one may lie any distance ahead."""
    monitor = core.monitor(max_future=SECOND)
    core.feed(monitor, [0, load(-1000.0), speed(10.0)])
    here = START // 2
    state = core.feed(monitor, [here])[-1]
    assert state.validity == PointValidity.NO_INPUT
    late = [event for event in core.motion(10.0, start=here) if event.source is not early]
    core.feed(monitor, [*late, here])
    states = core.feed(monitor, [speed(10.0, here + STEP)])
    if early is Source.LOAD:
        assert states[-1].inputs[1].state is InputState.MISSING
    else:
        assert states[-1].zone == Zone.OPTIMAL


def test_a_load_alone_from_before_the_clock_began_is_forgotten(core):
    monitor = core.monitor(max_future=SECOND)
    core.feed(monitor, [0, load(-1000.0)])
    here = START // 2
    assert core.feed(monitor, [speed(10.0, here)])[-1].zone == Zone.OPTIMAL
    monitor.tick(here)
    assert core.feed(monitor, [speed(10.0, here + STEP)])[-1].inputs[1].state is InputState.MISSING


def test_stamps_as_far_ahead_as_is_allowed_are_kept(core):
    """A tick lies on its grid, which the clock may have left by almost a period."""
    monitor = core.monitor(max_future=SECOND, tick_period=10 * SECOND)
    ahead = START + 11 * SECOND
    core.feed(monitor, [START, *core.motion(10.0, start=ahead), START])
    assert core.feed(monitor, [speed(10.0, ahead)])[-1].zone == Zone.OPTIMAL


@pytest.mark.parametrize('period', [TIMEOUT + SECOND // 10, 2 * TIMEOUT])
def test_a_speed_slower_than_its_timeout_is_warned_of(core, period):
    monitor = slow_is_bad(core)
    for i in range(5):
        core.feed(monitor, core.motion(10.0, start=START + i * period))
        core.feed(monitor, [START + (i + 1) * period - 1])
    assert monitor.level == Level.WARN
    # The first hole may be an interruption; from the second on the input is slow.
    assert monitor.memory.event_start[ACTIVE] == START + period


def test_stays_that_are_not_of_one_piece_and_a_slow_speed_change_no_level(core):
    monitor = slow_is_bad(core)
    for i in range(20):
        core.feed(monitor, core.motion(0.0 if i % 2 else 10.0, start=START + i * SECOND))
    assert monitor.level == Level.UNKNOWN
    monitor = slow_is_bad(core)
    core.feed(monitor, core.motion(10.0, count=20))
    core.feed(monitor, core.motion(10.0, start=START + 60 * SECOND, count=20))
    assert monitor.level == Level.UNKNOWN
    monitor = slow_is_bad(core)
    state = core.feed(monitor, core.motion(40.0, count=20, step=SECOND))[-1]
    assert state.inputs[0].slow
    assert monitor.level == Level.UNKNOWN
    state = core.feed(monitor, core.motion(40.0, start=START + 20 * SECOND, count=102))[-1]
    assert not state.inputs[0].slow
    assert monitor.level == Level.OK


def test_a_load_of_an_earlier_time_line_leaves_the_filters_alone(core):
    monitor = slow_is_bad(core)
    for i in range(51):
        skew = i % 2 * 10 * SECOND
        core.feed(monitor, core.motion(10.0, start=START + i * STEP))
        core.feed(monitor, [load(-1000.0, START + i * STEP - skew)])
    assert monitor.level == Level.WARN


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
        pair = core.motion(40.0 if i > 120 else 10.0, start=START + i * STEP)
        ticks = [START + i * STEP] if i and i % 10 == 0 else []
        states += core.feed(monitor, [*lagging(pair, lag), *ticks])
        core.feed(plain, [*pair, *ticks])
        assert monitor.level is plain.level
    assert [state.stamp for state in states] == [START - lag + i * STEP for i in range(300)]
    assert {state.validity for state in states} == {PointValidity.VALID}
    assert monitor.level == Level.OK
    assert monitor.memory.event_number == 1
    assert states[-1].inputs[0].lag == pytest.approx(lag / SECOND)
    assert states[-1].inputs[0].lagging is (lag > SECOND // 5)


def test_a_warning_clears_though_the_stamps_drift(core):
    monitor = slow_is_bad(core)
    core.feed(monitor, core.motion(10.0, count=60))
    for i in range(210):
        pair = core.motion(40.0, start=START + SECOND + i * STEP)
        core.feed(monitor, [*lagging(pair, i * STEP // 2), START + SECOND + i * STEP])
    assert monitor.level == Level.OK


def test_a_stamped_speed_goes_with_a_load_that_is_timed_by_its_arrival(core):
    monitor = core.monitor()
    for i in range(20):
        force, fast = core.motion(10.0, start=START + i * STEP)
        state = core.feed(monitor, [force, *lagging([fast], SECOND)])[-1]
        assert state.zone == Zone.OPTIMAL


def test_a_lagging_speed_that_dies_goes_stale_by_its_arrival_on_its_own_time_line(core):
    monitor, lag = slow_is_bad(core, max_lag=SECOND // 5), SECOND
    core.feed(monitor, lagging(core.motion(10.0, count=60), lag))
    last = START + 59 * STEP
    assert monitor.tick(last + TIMEOUT) is None
    state = core.feed(monitor, [last + TIMEOUT + 1])[-1]
    assert state.validity == PointValidity.NO_INPUT
    assert state.stamp == last + TIMEOUT + 1 - lag
    assert state.level == Level.WARN


def test_a_clock_that_is_set_back_does_not_hide_a_dead_speed(core):
    """The stamps come from another machine, whose clock runs on."""
    monitor = core.monitor()
    core.feed(monitor, [START, *lagging(core.motion(10.0), 5 * SECOND)])
    back = START - 4 * SECOND
    assert monitor.tick(back) is None
    assert core.feed(monitor, [back + TIMEOUT + 1])[-1].validity == PointValidity.NO_INPUT


def length_of_event(monitor):
    return (monitor.memory.event_stamp - monitor.memory.event_start[ACTIVE]) / SECOND


@pytest.mark.parametrize('lag', [3600 * SECOND, 31_536_000 * SECOND, 2 * SECOND])
def test_a_source_whose_clock_is_set_forward_in_a_warning_makes_it_no_longer(core, lag):
    monitor = slow_is_bad(core, limits=core.limits(raise_delay=SECOND, clear_delay=SECOND))
    core.feed(monitor, lagging(core.motion(10.0, count=200), lag))
    assert monitor.level == Level.WARN
    begin = monitor.memory.event_start[ACTIVE]
    core.feed(monitor, core.motion(10.0, start=START + 200 * STEP, count=100))
    assert monitor.memory.event_start[ACTIVE] == begin + lag
    assert monitor.level == Level.WARN
    core.feed(monitor, core.motion(40.0, start=START + 300 * STEP, count=101))
    assert monitor.level == Level.OK
    assert (monitor.memory.event_number, length_of_event(monitor)) == (1, 4.0)


def test_a_leap_within_a_long_timeout_raises_and_clears_nothing(core):
    long = dict.fromkeys((Source.SPEED, Source.LOAD), 60 * SECOND)
    limits = core.limits(raise_delay=3 * SECOND, clear_delay=3 * SECOND)
    monitor, lag = slow_is_bad(core, timeouts=long, limits=limits), 10 * SECOND
    core.feed(monitor, lagging(core.motion(10.0, count=50), lag))
    core.feed(monitor, core.motion(10.0, start=START + 50 * STEP, count=50))
    assert monitor.level == Level.UNKNOWN
    running = monitor.memory.running_time
    assert running == 98 * STEP


def test_a_message_that_comes_late_and_a_hole_are_no_leap(core):
    """After a stall of 5 s one sample comes late, and those behind it are lost."""
    monitor = slow_is_bad(core)
    core.feed(monitor, core.motion(10.0, count=100))
    begin = monitor.memory.event_start[ACTIVE]
    late = core.motion(10.0, start=START + 105 * STEP + 5 * SECOND)
    core.feed(monitor, lagging(late, 5 * SECOND))
    core.feed(monitor, core.motion(10.0, start=START + 106 * STEP + 5 * SECOND))
    core.feed(monitor, core.motion(10.0, start=START + 3600 * SECOND))
    assert monitor.memory.event_active
    assert monitor.memory.event_start[ACTIVE] == begin


def test_positions_leave_a_leap_out_once(core):
    """The first position after it gives no speed."""
    monitor, lag = slow_is_bad(core, position_window=5 * STEP), 3600 * SECOND

    def moves(first, count):
        return [
            one
            for i in range(first, first + count)
            for one in (load(-1000.0, START + i * STEP), speed(0.1 * i, START + i * STEP))
        ]

    core.feed(monitor, lagging(moves(0, 200), lag))
    begin = monitor.memory.event_start[ACTIVE]
    assert monitor.level == Level.WARN
    core.feed(monitor, moves(200, 50))
    assert monitor.memory.event_start[ACTIVE] == begin + lag


@pytest.mark.parametrize('step', [3600 * SECOND, 31_536_000 * SECOND])
def test_a_clock_that_is_set_back_in_a_warning_makes_it_no_shorter(core, step):
    monitor = slow_is_bad(core, limits=core.limits(raise_delay=SECOND, clear_delay=SECOND))
    first = START + step
    core.feed(monitor, core.motion(10.0, start=first, count=200))
    core.feed(monitor, core.motion(10.0, start=START + 200 * STEP, count=100))
    core.feed(monitor, core.motion(40.0, start=START + 300 * STEP, count=101))
    assert (monitor.memory.event_number, length_of_event(monitor)) == (1, 3.99)


def test_what_was_lost_is_told_with_the_next_state(core):
    monitor = core.monitor()
    force, fast = core.motion(10.0)
    core.feed(monitor, [force])
    state = core.feed(monitor, [dataclasses.replace(fast, lost=7)])[-1]
    assert (state.inputs[0].lost, state.inputs[0].losing) == (7, True)
    assert (state.inputs[1].lost, state.inputs[1].losing) == (0, False)


stamps = st.integers(0, 40).map(lambda i: START + i * SECOND // 10)


class Kept(list):
    """A list that keeps what a memory is, as an array does."""

    def __setitem__(self, at, memory):
        super().__setitem__(at, copy.deepcopy(memory))


@pytest.mark.parametrize('every', [False, True])
@pytest.mark.parametrize('room', [1, 3, 100])
def test_many_events_are_taken_as_one_after_the_other(core, every, room):
    """Rows, their places, and memories of states or edges, while there is room for them."""
    limits = core.limits(raise_delay=0, clear_delay=0)
    monitor, other = (slow_is_bad(core, limits=limits, publish_period=3 * STEP) for _ in range(2))
    records, wanted = [], []
    for i, value in enumerate([40.0, 10.0, 40.0, 40.0] * 3):
        for each in core.motion(value, start=START + i * STEP):
            record = Event()
            fill(record, each)
            records.append(record)
            row = Row()
            found = step(
                other.surface,
                other.numbers,
                other.memory,
                other.speeds,
                other.positions,
                record,
                row,
            )
            if found != NOTHING:
                told = found == STATE and (every or row.edge != 0)
                wanted.append((i, row, copy.deepcopy(other.memory) if told else None))
    assert 1 < sum(memory is not None for *_, memory in wanted) <= len(wanted) == 12
    taken = made = 0
    while taken < len(records):
        rows, places, memories = [Row() for _ in records], [-1] * len(records), Kept([None] * room)
        one = [monitor.numbers], [monitor.memory], [monitor.speeds], [monitor.positions]
        some = records[taken:]
        count, rows_made, told = step_many(
            monitor.surface, *one, some, rows, places, memories, every
        )
        end = made + rows_made
        part = wanted[made:end]
        assert repr(rows[:rows_made]) == repr([row for _, row, _ in part])
        assert places[:rows_made] == [2 * i + 1 - taken for i, *_ in part]
        kept = [memory for *_, memory in part if memory is not None]
        assert repr(memories[:told]) == repr(kept)
        assert count == len(some) or told == room
        taken, made = taken + count, end
    assert made == len(wanted)


values = st.sampled_from([0.0, 0.2, 5.0, -5.0, 40.0, -40.0, 500.0, math.nan])
events = st.one_of(
    st.builds(speed, values, stamps),
    st.builds(load, values.map(lambda v: 50.0 * v), stamps),
    st.builds(Refusal, source=st.sampled_from(Source), why=st.sampled_from(Why)),
    stamps,
)


@given(st.lists(events, max_size=60))
def test_the_same_events_give_the_same_states(core, stream):
    first = slow_is_bad(core)
    second = Monitor(first.surface, first.settings)  # the text of an event names its surface
    states = [[repr(state.message) for state in core.feed(one, stream)] for one in (first, second)]
    assert states[0] == states[1]


@given(st.lists(events, max_size=60))
def test_the_level_changes_on_judged_speed_samples_only(core, stream):
    monitor, judged = slow_is_bad(core, limits=core.limits(raise_delay=0, clear_delay=0)), 0
    for event in stream:
        before = monitor.level
        state = (core.feed(monitor, [event]) or [None])[0]
        if isinstance(event, InputSample) and event.source is Source.SPEED and state is not None:
            still = state.gates & STANDSTILL
            judged += state.zone != Zone.UNKNOWN or still
            assert state.judged == judged
        if monitor.level is not before:
            assert state.validity == PointValidity.VALID
            outside = state.zone == Zone.OUTSIDE
            assert monitor.level is (Level.WARN if outside else Level.OK)


@given(st.lists(events, max_size=60))
def test_the_event_is_active_exactly_while_the_level_warns(core, stream):
    monitor, last = slow_is_bad(core, limits=core.limits(raise_delay=SECOND // 10)), 0
    for event in stream:
        core.feed(monitor, [event])
        assert monitor.memory.event_active is (monitor.level == Level.WARN)
        assert monitor.memory.event_number >= last
        last = monitor.memory.event_number


def turning(core, wrap=math.tau):
    """Return a monitor whose samples of the speed are positions [rad]."""
    window = SECOND // 20
    return core.monitor(position_window=window, wrap=wrap, plausible={Source.SPEED: 50.0})


def turn(core, monitor, angle, i):
    stamp = START + i * STEP
    (state,) = core.feed(monitor, [load(-1000.0, stamp), speed(angle, stamp)]) or [None]
    return state


def test_positions_are_judged_by_their_speed_two_of_them_after_a_hole(core):
    monitor = turning(core)
    assert turn(core, monitor, 0.0, 0) is None
    for i in range(1, 300):
        state = turn(core, monitor, math.remainder(0.2 * i, math.tau), i)
        assert state.speed == pytest.approx(20.0)
    assert (state.zone, state.judged) == (Zone.OPTIMAL, 299)
    assert (state.inputs[0].received, state.inputs[0].dropped) == (300, 1)
    assert state.totals.revolutions == pytest.approx(298 * 0.2 / math.tau)
    monitor = turning(core)
    turn(core, monitor, 0.0, 0)
    turn(core, monitor, 0.2, 1)
    assert turn(core, monitor, 0.4, 200) is None
    assert core.feed(monitor, [START + 2 * SECOND])[-1].inputs[0].why is Why.HOLE
    assert turn(core, monitor, 0.6, 201).speed == pytest.approx(20.0)


def test_a_position_that_jumps_or_is_not_plausible_never_counts(core):
    monitor = turning(core, wrap=0.0)
    states = [turn(core, monitor, 0.2 * i + 1e6 * (i == 10), i) for i in range(21)]
    assert [i for i, state in enumerate(states) if state is None] == [0, 10, 11]
    assert states[-1].inputs[0].implausible == 2
    assert states[-1].totals.revolutions == pytest.approx(19 * 0.2 / math.tau)
    assert states[-1].window.speed_max == pytest.approx(20.0)
    monitor = turning(core)
    for i in range(5):
        assert turn(core, monitor, 0.6 * i, i) is None
    assert core.feed(monitor, [START + 10 * SECOND])[-1].inputs[0].implausible == 4


@pytest.mark.parametrize('speed_of_all', [-45.0, 0.0, 45.0])
@pytest.mark.parametrize('offset', [0.0, -7.0, 1e6])
def test_a_constant_velocity_is_exact_through_every_wrap(core, speed_of_all, offset):
    plain, wrapped = turning(core, wrap=0.0), turning(core)
    for i in range(200):
        angle = offset + speed_of_all * i * STEP / SECOND
        for monitor, value in ((plain, angle), (wrapped, angle % math.tau)):
            state = turn(core, monitor, value, i)
            assert (state is None) is (i == 0)
            if i:
                assert state.speed == pytest.approx(speed_of_all, abs=1e-6)


def test_a_wrap_that_is_not_stated_is_refused_with_its_cure(core, says):
    monitor = turning(core, wrap=0.0)
    states = [turn(core, monitor, angle, i) for i, angle in enumerate((6.0, 6.2, 0.1, 0.3, 0.5))]
    assert [state is None for state in states] == [True, False, True, False, False]
    assert states[4].speed == pytest.approx(20.0)
    turn(core, monitor, 6.1, 5)
    assert monitor.input_status(START)[0].refusal == says('position_jumps_by')


@pytest.mark.parametrize('stamp_source', StampSource)
def test_a_burst_of_unstamped_positions_is_no_jump(core, stamp_source):
    monitor = turning(core)
    for i in range(6):
        stamp = START + i * STEP if i < 5 else START + 4 * STEP + 1000
        monitor.update(core.sample(Source.SPEED, 0.2 * i, stamp, stamp_source=stamp_source))
    refused = monitor.input_status(START)[0].implausible
    assert (refused == 1) is (stamp_source is StampSource.HEADER)
