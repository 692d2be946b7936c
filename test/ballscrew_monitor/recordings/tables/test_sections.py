# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Measurement files of LabVIEW with several sections, as its documentation describes them."""

import math

from ballscrew_monitor.recordings.tables import sources
from ballscrew_monitor.recordings.tables.guess import guess
from ballscrew_monitor.recordings.tables.mapping import make_map
from ballscrew_monitor.recordings.tables.series import read_series
import numpy as np
import pytest
from surrogate.files import limits

END, STEP = '***End_of_Header***\t', 0.02
WAVES = ['X velocity [mm/s]', 'X force [N]']


def head(columns='One'):
    return ['LabVIEW Measurement\t', 'Separator\tTab', f'X_Columns\t{columns}', END, '']


def section(rows, names=WAVES, *, clock='11:59:56', step=STEP):
    """Return a section: its head, the names of its columns, and a motion of a second."""
    every = range(len(names))
    fields = {'Channels': [len(names)], 'Samples': [rows] * len(names), 'Time': [clock]}
    fields['Delta_X'] = [step] * len(names)
    lines = ['\t'.join(map(str, [key, *values])) for key, values in fields.items()]
    lines += [END, '\t'.join(['X_Value', *names, 'Comment'])]
    for at in range(rows):
        speed = 80.0 * math.sin(math.tau * at * step)
        cells = [f'{step * at:.2f}', *[f'{speed - 3.0 * one:.4f}' for one in every]]
        lines.append('\t'.join(cells))
    return [*lines, '']


@pytest.mark.parametrize(
    'names', [['Untitled', 'Untitled 1'], ['Voltage_0', 'Voltage_1'], ['Dev1/ai0', 'Dev1/ai1']]
)
def test_columns_that_labview_named_are_those_of_a_map(names, tmp_path):
    """The names stand behind the head, whatever they say, and above them X_Dimension says Time."""
    path, lines = tmp_path / 'log.lvm', [*head(), *section(60, names)]
    lines.insert(len(head()) + 1, '\t'.join(['X_Dimension', 'Time', 'Time']))
    path.write_text('\n'.join(lines))
    axis = {'lead_mm': 10.0, 'speed': {'column': names[0], 'unit': 'mm/s'}}
    time = {'column': 'X_Value', 'unit': 's', 'epoch': '2025-07-14T00:00:00Z'}
    series = read_series(path, make_map({'time': time, 'axes': {'x': axis}}))
    (rows,) = [rows for (rows,) in series.blocks()]
    true = 80.0 * np.sin(math.tau * STEP * np.arange(60))
    np.testing.assert_allclose(rows.columns['x.speed'], true * math.tau / 10.0, atol=1e-4)


@pytest.mark.parametrize('rows', [60, 3000])
@pytest.mark.parametrize('end', ['\n', '\r\n'])
def test_sections_of_one_head_are_runs_of_one_table(rows, end, tmp_path, says):
    path = tmp_path / 'log.lvm'
    lines = [
        *head(),
        *section(rows),
        *section(40, clock='12:10:00'),
        *section(rows, clock='13:00:00'),
    ]
    path.write_bytes(end.join(lines).encode())
    series = read_series(path, make_map(guess(path).content))
    assert (series.count, len(series.run_begins)) == (2 * rows + 40, 3)
    assert any(says('joined') in note for note in series.notes)
    speed = np.concatenate([rows.columns['x.speed'] for (rows,) in series.blocks()])
    true = [80.0 * np.sin(math.tau * STEP * np.arange(count)) for count in (rows, 40, rows)]
    np.testing.assert_allclose(speed, np.concatenate(true) * math.tau / 10.0, atol=1e-4)


@pytest.mark.parametrize(
    ('other', 'key'),
    [
        ({'names': ['Temperature']}, 'channels'),
        ({'names': ['X position [mm]', 'X force [N]']}, 'names'),
        ({'step': 0.01}, 'step'),
    ],
)
def test_sections_of_other_heads_are_refused_with_what_differs(other, key, tmp_path, refused):
    path = tmp_path / 'log.lvm'
    path.write_text('\n'.join([*head(), *section(60), *section(60, **other)]))
    refused(key, sources.source_of, path)


def test_sections_without_times_are_refused(tmp_path, refused):
    path = tmp_path / 'log.lvm'
    path.write_text('\n'.join([*head('No'), *section(60), *section(60)]))
    refused('without_times', sources.source_of, path)
    path.write_text('\n'.join([*head('No'), *section(60)]))
    assert sources.source_of(path).first_rows().height == 60


@pytest.mark.parametrize('rows', [60, 3000])
def test_sections_of_a_file_that_is_too_large_to_look_for_them_are_refused(
    rows, tmp_path, refused, monkeypatch
):
    monkeypatch.setattr(limits, 'TABLE', 100)
    path = tmp_path / 'log.lvm'
    lines = [*head(), *section(rows)]
    path.write_text('\n'.join([*lines, *section(60)]))
    with refused('sections', row=len(lines) + 5):
        for _ in sources.source_of(path).blocks(['X_Value']):
            pass
