# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Messages of a state, an event and a surface."""

import math

from ballscrew_monitor.core.conversions import Direction, SECOND
from ballscrew_monitor.core.inputs import InputSample, Source
from ballscrew_monitor.core.judgement import EventEnd
from ballscrew_monitor.core.state import Ending
from ballscrew_monitor.messages import state_messages
from ballscrew_monitor.messages.state_messages import empty_state, fill_state
from ballscrew_msgs import msg
import pytest
from rclpy.serialization import deserialize_message, serialize_message

STAMP = 1_000_000_000 * SECOND + 5
NAN = math.nan


def one_row(core, *, speed=-20.0, surface=None, limits=None, stamp=STAMP):
    monitor = core.monitor(surface, limits)
    monitor.update(InputSample(source=Source.LOAD, value=1000.0, stamp=stamp))
    return monitor.update(InputSample(source=Source.SPEED, value=speed, stamp=stamp)), monitor


def state_message(row, monitor):
    message = empty_state('x')
    fill_state(message, row, monitor)
    return message


def over_the_wire(message):
    return deserialize_message(serialize_message(message), type(message))


def test_a_state_as_a_message(core):
    row, monitor = one_row(core, surface=core.surface(rcs=0.5), limits=core.limits(raise_delay=0))
    message = over_the_wire(state_message(row, monitor))
    assert (message.axis, message.header.frame_id) == ('x', 'x')
    assert (message.header.stamp.sec, message.header.stamp.nanosec) == (1_000_000_000, 5)
    assert message.level_since == message.header.stamp
    assert (message.point.speed, message.point.axial_load) == (-20.0, 1000.0)
    assert message.point.temperature == pytest.approx(40.0)
    assert math.isnan(message.point.motor_torque)
    assert message.point.direction == msg.OperatingPoint.DIRECTION_NEGATIVE
    assert message.point.temperature_source == msg.OperatingPoint.SOURCE_DEFAULT
    expected = (msg.BallScrewState.LEVEL_WARN, msg.BallScrewState.ZONE_OUTSIDE)
    assert (message.level, message.zone) == expected
    assert (message.event_id, message.judged) == (1, 1)
    assert [finding.code for finding in message.findings] == [msg.Finding.CODE_RCS_HIGH]
    assert list(message.active_gates) == []
    assert (message.rcs_limit, message.light_load_limit) == (0.25, 256.0)
    assert [health.name for health in message.inputs] == ['speed', 'load', 'temperature', 'torque']
    assert message.inputs[3].state == msg.InputHealth.STATE_NOT_CONFIGURED
    assert message.surface_id == '0123456789abcdef'


def test_a_result_as_a_message(core):
    row, monitor = one_row(core)
    result = state_message(row, monitor).result
    expected = (msg.PointResult.VALIDITY_VALID, msg.PointResult.TIER_CLOSED_FORM, '')
    assert (result.validity, result.tier, result.reason) == expected
    for name in state_messages.NUMBERS:
        assert getattr(result, name) == getattr(row, name) or (
            name.endswith('_std') and math.isnan(getattr(result, name))
        )
    wanted = (msg.PointResult.NUT_POSITIVE, msg.PointResult.SIDE_NUT)
    assert (result.worst_nut, result.worst_side) == wanted
    assert result.regime == msg.PointResult.REGIME_HYDRODYNAMIC


def test_a_used_message_keeps_nothing_of_the_state_before(core):
    used = empty_state('x')
    fill_state(
        used, *one_row(core, surface=core.surface(rcs=0.5, back_driving=True, corrected=True))
    )
    assert used.result.corrected
    lost = one_row(core, speed=500.0, stamp=SECOND)
    fresh = state_message(*lost)
    fill_state(used, *lost)
    assert repr(used) == repr(fresh)
    assert not fresh.result.back_driving
    assert not fresh.result.corrected
    numbers = [getattr(fresh.result, name) for name in state_messages.NUMBERS]
    assert all(math.isnan(number) for number in numbers)
    assert 'above the surface' in fresh.result.reason


def test_an_event_as_a_message_and_that_there_was_none(core, says):
    _, monitor = one_row(core, surface=core.surface(rcs=0.5), limits=core.limits(raise_delay=0))
    message = over_the_wire(state_messages.out_of_zone_message(monitor, shelved=True))
    assert (message.axis, message.event_id, message.active) == ('x', 1, True)
    assert (message.start.sec, message.duration, message.worst_value) == (1_000_000_000, 0.0, 0.5)
    assert message.cause.code == msg.Finding.CODE_RCS_HIGH
    assert message.cause.text == says('asperities')
    assert message.ending == msg.OutOfZone.ENDING_UNKNOWN
    assert monitor.acknowledge(STAMP, Ending(EventEnd.ACKNOWLEDGED, 'A', 'b'))
    message = over_the_wire(state_messages.out_of_zone_message(monitor, shelved=False))
    assert message.ending == msg.OutOfZone.ENDING_ACKNOWLEDGED
    assert (message.acknowledged_by, message.acknowledge_reason) == ('A', 'b')
    message = over_the_wire(state_messages.out_of_zone_message(core.monitor(), shelved=False))
    assert (message.event_id, message.active, message.duration) == (0, False, 0.0)
    assert math.isnan(message.worst_value)
    assert (message.cause.code, message.advice) == (msg.Finding.CODE_UNKNOWN, '')
    assert isinstance(message, msg.OutOfZone)


def test_a_surface_as_a_message(core):
    settings = core.monitor().settings
    message = over_the_wire(
        state_messages.surface_info_message('x', core.surface(), settings, stamp=STAMP)
    )
    assert (message.screw, message.oil, message.tier) == ('constant', 'water', 1)
    assert (message.speed_min, message.axial_load_max) == (0.1, 4000.0)
    assert message.temperature_max == pytest.approx(80.0)
    expected = (['rcs'], [2e-3], [1e-3])
    assert (message.error_field, list(message.error_max), list(message.error_p95)) == expected
    assert message.default_temperature == pytest.approx(40.0)
    assert (message.limit_factor_low, message.limit_factor_high) == (0.75, 1.5)
    assert (message.numerical_factor_low, message.numerical_factor_high) == (0.8, 1.25)


@pytest.mark.parametrize(
    ('speed', 'stated', 'direction'),
    [
        (5.0, 2, Direction.POSITIVE),
        (-5.0, 0, Direction.NEGATIVE),
        (0.0, 2, Direction.NEGATIVE),
        (0.0, 7, Direction.UNKNOWN),
        (NAN, 1, Direction.UNKNOWN),
    ],
)
def test_a_requested_point(speed, stated, direction):
    message = msg.OperatingPoint(speed=speed, axial_load=3.0, temperature=NAN, direction=stated)
    point = state_messages.read_point(message, default_temperature=300.0)
    assert (point.axial_load, point.temperature, point.direction) == (3.0, 300.0, direction)
    message.temperature = 20.0
    found = state_messages.read_point(message, default_temperature=300.0).temperature
    assert found == pytest.approx(293.15)
