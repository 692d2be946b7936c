# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Tables with a value a line: every order of columns, quoted or not, with names or none above."""

import itertools
import math

from ballscrew_monitor.recordings.tables.guess import guess
from ballscrew_monitor.recordings.tables.mapping import make_map
from ballscrew_monitor.recordings.tables.marks import bad_qualities
from ballscrew_monitor.recordings.tables.series import read_series
from ballscrew_monitor.recordings.tables.sources import source_of
from ballscrew_monitor.recordings.tables.times import joined
import numpy as np
import pytest
from surrogate.files import limits

STEP, COUNT = 0.01, 500
TIME = np.arange(COUNT) * STEP
SPEED = 90.0 * np.sin(math.tau * TIME)  # [mm/s]
PLACE = 150.0 + 90.0 / math.tau * (1.0 - np.cos(math.tau * TIME))  # [mm]
FORCE = np.where(SPEED >= 0.0, -900.0, 900.0)  # [N]
SIGNALS = {'X position [mm]': (PLACE, 3), 'X speed [mm/s]': (SPEED, 3), 'X force [N]': (FORCE, 1)}
HEADS = {'time': 'Timestamp', 'name': 'TagName', 'value': 'Value', 'unit': 'Unit'}


def clock(seconds):
    return f'2025-07-14 11:59:{50 + seconds:06.3f}'


def lines_of(order, *, separator=';', quoted=False, head=True, sign='.', time=clock):
    """Return a line for each value of each signal, those of one time behind each other."""
    rows = [[HEADS[role] for role in order]] if head else []
    for at, (name, (values, digits)) in itertools.product(range(COUNT), SIGNALS.items()):
        plain, unit = name.rstrip(']').split(' [')
        named = plain if 'unit' in order else name
        value = f'{values[at]:.{digits}f}'.replace('.', sign)
        cells = {'time': time(TIME[at]), 'name': named, 'value': value, 'unit': unit}
        rows.append([cells[role] for role in order])
    mark = '"' if quoted else ''
    return [separator.join(f'{mark}{cell}{mark}' for cell in row) for row in rows]


def read(path, lines):
    """Return the rows of a log by its first map."""
    path.write_text('\n'.join(lines) + '\n', encoding='utf-8')
    mapping = make_map(guess(path).content)
    return joined([rows for (rows,) in read_series(path, mapping).blocks()])


def check(rows):
    np.testing.assert_allclose((rows.stamps - rows.stamps[0]) / 1e9, TIME, atol=1e-4)
    turn = math.tau / 10.0  # [rad/mm]
    for name, values, atol in (
        ('x.position', PLACE * turn, 1e-3),
        ('x.speed', SPEED * turn, 1e-3),
        ('x.load', FORCE, 1e-9),
    ):
        np.testing.assert_allclose(rows.columns[name], values, atol=atol)


@pytest.mark.parametrize('order', [*itertools.permutations(HEADS)])
def test_columns_in_any_order_are_told_by_their_names(order, tmp_path):
    check(read(tmp_path / 'log.csv', lines_of(order)))


@pytest.mark.parametrize('order', [*itertools.permutations(['time', 'name', 'value'])])
@pytest.mark.parametrize('quoted', [False, True])
def test_columns_without_names_are_told_by_their_cells(order, quoted, tmp_path):
    lines = lines_of(order, quoted=quoted, head=False, separator=',')
    check(read(tmp_path / 'log.csv', lines))


@pytest.mark.parametrize(
    'layout',
    [
        {'sign': ',', 'separator': ';'},
        {'sign': ',', 'separator': ',', 'quoted': True},
        {'sign': ',', 'separator': '\t', 'head': False},
        {'separator': '|', 'quoted': True},
    ],
    ids=str,
)
def test_a_decimal_comma_and_quotes_are_those_of_any_table(layout, tmp_path):
    check(read(tmp_path / 'log.csv', lines_of(['name', 'time', 'value'], **layout)))


def test_signals_one_below_the_other_are_joined_by_their_times(tmp_path):
    lines = lines_of(['time', 'name', 'value'])
    sorted_lines = [lines[0], *sorted(lines[1:], key=lambda line: line.split(';')[1])]
    check(read(tmp_path / 'log.csv', sorted_lines))


def test_a_time_in_seconds_is_told_by_its_motion(tmp_path):
    lines = lines_of(['name', 'value', 'time'], time='{:.2f}'.format)
    check(read(tmp_path / 'log.csv', lines))


def test_whole_seconds_are_spread_for_each_signal(tmp_path):
    lines = lines_of(['time', 'name', 'value'], time=lambda seconds: clock(seconds)[:19])
    check(read(tmp_path / 'log.csv', lines))


def test_an_axis_of_its_own_column_tells_signals_of_one_name_apart(tmp_path):
    lines = ['Time;Axis;Signal;Value;Unit']
    for at in range(COUNT):
        lines += [
            f'{clock(TIME[at])};{axis};position;{factor * PLACE[at]:.4f};mm'
            for axis, factor in (('X', 1.0), ('Z', 2.0))
        ]
    rows = read(tmp_path / 'log.csv', lines)
    for axis, factor in (('x', 1.0), ('z', 2.0)):
        np.testing.assert_allclose(
            rows.columns[f'{axis}.position'], factor * PLACE * math.tau / 10.0, atol=1e-3
        )


def test_an_export_of_parts_repeats_its_names_above_each(tmp_path):
    lines = lines_of(['time', 'name', 'value'])
    parts = [[line for line in lines if name in line] for name in SIGNALS]
    check(read(tmp_path / 'log.csv', sum(([lines[0], *part, ''] for part in parts), [])))


def test_a_value_of_bad_quality_is_not_known(tmp_path):
    lines = [f'{lines};Good' for lines in lines_of(['time', 'name', 'value'])]
    lines[0] = lines[0].replace('Good', 'Quality')
    lines[4] = lines[4].replace('Good', 'Bad')  # the first cell after the first time
    rows = read(tmp_path / 'log.csv', lines)
    assert np.flatnonzero(np.isnan(rows.columns['x.position'])).tolist() == [1]


@pytest.mark.parametrize(
    ('good', 'bad'),
    [
        (['192', '216'], ['0', '24', '64']),  # OPC DA: GGxxxxxx, where 11 is good
        (['0xC0'], ['0x00', '0x18']),
        (['128'], ['0', '16', '64']),  # PROFIBUS, and WinCC by it
        (['0', '1024'], ['2147483648', '2165637120', '1073741824']),  # OPC UA, severity on top
        (['100'], ['0']),  # per cent of the samples
        (['Good', 'GoodLocalOverride', 'Good, Non-specific'], ['Comm Fail', 'Uncertain']),
        (['OK', ''], ['Fault']),
        (['Gut'], ['Schlecht', 'Unsicher']),
        ([''], ['BAD', 'No Data', 'Not_Connected']),
        (['AUTO', 'RUN', 'Goods'], []),  # no quality, but a state of the machine
        (['0', '1', '2'], []),
    ],
)
def test_a_quality_is_good_as_its_standard_has_it(good, bad):
    assert sorted(bad_qualities([*good, *bad])) == sorted(bad)


def test_a_value_whose_quality_of_opc_is_no_good_is_not_known(tmp_path):
    lines = [f'{lines};192' for lines in lines_of(['time', 'name', 'value'])]
    lines[0] = lines[0].replace('192', 'Quality')
    lines[4] = lines[4].replace(';192', ';0')
    rows = read(tmp_path / 'log.csv', lines)
    assert np.flatnonzero(np.isnan(rows.columns['x.position'])).tolist() == [1]


@pytest.mark.parametrize(
    ('head', 'good', 'bad'),
    [
        ('StatusCode', '0x00000000', '0x80000000'),
        ('StatusCode', 'x00000000', 'x80340000'),
        ('Some column', '0x00000000', '0x80000000'),
        ('OPC status', '0', '2147483648'),
        ('Validity', '1', '0'),
        ('IsBad', 'false', 'true'),
    ],
)
def test_a_status_is_no_name_of_a_signal(head, good, bad, tmp_path):
    lines = [f'{lines};{good}' for lines in lines_of(['time', 'name', 'value'])]
    lines[0] = lines[0].replace(f';{good}', f';{head}')
    lines[4] = lines[4].replace(f';{good}', f';{bad}')
    rows = read(tmp_path / 'log.csv', lines)
    assert np.flatnonzero(np.isnan(rows.columns['x.position'])).tolist() == [1]


def test_a_quality_that_no_standard_defines_is_refused(tmp_path, refused):
    lines = [f'{line};{at % 2}' for at, line in enumerate(lines_of(['time', 'name', 'value']))]
    lines[0] = f'{lines[0][:-2]};Quality'
    refused('quality', read, tmp_path / 'log.csv', lines)


def test_a_signal_in_two_units_is_refused(tmp_path, refused):
    lines = lines_of(['time', 'name', 'value', 'unit'])
    path = tmp_path / 'log.csv'
    path.write_text('\n'.join([*lines[:-3], lines[-3].replace(';mm', ';m'), *lines[-2:]]))
    refused('two_units', guess, path)


@pytest.mark.parametrize(
    'head',
    ['Time;X position [mm];Mode;X speed [mm/s]', 'Time;Name;X position [mm];X speed [mm/s]'],
)
def test_a_table_with_a_column_of_texts_is_none(head, tmp_path):
    path = tmp_path / 'log.csv'
    middle = ('{1:.3f};AUTO', 'AUTO;{1:.3f}')['Name' in head]
    rows = [
        ('{0};' + middle + ';{2:.3f}').format(clock(TIME[at]), PLACE[at], SPEED[at])
        for at in range(COUNT)
    ]
    path.write_text('\n'.join([head, *rows]))
    assert source_of(path).names() == head.split(';')


@pytest.mark.parametrize('names', [('time', 'turn'), ('time 0', 'name')])
def test_a_signal_may_be_called_as_the_time_is(names, tmp_path):
    path = tmp_path / 'log.csv'
    rows = [f'{at},{name},{at}' for at in range(20) for name in (*names, 'x_pos_mm')]
    path.write_text('\n'.join(['time,tag,value', *rows]))
    held = [name.split('_dup')[0] for name in source_of(path).names()]
    assert held == ['time', *names, 'x_pos_mm']


def test_an_id_is_the_name_of_a_signal_where_nothing_else_is(tmp_path):
    path = tmp_path / 'log.csv'
    rows = [f'{at},{name},{at % 3}' for at in range(20) for name in ('z_speed_mm_s', 'z_force_N')]
    path.write_text('\n'.join(['time,id,val', *rows]))
    assert source_of(path).names() == ['time', 'z_speed_mm_s', 'z_force_N']


def test_the_table_that_values_make_is_counted_before(tmp_path, refused, monkeypatch):
    """A value a line of signals in turn: a row for each, in which all others are empty."""
    path = tmp_path / 'log.csv'
    rows = [f'{at},x_speed_{at % 20},{at}' for at in range(200)]
    path.write_text('\n'.join(['time,tag,value', *rows]))
    monkeypatch.setattr(limits, 'SPARSE', 200 * 21 * limits.TEXT_CELL)
    assert len(source_of(path).names()) == 21
    monkeypatch.setattr(limits, 'SPARSE', 200 * 21 * limits.TEXT_CELL - 1)
    refused('wide', source_of, path)


def test_names_in_the_coding_of_the_middle_of_europe_are_those_of_quantities(tmp_path):
    names = ('poloha X [mm]', 'rychlost X [mm/s]', 'síla X [N]', 'průměr X [mm]')
    path = tmp_path / 'log.csv'
    rows = [f'{clock(TIME[at])};{name};{at}.5' for at in range(30) for name in names]
    path.write_bytes('\n'.join(['čas;name;value', *rows]).encode('cp1250'))
    assert source_of(path).names() == ['čas', *names]


def test_a_semicolon_before_milliseconds_parts_no_values(tmp_path):
    lines = lines_of(('time', 'name', 'value'), time=lambda time: clock(time).replace('.', ';'))
    check(read(tmp_path / 'log.csv', lines))
