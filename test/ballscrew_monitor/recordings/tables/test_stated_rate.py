# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Rows at a rate that a map states, in files that say otherwise.

Lines of LinuxCNC halsampler begin with the number of the sample where `-t` asks for it, and tell
of lost samples by a line `overrun`, behind which the numbers go on with those that were lost.

"""

import datetime as dt
import math

from ballscrew_monitor.recordings.tables.guess import guess
from ballscrew_monitor.recordings.tables.mapping import make_map
from ballscrew_monitor.recordings.tables.series import read_series
import numpy as np
import polars as pl
import pytest

RATE, COUNT = 100.0, 400
TIME = np.arange(COUNT) / RATE
SPEED = 90.0 * np.sin(math.tau * TIME / 4.0)
EPOCH = '2026-01-05T08:00:00Z'


def sampler(path, *, numbers, lost=0, overrun=False, at=150):
    """Write speeds as a sampler does, of which some are lost before the row `at`."""
    kept = [one for one in range(COUNT) if not at <= one < at + lost]
    lines = [f'{one} ' * numbers + f'{SPEED[one]:.6f} 1.700000 ' for one in kept]
    if overrun:
        lines.insert(at, 'overrun')
    path.write_text('\n'.join(lines) + '\n')
    return path


def by_rate(place, **time):
    axis = {'lead_mm': 10.0, 'speed': {'column': f'column {place}', 'unit': 'mm/s'}}
    return make_map({'time': {'epoch': EPOCH} | (time or {'rate_Hz': RATE}), 'axes': {'x': axis}})


@pytest.mark.parametrize('overrun', [False, True])
def test_samples_that_a_counter_shows_to_be_lost_are_not_closed_up(overrun, tmp_path, refused):
    path = sampler(tmp_path / 'log.txt', numbers=True, lost=50, overrun=overrun)
    with refused('lost', before='149', after='200', row=152 if overrun else 151):
        read_series(path, by_rate(2))
    series = read_series(path, by_rate(2, column='column 1', unit='s', scale=1.0 / RATE))
    (rows,) = next(series.blocks())
    times = (rows.stamps - rows.stamps[0]) / 1e9
    np.testing.assert_allclose(times[149:151], [1.49, 2.0], atol=1e-9)
    np.testing.assert_allclose(
        rows.columns['x.speed'], np.interp(times, TIME, SPEED) * math.tau / 10.0, atol=1e-4
    )


def counted(path, numbers):
    """Write speeds at 100 Hz behind the numbers of their samples."""
    lines = [
        f'{number} {90.0 * math.sin(math.tau * at / 400.0):.6f}'
        for at, number in enumerate(numbers)
    ]
    path.write_text('\n'.join([*lines, '']))
    return path


@pytest.mark.parametrize(
    ('least', 'largest', 'begin'),
    [(0, 255, 0), (0, 255, 250), (0, 65535, 65136), (-128, 127, 0), (1, 100, 1), (0, 999, 0)],
)
def test_a_counter_of_samples_that_begins_again_closes_up_nothing(least, largest, begin, tmp_path):
    """At a power of two, or several times at the same number."""
    size = largest - least + 1
    numbers = [least + (begin - least + at) % size for at in range(2500)]
    assert read_series(counted(tmp_path / 'log.txt', numbers), by_rate(2)).count == 2500


@pytest.mark.parametrize(
    ('largest', 'lost', 'before', 'after'),
    [
        (255, slice(300, 340), 43, 84),
        (255, slice(500, 520), 243, 8),
        (255, slice(511, 512), 254, 0),
        (899, slice(0, 0), 899, 0),
        (2**20, slice(700, 800), 699, 800),
    ],
)
def test_a_counter_that_begins_again_still_shows_what_is_lost(
    largest, lost, before, after, tmp_path, refused
):
    """So does one that does so once, at no power of two, as it does where a run begins."""
    numbers = [at % (largest + 1) for at in range(1600)]
    del numbers[lost]
    path = counted(tmp_path / 'log.txt', numbers)
    row = (lost.start or largest + 1) + 1
    with refused('lost', before=before, after=after, row=row):
        read_series(path, by_rate(2))


def test_a_line_of_lost_samples_without_a_counter_is_no_sample(tmp_path, refused):
    path = sampler(tmp_path / 'log.txt', numbers=False, lost=50, overrun=True)
    refused('overrun', read_series, path, by_rate(1))


@pytest.mark.parametrize('sign', ['', '# '])
@pytest.mark.parametrize('units', [' [mm/s]', ''])
def test_names_between_rows_without_times_begin_another_run(sign, units, tmp_path, refused):
    """Two runs of 200 rows below a sample time: how long the pause between them was is unknown."""
    path = tmp_path / 'log.csv'
    names = f'{sign}X speed{units};X force'
    rows = [f'{speed:.4f};-300' for speed in SPEED[:200]]
    path.write_text('\n'.join(['Sample time: 10 ms', names, *rows, '']))
    content = guess(path).content
    assert content['time'] == {'rate_Hz': RATE}
    content['axes']['x']['speed']['unit'] = 'mm/s'
    content['axes']['x']['load'] |= {'unit': 'N', 'magnitude': False}
    mapping = make_map(content)
    assert read_series(path, mapping).count == 200
    path.write_text(path.read_text() + '\n'.join([names, *rows, '']))
    refused('named_again', read_series, path, mapping)
    assert guess(path).content['time'] == {'rate_Hz': None}


@pytest.mark.parametrize('columns', [1, 2])
def test_a_blank_line_between_rows_without_times_begins_another_run(columns, tmp_path, says):
    """One that ends the text begins none."""
    path = tmp_path / 'log.csv'
    rows = [';'.join([f'{speed:.4f}', '-300.0'][:columns]) for speed in SPEED[:200]]
    head = ['Sample time: 10 ms', ';'.join(['X speed [mm/s]', 'X force [N]'][:columns])]
    for end in (['', ''], ['', '', ''], ['\t', '']):
        path.write_text('\n'.join([*head, *rows, *end]))
        made = guess(path)
        assert made.content['time'] == {'rate_Hz': RATE}
    path.write_text('\n'.join([*head, *rows, '', *rows, '']))
    made = guess(path)
    assert made.content['time'] == {'rate_Hz': None}
    assert any(says('blank') in one for one in made.unstated)


def test_a_row_that_is_cut_off_at_the_end_closes_up_nothing(tmp_path):
    path = sampler(tmp_path / 'log.txt', numbers=True)
    path.write_text(path.read_text() + '400\n')
    assert read_series(path, by_rate(2)).count == COUNT


def test_times_of_whole_seconds_that_no_map_names_count_no_samples(tmp_path):
    path = tmp_path / 'log.parquet'
    seconds = [dt.datetime(2025, 7, 14) + dt.timedelta(seconds=at) for at in range(COUNT)]
    pl.DataFrame({'stamp': seconds, 'x speed [mm/s]': SPEED}).write_parquet(path)
    axis = {'lead_mm': 10.0, 'speed': {'column': 'x speed [mm/s]', 'unit': 'mm/s'}}
    mapping = make_map({'time': {'rate_Hz': 1.0, 'epoch': EPOCH}, 'axes': {'x': axis}})
    assert read_series(path, mapping).count == COUNT


def groups(path, name, *, shift, step=1.0 / RATE):
    """Write a speed and a force behind times of their own, under one name."""
    force = 900.0 * np.cos(math.tau * (TIME + shift) / 4.0)
    times = np.arange(COUNT) * step
    later = times + shift * RATE * step
    lines = [
        f'{one:.6g};{speed:.4f};{other:.6g};{load:.3f}'
        for one, speed, other, load in zip(times, SPEED, later, force, strict=True)
    ]
    path.write_text('\n'.join([f'{name};X speed [mm/s];{name};X force [N]', *lines]) + '\n')
    return path


@pytest.mark.parametrize('name', ['X', 'X_Value', 'Sample', 't', 'Time', 'Zeit', 'ms'])
def test_two_groups_whose_times_have_one_name_are_not_put_into_one_row(name, tmp_path, refused):
    step = {'Sample': 1.0, 'ms': 1e3 / RATE}.get(name, 1.0 / RATE)
    path = groups(tmp_path / 'log.csv', name, shift=0.5, step=step)
    content = guess(path).content
    assert content['time']['column'] == name
    assert content['axes']['x']['load']['time'] == f'{name}_duplicated_0'
    inputs = {kind: dict(content['axes']['x'][kind]) for kind in ('speed', 'load')}
    inputs['load'].pop('time')
    stated = content | {'time': {'rate_Hz': RATE}, 'axes': {'x': inputs}}
    with refused('twins', name=name):
        read_series(path, make_map(stated))
    content['time'] |= {'unit': 's', 'scale': 1.0 / RATE / step}
    series = read_series(path, make_map(content))
    rows = [rows for groups in series.blocks() for rows in groups if 'x.load' in rows.columns]
    times = (np.concatenate([one.stamps for one in rows]) - series.begin) / 1e9
    load = np.concatenate([one.columns['x.load'] for one in rows])
    np.testing.assert_allclose(load, 900.0 * np.cos(math.tau * times / 4.0), atol=1e-2)


def test_times_of_one_name_that_are_the_same_leave_the_rate_alone(tmp_path):
    path = groups(tmp_path / 'log.csv', 'X', shift=0.0)
    axis = {'speed': {'column': 'X speed [mm/s]', 'unit': 'mm/s'}}
    axis |= {'load': {'column': 'X force [N]', 'unit': 'N'}, 'lead_mm': 10.0}
    mapping = make_map({'time': {'rate_Hz': RATE, 'epoch': EPOCH}, 'axes': {'x': axis}})
    assert read_series(path, mapping).count == COUNT


@pytest.mark.parametrize(('stated', 'period'), [('200 Hz', 0.005), ('100 Hz', None)])
def test_a_head_of_another_rate_than_the_times_is_asked_about(
    stated, period, tmp_path, says, refused
):
    path = tmp_path / 'log.csv'
    lines = [f'{one:.2f};{speed:.4f};-300' for one, speed in zip(TIME, SPEED, strict=True)]
    path.write_text(f'# Sample rate: {stated}\nTime [s];X speed [mm/s];X force [N]\n')
    path.write_text(path.read_text() + '\n'.join(lines) + '\n')
    made = guess(path)
    assert (made.content['time']['column'] is None) is (period is not None)
    assert (says('two_rates') in made.unstated) is (period is not None)
    made.content['time']['column'] = 'Time [s]'
    made.content['axes']['x']['load']['magnitude'] = False
    notes = ' '.join(read_series(path, make_map(made.content)).notes)
    assert (says('by_map') in notes) is (period is not None)
    by_rate_200 = make_map(made.content | {'time': {'rate_Hz': 200.0}})
    if period:
        assert not any('states a period' in note for note in read_series(path, by_rate_200).notes)
    else:
        refused('denied', read_series, path, by_rate_200)
        skipped = made.content | {'time': {'rate_Hz': 200.0}, 'skip': 1}
        assert read_series(path, make_map(skipped)).usual_period == pytest.approx(0.005)


@pytest.mark.parametrize('counter', ['', 'each row', 'each time'])
@pytest.mark.parametrize('signals', [2, 3])
def test_a_period_of_signals_on_rows_of_their_own_may_be_theirs(
    signals, counter, tmp_path, says, refused
):
    """Speeds of a sine of 4 s, of which both readings tell the length of the log."""
    path = tmp_path / 'log.csv'
    names = ['X speed [mm/s]', 'X force [N]', 'Z force [N]'][:signals]
    lines = []
    for at, speed in enumerate(SPEED):
        for place, value in enumerate((speed, -10.0 * speed, 7.0)[:signals]):
            number = len(lines) if counter == 'each row' else at
            cells = [f'{value:.4f}' if one == place else '' for one in range(signals)]
            lines.append(';'.join([f'{number}'] * bool(counter) + cells))
    head = ['Sample time: 10 ms', ';'.join(['No'] * bool(counter) + names)]
    path.write_text('\n'.join([*head, *lines]) + '\n')
    made = guess(path)
    assert made.content['time']['rate_Hz'] is None
    assert says('either_period', fast=f'{100 * signals}', rows=f'{signals}') in made.unstated
    assert made.picture[0].startswith('Group 1: an unknown period')
    for rate in (100.0, 100.0 * signals):
        content = made.content | {'time': {'rate_Hz': rate}}
        rows, *_ = next(read_series(path, make_map(content)).blocks())
        times = (rows.stamps - rows.stamps[0]) / 1e9 * rate / 100.0 / signals
        speeds = np.interp(times, TIME, SPEED) * math.tau / 10.0
        np.testing.assert_allclose(rows.columns['x.speed'], speeds, atol=1e-4)
    both = made.content | {'time': {'rate_Hz': 50.0}}
    with refused('denied_both', fast=f'{100 * signals}'):
        read_series(path, make_map(both))


def test_a_signal_in_each_row_has_the_period_of_the_head_beside_a_rarer_one(tmp_path):
    path = tmp_path / 'log.csv'
    lines = [f'{one:.4f};' + '-300' * (at % 5 == 0) for at, one in enumerate(SPEED)]
    path.write_text('Sample time: 10 ms\nX speed [mm/s];X force [N]\n' + '\n'.join(lines))
    made = guess(path)
    assert made.content['time']['rate_Hz'] == RATE
    assert [one[:14] for one in made.picture[:2]] == ['Group 1: 10 ms', 'Group 2: 50 ms']


@pytest.mark.parametrize('unit', ['s', 'ms'])
def test_stamps_that_are_rounded_keep_the_rate_of_the_head(unit, tmp_path):
    """Rows of 400 Hz with stamps of milliseconds are 2 and 3 ms apart."""
    path = tmp_path / 'log.csv'
    stamps = [round(2.5 * at + 1e-9) for at in range(COUNT)]
    factor = {'s': 1e-3, 'ms': 1.0}[unit]
    lines = [f'{factor * one:.3f};{speed:.4f}' for one, speed in zip(stamps, SPEED, strict=True)]
    head = ['# Sample rate: 400 Hz', f'Time [{unit}];X speed [mm/s]']
    path.write_text('\n'.join([*head, *lines]) + '\n')
    made = guess(path)
    assert made.content['time']['column'] == f'Time [{unit}]'
    assert not any(
        'states a period' in note for note in read_series(path, make_map(made.content)).notes
    )


def test_a_counter_beside_a_stated_rate_of_the_head_is_offered_a_scale(tmp_path, says):
    path = tmp_path / 'log.csv'
    lines = [f'{one};{speed:.4f}' for one, speed in enumerate(SPEED)]
    path.write_text('# Sample rate: 200 Hz\nTime;X speed [mm/s]\n' + '\n'.join(lines) + '\n')
    assert says('scale') in guess(path).unstated
