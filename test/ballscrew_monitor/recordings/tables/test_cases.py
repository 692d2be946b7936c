# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Kinds of tables that shops have, one of each: a motion in closed form, as a control writes it.

All of them hold 8 s of a speed of 90 mm/s times a sine of 4 s, on a lead of 10 mm, if a case does
not say otherwise.

"""

import datetime as dt
import math

from ballscrew_monitor.recordings.tables.guess import guess
from ballscrew_monitor.recordings.tables.mapping import make_map
from ballscrew_monitor.recordings.tables.series import read_series
import numpy as np
import pytest

LEAD, PERIOD, END = 10.0, 4.0, 8.0
BEGIN = dt.datetime(2025, 7, 14, 11, 59, 50, tzinfo=dt.UTC)
ENDINGS = ('txt', 'lvm', 'log', 'dat', 'asc')
UNITS = {'speed': 'mm/s', 'position': 'mm', 'torque': 'N m', 'load': 'kN'}


def motion(rate):
    """Return times [s], places [mm] and speeds [mm/s]."""
    time = np.arange(round(END * rate)) / rate
    turned = math.tau * time / PERIOD
    place = 150.0 + 90.0 * PERIOD / math.tau * (1.0 - np.cos(turned))
    return time, place, 90.0 * np.sin(turned)


def ways(speed, amount):
    """Return an amount with the sign of a speed."""
    return np.where(speed < 0.0, -amount, amount)


def moment(seconds, form):
    return (BEGIN + dt.timedelta(seconds=float(seconds))).strftime(form)


def german(value, digits):
    return f'{value:,.{digits}f}'.translate(str.maketrans(',.', '.,'))


def rows_of(separator, *columns):
    return [separator.join(row) for row in zip(*columns, strict=True)]


def texts(values, digits=4):
    return [f'{value:.{digits}f}' for value in values]


def groups_of_a_scope():
    """Two groups of columns, each with its own time, below rows that describe the channels."""
    time, place, speed = motion(100.0)
    late = np.floor(time * 50.0) * 20.0
    columns = [1e3 * time, place, speed, late, ways(speed, 1.7)]
    below = rows_of('\t', *([german(cell, 4).replace('.', '') for cell in one] for one in columns))
    head = ['Scope Export', 'StartTime\t22-7-2026 09:14:03', '']
    names = ['Name', 'ActPos', 'ActVelo', 'Name', 'fTorque']
    about = [('SymbolName', 'Axes.X.ActPos', 'Axes.X.ActVelo', 'SymbolName', 'GVL.fTorque')]
    about += [('Port', '501', '501', 'Port', '851'), ('Unit', 'mm', 'mm/s', 'Unit', 'Nm')]
    return [*head, '\t'.join(names), *map('\t'.join, about), *below], (100.0, 800)


def ticks():
    """Ticks of 100 ns since 1601 in a column called Name, and a line that ends the file."""
    time, place, speed = motion(50.0)
    first = 134_000_000_000_000_000
    stamps = [str(first + round(one * 1e7)) for one in time]
    below = rows_of(',', stamps, texts(place), texts(speed), texts(ways(speed, 1.7)))
    return ['Name,Scope', '', 'Name,ActPos,ActVelo,fTorque', *below, 'EOF'], (50.0, 400)


def month_first():
    time, _, speed = motion(20.0)
    stamps = [moment(one, '%m/%d/%Y %H:%M:%S.%f')[:-3] for one in time]
    names = 'Time,X Feed (mm/min),X Force (N)'
    below = rows_of(',', stamps, texts(60.0 * speed, 1), texts(ways(speed, -900.0), 0))
    return [names, *below], (20.0, 160)


def serial_days():
    time, _, speed = motion(20.0)
    zero = dt.datetime(1899, 12, 30, tzinfo=dt.UTC)
    days = [(BEGIN - zero).total_seconds() / 86400.0 + one / 86400.0 for one in time]
    names = 'Time,X Feed (mm/min),X Force (N)'
    below = rows_of(',', texts(days, 10), texts(60.0 * speed, 1), texts(ways(speed, -900.0), 0))
    return [names, *below], (20.0, 160)


def thousands_with_points():
    time, _, speed = motion(100.0)
    cells = [[german(cell, 0) for cell in one] for one in (60.0 * speed, ways(speed, -2400.0))]
    names = 'Zeit [s];X Vorschub [mm/min];X Kraft [N]'
    return [names, *rows_of(';', [german(one, 2) for one in time], *cells)], (100.0, 800)


def letters_of_quantities():
    time, place, speed = motion(50.0)
    names = 'Unnamed: 0,time,pos_x,v_x,a_x,f_x,curr_x'
    numbers = [str(149 + at) for at in range(len(time))]
    slope = 90.0 * math.tau / PERIOD * np.cos(math.tau * time / PERIOD)
    columns = (2.98 + time, place, speed, slope, ways(speed, -0.9), ways(speed, 1.2))
    return [names, *rows_of(',', numbers, *map(texts, columns))], (50.0, 400)


def speed_always_zero():
    time, place, speed = motion(100.0)
    names = '%time,field.header.seq,field.header.stamp,field.name0,field.position0,'
    stamps = [str(1_790_000_000_000_000_000 + round(one * 1e9)) for one in time]
    numbers, joints = [str(at) for at in range(len(time))], ['x_axis'] * len(time)
    turned, torque = texts(place * math.tau / LEAD), texts(ways(speed, 1.7), 3)
    columns = (stamps, numbers, stamps, joints, turned, ['0.0'] * len(time), torque)
    return [f'{names}field.velocity0,field.effort0', *rows_of(',', *columns)], (100.0, 800)


def whole_seconds():
    time, _, speed = motion(100.0)
    stamps = [moment(one, '%Y-%m-%dT%H:%M:%SZ') for one in time]
    names = 'timestamp,x_velocity_mm_s,x_force_N'
    return [names, *rows_of(',', stamps, texts(speed), texts(ways(speed, -900.0)))], (100.0, 800)


def rows_of_their_own():
    time, _, speed = motion(100.0)
    lines = []
    for at, one, force in zip(time, speed, ways(speed, -900.0), strict=True):
        lines += [f'{at:.3f},{one:.4f},', f'{at + 0.005:.3f},,{force:.0f}']
    return ['time_s,x_velocity_mm_s,x_force_N', *lines], (100.0, 800)


def measurement_file():
    time, _, speed = motion(200.0)
    head = ['LabVIEW Measurement', 'Separator\tTab', 'Decimal_Separator\t,']
    head += ['***End_of_Header***', '', 'Channels\t2', 'Delta_X\t0,005\t0,005']
    head += ['***End_of_Header***', 'X_Value\tX Geschwindigkeit [mm/s]\tX Kraft [N]\tComment']
    columns = (texts(one) for one in (time, speed, ways(speed, -900.0)))
    return [*head, *(row.replace('.', ',') for row in rows_of('\t', *columns))], (200.0, 1600)


CASES = {
    one.__name__: one
    for one in (
        *(groups_of_a_scope, ticks, month_first, serial_days, thousands_with_points),
        *(letters_of_quantities, speed_always_zero, whole_seconds, rows_of_their_own),
        measurement_file,
    )
}


def samples_of(path):
    """Return the samples of the first map of a log, whose open units are stated."""
    content = guess(path).content
    for section in content['axes'].values():
        for kind, column in section.items():
            if isinstance(column, dict) and column.get('unit', '') is None:
                column['unit'] = UNITS[kind]
    samples = {}
    for groups in read_series(path, make_map(content)).blocks():
        for rows in groups:
            for name, values in rows.columns.items():
                samples.setdefault(name, []).append((rows.stamps, values))
    return {
        name: tuple(map(np.concatenate, zip(*parts, strict=True)))
        for name, parts in samples.items()
    }


@pytest.mark.parametrize(
    ('case', 'ending'),
    [*((case, 'csv') for case in CASES), *(('measurement_file', one) for one in ENDINGS)],
)
def test_a_table_of_a_shop_has_the_times_and_the_speeds_of_its_motion(case, ending, tmp_path):
    lines, (rate, count) = CASES[case]()
    path = tmp_path / f'feed.{ending}'
    path.write_text('\n'.join(lines) + '\n')
    stamps, speed = samples_of(path)['x.speed']
    assert len(speed) == count
    np.testing.assert_allclose((stamps - stamps[0]) / 1e9, np.arange(count) / rate, atol=2e-3)
    true = motion(rate)[2] * math.tau / LEAD
    inner = slice(1, -1)  # of a slope
    np.testing.assert_allclose(speed[inner], true[inner], atol=0.02 * 90.0 * math.tau / LEAD)


@pytest.mark.parametrize(
    ('case', 'kind', 'amount'),
    [
        ('groups_of_a_scope', 'torque', 1.7),
        ('ticks', 'torque', 1.7),
        ('thousands_with_points', 'load', 2400.0),
        ('letters_of_quantities', 'load', 900.0),
        ('speed_always_zero', 'torque', 1.7),
        ('rows_of_their_own', 'load', 900.0),
    ],
)
def test_a_table_of_a_shop_has_the_load_of_its_motion(case, kind, amount, tmp_path):
    path = tmp_path / 'feed.csv'
    path.write_text('\n'.join(CASES[case]()[0]) + '\n')
    _, values = samples_of(path)[f'x.{kind}']
    np.testing.assert_allclose(np.abs(values), amount, rtol=1e-9)
    assert 0.4 < np.mean(values > 0.0) < 0.6


def test_runs_that_were_appended_to_a_table_are_parted(tmp_path):
    path = tmp_path / 'feed.csv'
    lines = [f'{at / 100:.2f},{speed},-300' for speed in (80, -40, 10) for at in range(300)]
    path.write_text('\n'.join(['time_s,x_velocity_mm_s,x_force_N', *lines]) + '\n')
    content = guess(path).content
    content['axes']['x']['load']['magnitude'] = False
    series = read_series(path, make_map(content))
    assert (series.count, len(series.run_begins)) == (900, 3)


def test_a_table_without_names_is_refused_and_its_columns_have_numbers(tmp_path, refused):
    time, place, speed = motion(100.0)
    columns = ([str(at) for at in range(len(time))], texts(place), texts(speed))
    path = tmp_path / 'sampler.txt'
    path.write_text(''.join(f'{row} \n' for row in rows_of(' ', *columns, texts(speed * 0.1))))
    refused('no_names', guess, path)
    axis = {'speed': {'column': 'column 3', 'unit': 'mm/s'}, 'lead_mm': LEAD}
    axis |= {'torque': {'column': 'column 4', 'unit': 'N m'}, 'load': {'from': 'torque'}}
    stated = {'rate_Hz': 100.0, 'epoch': '2026-01-05T08:00:00Z'}
    (rows,) = next(read_series(path, make_map({'time': stated, 'axes': {'x': axis}})).blocks())
    np.testing.assert_allclose(rows.columns['x.speed'], speed * math.tau / LEAD, atol=1e-3)
    force = -0.1 * speed * math.tau / (LEAD / 1e3)  # at an efficiency of 1
    np.testing.assert_allclose(rows.columns['x.load'], force, atol=0.1)


def test_lines_of_an_adapter_hold_what_moves_and_its_load_in_per_cent(tmp_path):
    """Values on change among lines about all else; a coordinate of the workpiece jumps."""
    lines = ['2022-08-08T13:51:34.7167146Z|system|NORMAL||||', '--multiline--ABCD']
    lines += ['2022-08-08T13:51:34.9702571Z|@ASSET@|123456.20|CuttingTool|--multiline--ABCD']
    time, place, speed = motion(10.0)
    for at, (one, load) in enumerate(zip(place, np.abs(speed) / 3.0, strict=True)):
        stamp = f'2022-08-08T13:52:{time[at]:010.7f}Z'
        lines.append(f'{stamp}|p1block|NN{at} G21 HP=4|X1load|{load:.0f}')
        lines.append(f'{stamp}|X1actm|{one:.4f}|X1actw|{one - 300.0 * (at > 40):.4f}|S6speed|0')
    path = tmp_path / 'mill.shdr'
    path.write_text('\n'.join(lines) + '\n')
    axis = guess(path).content['axes']['x']
    assert axis['position'] == {'column': 'X1actm'}
    assert axis['torque'] == {'column': 'X1load', 'unit': '%', 'magnitude': True}
    content = guess(path).content
    content['axes']['x']['torque_rated_Nm'] = 10.0
    (rows,) = next(read_series(path, make_map(content)).blocks())
    turned = rows.columns['x.position'] - rows.columns['x.position'][0]
    np.testing.assert_allclose(turned, (place - place[0]) * math.tau / LEAD, atol=1e-3)
