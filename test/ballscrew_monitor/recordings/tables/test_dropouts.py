# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Dropouts of a signal: found where a channel fails, and never where a motion stops."""

from ballscrew_monitor.recordings.tables.dropouts import column_of, dropped
from ballscrew_monitor.recordings.tables.guess import guess
from ballscrew_monitor.recordings.tables.mapping import make_map
import numpy as np
import polars as pl
import pytest

TIME = np.arange(1200) / 100.0
CORNERS = [0.0, 0.5, 1.0, 5.0, 5.5, 6.0, 6.5, 11.0, 11.5, 12.0]
SPEED = np.interp(TIME, CORNERS, [0.0, 0.0, 75.0, 75.0, 0.0, 0.0, -40.0, -40.0, 0.0, 0.0])
FORCE = 12.0 * SPEED + 10.0 * np.sin(3.0 * TIME)
NOISE = np.random.default_rng(4).normal(0.0, 0.2, len(TIME))
LOST = (TIME >= 3.0) & (TIME < 3.5)


@pytest.mark.parametrize('value', [0.0, -1.0, -99.0, 12.5])
@pytest.mark.parametrize('noise', [0.0, 1.0])
@pytest.mark.parametrize('spans', [((3.0, 3.5),), ((2.0, 2.04),), ((2.0, 2.2), (7.0, 8.0))])
def test_a_value_between_two_jumps_is_lost(value, noise, spans):
    lost = np.zeros(len(TIME), bool)
    for begin, end in spans:
        lost |= (begin - 1e-6 < TIME) & (end - 1e-6 > TIME)
    speed = np.where(lost, value, SPEED + noise * NOISE)
    np.testing.assert_array_equal(dropped(speed), lost)


@pytest.mark.parametrize('value', [-1.0, 999.0, 0.0])
@pytest.mark.parametrize('rows', [3, 20, 60, 120])
@pytest.mark.parametrize('begin', [60, 200, 300, 700, 900])
def test_a_position_that_goes_on_while_it_is_lost_is_lost(value, rows, begin):
    place = 120.0 + np.cumsum(SPEED) / 100.0
    lost = np.zeros(len(TIME), bool)
    lost[slice(begin, begin + rows)] = True
    np.testing.assert_array_equal(dropped(np.where(lost, value, place)), lost)


@pytest.mark.parametrize('place', [0.0, -300.0, 1e4])
@pytest.mark.parametrize('at', [[30], [570], [575, 590]])
def test_a_position_that_is_set_at_rest_is_not_lost(place, at):
    values = 120.0 + np.cumsum(SPEED) / 100.0
    for number, begin in enumerate(at):
        values[begin:] += place * (1 + number) - values[begin]
    assert not dropped(values).any()


SQUARE = np.where(SPEED > 0.0, 75.0, np.where(SPEED < 0.0, -40.0, 0.0))
MOTIONS = {
    'with ramps': SPEED,
    'with noise': SPEED + NOISE,
    'in squares': SQUARE,
    'there and there again': np.abs(SQUARE),
    'in one step': np.where(LOST, 0.0, 75.0),
    'by its position': np.cumsum(SPEED) / 100.0,
    'in coarse steps': np.round(np.cumsum(SPEED) / 100.0, 1),
    'in few rows': SPEED[::50],
    'at rest': 0.0 * SPEED,
    'with an outlier of two rows': np.where((TIME > 3.0) & (TIME < 3.025), 0.0, SPEED),
    'with steps of its own': np.where((TIME > 7.0) & (TIME < 7.2), -30.0, np.sign(SPEED) * 50.0),
    'lost for most of it': np.where((TIME > 1.0) & (TIME < 4.9), 0.0, SPEED),
    'in two rows': SPEED[:2],
    'never known': SPEED * np.nan,
}


@pytest.mark.parametrize('motion', MOTIONS)
def test_a_motion_that_stops_is_not_lost(motion):
    assert not dropped(MOTIONS[motion]).any()


def test_values_that_are_not_known_part_no_dropout():
    rows = np.repeat(np.where(LOST, 0.0, SPEED), 2)
    rows[::2] = np.nan
    np.testing.assert_array_equal(dropped(rows)[1::2], LOST)


@pytest.mark.parametrize('name', ['Fault', 'link', 'Source', 'Sensor state', 'Confidence'])
@pytest.mark.parametrize('cells', [('1', '0'), ('down', 'up'), ('0.2', '1.0')])
def test_the_column_that_goes_with_a_dropout_is_asked_for(name, cells, tmp_path, says, refused):
    columns = {
        't [s]': TIME,
        'x velocity [mm/s]': np.where(LOST, 0.0, SPEED),
        'Program': np.where(TIME < 6.0, 'A', 'B'),
        name: np.where(LOST, *cells),
        'x force [N]': FORCE,
    }
    pl.DataFrame(columns).write_csv(tmp_path / 'log.csv')
    result = guess(tmp_path / 'log.csv')
    speed = result.content['axes']['x']['speed']
    assert speed['valid'] == {'column': name, 'cells': None}
    told = ', '.join(sorted(f'{float(cell):g}' if '.' in cell else cell for cell in cells))
    assert result.unstated == (says('dropout', column=name, cells=told),)
    with refused('dropout_cells', column=name):
        make_map(result.content)


@pytest.mark.parametrize(('kind', 'value'), [('speed', -99.0), ('load', 4000.0)])
def test_a_dropout_without_a_column_is_asked_for(kind, value, tmp_path, says, refused):
    columns = {'t_s': TIME, 'x_velocity_mm_s': SPEED, 'x_force_N': FORCE}
    name = {'speed': 'x_velocity_mm_s', 'load': 'x_force_N'}[kind]
    columns[name] = np.where(LOST, value, columns[name])
    pl.DataFrame(columns).write_csv(tmp_path / 'log.csv')
    result = guess(tmp_path / 'log.csv')
    assert result.content['axes']['x'][kind]['valid'] == {'column': None, 'cells': None}
    assert result.unstated == (says('bare_dropout', kind=kind, column=name, value=f'{value:g}'),)
    with refused('dropout_column', kind=kind):
        make_map(result.content)


def test_a_column_of_many_cells_tells_no_dropout():
    frame = pl.DataFrame({'count': np.arange(len(TIME)), 'ok': np.ones(len(TIME))})
    assert column_of(LOST, [frame]) == ('', [])
    assert column_of(LOST, [frame.with_columns(ok=pl.Series(~LOST))]) == ('ok', ['false', 'true'])
