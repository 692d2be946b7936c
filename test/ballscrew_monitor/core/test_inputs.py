# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Field paths, stamps and refusals."""

import math

from ballscrew_monitor.core import inputs
from ballscrew_monitor.core.conversions import Scaling, SECOND
from ballscrew_monitor.core.fields import OtherJoints
from ballscrew_monitor.core.inputs import InputSample, Refusal, Source, StampSource, Why
import pytest
from sensor_msgs.msg import JointState
from std_msgs.msg import Float64

NOW = 100 * SECOND


def joints(*names, velocity=(), stamp=0):
    message = JointState(name=list(names), velocity=list(velocity))
    message.header.stamp.sec, message.header.stamp.nanosec = divmod(stamp, SECOND)
    return message


def speed_input(*, type_name='sensor_msgs/msg/JointState', **changes):
    values = {
        'source': Source.SPEED,
        'topic': 'joint_states',
        'field': 'velocity[x_axis]',
        'scaling': Scaling(factor=1.0, shift=0.0),
    }
    return inputs.OpenInput(**(values | changes)).close(type_name)


def text_of(refusal, field='velocity[x_axis]'):
    """Return what is said of a refusal."""
    numbers = refusal.first, refusal.second
    return inputs.refusal_text(refusal.source, refusal.why, *numbers, most=math.inf, field=field)


def test_a_header_stamp_is_the_stamp_and_without_one_the_time_of_reception_counts():
    sample = speed_input().read(
        joints('x_axis', velocity=[3.0], stamp=NOW - 5), now=NOW, max_future=0
    )
    assert sample == InputSample(
        source=Source.SPEED, value=3.0, stamp=NOW - 5, stamp_source=StampSource.HEADER, arrival=NOW
    )
    unstamped = speed_input(type_name='std_msgs/msg/Float64', field='data')
    for sample in (
        speed_input().read(joints('x_axis', velocity=[3.0]), now=NOW, max_future=0),
        unstamped.read(Float64(data=3.0), now=NOW, max_future=0),
    ):
        assert (sample.stamp, sample.stamp_source) == (NOW, StampSource.RECEIVE)


def test_a_stamp_as_far_ahead_as_allowed_is_taken_and_any_before_a_clock_starts():
    speed = speed_input()
    limit = joints('x_axis', velocity=[3.0], stamp=NOW + 7)
    beyond = joints('x_axis', velocity=[3.0], stamp=NOW + 8)
    assert isinstance(speed.read(limit, now=NOW, max_future=7), InputSample)
    refusal = speed.read(beyond, now=NOW, max_future=7)
    assert (refusal.source, refusal.why, refusal.arrival) == (Source.SPEED, Why.FUTURE, NOW)
    message = joints('x_axis', velocity=[3.0], stamp=NOW)
    sample = speed_input().read(message, now=0, max_future=0)
    assert (sample.stamp, sample.arrival) == (NOW, NOW)


@pytest.mark.parametrize(
    ('ahead', 'why', 'words'),
    [
        (
            2 * SECOND,
            Why.FUTURE,
            ['2 s ahead of the clock', 'max_future, 0.5 s', 'set the clocks'],
        ),
        (inputs.YEAR, Why.FUTURE, ['ahead of the clock']),
        (
            inputs.YEAR + 1,
            Why.OTHER_CLOCK,
            [
                'more than a year ahead',
                'set the clock of its machine',
                'set use_sim_time to false',
            ],
        ),
    ],
)
def test_a_refused_stamp_says_what_mends_it(ahead, why, words):
    message = joints('x_axis', velocity=[3.0], stamp=SECOND + ahead)
    refusal = speed_input().read(message, now=SECOND, max_future=SECOND // 2)
    assert refusal.why is why
    assert all(word in text_of(refusal) for word in words)


@pytest.mark.parametrize('now', [0, NOW])
def test_a_negative_stamp_is_refused(now, says):
    message = joints('x_axis', velocity=[3.0], stamp=-1)
    refusal = speed_input().read(message, now=now, max_future=0)
    assert isinstance(refusal, Refusal)
    assert (refusal.why, refusal.arrival) == (Why.NEGATIVE, now)
    assert text_of(refusal) == says('stamp_negative_mend')


@pytest.mark.parametrize('bad', [math.nan, math.inf, -math.inf])
def test_what_is_not_a_number_is_refused(bad, says):
    refusal = speed_input().read(joints('x_axis', velocity=[bad]), now=NOW, max_future=0)
    assert (refusal.source, refusal.why) == (Source.SPEED, Why.NOT_A_NUMBER)
    assert text_of(refusal) == says('field_holds_finite', bad=bad)


@pytest.mark.parametrize(
    ('field', 'velocity', 'text'),
    [
        ('velocity[x_axis]', [], 'velocity_empty_messages'),
        ('velocity[1]', [3.0], 'velocity_has_1'),
    ],
)
def test_an_array_that_ends_too_soon_is_refused(field, velocity, text, says):
    message = joints('x_axis', velocity=velocity)
    refusal = speed_input(field=field).read(message, now=NOW, max_future=0)
    assert (refusal.why, refusal.arrival) == (Why.TOO_SHORT, NOW)
    assert text_of(refusal, field).startswith(says(text))


def test_a_message_about_other_joints_is_refused_as_such():
    message = joints('y_axis', velocity=[1.0])
    refusal = speed_input().read(message, now=NOW, max_future=0, lost=3)
    assert refusal == Refusal(
        source=Source.SPEED,
        why=Why.OTHER_JOINTS,
        joints=OtherJoints('velocity', 'x_axis', ('y_axis',)),
        arrival=NOW,
        lost=3,
    )


def test_the_value_is_scaled_and_an_open_input_is_closed_by_a_type(refused):
    speed = speed_input(scaling=Scaling(factor=2.0, shift=1.0))
    assert speed.read(joints('x_axis', velocity=[3.0]), now=NOW, max_future=0).value == 7.0
    opened = inputs.OpenInput(
        source=Source.SPEED, topic='speed', field='data', scaling=Scaling(factor=2.0, shift=0.0)
    )
    closed = opened.close('std_msgs/msg/Float64')
    assert closed.read(Float64(data=3.0), now=NOW, max_future=0).value == 6.0
    refused('jointstate_has_field', opened.close, 'sensor_msgs/msg/JointState')


def test_of_equal_stamps_the_speed_is_last_and_all_else_stays_in_order():
    """Whatever order a burst arrived in, also across a clock that was set back."""

    def event(source, stamp):
        return ('x', InputSample(source=source, value=1.0, stamp=stamp))

    speed, load, heat = Source.SPEED, Source.LOAD, Source.TEMPERATURE
    came = [(speed, 50), (load, 40), (speed, 60), (load, 60), (heat, 60), (speed, 1), (load, 1)]
    taken = [(one.source, one.stamp) for _, one in inputs.ordered([event(*pair) for pair in came])]
    assert taken == [
        (speed, 50),
        (load, 40),
        (heat, 60),
        (load, 60),
        (speed, 60),
        (load, 1),
        (speed, 1),
    ]
