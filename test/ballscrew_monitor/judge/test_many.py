# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The step compiled over arrays and interpreted event by event: the same bits."""

import dataclasses
import math
import sys

from ballscrew_monitor.core.advice import advised_speed
from ballscrew_monitor.core.conversions import direction_of, SECOND
from ballscrew_monitor.core.inputs import Source, Why
from ballscrew_monitor.core.judgement import Limits
from ballscrew_monitor.core.state import LoadDerivation, MonitorSettings
from ballscrew_monitor.judge import many
from ballscrew_monitor.judge.many import compiled_nearest, EVENT, ManyJudge, MEMORY, ROW
from ballscrew_monitor.judge.monitor import fill, Monitor
from ballscrew_monitor.judge.records import Event, Memory, REFUSAL, Row, RUN, SAMPLE, TICK
from ballscrew_monitor.judge.records import STEP as CLOCK_STEP
from ballscrew_monitor.judge.step import NOTHING, STATE, step
from hypothesis import given, settings
from hypothesis import strategies as st
import numpy as np
import pytest
from surrogate.surface import batch, shipped_surface, Surface
from surrogate.surface.records import as_array, dtype_of, from_array

SURFACE = Surface.load(shipped_surface())
TIMEOUT, STEP = SECOND // 2, SECOND // 100
LIMITS = Limits(
    rcs=0.01,
    efficiency=0.85,
    light_load=661.0,
    standstill_speed=0.5,
    raise_delay=3 * STEP,
    clear_delay=2 * STEP,
    hysteresis=0.1,
)
DERIVATION = {
    'window': SECOND // 20,
    'torque_uncertainty': 0.05,
    'parts_uncertainty': 0.1,
    'largest_share': 2.0,
}
POSITIONS = {'position_window': SECOND // 20, 'wrap': 2 * math.pi}
WAYS = {
    'measured': {},
    'torque': {'derivation': LoadDerivation(inertia=0.0, **DERIVATION)},
    'inertia': {'derivation': LoadDerivation(inertia=1e-3, **DERIVATION)},
    'angle': POSITIONS,
    'all': {'derivation': LoadDerivation(inertia=1e-3, **DERIVATION), **POSITIONS},
}
REST = set(
    'asperity_share central_film minimum_film friction_coefficient max_pressure back_driving '
    'friction_torque_error friction_torque_std friction_torque_stderr rcs_error rcs_std '
    'rcs_stderr efficiency_error efficiency_std efficiency_stderr'.split()
)
"""Fields that only the row of a state has."""


def bits(array):
    """Return the bytes of an array of records field by field; every NaN is one."""
    found = {}
    for name in array.dtype.names:
        column = np.ascontiguousarray(array[name])
        if column.dtype.kind == 'f':
            column = np.where(np.isnan(column), math.nan, column).view(np.int64)
        found[name] = column
    return found


def assert_same(one, other, names, place):
    one, other = bits(one), bits(other)
    for name in names:
        np.testing.assert_array_equal(one[name], other[name], f'{place}: {name}')


def interpreted(monitor, events):
    """Return rows and the memory after each row of a state, and let the monitor remember."""
    rows, memories = [], []
    for event in events:
        row = Row()
        found = step(
            monitor.surface.tables,
            monitor.numbers,
            monitor.memory,
            monitor.speeds,
            monitor.positions,
            from_array(Event, event),
            row,
        )
        if found != NOTHING:
            rows.append(as_array(row))
        if found == STATE:
            memories.append(as_array(monitor.memory))
    none = np.empty(0, ROW), np.empty(0, MEMORY)
    return np.concatenate([none[0], *rows]), np.concatenate([none[1], *memories])


def at_once(monitor, events):
    """Return the same, compiled."""
    judge = ManyJudge(monitor)
    rows, memories = [np.empty(0, ROW)], [np.empty(0, MEMORY)]
    for judged in judge.judge(events, states=True):
        assert len(judged.memories) == len(judged.told)
        rows.append(judged.rows.copy())
        memories.append(judged.memories.copy())
    return np.concatenate(rows), np.concatenate(memories)


def compare(one, other, events, place=''):
    """Let two monitors judge events, one of them at once; compare all that comes of it."""
    (rows, memories), (wanted, remembered) = at_once(one, events), interpreted(other, events)
    assert len(rows) == len(wanted)
    assert_same(rows, wanted, [name for name in ROW.names if name not in REST], place)
    published = wanted['published']
    assert_same(rows[published], wanted[published], ROW.names, place)
    assert_same(memories, remembered, MEMORY.names, place)
    for name in ('memory', 'speeds', 'positions'):
        left, right = (as_array(getattr(monitor, name)) for monitor in (one, other))
        assert left.tobytes() == right.tobytes(), f'{place}: {name}'


def test_golden_runs_come_out_the_same(run, golden):
    one, other, events = golden.monitor(run), golden.monitor(run), []
    for stored in golden.table('event_', golden.numbers(run)):
        event, record = golden.event(stored), Event()
        if event is None:
            compare(one, other, np.array(events, EVENT), f'before event {stored.stamp}')
            events.clear()
            for monitor in (one, other):
                golden.command(monitor, stored)
            continue
        if isinstance(event, int):
            record.kind, record.stamp = TICK, event
        else:
            fill(record, event)
        events.append(as_array(record)[0])
    compare(one, other, np.array(events, EVENT))


def near(*limits):
    """Return limits and their neighbours, of both signs."""
    found = [math.nextafter(one, way) for one in limits for way in (-math.inf, one, math.inf)]
    return st.sampled_from([sign * one for one in found for sign in (1.0, -1.0)])


EDGES = st.sampled_from(
    [0.0, -0.0, 5e-324, -2e-320, 1e154, sys.float_info.max, math.inf, -math.inf, math.nan]
)
VALUES = {
    Source.SPEED: near(0.5, *SURFACE.speed_range) | st.floats(-250.0, 250.0),
    Source.LOAD: near(661.0, 1.1 * 661.0, *SURFACE.load_range) | st.floats(520.0, 740.0),
    Source.TEMPERATURE: near(*SURFACE.temperature_range) | st.floats(283.0, 354.0),
    Source.TORQUE: near(0.05, 1.0) | st.floats(-8.0, 8.0),
}
READINGS = st.sampled_from([Source.SPEED, *Source]).flatmap(
    lambda source: st.tuples(
        st.just(source), st.one_of(VALUES[source], VALUES[source], VALUES[source], EDGES)
    )
)
HAPPENINGS = st.lists(
    st.tuples(
        st.sampled_from([SAMPLE] * 12 + [REFUSAL, TICK, TICK, CLOCK_STEP, RUN]),
        READINGS,
        st.sampled_from(
            [0, 1, *[STEP] * 9, TIMEOUT, TIMEOUT + 1, 3 * SECOND]
            + [-1, -STEP, -SECOND, -SECOND - 1, -3 * SECOND]
        ),
        st.sampled_from([0, 0, 0, STEP, SECOND, None]),  # lag of the stamp, no arrival
        st.sampled_from([0, 0, 0, 2, -1]),
        st.sampled_from([1, 1, 2]),
        st.sampled_from(Why),
    ),
    max_size=80,
)


def events_of(happenings, positions):
    """Return what happens as events; positions follow from the speeds."""
    events, now, angle = np.empty(len(happenings), EVENT), 1000 * SECOND, 0.0
    for at, (kind, (source, value), gap, lag, lost, stamp_source, why) in enumerate(happenings):
        now += gap
        if positions and source is Source.SPEED and abs(value) < 300.0:
            value = angle = math.remainder(angle + value * STEP / SECOND, math.tau)
        arrival = 0 if lag is None else now + lag
        record = Event(kind=kind, source=source, why=why, stamp=now, arrival=arrival, lost=lost)
        record.stamp_source, record.value = stamp_source, value
        events[at] = as_array(record)[0]
    return events


@pytest.mark.parametrize('way', WAYS)
@settings(max_examples=settings.default.max_examples * 3 // 10)
@given(HAPPENINGS, st.booleans(), st.sampled_from([0, 2 * STEP]))
def test_whatever_happens_comes_out_the_same(way, happenings, usual, period):
    """In blocks of a few events and memories; `usual` inputs come before the odd ones."""
    told = MonitorSettings(
        axis='x',
        limits=LIMITS,
        timeouts=dict.fromkeys(Source, TIMEOUT),
        default_temperature=313.15,
        publish_period=period,
        max_future=SECOND,
        max_lag=SECOND // 5,
        tick_period=SECOND // 10,
        plausible={Source.SPEED: 700.0},
        **WAYS[way],
    )
    if usual:
        before = [(Source.TEMPERATURE, 313.15), (Source.LOAD, -900.0), (Source.TORQUE, 3.0)]
        before += [(Source.SPEED, 60.0)] * 5
        rest = (STEP // 10, 0, 0, 1, Why.OTHER_JOINTS)
        happenings = [*((SAMPLE, reading, *rest) for reading in before), *happenings]
    events = events_of(happenings, told.position_window > 0)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(many, 'AT_ONCE', 16)
        patch.setattr(many, 'MOST_MEMORIES', 5)
        compare(Monitor(SURFACE, told), Monitor(SURFACE, told), events)


def usual_settings(**changes):
    return MonitorSettings(
        axis='x',
        limits=LIMITS,
        timeouts=dict.fromkeys((Source.SPEED, Source.LOAD), TIMEOUT),
        default_temperature=313.15,
        tick_period=SECOND // 10,
        **changes,
    )


def turn_of(speeds, begin):
    """Return a load and these speeds as events."""
    records = [Event(source=Source.LOAD, stamp=begin, arrival=begin, value=-900.0)]
    for at, speed in enumerate(speeds):
        stamp = begin + at * STEP
        records.append(Event(source=Source.SPEED, stamp=stamp, arrival=stamp, value=speed))
        records[-1].stamp_source = 1
    return np.concatenate([as_array(record) for record in records])


SLOW, FAST = [0.6] * 6, [100.0] * 6


def test_a_monitor_goes_on_by_itself_where_a_judge_has_remembered_for_it():
    """Turns are judged compiled, interpreted and compiled again, and one is acknowledged."""
    one, other = (Monitor(SURFACE, usual_settings()) for _ in range(2))
    judge, numbers = ManyJudge(one), []
    for turn, speeds in enumerate([SLOW, FAST, SLOW, FAST]):
        begin = 1000 * SECOND + turn * len(speeds) * STEP
        events = turn_of(speeds, begin)
        interpreted(other, events)
        if turn == 1:
            interpreted(one, events)
        else:
            for judged in judge.judge(events, states=True):
                for at, row in judge.told(judged):
                    assert (row.stamp, one.memory.stamp) == (judged.rows['stamp'][at],) * 2
                    numbers.append((row.edge, one.memory.event_number))
        if turn == 2:
            for monitor in (one, other):
                assert monitor.acknowledge(begin + len(speeds) * STEP)
        for name in ('memory', 'speeds', 'positions'):
            left, right = (as_array(getattr(monitor, name)) for monitor in (one, other))
            assert left.tobytes() == right.tobytes(), f'turn {turn}: {name}'
    assert {(1, 1), (1, 2)} < set(numbers)
    assert one.ending == other.ending


def test_a_leap_of_the_stamps_in_a_warning_is_told_with_the_row_after_it_or_the_end():
    monitor = Monitor(SURFACE, usual_settings(publish_period=SECOND, max_lag=SECOND))
    judge, leap = ManyJudge(monitor), 3600 * SECOND
    events = turn_of([*SLOW, *SLOW, *SLOW], 1000 * SECOND)
    events['stamp'][10:] += leap
    moved = []
    for begin in range(0, len(events), 4):
        end = begin + 4
        for judged in judge.judge(events[begin:end], states=True):
            moved += [monitor.moved for _ in judge.told(judged)]
            moved.append(monitor.moved)
    assert [round(one / SECOND) for one in moved if one] == [3600]


def test_what_is_prepared_is_what_a_recording_needs():
    """One compiled step and one lookup, before and after a judgement."""
    many.prepare()
    told = MonitorSettings(axis='', limits=LIMITS, timeouts={}, default_temperature=313.15)
    at_once(Monitor(SURFACE, told), np.zeros(3, EVENT))
    batch.look_up_many(SURFACE, *np.ones((3, 2)))
    for entry in (many.compiled_step(), batch._compiled()):
        assert len(entry.signatures) == 1


def test_a_memory_has_the_fields_of_its_slots():
    for kind in (Memory, Row, Event):
        assert dtype_of(kind).names == tuple(
            name for base in kind.__mro__[::-1] for name in getattr(base, '__slots__', ())
        )
        made = as_array(kind())
        again = from_array(kind, made[0])
        assert repr(again) == repr(kind())
        assert as_array(again).tobytes() == made.tobytes()


@given(
    speed=st.floats(-400.0, 400.0),
    load=st.floats(-4000.0, 4000.0),
    temperature=st.floats(280.0, 360.0),
    efficiency=st.sampled_from([0.5, 0.85, 0.95]),
)
@settings(max_examples=settings.default.max_examples * 3 // 10)
def test_advice_comes_out_the_same(speed, load, temperature, efficiency):
    limits = dataclasses.replace(LIMITS, efficiency=efficiency)
    point = {'speed': speed, 'axial_load': load, 'temperature': temperature}
    point['direction'] = direction_of(speed)
    compiled = advised_speed(SURFACE, limits, **point, nearest=compiled_nearest())
    assert repr(compiled) == repr(advised_speed(SURFACE, limits, **point))
