# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The first map of a log: by names, ranges and rates, and honest about what is assumed."""

import datetime as dt
import math

from ballscrew_monitor.recordings.tables import guess as guess_module
from ballscrew_monitor.recordings.tables import read as read_module
from ballscrew_monitor.recordings.tables.guess import guess
from ballscrew_monitor.recordings.tables.mapping import make_map
from ballscrew_monitor.recordings.tables.series import read_series
import numpy as np
import pytest
from surrogate.files import InputError
import yaml

TIME = np.arange(200) / 50.0
SPEED = 100.0 * np.sin(TIME)
TURNING = 2.0 * np.sin(TIME * 2.0)  # of the screw in a second
PLACE = 3.0 - np.cos(TIME * 2.0)  # the turns that these are
SQUARE = np.repeat([1.0, -1.0, 1.0, -1.0], 200)  # steady both ways

CONSTANT = 'torque_constant_Nm_per_A'


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
        'current': {'column': 'X1_CurrentFeedback', 'unit': None, 'magnitude': None},
        CONSTANT: None,
    }
    assert axes['z']['load'] == {'unknown': 'Z1_CurrentFeedback is always 0'}
    assert 'current' not in axes['z']
    assert made.content['time'] == {'rate_Hz': None}
    assert made.unstated == (
        *map(says, ('current_x', 'sign_x', 'constant_x')),
        *map(says, ('current_y', 'constant_y', 'state_rate')),
    )
    assert f'#   {made.unstated[0]}\n' in made.text
    assert assumed['x.speed.unit']['value'] == 'mm/s'
    assert assumed['x.load.from']['value'] == 'current'
    assert all(entry['reason'] for entry in assumed.values())
    assert any('spindle' in note for note in made.notes)
    assert any('axis z: the load is not known' in note for note in made.notes)
    assert yaml.safe_load(made.text) == made.content
    refused('blank_rate', make_map, made.content)
    for name in ('x', 'y'):
        axes[name]['current'] |= {'unit': 'A', 'magnitude': False}
        axes[name][CONSTANT] = 0.2
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
    assert made.unstated == (() if magnitude else (says('unclear_amounts'),))


@pytest.mark.parametrize('amount', [0.9, 25.0, 2500.0])
def test_the_unit_of_a_force_is_asked_for(amount, guessed, refused, says):
    force = amount * np.cos(TIME)
    made = guessed({'t_s': TIME, 'v_x_mm_s': SPEED, 'f_x': force, 'curr_x': SPEED / 50})
    assert says('current_left_out') in made.notes
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
def test_position_and_time_tell_the_unit_of_the_speed(factor, unit, guessed, says):
    position = 300.0 - 100.0 * np.cos(TIME)
    columns = {'t_s': TIME, 'x_pos_mm': position, 'x_vel': SPEED * factor}
    made = guessed(columns, form='{:.9g}')
    assert made.content['assumed']['x.speed.unit']['value'] == unit
    columns = {'t_s': TIME, 'x_pos': position, 'x_vel': SPEED * factor}
    made = guessed(columns, form='{:.9g}')
    axis = made.content['axes']['x']
    assert axis['speed']['unit'] is axis['position']['unit'] is None
    assert made.unstated == (says('no_units', unit=unit),)


def test_what_cannot_be_told_is_said_or_refused(guessed, refused, says):
    made = guessed({'x_vel_mm_s': SPEED, 'x_force_N': SPEED})
    assert made.content['time'] == {'rate_Hz': None}
    assert made.unstated == (says('no_time'),)
    refused('column_looks_like', guessed, {'a': TIME, 'b': TIME})
    made = guessed({'t_s': TIME, 'x_speed_furlong': SPEED, 'x_force_N': SPEED})
    assert made.content['axes']['x']['speed']['unit'] is None
    assert made.unstated == (says('no_speed_unit'),)
    made = guessed({'t_s': TIME, 'x_position': SPEED, 'x_force_N': SPEED})
    assert made.content['axes']['x']['position']['unit'] is None


def test_of_a_long_log_the_first_rows_tell_the_rate_and_all_the_ranges(guessed, monkeypatch, says):
    monkeypatch.setattr(guess_module, 'NUMBERS', 300)
    late = np.where(np.arange(200) < 140, 0.0, 1.0)
    made = guessed({'t_s': TIME, 'x_vel_mm_s': late * SPEED, 'x_force_N': late * SPEED})
    assert made.content['axes']['x']['load'] == {'column': 'x_force_N', 'unit': 'N'}
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
    columns = {'served_ms': TIME * 1e3, 'time_s': TIME, 'x_vel_mm_s': SPEED, 'x_force_N': SPEED}
    assert guessed(columns).content['time']['column'] == 'time_s'
    del columns['time_s']
    assert guessed(columns).content['time'] == {'column': 'served_ms', 'unit': 'ms'}
    jagged = np.random.default_rng(5).permutation(TIME)
    made = guessed({'Zeit_ms': jagged, 'x_vel_mm_s': SPEED, 'x_force_N': SPEED})
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
    columns = {'time_s': TIME, 'x_vel_mm_s': SPEED, 'x_force_N': SPEED}
    columns = {'Time': ['some time'] * 200} | columns
    made = guessed(columns)
    assert made.content['time'] == {'column': 'time_s', 'unit': 's'}
    assert not made.unstated
    assert any("'some time' in row 2; it is left out" in note for note in made.notes)


def test_what_a_map_says_first_stays_in_comments(guessed):
    columns = {'Time': ['1\n: 2'] * 200, 'x_vel_mm_s': SPEED, 'x_force_N': SPEED}
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
        lines.append(f'{clock};{number};{row - 100};41,5')
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
    made = guess(write_csv(path, {'t_s': TIME, 'x_vel_mm_s': SPEED}))
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
    assert 'by time: {order: mdy}' in made.content['assumed']['time.epoch']['reason']


@pytest.mark.parametrize('split', [False, True])
def test_dates_of_several_orders_are_asked_about_and_read_by_each(split, tmp_path, says, refused):
    """A control of Japan writes 25/07/11 on 11 July 2025."""
    log = tmp_path / 'log.csv'
    between, names = (';', 'Date;Time') if split else (' ', 'Time')
    rows = ''.join(f'25/07/11{between}10:00:{0.1 * at:06.3f};{at % 7}\n' for at in range(100))
    log.write_text(f'{names};x_vel [mm/s]\n{rows}')
    made = guess(log)
    assert made.content['time']['order'] is None
    column, cell = ('Date', '25/07/11') if split else ('Time', '25/07/11 10:00:00.000')
    assert says('two_orders', log=log, column=column, cell=cell) in made.unstated
    made.content['time'].pop('order')
    with refused('two_orders', log=log, column=column, cell=cell):
        read_series(log, make_map(made.content))
    for order, day in (('ymd', (2025, 7, 11)), ('dmy', (2011, 7, 25))):
        made.content['time']['order'] = order
        begin = read_series(log, make_map(made.content)).begin / 1e9
        assert dt.datetime.fromtimestamp(begin, dt.UTC).replace(tzinfo=None) == dt.datetime(
            *day, 10
        )


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


def test_days_of_a_text_are_said_to_count_from_1900_and_a_map_lets_them_from_1904(
    tmp_path, write_csv, says
):
    begin = dt.datetime(2025, 7, 14, 12)
    since_1904 = (begin - dt.datetime(1904, 1, 1)) / dt.timedelta(days=1)
    columns = {'Time': since_1904 + np.arange(60) / 86400.0, 'v_x [mm/s]': SPEED[:60]}
    log = write_csv(tmp_path / 'log.csv', columns, form='{:.12g}')
    content = guess(log).content
    assert content['assumed']['time.offset'] == {'value': 0.0, 'reason': says('from_1900')}
    assert not read_series(log, make_map(content)).notes
    content['assumed']['time.offset']['value'] = 1462
    stamp = read_series(log, make_map(content)).begin / 1e9
    assert abs(stamp - begin.replace(tzinfo=dt.UTC).timestamp()) < 1e-2


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


@pytest.mark.parametrize('names', [('Time A [ms]', 'Time B [ms]'), ('Zeit 1 [ms]', 'Zeit 2 [ms]')])
def test_columns_have_the_time_before_them_whatever_its_name(names, tmp_path, write_csv, says):
    first, second = names
    columns = {
        first: TIME * 1e3,
        'X_vel [mm/s]': SPEED,
        second: 1e3 + TIME * 1250.0,
        'X_torque [Nm]': np.arange(200) - 100.0,
    }
    path = write_csv(tmp_path / 'log.csv', columns, form='{:.9g}')
    made = guess(path)
    torque = made.content['axes']['x']['torque']
    assert torque == {'column': 'X_torque [Nm]', 'unit': 'N m', 'time': second}
    assert [line.split(',')[0] for line in made.picture[:2]] == [
        'Group 1: 20 ms',
        'Group 2: 25 ms',
    ]
    assert says('own_time', time=second) in made.notes
    assert not any('not used' in note for note in made.notes)
    series = read_series(path, make_map(made.content))
    groups = list(series.blocks())
    number = series.places['X_torque [Nm]']
    stamps = np.concatenate([rows[number].stamps for rows in groups])
    assert (stamps - series.begin) / 1e9 == pytest.approx(1.0 + 1.25 * TIME)


def test_equal_names_of_times_are_all_used(tmp_path):
    rows = ''.join(f'{at};{at % 7};{at + 500};{at % 9 - 4}\n' for at in range(0, 2000, 10))
    log = tmp_path / 'log.csv'
    log.write_text(f'Time [ms];X_vel [mm/s];Time [ms];X_torque [Nm]\n{rows}')
    made = guess(log)
    assert made.content['axes']['x']['torque']['time'] == 'Time [ms]_duplicated_0'
    assert not any('not used' in note for note in made.notes)


@pytest.mark.parametrize('other', [1.7e9 + TIME, TIME + 1e-4, np.full(200, 0.02)])
def test_a_second_time_of_the_same_rows_is_none_of_its_own(other, guessed):
    columns = {
        'Time A [s]': TIME,
        'v_x [mm/s]': SPEED,
        'Time B [s]': other,
        'x_torque [Nm]': SPEED,
    }
    made = guessed(columns, form='{:.14g}')
    assert made.content['time']['column'] == 'Time A [s]'
    assert 'time' not in made.content['axes']['x']['torque']
    assert not made.unstated


def test_a_second_time_in_another_unit_is_asked_for(guessed, refused, says):
    second = 1e3 + TIME * 1250.0
    columns = {
        'Time A [s]': TIME,
        'v_x [mm/s]': SPEED,
        'Time B [ms]': second,
        'x_torque [Nm]': SPEED,
    }
    made = guessed(columns, form='{:.9g}')
    assert made.content['axes']['x']['torque']['time'] is None
    assert made.unstated == (says('times_of_two_units'),)
    refused('blank_time', make_map, made.content)
    made.content['axes']['x']['torque']['time'] = 'Time A [s]'
    assert make_map(made.content)


@pytest.mark.parametrize(
    ('position', 'unit', 'name'),
    [
        ({'x_pos_mm': 10.0 * PLACE}, 'rev/min', 'turning'),
        ({'x_pos_deg': 360.0 * PLACE}, 'mm/s', 'feeding'),
    ],
)
def test_a_speed_that_does_not_make_its_position_is_asked_for(position, unit, name, guessed, says):
    """A screw of 10 mm a turn makes the place of 60 speeds a second, or of 10."""
    speed = {'rev/min': 60.0, 'mm/s': 10.0}[unit] * TURNING
    made = guessed({'t_s': TIME, **position, 'x_speed': speed, 'x_force_N': SPEED}, form='{:.9g}')
    assert made.content['axes']['x']['speed'] == {'column': 'x_speed', 'unit': None}
    assert made.unstated == (says(name),)
    made.content['axes']['x']['speed']['unit'] = unit
    assert make_map(made.content)


@pytest.mark.parametrize('unit', ['mm/s', 'mm/min', 'm/min', 'm/s'])
def test_a_speed_that_makes_its_position_has_its_unit(unit, guessed):
    scale = {'mm/s': 10.0, 'mm/min': 600.0, 'm/min': 0.6, 'm/s': 0.01}[unit]
    made = guessed({'t_s': TIME, 'x_pos_mm': 10.0 * PLACE, 'x_speed': scale * TURNING})
    assert made.content['assumed']['x.speed.unit']['value'] == unit


def test_a_speed_without_a_sign_gives_way_to_its_position(guessed, says):
    made = guessed({'t_s': TIME, 'x_pos_mm': 10.0 * PLACE, 'x_speed_mm_s': abs(10.0 * TURNING)})
    assert 'speed' not in made.content['axes']['x']
    assert says('amounts_of_speed') in made.notes


def test_a_position_within_a_turn_tells_the_unit_of_its_speed(guessed):
    made = guessed({'t_s': TIME, 'x_pos_deg': 360.0 * PLACE % 360.0, 'x_speed': 60.0 * TURNING})
    assert made.content['assumed']['x.speed.unit']['value'] == 'rev/min'


def test_a_command_gives_way_to_a_position_that_does_not_follow_it(guessed, says):
    columns = {'t_s': TIME, 'x_actual_position_mm': 10.0 * PLACE}
    made = guessed(columns | {'x_command_velocity_mm_s': 15.0 * TURNING}, form='{:.9g}')
    assert 'speed' not in made.content['axes']['x']
    assert says('command') in made.notes
    made = guessed(columns | {'x_velocity_mm_s': 15.0 * TURNING}, form='{:.9g}')
    assert made.unstated == (says('contradiction'),)
    made = guessed(columns | {'x_velocity_mm_s': 10.0 * np.sin(5.0 * TIME)}, form='{:.9g}')
    assert made.unstated == (says('another_motion'),)


def test_a_quantity_that_is_only_commanded_is_said_and_so_is_what_a_load_may_be_in(guessed, says):
    columns = {'t_s': TIME, 'x_command_velocity_mm_s': SPEED}
    assert says('commanded') in guessed(columns).notes
    columns |= {'x_actual_velocity_mm_s': SPEED, 'x load': np.round(20.0 + SPEED / 10.0)}
    made = guessed(columns)
    assert says('commanded') not in made.notes
    assert says('load_of_the_motor') in made.unstated


@pytest.mark.parametrize(('lead', 'asked'), [(10.02, False), (5.0, True), (3.3333, True)])
def test_a_log_of_screw_and_table_tells_the_lead(lead, asked, guessed, refused, says):
    """Behind a gear the speed is that of the motor, and the lead another."""
    for columns in (
        {'x_pos_mm': lead * PLACE, 'x_speed_rpm': 60.0 * TURNING},
        {'x_pos_rev': PLACE, 'x_speed_mm_s': lead * TURNING},
    ):
        made = guessed({'t_s': TIME} | columns, form='{:.9g}')
        assert ('x.lead_mm' in made.content['assumed']) is not asked
        assert len(made.unstated) == asked
        if asked:
            refused('blank_lead', make_map, made.content)
            position, speed = columns
            lead_mm = f'{lead:.3g}'
            assert made.unstated == (says('lead', position=position, speed=speed, lead=lead_mm),)


def test_a_speed_of_one_sign_alone_is_said_and_a_temperature_in_fahrenheit_asked_for(
    guessed, says
):
    made = guessed({'t_s': TIME, 'x_vel_mm_s': abs(SPEED), 'oil_temp_F': 90.0 + TIME})
    assert made.content['assumed']['x.speed.magnitude'] == {
        'value': False,
        'reason': says('one_direction'),
    }
    assert made.unstated == (says('fahrenheit'),)
    made.content['axes']['x']['temperature'] |= {'unit': 'degC', 'scale': 5 / 9}
    assert make_map(made.content).axes[0].columns['speed'].magnitude is False


def test_a_speed_tells_the_unit_of_its_position(guessed, says):
    made = guessed({'t_s': TIME, 'x_pos': PLACE / 100.0, 'x_speed_mm_s': 10.0 * TURNING})
    assert made.content['assumed']['x.position.unit']['value'] == 'm'
    made = guessed({'t_s': TIME, 'x_pos': PLACE, 'x_speed_mm_s': 10.0 * TURNING}, form='{:.9g}')
    assert made.unstated == (says('position_of_no_unit'),)


def test_of_columns_that_are_as_likely_the_map_names_one(guessed, refused, says):
    columns = {'t_s': TIME, 'X motor velocity [mm/s]': SPEED, 'X table velocity [mm/s]': SPEED}
    made = guessed(columns)
    assert made.unstated == (says('which_column'),)
    refused('blank_column', make_map, made.content)
    made.content['axes']['x']['speed']['column'] = 'X table velocity [mm/s]'
    assert make_map(made.content)


@pytest.mark.parametrize(
    ('first', 'second', 'kind'),
    [
        ('X motor position [mm]', 'X table position [mm]', 'position'),
        ('X actual position 1 [mm]', 'X actual position 2 [mm]', 'position'),
        ('X position [mm]', 'X position 2 [mm]', 'position'),
        ('X position [mm]', 'X position [mm]', 'position'),
        ('X ENC1_POS [mm]', 'X ENC2_POS [mm]', 'position'),
        ('X velocity [mm/s]', 'X velocity [mm/s]', 'speed'),
    ],
)
@pytest.mark.parametrize('factor', [1.0, 1.02, 1.5, -1.0])
def test_columns_that_contradict_each_other_are_asked_for(first, second, kind, factor, tmp_path):
    values = 1e3 * PLACE if kind == 'position' else SPEED
    rows = zip(TIME, values, factor * values + 20.0, -9.0 * TURNING, strict=True)
    lines = [','.join(f'{cell:.6g}' for cell in row) for row in rows]
    log = tmp_path / 'log.csv'
    log.write_text('\n'.join([f't [s],{first},{second},X force [N]', *lines, '']))
    made = guess(log)
    agree = abs(factor - 1.0) < 0.05
    assert made.content['axes']['x'][kind]['column'] == (first if agree else None)
    assert bool(made.unstated) is not agree


@pytest.mark.parametrize(
    'other',
    ['programmed velocity', 'velocity std', 'max velocity', 'filtered velocity', 'velocity min'],
)
def test_a_plain_name_is_the_measured_one(other, guessed):
    made = guessed({'t_s': TIME, f'X {other} [mm/s]': 2 * SPEED, 'X velocity [mm/s]': SPEED})
    assert made.content['axes']['x']['speed']['column'] == 'X velocity [mm/s]'
    assert not made.unstated


def test_a_force_and_a_speed_of_one_sign_are_asked_for(guessed, refused, says):
    made = guessed({'t_s': TIME, 'v_x [mm/s]': TURNING, 'f_x [N]': 9.0 + abs(TURNING)})
    assert made.unstated == (says('one_sign_of_force'),)
    made.content['axes']['x']['load']['magnitude'] = True
    refused('amounts_of_force', make_map, made.content)
    made.content['axes']['x']['load']['magnitude'] = False
    assert make_map(made.content)
    made = guessed({'t_s': TIME, 'v_x [mm/s]': abs(TURNING), 'm_x [Nm]': TURNING})
    assert made.unstated == (says('one_sign_of_speed'),)
    made = guessed({'t_s': TIME, 'v_x [mm/s]': abs(TURNING), 'f_x [N]': 9.0 * TURNING})
    assert made.unstated == (says('one_sign_of_speed'),)


def test_a_column_of_a_rotary_axis_is_none_of_the_only_linear_one(guessed):
    columns = {'t_s': TIME, 'C speed [rpm]': SPEED, 'Y position [mm]': 10.0 * PLACE}
    assert 'speed' not in guessed(columns).content['axes']['y']


@pytest.mark.parametrize(
    ('name', 'unit', 'scale', 'read'),
    [
        ('x force [daN]', 'N', 10.0, 'load'),
        ('x_force_kgf', 'N', 9.80665, 'load'),
        ('X load (lbf)', 'N', 4.4482216152605, 'load'),
        ('x torque [mNm]', 'N m', 1e-3, 'torque'),
        ('x_torque_Ncm', 'N m', 1e-2, 'torque'),
    ],
)
def test_a_unit_that_is_so_many_of_another_is_read(name, unit, scale, read, tmp_path, write_csv):
    force = -SPEED if read == 'load' else SPEED
    columns = {'t_s': TIME, 'x_vel_mm_s': SPEED, name: force}
    path = write_csv(tmp_path / 'log.csv', columns)
    made = guess(path)
    assert made.content['axes']['x'][read] == {'column': name, 'scale': scale, 'unit': unit}
    assert not made.unstated
    (rows,) = [rows for (rows,) in read_series(path, make_map(made.content)).blocks()]
    assert rows.columns[f'x.{read}'] == pytest.approx(force * scale, abs=1e-2)


@pytest.mark.parametrize(
    ('name', 'mm_per_s'),
    [('x speed (in/min)', 25.4 / 60), ('x_vel_um_s', 1e-3), ('x speed [deg/s]', 10 / 360)],
)
def test_a_speed_of_another_unit_turns_the_screw_as_far(name, mm_per_s, tmp_path, write_csv):
    path = write_csv(tmp_path / 'log.csv', {'t_s': TIME, name: SPEED, 'x_force_N': 1e4 * SPEED})
    (rows,) = [rows for (rows,) in read_series(path, make_map(guess(path).content)).blocks()]
    turns = rows.columns['x.speed'] / (2 * np.pi)
    assert turns * 10.0 == pytest.approx(SPEED * mm_per_s, rel=1e-3, abs=1e-4)  # lead 10 mm


def test_a_place_in_another_unit_goes_with_its_speed(guessed):
    place = 1e3 * np.cumsum(SPEED) * (TIME[1] - TIME[0])
    made = guessed({'t_s': TIME, 'X_pos_um': place, 'x_vel': SPEED}, form='{:.9g}')
    assert made.content['assumed']['x.speed.unit']['value'] == 'mm/s'


def test_a_unit_that_is_not_known_is_named(guessed, refused, says):
    made = guessed({'t_s': TIME, 'x_vel_mm_s': SPEED, 'x force [slug]': SPEED})
    assert says('unit_slug') in made.notes
    why = 'x force [slug] is in slug, which is no unit of a load that maps know'
    assert made.content['axes']['x']['load'] == {'unknown': why}
    refused('unit_furlong', guessed, {'t_s': TIME, 'x vel [furlong/h]': SPEED})


@pytest.mark.parametrize('unit', ['‰', '0.1%', '% of rated', 'per mille'])
def test_a_part_of_a_rated_torque_is_offered_as_one_of_its_per_cent(unit, guessed, says):
    made = guessed({'t_s': TIME, 'x_vel_mm_s': SPEED, f'x torque [{unit}]': SPEED})
    assert says('unit_rated', unit=unit) in made.notes


@pytest.mark.parametrize(
    ('name', 'kind', 'unit'), [('x torque [A]', 'current', 'A'), ('Effort X [N]', 'load', 'N')]
)
def test_the_unit_tells_what_a_torque_or_an_effort_is(name, kind, unit, guessed):
    made = guessed({'t_s': TIME, 'x_vel_mm_s': SPEED, name: 9.0 * SPEED})
    assert made.content['axes']['x'][kind] == {'column': name, 'unit': unit}


def test_an_axis_in_brackets_is_no_unit(guessed):
    columns = {'Time(ms)': TIME * 1e3, 'POSF(X)': 5.0 * PLACE, 'SPEED(X)(rpm)': 60.0 * TURNING}
    made = guessed(columns | {'TCMD(X)(A)': SPEED}).content
    axis = made['axes']['x']
    assert made['assumed']['x.position.unit']['value'] == 'mm'
    assert axis.pop('lead_mm') is axis.pop(CONSTANT) is None
    assert {kind: one.get('unit') for kind, one in axis.items()} == {
        'speed': 'rev/min',
        'position': None,
        'current': 'A',
    }
    axis = guessed(columns | {'TCMD(X)': SPEED}).content['axes']['x']
    assert axis['torque'] == {'column': 'TCMD(X)', 'unit': None}


@pytest.mark.parametrize('names', [('t1 [s]', 't2 [s]'), ('x_vel time [s]', 'x_torque time [s]')])
def test_times_may_be_numbered_or_named_after_their_column(names, guessed):
    first, second = names
    columns = {first: TIME, 'x_vel [mm/s]': SPEED, second: 1.0 + 1.25 * TIME}
    made = guessed(columns | {'x_torque [Nm]': SPEED}, form='{:.9g}')
    assert made.content['time'] == {'column': first, 'unit': 's'}
    assert made.content['axes']['x']['torque']['time'] == second


def test_minutes_and_seconds_of_an_hour_are_a_time(tmp_path):
    log = tmp_path / 'log.csv'
    tenths = range(35_900, 36_100)
    rows = ''.join(
        f'{at // 600 % 60:02}:{at % 600 // 10:02}.{at % 10};{at % 7};1\n' for at in tenths
    )
    log.write_text(f'time;x_vel_mm_s;x_force_N\n{rows}')
    made = guess(log)
    assert made.content['time'] == {'column': 'time', 'unit': 's'}
    (rows,) = [rows for (rows,) in read_series(log, make_map(made.content)).blocks()]
    assert np.diff(rows.stamps) / 1e9 == pytest.approx(0.1)


def test_nothing_is_said_of_numbers_whose_sign_is_open(tmp_path):
    log = tmp_path / 'log.txt'
    rows = ''.join(f'{at}\t{at},500\t{at + 1},250\n' for at in range(1, 200))
    log.write_text(f't [s]\tspeed X [m/min]\tforce X [kN]\n{rows}')
    made = guess(log)
    assert made.content['decimal'] is None
    assert made.picture[0].startswith('Group 1: an unknown period')
    assert not any('moves' in note for note in made.notes)


@pytest.mark.parametrize('order', ['ABvm', 'vAmB'])
def test_times_in_another_order_are_asked_for(order, tmp_path, write_csv, says):
    """Both first, or each behind its value: as well they may be the times of what follows."""
    columns = {
        'A': ('Time A [s]', TIME),
        'B': ('Time B [s]', 1.0 + 1.25 * TIME),
        'v': ('v_x [mm/s]', SPEED),
        'm': ('x_torque [Nm]', SPEED),
    }
    made = guess(write_csv(tmp_path / 'log.csv', dict(columns[one] for one in order)))
    assert made.unstated == (
        says('idle', kind='speed', column='v_x [mm/s]'),
        says('idle', kind='torque', column='x_torque [Nm]'),
    )


@pytest.mark.parametrize('name', ['|x velocity| [mm/s]', 'x velocity magnitude [mm/s]'])
def test_a_name_of_an_amount_is_no_speed(name, guessed):
    made = guessed({'t_s': TIME, name: SPEED, 'x position [mm]': PLACE})
    assert 'speed' not in made.content['axes']['x']


@pytest.mark.parametrize('name', ['X diameter position [mm]', 'X pos (dia) [mm]'])
def test_the_diameter_of_a_lathe_is_no_way_of_its_axis(name, guessed, refused):
    refused('column_of_diameter', guessed, {'t_s': TIME, name: PLACE})


def test_a_head_that_scales_its_columns_is_announced_and_asked_for(tmp_path, refused, says):
    log = tmp_path / 'log.csv'
    rows = [f'{at / 50:.2f},{SPEED[at]:.3f},{SPEED[at]:.3f}' for at in range(200)]
    head = ['t,x velocity,x force', 's,cm/s,N', '1,0.5,1']
    log.write_text('\n'.join([*head, *rows, '']))
    made = guess(log)
    assert made.unstated == (says('factors'), says('times_ten'))
    axes = made.content['axes']['x']
    assert axes['speed']['scale'] is None
    assert axes['load']['scale'] is None
    refused('blank_scale', make_map, made.content)
    axes['speed']['scale'], axes['load']['scale'] = 5.0, 1.0
    (rows,) = next(read_series(log, make_map(made.content)).blocks())
    assert len(rows.stamps) == 200
    expected = SPEED[50] * 5.0 * 2 * np.pi / 10.0
    assert rows.columns['x.speed'][50] == pytest.approx(expected, rel=1e-4)


SECOND_TIMES = {
    'of the axis of a diagram': (['Time [ms]', 'v', 'X-Axis [ms]', 'm'], 'read'),
    'of a letter': (['X [s]', 'v', 'X [ms]', 'm'], 'asked'),
    'without a name': (['Time [ms]', 'v', '', 'm'], 'asked'),
    'by pandas': (['Time [ms]', 'v', 'Unnamed: 2', 'm'], 'asked'),
    'without a name before': (['', 'v', 'Time [ms]', 'm'], 'asked'),
    'behind': (['v', 'Time A [ms]', 'm', 'Time B [ms]'], 'asked'),
    'behind, the last without': (['v', 'Time A [ms]', 'm', ''], 'asked'),
    'behind the first of three': (['p', 'Time A [ms]', 'v', 'Time B [ms]', 'm'], 'asked'),
}


@pytest.mark.parametrize('kind', SECOND_TIMES)
@pytest.mark.parametrize('late', [2.0, 0.37])
def test_a_second_time_is_that_of_its_column_or_asked_for(kind, late, tmp_path, refused, says):
    heads, outcome = SECOND_TIMES[kind]
    names = {'v': 'X_vel [mm/s]', 'm': 'X_torque [Nm]', 'p': 'X_pos [mm]'}
    columns = {'v': SPEED, 'm': SPEED / 50.0, 'p': 100.0 * (1.0 - np.cos(TIME))}
    stamps = iter([TIME, TIME + late])
    cells = [columns[one] if one in columns else 1e3 * next(stamps) for one in heads]
    if heads[0] == 'X [s]':
        cells[0] = cells[0] / 1e3
    rows = [';'.join(f'{cell:.4f}' for cell in row) for row in zip(*cells, strict=True)]
    log = tmp_path / 'log.csv'
    log.write_text('\n'.join([';'.join(names.get(one, one) for one in heads), *rows, '']))
    made = guess(log)
    if outcome == 'asked':
        if kind == 'without a name':
            assert made.unstated == (says('unnamed_time'),)
        refused('blank_own_time', make_map, made.content)
        return
    blocks = list(read_series(log, make_map(made.content)).blocks())
    stamps = [np.concatenate([groups[at].stamps for groups in blocks]) for at in (0, 1)]
    assert (stamps[1][0] - stamps[0][0]) / 1e9 == pytest.approx(late, abs=1e-6)


def test_an_unnamed_index_before_a_time_is_no_second_time(guessed):
    columns = {'': np.arange(200.0), 't_s': TIME, 'x_vel_mm_s': SPEED, 'x_force_N': SPEED}
    made = guessed(columns)
    assert made.content['time'] == {'column': 't_s', 'unit': 's'}
    assert not made.unstated


@pytest.mark.parametrize(('factor', 'unit'), [(1.0, 'mm/s'), (6.0, 'rpm')])
def test_a_speed_against_its_position_is_asked_for(factor, unit, guessed, refused, says, tmp_path):
    place = 100.0 * (1.0 - np.cos(TIME))
    columns = {'t_s': TIME, 'x_pos_mm': place, f'x_vel [{unit}]': -factor * SPEED}
    made = guessed(columns, form='{:.6g}')
    assert made.unstated == (says('turned', speed=f'x_vel [{unit}]'),)
    refused('blank_scale', make_map, made.content)
    speed = made.content['axes']['x']['speed']
    for scale in (-1.0, 1.0):
        speed['scale'] = scale
        mapping = make_map(made.content)
        if scale > 0.0:
            refused('still_turned', read_series, tmp_path / 'log.csv', mapping)
        else:
            assert read_series(tmp_path / 'log.csv', mapping).count == 200


def test_amounts_that_are_seen_late_are_none_the_less(tmp_path, monkeypatch):
    """An axis that goes one way for long, and reverses in some of the last rows of the log."""
    monkeypatch.setattr(read_module, 'MOST_ROWS', 4000)
    monkeypatch.setattr(read_module, 'PIECE', 100)
    monkeypatch.setattr(guess_module, 'NUMBERS', 2000)
    rows = np.arange(30_000)
    speed = 50.0 * np.abs(np.sin(rows / 150.0)) * np.where(rows > 27_000, -1.0, 1.0)
    torque = 0.02 * np.abs(speed) + 1.0
    text = [f'{at / 100:.2f};{v:.3f};{m:.4f}' for at, v, m in zip(rows, speed, torque)]
    log = tmp_path / 'log.csv'
    log.write_text('\n'.join(['t [s];x velocity [mm/s];x torque [Nm]', *text, '']))
    made = guess(log)
    assert made.content['axes']['x']['torque']['magnitude'] in (True, None)
    made.content['axes']['x']['torque'].pop('magnitude')
    series = read_series(log, make_map(made.content)) if made.unstated == () else None
    assert series is None or series.mapping.axes[0].columns['torque'].magnitude


def log_below(head, names, path):
    """Return a log of two rising and falling columns below a head."""
    rows = ''.join(f'{at / 50};{at % 7 - 3};{at % 5 - 2}\n' for at in range(60))
    path.write_text(f'{head}\n{names}\n{rows}')
    return path


@pytest.mark.parametrize(
    ('line', 'names', 'key', 'value'),
    [
        ('Lead: 5 mm', 't [s];x velocity [mm/s];x force [N]', 'lead_mm', 5.0),
        ('Spindelsteigung: 5 mm', 't [s];x velocity [mm/s];x force [N]', 'lead_mm', 5.0),
        ('Steigung [mm];5', 't [s];x velocity [mm/s];x force [N]', 'lead_mm', 5.0),
        ('Ball screw pitch: 5.0 mm', 't [s];x velocity [mm/s];x force [N]', 'lead_mm', 5.0),
        ('lead_mm: 5.0', 't [s];x velocity [mm/s];x force [N]', 'lead_mm', 5.0),
        ('Torque constant: 0.8 Nm/A', 't [s];x velocity [mm/s];x current [A]', CONSTANT, 0.8),
        ('Kt = 0,8 N m/A', 't [s];x velocity [mm/s];x current [A]', CONSTANT, 0.8),
        (
            'Oil temperature: 70 °C',
            't [s];x velocity [mm/s];x force [N]',
            'temperature_degC',
            70.0,
        ),
    ],
)
def test_what_the_head_says_of_the_machine_is_taken_from_it(line, names, key, value, tmp_path):
    content = guess(log_below(line, names, tmp_path / 'log.csv')).content
    place = content['assumed'][f'x.{key}']
    assert place['value'] == value
    assert line in place['reason']


@pytest.mark.parametrize(
    ('line', 'names', 'key'),
    [
        ('# ball screw 32x5', 't [s];x velocity [mm/s];x force [N]', 'lead_mm'),
        ('Screw: 32 x 5', 't [s];x velocity [mm/s];x force [N]', 'lead_mm'),
        ('Pitch: 5 mm', 't [s];x velocity [mm/s];x force [N]', 'lead_mm'),
        ('Lead: 5', 't [s];x velocity [mm/s];x force [N]', 'lead_mm'),
        ('Lead: 5 mm\nLead: 10 mm', 't [s];x velocity [mm/s];x force [N]', 'lead_mm'),
        ('Torque constant: 0.8', 't [s];x velocity [mm/s];x current [A]', CONSTANT),
        ('Gear ratio: 3', 't [s];x motor speed [rpm];x force [N]', 'speed.scale'),
        ('Gear ratio: 3', 't [s];x velocity [mm/s];x torque [Nm]', 'torque.scale'),
    ],
)
def test_what_the_head_may_say_of_the_machine_is_named_in_a_question(line, names, key, tmp_path):
    result = guess(log_below(line, names, tmp_path / 'log.csv'))
    (asked,) = [why for why in result.unstated if f'axes.x.{key}' in why]
    assert all(part in asked for part in line.split('\n'))


def test_a_lead_in_the_head_that_position_and_speed_contradict_is_asked_for(tmp_path):
    moved = np.cumsum(200.0 * np.sin(np.arange(400) / 9) / 50.0)
    rows = ''.join(
        f'{at / 50};{moved[at] / 10.0 * 360.0};{200.0 * math.sin(at / 9)}\n' for at in range(400)
    )
    log = tmp_path / 'log.csv'
    log.write_text(f'Lead: 5 mm\nt [s];x position [deg];x velocity [mm/s]\n{rows}')
    result = guess(log)
    assert result.content['axes']['x']['lead_mm'] is None
    assert any('Lead: 5 mm' in why and '10' in why for why in result.unstated)


def test_an_oil_of_the_head_is_named_beside_the_one_that_is_taken(tmp_path):
    names = 't [s];x velocity [mm/s];x force [N]'
    content = guess(log_below('Oil: ISO VG 220', names, tmp_path / 'log.csv')).content
    assert 'Oil: ISO VG 220' in content['assumed']['x.oil']['reason']


@pytest.mark.parametrize('in_turn', [True, False])
@pytest.mark.parametrize(
    ('column', 'cells'),
    [
        ('axis', 'XY'),
        ('Achse', '12'),
        ('device', 'AB'),
        ('Serial', '57'),
        ('Machine', ('M1', 'M2')),
    ],
)
def test_rows_of_several_axes_or_machines_are_refused(column, cells, in_turn, tmp_path, refused):
    rows = [(at / 50, cell, at % 7 - 3) for at in range(60) for cell in cells]
    rows = rows if in_turn else sorted(rows, key=lambda row: row[1])
    text = ''.join(f'{time};{cell};{speed}\n' for time, cell, speed in rows)
    log = tmp_path / 'log.csv'
    log.write_text(f't [s];{column};velocity [mm/s]\n{text}')
    with refused('several', column=repr(column), cells=', '.join(cells)):
        guess(log)


def test_a_column_of_one_axis_alone_refuses_nothing(tmp_path):
    rows = ''.join(f'{at / 50};X;{at % 7 - 3}\n' for at in range(60))
    log = tmp_path / 'log.csv'
    log.write_text(f't [s];axis;velocity [mm/s]\n{rows}')
    assert guess(log).content['axes']


@pytest.mark.parametrize('part', ['ms', 'Millisecond'])
@pytest.mark.parametrize('rows', [50, 100])
def test_whole_seconds_and_their_parts_apart_are_one_time(part, rows, tmp_path):
    text = ''.join(
        f'12:00:{second:02d};{10 * row};{100.0 + second + row / 100}\n'
        for second in range(12)
        for row in range(rows)
    )
    log = tmp_path / 'log.csv'
    log.write_text(f'Time;{part};x position [mm]\n{text}')
    assert guess(log).content['time']['column'] == f'time of Time, {part}'


@pytest.mark.parametrize('mark', [-9999.0, 999.9, 32767.0, 655.35, 327.67])
@pytest.mark.parametrize('place', ['x_velocity_mm_s', 'x_force_N'])
def test_a_number_that_may_stand_for_no_value_is_asked_for(
    mark, place, write_csv, tmp_path, says, refused
):
    """By the map, too, which reads it as a value or as none."""
    time = np.arange(400) / 50.0
    columns = {'t_s': time, 'x_velocity_mm_s': 100.0 * np.sin(time)}
    columns['x_force_N'] = 0.8 * columns['x_velocity_mm_s']
    kind = {'x_velocity_mm_s': 'speed', 'x_force_N': 'load'}[place]
    columns[place] = columns[place].copy()
    columns[place][50:54] = mark
    log = write_csv(tmp_path / 'log.csv', columns, form='{:.7g}')
    made = guess(log)
    question = says('mark_of_none', kind=kind, column=place, mark=f'{mark:g}')
    assert question in made.unstated
    axis = made.content['axes']['x'][kind]
    assert axis.pop('none') is None
    with pytest.raises(InputError, match='stands for no value'):
        read_series(log, make_map(made.content))
    for none, unknown in (([mark], 4), ([], 0)):
        axis['none'] = none
        (rows,) = next(read_series(log, make_map(made.content)).blocks())
        assert np.count_nonzero(np.isnan(rows.columns[f'x.{kind}'])) == unknown
    axis['none'] = mark
    refused('none_is_a_list', make_map, made.content)


@pytest.mark.parametrize(
    ('marks', 'stated'),
    [
        ((-9999.0, 9999.0), (-9999.0,)),
        ((-9999.0, 9999.0), (9999.0,)),
        ((-32768.0, -9999.0), (-32768.0,)),
        ((-9999.0, 999.9, 32767.0), (999.9, 32767.0)),
    ],
)
def test_each_number_that_may_stand_for_no_value_is_asked_for_until_it_is_stated(
    marks, stated, tmp_path, write_csv, says, refused
):
    time = np.arange(400) / 50.0
    columns = {'t_s': time, 'x_velocity_mm_s': 100.0 * np.sin(time)}
    columns['x_force_N'] = 150.0 * np.cos(time)
    for at, mark in enumerate(marks):
        columns['x_force_N'][slice(50 + 60 * at, 54 + 60 * at)] = mark
    log = write_csv(tmp_path / 'log.csv', columns, form='{:.7g}')
    made = guess(log)
    every, left = ([f'{one:g}' for one in some] for some in (marks, {*marks} - {*stated}))
    words = {'every': ', '.join(every), 'told': ' and '.join(every)}
    rows = ' and '.join(['4 rows'] * len(marks))
    assert says('marks_of_none', **words, rows=rows) in made.unstated
    load = made.content['axes']['x']['load']
    load['none'] = [*stated]
    words['known'] = ' and '.join(f'{one:g}' for one in stated)
    with refused('another_mark_of_none', every=words['every'], mark=left[0], known=words['known']):
        read_series(log, make_map(made.content))
    for none, unknown in (([*marks], 4 * len(marks)), ([], 0)):
        load['none'] = none
        (block,) = next(read_series(log, make_map(made.content)).blocks())
        assert np.count_nonzero(np.isnan(block.columns['x.load'])) == unknown


@pytest.mark.parametrize('mark', [999.9, 655.35, 327.67])
@pytest.mark.parametrize('slow', [True, False])
def test_a_full_number_near_others_is_a_mark_where_it_is_reached_in_a_leap(
    mark, slow, write_csv, tmp_path, says
):
    force = 0.91 * mark * np.sin(TIME / 2.0)
    held = np.arange(len(TIME)) // 4 == 20
    way = np.minimum(np.arange(len(TIME)) / 80.0, 1.0) if slow else 0.9
    columns = {'t_s': TIME, 'x_velocity_mm_s': SPEED}
    columns['x_force_N'] = np.where(held, mark, force if not slow else mark * way * 0.999)
    log = write_csv(tmp_path / 'log.csv', columns, form='{:.7g}')
    if slow:
        assert guess(log).content['axes']['x']['load']
        return
    question = says('mark_of_none', kind='load', column='x_force_N', mark=f'{mark:g}')
    assert question in guess(log).unstated


@pytest.mark.parametrize(('mark', 'count'), [(9999.0, 2), (9990.0, 10), (9999.0, 150), (99.0, 9)])
def test_few_or_many_or_common_numbers_stand_for_themselves(mark, count, write_csv, tmp_path):
    columns = {'t_s': TIME, 'x_velocity_mm_s': SPEED, 'x_force_N': 0.3 * SPEED}
    columns['x_force_N'][slice(50, 50 + count)] = mark
    log = write_csv(tmp_path / 'log.csv', columns, form='{:.7g}')
    assert guess(log).content['axes']['x']['load']


@pytest.mark.parametrize(
    ('name', 'position', 'asked'),
    [
        ('x motor speed [rpm]', False, True),
        ('x speed [rpm]', False, False),
        ('x motor velocity [mm/s]', False, False),
        ('x motor speed [rpm]', True, False),
    ],
)
def test_the_speed_of_a_motor_is_said_to_be_that_of_the_screw(name, position, asked, guessed):
    """The position of the table tells a gear by the lead."""
    columns = {'t_s': TIME, name: 60.0 * TURNING, 'x_force_N': SPEED}
    columns |= {'x_pos_mm': 10.0 * PLACE} if position else {}
    assumed = guessed(columns, form='{:.9g}').content['assumed']
    assert ('x.speed.scale' in assumed) is asked
    assert not asked or assumed['x.speed.scale']['value'] == 1.0


def test_all_that_names_the_motor_is_assumed_to_be_of_the_screw(guessed):
    """A gear of 2 in the file of a drive: none of its signals is of the table."""
    columns = {'t_s': TIME, 'X motor speed [rpm]': 120.0 * TURNING}
    columns |= {'X motor position [deg]': 720.0 * PLACE, 'X motor torque [Nm]': SPEED}
    made = guessed(columns, form='{:.9g}')
    kinds = ('speed', 'position', 'torque')
    assert {kind: made.content['assumed'][f'x.{kind}.scale']['value'] for kind in kinds} == (
        dict.fromkeys(kinds, 1.0)
    )
    assert {column.scale for column in make_map(made.content).axes[0].columns.values()} == {1.0}


@pytest.mark.parametrize(
    ('name', 'value', 'unit', 'factor'),
    [
        ('X motor torque [Ncm]', 50.0, 'N m', 0.01),
        ('X motor torque [mNm]', 500.0, 'N m', 1e-3),
        ('X motor torque [lbf ft]', 0.4, 'N m', 1.3558179483314004),
        ('X motor speed [deg/s]', 360.0, 'rev/min', 1.0 / 6.0),
        ('X drive speed [rev/s]', 1.0, 'rev/min', 60.0),
    ],
)
def test_a_unit_that_is_converted_leaves_the_gear_of_the_motor_assumed(
    name, value, unit, factor, guessed, says
):
    kind = 'torque' if 'torque' in name else 'speed'
    columns = {'t_s': TIME, name: value * np.sin(TIME)}
    columns |= {'X speed [mm/s]': SPEED} if kind == 'torque' else {'X force [N]': SPEED}
    made = guessed(columns, form='{:.9g}')
    assert not made.unstated
    assumed = made.content['assumed'][f'x.{kind}.scale']
    assert assumed['value'] == pytest.approx(factor, rel=1e-12)
    assert assumed['reason'] == says('no_gear', column=name)
    column = make_map(made.content).axes[0].columns[kind]
    assert (column.unit, column.scale) == (unit, assumed['value'])


def test_an_assumed_gear_leaves_the_sign_of_a_torque_in_doubt(write_csv, refused, tmp_path):
    """A torque against all motion is asked for in a log that is read by the map of another."""
    path, torque = tmp_path / 'log.csv', 'X motor torque [Nm]'
    columns = {'t_s': np.arange(800) / 50.0, 'X speed [mm/s]': 50.0 * SQUARE, torque: SQUARE}
    mapping = make_map(guess(write_csv(path, columns)).content)
    assert mapping.axes[0].columns['torque'].scale == 1.0
    write_csv(path, columns | {torque: -SQUARE})
    refused('brakes', read_series, path, mapping)


def test_a_scope_that_writes_a_time_before_each_signal_leaves_no_time_idle(tmp_path):
    names = ['X SetVelo [mm/s]', 'X ActVelo [mm/s]', 'X PosDiff [mm]', 'X ActForce [N]']
    values = np.column_stack([1.2 * SPEED, SPEED, 0.01 * SPEED, 9.0 * SPEED])
    rows = [
        '\t'.join(f'{1e3 * time:.0f}\t{value:.4f}' for value in row)
        for time, row in zip(TIME, values, strict=True)
    ]
    head = '\t'.join(f'Name\t{name}' for name in names)
    log = tmp_path / 'log.csv'
    log.write_text('\n'.join(['NetId\t5.24', head, *rows, '']))
    result = guess(log)
    speed = result.content['axes']['x']['speed']
    assert (speed['column'], speed['time']) == (names[1], 'Name_duplicated_0')
    assert not [why for why in result.unstated if '.time' in why]


@pytest.mark.parametrize('rate', [1, 4, 10])
def test_a_torque_of_another_group_has_the_signs_of_all_its_rows(rate, tmp_path, write_csv):
    """Its first rows are those of the first motion alone, in which it has one sign."""
    count = len(TIME) // rate
    columns = {
        'Time 1 [s]': [*TIME[::rate][:count], *[''] * (len(TIME) - count)],
        'X velocity [mm/s]': [*SPEED[::rate][:count], *[''] * (len(TIME) - count)],
        'Time 2 [s]': TIME,
        'X torque [Nm]': 2.0 * np.sign(SPEED),
    }
    lines = [
        ','.join(f'{cell:.7g}' if cell != '' else '' for cell in row)
        for row in zip(*columns.values(), strict=True)
    ]
    log = tmp_path / 'log.csv'
    log.write_text('\n'.join([','.join(columns), *lines, '']))
    result = guess(log)
    assert 'magnitude' not in result.content['axes']['x']['torque']
    assert read_series(log, make_map(result.content))


@pytest.mark.parametrize(
    ('least', 'unit'),
    [(-30.0, 'degC'), (35.0, 'degC'), (293.0, 'K'), (-90.0, None), (180.0, None)],
)
def test_the_unit_of_a_temperature_is_said_or_asked_for_if_no_oil_has_it(
    least, unit, guessed, says
):
    column = 'x oil temperature'
    warmth = least + 30.0 * np.linspace(0.0, 1.0, len(TIME))
    made = guessed({'t_s': TIME, 'x_vel_mm_s': SPEED, column: warmth})
    told = {'least': f'{least:.3g}', 'most': f'{least + 30.0:.3g}'}
    if unit is None:
        assert made.unstated == (says('temperature_of_no_unit', **told),)
    else:
        assert says('temperature_taken', unit=unit, **told) in made.notes
        assert made.content['assumed']['x.temperature.unit']['value'] == unit


def test_a_warm_temperature_without_a_unit_may_be_in_degF(guessed, says):
    """68 degF are 20 degC, and 68 degC another oil."""
    made = guessed({'t_s': TIME, 'x_vel_mm_s': SPEED, 'x oil temperature': 68.0 + 0.1 * TIME})
    least, most = '68', f'{68.0 + 0.1 * TIME[-1]:.3g}'
    assert made.unstated == (says('temperature_maybe_in_degF', least=least, most=most),)


def test_parts_of_one_in_a_column_of_per_cent_are_asked_for(guessed, says):
    """A workbook shows 0.5 as 50 %, and holds 0.5."""
    part = 0.5 * np.cos(TIME)
    made = guessed({'t_s': TIME, 'x_vel_mm_s': SPEED, 'X torque [%]': part})
    assert says('part_or_per_cent') in made.unstated
    made = guessed({'t_s': TIME, 'x_vel_mm_s': SPEED, 'X torque [%]': 100.0 * part})
    assert made.content['axes']['x']['torque']['unit'] == '%'


@pytest.mark.parametrize('shift', [0.5, 0.0025])
def test_each_signal_of_labview_has_the_times_before_it(shift, tmp_path):
    """X_Columns Multi: two columns are called X_Value, those of the force are later."""
    rows = [
        f'{0.01 * at:.4f}\t{90.0 * math.sin(at / 40):.4f}\t{0.01 * at + shift:.4f}\t{-900 - at}'
        for at in range(400)
    ]
    head = ['LabVIEW Measurement', 'Separator\tTab', 'X_Columns\tMulti', '***End_of_Header***']
    names = 'X_Value\tX speed [mm/s]\tX_Value\tX force [N]\tComment'
    path = tmp_path / 'log.lvm'
    path.write_text('\n'.join([*head, names, *rows]))
    content = guess(path).content
    assert content['time'] == {'column': 'X_Value', 'unit': 's'}
    assert content['axes']['x']['load']['time'] == 'X_Value_duplicated_0'


def test_an_oil_temperature_in_an_unknown_unit_is_asked_for(guessed, says):
    """176 degF are 80 degC, which is not the usual 40 degC."""
    log = {'t_s': TIME, 'x_vel_mm_s': SPEED, 'Oil temperature [°F]': 176.0 + 0.1 * TIME}
    made = guessed(log)
    assert says('temperature_in_degF') in made.unstated
    assert 'x.temperature_degC' not in made.content['assumed']
    log = {'t_s': TIME, 'x_vel_mm_s': SPEED, 'Motor temperature [°F]': 176.0 + 0.1 * TIME}
    assert guessed(log).content['assumed']['x.temperature_degC']['value'] == 40.0
