# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The usual time between rows, out of bins that do not grow with the rows."""

from ballscrew_monitor.recordings.tables.mapping import make_map
from ballscrew_monitor.recordings.tables.series import read_series
from ballscrew_monitor.recordings.tables.times import Steps, WIDTH
import numpy as np
import pytest


def counted(stamps, block):
    """Return the steps between stamps that are told in blocks."""
    steps = Steps()
    for begin in range(0, len(stamps), block):
        end = begin + block
        steps.add(stamps[begin:end])
    return steps


@pytest.mark.parametrize('block', [1, 100, 10_000])
@pytest.mark.parametrize('count', [1000, 1001])
def test_the_median_is_right_but_for_the_width_of_a_bin(block, count):
    steps = np.random.default_rng(1).lognormal(15.0, 3.0, count).round()
    found = counted(np.concatenate([[0.0], np.cumsum(steps)]), block)
    assert found.median == pytest.approx(np.median(steps), rel=WIDTH)
    assert found.longest == steps.max()
    assert found.longest_row == steps.argmax() + 1
    assert found.gaps() == (steps > 100 * np.median(steps)).sum()


def test_equal_steps_are_told_to_the_last_bit_and_one_of_exactly_a_hundred_is_no_gap():
    assert counted(np.arange(10.0) * 12_345_678.0, 3).median == 12_345_678.0
    assert counted(np.zeros(4), 4).median == 0.0
    assert counted(np.zeros(4), 4).gaps() == 0
    for last, gaps in ((100.0, 0), (101.0, 1)):
        assert counted(np.cumsum([0.0, *[7.0] * 9, 7.0 * last]), 4).gaps() == gaps


@pytest.mark.parametrize('block', [1, 2, 9])
def test_a_pause_between_runs_is_no_step(block):
    stamps, runs = np.array([0.0, 20, 420, 90_000, 90_020, 90_420]), np.repeat([0, 1], 3)
    steps = Steps()
    for begin in range(0, len(stamps), block):
        end = begin + block
        steps.add(stamps[begin:end], runs[begin:end])
    assert (steps.median, steps.longest, steps.longest_row) == (210.0, 400.0, 2)


@pytest.mark.parametrize('begin', [0, 30, 60])
@pytest.mark.parametrize(('lost', 'every'), [(40, 1), (40, 5), (0, 5)])
def test_empty_rows_at_the_ends_are_missing_as_those_in_the_middle(begin, lost, every, tmp_path):
    """Of 100 rows 40 hold a temperature alone, if any; that is known in each row or each fifth."""
    lines = ['t [s];X Speed [mm/s];X Force [N];Oil temperature [°C]']
    for at in range(100):
        motion = ';' if begin <= at < begin + lost else f'{at % 9}.5;-300'
        lines.append(f'{at / 10:.1f};{motion};{"" if at % every else 38.5}')
    path = tmp_path / 'log.csv'
    path.write_text('\n'.join(lines))
    axis = {'lead_mm': 10.0, 'speed': {'column': 'X Speed [mm/s]', 'unit': 'mm/s'}}
    axis['temperature'] = {'column': 'Oil temperature [°C]', 'unit': 'degC'}
    time = {'column': 't [s]', 'unit': 's', 'epoch': '2026-01-05T08:00:00Z'}
    series = read_series(path, make_map({'time': time, 'axes': {'x': axis}}))
    assert series.rows == (100, 100 // every)
    assert series.counts == (100 - lost, 100 // every)
