# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""A small log like a real one: three axes and a spindle, no time, a current of zeros."""

import sys

from ballscrew_monitor.recordings.tables import apart
import numpy as np
import pytest

RATE = 10.0
ROWS = 300
LEAD_MM = 10.0


def mill_columns(rows=ROWS):
    time = np.arange(rows) / RATE
    columns = {}
    for number, axis in enumerate('XYZ'):
        speed = 20.0 * (number + 1) * np.sin(2 * np.pi * time / (8.0 + number))
        speed[:20] = 0.0
        moved = np.concatenate([[0.0], np.cumsum((speed[1:] + speed[:-1]) / 2 / RATE)])
        columns |= {
            f'{axis}1_ActualPosition': 100.0 + moved,
            f'{axis}1_ActualVelocity': speed,
            f'{axis}1_ActualAcceleration': np.gradient(speed, time),
            f'{axis}1_CommandVelocity': speed * 1.01,
            f'{axis}1_CurrentFeedback': 0.0 * speed if axis == 'Z' else 5.0 + 0.2 * speed,
            f'{axis}1_OutputCurrent': np.full(rows, 325.0),
        }
    columns |= {
        'S1_ActualVelocity': np.full(rows, 50.0),
        'S1_CurrentFeedback': np.full(rows, 20.0),
        'M1_CURRENT_FEEDRATE': np.full(rows, 6.0),
    }
    return columns


def write_table(path, columns, *, separator=',', form='{:.5g}'):
    names = list(columns)
    lines = [separator.join(names)]
    for row in zip(*columns.values(), strict=True):
        cells = (cell if isinstance(cell, str) else form.format(cell) for cell in row)
        lines.append(separator.join(cells))
    path.write_text('\n'.join(lines) + '\n', encoding='utf-8')
    return path


@pytest.fixture
def in_this_process(monkeypatch):
    """Let readers work here, where their libraries are loaded."""

    def result(task, inputs, *, memory, failure):
        module, _, name = task.partition(':')
        return getattr(sys.modules[module], name)(inputs)

    monkeypatch.setattr(apart, 'result_apart', result)


@pytest.fixture
def mill_log(tmp_path):
    columns = mill_columns() | {'Machining_Process': ['Prep'] * ROWS}
    return write_table(tmp_path / 'mill.csv', columns)


@pytest.fixture(scope='session')
def write_csv():
    return write_table


@pytest.fixture(scope='session')
def mill():
    return mill_columns
