# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Tables that are not as they should be: one sentence, or the good part and how much it is."""

import datetime as dt
import math
from pathlib import Path
import tempfile

from ballscrew_monitor.recordings.tables import cells, read, sources
from ballscrew_monitor.recordings.tables.quantities import Layout
from ballscrew_monitor.recordings.tables.read import look_through, open_table
from ballscrew_monitor.recordings.tables.sources import source_of
from hypothesis import given, settings
from hypothesis import strategies as st
import numpy as np
import polars as pl
import pytest
from surrogate.files import InputError


def text_log(tmp_path, text):
    path = tmp_path / 'log.csv'
    path.write_bytes(text if isinstance(text, bytes) else text.encode())
    return path


def test_numbers_come_as_they_are(tmp_path):
    table = open_table(text_log(tmp_path, 'a,b,c\n1,2,x\n3,4e1,y\n'), ['b', 'a'])
    expected = {'a': [1, 3], 'b': [2, 40]}
    assert {name: list(values) for name, values in table.head(99).items()} == expected
    assert table.rows == 2
    assert not table.notes


@pytest.mark.parametrize(
    'text',
    [
        'a;b\n1,5;2\n2,5;3\n',
        'a\tb\n1.5\t2\n2.5\t3\n',
        '# a comment\na,b\n1.5,2,\n2.5,3\n',
        '# of axis x, drive 3, in the night, at the mill\na;b\n1.5;2\n2.5;3\n',
        b'a,b,\xb5\n1.5,2,1\n2.5,3,1\n',
        'a;b;"c, d, e, f"\n1,5;2;1\n2,5;3;1\n',
        '\ufeffa;b\n1,5;2\n2,5;3\n',
        '\ufeff# of axis x, drive 3, in the night\na;b\n1.5;2\n2.5;3\n',
    ],
    ids=[
        'decimal comma',
        'tab',
        'comment',
        'comment of other marks',
        'latin',
        'quoted separators',
        'byte order mark',
        'byte order mark before a comment',
    ],
)
def test_other_forms_are_read_too(text, tmp_path):
    table = open_table(text_log(tmp_path, text), ['a', 'b'])
    assert list(table.head(99)['a']) == [1.5, 2.5]
    assert list(table.head(99)['b']) == [2, 3]


@pytest.mark.parametrize(
    ('text', 'expected'),
    [
        ('t;v\n0;0\n0,1;1\n0,2;2\n0,3;3\n', [0.0, 0.1, 0.2, 0.3]),
        ('t;v\n0;0\n0.1;1\n0.2;2\n0,3;3\n', [0.0, 0.1, 0.2, np.nan]),
        ('t,v\n"0,1",0\n"0,2",1\n', [0.1, 0.2]),
    ],
    ids=['whole number among them', 'points in most', 'in quotes'],
)
def test_the_decimal_mark_is_that_of_most_cells(text, expected, tmp_path):
    values = open_table(text_log(tmp_path, text), ['t']).head(99)['t']
    np.testing.assert_array_equal(values, expected)


def test_an_optional_column_whose_cells_hold_several_values_is_left_out(tmp_path):
    path = tmp_path / 'log.parquet'
    pl.DataFrame({'t': [0.0, 1.0], 'v': [['a'], ['b']]}).write_parquet(path)
    table = open_table(path, ['t', 'v'], optional=['v'])
    assert list(table.head(9)['t']) == [0.0, 1.0]
    assert 'it must hold numbers' in table.left_out['v']


@pytest.mark.parametrize(
    ('text', 'key'),
    [
        ('t,v,F\n' + 9 * '0,01,1,5,2,5\n', 'decimal_comma'),
        ('t;v\n' + 5 * '1;2\n' + '1;2;3\n' + 5 * '1;2\n', 'one_more'),
        ('t;v\n' + 8 * '1;2\n2\n', 'fewer'),
    ],
)
def test_rows_of_more_cells_than_names_or_often_fewer_are_refused(text, key, tmp_path, refused):
    refused(key, open_table, text_log(tmp_path, text), ['t', 'v'])


@pytest.mark.parametrize('below', ['t [s];v [m/min]', 's;m/min', '# t [s];v [m/min]', 't;F [N]'])
def test_other_names_or_units_below_the_head_are_refused(below, tmp_path, refused):
    rows = 9 * '1;2\n'
    for head in ('t [s];v [mm/s]', 't;v\ns;mm/s'):
        path = text_log(tmp_path, f'{head}\n{rows}{below}\n{rows}')
        refused('other_names', open_table, path, source_of(path).names())
    for head in ('t [s];v [mm/s]', 't;v\ns;mm/s'):
        path = text_log(tmp_path, f'{head}\n{rows}{head}\n{rows}ERROR;ERROR\n')
        assert np.nansum(open_table(path, source_of(path).names()).head(99)['v [mm/s]']) == 36


@pytest.mark.parametrize('sign', [';', ',', '\t'])
@pytest.mark.parametrize(
    'words',
    [['tool change', 'by hand'], ['stop', 'start', 'stop'], ['one', 'two', 'three', 'four']],
)
def test_a_remark_of_as_many_words_as_columns_is_none_of_names(words, sign, tmp_path):
    names = [f'v{at} [mm/s]' for at in range(len(words))]
    rows = 9 * (sign.join('1' for _ in words) + '\n')
    remark = f'# {sign.join(words)}\n'
    path = text_log(tmp_path, f'{sign.join(names)}\n{rows}{remark}{rows}')
    assert np.nansum(open_table(path, names).head(99)[names[0]]) == 18


def test_a_row_of_fewer_cells_is_left_out_and_counted(tmp_path, says):
    """Which of its cells is missing is not known: none of them is read, however others are."""
    table = open_table(text_log(tmp_path, 't;v;w\n' + 30 * '1;2;x\n' + '1;3\n\n'), ['t', 'v'])
    assert np.nansum(table.head(99)['v']) == 60
    assert says('short_row') in table.notes[0]


@pytest.mark.parametrize('name', ['beside it', 'far off', 'both', 'quoted', 'blank', 'remark'])
def test_a_longer_row_does_not_hide_one_of_fewer_cells(name, tmp_path, says):
    """As many cells as there should be in all are no proof of each row."""
    rows = [f'{row},{2 * row},{3 * row}' for row in range(100)]
    longer = 41 if name == 'beside it' else 80
    rows[longer] += {'quoted': ',""', 'blank': ', '}.get(name, ',')
    rows[40] = '40,120'
    if name == 'remark':
        rows.insert(60, '# seen, by hand')
    end = '\r\n' if name == 'both' else '\n'
    table = open_table(text_log(tmp_path, end.join(['t,v,w', *rows, ''])), ['t', 'v'])
    assert says('one_shorter') in table.notes[0]
    values = table.head(999)['v'].tolist()
    expected = [math.nan if row == 40 else 2.0 * row for row in range(100)]
    np.testing.assert_array_equal(values, expected)
    assert open_table(table.path, ['w']).notes == table.notes


@pytest.mark.parametrize('seen', [{}, {0: 'begin'}, {7: 'seen', 30: 'end'}])
def test_a_last_column_of_comments_may_be_left_out_of_a_row(seen, tmp_path):
    """As LabVIEW writes it."""
    rows = [f'{row},{2 * row}' + (f',{seen[row]}' if row in seen else '') for row in range(40)]
    table = open_table(text_log(tmp_path, '\n'.join(['t,v,Comment', *rows, ''])), ['t', 'v'])
    assert not table.notes
    assert table.head(99)['v'].tolist() == [2 * row for row in range(40)]


@pytest.mark.parametrize(('sign', 'is_german'), [(',', True), ('.', False)])
def test_dates_with_points_beside_a_decimal_comma_begin_with_the_day(
    sign, is_german, tmp_path, says, refused
):
    rows = [f'14.07.25 08:00:{at:02d};{at}{sign}5;0' for at in range(20)]
    path = text_log(tmp_path, '\n'.join(['t;v;w', *rows, '']))
    if not is_german:
        refused('several_dates', open_table, path, ['t', 'v'])
        return
    table = open_table(path, ['t', 'v'])
    begin = dt.datetime(2025, 7, 14, 8, tzinfo=dt.UTC).timestamp()
    np.testing.assert_array_equal(table.head(99)['t'], begin + np.arange(20.0))
    assert says('dates_with_points', path=path) in table.notes


def test_times_of_day_become_seconds(tmp_path):
    text = 't\n2026-01-02T03:04:05.5Z\n2026-01-02T03:04:06.5Z\n'
    values = open_table(text_log(tmp_path, text), ['t']).head(99)['t']
    assert values[0] == 1767323045.5
    assert values[1] - values[0] == 1.0


def test_what_follows_a_colon_is_a_whole_number_of_milliseconds(tmp_path):
    cells = ''.join(f'11:59:{54 + row // 1000}:{row % 1000}\n' for row in range(0, 3000, 10))
    values = open_table(text_log(tmp_path, f't\n{cells}'), ['t']).head(999)['t']
    np.testing.assert_allclose(np.diff(values), 0.01)


@pytest.mark.parametrize('block', [1, 2, 99])
def test_a_column_is_read_in_the_form_of_most_cells(tmp_path, monkeypatch, block, says):
    monkeypatch.setattr(sources, 'BLOCK', block)
    text = 't\n7\n2026-01-02T03:04:05\n8\n2026-01-02T03:04:06\n2026-01-02T03:04:07\n'
    table = open_table(text_log(tmp_path, text), ['t'])
    values = table.head(99)['t']
    assert np.isnan(values).tolist() == [True, False, True, False, False]
    assert values[3] - values[1] == 1.0
    assert says('2_cells_without') in table.notes[0]
    table = open_table(text_log(tmp_path, 't\n1\n2026-01-02T03:04:05\n3\n'), ['t'])
    np.testing.assert_array_equal(table.head(99)['t'], [1, np.nan, 3])


def test_cells_without_a_finite_number_are_unknown_and_counted(tmp_path, says, refused):
    table = open_table(text_log(tmp_path, 'a,b\n1,2\n1,oops\n1,\n1,'), ['a', 'b'])
    assert np.isnan(table.head(99)['b']).tolist() == [False, True, True, True]
    assert table.notes[0].endswith(says('column_b'))
    table = open_table(text_log(tmp_path, 'a\n1\nNaN\ninf\n4\n'), ['a'])
    np.testing.assert_array_equal(table.head(99)['a'], [1, np.nan, np.nan, 4])
    np.testing.assert_array_equal(table.readings['a'].extremes, [1, 4])
    assert says('2_cells') in table.notes[0]
    path = tmp_path / 'log.parquet'
    pl.DataFrame({'a': [1.0, np.nan, None], 'b': [np.nan] * 3}).write_parquet(path)
    assert says('2_cells_without_number') in open_table(path, ['a']).notes[0]
    refused('column_b_holds', open_table, path, ['b'])


@pytest.mark.parametrize(
    ('text', 'expected'),
    [
        ('', 'empty'),
        ('  \n', 'empty'),
        ('a,b\n', 'holds_row'),
        ('a,b\nx,1\ny,2\n', 'column_holds_number'),
        ('a,b\nNaN,1\nNaN,2\n', 'column_holds'),
        ('b,c\n1,2\n', 'column_missing_log'),
        (b'\x00\x01\x02' * 50, 'text_2'),
        (b'PAR1 and no more', 'cannot_read_2'),
        ('# nothing but a comment\n', 'cannot_read_2'),
    ],
)
def test_what_cannot_be_read_is_one_sentence(text, expected, tmp_path, says):
    with pytest.raises(InputError) as caught:
        open_table(text_log(tmp_path, text), ['a'])
    assert says(expected) in str(caught.value)
    assert '\n' not in str(caught.value)


def test_what_is_not_there_or_not_converted_is_a_sentence(tmp_path, refused, monkeypatch):
    refused('cannot_read_such', source_of, tmp_path / 'log.csv')

    def fail(texts):
        raise pl.exceptions.InvalidOperationError('conversion failed\nmore of it')

    monkeypatch.setattr(cells, '_points', fail)
    refused('column_string_cannot', open_table, text_log(tmp_path, 'a\n1\n'), ['a'])


def test_parquet_is_read_with_its_types(tmp_path, refused):
    path = tmp_path / 'log.parquet'
    times = pl.datetime_range(
        pl.datetime(2026, 1, 1), pl.datetime(2026, 1, 1, 0, 0, 2), '1s', eager=True
    )
    frame = pl.DataFrame(
        {'t': times, 'n': [1, 2, None], 'text': ['1', '2', 'x'], 'flag': [True, False, True]}
    )
    frame.write_parquet(path)
    table = open_table(path, ['t', 'n', 'text'])
    assert list(np.diff(table.head(99)['t'])) == [1.0, 1.0]
    assert np.isnan(table.head(99)['n'][2])
    assert len(table.notes) == 1
    assert table.readings['n'].holes[0] == 1
    refused('column_flag_holds', open_table, path, ['flag'])
    path.write_bytes(path.read_bytes()[:-20])
    refused('cannot_read', open_table, path, ['n'])


@pytest.mark.parametrize('unit', ['ms', 'us', 'ns'])
def test_times_and_durations_of_parquet_are_seconds(tmp_path, unit):
    path = tmp_path / 'log.parquet'
    spans = [dt.timedelta(seconds=1.5), None, dt.timedelta(hours=1)]
    frame = pl.DataFrame(
        {
            'span': pl.Series(spans, dtype=pl.Duration(unit)),
            'clock': [dt.time(0, 0, 2), dt.time(1), None],
        }
    )
    frame.write_parquet(path)
    table = open_table(path, ['span', 'clock'])
    np.testing.assert_array_equal(table.head(99)['span'], [1.5, np.nan, 3600.0])
    np.testing.assert_array_equal(table.head(99)['clock'], [2.0, 3600.0, np.nan])
    assert not table.notes
    assert table.readings['span'].holes != table.readings['clock'].holes


def test_a_missing_column_is_refused_with_what_may_be_meant(tmp_path, refused):
    path = text_log(tmp_path, 'Maschine;3\nZeit;Kraft\ns;N\n0;1\n1;2\n')
    refused('meant', open_table, path, ['Kraft'])
    refused('meant_elsewhere', open_table, path, ['Kraft [N]'], layout=Layout())
    names = ','.join(['n' * 99, *(f'c{number}' for number in range(99))])
    refused('many_names', open_table, text_log(tmp_path, f'{names}\n1\n'), ['x'])


def test_an_optional_column_without_a_number_is_left_out_with_the_reason(tmp_path, says):
    path = text_log(tmp_path, 'a,b,c\n1,x,2\n2,y,3\n')
    table = open_table(path, ['a', 'b'], optional=['b'])
    assert list(table.head(9)) == ['a']
    assert table.left_out['b'].endswith(says('left_out'))
    assert not table.notes


@pytest.mark.parametrize(
    ('text', 'layout'),
    [
        ('a,b\n1,2\n1,oops\n', Layout()),
        ('# of axis x\n\na,b\n1,2\n1,oops\n', Layout()),
        ('Maschine;3\nZeit;b\ns;\n0;1\n1;oops\n', Layout(skip=1, header_rows=2)),
        ('"a\nof two lines",b\r\n1,2\r\n1,oops\r\n', Layout()),
        ('a,b\n\n1,2\n1,oops\n', Layout()),
    ],
    ids=['names', 'comment', 'units', 'name of two lines', 'empty line'],
)
def test_rows_are_the_lines_of_the_file(text, layout, tmp_path):
    table = open_table(text_log(tmp_path, text), ['b'], layout=layout)
    unknown = table.first_row + np.flatnonzero(np.isnan(table.head(99)['b']))
    lines = text.splitlines()
    assert lines[unknown[-1] - 1].endswith('oops')
    assert f'in row {unknown[-1]};' in table.notes[0]


PLAIN = ['1', '20', '-3', '0.5', '2.5', '1e5', '7.25']
ODD = [*PLAIN, '', ' ', 'x', 'nan', 'inf', '1.234', '1,5', '1,234.5', '1 234', '12:30:00', '"8"']


def looked_through(path, tries):
    """Return all that is known of a table and its cells, where parts may have types or none."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(sources, 'PART', 24)
        patch.setattr(sources, 'TRIES', tries)
        try:
            table = look_through(sources.source_of(path), ['a', 'b'], optional=['a', 'b'])
        except InputError as error:
            return str(error)
        columns = {name: [repr(one) for one in cells] for name, cells in table.head(999).items()}
        readings = {
            name: (one.note, one.holes, one.extremes.tolist())
            for name, one in table.readings.items()
        }
        return columns, readings, table.notes, table.doubts, table.left_out, table.decision


@settings(max_examples=settings.default.max_examples // 2)
@given(
    first=st.lists(st.tuples(st.sampled_from(PLAIN), st.sampled_from(PLAIN)), min_size=3),
    rest=st.lists(st.tuples(st.sampled_from(PLAIN), st.sampled_from(ODD)), max_size=12),
    last=st.lists(st.tuples(st.sampled_from(ODD), st.sampled_from(PLAIN)), max_size=6),
)
def test_a_text_read_by_types_is_the_text_read_as_text(first, rest, last):
    """Columns of plain numbers may go on with anything else."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / 'log.csv'
        rows = [f'{a};{b}' for a, b in [*first, *rest, *last]]
        path.write_text('\n'.join(['a;b', *rows]) + '\n')
        assert looked_through(path, 3) == looked_through(path, 0)


def test_cells_of_plain_numbers_are_read_by_type(tmp_path):
    """Once a decimal point or none at all is shown, no text is made of them."""
    path = tmp_path / 'log.csv'
    path.write_text('a,b\n' + ''.join(f'{row},{row + 0.25}\n' for row in range(200_000)))
    table = open_table(path, ['a', 'b'])
    types = {name: one.plain for name, one in table.readings.items()}
    assert types == {'a': pl.Int64, 'b': pl.Float64}
    blocks = list(table.source.blocks(['a', 'b'], types))
    assert {tuple(block.dtypes) for block in blocks} == {(pl.Int64, pl.Float64)}
    assert table.readings['b'].extremes.tolist() == [0.25, 199_999.25]


@pytest.mark.parametrize('rows', [50, 900, 5000, 40_000])
@pytest.mark.parametrize('block', [64, 1000])
def test_a_sample_spans_a_table_in_rows_that_follow_each_other(rows, block, tmp_path, monkeypatch):
    monkeypatch.setattr(sources, 'BLOCK', block)
    monkeypatch.setattr(read, 'PIECE', 50)
    monkeypatch.setattr(read, 'MOST_ROWS', 1000)
    lines = ''.join(f'{row},{-1 - row if row > rows - 90 else 0.5}\n' for row in range(rows))
    table = open_table(text_log(tmp_path, f'a,b\n{lines}'), ['a', 'b'])
    sampled = table.sampled('a')
    assert len(sampled) == rows if rows <= 1000 else 400 < len(sampled) <= 1050
    assert sampled[0] == 0
    assert sampled[-1] > 0.9 * rows
    steps = np.diff(sampled)
    assert (steps > 0).all()
    assert (steps == 1).mean() > 0.95
    np.testing.assert_array_equal(table.sampled('b') < 0, sampled > rows - 90)
