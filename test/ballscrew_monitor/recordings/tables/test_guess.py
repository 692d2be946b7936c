# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The first map of a log: by names, ranges and rates, and honest about what is assumed."""

import datetime as dt

from ballscrew_monitor.recordings.tables import guess as guess_module
from ballscrew_monitor.recordings.tables.guess import guess
from ballscrew_monitor.recordings.tables.mapping import make_map
from ballscrew_monitor.recordings.tables.series import read_series
import numpy as np
import pytest
import yaml

TIME = np.arange(200) / 50.0
SPEED = 100.0 * np.sin(TIME)


@pytest.fixture
def guessed(tmp_path, write_csv):
    def make(columns, **how):
        return guess(write_csv(tmp_path / 'log.csv', columns, **how))

    return make


def test_a_mill_log_is_understood(mill_log, says, refused):
    made = guess(mill_log)
    axes, assumed = made.content['axes'], made.content['assumed']
    assert list(axes) == ['x', 'y', 'z']
    assert axes['x'] == {
        'speed': {'column': 'X1_ActualVelocity'},
        'position': {'column': 'X1_ActualPosition'},
        'current': {'column': 'X1_CurrentFeedback', 'unit': None},
    }
    assert axes['z']['load'] == {'unknown': 'Z1_CurrentFeedback is always 0'}
    assert 'current' not in axes['z']
    assert made.content['time'] == {'rate_Hz': None}
    assert made.unstated == (*map(says, ('current_x', 'current_y', 'state_rate')),)
    assert f'#   {made.unstated[0]}\n' in made.text
    assert assumed['x.speed.unit']['value'] == 'mm/s'
    assert assumed['x.load.from']['value'] == 'current'
    assert assumed['x.torque_constant_Nm_per_A']['value'] > 0
    assert all(entry['reason'] for entry in assumed.values())
    assert any('spindle' in note for note in made.notes)
    assert any('axis z: the load is not known' in note for note in made.notes)
    assert yaml.safe_load(made.text) == made.content
    refused('blank_rate', make_map, made.content)
    for name in ('x', 'y'):
        axes[name]['current']['unit'] = 'A'
    assert make_map(made.content | {'time': {'rate_Hz': 10.0}}).rate == 10.0


def test_units_in_names_are_not_assumed(guessed):
    made = guessed(
        {
            'time_ms': TIME * 1e3,
            'x_speed_mm_s': SPEED,
            'x load [kN]': SPEED,
            'y_speed (rpm)': SPEED,
            'y_torque_Nm': SPEED,
            'oil_temperature_degC': TIME + 40,
            'motor_temperature': TIME,
        }
    )
    axes = made.content['axes']
    assert axes['x'] == {
        'speed': {'column': 'x_speed_mm_s', 'unit': 'mm/s'},
        'load': {'column': 'x load [kN]', 'unit': 'kN'},
        'temperature': {'column': 'oil_temperature_degC', 'unit': 'degC'},
    }
    assert axes['y']['speed']['unit'] == 'rev/min'
    assert axes['y']['torque'] == {'column': 'y_torque_Nm', 'unit': 'N m'}
    assert made.content['assumed']['y.load.from']['value'] == 'torque'
    assert made.content['time'] == {'column': 'time_ms', 'unit': 'ms'}
    assert not [key for key in made.content['assumed'] if key.endswith('.unit')]


@pytest.mark.parametrize(
    ('name', 'kind'),
    [('Drehmoment [%]', 'torque'), ('Motorstrom [%]', 'current'), ('load [%]', 'torque')],
)
def test_a_part_of_the_rated_torque_needs_that(name, kind, guessed, refused, says):
    made = guessed({'t_s': TIME, 'Vorschub [mm/min]': SPEED, name: SPEED})
    axis = made.content['axes']['x']
    assert axis[kind] == {'column': name, 'unit': '%'}
    assert axis['torque_rated_Nm'] is None
    assert made.unstated == (says('state_rated', column=name),)
    assert 'x.torque_constant_Nm_per_A' not in made.content['assumed']
    refused('blank_rated', make_map, made.content)
    axis['torque_rated_Nm'] = 8.0
    assert make_map(made.content).axes[0].motor_torque(kind) == pytest.approx(0.08)


@pytest.mark.parametrize(('weight', 'magnitude'), [(0.0, True), (6.0, None)])
def test_amounts_of_a_torque_are_said(weight, magnitude, guessed, says):
    torque = np.abs(weight + 2.0 * np.sign(SPEED) + 0.4 * np.cos(TIME))
    made = guessed({'t_s': TIME, 'x_vel_mm_s': SPEED, 'x_torque_Nm': torque})
    assert made.content['axes']['x']['torque'].get('magnitude') is magnitude
    assert (says('amounts') in made.notes) is bool(magnitude)
    assert not made.unstated


@pytest.mark.parametrize(('amount', 'unit'), [(0.9, None), (25.0, None), (2500.0, 'N')])
def test_a_force_is_in_newtons_if_no_axis_holds_as_many_kilonewtons(
    amount, unit, guessed, refused, says
):
    force = amount * np.cos(TIME)
    made = guessed({'t_s': TIME, 'v_x': SPEED, 'f_x': force, 'curr_x': SPEED / 50})
    assert says('current_left_out') in made.notes
    if unit:
        assert made.content['assumed']['x.load.unit']['value'] == unit
        assert not made.unstated
        return
    assert made.content['axes']['x']['load'] == {'column': 'f_x', 'unit': None}
    assert 'x.load.unit' not in made.content['assumed']
    assert 'current' not in made.content['axes']['x']
    refused('force_unit_missing', make_map, made.content)
    if amount == 0.9:
        assert made.unstated == (says('force_of_any_unit'),)
        assert f'#   {made.unstated[0]}\n' in made.text
    made.content['axes']['x']['load'] = {'from': 'current'}
    made.content['axes']['x']['current'] = {'column': 'curr_x', 'unit': 'A'}
    refused('constant_missing', make_map, made.content)


def test_logs_of_one_axis_need_no_letter(guessed):
    made = guessed({'Timestamp': 1.7e9 + TIME, 'Velocity': SPEED, 'Force': SPEED}, form='{:.12g}')
    assert list(made.content['axes']) == ['x']
    assert made.content['time'] == {'column': 'Timestamp', 'unit': 's'}
    assert 'time.epoch' not in made.content['assumed']
    made = guessed({'t': TIME, 'motor_rpm': SPEED, 'nut_speed': SPEED, 'slide_force': SPEED})
    assert list(made.content['axes']) == ['x']


@pytest.mark.parametrize(
    ('factor', 'unit'), [(1.0, 'mm/s'), (60.0, 'mm/min'), (1e-3, 'm/s'), (0.06, 'm/min')]
)
def test_position_and_time_tell_the_unit_of_the_speed(factor, unit, guessed):
    position = 300.0 - 100.0 * np.cos(TIME)
    made = guessed({'t_s': TIME, 'x_pos': position, 'x_vel': SPEED * factor}, form='{:.9g}')
    assert made.content['assumed']['x.speed.unit']['value'] == unit


def test_what_cannot_be_told_is_said_or_refused(guessed, refused, says):
    made = guessed({'x_vel': SPEED, 'x_force_N': SPEED})
    assert made.content['time'] == {'rate_Hz': None}
    assert made.unstated == (says('no_time'),)
    refused('column_looks_like', guessed, {'a': TIME, 'b': TIME})
    made = guessed({'t': TIME, 'x_speed_furlong': SPEED, 'x_force_N': SPEED})
    reason = made.content['assumed']['x.speed.unit']['reason']
    assert reason.startswith('x_speed_furlong states none that is known')


def test_of_a_long_log_the_first_rows_tell_the_rate_and_all_the_ranges(guessed, monkeypatch, says):
    monkeypatch.setattr(guess_module, 'NUMBERS', 300)
    late = np.where(np.arange(200) < 150, 0.0, 1.0)
    made = guessed({'t': TIME, 'x_vel': late * SPEED, 'x_force_N': late})
    assert made.content['axes']['x']['load'] == {'column': 'x_force_N', 'unit': 'N'}
    assert made.content['assumed']['x.speed.unit']['value'] == 'mm/s'
    assert says('rate_units_those') in made.notes
    assert not any('never moves' in note for note in made.notes)


def test_what_is_odd_is_said_and_a_column_of_texts_is_left_out(guessed, says, refused):
    made = guessed({'t': TIME, 'x_vel_m_s': SPEED, 'y_vel': 0 * SPEED, 'x_force': SPEED})
    assert says('moves_up_100') in made.notes
    assert 'axis y never moves: its speed is always 0' in made.notes
    words = ['fast'] * len(TIME)
    made = guessed({'t': TIME, 'x_vel': SPEED, 'y_vel': words, 'x_force': SPEED})
    assert list(made.content['axes']) == ['x']
    assert any("column 'y_vel' holds no number" in note for note in made.notes)
    refused('holds_number', guessed, {'t': TIME, 'x_vel': words})


def test_what_another_unit_or_place_is_of_is_left_out(guessed, says):
    made = guessed(
        {
            't [s]': TIME,
            'x speed [mm/s]': SPEED,
            'x load limit [%]': SPEED,
            'x motor temperature [C]': TIME + 60,
            'x temperature [C]': TIME + 30,
        }
    )
    axis, assumed = made.content['axes']['x'], made.content['assumed']
    assert axis['load'] == {'unknown': 'no force, torque or current'}
    assert axis['temperature'] == {'unit': 'degC'}
    assert assumed['x.temperature.column']['value'] == 'x temperature [C]'
    assert made.notes[-1] == says('used_load_motor')
    assert 'temperature' in make_map(made.content).axes[0].columns


def test_axes_are_told_by_the_words_in_which_names_differ(guessed, says):
    made = guessed(
        {
            'Zeit_ms': 1.7676e12 + TIME * 1e3,
            'a_speed_m_per_min': SPEED,
            'a_force_kN': SPEED,
            'a_oil [°C]': TIME + 40,
            'left_speed_mm_s': SPEED,
            'left_force_N': SPEED,
            'oil_temp_degC': TIME + 30,
        },
        separator=';',
        form='{:.13g}',
    )
    axes = made.content['axes']
    assert made.content['time'] == {'column': 'Zeit_ms', 'unit': 'ms'}
    assert axes['a'] == {
        'speed': {'column': 'a_speed_m_per_min', 'unit': 'm/min'},
        'load': {'column': 'a_force_kN', 'unit': 'kN'},
        'temperature': {'column': 'a_oil [°C]', 'unit': 'degC'},
    }
    assert axes['left']['load'] == {'column': 'left_force_N', 'unit': 'N'}
    assert axes['left']['temperature'] == {'column': 'oil_temp_degC', 'unit': 'degC'}
    assert says('axes_left_told') in made.notes
    assert list(make_map(made.content).axes[0].columns) == ['speed', 'load', 'temperature']


def test_a_time_by_name_comes_before_one_by_unit_and_one_that_does_not_rise_is_said(guessed, says):
    columns = {'served_ms': TIME * 1e3, 'time_s': TIME, 'x_vel': SPEED, 'x_force_N': SPEED}
    assert guessed(columns).content['time']['column'] == 'time_s'
    del columns['time_s']
    assert guessed(columns).content['time'] == {'column': 'served_ms', 'unit': 'ms'}
    made = guessed({'Zeit_ms': -TIME, 'x_vel': SPEED, 'x_force_N': SPEED})
    assert made.content['time'] == {'rate_Hz': None}
    assert made.unstated == (says('still_time'),)


def test_ticks_are_a_time_by_their_amount_and_small_whole_numbers_of_any_unit(guessed):
    ticks = [f'{134_000_000_000_000_000 + 200_000 * row}' for row in range(200)]
    made = guessed({'Time': ticks, 'x_vel': SPEED, 'x_force': SPEED})
    assert made.content['time'] == {'column': 'Time', 'unit': 'filetime'}
    made = guessed({'Name': ticks, 'x_vel': SPEED, 'x_force': SPEED})
    assert made.content['time'] == {'column': 'Name', 'unit': 'filetime'}
    whole = [f'{1000 + 7 * row}' for row in range(200)]
    made = guessed({'Time': whole, 'x_vel': SPEED, 'x_force': SPEED})
    assert made.content['time'] == {'column': 'Time', 'unit': None}


def test_a_column_of_another_time_is_left_out_where_one_is_read(guessed):
    columns = {'Time': ['some time'] * 200, 'time_s': TIME, 'x_vel': SPEED, 'x_force_N': SPEED}
    made = guessed(columns)
    assert made.content['time'] == {'column': 'time_s', 'unit': 's'}
    assert not made.unstated
    assert any("'some time' in row 2; it is left out" in note for note in made.notes)


def test_what_a_map_says_first_stays_in_comments(guessed):
    columns = {'Time': ['1\n: 2'] * 200, 'x_vel': SPEED, 'x_force_N': SPEED}
    columns = {name: [f'"{one}"' for one in column] for name, column in columns.items()}
    made = guessed(columns)
    assert len(made.unstated) == 1
    assert yaml.safe_load(made.text) == made.content


def test_a_speed_without_a_number_is_none_and_the_position_is_used(guessed, says):
    made = guessed({'time_s': TIME, 'x_speed_mm_s': ['NaN'] * 200, 'x_position_mm': SPEED})
    assert made.content['axes']['x']['position'] == {'column': 'x_position_mm', 'unit': 'mm'}
    assert 'speed' not in made.content['axes']['x']
    assert says('column_x_speed_mm_s_holds') in made.notes[0]
    assert not any('never moves' in note for note in made.notes)


def test_a_german_log_is_understood(tmp_path):
    """Names in two rows below a preamble, date and time of day apart, decimal commas, latin-1."""
    begin, lines = dt.datetime(2026, 1, 2, 23, 59, 59), []
    for row, speed in enumerate(SPEED):
        at = begin + dt.timedelta(milliseconds=20 * row)
        number = f'{speed * 60:.4f}'.replace('.', ',')
        clock = f'{at:%d.%m.%Y;%H:%M:%S},{at.microsecond // 1000:03d}'
        lines.append(f'{clock};{number};{row + 1};41,5')
    text = [
        'Maschine;DMU 50;;;',
        'Datum;Uhrzeit;Geschw.;Axialkraft;Öltemperatur',
        ';;mm/min;N;°C',
        *lines,
    ]
    path = tmp_path / 'log.csv'
    path.write_bytes('\r'.join(text).encode('latin-1'))
    content = guess(path).content
    assert content['time'] == {'column': 'Uhrzeit', 'unit': 's', 'date': 'Datum'}
    assert content['axes']['x'] == {
        'speed': {'column': 'Geschw. [mm/min]', 'unit': 'mm/min'},
        'load': {'column': 'Axialkraft [N]', 'unit': 'N'},
        'temperature': {'column': 'Öltemperatur [°C]', 'unit': 'degC'},
    }
    assert not [key for key in content['assumed'] if key.startswith('time')]
    ((block,),) = read_series(path, make_map(content)).blocks()
    first = round(begin.replace(tzinfo=dt.UTC).timestamp()) * 10**9
    np.testing.assert_array_equal(block.stamps - first, np.arange(len(SPEED)) * 20_000_000)


def test_a_time_of_day_counts_in_seconds_and_a_count_beside_a_date_is_none(guessed):
    clocks = [f'03:{row // 6:02d}:{row % 6}0' for row in range(200)]
    made = guessed({'Uhrzeit': clocks, 'x_vel': SPEED, 'x_force': SPEED})
    assert made.content['time'] == {'column': 'Uhrzeit', 'unit': 's'}
    night = [f'{minute}:{row:02d}' for minute in ('23:59', '00:00') for row in range(60)]
    made = guessed({'Uhrzeit': night, 'x_vel': SPEED[:120], 'x_force': SPEED[:120]})
    assert made.content['time'] == {'column': 'Uhrzeit', 'unit': 's'}
    dates = ['02.01.2026'] * 200
    made = guessed({'Datum': dates, 'Zeit': TIME, 'x_vel': SPEED, 'x_force': SPEED})
    assert made.content['time'] == {'column': 'Zeit', 'unit': None}


@pytest.mark.parametrize('scale', [1.0, 1e3, 1 / 60])
def test_a_time_with_decimals_is_of_no_unit_until_one_is_stated(scale, guessed, refused, says):
    columns = {'x_vel_mm_s': SPEED, 'x_force_N': SPEED}
    made = guessed({'time': TIME * scale} | columns, form='{:.9g}')
    assert made.content['time'] == {'column': 'time', 'unit': None}
    assert 'time.unit' not in made.content['assumed']
    refused('no_unit', make_map, made.content)
    if scale == 1.0:
        assert made.unstated == (says('rates_of_units'),)
        assert f'#   {says("rates_of_units")}\n' in made.text


@pytest.mark.parametrize(
    ('name', 'unit'),
    [('t_s', 's'), ('Zeit (s)', 's'), ('seconds', 's'), ('seconds_elapsed', 's')]
    + [('TimeSeconds', 's'), ('Zeit [ms]', 'ms'), ('MilliSeconds', 'ms'), ('t (min)', 'min')],
)
def test_a_name_states_the_unit_of_its_time(name, unit, guessed):
    made = guessed({name: TIME, 'x_vel_mm_s': SPEED, 'x_force_N': SPEED})
    assert made.content['time'] == {'column': name, 'unit': unit}


@pytest.mark.parametrize(
    ('name', 'moment'),
    [
        ('Scope_20250714_115950.csv', dt.datetime(2025, 7, 14, 11, 59, 50)),
        ('x 14.07.2025.csv', dt.datetime(2025, 7, 14)),
        ('2025-07-14/log.csv', dt.datetime(2025, 7, 14)),
    ],
)
def test_a_relative_time_is_dated_by_the_name(name, moment, tmp_path, write_csv):
    path = tmp_path / name
    path.parent.mkdir(exist_ok=True)
    made = guess(write_csv(path, {'t_s': TIME, 'x_vel': SPEED}))
    assert made.content['date_from'] == 'name'
    assert 'time.epoch' not in made.content['assumed']
    assert make_map(made.content).date_from == 'name'
    assert f'start {moment} from the name of the' in made.text


@pytest.mark.parametrize(('start', 'order'), [('22-7-2026', 'dmy'), ('7-22-2026', 'mdy')])
def test_a_relative_time_is_dated_by_the_head_in_the_order_that_it_shows(start, order, tmp_path):
    log = tmp_path / '2025-01-01.csv'
    rows = ''.join(f'{0.1 * at:.1f},{at % 7}\n' for at in range(100))
    log.write_text(f'Scope Export\nStartTime,{start} 09:14:03\n\nt_s,x_vel\n{rows}')
    made = guess(log)
    assert made.content['date_from'] == 'header'
    assert made.content['time']['order'] == order
    assert 'time.epoch' not in made.content['assumed']
    assert 'start 2026-07-22 09:14:03 from line 2' in made.text


def test_a_head_of_either_order_dates_nothing_and_says_how(tmp_path):
    log = tmp_path / 'a.csv'
    rows = ''.join(f'{0.1 * at:.1f},{at % 7}\n' for at in range(100))
    log.write_text(f'Scope Export\nStartTime,5-2-2025 09:14:03\n\nt_s,x_vel\n{rows}')
    made = guess(log)
    assert 'date_from' not in made.content
    assert 'time: {order: dmy} or mdy' in made.content['assumed']['time.epoch']['reason']


def test_a_name_dates_no_time_that_has_a_date(tmp_path, write_csv):
    columns = {'Timestamp': 1.7e9 + TIME, 'x_vel': SPEED}
    made = guess(write_csv(tmp_path / '2025-07-14.csv', columns, form='{:.12g}'))
    assert 'date_from' not in made.content
    assert 'date_from' not in guess(write_csv(tmp_path / 'a.csv', columns)).content


@pytest.mark.parametrize(
    ('name', 'zero', 'unit'),
    [
        ('MJD', 60870.4999, 'mjd'),
        ('Time [d]', 45852.4999, 'spreadsheet_days'),
        ('t [d]', 0.0, 'd'),
    ],
)
def test_days_are_those_of_their_epoch(name, zero, unit, guessed):
    made = guessed({name: zero + TIME / 86400.0, 'v_x [mm/s]': SPEED}, form='{:.12g}')
    assert made.content['time'] == {'column': name, 'unit': unit}


def test_seconds_of_a_day_are_no_days(guessed):
    seconds = 45852.0 + 1e-3 * np.arange(len(TIME))
    made = guessed({'time': seconds, 'v_x [mm/s]': SPEED}, form='{:.12g}')
    assert made.content['time'] == {'column': 'time', 'unit': None}


def test_words_in_the_rows_of_another_signal_are_to_be_left_empty(guessed, says):
    rows = np.arange(len(TIME))
    speed, force = (np.where(rows % 2 == own, SPEED, np.nan) for own in (0, 1))
    made = guessed({'t_s': TIME, 'v_x [mm/s]': speed, 'f_x [N]': force})
    assert says('joined') in made.notes
    holed = np.where(rows % 7 == 0, np.nan, SPEED)
    made = guessed({'t_s': TIME, 'v_x [mm/s]': holed, 'f_x [N]': holed})
    assert says('joined') not in made.notes
