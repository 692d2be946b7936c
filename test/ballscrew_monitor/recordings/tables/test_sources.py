# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Tables in whatever form a machine writes them: one log, read alike; and bounds of all."""

import gzip
import io
import json
import zipfile

from ballscrew_monitor.recordings.tables import codings, foreign, sources
from ballscrew_monitor.recordings.tables.quantities import Layout
from ballscrew_monitor.recordings.tables.read import open_table
from ballscrew_monitor.recordings.tables.sources import source_of
import numpy as np
import openpyxl
import polars as pl
import pytest
from surrogate.files import limits

ROWS = [
    ['Maschine', 'DMU 50', '', ''],
    ['Bediener', 'Müller "Max"', '', ''],
    ['Zeit', 'Geschw.', 'Öltemperatur', 'Programm'],
    ['s', 'mm/min', '°C', ''],
    *([f'{row / 10}'.replace('.', ','), f'{row * 7},5', '41', 'Übung'] for row in range(9)),
]
NAMES = ['Zeit [s]', 'Geschw. [mm/min]', 'Öltemperatur [°C]', 'Programm']
LAYOUT = Layout(skip=2, header_rows=2)


def csv_text(separator=';', line_end='\n'):
    cells = (
        ['"' + cell.replace('"', '""') + '"' if '"' in cell else cell for cell in row]
        for row in ROWS
    )
    return ''.join(separator.join(row) + line_end for row in cells)


def workbook(rows):
    book, content = openpyxl.Workbook(), io.BytesIO()
    for row in rows:
        book.active.append([None if cell == '' else cell for cell in row])
    book.save(content)
    return content.getvalue()


FORMS = {
    'utf-8': csv_text().encode(),
    'mark': csv_text().encode('utf-8-sig'),
    'latin-1': csv_text().encode('latin-1'),
    'cp1252': csv_text('|').encode('cp1252'),
    'utf-16': csv_text('\t').encode('utf-16'),
    'utf-16 of the other order': b'\xfe\xff' + csv_text().encode('utf-16-be'),
    'carriage return': csv_text(line_end='\r').encode('cp1252'),
    'both': csv_text(line_end='\r\n').encode(),
    'comments': b'# a; comment\n\n' + csv_text().encode(),
    'xlsx': workbook(ROWS),
}
ONE_BYTE = ('latin-1', 'cp1252', 'carriage return')
"""Forms of which a note names the coding."""


@pytest.fixture
def log(tmp_path):
    def written(content):
        path = tmp_path / 'log.csv'
        path.write_bytes(content)
        return path

    return written


@pytest.mark.parametrize('form', FORMS)
def test_a_log_is_the_same_in_each_form(form, log):
    path = log(FORMS[form])
    assert source_of(path).names() == NAMES
    if form != 'comments':
        assert source_of(path, LAYOUT).names() == NAMES
    table = open_table(path, NAMES[:3])
    assert len(table.notes) == (form in ONE_BYTE)
    found = table.head(99)
    np.testing.assert_array_equal(found['Zeit [s]'], np.arange(9) / 10)
    np.testing.assert_array_equal(found['Geschw. [mm/min]'], np.arange(9) * 7 + 0.5)
    np.testing.assert_array_equal(found['Öltemperatur [°C]'], np.full(9, 41.0))


def test_names_are_in_one_line_unlike_and_without_control_characters(log, tmp_path):
    path = log(b'"a ""b""\n[mm]";x\x1b[31m; x ;x;x\n1;2;3;4;5\n1;2;3;4;6\n')
    names = ['a "b" [mm]', 'x\\x1b[31m', 'x', 'x_duplicated_0', 'x_duplicated_1']
    assert source_of(path).names() == names
    assert list(open_table(path, names).head(1)[names[-1]]) == [5.0]
    parquet = tmp_path / 'log.parquet'
    pl.DataFrame({'a\n\x07b': [1.0], 'a \x07b': [2.0]}).write_parquet(parquet)
    held = ['a \\x07b', 'a \\x07b_duplicated_0']
    assert source_of(parquet).names() == held
    assert list(open_table(parquet, held).head(1)[held[1]]) == [2.0]


def test_dates_and_times_of_a_sheet_are_those_of_the_calendar(log):
    day = np.datetime64('2026-01-02')
    times = [(day + np.timedelta64(row * 90_500, 'ms')).item() for row in range(3)]
    path = log(workbook([['Datum', 'Uhrzeit'], *([day.item(), one.time()] for one in times)]))
    found = open_table(path, ['Datum', 'Uhrzeit']).head(9)
    np.testing.assert_array_equal(found['Datum'], [day.astype('datetime64[s]').astype(int)] * 3)
    np.testing.assert_array_equal(found['Uhrzeit'], [0.0, 90.5, 181.0])


def test_a_missing_head_and_damage_are_sentences(log, refused):
    refused('short_sheet', source_of, log(workbook([['a'], [1.0]])), Layout(skip=2))
    refused('no_head', source_of, log(b'a;b\n1;2\n'), Layout(skip=2))
    refused('odd', source_of, log(b'\xff\xfea'))
    refused('no_book', source_of, log(workbook(ROWS)[:-30]))
    content = io.BytesIO()
    with zipfile.ZipFile(content, 'w') as archive:
        archive.writestr('a.txt', 'no sheet')
    refused('no_sheet', source_of, log(content.getvalue()))


def test_what_is_read_at_once_is_bounded(log, refused, monkeypatch):
    monkeypatch.setattr(limits, 'WORKBOOK', 1000)
    refused('wide_letters', source_of, log(csv_text().encode('utf-16') * 2))
    monkeypatch.setattr(limits, 'MEGA', 100)
    refused('packed', source_of, log(workbook(ROWS)))


def test_a_workbook_that_says_less_than_it_holds_is_refused(log, refused, monkeypatch):
    monkeypatch.setattr(limits, 'CHUNK', 100_000)
    monkeypatch.setattr(limits, 'PACKING', 2)
    content = io.BytesIO()
    with zipfile.ZipFile(content, 'w', zipfile.ZIP_DEFLATED) as archive:
        archive.writestr('xl/workbook.xml', ' ' * 1_000_000)
    lying = content.getvalue().replace(
        (1_000_000).to_bytes(4, 'little'), (9).to_bytes(4, 'little')
    )
    refused('packed', source_of, log(lying))


@pytest.mark.parametrize(
    ('text', 'key'),
    [
        ('a,b\n' + 2 * ('1,2' + 60 * ' ' + '\n'), None),
        ('a,b\n1,2' + 120 * ' ' + '\n', 'long'),
        ('a,b\n1,"' + 'x\n' * 40 + '"\n', None),
        ('a,b\n1,"' + 'x\n' * 80 + '"\n', 'long'),
        (','.join(f'c{number}' for number in range(7)) + '\n1\n', 'wide'),
    ],
    ids=['short', 'long', 'short quote', 'long quote', 'wide'],
)
def test_lines_and_columns_are_bounded(text, key, log, monkeypatch, refused):
    for name, most in {'MEGA': 10, 'LINE': 100, 'COLUMNS': 6}.items():
        monkeypatch.setattr(limits, name, most)
    path = log(text.encode())
    if key is None:
        assert source_of(path).names() == ['a', 'b']
    else:
        refused(key, source_of, path)


def test_a_small_parquet_file_of_many_cells_is_refused(tmp_path, refused, monkeypatch):
    path = tmp_path / 'log.parquet'
    pl.DataFrame({'a': np.zeros(100_000), 'b': np.zeros(100_000)}).write_parquet(path)
    monkeypatch.setattr(limits, 'PACKING', 1)
    monkeypatch.setattr(limits, 'WORKBOOK', 800_000)
    monkeypatch.setattr(limits, 'CHUNK', 0)
    assert open_table(path, ['a']).rows == 100_000
    refused('many_cells', open_table, path, ['a', 'b'])


def test_a_parquet_file_of_an_axis_at_rest_is_read(tmp_path, monkeypatch):
    """Columns that stay as they are take no room: what is read counts, not all that is there."""
    path, rest = tmp_path / 'log.parquet', np.zeros(100_000)
    names = [f'X_{number}' for number in range(99)]
    columns = {'t': np.arange(len(rest)) / 1000.0} | dict.fromkeys(names, rest)
    pl.DataFrame(columns).write_parquet(path)
    monkeypatch.setattr(limits, 'WORKBOOK', 0)
    assert 8 * len(rest) * len(columns) > limits.most_unpacked(path.stat().st_size)
    assert open_table(path, ['t', *names[:3]]).rows == len(rest)


@pytest.mark.parametrize('end', ['\n', '\r\n', '\r'])
@pytest.mark.parametrize('last', [True, False])
def test_parts_of_a_text_leave_no_trace(tmp_path, monkeypatch, end, last):
    lines = [
        '# of a mill',
        'a;b',
        '1;2',
        '"x;',
        'y";3',
        '',
        '4',
        '5;6',
        '# a note',
        ';8',
        '9;"10"',
    ]
    path = tmp_path / 'log.csv'
    path.write_bytes((end.join(lines) + end * last).encode())
    found = []
    for size in (1, 2, 7, 1000):
        monkeypatch.setattr(sources, 'PART', size)
        found.append(pl.concat(list(sources.source_of(path).blocks(['a', 'b']))).rows())
    whole = found[-1]
    assert found == [whole] * 4
    assert [row for row in whole if row[0]] == [
        ('1', '2'),
        ('x;' + end + 'y', '3'),
        ('5', '6'),
        ('9', '10'),
    ]
    assert whole[0] == ('1', '2')
    assert whole[-1] == ('9', '10')


LOG = 't,v\n' + ''.join(f'{row},{row % 7}.5\n' for row in range(40))
HEADS = {
    'csv': (LOG.encode(), True),
    'wide csv': (LOG.encode('utf-16'), True),
    'text': (b'twelve nuts, please\n' * 40, False),
    'records': (b'[' + b'{"t": 0.5, "v": "1.5"},' * 20, True),
    'lists': (b'{"v": [' + b'1, -2.5e3, ' * 20, True),
    'settings': (b'{"name": "mill", "version": "1.2.3", "axes": [1, 2, 3],', False),
    'trace': (b'<?xml version="1.0"?><t>' + b'<rec time="0.5" f1="1.5"/>' * 20, True),
    'page': (b'<!DOCTYPE html><html lang="en"><p>' + b'12 nuts' * 40, False),
    'matlab': (b'MATLAB 5.0 MAT-file'.ljust(128), True),
}


@pytest.mark.parametrize('kind', HEADS)
@pytest.mark.parametrize('packed', [False, True])
def test_the_begin_of_a_file_tells_whether_it_is_a_log(kind, packed, tmp_path, monkeypatch):
    """Of a text, a packed or a large file the rest is not read."""
    head, holds = HEADS[kind]
    path = tmp_path / 'log.rec'
    rest = bytes(range(1, 256)) * 9000  # which is neither, nor may it be packed much
    monkeypatch.setattr(foreign, 'read_signals', None)
    monkeypatch.setattr(limits, 'TEXT', 0)
    monkeypatch.setattr(limits, 'MEGA', max(len(head), 512) // 64 * 64)
    content = gzip.compress(head + rest)[:-2000] if packed else head + rest
    path.write_bytes(content)
    monkeypatch.setattr(codings, 'decoded', None)
    assert sources.is_log(path) is holds


PLACES = [[at * 1.5, at * 2] for at in range(40)]
SMALL = {
    'coefficients': (json.dumps({'name': 'cal', 'table': PLACES, 'limits': {'a': 1}}), False),
    'settings': (json.dumps({f'setting {at}': at for at in range(40)}), False),
    'tools': ('<tools>' + '<tool length="1.5"/>' * 40 + '</tools>', False),
    'trace': ('<trace>' + '<rec time="0.5" f1="1.5"/>' * 40 + '</trace>', True),
    'torn trace': (
        json.dumps(
            {
                'Header': {'SignalListHFData': [{'Name': 'Cycle'}]},
                'Payload': [{'HFData': [[1, 2]]}],
            }
        ),
        True,  # of a machine: its fault is worth a sentence
    ),
    'late': (
        json.dumps({'note': 'x' * limits.MEGA, 'samples': [{'t': t, 'v': v} for t, v in PLACES]}),
        True,
    ),
}


@pytest.mark.parametrize('name', SMALL)
def test_json_and_xml_are_logs_if_they_hold_signals(name, tmp_path):
    content, holds = SMALL[name]
    path = tmp_path / 'log.rec'
    path.write_text(content)
    assert sources.is_log(path) is holds


@pytest.mark.parametrize(
    'content',
    [b' \n', bytes(5000), gzip.compress(b''), gzip.compress(bytes(9))],
    ids=['blanks', 'zeros', 'packed nothing', 'packed zeros'],
)
def test_a_file_that_holds_nothing_is_told_so(content, tmp_path, refused):
    path = tmp_path / 'log.csv'
    path.write_bytes(content)
    refused('nothing', sources.source_of, path)
    assert not sources.is_log(path)


@pytest.mark.parametrize(
    ('coding', 'names'),
    [
        ('cp1250', ['czas [s]', 'położenie X [mm]', 'prędkość X [mm/s]', 'siła X [N]']),
        ('cp1250', ['čas [s]', 'poloha X [µm]', 'rychlost X [mm/s]', 'síla X [N]']),
        ('cp1252', ['Zeit [s]', 'Weg X [µm]', 'Öltemperatur [°C]', 'Kräfte [N]']),
    ],
)
def test_letters_of_one_byte_are_those_that_make_words_and_it_is_said(
    coding, names, tmp_path, says
):
    path = tmp_path / 'log.csv'
    rows = (f'{at / 10};{at % 7};{at % 5};{at % 3}' for at in range(60))
    path.write_bytes('\n'.join([';'.join(names), *rows]).encode(coding))
    source = sources.source_of(path)
    assert source.names() == names
    assert source.notes == (says('coding', path=path, coding=coding),)
    path.write_text('\n'.join([';'.join(names), '0;1;2;3', '1;2;3;4']), encoding='utf-8')
    assert sources.source_of(path).notes == ()


def torn_rows(names, end=''):
    """Return a table of Rockwell whose times of 20 ms are not quoted, for 60 rows."""
    rows = (f'09:00:0{at // 50};{20 * (at % 50):03d};{at}.5;7.25{end}' for at in range(60))
    return '\n'.join([';'.join(names), *rows])


def test_a_semicolon_before_milliseconds_parts_no_cells(tmp_path, says):
    path = tmp_path / 'log.csv'
    path.write_text(torn_rows(['Time', 'X position [mm]', 'X speed [mm/s]']))
    source = sources.source_of(path)
    rows = source.first_rows()
    assert rows['Time'].to_list() == [
        f'09:00:0{at // 50}:{20 * (at % 50):03d}' for at in range(60)
    ]
    assert rows['X position [mm]'].to_list() == [f'{at}.5' for at in range(60)]
    assert source.notes == (says('torn', path=path),)


@pytest.mark.parametrize('end', ['', ';'])
def test_milliseconds_in_a_column_of_their_own_are_cells(end, tmp_path):
    path = tmp_path / 'log.csv'
    path.write_text(torn_rows(['Time', 'Millitm', 'X position [mm]', 'X speed [mm/s]'], end))
    rows = sources.source_of(path).first_rows()
    assert rows['X position [mm]'].to_list() == [f'{at}.5' for at in range(60)]
    assert rows['X speed [mm/s]'][0] == '7.25'
