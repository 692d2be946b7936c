# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""A workbook is refused before it is read if its cells come to too much, however they are told."""

import datetime as dt
import io
import json
import re
import sys
import types
import zipfile

from ballscrew_monitor import cli
from ballscrew_monitor.recordings.tables import apart, workbook
from ballscrew_monitor.recordings.tables.guess import guess
from ballscrew_monitor.recordings.tables.mapping import make_map
from ballscrew_monitor.recordings.tables.series import read_series
from ballscrew_monitor.recordings.tables.workbook import read_sheet, write_cells
import openpyxl
from openpyxl.utils.datetime import CALENDAR_MAC_1904, CALENDAR_WINDOWS_1900, to_excel
import polars as pl
import pytest
from surrogate.files import limits
from surrogate.tasks.child import result_apart

pytestmark = pytest.mark.usefixtures('in_this_process')
ROWS = [('t', 'v'), ('0', '3'), ('0.1', '4'), ('0.2', '5')]
FAR = '<row r="1048576"><c r="Z1048576"><v>1</v></c></row>'
FORMS = {
    'as usual': lambda text: text,
    'no references': lambda text: re.sub(r' r="\w+"', '', text),
    'blanks': lambda text: re.sub(r' r="(\w+)"', r" r = '\1'", text),
    'another order': lambda text: re.sub(r'<c r="(\w+)" t="n"', r'<c t="n" r="\1"', text),
    'small letters': lambda text: re.sub(r'r="([A-Z])(\d)', lambda m: m[0].lower(), text),
    'prefix': lambda text: re.sub('<(/?)([a-z])', r'<\1x:\2', text, flags=re.I).replace(
        'xmlns=', 'xmlns:x='
    ),
    'rows upside down': lambda text: re.sub('(<row r="3".*?</row>)(<row.*?</row>)', r'\2\1', text),
}


@pytest.fixture
def book(tmp_path):
    """Return the function that writes a workbook whose sheet is changed as a text."""

    def write(change=lambda text: text, left_out=()):
        made, content = openpyxl.Workbook(), io.BytesIO()
        for row in [ROWS[0], *([float(cell) for cell in row] for row in ROWS[1:])]:
            made.active.append(row)
        made.save(content)
        path = tmp_path / 'log.xlsx'
        with zipfile.ZipFile(content) as held, zipfile.ZipFile(path, 'w') as archive:
            for name in {*held.namelist()} - {*left_out}:
                part = held.read(name)
                if name.endswith('sheet1.xml'):
                    part = change(part.decode()).encode()
                archive.writestr(name, part)
        return path

    return write


@pytest.fixture
def unread(monkeypatch):
    """Let nothing read a workbook."""
    monkeypatch.setitem(sys.modules, 'fastexcel', types.SimpleNamespace())


def with_row(row):
    return lambda text: re.sub(r'</(\w+:)?sheetData>', row + r'\g<0>', text)


@pytest.mark.parametrize('form', FORMS)
def test_cells_are_the_same_however_they_are_told(form, book):
    assert read_sheet(book(FORMS[form])).cells.rows() == ROWS


@pytest.mark.parametrize('form', FORMS)
def test_a_cell_far_off_is_refused_before_anything_is_read(form, book, unread, refused):
    refused('far_off', read_sheet, book(lambda text: with_row(FAR)(FORMS[form](text))))


@pytest.mark.parametrize(
    'row',
    [
        '<row r="4000000000"><c r="ZZZZZZ4000000000"><v>1</v></c></row>',
        '<row r="9"><c r="A4000000000"><v>1</v></c><c r="A9"><v>1</v></c></row>',
        '<row r="4000000000"><c><v>1</v></c></row>',
        '<row><c r="ALL9"/><c t="inlineStr"><is><t>x</t></is></c></row><row r="9999999"/>' + FAR,
        f'<row><c r="A9" s="{"x" * 3000}"><v>1</v></c></row>{FAR}',
    ],
)
def test_no_reference_hides_behind_others(row, book, unread, refused):
    refused('far_off_anywhere', read_sheet, book(with_row(row)))


@pytest.mark.parametrize('size', [1, 7, 64])
def test_a_reference_may_lie_across_blocks(size, book, unread, refused, monkeypatch):
    path = book(with_row(FAR))
    monkeypatch.setattr(limits, 'most_unpacked', lambda packed: 10**9)
    monkeypatch.setattr(limits, 'WORKBOOK', 10**9)
    monkeypatch.setattr(limits, 'MEGA', size)
    refused('far_off_anywhere', read_sheet, path)


@pytest.mark.parametrize(
    'row',
    [
        '<row r="1048576"><c r="XFD1048576" s="1"/></row>',
        '<row r="1048576"><c r="XFD1048576"><v></v>\n</c></row>',
        '<row r="1048576"><c r="XFD1048576"><f>A1</f></c></row>',
        '<row r="1048576" ht="12.8"/>',
    ],
    ids=['format', 'no value', 'formula', 'row'],
)
def test_cells_without_a_value_are_none(row, book):
    assert read_sheet(book(with_row(row))).cells.rows() == ROWS


@pytest.mark.parametrize(
    ('key', 'change'),
    [
        ('doctype', lambda text: f'<!DOCTYPE worksheet>{FORMS["blanks"](text)}'),
        ('cell', with_row('<row><c r="9A"><v>1</v></c></row>')),
        ('row', with_row('<row r="x"><c><v>1</v></c></row>')),
        ('ill_formed', with_row('<row><c t="n"><v>1</v></d></row>')),
        ('long_tag', with_row(f'<row><c r="A1" s="{"x" * 5000}"><v>1</v></c></row>')),
    ],
)
def test_a_sheet_that_is_none_is_refused(key, change, book, unread, refused, monkeypatch):
    path = book(change)
    monkeypatch.setattr(limits, 'most_unpacked', lambda packed: 10**9)
    monkeypatch.setattr(limits, 'LINE', 4000)
    monkeypatch.setattr(limits, 'MEGA', 1000)
    refused(key, read_sheet, path)


def test_a_workbook_without_a_sheet_is_refused(book, unread, refused):
    refused('no_part', read_sheet, book(left_out=['xl/worksheets/sheet1.xml']))


def test_a_workbook_that_lists_no_sheet_is_refused(book, refused):
    refused('no_list', read_sheet, book(left_out=['xl/workbook.xml']))


class Panic(BaseException):
    """As a reader raises it that is not written in Python."""


def test_a_panic_of_the_reader_is_a_sentence_and_an_interrupt_is_none(
    book, tmp_path, refused, monkeypatch
):
    raised = []

    def read(*arguments, **named):
        raise raised.pop()

    monkeypatch.setattr(pl, 'read_excel', read)
    inputs = {'path': str(book()), 'target': str(tmp_path / 'cells'), 'sheet': ''}
    for error in (Panic('capacity overflow'), IndexError('capacity overflow')):
        raised.append(error)
        refused('panic', write_cells, inputs)
    for error in (KeyboardInterrupt(), SystemExit(3), GeneratorExit()):
        raised.append(error)
        with pytest.raises(type(error)):
            write_cells(inputs)


def test_a_reader_that_needs_too_much_memory_is_a_sentence(book, refused, monkeypatch):
    monkeypatch.setattr(apart, 'result_apart', result_apart)
    monkeypatch.setattr(limits, 'MEMORY', 1000)
    refused('memory', read_sheet, book())


def test_a_workbook_is_read_once_as_long_as_it_is_the_same(book, monkeypatch):
    path = book()
    cells = read_sheet(path).cells
    monkeypatch.setattr(apart, 'result_apart', None)
    assert read_sheet(path).cells is cells


def test_what_a_cell_comes_to_is_that_of_the_whole_sheet(book, monkeypatch, refused):
    path = book()
    size = len(zipfile.ZipFile(path).read('xl/worksheets/sheet1.xml'))
    monkeypatch.setattr(limits, 'CHUNK', 0)
    monkeypatch.setattr(limits, 'SPARSE', 0)
    monkeypatch.setattr(limits, 'PACKING', 100)
    monkeypatch.setattr(workbook, 'CELL_SIZE', 10 * size // 8)
    assert read_sheet(path).cells.rows() == ROWS
    monkeypatch.setattr(workbook, 'CELL_SIZE', 10 * size // 8 + 1)
    refused('eight_cells', read_sheet, path)


@pytest.fixture
def books(tmp_path):
    """Return the function that writes a workbook of several sheets, rows by their names."""

    def write(sheets):
        made, path = openpyxl.Workbook(), tmp_path / 'log.xlsx'
        made.remove(made.active)
        for name, rows in sheets.items():
            sheet = made.create_sheet(name)
            for row in rows:
                sheet.append(row)
        made.save(path)
        return path

    return write


INFO = [('Maschine', 'DMU'), ('Takt', 20), ('Nummer', 7), ('Jahr', 2025)]
DATA = [('t_s', 'x_vel_mm_s', 'x_force_N'), *((at / 50, at % 9, -at) for at in range(60))]
OTHER = [('t_s', 'x_vel_mm_s', 'x_force_N'), *((at / 10, at % 7, -at) for at in range(60))]


def test_the_sheet_with_a_table_is_read_and_the_others_are_named(books, says):
    path = books({'Info': INFO, 'Daten': DATA, 'Leer': []})
    made = guess(path)
    assert made.content['sheet'] == 'Daten'
    assert says('other_sheets') in made.notes
    assert read_series(path, make_map(made.content)).count == 60
    assert 'sheet' not in guess(books({'Daten': DATA})).content


def test_a_map_names_the_sheet(books, refused):
    path = books({'Info': INFO, 'Daten': DATA, 'Later': OTHER})
    content = guess(path).content
    assert content['sheet'] == 'Daten'
    for name, period in (('Daten', 0.02), ('Later', 0.1)):
        series = read_series(path, make_map(content | {'sheet': name}))
        assert series.usual_period == pytest.approx(period)
    refused('no_such_sheet', read_series, path, make_map(content | {'sheet': 'Messung'}))
    refused('sheet_number', make_map, content | {'sheet': 2})


def test_a_replay_says_which_sheets_it_has_not_read(books, says, tmp_path, capsys):
    path = books({'Info': INFO, 'Daten': DATA, 'Later': OTHER})
    for stated, others in (
        ({}, {'Info': 'info', 'Later': 'later'}),
        ({'sheet': 'Later'}, {'Info': 'by_map', 'Daten': 'by_map'}),
    ):
        content = {key: one for key, one in guess(path).content.items() if key != 'sheet'}
        expected = {name: says(key) for name, key in others.items()}
        series = read_series(path, make_map(content | stated))
        assert series.unread == expected
        assert all(f'{name}, as {why}' in series.notes[0] for name, why in expected.items())
    mapping, out = tmp_path / 'map.yaml', tmp_path / 'out'
    mapping.write_text(guess(path).text)
    cli.main(['replay', str(path), '--map', str(mapping), '--json'])
    printed = capsys.readouterr()
    assert set(json.loads(printed.out)['x']['unread_parts']) == {'Info', 'Later'}
    assert says('unread') in printed.err
    cli.main(['replay', str(path), '--map', str(mapping), '--out', str(out)])
    assert says('unread') in (out / 'report.html').read_text()


def test_sheets_without_numbers_are_named(books, refused):
    refused('no_numbers', guess, books({'Info': [('Maschine', 'DMU')], 'Text': [('a', 'b')]}))


def book_of(path, sheets, hidden=()):
    """Write a workbook of sheets, each its name, names of columns and number of rows."""
    made = openpyxl.Workbook()
    made.remove(made.active)
    for name, names, rows in sheets:
        sheet = made.create_sheet(name)
        sheet.append(names)
        for row in range(rows):
            sheet.append([0.1 * row, *[3.0 * row] * (len(names) - 1)])
        for row in hidden:
            sheet.row_dimensions[row].hidden = True
    made.save(path)
    return path


@pytest.mark.parametrize(
    ('names', 'more'),
    [
        (['t [s]', 'x velocity [mm/s]'], 60),
        (['x velocity [mm/s]', 't [s]', 'remark'], 60),
        (['tool', 'radius [mm]'], 0),
    ],
)
def test_a_sheet_of_the_same_names_counts_as_rows_that_there_should_be(tmp_path, names, more):
    first = ['t [s]', 'x velocity [mm/s]']
    sheets = [('Data', first, 100), ('Continued', names, 60)]
    sheet = read_sheet(book_of(tmp_path / 'log.xlsx', sheets))
    assert (sheet.name, sheet.more_rows, sheet.hidden) == ('Data', more, 0)
    series = read_series(tmp_path / 'log.xlsx', make_map(guess(tmp_path / 'log.xlsx').content))
    assert (series.count, series.rows) == (100, (100 + more,))


@pytest.mark.parametrize(('first', 'second', 'more'), [('X', 'Y', 0), ('X axis', 'X 2', 60)])
def test_the_sheet_of_another_axis_holds_no_rows_of_this_one(tmp_path, first, second, more):
    names = ['t [s]', 'velocity [mm/s]']
    sheets = [(first, names, 100), (second, names, 60)]
    assert read_sheet(book_of(tmp_path / 'log.xlsx', sheets)).more_rows == more
    assert [*guess(tmp_path / 'log.xlsx').content['axes']] == ['x']


def test_hidden_rows_of_a_workbook_are_read_and_counted_in_a_sentence(tmp_path):
    names = ['t [s]', 'x velocity [mm/s]']
    path = book_of(tmp_path / 'log.xlsx', [('Data', names, 100)], hidden=range(20, 50))
    series = read_series(path, make_map(guess(path).content))
    assert series.count == 100
    assert any('30 rows of its sheets are hidden' in note for note in series.notes)


@pytest.mark.parametrize('as_cells', [lambda moment, epoch: moment, to_excel])
@pytest.mark.parametrize('epoch', [CALENDAR_WINDOWS_1900, CALENDAR_MAC_1904])
def test_days_of_a_workbook_count_from_its_epoch(as_cells, epoch, tmp_path, says):
    made, path = openpyxl.Workbook(), tmp_path / 'log.xlsx'
    made.epoch, begin = epoch, dt.datetime(2025, 7, 14, 11, 59, 50, tzinfo=dt.UTC)
    made.active.append(['time', 'x velocity [mm/s]'])
    for row in range(60):
        moment = begin.replace(tzinfo=None) + dt.timedelta(seconds=row)
        made.active.append([as_cells(moment, epoch), row])
    made.save(path)
    series = read_series(path, make_map(guess(path).content))
    assert series.begin / 1e9 == pytest.approx(begin.timestamp(), abs=1e-3)
    assert series.usual_period == pytest.approx(1.0, abs=1e-3)
    corrected = as_cells is to_excel and epoch == CALENDAR_MAC_1904
    assert (says('from_1904', path=path) in series.notes) == corrected


def test_a_time_of_day_in_a_workbook_from_1904_has_no_day(tmp_path):
    made, path = openpyxl.Workbook(), tmp_path / 'log.xlsx'
    made.epoch = CALENDAR_MAC_1904
    for row in range(30):
        made.active.append([dt.time(12, 0, row), 1.0, 2.0])
    made.save(path)
    assert read_sheet(path).cells.row(29)[0] == '12:00:29'


@pytest.mark.parametrize('form', ['hh:mm:ss', '[h]:mm:ss.000'])
@pytest.mark.parametrize('hours', [23, 71, 130])
@pytest.mark.parametrize('epoch', [CALENDAR_WINDOWS_1900, CALENDAR_MAC_1904])
def test_hours_of_a_workbook_go_on_through_midnight(epoch, hours, form, tmp_path):
    """A spreadsheet adds times of a day to more than one day, and shows its hours or all."""
    made, path = openpyxl.Workbook(), tmp_path / 'log.xlsx'
    made.epoch = epoch
    made.active.append(['time', 'x velocity [mm/s]'])
    for row in range(60):
        made.active.append([(hours + (3570 + row) / 3600) / 24, row])
        made.active.cell(row=row + 2, column=1).number_format = form
    made.save(path)
    series = read_series(path, make_map(guess(path).content))
    assert series.count == 60
    assert (series.end - series.begin) / 1e9 == pytest.approx(59.0, abs=0.01)
    assert not any('without' in note for note in series.notes)
