# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Numbers that may be read in two ways are refused until the map states the decimal sign.

The true numbers are those that are written here, with one decimal sign in all of a log.

"""

import json
import math
from pathlib import Path
import tempfile

from ballscrew_monitor import cli
from ballscrew_monitor.recordings.tables import sources
from ballscrew_monitor.recordings.tables.mapping import make_map
from ballscrew_monitor.recordings.tables.read import open_table
from ballscrew_monitor.recordings.tables.series import read_series
from ballscrew_monitor.recordings.tables.signs import signless
from hypothesis import given
from hypothesis import strategies as st
import numpy as np
import openpyxl
import polars as pl
import pytest
from surrogate.files import InputError

OTHER = {'.': ',', ',': '.'}


def written(value, sign, digits=0, *, parted=True):
    """Return a number with a decimal sign, its thousands parted by the other one or by nothing."""
    text = f'{value:,.{digits}f}' if parted else f'{value:.{digits}f}'
    return text.translate(str.maketrans('.,', sign + OTHER[sign]))


def log_of(folder, columns, separator=';'):
    """Write a table of texts, in quotes where they hold the separator."""
    rows = [list(columns), *zip(*columns.values(), strict=True)]
    quoted = [[f'"{cell}"' if separator in cell else cell for cell in row] for row in rows]
    path = Path(folder) / 'log.csv'
    path.write_text(''.join(f'{separator.join(row)}\n' for row in quoted))
    return path


@pytest.fixture
def read(tmp_path):
    """Return a function that reads columns of texts, by default all of them."""

    def make(columns, names=None, *, decimal='', separator=';'):
        path = log_of(tmp_path, columns, separator)
        return open_table(path, names or list(columns), decimal=decimal).head(99)

    return make


@pytest.mark.parametrize('sign', '.,')
def test_one_column_shows_the_sign_of_all(read, sign):
    columns = {
        't': [written(row / 100, sign, 2) for row in range(3)],
        'v': ['845', '0', written(5400.0, sign)],
    }
    for decimal in ('', sign):
        assert read(columns, decimal=decimal)['v'].tolist() == [845.0, 0.0, 5400.0]
    assert read(columns, decimal=OTHER[sign])['v'].tolist() == [845.0, 0.0, 5.4]
    assert read(columns, decimal=OTHER[sign])['t'].tolist() == [0.0, 0.01, 0.02]  # they show it


@pytest.mark.parametrize('shown', ['12,35', '1.234,5', '1.234.567'])
def test_a_cell_of_the_column_shows_the_sign_too(read, shown):
    true = {'12,35': 12.35, '1.234,5': 1234.5, '1.234.567': 1_234_567.0}[shown]
    assert read({'n': ['1', '2'], 'v': ['5.400', shown]})['v'].tolist() == [5400.0, true]


def test_a_column_that_is_not_read_shows_the_sign_too(read):
    columns = {'t': ['0', '10'], 'v': ['5.400', '5.500'], 'oil': ['41,5', '41,5']}
    assert read(columns, ['t', 'v'])['v'].tolist() == [5400.0, 5500.0]


def test_columns_of_either_sign_leave_others_in_doubt(read, refused):
    refused('neither', read, {'v': ['5.400'], 'f': ['1,250']})
    columns = {'a': ['0.5'], 'b': ['0,5'], 'v': ['5.400']}
    refused('both', read, columns)
    assert read(columns, decimal=',') == {'a': [0.5], 'b': [0.5], 'v': [5400.0]}


@pytest.mark.parametrize('mark', [' ', "'", '\u2019', '\xa0', '\u202f'])
@pytest.mark.parametrize('sign', '.,')
def test_blanks_and_apostrophes_part_thousands(read, mark, sign):
    texts = [f'5{mark}400', f'-1{mark}234{mark}567{sign}5', '12', f'0{sign}5']
    values = read({'n': ['1', '2', '3', '4'], 'v': texts})['v']
    assert values.tolist() == [5400.0, -1_234_567.5, 12.0, 0.5]


VALUES = st.lists(
    st.floats(-5e6, 5e6) | st.integers(-9999, 9999).map(float), min_size=1, max_size=9
)


@given(VALUES, st.sampled_from('.,'), st.sampled_from(';\t,'), st.integers(0, 4), st.booleans())
def test_no_number_is_another_one(values, sign, separator, digits, parted):
    """It is right, unknown or refused; once the sign is stated it is right."""
    columns = {
        't': [written(row / 100, sign, 2) for row in range(len(values))],
        'v': [written(value, sign, digits, parted=parted) for value in values],
    }
    true = np.array([float(f'{value:.{digits}f}') for value in values])
    with tempfile.TemporaryDirectory() as folder:
        log = log_of(folder, columns, separator)
        found = open_table(log, ['t', 'v'], decimal=sign).head(99)
        np.testing.assert_array_equal(found['v'], true)
        np.testing.assert_array_equal(found['t'], np.arange(len(values)) / 100)
        try:
            found = open_table(log, ['t', 'v']).head(99)
        except InputError:
            return
        known = np.isfinite(found['v'])
        np.testing.assert_array_equal(found['v'][known], true[known])


@pytest.mark.parametrize('block', [1, 2, 99])
@pytest.mark.parametrize(
    ('shown', 'expected'),
    [('0.125', 0.125), ('5.4e3', 5400.0), ('1234.567', 1234.567), ('1.2345', 1.2345)],
)
def test_a_column_that_shows_its_sign_is_read_by_it(read, monkeypatch, shown, expected, block):
    monkeypatch.setattr(sources, 'BLOCK', block)
    columns = {'t': ['0,1', '0,2'], 'v': ['5.432', shown]}
    for decimal in ('', ',', '.'):
        assert read(columns, decimal=decimal)['v'].tolist() == [5.432, expected]


@pytest.mark.parametrize('shown', ['1480.0', '12.35', '.5', '60.0'])
def test_numbers_of_two_writings_in_one_column_are_refused(read, refused, shown):
    columns = {'t': ['0,1', '0,2'], 'v': ['5.400', shown]}
    for decimal in ('', ','):
        refused('two_writings', read, columns, decimal=decimal)
    assert read(columns, decimal='.')['v'].tolist() == [5.4, float(shown)]
    alone = {'t': ['0.1', '0.2'], 'v': ['5.400', shown]}  # four digits of a meter
    assert read(alone)['v'].tolist() == [5.4, float(shown)]


def test_whole_numbers_between_commas_show_that_a_point_may_part_thousands(read, refused):
    columns = {'t': ['0', '10', '20'], 'v': ['0', '-910', '5.400']}
    refused('whole', read, columns, separator=',')
    assert read(columns, decimal='.', separator=',')['v'].tolist() == [0.0, -910.0, 5.4]
    assert read(columns, decimal=',', separator=',')['v'].tolist() == [0.0, -910.0, 5400.0]
    for shown in ('12.5', '0.125', '1480', '.5'):  # 1480 has no sign where it could have
        true = [0.0, float(shown), 5.4]
        assert read(columns | {'v': ['0', shown, '5.400']}, separator=',')['v'].tolist() == true
    columns['w'] = ['-12.345', '0.000', '5.400']
    assert read(columns, separator=',')['v'].tolist() == [0.0, -910.0, 5.4]


@pytest.fixture(scope='module')
def container(tmp_path_factory):
    """Return a function that writes columns of numbers and texts to a file of a kind."""

    def write(kind, columns):
        path = tmp_path_factory.mktemp('container') / f'log.{kind}'
        cells = [*zip(*columns.values(), strict=True)]
        rows = [dict(zip(columns, row, strict=True)) for row in cells]
        if kind == 'xlsx':
            book = openpyxl.Workbook()
            for row in [list(columns), *cells]:
                book.active.append(row)
            book.save(path)
        elif kind == 'parquet':
            pl.DataFrame(columns).write_parquet(path)
        elif kind == 'json':
            path.write_text(json.dumps(rows))
        else:
            path.write_text(''.join(f'{json.dumps(row)}\n' for row in rows))
        return path

    return write


@pytest.mark.parametrize('kind', ['xlsx', 'parquet', 'json', 'jsonl'])
def test_true_numbers_prove_no_sign_of_texts(kind, container, refused):
    times, texts = [0.25, 0.5, 0.75], ['0', '-5.400', '12.000']
    log = container(kind, {'t': times, 'v': texts})
    refused('true_numbers', open_table, log, ['t', 'v'])
    for decimal, scale in (('.', 1.0), (',', 1000.0)):
        found = open_table(log, ['t', 'v'], decimal=decimal).head(9)
        assert found['v'].tolist() == [0.0, -5.4 * scale, 12.0 * scale]
        assert found['t'].tolist() == times
    for shown, true in (('0,5', 5400.0), ('0.5', 5.4)):
        log = container(kind, {'t': times, 'v': ['5.400', '7', shown]})
        assert open_table(log, ['t', 'v']).head(9)['v'][0] == true


@pytest.mark.parametrize('kind', ['xlsx', 'json', 'jsonl'])
def test_true_numbers_among_texts_prove_none_either(kind, container, refused):
    numbers = ['1.480', -910.5, 60.125, 1e-9, 3]
    log = container(kind, {'t': [0.25, 0.5, 0.75, 1.0, 1.25], 'v': numbers})
    refused('among_texts', open_table, log, ['t', 'v'])
    for decimal, first in (('.', 1.48), (',', 1480.0)):
        found = open_table(log, ['t', 'v'], decimal=decimal).head(9)
        assert found['v'].tolist() == [first, *numbers[1:]]


@given(st.floats(allow_nan=False, allow_infinity=False))
def test_a_number_without_a_sign_is_the_same(number):
    text = signless(number)
    assert float(text) == number
    assert '.' not in text


@pytest.mark.parametrize('separator', ';\t')
def test_a_log_that_shows_no_sign_is_refused(read, refused, separator):
    columns = {'t': ['0', '10'], 'v': ['5.400', '-12.000'], 'n': ['N 1,5', '14.07.2025 10:00,5']}
    refused('nowhere', read, columns, ['t', 'v'], separator=separator)
    assert read(columns, ['t', 'v'], decimal='.')['v'].tolist() == [5.4, -12.0]
    assert read(columns, ['t', 'v'], decimal=',')['v'].tolist() == [5400.0, -12000.0]
    columns = {'t': ['0', '10'], 'v': ['5,400', '5,500']}
    refused('nowhere_comma', read, columns, separator=separator)


@pytest.mark.parametrize('shown', ['0.400', '0.000', '1234.500', '20.5'])
def test_a_cell_or_another_column_shows_that_a_point_is_decimal(read, shown):
    true = float(shown)
    assert read({'t': ['0', '10'], 'v': ['10.000', shown]})['v'].tolist() == [10.0, true]
    columns = {'t': ['0', '10'], 'v': ['10.000', '20.500'], 'w': ['40.000', shown]}
    assert read(columns, ['t', 'v'])['v'].tolist() == [10.0, 20.5]


def test_a_point_between_commas_is_decimal_where_large_numbers_have_none(read, refused):
    columns = {'t': ['0', '10'], 'v': ['5.400', '5.500'], 'n': ['N 1', '14.07.2025 10:00:00']}
    refused('neither', read, columns, ['t', 'v'], separator=',')
    for large in ({'t': ['0', '1000']}, {'n': ['999', '1480']}):
        assert read(columns | large, ['t', 'v'], separator=',')['v'].tolist() == [5.4, 5.5]


@pytest.mark.parametrize(
    ('content', 'key'), [(None, 'blank'), ('', 'empty'), (';', 'other'), ([','], 'list')]
)
def test_a_map_states_a_point_or_a_comma(content, key, refused):
    axes = {'x': {'lead_mm': 10.0, 'speed': {'column': 'v', 'unit': 'mm/s'}}}
    mapping = {'time': {'rate_Hz': 10.0}, 'axes': axes}
    assert make_map(mapping).decimal == ''
    assert make_map(mapping | {'decimal': ','}).decimal == ','
    refused(key, make_map, mapping | {'decimal': content})


COUNT = 800


@pytest.fixture
def doubtful_log(tmp_path):
    """Return a log of up to 540 rev/min at 10 mm of lead, of which no cell shows the sign."""
    speeds = 5400.0 * np.sin(math.pi * np.arange(COUNT) / 200)
    columns = {
        'Zeit [ms]': [f'{10 * row}' for row in range(COUNT)],
        'X Vorschub [mm/min]': [written(speed, ',') for speed in speeds],
        'X Kraft [N]': [written(-2400.0 if speed >= 0.0 else 2400.0, ',') for speed in speeds],
    }
    return log_of(tmp_path, columns)


def test_each_command_refuses_it_until_the_map_says_which(doubtful_log, tmp_path, capsys, says):
    log, mapping, out = str(doubtful_log), tmp_path / 'map.yaml', tmp_path / 'out'
    assert cli.main(['import', log, '--guess']) == 0
    captured = capsys.readouterr()
    assert says('of_the_log', log=log) in captured.err
    assert f'#   {says("of_the_log", log=log)}\n' in captured.out
    unsaid = captured.out.replace('decimal: null\n', '')
    for content, said in ((captured.out, says('blank')), (unsaid, says('of_the_log', log=log))):
        mapping.write_text(content)
        for command in (
            ['import', log, '--config', str(mapping), '--out', str(out)],
            ['replay', log, '--map', str(mapping)],
            ['health', log, '--map', str(mapping)],
        ):
            assert cli.main(command) == 2, command
            assert said in capsys.readouterr().err
    mapping.write_text(captured.out.replace('decimal: null', "decimal: ','"))
    assert cli.main(['replay', log, '--map', str(mapping)]) == 0
    shown = capsys.readouterr().out
    assert '-56.55 to 56.55 rad/s' in shown
    assert '-2400 to 2400 N' in shown
    assert ', 46 revolutions, ' in shown


def test_one_look_is_enough_for_a_log_that_is_clear(tmp_path, monkeypatch):
    """Other columns are looked at only where those of the map leave a doubt."""
    looks = []
    plain = sources.Source.first_rows
    monkeypatch.setattr(
        sources.Source, 'first_rows', lambda source: looks.append(source) or plain(source)
    )
    axes = {'x': {'lead_mm': 10.0, 'speed': {'column': 'v', 'unit': 'mm/s'}}}
    time = {'t': ['1', '2']}
    mapping = make_map({'time': {'column': 't', 'unit': 's', 'epoch': '2026-01-01'}, 'axes': axes})
    read_series(log_of(tmp_path, time | {'v': ['5.400', '12.5'], 'n': ['1,5', '2']}), mapping)
    assert not looks
    read_series(log_of(tmp_path, time | {'v': ['5.400', '5.500'], 'n': ['1', '0.5']}), mapping)
    assert len(looks) == 1


@pytest.mark.parametrize('minus', ['-', '- ', '-   ', '\u2212', '\u2212 ', '\u2013'])
@pytest.mark.parametrize('sign', '.,')
def test_a_minus_is_one_however_it_is_written(read, minus, sign):
    texts = [f'{minus}0{sign}800', f'+ 12{sign}5', f'{minus}1{OTHER[sign]}234{sign}5', '+7']
    values = read({'n': ['1', '2', '3', '4'], 'v': texts})['v']
    assert values.tolist() == [-0.8, 12.5, -1234.5, 7.0]


def test_a_doubtful_number_with_a_long_minus_is_refused(read, refused):
    refused('long_minus', read, {'n': ['1'], 'v': ['\u22125.400']})
    assert read({'n': ['1'], 'v': ['\u22125.400']}, decimal=',')['v'].tolist() == [-5400.0]
