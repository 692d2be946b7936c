# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Cells of workbooks that another writer made: errors, per cents and texts are what they were."""

import re
import zipfile

from ballscrew_monitor.recordings.tables import cell_kinds
from ballscrew_monitor.recordings.tables.read import open_table
from ballscrew_monitor.recordings.tables.sources import source_of
import openpyxl
from openpyxl.styles import Font
import pytest

pytestmark = pytest.mark.usefixtures('in_this_process')
ERRORS = ['#N/A', '#VALUE!', '#DIV/0!', '#REF!', '#NAME?', '#NUM!', '#NULL!']
COUNT = 20


@pytest.fixture
def sheet(tmp_path):
    """Return a function that writes rows of a sheet, whose first cell is that of a place."""

    def write(columns, *, formats=None, place=(1, 1), before=()):
        book = openpyxl.Workbook()
        for name in before:
            book.create_sheet(name, 0).append(['notes'])
        cells = book.worksheets[-1]
        cells['A1'].font = cells.cell(90, 90).font = Font(bold=True)  # no value, so no cell
        for at, (name, values) in enumerate(columns.items()):
            for row, value in enumerate([name, *values]):
                cell = cells.cell(place[0] + row, place[1] + at, value)
                if row:
                    cell.number_format = (formats or {}).get(name, 'General')
        path = tmp_path / 'log.xlsx'
        book.save(path)
        return path

    return write


def columns_of(values):
    return {'t': [row / 8 for row in range(COUNT)], 'v': values, 'n': [7.5] * COUNT}


@pytest.mark.parametrize('error', ERRORS)
@pytest.mark.parametrize('place', [(1, 1), (4, 3)])
def test_an_error_is_unknown_and_an_empty_cell_is_no_sample(error, place, sheet):
    values = [None if row == 5 else error if row % 4 == 1 else row + 0.5 for row in range(COUNT)]
    values[5] = None
    log = sheet(columns_of(values), place=place, before=['A', 'B & "C"'])
    table = open_table(log, ['t', 'v'])
    assert table.readings['v'].holes[0] == 1
    (note,) = table.notes
    assert f"holds 4 cells without a number, the first is '{error}' in row " in note
    known = [row + 0.5 for row in range(COUNT) if row % 4 != 1]
    assert [one for one in table.head(99)['v'].tolist() if one == one] == known


@pytest.mark.parametrize(
    ('form', 'is_share'),
    [
        ('0%', True),
        ('0.00%', True),
        ('0.0%', True),
        ('[Red]-0.0%', True),
        ('#,##0.0 %', True),
        ('0.0"%"', False),
        ('0.0\\%', False),
        ('0.00', False),
        ('General', False),
    ],
)
def test_a_share_is_what_is_shown(form, is_share, sheet):
    shares = [0.01 * row - 0.07 for row in range(COUNT)]
    log = sheet(columns_of(shares), formats={'v': form})
    name = 'v [%]' if is_share else 'v'
    scale = 100.0 if is_share else 1.0
    assert source_of(log).names() == ['t', name, 'n']
    found = open_table(log, ['t', name]).head(99)[name]
    assert found.tolist() == pytest.approx([scale * share for share in shares], abs=1e-12)


def test_a_share_under_another_unit_is_refused(sheet, refused):
    log = sheet({'t [s]': [0.5, 1.0], 'x force [N]': [0.5, 0.25]}, formats={'x force [N]': '0%'})
    refused('other_unit', open_table, log, ['x force [N]'])


def test_a_sheet_whose_cells_are_counted_otherwise_is_refused(sheet, refused, monkeypatch):
    log = sheet(columns_of(['#N/A'] * COUNT))
    counted = cell_kinds._cells
    monkeypatch.setattr(
        cell_kinds, '_cells', lambda text: ((row, 1, *others) for row, _, *others in counted(text))
    )
    refused('counted', source_of, log)


@pytest.mark.parametrize(('text', 'is_number'), [('5.400', True), ('slow', False)])
def test_texts_that_a_workbook_shares_are_looked_at(text, is_number, sheet, tmp_path, refused):
    """Spreadsheets write texts once and refer to them, openpyxl here writes them in the cells."""
    log, shared = sheet({'t': [0.125, 0.25, 0.375], 'v': [text, 5, 6]}), tmp_path / 'shared.xlsx'
    with zipfile.ZipFile(log) as old, zipfile.ZipFile(shared, 'w') as new:
        strings: list[str] = []

        def refer(match: re.Match[str]) -> str:
            strings.append(match[1])
            return f't="s"><v>{len(strings) - 1}</v>'

        for name in old.namelist():
            content = old.read(name).decode()
            if name == 'xl/worksheets/sheet1.xml':
                content = re.sub(r't="inlineStr"><is><t>(.*?)</t></is>', refer, content)
                assert len(strings) == 3
            kind = 'officedocument.spreadsheetml.sharedStrings+xml'
            content = content.replace(
                '</Types>',
                '<Override PartName="/xl/sharedStrings.xml" '
                f'ContentType="application/vnd.openxmlformats-{kind}"/></Types>',
            )
            new.writestr(name, content)
        rows = ''.join(f'<si><t>{one}</t></si>' for one in strings)
        space = 'http://schemas.openxmlformats.org/spreadsheetml/2006/main'
        new.writestr('xl/sharedStrings.xml', f'<sst xmlns="{space}">{rows}</sst>')
    if is_number:
        refused('shared', open_table, shared, ['t', 'v'])
    else:
        assert open_table(shared, ['t', 'v']).head(9)['v'].tolist()[1:] == [5.0, 6.0]
    assert open_table(shared, ['t']).head(9)['t'].tolist() == [0.125, 0.25, 0.375]
