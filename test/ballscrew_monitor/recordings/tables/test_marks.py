# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Columns that mark others: bad values are not known, backward ones get a minus."""

from ballscrew_monitor.recordings.tables.guess import guess
from ballscrew_monitor.recordings.tables.mapping import make_map
from ballscrew_monitor.recordings.tables.marks import backward_cells, valid_cells
from ballscrew_monitor.recordings.tables.series import read_series
import numpy as np
import polars as pl
import pytest

TIME = np.arange(300) / 50.0
SPEED = 100.0 * np.sin(TIME)
BAD = (TIME > 2.0) & (TIME < 2.5)


def read_by_guess(log, **places):
    content = guess(log).content
    for place, cells in places.items():
        content['axes']['x']['speed'][place]['cells'] = cells
    blocks = list(read_series(log, make_map(content)).blocks())
    names = blocks[0][0].columns
    return {name: np.concatenate([rows.columns[name] for (rows,) in blocks]) for name in names}


def speeds(log, **places):
    return read_by_guess(log, **places)['x.speed'] * 10.0 / (2 * np.pi)


@pytest.mark.parametrize(
    ('words', 'cells', 'valid'),
    [
        (['quality'], ['192', '216', '0', '64'], ['192', '216']),
        (['quality'], ['192.0', '0.0'], ['192.0']),
        (['x', 'velocity', 'quality'], ['Good', 'Bad', 'Uncertain'], ['Good']),
        (['valid'], ['0', '1'], ['1']),
        (['is', 'valid'], ['True', 'False'], ['True']),
        (['invalid'], ['0', '1'], ['0']),
        (['is', 'bad'], ['false', 'true'], ['false']),
        (['ok'], ['1'], ['1']),
        (['status', 'code'], ['0x00000000', '0x80000000'], ['0x00000000']),
        (['status', 'code'], ['x00000000', 'x80340000'], ['x00000000']),
        (['status', 'code'], ['16#00000000', '16#C0000000'], ['16#00000000']),
        (['status', 'code'], ['00000000', '80000000'], ['00000000']),
        (['status', 'code'], ['0', '2147483648', '1073741824'], ['0']),
        (['status', 'code'], ['0', '-2147483648'], ['0']),
        (['quality'], ['0', '1'], None),
        (['quality'], ['1', '2', '3'], None),
        (['valid'], ['0'], None),
        (['quality'], ['Bad'], None),
        (['x', 'velocity', 'q'], ['192', '24'], ['192']),
        (['signal', 'ok'], ['yes', 'no'], ['yes']),
        (['missing'], ['0', '1'], ['0']),
        (['stale'], ['false', 'true'], ['false']),
        (['x', 'velocity', 'error'], ['0', '1'], None),
        (['x', 'velocity', 'flag'], ['0', '1'], None),
        (['overload'], ['0', '1'], None),
        (['error'], ['0'], ['0']),
        (['x', 'error'], ['0.001', '0', '-0.002'], []),
        (['status'], ['0', '1', '2'], []),
        (['axis', 'status'], ['567', '1591', '0'], []),
        (['state'], ['RUN', 'IDLE'], []),
        (['quality'], [str(at) for at in range(60)], []),
    ],
)
def test_qualities_are_those_of_their_standard_or_unclear(words, cells, valid):
    assert valid_cells(words, cells) == valid


@pytest.mark.parametrize(
    ('words', 'cells', 'back'),
    [
        (['direction'], ['-1', '0', '1'], ['-1']),
        (['x', 'dir'], ['+', '-'], ['-']),
        (['direction'], ['forward', 'backward', 'stop'], ['backward']),
        (['moving', 'backward'], ['0', '1'], ['1']),
        (['forward'], ['True', 'False'], ['False']),
        (['reverse'], ['0'], []),
        (['dir'], ['CW', 'CCW'], None),
        (['direction'], ['0', '1'], None),
        (['direction'], ['1', '2'], None),
        (['richtung'], ['links', 'rechts'], None),
        (['ccw'], ['0', '1'], None),
        (['bewegung'], ['vor', 'zurück', 'steht'], ['zurück']),
        (['phase'], ['rest', 'advance', 'retract'], ['retract']),
        (['stroke'], ['extend', 'return'], ['return']),
        (['return', 'stroke'], ['0', '1'], ['1']),
        (['x', 'moving', 'negative'], ['false', 'true'], ['true']),
        (['move'], ['up', 'down'], None),
        (['sense'], ['>', '<'], None),
        (['gear'], ['F', 'R', 'N'], None),
        (['gear'], ['3'], []),
        (['phase'], ['load', 'clamp', 'mill', 'unload'], []),
        (['phase'], [str(at) for at in range(9)], []),
    ],
)
def test_directions_are_plain_or_unclear(words, cells, back):
    assert backward_cells(words, cells) == back


HEADS = {
    'of all': ({'valid': np.where(BAD, '0', '1')}, ('x.speed', 'x.load')),
    'of the speed': ({'X velocity quality': np.where(BAD, '24', '192')}, ('x.speed',)),
    'of the axis': ({'X ok': np.where(BAD, 'false', 'true')}, ('x.speed', 'x.load')),
    'of a signal': ({'Signal ok': np.where(BAD, 'no', 'yes')}, ('x.speed', 'x.load')),
    'by a letter': ({'x_velocity_q': np.where(BAD, '24', '192')}, ('x.speed',)),
    'of what is missing': ({'missing': np.where(BAD, '1', '0')}, ('x.speed', 'x.load')),
    'of a small error': ({'X velocity error': np.where(BAD, '0.01', '0')}, ()),
    'of another axis': ({'Y velocity quality': np.where(BAD, '0', '192')}, ()),
    'of a machine': ({'Machine status': np.where(BAD, '1', '2')}, ()),
}


@pytest.mark.parametrize('kind', HEADS)
@pytest.mark.parametrize('suffix', ['csv', 'parquet'])
def test_bad_values_are_not_known(kind, suffix, tmp_path):
    more, marked = HEADS[kind]
    lost = {name: BAD if name in marked else np.zeros(300, bool) for name in ('x.speed', 'x.load')}
    columns = {'Time [s]': TIME, 'X velocity [mm/s]': np.where(lost['x.speed'], 0.0, SPEED)}
    columns |= {'X force [N]': np.where(lost['x.load'], -5.0, 9.0 * SPEED), **more}
    log = tmp_path / f'log.{suffix}'
    frame = pl.DataFrame(columns)
    frame.write_csv(log) if suffix == 'csv' else frame.write_parquet(log)
    found = read_by_guess(log)
    for name, expected in lost.items():
        np.testing.assert_array_equal(np.isnan(found[name]), expected)


def test_qualities_of_one_name_stand_behind_their_columns_or_are_asked_for(tmp_path, refused):
    log = tmp_path / 'log.csv'
    pairs = zip(TIME, SPEED, np.where(BAD, 'Bad', 'Good'), strict=True)
    rows = [(f'{t:.2f}', f'{v:.4f}', quality, f'{9 * v:.4f}') for t, v, quality in pairs]
    lines = [','.join([*row, 'Good']) for row in rows]
    head = 'Time [s],X velocity [mm/s],Quality,X force [N],Quality'
    log.write_text('\n'.join([head, *lines, '']))
    found = read_by_guess(log)
    np.testing.assert_array_equal(np.isnan(found['x.speed']), BAD)
    assert not np.isnan(found['x.load']).any()
    lines = [','.join([t, quality, v, 'Good', f]) for t, v, quality, f in rows]
    head = 'Time [s],Quality,X velocity [mm/s],Quality,X force [N]'
    log.write_text('\n'.join([head, *lines, '']))
    refused('unclear_cells', make_map, guess(log).content)


@pytest.mark.parametrize(
    ('name', 'cells', 'clear'),
    [
        ('x direction', np.sign(SPEED).astype(int).astype(str), True),
        ('Direction', np.where(SPEED < 0.0, 'backward', 'forward'), True),
        ('moving backward', np.where(SPEED < 0.0, '1', '0'), True),
        ('dir', np.where(SPEED < 0.0, 'CCW', 'CW'), False),
        ('Bewegung', np.where(SPEED < 0.0, 'zurück', 'vor'), True),
        ('x moving negative', np.where(SPEED < 0.0, 'true', 'false'), True),
    ],
)
@pytest.mark.parametrize('amounts', [True, False])
def test_a_direction_is_the_sign_of_an_amount_of_speed(
    name, cells, clear, amounts, tmp_path, refused, says
):
    log = tmp_path / 'log.csv'
    speed = np.round(np.abs(SPEED) if amounts else SPEED, 4)
    frame = {'t [s]': TIME, 'x velocity [mm/s]': speed, name: cells, 'x force [N]': 9 * SPEED}
    pl.DataFrame(frame).write_csv(log)
    if clear or not amounts:
        is_used = any(f'is backward where {name} is' in note for note in guess(log).notes)
        assert is_used == amounts
        np.testing.assert_allclose(speeds(log), SPEED, atol=1e-3)
        return
    made = guess(log)
    assert made.unstated[0] == says('state_cells')
    refused('unclear_way', make_map, made.content)
    np.testing.assert_allclose(speeds(log, backward=['CCW']), SPEED, atol=1e-3)
    np.testing.assert_allclose(speeds(log, backward='CW'), -SPEED, atol=1e-3)


def test_no_quantity_is_a_mark_of_another(tmp_path):
    log = tmp_path / 'log.csv'
    frame = {'t [s]': TIME, 'x position [mm]': 100 * (1 - np.cos(TIME)), 'x velocity ok': 1}
    pl.DataFrame(frame).write_csv(log)
    assert 'speed' not in guess(log).content['axes']['x']
