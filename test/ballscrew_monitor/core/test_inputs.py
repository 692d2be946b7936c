# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Field paths, stamps, refusals and the health of an input."""

import math

from ballscrew_monitor.core.conversions import Scaling, SECOND
from ballscrew_monitor.core.inputs import (
    InputSample,
    InputState,
    LOSS_SHOWN,
    make_input,
    Refusal,
    Source,
    StampSource,
    Tracker,
    Why,
    YEAR,
)
from ballscrew_msgs.msg import InputHealth
import pytest
from sensor_msgs.msg import JointState
from std_msgs.msg import Float64

NOW = 100 * SECOND


def joints(*names, velocity=(), stamp=0):
    message = JointState(name=list(names), velocity=list(velocity))
    message.header.stamp.sec, message.header.stamp.nanosec = divmod(stamp, SECOND)
    return message


def speed_input(**changes):
    values = {
        'topic': 'joint_states',
        'type_name': 'sensor_msgs/msg/JointState',
        'field': 'velocity[x_axis]',
        'scaling': Scaling(factor=1.0, shift=0.0),
    }
    return make_input(Source.SPEED, **(values | changes))


def test_a_header_stamp_is_the_stamp():
    sample = speed_input().read(
        joints('x_axis', velocity=[3.0], stamp=NOW - 5), now=NOW, max_future=0
    )
    assert sample == InputSample(
        source=Source.SPEED, value=3.0, stamp=NOW - 5, stamp_source=StampSource.HEADER, arrival=NOW
    )


def test_without_a_stamp_the_time_of_reception_counts():
    unstamped = speed_input(type_name='std_msgs/msg/Float64', field='data')
    for sample in (
        speed_input().read(joints('x_axis', velocity=[3.0]), now=NOW, max_future=0),
        unstamped.read(Float64(data=3.0), now=NOW, max_future=0),
    ):
        assert (sample.stamp, sample.stamp_source) == (NOW, StampSource.RECEIVE)


def test_a_stamp_exactly_as_far_ahead_as_allowed_is_taken():
    speed = speed_input()
    limit = joints('x_axis', velocity=[3.0], stamp=NOW + 7)
    beyond = joints('x_axis', velocity=[3.0], stamp=NOW + 8)
    assert isinstance(speed.read(limit, now=NOW, max_future=7), InputSample)
    refusal = speed.read(beyond, now=NOW, max_future=7)
    assert (refusal.source, refusal.why, refusal.arrival) == (Source.SPEED, Why.FUTURE, NOW)


@pytest.mark.parametrize(
    ('ahead', 'why', 'words'),
    [
        (
            2 * SECOND,
            Why.FUTURE,
            ['2 s ahead of the clock', 'max_future, 0.5 s', 'set the clocks'],
        ),
        (YEAR, Why.FUTURE, ['ahead of the clock']),
        (YEAR + 1, Why.OTHER_CLOCK, ['wall clock', 'simulated time', 'set use_sim_time to false']),
    ],
)
def test_a_refused_stamp_says_what_mends_it(ahead, why, words):
    message = joints('x_axis', velocity=[3.0], stamp=SECOND + ahead)
    refusal = speed_input().read(message, now=SECOND, max_future=SECOND // 2)
    assert refusal.why is why
    assert all(word in refusal.text for word in words)


def test_a_clock_that_has_not_started_refuses_no_stamp_and_times_nothing():
    message = joints('x_axis', velocity=[3.0], stamp=NOW)
    sample = speed_input().read(message, now=0, max_future=0)
    assert (sample.stamp, sample.arrival) == (NOW, NOW)


@pytest.mark.parametrize('bad', [math.nan, math.inf, -math.inf])
def test_what_is_not_a_number_is_refused(bad):
    refusal = speed_input().read(joints('x_axis', velocity=[bad]), now=NOW, max_future=0)
    assert (refusal.source, refusal.why) == (Source.SPEED, Why.NOT_A_NUMBER)
    assert refusal.text == f'the field holds {bad}, it must be a finite number'


def test_a_message_about_other_joints_is_refused_as_such():
    message = joints('y_axis', velocity=[1.0])
    refusal = speed_input().read(message, now=NOW, max_future=0, lost=3)
    assert refusal == Refusal(source=Source.SPEED, why=Why.OTHER_JOINTS, arrival=NOW, lost=3)


def test_the_value_is_scaled():
    speed = speed_input(scaling=Scaling(factor=2.0, shift=1.0))
    assert speed.read(joints('x_axis', velocity=[3.0]), now=NOW, max_future=0).value == 7.0


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
    assert load.health(111).age == 11e-9


def test_a_sample_newer_than_the_judged_instant_has_no_negative_age():
    load = tracker()
    load.accept(sample(100))
    assert load.health(90).age == 0.0


def test_an_input_begins_missing_and_goes_bad_until_the_next_good_sample():
    load = tracker()
    assert load.state(0) is InputState.MISSING
    assert math.isnan(load.health(0).age)
    load.refuse(refusal())
    assert load.state(0) is InputState.BAD
    assert (load.health(0).why, load.health(0).refusal) == (Why.NOT_A_NUMBER, 'because')
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
    assert math.isnan(load.health(0).rate)
    for i in range(100):
        load.accept(sample(i * SECOND // 50))
    assert load.health(2 * SECOND).rate == 50.0
    load.forget()
    assert math.isnan(load.health(0).rate)


@pytest.mark.parametrize(
    ('enumeration', 'prefix'), [(InputState, 'STATE_'), (StampSource, 'STAMP_')]
)
def test_enumerations_have_the_numbers_of_the_messages(enumeration, prefix):
    for member in enumeration:
        assert getattr(InputHealth, f'{prefix}{member.name}') == member


def test_how_fresh_an_input_is_counts_from_its_arrival():
    load = tracker()
    load.accept(sample(100, arrival=700))
    assert load.state(710) is InputState.OK
    assert load.state(711) is InputState.STALE
    assert load.health(711).age == 11e-9


def test_the_lag_is_the_least_of_the_last_samples():
    load = tracker(max_lag=600)
    assert math.isnan(load.lag)
    for stamp, arrival in ((100, 900), (200, 800), (300, 1200)):
        load.accept(sample(stamp, arrival=arrival))
    assert load.lag == 600e-9
    assert not load.lagging
    load = tracker(max_lag=599)
    load.accept(sample(200, arrival=800))
    assert load.health(800).lagging


def test_stamps_of_reception_have_no_lag():
    load = tracker(max_lag=1)
    load.accept(sample(100, arrival=100, stamp_source=StampSource.RECEIVE))
    assert math.isnan(load.health(100).lag)
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
    assert (load.health(SECOND).lost, load.health(SECOND).losing) == (0, False)
    load.lose(3, 2 * SECOND)
    load.lose(4, 3 * SECOND)
    assert load.health(3 * SECOND).lost == 7
    assert load.health(3 * SECOND + LOSS_SHOWN - 1).losing
    assert not load.health(3 * SECOND + LOSS_SHOWN).losing


def test_a_loss_that_cannot_be_known_is_unknown_and_keeps_what_was_counted():
    load = tracker()
    load.lose(3, SECOND)
    load.lose(None, SECOND)
    assert load.health(SECOND).lost is None
    load.lose(0, SECOND)
    assert load.health(SECOND).lost == 3
