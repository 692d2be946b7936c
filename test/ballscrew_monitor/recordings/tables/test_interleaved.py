# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Rows of several sources in turn: refused whatever the column is called that tells them apart."""

from ballscrew_monitor.recordings.tables.guess import guess
import numpy as np
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
