# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Names of columns in the ways in which controls write them."""

from ballscrew_monitor.recordings.tables.names import (
    axis_names,
    kind_by_unit,
    read_name,
    unit_of,
    word_of_the_axis,
)
import pytest


@pytest.mark.parametrize(
    ('column', 'place', 'axis', 'kind', 'unit'),
    [
        ('X1_ActualVelocity', 'axis', 'x1', 'speed', ''),
        ('vel_x [mm/min]', 'axis', 'x', 'speed', 'mm/min'),
        ('Axis 2 Motor Current (mA)', 'axis', 'axis2', 'current', 'mA'),
        ('Z1 torque [Nm]', 'axis', 'z1', 'torque', 'N m'),
        ('current_position_x', 'axis', 'x', 'position', ''),
        ('force_z_kN', 'axis', 'z', 'load', 'kN'),
        ('U1_pos', 'axis', 'u1', 'position', ''),
        ('rpm', 'machine', '', 'speed', 'rev/min'),
        ('Temp_nut_C', 'machine', '', 'temperature', 'degC'),
        ('Timestamp (ms)', 'machine', '', 'time', 'ms'),
        ('SpindleSpeed', 'spindle', '', 'speed', ''),
        ('S1_ActualPosition', 'spindle', '', 'position', ''),
        ('b1_pos', 'rotary', '', 'position', ''),
        ('x load [%]', 'axis', 'x', '', ''),
        ('X1_ActualAcceleration', 'axis', 'x1', '', ''),
        ('M1_CURRENT_FEEDRATE', 'other', '', '', ''),
        ('x_feed_m_min', 'axis', 'x', 'speed', 'm/min'),
        ('x_feed_rate_m_min', 'axis', 'x', '', ''),
        ('Zeit_ms', 'machine', '', 'time', 'ms'),
        ('counter_ms', 'machine', '', 'time', 'ms'),
        ('x_delay_ms', 'axis', 'x', '', ''),
        ('X oil [°C]', 'axis', 'x', 'temperature', 'degC'),
        ('y_oil_degC', 'axis', 'y', 'temperature', 'degC'),
        ('y_motor_degC', 'axis', 'y', '', ''),
        ('x [mm]', 'axis', 'x', 'position', 'mm'),
        ('x_preload_kN', 'axis', 'x', '', ''),
        ('x_min', 'axis', 'x', '', ''),
    ],
)
def test_a_name_says_axis_quantity_and_unit(column, place, axis, kind, unit):
    named = read_name(column)
    assert (named.place, named.axis, named.kind, named.unit) == (place, axis, kind, unit)


def test_the_word_the_number_and_the_rank_of_an_axis():
    names = ('a_speed_m_per_min', 'left actual force [N]', 'Speed 2', 'oil_temp_degC')
    words = [word_of_the_axis(read_name(name)) for name in names]
    assert words == ['a', 'left', '2', '']
    named = [read_name(name) for name in ('X1_vel', 'Y1_vel', 'Y2_vel', 'axis3_vel')]
    assert axis_names(named) == {'x1': 'x', 'y1': 'y1', 'y2': 'y2', 'axis3': 'axis3'}
    names = ('X_ActualVelocity', 'X_Velocity', 'X_OutputVelocity', 'X_CommandVelocity')
    ranks = [read_name(name).rank for name in names]
    assert ranks == sorted(ranks, reverse=True)
    assert len(set(ranks)) == len(ranks)


@pytest.mark.parametrize(
    ('column', 'kind', 'unit'),
    [
        ('X_speed_m_per_min', 'speed', 'm/min'),
        ('x_feed_m_min', 'speed', 'm/min'),
        ('x_vel_mm_per_s', 'speed', 'mm/s'),
        ('VelocityMmPerS', 'speed', 'mm/s'),
        ('x speed [m / min]', 'speed', 'm/min'),
        ('x_speed_m/min', 'speed', 'm/min'),
        ('speed_mm_s_x', 'speed', 'mm/s'),
        ('x_speed_rad_s', 'speed', 'rad/s'),
        ('x_speed_rev_min', 'speed', 'rev/min'),
        ('x_rev_per_min', 'speed', 'rev/min'),
        ('Drehzahl [U/min]', 'speed', 'rev/min'),
        ('x_speed_furlong', 'speed', ''),
        ('x_vel_ms', 'speed', ''),
        ('x_torque_N_m', 'torque', 'N m'),
        ('motor_current_mA', 'current', 'mA'),
        ('oil °C', 'temperature', 'degC'),
        ('x_temp_deg_C', 'temperature', 'degC'),
        ('oil_temp_K', 'temperature', 'K'),
        ('elapsed_µs', 'time', 'us'),
        ('x_min_time', 'time', ''),
    ],
)
def test_a_unit_is_found_as_it_is_spelt(column, kind, unit):
    assert unit_of(column, kind) == unit


@pytest.mark.parametrize(
    ('column', 'kind'),
    [
        ('X oil [°C]', 'temperature'),
        ('x_mm_s', 'speed'),
        ('tick_ms', 'time'),
        ('x_min', ''),
        ('phase_a', ''),
        ('x', ''),
    ],
)
def test_only_a_unit_that_is_no_word_tells_the_quantity(column, kind):
    assert kind_by_unit(column)[0] == kind
