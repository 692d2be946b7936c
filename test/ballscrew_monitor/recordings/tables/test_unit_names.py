# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Units in the names of columns in the ways in which controls write them."""

import math

from ballscrew_monitor.core.conversions import ROTARY_SPEED_UNITS
from ballscrew_monitor.recordings.tables.names import read_name, unknown_units
from ballscrew_monitor.recordings.tables.quantities import UNITS
from ballscrew_monitor.recordings.tables.unit_names import (
    factor_of,
    is_unit,
    kind_by_unit,
    unit_of,
    unknown_unit,
    words_of,
)
import pytest


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
        ('Drehzahl [min⁻¹]', 'speed', 'rev/min'),
        ('Laufzeit [sek]', 'time', 's'),
        ('x_force_daN', 'load', ''),  # ten times a newton
        ('x_force_kN', 'load', 'kN'),
        ('x_torque_mNm', 'torque', ''),
        ('x_torque_kNm', 'torque', ''),
        ('torqueNm', 'torque', 'N m'),
        ('oil_mK', 'temperature', ''),
    ],
)
def test_a_unit_is_found_as_it_is_spelt(column, kind, unit):
    assert unit_of(column, kind) == unit


@pytest.mark.parametrize(
    ('column', 'degrees'),
    [
        *((f'X speed [{unit}]', 1.0) for unit in ('°/s', 'deg/s', 'Grad/s', 'degrees/s')),
        ('X speed [deg/sec]', 1.0),
        ('X Geschwindigkeit (°/min)', 1.0 / 60.0),
        ('X speed [rad/s]', 180.0 / math.pi),
    ],
)
def test_a_turning_speed_is_one_of_degrees_in_a_second(column, degrees):
    named = read_name(column)
    turning = named.scale * ROTARY_SPEED_UNITS[named.unit]
    assert turning == pytest.approx(math.radians(degrees), rel=1e-12)


@pytest.mark.parametrize('unit', ['°', 'deg', 'Grad', 'degrees'])
def test_an_angle_is_one_of_degrees(unit):
    assert read_name(f'X position [{unit}]').unit == 'deg'
    assert not read_name('Grad').kind, 'a word alone tells no quantity'


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


def test_a_cell_below_a_name_may_be_a_unit():
    assert all(map(is_unit, ('mm/min', '[N]', ' (Nm) ', '°C', 'ms', '1/min')))
    assert not any(map(is_unit, ('', 'Kraft', 'x', '12', '[furlong]')))


@pytest.mark.parametrize(
    ('name', 'words'),
    [
        ('Motorstrom', ['motor', 'strom']),
        ('Istgeschwindigkeit', ['ist', 'geschwindigkeit']),
        ('Geschwindigkeitsistwert', ['geschwindigkeit', 'istwert']),
        ('Öltemperatur_2', ['öl', 'temperatur', '2']),
        ('Drehmoment [Nm]', ['drehmoment']),
        ('Mistgabel', ['mistgabel']),
    ],
)
def test_a_german_word_of_several_comes_in_parts(name, words):
    assert words_of(name) == words


@pytest.mark.parametrize(
    ('column', 'kind', 'factor'),
    [
        ('x velocity [mm/s] (x10)', 'speed', 'x10'),
        ('x velocity/10 [mm/s]', 'speed', '/10'),
        ('10*x velocity [mm/s]', 'speed', '10*'),
        ('x_velocity_10mm_s', 'speed', '10mm_s'),
        ('x speed 10rpm', 'speed', '10rpm'),
        ('x speed (0.1) [rpm]', 'speed', '0.1'),
        ('x force [N] ×10^3', 'load', '×10^3'),
        ('x force 100 N', 'load', '100 N'),
        ('x_pos_0.1um', 'position', '0.1um'),
        ('time_250us', 'time', '250us'),
        ('time_1_10ms', 'time', '10ms'),
        ('t x10 [ms]', 'time', 'x10'),
        ('X10 pos [mm]', 'position', ''),
        ('x1_mm', 'position', ''),
        ('pos 2 mm', 'position', ''),
        ('speed x1 [rpm]', 'speed', ''),
        ('x speed 1/min', 'speed', ''),
        ('x_vel_min-1', 'speed', ''),
        ('x speed filtered 10 ms [mm/s]', 'speed', ''),
        ('x velocity (2.5 ms) [mm/s]', 'speed', ''),
    ],
)
def test_a_factor_beside_a_unit_is_seen_and_the_number_of_an_axis_is_none(column, kind, factor):
    assert factor_of(column, kind) == factor


def test_what_is_no_unit_is_told_whole():
    assert unknown_unit('x torque [1/1000]', 'torque') == '1/1000'
    assert unknown_unit('x velocity [mm/s] x10', 'speed') == 'x10'
    assert unknown_unit('x_force_10N', 'load') == '10N'
    assert not unknown_unit('x force', 'load')


PREFIXES = {'µ': 1e-6, 'μ': 1e-6, 'u': 1e-6, 'm': 1e-3, 'c': 1e-2, 'd': 0.1, 'k': 1e3, 'M': 1e6}
"""Of the brochure of the SI, table 7; both letters for micro are in use."""


@pytest.mark.parametrize(
    ('kind', 'unit', 'prefix'),
    [
        *(('load', 'N', prefix) for prefix in 'mdkM'),
        *(('torque', 'Nm', prefix) for prefix in 'mcdkM'),
        *(('speed', 'm/s', prefix) for prefix in 'µμumc'),
        *(('position', 'm', prefix) for prefix in 'µμumc'),
    ],
)
def test_a_multiple_of_a_unit_is_so_many_of_it(kind, unit, prefix):
    words = {'load': 'force', 'speed': 'vel'}
    name = f'x {words.get(kind, kind)} [{{}}]'
    one, many = (read_name(name.format(text)) for text in (unit, f'{prefix}{unit}'))
    assert one.kind == many.kind == kind
    size, whole = (named.scale * UNITS[kind][named.unit] for named in (many, one))
    assert size / whole == pytest.approx(PREFIXES[prefix], rel=1e-12)


@pytest.mark.parametrize('unit', ['Arms', 'A(rms)', 'A rms', 'Aeff', 'A'])
def test_an_effective_current_is_one(unit):
    named = read_name(f'X current [{unit}]')
    assert (named.kind, named.unit, named.scale) == ('current', 'A', 1.0)
    assert not read_name('robot arms').kind


@pytest.mark.parametrize('unit', ['A(p)', 'A(peak)', 'Ap', 'Apk', 'A pk'])
def test_an_amplitude_of_a_current_is_asked_for(unit, says):
    named = read_name(f'X current [{unit}]')
    assert (named.kind, named.doubtful) == ('', 'current')
    assert unknown_units([named]) == [says('amplitude', unit=unit)]


def test_a_load_in_per_cent_is_a_torque(says):
    assert unknown_units([read_name('X load [% rated]')]) == [says('rated')]


@pytest.mark.parametrize('word', ['Filtered', 'raw', 'Mean', 'unfiltered'])
def test_a_word_in_brackets_is_no_unit(word):
    named = read_name(f'Force ({word})')
    assert (named.kind, named.unit) == ('load', '')
    assert read_name('Force (slug)').doubtful == 'load'
