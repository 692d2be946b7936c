# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Limits on the limit, gates, the level held over time, and the excursions that it raises."""

import math

from ballscrew_monitor.core.conversions import SECOND
from ballscrew_monitor.core.judgement import Code, Gate, Level, Zone
from ballscrew_monitor.core.state import NOT_ENDED, NOT_SHELVED
from ballscrew_monitor.judge import records
from ballscrew_monitor.judge.kept import AxisRecord
from ballscrew_monitor.judge.records import LIGHT_LOAD, Memory, Row, STANDSTILL
from ballscrew_monitor.judge.views import clear_totals, total_times
from ballscrew_monitor.judge.zone import (
    ACTIVE,
    add_to_totals,
    add_to_window,
    clear_window,
    follow_excursion,
    hold_level,
    set_zone,
    shut_gates,
)
from ballscrew_monitor.messages.state_messages import fill_window
from ballscrew_msgs.msg import WindowStatistics
from hypothesis import given
from hypothesis import strategies as st
import pytest
from surrogate.units import TURN

GAP = SECOND // 2
STEP = SECOND // 100
HELD = 3
OUTSIDE, INSIDE, BAND, UNKNOWN = (2, False), (1, True), (1, False), (0, False)
"""Zone, and whether it counts towards clearing."""
below = lambda value: math.nextafter(value, -math.inf)  # noqa: E731


def numbers(core, **changes):
    return core.monitor(limits=core.limits(**changes)).numbers


def judged(core, memory=None, **changes):
    values = {'validity': 1, 'speed': 10.0, 'axial_load': -1000.0, 'rcs': 0.0, 'efficiency': 0.9}
    row, settings = Row(**(values | changes)), numbers(core)
    shut_gates(settings, memory or Memory(), row)
    set_zone(settings, row)
    return row


@pytest.mark.parametrize(
    ('rcs', 'efficiency', 'zone'),
    [
        (0.25, 0.75, Zone.OUTSIDE),
        (below(0.25), 0.75, Zone.OPTIMAL),
        (below(0.25), below(0.75), Zone.OUTSIDE),
        (0.0, 1.0, Zone.OPTIMAL),
        (math.nan, 0.9, Zone.UNKNOWN),
        (0.0, math.nan, Zone.UNKNOWN),
    ],
)
def test_zone_on_its_limits(core, rcs, efficiency, zone):
    row = judged(core, rcs=rcs, efficiency=efficiency)
    assert row.zone == zone
    assert not row.clears or zone is Zone.OPTIMAL


@pytest.mark.parametrize(
    ('rcs', 'efficiency', 'clears'),
    [(0.125, 0.875, False), (below(0.125), 0.875, True), (below(0.125), below(0.875), False)],
)
def test_hysteresis_on_its_limits(core, rcs, efficiency, clears):
    row = judged(core, rcs=rcs, efficiency=efficiency)
    assert (row.zone, row.clears) == (Zone.OPTIMAL, clears)


@pytest.mark.parametrize('sign', [1.0, -1.0])
@pytest.mark.parametrize(
    ('force', 'was_light', 'light'),
    [
        (256.0, False, False),
        (below(256.0), False, True),
        (below(384.0), True, True),
        (384.0, True, False),
        (0.0, False, True),
    ],
)
def test_light_load_on_its_limits(core, force, was_light, light, sign):
    """A light load leaves the efficiency unjudged and does not excuse RCS."""
    memory = Memory(light=was_light)
    row = judged(core, memory, axial_load=sign * force, efficiency=0.0)
    assert (row.gates, memory.light) == (LIGHT_LOAD * light, light)
    assert (row.zone, row.clears) == ((1, True) if light else (2, False))
    assert judged(core, axial_load=sign * force, rcs=0.25).zone == Zone.OUTSIDE


@given(st.lists(st.floats(520.0, 680.0), min_size=1, max_size=60), st.booleans())
def test_a_load_about_the_light_limit_is_one_verdict(core, loads, begins_light):
    """600 +- 80 N about a gate of 661 N, too small to open it at 727 N."""
    settings, memory = numbers(core, light_load=661.0, hysteresis=0.1), Memory()
    zones = []
    for load in ([600.0] if begins_light else []) + loads:
        row = Row(validity=1, speed=10.0, axial_load=-load, rcs=0.0, efficiency=0.5)
        shut_gates(settings, memory, row)
        set_zone(settings, row)
        zones.append(row.zone)
    assert zones == sorted(zones, reverse=True)  # from OUTSIDE to OPTIMAL, and never back
    assert not begins_light or set(zones) == {Zone.OPTIMAL}


@pytest.mark.parametrize('sign', [1.0, -1.0])
@pytest.mark.parametrize(('speed', 'still'), [(0.5, False), (below(0.5), True), (0.0, True)])
def test_standstill_on_its_limit(core, speed, still, sign):
    row = judged(core, speed=sign * speed, rcs=1.0)
    assert row.gates == STANDSTILL * still
    assert row.zone == (Zone.UNKNOWN if still else Zone.OUTSIDE)


def test_numbers_that_are_unknown_or_held_shut_no_gate(core):
    held = {'speed_source': HELD, 'axial_load_source': HELD}
    memory = Memory(light=True)
    for row in (
        judged(core, memory, speed=math.nan, axial_load=math.nan),
        judged(core, memory, speed=0.0, axial_load=0.0, **held),
    ):
        assert row.gates == 0
    assert memory.light


@given(st.floats(0.0, 1.0), st.floats(0.0, 1.0))
def test_bands_are_exhaustive(core, rcs, efficiency):
    row = judged(core, rcs=rcs, efficiency=efficiency)
    assert (row.zone == Zone.OUTSIDE) == (rcs >= 0.25 or efficiency < 0.75)
    assert (row.zone == Zone.OPTIMAL) == (rcs < 0.25 and efficiency >= 0.75)


def levels(core, signs, *, level=Level.UNKNOWN, step=STEP, period=0, **limits):
    settings, found = numbers(core, **limits), []
    memory = Memory(level=int(level), level_since=-1)
    for i, (zone, clears) in enumerate(signs):
        before = memory.level
        hold_level(settings, memory, Row(zone=zone, clears=clears, stamp=i * step), GAP, period)
        assert memory.level == before or memory.level_since == i * step
        found.append(Level(memory.level))
    return found


def test_a_level_changes_when_its_delay_is_exactly_over_without_a_break(core):
    assert levels(core, [OUTSIDE] * 51) == [Level.UNKNOWN] * 50 + [Level.WARN]
    assert levels(core, [INSIDE] * 101, level=Level.WARN) == [Level.WARN] * 100 + [Level.OK]
    none = {'raise_delay': 0, 'clear_delay': 0}
    assert levels(core, [OUTSIDE, INSIDE, OUTSIDE], **none) == [Level.WARN, Level.OK, Level.WARN]
    signs = [OUTSIDE] * 50 + [BAND] + [OUTSIDE] * 50
    assert set(levels(core, signs, level=Level.OK)) == {Level.OK}
    assert levels(core, [BAND] * 200, level=Level.WARN)[-1] is Level.WARN
    assert levels(core, [BAND] * 200)[-1] is Level.OK
    found = levels(core, [OUTSIDE, UNKNOWN] * 26, level=Level.OK)
    assert found[-2:] == [Level.WARN, Level.WARN]


@pytest.mark.parametrize('spoiler', [OUTSIDE, BAND, UNKNOWN])
def test_anything_else_starts_the_clearing_over(core, spoiler):
    signs = [INSIDE] * 100 + [spoiler] + [INSIDE] * 100
    assert set(levels(core, signs, level=Level.WARN)) == {Level.WARN}


@pytest.mark.parametrize(
    ('sign', 'step', 'period', 'changes'),
    [
        (OUTSIDE, GAP, 0, True),
        (OUTSIDE, GAP + 1, 0, False),
        (OUTSIDE, 3 * GAP, 3 * GAP, True),  # the period of a slow input
        (OUTSIDE, 3 * GAP + 1, 3 * GAP, False),
        (INSIDE, GAP, 0, True),
        (INSIDE, GAP + 1, 0, False),
        (INSIDE, 3 * GAP, 3 * GAP, False),
    ],
)
def test_a_hole_starts_over(core, sign, step, period, changes):
    before = Level.OK if sign is OUTSIDE else Level.WARN
    delays = {'raise_delay': step, 'clear_delay': step}
    found = levels(core, [sign] * 2, level=before, step=step, period=period, **delays)
    assert (found[-1] is not before) is changes


signs = st.lists(st.sampled_from([OUTSIDE, INSIDE, BAND, UNKNOWN]), max_size=300)


@given(signs)
def test_an_unknown_changes_no_level_and_no_level_becomes_unknown(core, signs):
    before = Level.UNKNOWN
    for sign, level in zip(signs, levels(core, signs), strict=True):
        if level is not before:
            assert level is {2: Level.WARN, 1: Level.OK}[sign[0]]
        before = level


@given(
    st.lists(st.sampled_from([INSIDE, INSIDE, INSIDE, BAND]), max_size=300),
    st.sets(st.integers(0, 299), max_size=3),
)
def test_making_samples_unknown_never_clears_a_warning_sooner(core, signs, holes):
    spoiled = [UNKNOWN if i in holes else sign for i, sign in enumerate(signs)]
    whole = levels(core, signs, level=Level.WARN)
    for good, bad in zip(whole, levels(core, spoiled, level=Level.WARN), strict=True):
        assert not (bad is Level.OK and good is Level.WARN)


rows = st.builds(
    Row,
    validity=st.just(1),
    speed=st.floats(1.0, 50.0),
    axial_load=st.sampled_from([-1000.0, 1000.0, 100.0, 300.0]),
    temperature=st.floats(290.0, 340.0),
    direction=st.sampled_from([1, 2]),
    derived=st.sampled_from([0, 3]),
    rcs=st.sampled_from([0.0, 0.25, 0.5, 0.75]),
    efficiency=st.sampled_from([0.25, 0.5, 0.75, 0.9]),
)


@given(st.lists(rows, max_size=40), st.sampled_from([0, 2]), st.sampled_from([0, 2]))
def test_an_excursion_keeps_one_sample_as_its_worst(core, rows, raise_delay, clear_delay):
    """Value, limit and place are of one row outside between begin and end, and none is worse."""
    settings, memory = numbers(core, raise_delay=raise_delay, clear_delay=clear_delay), Memory()
    asked, begun = core.monitor().settings, []
    for stamp, row in enumerate(rows, 1):
        row.stamp, before = stamp, memory.level
        shut_gates(settings, memory, row)
        set_zone(settings, row)
        hold_level(settings, memory, row, GAP, 0)
        follow_excursion(settings, memory, row, before)
        changed = memory.level != before
        assert (row.edge == records.EVENT_BEGINS) == (changed and memory.level == Level.WARN)
        assert (row.edge == records.EVENT_ENDS) == (changed and before == Level.WARN)
        assert memory.event_active == (memory.level == Level.WARN)
        if row.edge == records.EVENT_BEGINS:
            start = memory.event_start[ACTIVE]
            assert start == memory.raising_start
            begun = [one for one in rows[:stamp] if one.stamp >= start]
        elif memory.event_active:
            begun.append(row)
        if not memory.event_active:
            continue
        high = memory.event_code[ACTIVE] == Code.RCS_HIGH
        outside = [
            one
            for one in begun
            if one.zone == Zone.OUTSIDE
            and (one.rcs >= 0.25 if high else one.efficiency < 0.75 and one.gates == 0)
        ]
        value = (lambda one: one.rcs) if high else (lambda one: one.efficiency)
        worst = (max if high else min)(outside, key=value)
        assert memory.event_worst[ACTIVE] == value(worst)
        limit = asked.limits.rcs if high else asked.limits.efficiency
        assert memory.event_limit[ACTIVE] == limit
        assert memory.event_derived[ACTIVE] == bool(worst.derived)
        names = {'load': 'axial_load', 'speed': 'speed', 'temperature': 'temperature'}
        for name, column in (names | {'direction': 'direction'}).items():
            assert getattr(memory, f'event_{name}')[ACTIVE] == getattr(worst, column)


def test_gates_are_the_bits_of_a_row():
    assert (1 << (Gate.STANDSTILL - 1), 1 << (Gate.LIGHT_LOAD - 1)) == (STANDSTILL, LIGHT_LOAD)


BEGIN = 1000 * SECOND


def row(stamp=0, **changes):
    values = {'speed': 10.0, 'axial_load': -1000.0, 'rcs': 0.0, 'efficiency': 0.9, 'zone': 1}
    values |= {'validity': 1, 'film_ratio': 3.0, 'friction_torque': 0.125, 'regime': 3}
    return Row(**(values | {'stamp': BEGIN + stamp} | changes))


def totals(since=0, **known):
    """Return totals, zero unless known."""
    sums = {'angle': 0.0, 'energy_lost': 0.0, 'since': since}
    return total_times(Memory()) | sums | known


def totals_of(memory):
    sums = {name: getattr(memory, name) for name in ('angle', 'energy_lost', 'since')}
    return total_times(memory) | sums


def add_up(*rows, memory=None):
    memory = memory or Memory()
    for one in rows:
        add_to_totals(memory, one, GAP)
    return totals_of(memory)


def window_of(memory):
    window = WindowStatistics()
    fill_window(window, memory)
    return window


def test_a_window_holds_what_was_judged_until_it_was_told():
    memory = Memory()
    assert window_of(memory).count == 0
    assert math.isnan(window_of(memory).speed_min)
    for one in (row(speed=10.0, rcs=0.01), row(speed=-30.0, rcs=0.09), row(speed=20.0)):
        add_to_window(memory, one)
    add_to_window(memory, row(speed=0.2, zone=0, gates=STANDSTILL))
    clear_window(memory)
    window = window_of(memory)
    assert window.count == 3
    assert (window.speed_min, window.speed_mean, window.speed_max) == (-30.0, 0.0, 20.0)
    assert window.rcs_max == 0.09
    assert (window.efficiency_min, window.efficiency_max) == (0.9, 0.9)
    assert window.efficiency_mean == pytest.approx(0.9)
    memory.window_told = True
    clear_window(memory)
    assert window_of(memory).count == 0
    assert math.isnan(window_of(memory).speed_min)


def test_efficiency_counts_only_where_it_was_judged():
    memory = Memory()
    add_to_window(memory, row(gates=LIGHT_LOAD, efficiency=0.01))
    window = window_of(memory)
    assert window.count == 1
    assert math.isnan(window.efficiency_mean)
    assert window.film_ratio_mean == 3.0


def test_each_sample_lasts_until_the_next():
    added = add_up(
        row(speed=TURN, zone=2, regime=1), row(GAP, speed=-2.0 * TURN, regime=2), row(2 * GAP)
    )
    assert added == totals(
        running_time=2 * GAP,
        boundary_time=GAP,
        outside_time=GAP,
        mixed_time=GAP,
        optimal_time=GAP,
        angle=1.5 * TURN,
        energy_lost=pytest.approx(1.5 * TURN * 0.125),
        since=BEGIN,
    )


def test_what_adds_nothing_is_not_judged_or_is_reset():
    nothing = totals(since=BEGIN)
    assert add_up(row(), row(GAP + 1)) == nothing
    assert add_up(row(speed=0.2, gates=STANDSTILL), row(GAP)) == nothing
    assert add_up(row(), row(-1)) == nothing
    unjudged = {'running_time': GAP, 'unjudged_time': GAP, 'angle': 75.0}
    added = add_up(row(speed=150.0, validity=3, zone=0, regime=0), row(GAP))
    assert added == nothing | unjudged
    memory = Memory()
    add_up(row(), row(GAP), memory=memory)
    clear_totals(memory)
    assert totals_of(memory) == totals()
    added = add_up(row(2 * GAP), memory=memory)
    assert (added['running_time'], added['since']) == (GAP, BEGIN + 2 * GAP)


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
            before = totals_of(other)
            other = AxisRecord.of('x', other, NOT_ENDED, NOT_SHELVED, 0).read_memory()
            assert totals_of(other) == before
            memory.moment = False  # as a restart does
    assert totals_of(other) == totals_of(memory)
    judged = memory.running_time - memory.unjudged_time
    assert judged == sum(memory.zone_time) == sum(memory.regime_time)
    assert memory.zone_time[0] == memory.regime_time[0] == 0
    assert 0 <= memory.running_time <= stamp
