# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Tables in layouts that were drawn: each is read right or refused, never read as other numbers.

The writer below knows nothing of the reader: it makes a motion, and writes its numbers by a sign,
a form of time, in groups of columns, below a preamble.

"""

import datetime as dt
import math
import random
import re

from ballscrew_monitor.recordings.tables.guess import guess
from ballscrew_monitor.recordings.tables.mapping import make_map
from ballscrew_monitor.recordings.tables.series import read_series
from ballscrew_monitor.recordings.tables.sources import source_of
from hypothesis import given, settings
from hypothesis import strategies as st
import numpy as np
import pytest
from surrogate.files import InputError

BEGIN = dt.datetime(2025, 7, 14, 11, 59, 50, tzinfo=dt.UTC)
ROWS = 60
DRAWN = 20
DAY = 86400.0
TO_ONE, TO_MIDNIGHT = 3609.7, 43209.7  # [s] after the begin, 0.3 s before a clock may begin again


def at(form, digits=3):
    def write(seconds):
        moment = BEGIN + dt.timedelta(seconds=seconds)
        return moment.strftime(form).replace('FFF', f'{moment:%f}'[:digits])

    return write


def since(year, unit, digits):
    zero = dt.datetime(year, 1, 1, tzinfo=dt.UTC)
    before = (BEGIN - zero) // dt.timedelta(microseconds=1)
    return lambda seconds: f'{(before + round(seconds * 1e6)) / 1e6 / unit:.{digits}f}'


def ticks(seconds):
    zero = dt.datetime(1601, 1, 1, tzinfo=dt.UTC)
    return str(((BEGIN - zero) // dt.timedelta(microseconds=1) + round(seconds * 1e6)) * 10)


def days(seconds):
    zero = dt.datetime(1899, 12, 30, tzinfo=dt.UTC)
    return f'{(BEGIN - zero).total_seconds() / DAY + seconds / DAY:.11f}'


TIMES = {
    'iso': ('Time', at('%Y-%m-%d %H:%M:%S.FFF')),
    'iso T': ('timestamp', at('%Y-%m-%dT%H:%M:%S.FFFZ')),
    'month first': ('Time', at('%m/%d/%Y %H:%M:%S.FFF')),
    'month first, half days': ('Time', at('%m/%d/%Y %I:%M:%S.FFF %p')),
    'day first': ('Date/Time', at('%d/%m/%Y %H:%M:%S.FFF')),
    'dots': ('Zeit', at('%d.%m.%Y %H:%M:%S.FFF')),
    'month in words': ('Time', at('%d-%b-%Y %H:%M:%S.FFF')),
    'month before day in words': ('Time', at('%b %d %Y %H:%M:%S.FFF')),
    'colon': ('Zeit', at('%Y-%m-%d %H:%M:%S:FFF')),
    'hours': ('Uhrzeit', at('%H:%M:%S.FFF')),
    'half days without a word': ('Time', at('%I:%M:%S.FFF')),
    'semicolon': ('Time', at('%H:%M:%S;FFF')),
    's': ('Time [s]', lambda seconds: f'{seconds:.3f}'),
    'ms': ('Time [ms]', lambda seconds: f'{1e3 * seconds:.1f}'),
    'no unit': ('time', lambda seconds: f'{seconds:.3f}'),
    'epoch s': ('Time', since(1970, 1.0, 3)),
    'epoch ms': ('Time', since(1970, 1e-3, 0)),
    'epoch us': ('Time', since(1970, 1e-6, 0)),
    'labview': ('Time', since(1904, 1.0, 3)),
    'ticks': ('Name', ticks),
    'days': ('Time', days),
}
PREAMBLES = (
    [],
    ['Maschine: Fräse 3'],
    ['Operator;A. Meier', 'Part;100'],
    ['# made by a logger', '#'],
    ['Export of the scope', '', 'Version 3.1', 'Channels 4', ''],
    ['Drive 7, firmware 4.5.1, 12 bit'],
)
SIGNALS = {
    'X position [mm]': lambda t: 150.0 + 2000.0 / math.tau * (1.0 - math.cos(math.tau * t / 2.0)),
    'X speed [mm/min]': lambda t: (
        60.0 * 1000.0 / math.tau * math.tau * math.sin(math.pi * t) / 1.0
    ),
    'X force [N]': lambda t: -2400.0 if math.sin(math.pi * t) >= 0.0 else 1200.0,
}
FORMS = {'X position [mm]': 4, 'X speed [mm/min]': 0, 'X force [N]': 0}


def number(value, digits, sign, part):
    """Return a number by a decimal sign, its thousands parted by something or nothing."""
    text = f'{value:,.{digits}f}'
    return text.translate(str.maketrans({',': part, '.': sign}))


MARKS = {
    'valid': (lambda column: 'valid', {True: ['1'], False: ['0']}),
    'quality': (lambda column: f'{column.split(" [")[0]} quality', {True: ['192'], False: ['0']}),
    'status': (
        lambda column: f'{column.split(" [")[0]} StatusCode',
        {True: ['0x00000000'], False: ['0x80000000', '0x80350000']},
    ),
    'words': (
        lambda column: f'{column.split(" [")[0]} Status',
        {True: ['Good'], False: ['Bad', 'Uncertain']},
    ),
    'direction': (lambda column: 'X direction', {True: ['1', '0'], False: ['-1']}),
}
"""Columns that mark others: how they are called, and cells of values that are good, and not."""
BAD_ROWS = range(20, 26)
SPEED = 'X speed [mm/min]'


def layout(draw):
    """Return a drawn layout."""
    sign = draw.choice('.,')
    other = {'.': ',', ',': '.'}[sign]
    separators = [';', '\t', '|'] + ([','] if sign == '.' else [])
    return {
        'sign': sign,
        'part': draw.choice(['', '', other, "'", '\u202f']),
        'separator': draw.choice(separators),
        'time': draw.choice(list(TIMES)),
        'preamble': draw.choice(PREAMBLES),
        'grouping': draw.choice(['one', 'one', 'groups', 'own rows', 'a value a line']),
        'units below': draw.random() < 0.2,
        'quoted': draw.random() < 0.2,
        'line end': draw.choice(['\n', '\r\n']),
        'step': draw.choice([0.01, 0.02, 0.1]),
        'minus': draw.choice(['-', '-', '- ', '\u2212']),
        'marks': draw.choice(['', '', *MARKS]),
        'second time': draw.choice(['as the first', 'as the first', 'unnamed']),
        'factors': draw.random() < 0.1,
        'unit in words': draw.random() < 0.2,
        'note': draw.choice(['', ' (X)', ' (ist)', ' (Achse 1)']),
        'later': draw.choice([0.0, 0.0, TO_ONE, TO_MIDNIGHT]),
    }


def marked(line, marks, good, places):
    """Mark a row, and put another number into its places where it is bad."""
    cells = MARKS[marks][1][good]
    line.append(cells[len(line) % len(cells)])
    for place in [] if good else places:
        line[place] = '0'


def written(made):
    """Return the text of a table in a layout, and its samples by the name of a column."""
    name, clock = TIMES[made['time']]
    step = made['step']
    true = {
        column: [(row * step, float(f'{f(row * step):.{FORMS[column]}f}')) for row in range(ROWS)]
        for column, f in SIGNALS.items()
    }
    force = [(seconds + step / 2, value) for seconds, value in true['X force [N]']]
    own = made['grouping'] in ('groups', 'own rows')
    in_lines = made['grouping'] == 'a value a line'
    marks = '' if own or (in_lines and made['marks'] == 'direction') else made['marks']
    true['X force [N]'] = force if own else true['X force [N]']

    def cell(column, value):
        value = abs(value) if (marks, column) == ('direction', SPEED) else value
        text = number(value, FORMS[column], made['sign'], made['part'])
        text = text.replace('-', made['minus'])
        return f'"{text}"' if made['quoted'] or made['separator'] in text else text

    def moment(seconds):
        text = clock(made['later'] + seconds)
        plain = text.replace('.', '', 1).isdigit()
        return text.replace('.', made['sign']) if plain else text

    columns = list(SIGNALS)
    if made['grouping'] == 'groups':
        second = name if made['second time'] == 'as the first' else ''
        names = [name, *columns[:2], second, columns[2]]
        rows = [
            [
                moment(true[columns[0]][row][0]),
                *(cell(each, true[each][row][1]) for each in columns[:2]),
                moment(force[row][0]),
                cell(columns[2], force[row][1]),
            ]
            for row in range(ROWS)
        ]
    elif own:
        names = [name, *columns]
        rows = []
        for row in range(ROWS):
            moved = [cell(each, true[each][row][1]) for each in columns[:2]]
            rows.append([moment(true[columns[0]][row][0]), *moved, ''])
            rows.append([moment(force[row][0]), '', '', cell(columns[2], force[row][1])])
    elif made['grouping'] == 'a value a line':
        names = [name, 'Signal', 'Value']
        rows = [
            [moment(row * step), each, cell(each, true[each][row][1])]
            for row in range(ROWS)
            for each in columns
        ]
        if marks:
            names.append({'valid': 'Validity', 'status': 'StatusCode'}.get(marks, 'Quality'))
            for at, line in enumerate(rows):
                marked(line, marks, at // len(columns) not in BAD_ROWS, [2])
    else:
        names = [name, *columns]
        rows = [
            [moment(row * step), *(cell(each, true[each][row][1]) for each in columns)]
            for row in range(ROWS)
        ]
        heads = dict.fromkeys(MARKS[marks][0](each) for each in columns) if marks else {}
        names += heads
        for row, line in enumerate(rows):
            for _ in heads:
                good = row not in BAD_ROWS
                if marks == 'direction':
                    good = true[SPEED][row][1] >= 0.0
                marked(line, marks, good, [] if marks == 'direction' else [1, 2, 3])
    if marks not in ('', 'direction'):
        true = {
            column: [one for row, one in enumerate(samples) if row not in BAD_ROWS]
            for column, samples in true.items()
        }
    heads = [names]
    if made['units below']:
        split = [each.partition(' [') for each in names]
        noted = [f'{each}{made["note"] * bool(unit)}' for each, _, unit in split]
        heads = [noted, [unit.strip(']') for *_, unit in split]]
    elif made['unit in words']:
        heads = [[re.sub(r' \[(.*)\]$', r' in \1', each) for each in names]]
    if made['factors'] and not in_lines:
        rows.insert(0, ['1', number(0.5, 1, made['sign'], ''), *['1'] * (len(names) - 2)])
        position = columns[0]
        true[position] = [(seconds, 0.5 * value) for seconds, value in true[position]]
    lines = [*made['preamble'], *(made['separator'].join(row) for row in [*heads, *rows])]
    return made['line end'].join([*lines, '']), true


SI = {
    'x.position': ('X position [mm]', math.tau / 10.0),
    'x.speed': ('X speed [mm/min]', math.tau / 10.0 / 60.0),
    'x.load': ('X force [N]', 1.0),
}


def samples_of(path):
    """Return the samples of a log by the first map of it; raises InputError."""
    series = read_series(path, make_map(guess(path).content))
    found = {}
    for groups in series.blocks():
        for rows in groups:
            for name, values in rows.columns.items():
                found.setdefault(name, []).append((rows.stamps, values))
    return {
        name: tuple(np.concatenate(part) for part in zip(*parts, strict=True))
        for name, parts in found.items()
    }


def check(text, true, path):
    """Return True if a table is read; raises AssertionError where its numbers are others."""
    path.write_bytes(text.encode())
    try:
        found = samples_of(path)
    except InputError:
        return False
    begin = min(stamps[0] for stamps, _ in found.values())
    for name, (column, factor) in SI.items():
        if name not in found:
            continue
        stamps, values = found[name]
        known = np.isfinite(values)
        times, numbers = (np.array(each) for each in zip(*true[column], strict=True))
        assert len(values[known]) == len(numbers), name
        np.testing.assert_allclose((stamps[known] - begin) / 1e9, times - 0.0, atol=2e-3)
        np.testing.assert_allclose(values[known], numbers * factor, rtol=1e-9, atol=1e-9)
    return True


def drawn(seed, folder):
    """Return True if the layout of a seed is read; raises AssertionError for other numbers."""
    made = layout(random.Random(seed))
    text, true = written(made)
    try:
        return check(text, true, folder / 'log.csv')
    except AssertionError as error:
        raise AssertionError(f'{made}: {error}\n{text[:600]}') from None


@settings(max_examples=2 * settings.default.max_examples)
@given(seed=st.integers(0, 2**32))
def test_a_drawn_layout_is_read_right_or_refused(seed, tmp_path_factory):
    drawn(seed, tmp_path_factory.getbasetemp())


def test_a_value_a_line_between_bars_is_not_taken_for_lines_of_an_adapter(tmp_path):
    made = layout(random.Random(0)) | {'separator': '|', 'time': 'iso T', 'sign': '.', 'part': "'"}
    text, true = written(made | {'grouping': 'a value a line', 'quoted': False})
    assert check(text, true, tmp_path / 'log.csv')


def test_a_remark_as_wide_as_a_value_a_line_names_no_columns(tmp_path):
    made = layout(random.Random(1009))
    assert (made['grouping'], made['separator']) == ('a value a line', ',')
    assert made['preamble'][0].count(',') == 2, 'as wide as time, signal and value'
    assert check(*written(made), tmp_path / 'log.csv')


@pytest.mark.parametrize('marks', ['quality', 'status', 'words'])
def test_units_stand_below_the_names_though_columns_of_marks_have_none(marks, tmp_path):
    made = layout(random.Random(2)) | {'units below': True, 'grouping': 'one', 'factors': False}
    assert check(*written(made | {'marks': marks}), tmp_path / 'log.csv')


def test_most_of_drawn_layouts_are_read(tmp_path):
    assert sum(drawn(seed, tmp_path) for seed in range(DRAWN)) >= 0.7 * DRAWN


@pytest.mark.parametrize(
    ('line', 'period'),
    [
        ('# Sampling period is 1000000 ns', 1e-3),
        ('# Sample time: 10 ms', 0.01),
        ('# Sample period: 10 [ms]', 0.01),
        ('# Sample time [ms]: 10', 0.01),
        ('# Sample rate: 100', 0.01),
        ('# dt = 0.004', 0.004),
        ('# CycleTimeMs: 2', 0.002),
        ('# Cycle time: 10', math.nan),
        ('# Sample time: 10,000 us', math.nan),
        ('# Sample rate: 1.000 Hz', math.nan),
        ('# Sampling rate: 100 Sa/s', math.nan),
        ('# Period: 1 ms; decimation: 10', math.nan),
        ('# Sample time: 1 ms x 10', math.nan),
        ('# Sampling: every 10 cycles of 1 ms', math.nan),
        ('# Interpolator cycle 4 ms', math.nan),
        ('# Control cycle: 2 ms', math.nan),
        ('# Trigger sample time: 5 ms', math.nan),
        ('# Sampling frequency of current: 20 kHz', math.nan),
    ],
)
def test_a_period_is_that_of_rows_with_its_unit_or_none(line, period, tmp_path):
    log = tmp_path / 'log.csv'
    rows = ''.join(f'{at % 7 - 3};{at % 5 - 2}\n' for at in range(40))
    log.write_text(f'{line}\nx velocity [mm/s];x force [N]\n{rows}')
    assert source_of(log).head.period == pytest.approx(period, nan_ok=True)


@pytest.mark.parametrize(
    'line',
    [
        'Cycle time: 12 s',
        'PLC cycle time: 2 ms',
        '# Servo cycle 125 us',
        'Frequency: 50 Hz',
        'Period: 12 s',
        'Interval: 60 s',
        'Period (ms);10',
        '# Rate: 100',
        '# Frequency = 100',
        'Sample time: 12 s',
        '# Sample duration: 12 s',
        '# Sampled 12 s, 100 Hz',
        '# Sampling jitter 20 us',
        '# Sample rate (original) 1 kHz',
        'Sample rate before averaging: 1 kHz',
        '# resampled from 1 kHz',
        '# cycle 1 ms, logged each 10th',
        '# Drive sampling time 125 us',
        '# Schrittmotor 5 s',
        'Sample time: 1 ms\nDecimation: 10',
        'Sample rate: 1 kHz\nDownsampling: 10',
        'Sample time: 1 ms\nRecord every: 10',
        'Abtastzeit: 1 ms\nUntersetzung: 10',
        'Averaging: 10 samples\nSample rate: 1000 Hz',
        'Sample rate: 100 Hz\nSample time: 1 ms',
        'Sample rate: 1000 Hz\nReduced rate: 0.01 s',
        'Sample rate: 1 kHz\nExport interval: 10 ms',
        'Stored rate: 100 Hz\nSample rate: 1 kHz',
    ],
)
def test_a_period_that_may_be_of_something_else_is_named_in_a_question(line, tmp_path):
    log = tmp_path / 'log.csv'
    rows = ''.join(f'{at % 7 - 3};{at % 5 - 2}\n' for at in range(40))
    log.write_text(f'{line}\nx velocity [mm/s];x force [N]\n{rows}')
    result = guess(log)
    assert result.content['time']['rate_Hz'] is None
    assert all(part in ' '.join(result.unstated) for part in line.split('\n'))


@pytest.mark.parametrize(
    'line',
    [
        'Sample rate;100;Hz',
        'Abtastrate;100,0;Hz',
        'Sample interval;0,01;s',
        'Logging interval: 10 ms',
        'Log rate: 100 Hz',
        'Scan rate: 100 Hz',
        'Acquisition rate: 100 Hz',
        'Ts = 10 ms',
        'fs = 100',
        '# mill 3, sampling rate 100 Hz, table',
        '"Sampling cycle 10 msec"',
    ],
)
def test_a_period_in_plain_words_of_rows_is_read(line, tmp_path):
    log = tmp_path / 'log.csv'
    rows = ''.join(f'{at % 7 - 3};{at % 5 - 2};{20 + at % 3}\n' for at in range(40))
    log.write_text(f'{line}\nx velocity [mm/s];x force [N];oil temperature [degC]\n{rows}')
    assert guess(log).content['time']['rate_Hz'] == 100.0


@pytest.mark.parametrize('note', ['', ' (Achse 1)', ' (X)', ' (ist)'])
def test_a_row_of_factors_is_asked_for_whatever_stands_behind_the_names(note, tmp_path):
    names = ';'.join(f'{name}{note}' for name in ('Time', 'X position', 'X force'))
    rows = [f'{0.1 * row:.1f};{150 + row};{20 + row}'.replace('.', ',') for row in range(60)]
    path = tmp_path / 'log.csv'
    path.write_text('\n'.join([names, 's;mm;N', '1;0,5;1', *rows]))
    axis = guess(path).content['axes']['x']
    assert [axis[name]['scale'] for name in ('position', 'load')] == [None, None]


@pytest.mark.parametrize('separator', [',', ';', '\t'])
@pytest.mark.parametrize('date', ['2025-07-14', '2025/07/14'])
def test_a_servo_guide_has_properties_side_by_side_and_a_line_for_each_channel(
    separator, date, tmp_path
):
    """Rows as wide as the table: two properties, or channel, axis, signal and unit."""
    head = [['SERVO GUIDE DATA'], ['DATE', date, 'TIME', '11:59:50'], ['SAMPLING', '1msec']]
    head += [['CH1', 'X', 'POSF', 'mm'], ['CH2', 'X', 'TCMD', '%'], ['CH3', 'X', 'SPEED', '1/min']]
    head.append(['TIME', 'CH1', 'CH2', 'CH3'])
    turning = [540.0 * math.sin(math.pi * row / 200) for row in range(400)]
    place = np.cumsum(turning) * 10.0 / 60.0 / 1000.0
    rows = [
        [f'{row}', f'{150.0 + place[row]:.6f}', '50.0' if row < 200 else '-50.0', f'{one:.4f}']
        for row, one in enumerate(turning)
    ]
    path = tmp_path / 'guide.csv'
    path.write_text('\n'.join(separator.join(row) for row in [*head, *rows]))
    content = guess(path).content
    axis = content['axes']['x']
    assert {kind: axis[kind]['unit'] for kind in ('speed', 'position', 'torque')} == {
        'speed': 'rev/min',
        'position': 'mm',
        'torque': '%',
    }
    axis['torque_rated_Nm'] = 4.0
    (block,) = next(read_series(path, make_map(content)).blocks())
    assert block.stamps[0] == BEGIN.timestamp() * 1e9
    np.testing.assert_array_equal(np.diff(block.stamps), 1_000_000)
    np.testing.assert_allclose(
        block.columns['x.speed'], np.array(turning) * math.tau / 60.0, atol=1e-4
    )
    np.testing.assert_allclose(np.abs(block.columns['x.torque']), 2.0)


@pytest.mark.parametrize('places', [{0}, {0, 1, 7}, {0, 30}])
@pytest.mark.parametrize('word', ['#DIV/0!', '#NV', '#VALUE!', 'No Data', 'I/O Timeout'])
def test_a_word_for_a_number_in_the_first_row_is_counted_as_in_all_others(places, word, tmp_path):
    if places == {0} and not word.startswith('#'):
        places = {0, 40}  # a word that stands nowhere else may be a remark
    force = [word if at in places else f'{300 - 10 * (at % 60)}' for at in range(100)]
    lines = [f'{at / 100:.2f},{at % 50 - 25}.5,{force[at]}' for at in range(100)]
    path = tmp_path / 'log.csv'
    path.write_text('\n'.join(['t [s],x speed [mm/s],x force [N]', *lines]) + '\n')
    (rows,) = next(read_series(path, make_map(guess(path).content)).blocks())
    assert {*np.flatnonzero(np.isnan(rows.columns['x.load'])).tolist()} == places
    assert len(rows.stamps) == 100


@pytest.mark.parametrize('end', ['EOF', 'END', '*** end of data ***', '# EOF', 'EOF\n\n'])
def test_a_word_that_ends_a_table_is_no_row_that_is_missing(end, tmp_path):
    lines = [f'{at / 100:.2f},{at % 50 - 25}.5,{300 - 10 * (at % 60)}' for at in range(100)]
    path = tmp_path / 'log.csv'
    path.write_text('\n'.join(['t [s],x speed [mm/s],x force [N]', *lines, end]))
    series = read_series(path, make_map(guess(path).content))
    assert (series.count, series.rows) == (100, (100,))
    assert not [note for note in series.notes if 'cells' in note]
    path.write_text('\n'.join(['t [s],x speed [mm/s],x force [N]', *lines, '1.00,3']))
    assert read_series(path, make_map(guess(path).content)).rows == (101,), 'a row that was torn'


@pytest.mark.parametrize('clock', ['11:59:{:02d};{:03d}', '11:59:{:02d};{}'])
def test_a_trend_of_rockwell_has_milliseconds_behind_a_semicolon(clock, tmp_path):
    head = ['"Controller Name:","Mill1"', '"Trend Name:","Axis"', '"Sample Period:","50 ms"']
    head.append('Header,Date,Time,X_Axis.ActualVelocity')
    rows = (
        f'Data,07/14/2025,{clock.format(at // 20, 50 * (at % 20))},{at % 9}' for at in range(300)
    )
    path = tmp_path / 'trend.csv'
    path.write_text('\n'.join([*head, *rows]))
    content = guess(path).content
    content['axes']['x']['speed']['unit'] = 'mm/s'
    content['assumed'].pop('x.speed.unit', None)
    series = read_series(path, make_map(content))
    ((block,),) = series.blocks()
    moments = dt.datetime(2025, 7, 14, 11, 59, tzinfo=dt.UTC).timestamp() + np.arange(300) / 20
    np.testing.assert_allclose(block.stamps / 1e9, moments, atol=1e-6, rtol=0.0)
