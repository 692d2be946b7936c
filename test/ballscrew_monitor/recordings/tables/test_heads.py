# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Heads of tables: the block of numbers is found, and what stands above it names its columns."""

import math

from ballscrew_monitor.recordings.tables.heads import cells_of, find_head, Line
from ballscrew_monitor.recordings.tables.mapping import make_map
from ballscrew_monitor.recordings.tables.quantities import Layout
from ballscrew_monitor.recordings.tables.series import read_series
from ballscrew_monitor.recordings.tables.sources import source_of
from hypothesis import given, strategies
import numpy as np
import pytest


def head_of(text, layout=None):
    lines = [Line(raw=line, row=number + 1) for number, line in enumerate(text.split('\n'))]
    return find_head(lines, layout)


@pytest.mark.parametrize(
    ('text', 'names', 'first'),
    [
        ('t,v\n0,1\n1,2', ['t', 'v'], 2),
        ('# a comment\n\nt;v\n0;1\n1;2', ['t', 'v'], 4),
        ('# t;v\n0;1\n1;2', ['t', 'v'], 2),
        ('Maschine: 3\nt;v\n0;1\n1;2', ['t', 'v'], 3),
        (
            'Rate;100\nKunde;Meier\n\nt;v;F\ns;mm/s;N\n0;1;2\n1;2;3',
            ['t [s]', 'v [mm/s]', 'F [N]'],
            6,
        ),
        ('t;v;F\ns;mm/s;N\nREAL;REAL;INT\n0;1;2\n1;2;3', ['t [s]', 'v [mm/s]', 'F [N]'], 4),
        ('made,on\nt,v,F\n0,1,2\n1,2,3', ['t', 'v', 'F'], 3),
        ('t;v\n[s];[mm/s]\n0;1\n1;2', ['t [s]', 'v [mm/s]'], 3),
        ('t;text\n0;x\n1;y', ['t', 'text'], 2),
        ('1;2\n3;4', ['column 1', 'column 2'], 1),
        ('t\tF\n2026-01-02T03:04:05Z\t-1e3\n', ['t', 'F'], 2),
        ('Datum;Uhrzeit;v\n01.02.2026;03:04:05,5;1,5', ['Datum', 'Uhrzeit', 'v'], 2),
        ('0 1.5  2\n1 1.6  2 \n', ['column 1', 'column 2', 'column 3'], 1),
        ('Time\nX position\nX speed\n0 1.5 2\n1 1.6 2', ['Time', 'X position', 'X speed'], 4),
        ('Column 1: Time [s]\nColumn 2: X speed\n0 2\n1 2', ['Time [s]', 'X speed'], 3),
        ('sep=;\nt;v\n0,5;1\n1,5;2', ['t', 'v'], 3),
        ('"Time (s)","X ""speed"""\n"0","1"\n"1","2"', ['Time (s)', 'X "speed"'], 2),
    ],
)
def test_names_stand_above_the_numbers_in_whatever_way(text, names, first):
    head = head_of(text)
    assert (list(head.names), head.first) == (names, first)
    assert head.named == (names[0] != 'column 1')


def test_cells_of_a_column_are_known_where_rows_end_with_a_sign():
    text = 't;v;F\n' + ''.join(f'{at};{at}.5;{at} N;\n' for at in range(5))
    lines = [Line(raw=line, row=row + 1) for row, line in enumerate(text.splitlines())]
    head = find_head(lines)
    assert cells_of(lines, head)[head.names[2]] == [f'{at} N' for at in range(5)]


def test_names_that_repeat_say_of_longer_ones_what_these_are():
    """As TwinCAT Scope writes two axes: short names of the quantities, long ones of the tags."""
    rows = [
        ['Name', 'ActVelo', 'ActTorque', 'Name', 'ActVelo', 'ActTorque'],
        ['SymbolName', 'Axes.X.Vel', 'Axes.X.Tq', 'SymbolName', 'Axes.Y.Vel', 'Axes.Y.Tq'],
        *[[str(at)] * 6 for at in range(5)],
    ]
    head = head_of('\n'.join(map('\t'.join, rows)))
    assert [head.symbols[name] for name in head.names] == rows[0]
    assert list(head.names)[1:3] == rows[1][1:3]


@pytest.mark.parametrize(
    ('name', 'cell', 'differs'),
    [
        ('x force [N]', 'kN', True),
        ('x velocity [mm/s]', 'm/min', True),
        ('x_velocity_mm_s', '[in/s]', True),
        ('x position [mm]', 'um', True),
        ('t [s]', 'ms', True),
        ('x speed [rpm]', '1/min', False),
        ('x force [N]', 'N', False),
        ('x torque [Nm]', 'N m', False),
        ('x force', 'kN', False),
    ],
)
@pytest.mark.parametrize('first', ['name', 'unit'])
def test_a_name_and_the_row_of_units_that_contradict_it_are_refused(name, cell, differs, first):
    rows = {'name': f'Name;n;{name};Valve', 'unit': f'Unit;1;{cell};V'}
    text = '\n'.join([rows.pop(first), *rows.values(), ';0;1;2', ';1;1;2', ''])
    if not differs:
        assert head_of(text).names[2].startswith(name)
        return
    with pytest.raises(ValueError, match='states another unit than the row of units') as caught:
        head_of(text)
    assert repr(name) in str(caught.value)
    assert cell in str(caught.value)


@pytest.mark.parametrize(
    ('name', 'cell', 'called'),
    [
        ('Drehzahl (X)', 'rpm', 'Drehzahl (X) [rpm]'),
        ('Drehzahl (ist)', 'rpm', 'Drehzahl (ist) [rpm]'),
        ('Drehzahl (Achse 1)', '1/s', 'Drehzahl (Achse 1) [1/s]'),
        ('Position (A)', 'inch', 'Position (A) [inch]'),
        ('Position (C)', 'inch', 'Position (C) [inch]'),
        ('Strom (A)', 'A', 'Strom (A)'),
        ('Position [mm]', 'mm', 'Position [mm]'),
        ('Drehzahl', '1/s', 'Drehzahl [1/s]'),
        ('Nut temperature (X)', '°F', 'Nut temperature (X) [°F]'),
        ('Nut temperature', '-', 'Nut temperature'),
        ('Programm (alt)', 'REAL', 'Programm (alt)'),
    ],
)
def test_a_unit_below_a_name_is_that_of_its_column(name, cell, called):
    text = f't;{name};F\ns;{cell};N\n' + 9 * '0;1;2\n'
    assert head_of(text).names == ('t [s]', called, 'F [N]')


@given(strategies.lists(strategies.text(max_size=20), max_size=9))
def test_whatever_the_lines_are_there_is_a_head_within_them_or_none(lines):
    try:
        head = head_of('\n'.join(lines))
    except ValueError:
        return
    assert head.begin <= sum(line.count('\n') + 1 for line in lines) + 1
    assert len(set(head.names)) == len(head.names)


def test_a_map_may_state_where_the_names_stand():
    text = 'v;F;x;t\nmm/s;[N];left;\n1;2;3;4\n1;2;3;4'
    head = head_of(text, Layout(header_rows=2))
    assert head.names == ('v [mm/s]', 'F [N]', 'x left', 't')
    assert head_of(text, Layout(skip=1)).names == ('mm/s', '[N]', 'left', '')
    assert head_of(text, Layout(skip=2, header_rows=0)).names[0] == 'column 1'
    with pytest.raises(ValueError, match='no line names its columns'):
        head_of('#\n\n', Layout())


@pytest.mark.parametrize(
    ('line', 'period'),
    [
        ('# Sampling period is 1000000 ns', 1e-3),
        ('Sample rate: 250 Hz', 4e-3),
        ('Sample time [ms];20', 0.02),
        ('Abtastrate = 2 kHz', 5e-4),
        ('dt;0,01', 0.01),
        ('Operator: 12', None),
        ('Sample period: 20 [ms]', 0.02),
        ('Sample rate: 6000 /min', None),
        ('Sample rate [1/min]: 6000', None),
        ('Sample rate: 100 Sa/s', None),
        ('Sample time: 1 ms x 10', None),
        ('Sample rate: 6 kHz / 60', None),
    ],
)
def test_a_period_is_found_wherever_it_stands(line, period):
    head = head_of(f'{line}\nX pos;X speed;X force\n1;2;3\n2;3;4\n3;4;5')
    assert (
        head.period == pytest.approx(period, nan_ok=True) if period else head.period != head.period
    )


def test_a_remark_about_a_name_does_not_name_the_columns():
    head = head_of('Name;x\nTimestamp;ActVelo [mm/s];Force [N]\n1;2;3\n2;3;4\n3;4;5')
    assert head.names == ('Timestamp', 'ActVelo [mm/s]', 'Force [N]')


def test_rows_that_begin_with_an_empty_cell_are_told_from_those_about_columns():
    head = [
        'Samples\t90\t90',
        'X0\t0.0\t0.0',
        'Delta_X\t0.01\t0.01',
        'X_Value\tPosition Z\tForce Z',
    ]
    rows = [f'\t{at}.5\t{at}.25' for at in range(30)]
    lines = [Line(raw=raw, row=row + 1) for row, raw in enumerate([*head, *rows])]
    found = find_head(lines)
    assert (found.names, found.first) == (('X_Value', 'Position Z', 'Force Z'), 5)
    assert found.period == 0.01


@pytest.mark.parametrize(
    ('rows', 'period'),
    [
        ('SampleRate,1.0E+02,1.0E+02', 0.01),
        ('HResolution,1.0E-02,1.0E-02', 0.01),
        ('SampleRate,1.0E+02,1.0E+02\nHResolution,1.0E-02,1.0E-02', 0.01),
        ('SampleRate,1.0E+03,1.0E+03\nHResolution,1.0E-02,1.0E-02', None),
        ('SampleRate,1.0E+02,1.0E+01', None),
        ('Sampling rate,100 Hz,100 Hz', 0.01),
        ('wf_increment,0.01,0.01', 0.01),
    ],
)
def test_rows_of_periods_and_rates_of_columns_agree_or_state_none(rows, period):
    head = 'TraceName,"X velocity","X force"\nVUnit,mm/s,N\n'
    found = head_of(f'{head}{rows}\nHUnit,s,s\n' + 9 * ',1.5,-2.5\n')
    assert found.names[1:] == ('X velocity [mm/s]', 'X force [N]')
    assert not found.factors
    assert found.period == period if period else math.isnan(found.period)


@pytest.mark.parametrize(
    ('text', 'factors'),
    [
        ('Name;v;F\nScaleFactor;0.1;1\nOffset;0;0\n', 'ScaleFactor 0.1 1'),
        ('Name;v;F\nScale;1;1.0\nOffset;0;5\n', 'Offset 0 5'),
        ('t;v;F\nGain;2;1\n', 'Gain 2 1'),
        ('v scale: 2\nt;v;F\n', 'v scale: 2'),
        ('t;v;F\ns;mm/s;N\nMultiplier;2;2\n', 'Multiplier 2 2'),
        ('t;v;F\ns;mm/s;N\nNorm.;0.5;2\n', 'Norm. 0.5 2'),
        ('t;v;F\ns;mm/s;N\nDecimals;2;1\n', 'Decimals 2 1'),
        ('t;v;F\ns;mm/s;N\nMin;-40;-610\nMax;75;910\n', ''),
        ('t;v;F\ns;mm/s;N\nMultiplier;1;1\n', ''),
        ('Calibration factor: 2\nt;v;F\n', 'Calibration factor: 2'),
        ('Scaling factor = 2\nt;v;F\n', 'Scaling factor = 2'),
        ('Gain (v): 2\nt;v;F\n', 'Gain (v): 2'),
        ('v resolution: 2 mm/s\nt;v;F\n', 'v resolution: 2 mm/s'),
        ('All values x 2\nt;v;F\n', 'All values x 2'),
        ('Scaling: v = raw / 10\nt;v;F\n', 'Scaling: v = raw / 10'),
        ('Gain X force: 2.5\nt;v;F\n', 'Gain X force: 2.5'),
        ('Gain of v: 2\nt;v;F\n', 'Gain of v: 2'),
        ('Conversion factor X Force [N/V]: 200\nt;v;F\n', 'Conversion factor X Force [N/V]: 200'),
        ('Gain X force: 1.0\nt;v;F\n', ''),
        ('Offset table: 5\nt;v;F\n', ''),
        ('Multiplier: 1.0\nt;v;F\n', ''),
        ('Name;v;F\nScaleFactor;1;1\nOffset;0;0.0\n', ''),
        ('Name;v;F\nGain;1.0E+00;1.0E+00\nOffset;0.0E+00;0.0E+00\n', ''),
        ('TraceName;v;F\nHResolution;1.0E-02;1.0E-02\n', ''),
        ('Name;v;F\nLength;1200;1200\n', ''),
        ('t0;14.07.2025;14.07.2025\nt;v;F\n', ''),
    ],
)
def test_a_row_that_scales_the_cells_is_known(text, factors):
    assert head_of(text + 9 * '1;2;3\n').factors == factors


@pytest.mark.parametrize('units', ['', 's;mm/s;N\n'])
@pytest.mark.parametrize('row', ['0.1;0.1', '0,1;0,1', '1e-1;1e-1'])
@pytest.mark.parametrize('label', ['k', 'K', 'm', 'a', 'N', 'C', 'A', 's', 'ms', 'd'])
def test_a_letter_before_numbers_names_factors_unless_it_is_a_unit_of_a_time(label, row, units):
    text = f't;v;F\n{units}{label};{row}\n'
    numbers = ''.join(f'0.{at}00;2;3\n' for at in range(9))
    factors = '' if label in ('s', 'ms', 'd') else f'{label} {row.replace(";", " ")}'
    assert head_of(text + numbers).factors == factors


BARE = ['1,0.5,1', '1;0,5;2,0', '1e-3;0.5;1', '1.0;1;1', '0.001;2;1']


@pytest.mark.parametrize('row', BARE)
@pytest.mark.parametrize('first', [0.0, 2.5, 30.0])
def test_a_row_of_factors_is_none_of_the_rows_however_it_is_written(row, first):
    sign = ';' if ';' in row else ','
    rows = [f'{first + at / 100:.2f}{sign}{at % 7}.5{sign}{at % 5}.5' for at in range(30)]
    for names in (['t [s],v [mm/s],F [N]'], ['t,v,F', 's,mm/s,N']):
        heads = [one.replace(',', sign) for one in names]
        found = head_of('\n'.join([*heads, row, *rows]))
        assert found.first == len(heads) + 2
        assert found.factors == ('' if row == '1.0;1;1' else row.replace(sign, ' '))
        offsets = head_of('\n'.join([*heads, row, sign.join('000'), *rows]))
        assert offsets.first == len(heads) + (3 if first != 0.01 else 2)


@pytest.mark.parametrize('times', [[0, 10, 20], [1, 2, 3], [10, 20, 30], [5, 1000, 1001]])
def test_first_rows_whose_time_goes_on_are_rows(times):
    step = times[2] - times[1]
    times = [*times, *(times[2] + step * at for at in range(1, 30))]
    rows = [f'{time},{max(at, 1)},{at % 5}' for at, time in enumerate(times)]
    found = head_of('\n'.join(['t,v,F', *rows]))
    assert (found.first, found.factors) == (2, '')


@pytest.mark.parametrize('names', ['t [s],x position [mm],x load [N]', 'alpha,beta,gamma'])
@pytest.mark.parametrize('row', ['1,0.01,0.1', '1e-3,10,2'])
def test_a_row_of_factors_is_found_below_names_of_any_kind(names, row, tmp_path):
    rows = (f'{100 * at},{1000 + at % 7},{at % 9}' for at in range(60))
    path = tmp_path / 'log.csv'
    path.write_text('\n'.join([names, row, *rows]))
    assert source_of(path).head.factors == row.replace(',', ' ')


def test_a_part_of_a_unit_stays_with_a_name_that_says_nothing(tmp_path):
    path = tmp_path / 'log.csv'
    path.write_text(
        '\n'.join(['alpha,beta', 's,0.01 mm', *(f'{at},{at % 7}' for at in range(60))])
    )
    assert source_of(path).names() == ['alpha [s]', 'beta [0.01 mm]']


@pytest.mark.parametrize(
    ('first', 'time', 'rows'),
    [
        ('{};NaN;NaN', '{:.1f}', 40),
        ('{};;', '{:.1f}', 40),
        ('{};;', '2025-07-14T10:00:{:04.1f}Z', 40),
        ('{};---;150', '{:.1f}', 40),
        ('{};No data;No data', '{:.1f}', 40),
        ('{};---;---', '2025-07-14T10:00:{:04.1f}Z', 40),
        ('{};---;---\n', '{:.1f}', 40),
        ('{};NaN;NaN', 'NaN', 40),
        ('{};NaN;NaN', '{:.1f}', 1),
        ('s;mm/s;N', '{:.1f}', 0),
        ('-;-;-', '{:.1f}', 0),
        (';;', '{:.1f}', 0),
        ('Scale;1;1', '{:.1f}', 0),
        ('1;Axis X;Axis X', '{:.1f}', 0),
        ('7000;;', '{:.1f}', 0),
        ('14.07.2025;;', '{:.1f}', 0),
    ],
)
def test_rows_whose_time_goes_on_without_other_numbers_are_rows_of_the_table(first, time, rows):
    """Units, labels, dates and counts above the first times are none."""
    names, count = 't [s];X Speed [mm/s];X Force [N]', max(rows, 1)
    above = [first.format(time.format(at / 10)) for at in range(count)]
    below = [f'{time.format((at + rows) / 10)};{at % 7}.5;-300' for at in range(60)]
    head = head_of('\n'.join([names, *above, *below]))
    lines = '\n'.join([names, *above]).count('\n') // count  # of a row above
    assert head.names[0] == 't [s]'
    assert head.first == (2 if rows else 2 + lines * count)


def test_rows_without_numbers_at_the_begin_are_lost_as_those_in_the_middle(tmp_path):
    path = tmp_path / 'log.csv'
    for begin in (0, 30):
        lines = [
            f'{at / 10};NaN;NaN' if begin <= at < begin + 40 else f'{at / 10};{at % 9};-300'
            for at in range(100)
        ]
        path.write_text('\n'.join(['t [s];X Speed [mm/s];X Force [N]', *lines]))
        axis = {'lead_mm': 10.0, 'speed': {'column': 'X Speed [mm/s]', 'unit': 'mm/s'}}
        time = {'column': 't [s]', 'unit': 's', 'epoch': '2026-01-05T08:00:00Z'}
        series = read_series(path, make_map({'time': time, 'axes': {'x': axis}}))
        assert series.rows == (100,)
        speeds = np.concatenate([rows.columns['x.speed'] for (rows,) in series.blocks()])
        assert np.isfinite(speeds).sum() == 60
