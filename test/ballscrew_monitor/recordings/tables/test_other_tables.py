# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Rows below or above a log that are of another table are no samples of it."""

from ballscrew_monitor.recordings.tables.guess import guess
from ballscrew_monitor.recordings.tables.mapping import make_map
from ballscrew_monitor.recordings.tables.other_tables import other_table
from ballscrew_monitor.recordings.tables.series import read_series
from hypothesis import given, settings
from hypothesis import strategies as st
import numpy as np
import pytest
from surrogate.files import InputError

NAMES = ['t [s]', 'x velocity [mm/s]', 'x force [N]']
SEPARATORS = {';': ';', 'tab': '\t', ',': ','}


def columns_of(rate, rows):
    times = np.arange(rows) / rate
    speed = 75.0 * np.sin(2 * np.pi * times / times[-1])
    return times, speed, 900.0 * np.sign(speed)


def statistics_of(columns):
    """Return rows such as a control writes below its log: least, most and mean, without a word."""
    return [[f'{of(one):.6g}' for one in columns] for of in (np.min, np.max, np.mean)]


def spectrum_of(columns):
    return [[str(at), f'{900 / (at + 1):.3f}', str(50 * at)] for at in range(40)]


def alarms_of(columns):
    end = columns[0][-1]
    return [[f'{end + wait:.2f}', str(code), '0'] for wait, code in ((300.0, 700), (450.0, 510))]


BELOW = {'statistics': statistics_of, 'spectrum': spectrum_of, 'alarms': alarms_of}
HEADS = {
    'none': lambda separator: [],
    'blank': lambda separator: [''],
    'blanks': lambda separator: ['', ''],
    'title': lambda separator: ['', 'Results'],
    'names': lambda separator: ['', separator.join(['f', 'A', 'phi'])],
    'words': lambda separator: [separator.join(['Bin', 'Count', 'Share'])],
}


def log_of(path, columns, rows, separator, head):
    sign = SEPARATORS[separator]
    cells = [[f'{cell:.6g}' for cell in row] for row in zip(*columns, strict=True)]
    lines = [sign.join(row) for row in [NAMES, *cells]]
    path.write_text('\n'.join([*lines, *HEADS[head](sign), *map(sign.join, rows)]) + '\n')
    return path


def read(path):
    mapping = guess(path).content
    return read_series(path, make_map(mapping))


@pytest.mark.parametrize(('separator', 'rate'), [(';', 50.0), ('tab', 1000.0), (',', 50.0)])
@pytest.mark.parametrize('head', HEADS)
@pytest.mark.parametrize('below', BELOW)
def test_a_table_below_a_log_is_named_and_never_read(tmp_path, separator, head, below, rate):
    if below == 'alarms' and head == 'none':
        return  # rows after a pause, which nothing parts from the log
    columns = columns_of(rate, 600)
    path = log_of(tmp_path / 'log.csv', columns, BELOW[below](columns), separator, head)
    with pytest.raises(InputError, match=r'log\.csv: (column|row).*split the log there'):
        read(path)


def limits_of(columns):
    """Return rows such as a control writes above its log: the least and most of each column."""
    return [[f'{of(one):.6g}' for one in columns] for of in (np.min, np.max)]


@pytest.mark.parametrize('separator', SEPARATORS)
@pytest.mark.parametrize(
    'rows', [limits_of, lambda columns: [['0', '-500', '-5e3'], ['20', '500', '5e3']]]
)
@pytest.mark.parametrize('rate', [50.0, 1000.0])
def test_rows_of_limits_above_a_log_are_named_and_never_read(tmp_path, separator, rows, rate):
    columns = columns_of(rate, 600)
    path = log_of(tmp_path / 'log.csv', columns, [], separator, 'none')
    names, *cells = path.read_text().splitlines()
    above = map(SEPARATORS[separator].join, rows(columns))
    path.write_text('\n'.join([names, *above, *cells]) + '\n')
    with pytest.raises(InputError, match=r'log\.csv: column .t \[s\].: rows 2 to 3 above the log'):
        read(path)


@pytest.mark.parametrize('rows', [2, 5, 12])
@pytest.mark.parametrize('step', [0.5, 1.0, 4.0])
def test_few_rows_of_a_run_before_the_first_are_of_the_log(tmp_path, rows, step):
    columns = columns_of(100.0, 600)
    path = log_of(tmp_path / 'log.csv', columns, [], ';', 'none')
    names, *cells = path.read_text().splitlines()
    above = [f'{7.0 + at * step / 100.0:g};0;0' for at in range(rows)]
    path.write_text('\n'.join([names, *above, *cells]) + '\n')
    assert read(path).count == 600 + rows


@pytest.mark.parametrize('head', ['none', 'blank', 'title'])
def test_a_log_that_goes_on_or_begins_again_is_one(tmp_path, head):
    columns = columns_of(100.0, 600)
    for shift in (6.0, 60.0, 0.0):
        rows = [[f'{cell:.6g}' for cell in row] for row in zip(*columns, strict=True)]
        rows = [[f'{float(time) + shift:.6g}', *rest] for time, *rest in rows]
        series = read(log_of(tmp_path / 'log.csv', columns, rows, ';', head))
        assert series.count == 1200


@given(
    rate=st.sampled_from([10.0, 100.0, 2000.0]),
    late=st.lists(st.tuples(st.integers(0, 590), st.integers(1, 9)), max_size=5),
    lost=st.lists(st.integers(0, 599), max_size=20),
    unknown=st.lists(st.integers(0, 599), max_size=10),
)
@settings(deadline=None)
def test_rows_that_come_late_or_miss_are_of_the_log(rate, late, lost, unknown):
    times = list(np.arange(600) / rate)
    for at in unknown:
        times[at] = np.nan
    for at, later in late:
        times.insert(at + later, times.pop(at))
    kept = np.delete(np.array(times), lost)
    assert not other_table(kept, 2, 1.0 / rate)


@pytest.mark.parametrize(
    ('first', 'step', 'seconds', 'rows'),
    [(0, 20, 0.2, '2 to 6 above'), (104, 4, 0.04, '229 to 250'), (250, 1, 0.01, '762 to 851')],
)
def test_milliseconds_without_zeros_are_offered_a_rate(first, step, seconds, rows, tmp_path, says):
    """Some controls write 8:00:01.4 four milliseconds after the second."""
    stamps = [divmod(first + step * at, 1000) for at in range(1100)]
    lines = [f'2025-03-14 08:00:{s:02}.{part};{at % 7}' for at, (s, part) in enumerate(stamps)]
    path = tmp_path / 'log.csv'
    path.write_text('\n'.join(['Time;x velocity [mm/s]', *lines]))
    with pytest.raises(InputError) as caught:
        read(path)
    assert f'rows {rows}' in f'{caught.value}'
    assert f'{seconds:g} s apart, not as those' in f'{caught.value}'
    assert says('without_zeros', step=f'{step / 1000:g}') in f'{caught.value}'
