# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Names of columns in the ways in which controls write them."""

from ballscrew_monitor.recordings.tables.names import (
    axis_names,
    axis_of_all,
    axis_of_file,
    best,
    is_of_the_screw,
    read_name,
    turning_unit,
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
        ('S-0-0040, Velocity feedback value [mm/min]', 'machine', '', 'speed', 'mm/min'),
        ('S-0-0084 Torque/force feedback value [%]', 'machine', '', 'torque', '%'),
        ('S-0-0084, Drehmoment-/Kraft-Istwert [Nm]', 'machine', '', 'torque', 'N m'),
        ('r63[0] Actual speed smoothed / rpm', 'machine', '', 'speed', 'rev/min'),
        ('X r80 torque actual [Nm]', 'axis', 'x', 'torque', 'N m'),
        ('0x606C Velocity actual value [rpm]', 'machine', '', 'speed', 'rev/min'),
        ('Actual torque [Nm] (0x6077)', 'machine', '', 'torque', 'N m'),
        ('X.StatusTorqueData.ActualTorque [Nm]', 'axis', 'x', 'torque', 'N m'),
        ('X drive status torque', 'axis', 'x', '', ''),
        ('Time  1 - default sample rate [s]', 'machine', '', 'time', 's'),
        ('X_Position_Actual [MILLIMETER]', 'axis', 'x', 'position', 'mm'),
        ('X_Torque [NEWTON_METER]', 'axis', 'x', 'torque', 'N m'),
        ('x load [PERCENT]', 'axis', 'x', 'torque', '%'),
        ('X.Act.Frc [N]', 'axis', 'x', 'load', 'N'),
        ('Temps (s)', 'machine', '', 'time', 's'),
        ('Vitesse X (mm/s)', 'axis', 'x', 'speed', 'mm/s'),
        ('velocity[0]', 'machine', '', 'speed', ''),
        ('joint_states.effort[1]', 'machine', '', 'torque', ''),
        ('Prędkość X [mm/s]', 'axis', 'x', 'speed', 'mm/s'),
        ('POŁOŻENIE X [mm]', 'axis', 'x', 'position', 'mm'),
        ('Siła X [N]', 'axis', 'x', 'load', 'N'),
        ('Prąd X [A]', 'axis', 'x', 'current', 'A'),
        ('Czas [s]', 'machine', '', 'time', 's'),
        ('Vx in mm/s', 'axis', 'x', 'speed', 'mm/s'),
        ('F_x in kN', 'axis', 'x', 'load', 'kN'),
        ('F_x/N', 'axis', 'x', 'load', 'N'),
        ('M_x / Nm', 'axis', 'x', 'torque', 'N m'),
        ('X velocity mm/min', 'axis', 'x', 'speed', 'mm/min'),
        ('x constant Nm/A', 'axis', 'x', '', ''),
        ('řeka/N', 'machine', '', '', ''),
        ('I nenn X [A]', 'axis', 'x', 'current', 'A'),
        ('M1_X_Velocity_mm_min', 'axis', 'x', 'speed', 'mm/min'),
        ('S2.Z.Torque [Nm]', 'axis', 'z', 'torque', 'N m'),
        ('Effort X (N)', 'axis', 'x', 'load', 'N'),
        ('Couple X (Nm)', 'axis', 'x', 'torque', 'N m'),
        ('Accélération X (m/s2)', 'axis', 'x', '', ''),
        ('Velocità X (mm/s)', 'axis', 'x', 'speed', 'mm/s'),
        ('Posición X (mm)', 'axis', 'x', 'position', 'mm'),
        ('Temp_nut_C', 'machine', '', 'temperature', 'degC'),
        ('Timestamp (ms)', 'machine', '', 'time', 'ms'),
        ('SpindleSpeed', 'spindle', '', 'speed', ''),
        ('S1_ActualPosition', 'spindle', '', 'position', ''),
        ('b1_pos', 'rotary', '', 'position', ''),
        ('x load [%]', 'axis', 'x', 'torque', '%'),
        ('Zatížení X [%]', 'axis', 'x', 'torque', '%'),
        ('X ZATÍŽENÍ [%]', 'axis', 'x', 'torque', '%'),
        ('Auslastung X [%]', 'axis', 'x', 'torque', '%'),
        ('zatížení osy X [N]', 'axis', 'x', 'load', 'N'),
        ('Xload', 'axis', 'x', 'torque', '%'),
        ('y_load_pct', 'axis', 'y', 'torque', '%'),
        ('spindle load [%]', 'spindle', '', 'torque', '%'),
        ('x load limit [%]', 'axis', 'x', '', ''),
        ('Load X %', 'axis', 'x', 'torque', '%'),
        ('x torque%', 'axis', 'x', 'torque', '%'),
        ('x load limit %', 'axis', 'x', '', ''),
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
        ('Geschw. [mm/min]', 'machine', '', 'speed', 'mm/min'),
        ('X-Achse Vorschub [m/min]', 'axis', 'x', 'speed', 'm/min'),
        ('Achse 2 Istgeschwindigkeit', 'axis', 'axis2', 'speed', ''),
        ('Motorstrom [A]', 'machine', '', 'current', 'A'),
        ('Axialkraft [kN]', 'machine', '', 'load', 'kN'),
        ('Drehmoment', 'machine', '', 'torque', ''),
        ('Motormoment [Nm]', 'machine', '', 'torque', 'N m'),
        ('Öltemperatur [°C]', 'machine', '', 'temperature', 'degC'),
        ('Motortemperatur [°C]', 'machine', '', '', ''),
        ('Lageistwert Z [mm]', 'axis', 'z', 'position', 'mm'),
        ('Antriebsdrehzahl X [tr/min]', 'axis', 'x', 'speed', 'rev/min'),
        ('X speed tr/min', 'axis', 'x', 'speed', 'rev/min'),
        ('X1_angle_deg', 'axis', 'x1', 'position', 'deg'),
        ('Winkel X [Grad]', 'axis', 'x', 'position', 'deg'),
        ('X phase angle [deg]', 'axis', 'x', '', ''),
        ('X angle error [deg]', 'axis', 'x', '', ''),
        ('X angle', 'axis', 'x', '', ''),
        ('x angle [mm]', 'axis', 'x', '', ''),
        ('C angle [deg]', 'machine', '', '', ''),
        ('Zeit [s]', 'machine', '', 'time', 's'),
        ('epoch', 'machine', '', 'time', ''),
        ('Spindeldrehzahl [1/min]', 'machine', '', '', ''),
        ('Beschleunigung [m/s]', 'machine', '', '', ''),
        ('x velocity [mm/s] (x10)', 'axis', 'x', '', 'mm/s'),
        ('time_10ms', 'machine', '', '', 'ms'),
        ('x abs velocity [mm/s]', 'axis', 'x', '', 'mm/s'),
        ('x speed total [mm/s]', 'axis', 'x', '', 'mm/s'),
        ('x velocity (absolute) [mm/s]', 'axis', 'x', '', 'mm/s'),
        ('x unsigned force [N]', 'axis', 'x', '', 'N'),
        ('x absolute position [mm]', 'axis', 'x', 'position', 'mm'),
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
    ('first', 'second', 'likely'),
    [
        ('x real velocity of tool [mm/s]', 'x velocity [mm/s]', 1),
        ('x actual force head [N]', 'x force [N]', 1),
        ('x actual velocity [mm/s]', 'x velocity [mm/s]', 0),
        ('x velocity of drive [mm/s]', 'x commanded velocity [mm/s]', 0),
        ('x speed PV [mm/s]', 'x speed [mm/s]', 0),
        ('x filtered actual velocity [mm/s]', 'x velocity [mm/s]', 0),
        ('Vitesse consigne X [mm/s]', 'Vitesse réelle X [mm/s]', 1),
        ('S-0-0036 Velocity command value [rpm]', 'S-0-0040 Velocity feedback value [rpm]', 1),
    ],
)
def test_a_word_of_another_thing_counts_more_than_one_of_what_is_measured(first, second, likely):
    pair = (first, second)
    for columns in (pair, pair[::-1]):
        (chosen,) = best([read_name(column) for column in columns]).values()
        assert chosen.column == pair[likely]


@pytest.mark.parametrize(
    'column',
    [
        'x actual position lag [mm]',
        'x position delta [mm]',
        'x position to go [mm]',
        'x velocity resultant [mm/s]',
        'x actual force ripple [N]',
    ],
)
def test_what_is_only_about_a_quantity_is_none(column):
    assert not read_name(column).kind


@pytest.mark.parametrize(
    'column',
    [
        'hydraulic oil temperature [°C]',
        'gearbox oil temperature [°C]',
        'Getriebe Öltemperatur [°C]',
        'oil temperature setpoint [°C]',
        'oil temperature alarm [°C]',
        'oil tank temperature [°C]',
        'bearing temperature [°C]',
        'controller temperature [°C]',
        'CPU temperature [°C]',
        'x drive temperature [°C]',
        'spindle bearing temperature [°C]',
    ],
)
def test_a_temperature_of_something_else_is_none_of_the_oil(column):
    assert read_name(column).kind != 'temperature'


@pytest.mark.parametrize(
    ('column', 'of_the_screw'),
    [
        ('oil temperature [°C]', True),
        ('x nut temperature [°C]', True),
        ('lubricant temperature actual [°C]', True),
        ('temperature [°C]', False),
        ('ball screw bearing temperature [°C]', False),
    ],
)
def test_a_temperature_of_the_screw_or_of_nothing_may_be_that_of_the_oil(column, of_the_screw):
    assert read_name(column).kind == 'temperature'
    assert is_of_the_screw(column) is of_the_screw


def test_german_words_say_what_is_measured_of_what_and_in_which_unit():
    measured, wanted = (read_name(name).rank for name in ('Lageistwert X', 'Lagesollwert X'))
    assert measured > read_name('Lage X').rank > wanted
    assert is_of_the_screw('Öltemperatur')
    assert not is_of_the_screw('Temperatur')
    names = ('Motordrehzahl', 'omega_x', 'Geschw.')
    assert [turning_unit(name) for name in names] == ['rev/min', 'rad/s', '']


@pytest.mark.parametrize(
    'column',
    [
        *(
            'Tool speed [rpm]',
            'Coolant pump speed [rpm]',
            'Fan speed [rpm]',
            'Turret position [mm]',
        ),
        *('Cutting speed [m/min]', 'Path velocity [mm/s]', 'Conveyor speed [mm/s]'),
        *('X jog speed [mm/s]', 'X homing velocity [mm/s]', 'X Eilgang Geschwindigkeit [mm/s]'),
        *('X home position [mm]', 'X speed ratio [mm/s]', 'X standstill speed [mm/s]'),
        *('X preload force [N]', 'X gravity force [N]', 'Grip force [N]', 'Tailstock force [N]'),
        *('Brake torque [Nm]', 'Tool torque [Nm]', 'Werkzeug Drehmoment [Nm]'),
        *('X screw temperature rise [K]', 'Dew point temperature [degC]'),
    ],
)
def test_the_quantity_of_another_thing_is_none_of_the_axis(column):
    assert not read_name(column).kind


@pytest.mark.parametrize(
    ('text', 'whole', 'file'),
    [
        *(('X', 'x', 'x'), ('y axis', 'y', 'y'), ('Achse_Z', 'z', 'z'), ('Axis X 2', 'x', 'x')),
        *(('datos y fuerza', '', 'y'), ('feed_z_7', '', 'z'), ('x and y', '', '')),
        *(('16x5', '', ''), ('max', '', ''), ('', '', ''), ('Y2', 'y', '')),
    ],
)
def test_the_axis_of_all_rows_is_told_by_a_name_and_in_a_file_by_a_letter(text, whole, file):
    assert (axis_of_all(text), axis_of_file(text)) == (whole, file)


def test_the_inclined_axis_of_a_lathe_of_okuma_is_y():
    """YI1actm and YI1actw are names of the public recording of an adapter."""
    assert [read_name(name).axis for name in ('YI1actm', 'YI1actw', 'Y1actm')] == ['y1'] * 3
    assert {read_name(name).kind for name in ('YI1actm', 'YI1actw')} == {'position'}
    assert read_name('YI1load').unit == '%'
