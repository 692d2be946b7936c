# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Rows of several sources in turn: refused whatever the column is called that tells them apart."""

from ballscrew_monitor.recordings.tables.guess import guess
from ballscrew_monitor.recordings.tables.mapping import make_map
from ballscrew_monitor.recordings.tables.series import read_series
import numpy as np
import openpyxl
import polars as pl
import pytest

TIME = np.arange(400) / 100.0
SPEED = 75.0 * np.sin(TIME)


def table(name, sources, *, apart=0.0):
    """Return rows of so many sources in turn, their times so far apart [s]."""
    parts = [
        pl.DataFrame(
            {
                't [s]': TIME + at * apart,
                name: [source] * len(TIME),
                'x velocity [mm/s]': SPEED / (at + 1),
                'x force [N]': 12.0 * SPEED / (at + 1),
            }
        ).with_row_index('row')
        for at, source in enumerate(sources)
    ]
    return pl.concat(parts).sort('row', maintain_order=True).drop('row')


@pytest.mark.parametrize('name', ['tag', 'host', 'part', 'Kanal', 'k'])
@pytest.mark.parametrize('sources', [('left', 'right'), ('1', '2'), ('a', 'b', 'c')])
@pytest.mark.parametrize('suffix', ['csv', 'parquet'])
def test_rows_of_one_time_are_of_several_sources(name, sources, suffix, tmp_path, refused):
    log = tmp_path / f'log.{suffix}'
    frame = table(name, sources)
    frame.write_csv(log) if suffix == 'csv' else frame.write_parquet(log)
    with refused('sources', column=repr(name), cells=', '.join(sources)):
        guess(log)


def test_texts_in_turn_are_of_several_sources(tmp_path, refused):
    log = tmp_path / 'log.csv'
    table('tag', ('left', 'right'), apart=0.005).write_csv(log)
    with refused('sources', column="'tag'", cells='left, right'):
        guess(log)


MORE = {
    'a state': np.where(SPEED > 0.0, 'out', 'back'),
    'a cycle': np.where(np.arange(400) % 100 < 50, '0', '1'),
    'a heartbeat': np.arange(400) % 2,
    'a number': np.arange(400),
    'a text': np.full(400, 'M1'),
    'nothing': np.full(400, ''),
}


@pytest.mark.parametrize('kind', MORE)
@pytest.mark.parametrize('step', [0.01, 1.0])
def test_other_columns_are_of_one_source(kind, step, tmp_path):
    columns = {'t [s]': np.floor(TIME / step + 1e-9) * step, 'tag': MORE[kind]}
    columns |= {'x velocity [mm/s]': SPEED, 'x force [N]': 12.0 * SPEED}
    log = tmp_path / 'log.csv'
    pl.DataFrame(columns).write_csv(log)
    assert guess(log).content['time'] == {'column': 't [s]', 'unit': 's'}


STATED = {'screw': 'nominal', 'oil': 'iso_vg_68', 'temperature_degC': 40.0, 'lead_mm': 10.0}


def map_of(axis, **more):
    """Return a map of the table above that states an axis."""
    inputs = {
        'speed': {'column': 'x velocity [mm/s]', 'unit': 'mm/s'},
        'load': {'column': 'x force [N]', 'unit': 'N'},
    }
    time = {'column': 't [s]', 'unit': 's', 'epoch': '2026-01-05T08:00:00Z'}
    return make_map({'time': time, 'axes': {axis: inputs | STATED}, **more})


@pytest.mark.parametrize('column', ['axis', 'Achse', 'device'])
@pytest.mark.parametrize('in_turn', [True, False])
def test_a_map_takes_no_rows_of_several_axes_for_those_of_one(column, in_turn, tmp_path, refused):
    log = tmp_path / 'log.csv'
    frame = table(column, ('X', 'Y'))
    (frame if in_turn else frame.sort(column, maintain_order=True)).write_csv(log)
    with refused('sources', column=repr(column), cells='X, Y'):
        read_series(log, map_of('x'))


@pytest.mark.parametrize('cell', ['Y', 'y', 'Y-Axis', 'Axis Y', 'Achse_Y'])
def test_a_map_states_no_other_axis_than_the_rows_do(cell, tmp_path, refused):
    log = tmp_path / 'log.csv'
    table('axis', (cell,)).write_csv(log)
    with refused('another_axis', what="column 'axis' says that its rows are"):
        read_series(log, map_of('x'))
    for axis in ('y', 'slide', 'y1'):  # of which a letter alone says nothing else
        assert read_series(log, map_of(axis)).count == len(TIME)


def test_a_map_states_no_other_axis_than_the_sheet_it_names(tmp_path, refused):
    log = tmp_path / 'log.xlsx'
    book = openpyxl.Workbook()
    for sheet in (book.active, book.create_sheet('Y')):
        frame = table('run', ('1',))
        for row in (frame.columns, *frame.rows()):
            sheet.append(row)
    book.save(log)
    with refused('another_axis', what="sheet 'Y' is"):
        read_series(log, map_of('x', sheet='Y'))
    assert read_series(log, map_of('y', sheet='Y')).rows == (len(TIME),)


@pytest.mark.parametrize(
    ('file', 'cell', 'axis'),
    [('log', 'Y', 'y'), ('log_z', '1', 'z'), ('Z axis 7', 'Y', 'y'), ('16x5_y_z', '1', 'x')],
)
def test_the_only_axis_has_the_name_that_its_column_or_file_says(file, cell, axis, tmp_path):
    log = tmp_path / f'{file}.csv'
    frame = table('axis', (cell,)).rename(lambda name: name.removeprefix('x '))
    frame.write_csv(log)
    assert [*guess(log).content['axes']] == [axis]
