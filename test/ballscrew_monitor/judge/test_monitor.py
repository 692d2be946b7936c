# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""A monitor's words on an excursion, and what it is told beside samples."""

import copy
import dataclasses
import math

from ballscrew_monitor.core.advice import SCAN_POINTS
from ballscrew_monitor.core.conversions import SECOND
from ballscrew_monitor.core.fields import OtherJoints
from ballscrew_monitor.core.inputs import InputSample, Refusal, Source, StampSource, Why
from ballscrew_monitor.core.judgement import Code, EventEnd, Level, Zone
from ballscrew_monitor.core.state import Ending, NAMELESS, NOT_ENDED, shelve, Shelving
from ballscrew_monitor.judge import records
from ballscrew_monitor.judge.kept import AxisRecord, SUMS
from ballscrew_monitor.judge.monitor import EARLIEST, fill, LATEST, MOST_OTHERS, within
from ballscrew_monitor.judge.views import SOURCES
from ballscrew_monitor.judge.zone import ACTIVE
from ballscrew_monitor.messages.unjudged import point_or_reason
from hypothesis import given
from hypothesis import strategies as st
import pytest

STEP = SECOND // 100
START = 1000 * SECOND
REMEMBERED = records.Memory(
    running_time=5 * SECOND,
    zone_time=[0, 5 * SECOND, 0],
    angle=7.5,
    since=SECOND,
    event_number=7,
    event_stamp=20,
    event_start=[10, 0],
    event_code=[Code.EFFICIENCY_LOW, 0],
    event_worst=[0.5, math.nan],
    event_limit=[0.75, math.nan],
    event_derived=[1, 0],
)
SHELVED = Shelving(until=START + 10 * SECOND, reason='nut is ordered')
KEPT = AxisRecord.of('x', REMEMBERED, Ending(EventEnd.ACKNOWLEDGED, 'Ada', 'why'), SHELVED, START)


def slow_is_bad(core, memory=None, **limits):
    """Return a monitor that warns below 30 rad/s."""
    surface = core.surface(rcs=lambda speed, load: 1.0 if speed < 30.0 else 0.0)
    made = core.monitor(surface, core.limits(**limits), speed_allowed=True)
    if memory is not None:
        made.take_up(memory, START)
    return made


def test_the_row_of_the_last_event_is_there_whether_or_not_a_state_is_due(core):
    monitor = core.monitor(publish_period=10 * SECOND)
    assert monitor.row is None
    found = []
    for event in core.motion(40.0, count=3):
        states, row = core.feed(monitor, [event]), monitor.row
        found.append((event.source, row and (row.stamp, row.speed), bool(states)))
    stamps = [START + number * STEP for number in range(3)]
    assert found == [
        one
        for number, stamp in enumerate(stamps)
        for one in ((Source.LOAD, None, False), (Source.SPEED, (stamp, 40.0), number == 0))
    ]
    assert monitor.tick(START + 3 * STEP) is None
    assert monitor.row is None


def test_an_event_begins_and_ends_with_its_facts(core):
    monitor = slow_is_bad(core)
    states = core.feed(monitor, core.motion(40.0, count=120))
    assert all(state.event is None for state in states)
    begin = START + 2 * SECOND
    states = core.feed(monitor, core.motion(10.0, start=begin, count=80))
    (edge,) = [state for state in states if state.event is not None]
    event = edge.event
    assert (event.event_number, event.event_active, event.event_start[0]) == (1, True, begin)
    assert event.event_stamp == edge.stamp == begin + SECOND // 2
    assert (monitor.event_code, event.event_worst[0]) == (Code.RCS_HIGH, 1.0)
    assert monitor.target_speed == pytest.approx(30.0, rel=1e-5)
    assert monitor.ending.kind == EventEnd.UNKNOWN
    states = core.feed(monitor, core.motion(40.0, start=begin + SECOND, count=120))
    (over,) = [state.event for state in states if state.event is not None]
    assert (over.event_number, over.event_active, over.event_start[0]) == (1, False, begin)
    assert monitor.ending.kind == EventEnd.CLEARED
    assert over.event_stamp == begin + 2 * SECOND
    assert {state.event_id for state in states} == {1}


def test_the_state_that_raises_does_not_wait_for_the_advice(core):
    """One lookup for a sample, as ever; the scan of the surface comes when it is asked for."""
    surface, limits = core.surface(rcs=1.0), core.limits(raise_delay=0)
    monitor = core.monitor(surface, limits, speed_allowed=True)
    (state,) = core.feed(monitor, core.motion(10.0))
    assert state.event.event_active
    assert len(monitor.surface.asked) == 1
    assert math.isnan(monitor.target_speed)  # bad everywhere
    asked = len(monitor.surface.asked)
    assert asked > SCAN_POINTS
    assert math.isnan(monitor.target_speed)
    assert len(monitor.surface.asked) == asked


def test_advice_comes_and_goes_with_the_parameter(core):
    """On the event that stands, too: its place and cause stay."""
    monitor = slow_is_bad(core, raise_delay=0)
    core.feed(monitor, core.motion(10.0))
    before = copy.deepcopy(monitor.memory)
    assert monitor.target_speed == pytest.approx(30.0, rel=1e-5)
    monitor.settings = dataclasses.replace(monitor.settings, speed_allowed=False)
    assert math.isnan(monitor.target_speed)
    monitor.settings = dataclasses.replace(monitor.settings, speed_allowed=True)
    assert monitor.target_speed == pytest.approx(30.0, rel=1e-5)
    assert repr(monitor.memory) == repr(before)


@pytest.mark.parametrize(
    ('course', 'raise_delay', 'code', 'worst'),
    [
        # speed, load and what the surface says there: RCS, efficiency
        ([(1.0, 1e3, 0.5, 0.9), (2.0, 1e3, 0.9, 0.9), (3.0, 1e3, 0.4, 0.9)], 2, 1, 1),
        ([(1.0, 1e3, 0.0, 0.7), (2.0, 100.0, 0.5, 0.1), (3.0, 1e3, 0.0, 0.5)], 0, 2, 2),
        ([(1.0, 1e3, 0.0, 0.7), (2.0, 100.0, 0.5, 0.1), (3.0, 1e3, 0.9, 0.72)], 2, 2, 0),
        ([(1.0, 1e3, 0.5, 0.5), (2.0, 1e3, 0.5, 0.25), (3.0, 1e3, 0.0, 0.1)], 0, 1, 0),
    ],
)
def test_worst_value_limit_and_place_are_of_one_sample(core, course, raise_delay, code, worst):
    """From the first sample outside on; one under a light load has no efficiency."""
    numbers = {at: (rcs, efficiency) for at, _, rcs, efficiency in course}
    surface = core.surface(
        rcs=lambda speed, load: numbers.get(speed, (0.0, 0.0))[0],
        efficiency=lambda speed, load: numbers.get(speed, (0.0, 0.0))[1],
    )
    monitor = core.monitor(surface, core.limits(raise_delay=raise_delay * STEP, hysteresis=0.0))
    for i, (speed, force, _, _) in enumerate(course):
        core.feed(monitor, core.motion(speed, start=START + i * STEP, force=-force))
    event, (speed, force, rcs, efficiency) = monitor.memory, course[worst]
    value, limit = (rcs, 0.25) if code == Code.RCS_HIGH else (efficiency, 0.75)
    assert (event.event_active, event.event_start[ACTIVE]) == (True, START)
    assert (event.event_code[ACTIVE], event.event_limit[ACTIVE]) == (code, limit)
    assert event.event_worst[ACTIVE] == value
    assert (event.event_speed[ACTIVE], event.event_load[ACTIVE]) == (speed, -force)
    assert event.event_temperature[ACTIVE] == 313.15


def test_the_limit_of_the_worst_sample_stays_with_it(core):
    monitor = core.monitor(core.surface(rcs=0.5), core.limits(raise_delay=0))
    core.feed(monitor, core.motion(10.0))
    limits = core.limits(rcs=0.375, raise_delay=0)
    monitor.settings = dataclasses.replace(monitor.settings, limits=limits)
    core.feed(monitor, core.motion(11.0, start=START + STEP))
    memory = monitor.memory
    assert (memory.event_worst[ACTIVE], memory.event_limit[ACTIVE]) == (0.5, 0.25)
    monitor.surface.numbers = {'rcs': 0.75}
    core.feed(monitor, core.motion(12.0, start=START + 2 * STEP))
    assert (monitor.memory.event_worst[ACTIVE], monitor.memory.event_limit[ACTIVE]) == (
        0.75,
        0.375,
    )
    assert monitor.memory.event_speed[ACTIVE] == 12.0


def length_of_event(monitor):
    return monitor.memory.event_stamp - monitor.memory.event_start[ACTIVE]


def stamped(event, lag=0, header=True):
    """Return a sample whose stamp lies behind its arrival by a lag [ns]."""
    kind = StampSource.HEADER if header else StampSource.RECEIVE
    return dataclasses.replace(
        event, stamp=event.stamp - lag, arrival=event.stamp, stamp_source=kind
    )


HOUR, YEAR = 3600 * SECOND, 365 * 86_400 * SECOND


def course_of(core, *, step=0, at=70, lag=0, header=True, follows=True):
    """Return how a course ends that is slow, fast and slow again; the clock is set before `at`."""
    monitor = slow_is_bad(core, raise_delay=SECOND // 2, clear_delay=SECOND)
    speeds = [10.0] * 100 + [40.0] * 150 + [10.0] * 80
    found = []
    for number, one in enumerate(core.motion(10.0, start=10 * YEAR, count=len(speeds))):
        if number == at and step:
            now = one.stamp + step
            monitor.set_clock(one.stamp, now)
        arrival = one.stamp + (step if number >= at else 0)
        stamp = (arrival if follows else one.stamp) - lag
        kind = StampSource.HEADER if header else StampSource.RECEIVE
        sample = {'stamp': stamp, 'arrival': arrival, 'stamp_source': kind}
        monitor.update(dataclasses.replace(one, value=speeds[number // 2], **sample))
        memory = monitor.memory
        lasted = memory.event_stamp - memory.event_start[ACTIVE] if memory.event_number else 0
        found.append((monitor.level, memory.event_number, memory.event_active, lasted))
        assert not monitor.moved
    sums = {name: getattr(monitor.memory, name) for name in SUMS}
    return found, sums


@pytest.mark.parametrize('step', [YEAR, HOUR, -HOUR, -YEAR // 400])
@pytest.mark.parametrize('at', [1, 30, 99, 120, 301, 420])
def test_a_step_of_the_nodes_clock_changes_no_duration(core, step, at):
    """It comes while a warning is raised, stands, is cleared and is over."""
    for stamps in ({}, {'header': False}, {'lag': 50 * SECOND}, {'lag': -SECOND // 20}):
        assert course_of(core, step=step, at=at, **stamps) == course_of(core, **stamps)


@pytest.mark.parametrize('step', [YEAR, HOUR])
def test_a_step_that_the_stamps_do_not_follow_changes_no_duration(core, step):
    for at in (1, 30, 120, 301, 420):
        assert course_of(core, step=step, at=at, follows=False) == course_of(core)


@pytest.mark.parametrize('after', [0, HOUR])
def test_what_ends_before_the_next_sample_lasts_as_long_as_without_a_step(core, after):
    monitor = slow_is_bad(core)
    core.feed(monitor, core.motion(10.0, count=100))
    end = START + 100 * STEP
    monitor.set_clock(end, end + HOUR)
    for number in range(3):
        monitor.tick(end + HOUR + number * SECOND)
    assert monitor.acknowledge(end + HOUR + 2 * SECOND)
    assert length_of_event(monitor) == 3 * SECOND


def test_inputs_are_as_old_after_a_step_as_before(core):
    monitor = slow_is_bad(core)
    core.feed(monitor, core.motion(10.0, count=30))
    now = START + 30 * STEP
    before = monitor.input_status(now)
    for step in (YEAR, -HOUR, HOUR):
        monitor.set_clock(now, now + step)
        now += step
        monitor.tick(now)
        assert monitor.input_status(now) == before
    core.feed(monitor, core.motion(10.0, start=now, count=1))
    for one, other in zip(monitor.input_status(now), before, strict=True):
        assert (one.state, one.slow) == (other.state, False)
        assert one.rate == pytest.approx(other.rate, nan_ok=True)


@pytest.mark.parametrize('step', [YEAR, HOUR, -HOUR])
def test_a_shelving_lasts_as_long_however_the_clock_is_set(core, step):
    monitor, begin = slow_is_bad(core), 10 * YEAR
    monitor.shelving = shelve(begin, 60.0, 'nut is ordered')
    monitor.set_clock(begin + 20 * SECOND, begin + 20 * SECOND + step)
    now = begin + step
    assert monitor.shelving.at(now + 59 * SECOND).until == now + 60 * SECOND
    assert monitor.shelving.is_over(now + 60 * SECOND)
    assert monitor.kept(now + 25 * SECOND).left_ns == 35 * SECOND


def test_a_shelving_goes_on_with_what_is_left_whatever_the_clock_says_then(core):
    kept = dataclasses.replace(KEPT, left_ns=35 * SECOND)
    for now in (START, START + YEAR, 5):
        monitor = slow_is_bad(core)
        monitor.take_up(kept, now)
        assert monitor.shelving.until == now + 35 * SECOND
    monitor = slow_is_bad(core)
    monitor.take_up(kept, 0)  # /clock has not begun
    assert monitor.kept(0).left_ns == 35 * SECOND
    assert not monitor.shelving.at(0).until
    assert not monitor.shelving.is_over(START)
    assert monitor.shelving.started(START) == Shelving(
        until=START + 35 * SECOND, reason=KEPT.reason
    )


@pytest.mark.parametrize('step', [-600 * SECOND, -20 * SECOND])
def test_a_clock_that_is_set_back_changes_no_length_of_an_excursion(core, step):
    monitor = slow_is_bad(core)
    core.feed(monitor, core.motion(10.0, count=100))
    length = length_of_event(monitor)
    core.feed(monitor, core.motion(10.0, start=START + SECOND + step, count=3))
    assert monitor.memory.event_active
    assert length_of_event(monitor) == length


def test_what_moves_the_begin_of_an_excursion_is_told_with_the_sample(core):
    monitor, lag = slow_is_bad(core), 600 * SECOND
    moved = []
    for one in core.motion(10.0, count=100):
        monitor.update(stamped(one, lag))
        moved.append(monitor.moved)
    for one in core.motion(10.0, start=START + SECOND, count=2):
        monitor.update(stamped(one))
        moved.append(monitor.moved)
    back = core.motion(10.0, start=START + SECOND + 2 * STEP - lag)
    for one in back:
        monitor.update(stamped(one))
        moved.append(monitor.moved)
    assert moved == [0] * 201 + [lag] + [0] * 3 + [STEP - lag]


def test_a_stay_too_short_is_no_event(core):
    monitor = slow_is_bad(core)
    core.feed(monitor, core.motion(10.0, count=50))
    core.feed(monitor, core.motion(40.0, start=START + SECOND // 2, count=3))
    core.feed(monitor, core.motion(10.0, start=START + SECOND, count=50))
    assert (monitor.memory.event_number, monitor.memory.event_active) == (0, False)
    assert monitor.ending == NOT_ENDED
    core.feed(monitor, core.motion(10.0, start=START + SECOND + SECOND // 2))
    assert (monitor.memory.event_number, monitor.memory.event_start[ACTIVE]) == (1, START + SECOND)


def test_an_acknowledged_warning_comes_back_as_a_new_event(core):
    monitor = slow_is_bad(core)
    core.feed(monitor, core.motion(10.0, count=51))
    seen = Ending(kind=EventEnd.ACKNOWLEDGED, name='Ada')
    assert monitor.acknowledge(START + SECOND, seen)
    memory = monitor.memory
    assert (memory.event_number, memory.event_active) == (1, False)
    assert memory.event_stamp == START + SECOND
    assert (monitor.ending, monitor.level) == (seen, Level.UNKNOWN)
    assert not monitor.acknowledge(START + SECOND)
    core.feed(monitor, core.motion(10.0, start=START + SECOND, count=51))
    assert (memory.event_number, memory.event_active) == (2, True)
    assert monitor.ending == NOT_ENDED
    monitor, samples = slow_is_bad(core), core.motion(10.0, count=51)
    core.feed(monitor, samples)
    assert monitor.acknowledge(START - 10 * SECOND)
    assert monitor.ending == NAMELESS
    assert monitor.memory.event_start[ACTIVE] == START
    assert monitor.memory.event_stamp == samples[-1].stamp
    (state,) = core.feed(monitor, core.motion(40.0, start=samples[-1].stamp + STEP))
    assert state.level_since <= state.stamp


def test_totals_reset(core):
    monitor = core.monitor()
    assert core.feed(monitor, core.motion(10.0, count=11))[-1].totals.running_time == 10 * STEP
    monitor.reset_totals()
    state = core.feed(monitor, core.motion(10.0, start=START + 11 * STEP))[-1]
    assert (state.totals.running_time, state.judged) == (STEP, 12)


def test_new_limits_and_a_new_surface_hold_from_the_next_sample(core):
    monitor = core.monitor(core.surface(rcs=0.5), core.limits(raise_delay=0))
    assert core.feed(monitor, core.motion(10.0))[-1].zone == Zone.OUTSIDE
    limits = core.limits(rcs=0.625, raise_delay=0)
    monitor.settings = dataclasses.replace(monitor.settings, limits=limits)
    state = core.feed(monitor, core.motion(10.0, start=START + STEP))[-1]
    assert (state.zone, state.message.rcs_limit) == (Zone.OPTIMAL, limits.rcs)
    monitor = core.monitor(core.surface(rcs=0.5))
    core.feed(monitor, core.motion(10.0))
    monitor.use_surface(core.surface(rcs=0.125))
    assert core.feed(monitor, core.motion(10.0, start=START + STEP))[-1].rcs == 0.125


@pytest.mark.parametrize(
    ('events', 'now', 'answer'),
    [
        ([], START, 'no valid sample of speed and load'),
        ([(Source.SPEED, 10.0)], START, 'no valid sample of load'),
        ([(Source.LOAD, -1e3), (Source.SPEED, 10.0)], START + SECOND, 'no valid sample of spe'),
        ([(Source.LOAD, -1e3), (Source.SPEED, 0.2)], START, 'the direction of motion is unk'),
        ([(Source.LOAD, -1e3), (Source.SPEED, 500.0)], START, 500.0),  # a solve may know it
        ([(Source.LOAD, -1e3), (Source.SPEED, -10.0)], START, -10.0),
        ([(Source.LOAD, -1e3), (Source.SPEED, 10.0), (Source.SPEED, 0.2)], START, 'the screw st'),
    ],
)
def test_the_point_of_now_is_known_or_said_to_be_missing(core, events, now, answer):
    monitor = core.monitor()
    core.feed(monitor, [core.sample(*event) for event in events])
    before = dataclasses.asdict(monitor.memory)
    found = point_or_reason(monitor, now)
    if isinstance(answer, str):
        assert found.startswith(answer)
    else:
        assert (found.speed, found.axial_load) == (answer, -1e3)
    assert repr(dataclasses.asdict(monitor.memory)) == repr(before)  # to ask changes nothing


def test_a_monitor_goes_on_where_another_one_ended(core):
    monitor = slow_is_bad(core, KEPT, raise_delay=0)
    assert monitor.kept(START) == KEPT
    states = core.feed(monitor, core.motion(10.0, count=2))
    assert states[0].event.event_number == 8
    assert states[-1].totals.running_time == 5 * SECOND + STEP
    assert states[-1].totals.since == SECOND
    assert monitor.shelving == SHELVED
    assert states[-1].level == Level.WARN
    kept = monitor.kept(START).read_memory()
    assert (kept.event_number, kept.event_active) == (8, True)
    assert kept.event_stamp == START + STEP
    assert monitor.kept(START).read_ending() == NOT_ENDED


def test_what_was_added_up_before_a_late_memory_counts_too(core):
    monitor = slow_is_bad(core, raise_delay=0)
    core.feed(monitor, core.motion(10.0, count=3))
    monitor.take_up(KEPT, START)
    assert (monitor.memory.event_number, monitor.memory.event_active) == (8, True)
    assert monitor.memory.running_time == 5 * SECOND + 2 * STEP
    assert monitor.shelving == SHELVED


def test_a_shelved_warning_is_judged_and_counted_as_ever(core):
    shelved, plain = (slow_is_bad(core, memory, raise_delay=0) for memory in (KEPT, None))
    events = core.motion(10.0, count=20)
    for one, other in zip(core.feed(shelved, events), core.feed(plain, events), strict=True):
        assert (one.level, one.zone, one.judged) == (other.level, other.zone, other.judged)
    late = core.motion(10.0, start=START + 10 * SECOND)
    assert not core.feed(shelved, late)[0].message.shelved


def others(*names):
    return Refusal(
        source=Source.LOAD, why=Why.OTHER_JOINTS, joints=OtherJoints('velocity', 'x', names)
    )


def heard(monitor):
    """Return the joints that the status of the load names."""
    return monitor.input_status(0)[1].joints


def test_joints_of_others_are_collected_until_a_sample_comes_up_to_a_number(core):
    monitor = core.monitor()
    assert heard(monitor) is None
    for names in (('c', 'a'), ('b',), ('c', 'a')):
        monitor.update(others(*names))
    assert heard(monitor) == OtherJoints('velocity', 'x', ('a', 'b', 'c'))
    monitor.update(core.sample(Source.LOAD, 1.0))
    assert heard(monitor) is None
    monitor.update(others('d'))
    assert heard(monitor).names == ('d',)
    monitor = core.monitor()
    for i in range(3 * MOST_OTHERS):
        monitor.update(others(f'joint{i}'))
    assert len(heard(monitor).names) == MOST_OTHERS


def test_a_refusal_is_told_with_its_number(core):
    monitor = core.monitor()
    for value in (math.inf, math.nan):
        monitor.update(Refusal(source=Source.LOAD, why=Why.NOT_A_NUMBER, first=value))
        assert f' {value}, ' in monitor.input_status(0)[1].refusal


@given(st.integers(-(2**70), 2**70), st.integers(-(2**70), 2**70), st.none() | st.integers(0, 9))
def test_a_record_holds_an_event_whose_stamps_fit(stamp, arrival, lost):
    """Differences of stamps stay within 64 bits."""
    record, known = records.Event(), -1 if lost is None else lost
    changes = {'arrival': arrival, 'lost': lost}
    fill(record, Refusal(source=Source.TORQUE, why=Why.NOT_A_NUMBER, **changes))
    assert (record.kind, record.source, record.why) == (records.REFUSAL, 2, Why.NOT_A_NUMBER)
    assert (record.arrival, record.lost) == (min(max(arrival, EARLIEST), LATEST), known)
    receive = StampSource.RECEIVE
    fill(record, InputSample(source=Source.SPEED, value=2, stamp=stamp, stamp_source=receive))
    assert (record.kind, record.source, record.value) == (records.SAMPLE, Source.SPEED, 2.0)
    assert (record.stamp, record.stamp_source) == (within(stamp), receive)
    assert isinstance(record.value, float)
    assert within(LATEST) - within(EARLIEST) < 2**63


def test_inputs_come_in_the_order_of_a_state(core):
    assert [one.source for one in core.monitor().input_status(0)] == list(SOURCES)
    assert set(SOURCES) == set(Source)
