# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The status of an input: freshness, rate, lag, losses, and what else its topic carries."""

import math

from ballscrew_monitor.core.conversions import SECOND
from ballscrew_monitor.core.fields import OtherJoints
from ballscrew_monitor.core.input_status import InputState, LOSS_SHOWN, MOST_OTHERS, Tracker
from ballscrew_monitor.core.inputs import InputSample, Refusal, Source, StampSource, Why
from ballscrew_msgs.msg import InputHealth


def tracker(**changes):
    return Tracker(Source.LOAD, **({'configured': True, 'timeout': 10} | changes))


def sample(stamp, **changes):
    return InputSample(source=Source.LOAD, value=1.0, stamp=stamp, **changes)


def refusal(why=Why.NOT_A_NUMBER):
    return Refusal(source=Source.LOAD, why=why, text='because')


def test_a_sample_exactly_as_old_as_the_timeout_is_good():
    load = tracker()
    load.accept(sample(100))
    assert load.state(110) is InputState.OK
    assert load.state(111) is InputState.STALE
    assert load.status(111).age == 11e-9


def test_a_sample_newer_than_the_judged_instant_has_no_negative_age():
    load = tracker()
    load.accept(sample(100))
    assert load.status(90).age == 0.0


def test_an_input_begins_missing_and_goes_bad_until_the_next_good_sample():
    load = tracker()
    assert load.state(0) is InputState.MISSING
    assert math.isnan(load.status(0).age)
    load.refuse(refusal())
    assert load.state(0) is InputState.BAD
    assert (load.status(0).why, load.status(0).refusal) == (Why.NOT_A_NUMBER, 'because')
    load.accept(sample(1))
    assert load.state(1) is InputState.OK
    assert (load.received, load.dropped) == (2, 1)


def test_messages_about_other_joints_are_counted_but_do_no_harm():
    load = tracker()
    load.accept(sample(1))
    load.drop()
    assert load.state(1) is InputState.OK
    assert (load.received, load.dropped) == (2, 1)


def test_an_input_without_a_topic_says_so():
    assert tracker(configured=False).state(0) is InputState.NOT_CONFIGURED


def test_rate_is_the_mean_over_the_last_samples():
    load = tracker()
    assert math.isnan(load.status(0).rate)
    for i in range(100):
        load.accept(sample(i * SECOND // 50))
    assert load.status(2 * SECOND).rate == 50.0
    load.forget()
    assert math.isnan(load.status(0).rate)


def test_states_have_the_numbers_of_the_messages():
    for member in InputState:
        assert getattr(InputHealth, f'STATE_{member.name}') == member


def test_how_fresh_an_input_is_counts_from_its_arrival():
    load = tracker()
    load.accept(sample(100, arrival=700))
    assert load.state(710) is InputState.OK
    assert load.state(711) is InputState.STALE
    assert load.status(711).age == 11e-9


def test_the_lag_is_the_least_of_the_last_samples():
    load = tracker(max_lag=600)
    assert math.isnan(load.lag)
    for stamp, arrival in ((100, 900), (200, 800), (300, 1200)):
        load.accept(sample(stamp, arrival=arrival))
    assert load.lag == 600e-9
    assert not load.lagging
    load = tracker(max_lag=599)
    load.accept(sample(200, arrival=800))
    assert load.status(800).lagging


def test_stamps_of_reception_have_no_lag():
    load = tracker(max_lag=1)
    load.accept(sample(100, arrival=100, stamp_source=StampSource.RECEIVE))
    assert math.isnan(load.status(100).lag)
    assert not load.lagging


def test_what_arrived_in_the_future_of_a_clock_that_was_set_back_has_arrived_now():
    load = tracker()
    load.accept(sample(1000))
    load.rebase(500)
    assert load.state(510) is InputState.OK
    assert load.state(511) is InputState.STALE


def test_losses_add_up_and_are_shown_for_a_while():
    load = tracker()
    load.lose(0, SECOND)
    assert (load.status(SECOND).lost, load.status(SECOND).losing) == (0, False)
    load.lose(3, 2 * SECOND)
    load.lose(4, 3 * SECOND)
    assert load.status(3 * SECOND).lost == 7
    assert load.status(3 * SECOND + LOSS_SHOWN - 1).losing
    assert not load.status(3 * SECOND + LOSS_SHOWN).losing


def test_a_loss_that_cannot_be_known_is_unknown_and_keeps_what_was_counted():
    load = tracker()
    load.lose(3, SECOND)
    load.lose(None, SECOND)
    assert load.status(SECOND).lost is None
    load.lose(0, SECOND)
    assert load.status(SECOND).lost == 3


def others(*names):
    return OtherJoints('velocity', 'x', names)


def test_joints_of_messages_about_others_are_collected_until_a_sample_comes():
    load = tracker()
    assert load.status(0).joints is None
    for names in (('c', 'a'), ('b',), ('c', 'a')):
        load.drop(others(*names))
    assert load.status(0).joints == others('a', 'b', 'c')
    load.accept(sample(1))
    assert load.status(1).joints is None


def test_of_joints_without_end_a_part_is_kept():
    load = tracker()
    for i in range(3 * MOST_OTHERS):
        load.drop(others(f'joint{i}'))
    assert len(load.status(0).joints.names) == MOST_OTHERS


def test_a_slow_input_tells_its_longest_gap():
    load = tracker(timeout=SECOND)
    for stamp in (1, 2, 4):
        load.accept(sample(stamp * SECOND))
    assert math.isnan(load.status(0).longest_gap)  # one gap is an interruption
    load.accept(sample(7 * SECOND))
    load.accept(sample(9 * SECOND))
    assert load.status(0).longest_gap == 3.0
    load.accept(sample(10 * SECOND))
    assert not load.status(0).slow
