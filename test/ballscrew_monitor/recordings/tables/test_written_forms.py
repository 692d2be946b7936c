# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Tables whose cells, times, codings or records are written in a way of some program.

One motion is written in a drawn combination of these ways, and must be read as it was.

"""

import datetime as dt
import gzip
import json
import math

from ballscrew_monitor.recordings.tables.codings import unpacked
from ballscrew_monitor.recordings.tables.guess import guess
from ballscrew_monitor.recordings.tables.log import TableLog
from ballscrew_monitor.recordings.tables.mapping import make_map
from ballscrew_monitor.recordings.tables.series import read_series
from ballscrew_monitor.recordings.tables.sources import source_of
from hypothesis import given, settings
from hypothesis import strategies as st
import numpy as np
import polars as pl
import pytest

ROWS, STEP = 240, 0.01
TIMES = np.arange(ROWS) * STEP
POSITION = np.round(150.0 + 200.0 / math.tau * (1.0 - np.cos(math.tau * TIMES)), 3)
SPEED = np.round(200.0 * np.sin(math.tau * TIMES), 1)
FORCE = np.where(SPEED >= 0.0, -910.5, 610.5)
NAMES = ['x position', 'x speed', 'x force']
UNITS = ['mm', 'mm/s', 'N']
NAMED = [f'{name} [{unit}]' for name, unit in zip(NAMES, UNITS, strict=True)]
VALUES = list(zip(POSITION, SPEED, FORCE, strict=True))
BEGIN = dt.datetime(2025, 7, 14, 11, 59, 59)
WIDE = str.maketrans('0123456789.-', '０１２３４５６７８９．－')

CELLS = {
    'plain': lambda text, unit: text,
    'formula': lambda text, unit: f'="{text}"',
    'apostrophe': lambda text, unit: f"'{text}",
    'D': lambda text, unit: f'{float(text):.6E}'.replace('E', 'D'),
    'D, bare point': lambda text, unit: f'{round(1000 * float(text))}.D-3',
    'unit': lambda text, unit: f'{text} {unit}',
    'unit, no blank': lambda text, unit: f'{text}{unit}',
    'wide': lambda text, unit: text.translate(WIDE),
    'minus behind': lambda text, unit: f'{text[1:]}-' if text[0] == '-' else text,
    'sign behind': lambda text, unit: f'{text[1:]}-' if text[0] == '-' else f'{text}+',
    'brackets': lambda text, unit: f'({text[1:]})' if text[0] == '-' else text,
}


def moment(seconds):
    return BEGIN + dt.timedelta(seconds=round(float(seconds), 6))


def epoch(seconds):
    return (
        int((BEGIN - dt.datetime(1970, 1, 1)).total_seconds())
        + round(float(seconds) * 1000) // 1000
    )


def part(seconds):
    return round(float(seconds) * 1000) % 1000


FORMS = {
    's': (['t [s]'], lambda t: [f'{t:.2f}']),
    'unit': (['Time'], lambda t: [f'{t:.2f} s']),
    'ms': (['Time'], lambda t: [f'{1e3 * t:.0f} ms']),
    'units that change': (['Time'], lambda t: [f'{1e3 * t:.0f} ms' if t < 1 else f'{t:.2f} s']),
    'IEC': (['Time'], lambda t: [f'T#{int(t + 1e-9)}s{part(t)}ms']),
    'IEC, hours': (['Time'], lambda t: [f't#1h2m{t:.2f}s']),
    'IEC, clock': (['Time'], lambda t: [f'TOD#{moment(t):%H:%M:%S.%f}']),
    'IEC, date': (['Time'], lambda t: [f'DT#{moment(t):%Y-%m-%d-%H:%M:%S.%f}']),
    'ISO': (['Time'], lambda t: [f'PT{t:.2f}S']),
    'pandas': (['Time'], lambda t: [f'0 days 00:00:{t:09.6f}']),
    'ticks': (['Timestamp'], lambda t: [str(ticks(t))]),
    'ROS': (['stamp.sec', 'stamp.nanosec'], lambda t: [epoch(t), part(t) * 10**6]),
    'usec': (['timestamp', 'usec'], lambda t: [epoch(t), part(t) * 1000]),
    'clock and ms': (['Time', 'ms'], lambda t: [f'{moment(t):%H:%M:%S}', part(t)]),
    'clock of half a day and ms': (
        ['Time', 'Millisecond'],
        lambda t: [f'{moment(t):%I:%M:%S %p}', part(t)],
    ),
    'hundredths': (['Time'], lambda t: [f'{moment(t):%H:%M:%S}:{part(t) // 10:02d}']),
    'parts': (
        ['Hour', 'Minute', 'Second', 'Millisecond'],
        lambda t: [moment(t).hour, moment(t).minute, moment(t).second, part(t)],
    ),
    'date in parts': (
        ['Year', 'Month', 'Day', 'Hour', 'Minute', 'Second'],
        lambda t: [
            *moment(t).timetuple()[:5],
            f'{moment(t).second + moment(t).microsecond / 1e6:.2f}',
        ],
    ),
    'short words': (
        ['Year', 'Month', 'Day', 'Hr', 'Min', 'Sec', 'ms'],
        lambda t: [*moment(t).timetuple()[:6], part(t)],
    ),
}


def ticks(seconds):
    return (moment(seconds) - dt.datetime(1, 1, 1)) // dt.timedelta(microseconds=1) * 10


CODINGS = {
    'utf-8': lambda text: text.encode(),
    'utf-16 without a mark': lambda text: text.encode('utf-16-le'),
    'utf-16, big end': lambda text: text.encode('utf-16-be'),
    'utf-32': lambda text: text.encode('utf-32'),
    'NULs behind': lambda text: text.encode() + bytes(3000),
    'gzip': lambda text: gzip.compress(text.encode()),
}


def table(cells='plain', form='s', separator=';', foot=()):
    """Return the text of a table."""
    heads, times = FORMS[form]
    names = NAMES if cells.startswith('unit') else NAMED
    rows = [
        [
            *map(str, times(t)),
            *(
                CELLS[cells](f'{value:.3f}' if at == 0 else f'{value:.1f}', UNITS[at])
                for at, value in enumerate(values)
            ),
        ]
        for t, values in zip(TIMES, VALUES, strict=True)
    ]
    return '\n'.join(separator.join(row) for row in [[*heads, *names], *rows, *foot]) + '\n'


def samples_of(path):
    """Return the stamps [ns] and values of each input of a log by the first map of it."""
    series = read_series(path, make_map(guess(path).content))
    found = {}
    for groups in series.blocks():
        for rows in groups:
            for name, values in rows.columns.items():
                found.setdefault(name, []).append((rows.stamps, values))
    return {
        name: tuple(np.concatenate(each) for each in zip(*parts, strict=True))
        for name, parts in found.items()
    }


def check(path):
    """Assert that a log is read as the motion that was written."""
    found = samples_of(path)
    turn = math.tau / 10.0
    for name, true in (('position', POSITION * turn), ('speed', SPEED * turn), ('load', FORCE)):
        stamps, values = found[f'x.{name}']
        np.testing.assert_allclose(values, true, rtol=1e-6, atol=1e-9)
        np.testing.assert_allclose((stamps - stamps[0]) / 1e9, TIMES, atol=1e-4)


@settings(max_examples=settings.default.max_examples // 2)
@given(
    cells=st.sampled_from(list(CELLS)),
    form=st.sampled_from(list(FORMS)),
    separator=st.sampled_from([';', '\t', '|', '^', '~', '&', '\x1f']),
    coding=st.sampled_from(list(CODINGS)),
)
def test_a_table_is_read_in_whatever_way_its_cells_times_and_letters_are_written(
    cells, form, separator, coding, tmp_path_factory
):
    path = tmp_path_factory.getbasetemp() / 'log.csv'
    path.write_bytes(CODINGS[coding](table(cells, form, separator)))
    check(path)


RECORDS = [
    {'t [s]': float(t), **dict(zip(NAMED, map(float, values), strict=True))}
    for t, values in zip(TIMES, VALUES, strict=True)
]
FIELDS = list(RECORDS[0])
LISTS = {name: [record[name] for record in RECORDS] for name in FIELDS}
JSON = {
    'a line each': '\n'.join(map(json.dumps, RECORDS)),
    'a line each, the last cut off': '\n'.join(map(json.dumps, RECORDS)) + '\n{"t [s]": 2.',
    'lists in lines': '\n'.join(
        json.dumps(row) for row in [FIELDS, *map(list, zip(*LISTS.values()))]
    ),
    'split': {'columns': FIELDS, 'index': list(range(ROWS)), 'data': list(zip(*LISTS.values()))},
    'by columns': {k: {str(at): one for at, one in enumerate(v)} for k, v in LISTS.items()},
    'by index': {str(at): record for at, record in enumerate(RECORDS)},
    'units beside': {
        'columns': ['t', *NAMES],
        'units': ['s', *UNITS],
        'data': list(zip(*LISTS.values())),
    },
    'columns with units beside': {
        'columns': ['t', *NAMES],
        'units': ['s', *UNITS],
        'data': list(LISTS.values()),
    },
    'channels': {
        'channels': [
            {'name': name, 'unit': unit, 'values': values}
            for name, unit, values in zip(
                ['t', *NAMES], ['s', *UNITS], LISTS.values(), strict=True
            )
        ]
    },
    'values with units': [
        {
            'time': {'value': record['t [s]'], 'unit': 's'},
            'x': {
                name[2:]: {'value': record[f'{name} [{unit}]'], 'unit': unit}
                for name, unit in zip(NAMES, UNITS, strict=True)
            },
        }
        for record in RECORDS
    ],
    'period beside lists': {'dt': STEP, **{name: LISTS[name] for name in NAMED}},
    'rate with its unit': {'sample_rate_Hz': 100, **{name: LISTS[name] for name in NAMED}},
    'events before': {'events': [{'at': 0, 'text': 'start'}], 'samples': RECORDS},
    'within': {'meta': {'machine': '3'}, 'data': LISTS},
}


@pytest.mark.parametrize('layout', JSON)
def test_layouts_of_json_are_one_table(layout, tmp_path):
    path, content = tmp_path / 'log.json', JSON[layout]
    path.write_text(content if isinstance(content, str) else json.dumps(content))
    check(path)


def test_lists_that_may_be_rows_or_columns_are_refused(tmp_path, refused):
    path = tmp_path / 'log.json'
    square = [[0.0, 1.0, 2.0]] * 3
    path.write_text(json.dumps({'columns': ['t', 'x speed', 'x position'], 'data': square}))
    refused('square', source_of, path)


@pytest.mark.parametrize('cut', [1, 12, 30])
def test_a_last_record_that_is_cut_off_is_counted(cut, tmp_path, refused):
    path = tmp_path / 'log.json'
    whole = JSON['a line each']
    path.write_text(f'{whole}\n{whole.splitlines()[-1][:cut]}')
    made = guess(path)
    assert f'1 row of {ROWS + 1} with fewer cells' in ' '.join(made.notes)
    log = TableLog(path, make_map(made.content))
    assert {*log.promised.values()} == {ROWS + 1}
    path.write_text(f'{JSON["lists in lines"]}\n[2.4, 15')
    refused('list_cut_off', source_of, path)


@pytest.mark.parametrize('rate', [10, 24, 25, 30, 50, 60])
def test_frames_of_a_second_are_named_as_what_they_may_be(rate, tmp_path, refused):
    path = tmp_path / 'log.csv'
    rows = [f'12:00:{at // rate:02d}:{at % rate:02d};{at % 9};{at % 7}' for at in range(10 * rate)]
    path.write_text('\n'.join([f'Time;{NAMED[1]};{NAMED[2]}', *rows]) + '\n')
    refused('frames', source_of, path)


def test_structures_and_the_index_of_a_frame_are_columns(tmp_path):
    path = tmp_path / 'log.parquet'
    motion = [{'position_mm': p, 'speed_mm_s': v, 'force_N': f} for p, v, f in VALUES]
    index = [BEGIN + dt.timedelta(seconds=float(t)) for t in TIMES]
    pl.DataFrame({'x': motion, '__index_level_0__': index}).write_parquet(path)
    check(path)


@pytest.mark.parametrize(
    'foot', [[['Min', '0', '-40', '-610', '1']], [['1', '2', '3', '4', '5', '6']] * 3]
)
def test_a_few_rows_of_more_cells_are_left_out_and_counted(foot, tmp_path):
    path = tmp_path / 'log.csv'
    path.write_text(table(foot=foot))
    check(path)
    assert f'{len(foot)} row' in ' '.join(guess(path).notes)


@pytest.mark.parametrize(
    ('text', 'key'),
    [
        (table('unit').replace('610.5 N', '0.6 kN'), 'units_of_cells'),
        (table('unit').replace('x force', 'x force [kN]'), 'unit_of_name'),
        (table(separator='::'), 'separator'),
    ],
)
def test_cells_that_contradict_their_column_are_refused_in_a_sentence(
    text, key, tmp_path, refused
):
    path = tmp_path / 'log.csv'
    path.write_text(text)
    refused(key, source_of, path)


def test_gzip_that_is_cut_off_or_holds_no_text_is_refused(tmp_path, refused):
    path = tmp_path / 'log.csv.gz'
    packed = gzip.compress(table().encode())
    path.write_bytes(packed[: len(packed) // 2])
    refused('cut_off', source_of, path)
    path.write_bytes(gzip.compress(json.dumps(RECORDS).encode()))
    refused('packed', source_of, path)


@pytest.mark.parametrize('members', [1, 2, 3, 7, 40])
@pytest.mark.parametrize('padding', [b'', bytes(512)])
def test_all_members_of_a_gzip_file_are_read(members, padding, tmp_path):
    """A logger that appends begins a new one each time."""
    path, text = tmp_path / 'log.csv.gz', table().encode()
    cuts = np.linspace(0, len(text), members + 1).astype(int)
    parts = [text[slice(*pair)] for pair in zip(cuts, cuts[1:])]
    path.write_bytes(b''.join(map(gzip.compress, parts)) + padding)
    assert unpacked(path) == text
    check(path)


def test_each_channel_has_its_own_time_in_whatever_order_they_stand(tmp_path):
    path = tmp_path / 'log.json'
    early, late = ([1e3 * (1.7e9 + shift) + 10.0 * at for at in range(200)] for shift in (0, 2))
    channels = [
        {
            'name': name,
            'unit': unit,
            'values': [scale * (at % 50) for at in range(200)],
            'times': at,
        }
        for name, unit, scale, at in (
            ('x position', 'mm', 1.0, early),
            ('oil temperature', 'degC', 0.1, late),
            ('x force', 'N', 10.0, early),
        )
    ]
    path.write_text(json.dumps({'channels': channels}))
    names = source_of(path).names()
    times = [at for at, name in enumerate(names) if name.endswith('time')]
    assert len(times) == 2
    assert {*names[slice(*times)][1:]} == {'x position [mm]', 'x force [N]'}


def test_signals_of_one_name_do_not_replace_each_other(tmp_path, refused):
    path = tmp_path / 'log.json'
    channels = [{'name': 'speed', 'axis': axis, 'unit': 'mm/s', 'values': [1.0]} for axis in 'XZ']
    path.write_text(json.dumps({'channels': channels}))
    refused('one_name', source_of, path)
    path.write_text(json.dumps({'columns': ['t', 'v', 'v'], 'data': [[0.0, 1.0, 2.0]] * 4}))
    refused('columns_of_one_name', source_of, path)
    trace = tmp_path / 'trace.xml'
    signals = ''.join(f'<dataSignal id="s{at}" name="X actual speed"/>' for at in (1, 2))
    trace.write_text(f'<trace>{signals}<rec time="0" s1="1" s2="2"/></trace>')
    assert source_of(trace).names() == ['time', 'X actual speed s1', 'X actual speed s2']


@pytest.mark.parametrize('value', [0.0, 1.5, 1.79578e12, 1.7e9])
@pytest.mark.parametrize('name', ['t', 'Time', 't [s]'])
def test_a_time_that_is_the_same_in_all_rows_is_named_as_such(name, value, tmp_path):
    path = tmp_path / 'log.csv'
    path.write_text(f'{name};{NAMED[1]}\n' + ''.join(f'{value:g};{v}\n' for v in SPEED))
    made = guess(path)
    assert made.content['time']['rate_Hz'] is None
    assert f'column {name!r}: it is {value:.12g} in all rows' in ' '.join(made.unstated)


@pytest.mark.parametrize(
    ('text', 'column'),
    [
        ('[Header]\nMachine=3\n[Data]\n' + table(), 'x speed [mm/s]'),
        ('[LOGGING];3\n' + table(), 'x speed [mm/s]'),
    ],
)
def test_a_section_in_brackets_is_no_json(text, column, tmp_path):
    path = tmp_path / 'log.csv'
    path.write_text(text)
    assert column in source_of(path).names()


@pytest.mark.parametrize(
    ('names', 'kinds'),
    [
        ('x load [A]', {'current'}),
        ('x load (Nm)', {'torque'}),
        ('x speed at load [mm/s]', {'speed'}),
        ('IL.FB (A)', {'current'}),
    ],
)
def test_the_unit_tells_which_of_several_quantities_a_name_means(names, kinds, tmp_path):
    path = tmp_path / 'log.csv'
    path.write_text(table().replace(NAMED[2] if 'speed' not in names else NAMED[1], names))
    assert kinds <= {*guess(path).content['axes']['x']}


@pytest.mark.parametrize('name', ['X load', 'X torque', 'X Auslastung'])
@pytest.mark.parametrize('form', ['{:.1f} %', '{:.1f}%'])
def test_cells_in_per_cent_are_those_of_the_rated_torque(name, form, tmp_path):
    """Controls mean by a load in per cent the torque of the motor."""
    torque = np.round(20.0 * np.sin(math.tau * TIMES), 1)
    lines = [
        f'{time:.2f};{speed};{form.format(one)}'
        for time, speed, one in zip(TIMES, SPEED, torque, strict=True)
    ]
    log = tmp_path / 'log.csv'
    log.write_text('\n'.join([f't [s];X speed [mm/s];{name}', *lines, '']))
    content = guess(log).content
    axis = content['axes']['x']
    assert axis['torque'] == {'column': f'{name} [%]', 'unit': '%'}
    axis['torque_rated_Nm'] = 5.0
    (rows,) = next(read_series(log, make_map(content)).blocks())
    np.testing.assert_allclose(rows.columns['x.torque'], 0.05 * torque, atol=1e-9)


@pytest.mark.parametrize(
    ('name', 'in_turn'),
    [
        ('X angle [deg]', 360.0),
        ('Winkel X [Grad]', 360.0),
        ('X angle [rad]', math.tau),
        ('X_motor_angle_deg', 360.0),
        ('Motorwinkel X [°]', 360.0),
    ],
)
def test_an_angle_of_an_axis_is_its_position(name, in_turn, tmp_path):
    """A screw that turns to and fro five times, whose speed is the slope of its angle."""
    turns = 5.0 * (1.0 - np.cos(math.tau * TIMES / 2.4))
    lines = [f'{t:.2f};{in_turn * one:.9f}' for t, one in zip(TIMES, turns, strict=True)]
    log = tmp_path / 'log.csv'
    log.write_text('\n'.join([f't [s];{name}', *lines, '']), encoding='utf-8')
    content = guess(log).content
    assert content['axes']['x']['position']['column'] == name
    (rows,) = next(read_series(log, make_map(content)).blocks())
    speed = 5.0 * math.tau / 2.4 * math.tau * np.sin(math.tau * TIMES / 2.4)  # [rad/s]
    np.testing.assert_allclose(rows.columns['x.speed'][5:-5], speed[5:-5], atol=0.5)


GROUPED = {
    'Swiss': (';', lambda one: f'{one:,.1f}'.replace(',', "'")),
    'German': (';', lambda one: f'{one:,.1f}'.translate(str.maketrans('.,', ',.'))),
    'German blank': (';', lambda one: f'{one:,.1f}'.translate(str.maketrans('.,', ', '))),
    'quoted': (',', lambda one: f'"{one:,.1f}"'),
    'minus behind': (';', lambda one: f'{abs(one):.1f}-' if one < 0.0 else f'{one:.1f}'),
}


@pytest.mark.parametrize('place', [1, 2])
@pytest.mark.parametrize('way', GROUPED)
def test_a_number_for_no_value_is_one_however_its_thousands_are_parted(way, place, tmp_path):
    sign, write = GROUPED[way]
    columns = [TIMES, SPEED, np.where(SPEED >= 0.0, 1200.0, -700.0)]
    columns[place] = np.where((TIMES > 0.5) & (TIMES < 0.6), -9999.0, columns[place])
    names = ['t [s]', 'x speed [mm/s]', 'x force [N]']
    times = [write(1e3 * one) for one in TIMES]
    lines = [
        sign.join([time, *map(write, row)])
        for time, row in zip(times, zip(*columns[1:], strict=True), strict=True)
    ]
    log = tmp_path / 'log.csv'
    log.write_text('\n'.join([sign.join(names).replace('[s]', '[ms]'), *lines, '']))
    content = guess(log).content
    kind = ('speed', 'load')[place - 1]
    assert content['axes']['x'][kind]['none'] is None
    content['axes']['x'][kind]['none'] = [-9999.0]
    (rows,) = next(read_series(log, make_map(content)).blocks())
    known = rows.columns[f'x.{kind}']
    factor = math.tau / 10.0 if kind == 'speed' else 1.0
    lost = columns[place] == -9999.0
    np.testing.assert_array_equal(np.isnan(known), lost)
    np.testing.assert_allclose(known[~lost], factor * columns[place][~lost])


def test_a_number_for_no_value_is_none_of_a_speed_that_goes_backward(tmp_path):
    """The sign that a direction gives makes no value of it."""
    back, lost = SPEED < 0.0, (TIMES > 0.6) & (TIMES < 0.7)
    amounts = np.where(lost, 9999.0, np.abs(SPEED))
    lines = [
        f'{time:.2f};{amount};{"reverse" if one else "forward"}'
        for time, amount, one in zip(TIMES, amounts, back, strict=True)
    ]
    log = tmp_path / 'log.csv'
    log.write_text('\n'.join(['t [s];x speed [mm/s];direction', *lines, '']))
    content = guess(log).content
    speed = content['axes']['x']['speed']
    assert speed['backward'] == {'column': 'direction', 'cells': ['reverse']}
    speed['none'] = [9999]
    (rows,) = next(read_series(log, make_map(content)).blocks())
    known = rows.columns['x.speed']
    np.testing.assert_array_equal(np.isnan(known), lost)
    np.testing.assert_allclose(known[~lost], math.tau / 10.0 * SPEED[~lost], atol=1e-9)


def test_numbers_of_rows_behind_all_columns_are_no_times(tmp_path):
    path = tmp_path / 'log.csv'
    lines = table().splitlines()
    numbered = [f'{lines[0]};', *(f'{line};{at}' for at, line in enumerate(lines[1:]))]
    path.write_text('\n'.join(numbered) + '\n')
    check(path)


def workbook(path, rows):
    openpyxl = pytest.importorskip('openpyxl')
    book = openpyxl.Workbook()
    for row in rows:
        book.active.append(row)
    book.save(path)


def rows_of(change=lambda row: row):
    return [change([float(t), *map(float, one)]) for t, one in zip(TIMES, VALUES, strict=True)]


@pytest.mark.parametrize(
    'heads',
    [
        [['Time', *NAMES], ['s', *UNITS]],
        [['Time', 'Axis X', None, None], ['s', *(name[2:] for name in NAMED)]],
        [['Time [s]', 'Axis X', None, None], [None, *(name[2:] for name in NAMED)]],
        [['Time', 'Axis X', None, None], ['[s]', *(name[2:] for name in NAMES)], [None, *UNITS]],
    ],
)
def test_two_rows_of_names_in_a_workbook_are_name_and_unit(heads, tmp_path):
    path = tmp_path / 'log.xlsx'
    workbook(path, [*heads, *rows_of()])
    check(path)


def test_formulas_without_their_values_are_named(tmp_path, refused):
    path = tmp_path / 'log.xlsx'
    heads = ['t [s]', *NAMED]
    workbook(path, [heads, *rows_of(lambda row: [*row[:2], f'={row[2]}*1', row[3]])])
    refused('formulas', source_of, path)


@pytest.mark.parametrize(
    ('names', 'moment_of'),
    [
        (
            '"TimeString";"Time_ms"',
            lambda t: f'"{moment(t):%d.%m.%Y %H:%M:%S}";{microdays(t):.6f}',
        ),
        ('Number;Date&Time;ms', lambda t: f'{t:.0f};{moment(t):%Y/%m/%d %H:%M:%S};{part(t)}'),
    ],
)
def test_times_of_controls_are_read(names, moment_of, tmp_path):
    path = tmp_path / 'log.csv'
    lines = [f'{names};{";".join(NAMED)}']
    lines += [
        f'{moment_of(t)};{p:.3f};{v:.1f};{f:.1f}'
        for t, (p, v, f) in zip(TIMES, VALUES, strict=True)
    ]
    path.write_text('\n'.join(lines) + '\n')
    check(path)


def microdays(seconds):
    return 1e6 * ((moment(seconds) - dt.datetime(1899, 12, 30)) / dt.timedelta(days=1))


def test_hours_go_on_after_24_as_a_clock_that_counts(tmp_path):
    path = tmp_path / 'log.csv'
    counted = [86399.0 + t for t in TIMES]
    texts = [
        f'{int(c // 3600):02d}:{int(c // 60 % 60):02d}:{c % 60:06.3f}'
        for c in (round(c, 3) for c in counted)
    ]
    rows = [
        f'{text};{p:.3f};{v:.1f};{f:.1f}' for text, (p, v, f) in zip(texts, VALUES, strict=True)
    ]
    path.write_text('\n'.join([';'.join(['Time', *NAMED]), *rows]) + '\n')
    check(path)
