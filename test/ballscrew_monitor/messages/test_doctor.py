# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Facts in, findings out."""

import dataclasses
import math

from ballscrew_monitor.core import conversions
from ballscrew_monitor.core.inputs import InputState, InputStatus, Source
from ballscrew_monitor.core.links import Link, Publisher
from ballscrew_monitor.messages.doctor import findings, Heard, InputFacts, near_topic, Surroundings
import pytest

JOINTS, FLOAT = 'sensor_msgs/msg/JointState', 'std_msgs/msg/Float64'
SPEED_UNITS = ('rad/s', 'rev/min', 'mm/s')
SCALINGS = {
    Source.SPEED: {
        unit: conversions.speed_scaling(unit, scale=1.0, offset=0.0, lead=0.01, handedness='right')
        for unit in SPEED_UNITS
    },
    Source.LOAD: {
        unit: conversions.load_scaling(unit, scale=1.0, offset=0.0)
        for unit in conversions.LOAD_UNITS
    },
    Source.TEMPERATURE: {
        unit: conversions.temperature_scaling(unit, scale=1.0, offset=0.0)
        for unit in conversions.TEMPERATURE_UNITS
    },
}
KNOWN = {
    Source.SPEED: (0.5, 314.0),
    Source.LOAD: (-20e3, 20e3),
    Source.TEMPERATURE: (conversions.kelvin(10.0), conversions.kelvin(80.0)),
}


def around(**changes):
    values = {
        'domain': 0,
        'discovery': 'SUBNET',
        'localhost_only': False,
        'nodes': ('machine',),
        'topics': {'/joint_states': (JOINTS,)},
        'domains': (),
        'use_sim_time': False,
    }
    return Surroundings(**(values | changes))


def heard(low=1.0, high=2.0, gap=0.01, **changes):
    status = {'source': Source.SPEED, 'state': InputState.OK, 'received': 100}
    return Heard(status=InputStatus(**(status | changes)), low=low, high=high, longest_gap=gap)


def facts(source=Source.SPEED, unit='rad/s', **changes):
    values = {
        'axis': 'x',
        'source': source,
        'link': Link(
            topic='/joint_states', type_name=JOINTS, publishers=(Publisher(type_name=JOINTS),)
        ),
        'timeout': 0.5,
        'unit': unit,
        'scalings': SCALINGS[source],
        'known': KNOWN[source],
        'heard': heard(),
    }
    return InputFacts(**(values | changes))


def test_all_is_well_and_without_a_surface_no_unit_is_judged():
    assert findings(around(), [facts()], 3.0) == []
    unknown = facts(heard=heard(0.0, 1e9), known=None, scalings={})
    assert findings(around(), [unknown], 3.0) == []


@pytest.mark.parametrize(
    ('changes', 'cure'),
    [
        ({}, 'start_machine_set'),
        ({'domains': (7, 9)}, 'domain_7_9'),
        ({'discovery': 'OFF'}, 'off_hides_other'),
        ({'localhost_only': True}, 'ros_localhost_only_hides'),
    ],
)
def test_nobody_is_there(changes, cure, says):
    (said,) = findings(around(nodes=(), **changes), [], 3.0)
    assert said.startswith('nobody else is seen in ROS domain 0: ')
    assert says(cure) in said


def test_simulated_time_needs_a_clock(says):
    (said,) = findings(around(use_sim_time=True), [], 3.0)
    assert said.startswith(says('use_sim_time_true_nobody'))
    topics = {'/clock': ('rosgraph_msgs/msg/Clock',)}
    assert findings(around(use_sim_time=True, topics=topics), [], 3.0) == []


@pytest.mark.parametrize(
    ('topic', 'near'),
    [
        ('/cell/joint_states', '/joint_states'),
        ('/joint_state', '/joint_states'),
        ('/velocity', '/joint_states'),
    ],
)
def test_a_topic_that_nobody_publishes_has_a_neighbour(topic, near, says):
    link = Link(topic=topic, type_name=JOINTS)
    assert near_topic(link, around().topics) == near
    (said,) = findings(around(), [facts(link=link, heard=None)], 3.0)
    assert said == says('speed_publisher_yet', topic=topic, near=near, joints=JOINTS)


def test_a_topic_like_no_other_has_none():
    assert near_topic(Link(topic='/velocity', type_name=FLOAT), around().topics) == ''


def test_a_field_that_cannot_be_read_lists_the_numbers_that_can(says):
    broken = facts(heard=None, problem='field is no number', numbers=('data',))
    assert findings(around(), [broken], 3.0) == [says('speed_field_number')]
    broken = facts(heard=None, problem='type is not installed')
    assert findings(around(), [broken], 3.0) == [says('speed_type_installed')]
    other = Link(topic='/t', type_name=JOINTS, publishers=(Publisher(type_name=FLOAT),))
    (said,) = findings(around(), [facts(link=other, heard=None, problem='no number')], 3.0)
    assert 'expected is' in said  # of the right type the field may be well


@pytest.mark.parametrize(
    ('source', 'unit', 'low', 'high', 'cure'),
    [
        (Source.SPEED, 'rad/s', -700.0, 700.0, 'looks_like_rev'),
        (Source.SPEED, 'rad/s', 0.0, 1e6, 'set_speed_scale'),
        (Source.SPEED, 'mm/s', 0.0, 3000.0, 'set_speed_unit'),
        (Source.LOAD, 'kN', -5000.0, -900.0, 'set_load_unit'),
        (Source.TEMPERATURE, 'K', 40.0, 40.0, 'set_temperature_unit'),
        (Source.TEMPERATURE, 'degC', 313.0, 314.0, 'set_temperature'),
    ],
)
def test_numbers_far_outside_look_like_another_unit(source, unit, low, high, cure, says):
    (said,) = findings(around(), [facts(source, unit, heard=heard(low, high))], 3.0)
    assert 'is far outside the surface' in said
    assert says(cure) in said


@pytest.mark.parametrize(('high', 'count'), [(1.5 * 314.0, 0), (math.nextafter(471.0, 1e3), 1)])
def test_the_limit_of_what_is_plausible_belongs_to_it(high, count):
    assert len(findings(around(), [facts(heard=heard(0.0, high))], 3.0)) == count


def test_gaps_silence_and_more_messages_than_one_core_takes_are_findings(says):
    assert findings(around(), [facts(heard=heard(gap=0.5))], 3.0) == []
    (said,) = findings(around(), [facts(heard=heard(gap=0.6))], 3.0)
    assert said.endswith('set x.speed.timeout to 2.0 or more')
    silent = heard(math.nan, math.nan, math.nan, received=0, state=InputState.MISSING)
    (said,) = findings(around(), [facts(heard=silent)], 3.0)
    assert said == says('speed_publisher_joint_states')
    assert findings(around(), [facts(heard=silent, timeout=30.0)], 3.0) == []
    axes = [facts(heard=heard(rate=1600.0)) for _ in range(2)]
    assert findings(around(), axes, 3.0) == []
    axes.append(facts(heard=heard(rate=1.0)))
    (said,) = findings(around(), axes, 3.0)
    assert said.startswith(says('speed_load_come'))


@pytest.mark.parametrize('numbers', [(0.0, 0.0), (math.nan, math.nan)])
def test_a_velocity_of_0_beside_a_position_that_moves_is_told(numbers, says):
    beside = ('position[x_axis]', 'rad')
    moving = facts(heard=dataclasses.replace(heard(*numbers), moved=True), beside=beside)
    assert findings(around(), [moving], 3.0) == [says('moves')]
    good = facts(heard=dataclasses.replace(heard(0.0, 2.0), moved=True), beside=beside)
    assert findings(around(), [good], 3.0) == []
