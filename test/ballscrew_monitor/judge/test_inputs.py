# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Quality of an input: freshness, rate, lag, losses, refusals."""

import dataclasses
import math

from ballscrew_monitor.core.conversions import SECOND
from ballscrew_monitor.core.inputs import InputState, Source, StampSource, Why
from ballscrew_monitor.core.judgement import PointSource
from ballscrew_monitor.judge import inputs
from ballscrew_monitor.judge.records import (
    Event,
    INPUTS,
    Memory,
    RATE_SAMPLES,
    Settings,
    SHOWN,
    WHYS,
)
from ballscrew_monitor.judge.views import input_status_of, refused_of
from hypothesis import given
from hypothesis import strategies as st
import pytest

LOAD = int(Source.LOAD)


class Input:
    """The load of one axis."""

    def __init__(self, timeout=10, max_lag=10**9, configured=1):
        self.memory = Memory()
        self.settings = Settings(timeout=[timeout] * INPUTS, max_lag=max_lag)
        self.settings.configured = [configured] * INPUTS

    def accept(self, stamp, arrival=None, stamp_source=StampSource.HEADER):
        arrival = stamp if arrival is None else arrival
        event = Event(source=LOAD, stamp=stamp, arrival=arrival, stamp_source=stamp_source)
        inputs.accept(self.memory, self.settings, event, 1.0)

    def refuse(self, why, first=math.nan, second=math.nan, arrival=SECOND):
        event = Event(source=LOAD, why=why, first=first, second=second, arrival=arrival)
        inputs.take_refusal(self.memory, event)

    def lose(self, count, arrival):
        inputs.lose(self.memory, LOAD, count, arrival)

    def status(self, now=0):
        return input_status_of(self.memory, self.settings, Source.LOAD, now, 'force[1]')


@pytest.mark.parametrize('arrival', [100, 700])
def test_a_sample_that_arrived_exactly_the_timeout_ago_is_good(arrival):
    load = Input()
    load.accept(100, arrival)
    assert load.status(arrival + 10).state is InputState.OK
    stale = load.status(arrival + 11)
    assert (stale.state, stale.age) == (InputState.STALE, 11e-9)
    assert load.status(arrival - 10).age == 0.0


def test_an_input_begins_missing_and_is_bad_until_the_next_good_sample():
    load = Input()
    missing = load.status()
    assert missing.state is InputState.MISSING
    assert math.isnan(missing.age + missing.rate + missing.lag)
    load.refuse(Why.TOO_SHORT, first=1.0, second=0.0)
    bad = load.status()
    assert (bad.state, bad.why) == (InputState.BAD, Why.TOO_SHORT)
    assert bad.refusal.startswith('force has 1 elements and no [1] in its messages')
    load.accept(1)
    good = load.status(1)
    assert (good.state, good.why, good.refusal) == (InputState.OK, None, '')
    assert (good.received, good.dropped) == (2, 1)
    load.accept(1)
    assert math.isnan(load.status(1).rate)  # two samples of one stamp
    assert refused_of(load.memory)[Source.LOAD] == {Why.TOO_SHORT: 1}


def test_messages_about_other_joints_and_inputs_without_a_topic_do_no_harm():
    load = Input()
    load.accept(1)
    load.refuse(Why.OTHER_JOINTS)
    status = load.status(1)
    assert (status.state, status.received, status.dropped) == (InputState.OK, 2, 1)
    assert refused_of(load.memory)[Source.LOAD] == {}
    assert Input(configured=0).status().state is InputState.NOT_CONFIGURED


@given(st.integers(2, 70))
def test_rate_is_the_mean_over_the_last_samples(count):
    load = Input()
    for i in range(count):  # the spacing doubles where the last samples begin
        load.accept((i if i < count - RATE_SAMPLES else 2 * i) * SECOND // 64)
    assert load.status().rate == 32.0
    inputs.forget(load.memory, LOAD)
    assert math.isnan(load.status().rate)


def test_what_is_forgotten_is_as_at_the_beginning_and_the_counts_stay():
    load = Input(timeout=1, max_lag=0)
    for stamp in (1, 2, 40, 80, 160):
        load.accept(stamp, stamp + 1)
    load.refuse(Why.OTHER_JOINTS)
    load.refuse(Why.NOT_A_NUMBER)
    inputs.forget(load.memory, LOAD)
    fresh = Memory()
    for name in ('known', 'refusal', 'stamps_taken', 'lags_taken', 'long_gaps', 'others'):
        assert getattr(load.memory, name)[LOAD] == getattr(fresh, name)[LOAD], name
    assert (load.memory.received[LOAD], load.memory.dropped[LOAD]) == (7, 2)


def changed(memory):
    """Return what a memory has at the load that a fresh one has not."""
    one, fresh, found = dataclasses.asdict(memory), dataclasses.asdict(Memory()), {}
    for name, values in one.items():
        if repr(values) != repr(fresh[name]):
            begin = LOAD * len(values) // INPUTS
            end = begin + len(values) // INPUTS
            found[name] = values[begin:end]
            assert [*values[:begin], *values[end:]] == [*fresh[name][:begin], *fresh[name][end:]]
    return found


def test_a_message_changes_what_it_says_and_nothing_else():
    ring = [0] * RATE_SAMPLES
    load = Input()
    load.accept(7, 9)
    first = {'received': [1], 'known': [1], 'value': [1.0], 'stamp_source': [1]}
    first |= {'sample_stamp': [7], 'arrival': [9], 'stamps_taken': [1], 'lags_taken': [1]}
    first |= {'stamps': [7, *ring[1:]], 'lags': [2, *ring[1:]], 'span_taken': [1]}
    assert changed(load.memory) == first
    load.accept(10, 0)  # no arrival, no lag
    second = {'received': [2], 'sample_stamp': [10], 'last_gap': [3], 'stamps_taken': [2]}
    second |= {'stamps': [7, 10, *ring[2:]], 'arrival': [0], 'span_taken': [2]}
    second = first | second
    del second['arrival']
    assert changed(load.memory) == second
    load = Input()
    why, last = [0] * WHYS, [-SHOWN] * WHYS
    why[Why.IMPLAUSIBLE], last[Why.IMPLAUSIBLE] = 1, SECOND
    load.refuse(Why.IMPLAUSIBLE, 5.0)
    assert changed(load.memory) == {
        'received': [1],
        'dropped': [1],
        'refused': why,
        'refusal': [Why.IMPLAUSIBLE],
        'refusal_first': [5.0],
        'refused_last': last,
        'span_taken': [1],
        'span_refused': [1],
    }
    load = Input()
    load.refuse(Why.OTHER_JOINTS, 5.0)
    assert changed(load.memory) == {'received': [1], 'dropped': [1], 'others': [1]}
    load.lose(-1, SECOND)
    assert changed(load.memory) == {
        'received': [1],
        'dropped': [1],
        'others': [1],
        'lost_known': [0],
    }


@pytest.mark.parametrize(('stamp', 'ahead'), [(99, True), (100, False), (101, False)])
def test_a_sample_is_ahead_of_an_earlier_stamp_until_it_is_forgotten(stamp, ahead):
    load = Input()
    load.accept(100)
    assert inputs.is_ahead(load.memory, LOAD, stamp) is ahead
    inputs.forget(load.memory, LOAD)
    assert not inputs.is_ahead(load.memory, LOAD, stamp)


@pytest.mark.parametrize(
    ('configured', 'known', 'now', 'expected'),
    [
        (0, True, 10, (PointSource.UNKNOWN, PointSource.DEFAULT)),
        (1, False, 10, (PointSource.UNKNOWN, PointSource.UNKNOWN)),
        (1, True, 10, (PointSource.MEASURED, PointSource.MEASURED)),
        (1, True, 11, (PointSource.HELD, PointSource.HELD)),
    ],
)
def test_the_source_of_a_value_follows_from_topic_sample_and_age(configured, known, now, expected):
    load = Input(configured=configured)
    if known:
        for source in (LOAD, Source.TEMPERATURE):
            event = Event(source=int(source), stamp=0, arrival=0)
            inputs.accept(load.memory, load.settings, event, 1.0)
    found = [
        inputs.standing_of(load.memory, load.settings, int(source), now)
        for source in (LOAD, Source.TEMPERATURE)
    ]
    assert found == list(expected)


@given(st.lists(st.integers(-1000, 1000), min_size=1, max_size=70))
def test_the_lag_is_the_least_of_the_last_samples(lags):
    load = Input(max_lag=0)
    for lag in lags:
        load.accept(10_000, 10_000 + lag)
    least = min(lags[-RATE_SAMPLES:])
    assert load.status().lag == least / SECOND
    assert load.status().lagging is (least > 0)


def test_stamps_of_reception_have_no_lag_and_those_of_the_future_arrived_now():
    load = Input(max_lag=1)
    load.accept(100, 200, StampSource.RECEIVE)
    assert math.isnan(load.status(100).lag)
    assert not load.status(100).lagging
    load = Input()
    load.accept(1000)
    inputs.rebase(load.memory, 500)
    assert load.status(510).state is InputState.OK
    assert load.status(511).state is InputState.STALE


def test_losses_add_up_are_shown_for_a_while_and_may_be_unknown():
    load = Input()
    load.lose(0, SECOND)
    assert (load.status(SECOND).lost, load.status(SECOND).losing) == (0, False)
    load.lose(3, 2 * SECOND)
    load.lose(4, 3 * SECOND)
    assert load.status(3 * SECOND).lost == 7
    assert load.status(3 * SECOND + SHOWN - 1).losing
    assert not load.status(3 * SECOND + SHOWN).losing
    load = Input()
    for count, told in ((3, 3), (-1, None), (0, 3)):
        load.lose(count, SECOND)
        assert load.status(SECOND).lost == told


def test_implausible_samples_are_told_with_their_value_and_shown_for_a_while():
    load = Input()
    load.settings.plausible = [5e3] * INPUTS
    load.refuse(Why.IMPLAUSIBLE, 5001.0)
    status = load.status(SECOND)
    assert (status.implausible, status.glitching) == (1, True)
    assert status.refusal.startswith('load 5001 N is beyond the plausible 5000 N: ')
    assert not load.status(SECOND + SHOWN).glitching


def test_a_slow_input_tells_its_longest_gap():
    load = Input(timeout=SECOND)
    gaps = []
    for stamp in (1, 2, 4, 7, 9, 10):
        load.accept(stamp * SECOND)
        status = load.status()
        gaps.append((status.slow, status.longest_gap, inputs.slow_period(load.memory, LOAD)))
    nan = pytest.approx(math.nan, nan_ok=True)
    # One gap is an interruption, two make a slow input.
    slow = [(True, 3.0, 3 * SECOND), (True, 3.0, 2 * SECOND)]
    assert gaps == [*[(False, nan, 0)] * 3, *slow, (False, nan, 0)]


def test_the_share_of_refused_messages_is_that_of_ten_to_twenty_seconds():
    load, shares = Input(), []
    for second in range(1, 61):
        load.accept(second * SECOND)
        if second <= 30:
            load.refuse(Why.FUTURE, arrival=second * SECOND)
        status = load.status(second * SECOND)
        shares.append((Why.FUTURE in status.refusing, status.refused_share))
    assert shares[:30] == [(True, pytest.approx(0.5, abs=0.05))] * 30
    assert shares[38][0]
    assert not shares[39][0]
    assert shares[-1] == (False, 0.0)
