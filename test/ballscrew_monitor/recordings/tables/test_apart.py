# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Frames that a process of bounded memory makes of a file."""

from ballscrew_monitor.recordings.tables import apart
from ballscrew_monitor.recordings.tables.foreign import read_signals
import numpy as np
import polars as pl
import pytest
import scipy.io
from surrogate.files import limits


def test_a_structure_that_unpacks_to_more_than_the_memory_is_one_sentence(
    tmp_path, refused, monkeypatch
):
    path = tmp_path / 'log.mat'
    packed = {'log': {'speed': np.zeros(10_000_000)}}  # of 80 MB, in a file of 80 kB
    scipy.io.savemat(path, packed, do_compression=True)
    assert path.stat().st_size < 100_000
    monkeypatch.setattr(limits, 'MEMORY', 200 * limits.MEGA)
    refused('memory', read_signals, path, 'mat')


def test_a_frame_is_made_again_only_when_its_file_has_changed(tmp_path, monkeypatch):
    path, tasks = tmp_path / 'log', []

    def result(task, inputs, *, memory, failure):
        tasks.append(task)
        pl.DataFrame({'a': [len(path.read_bytes())]}).write_ipc(inputs['target'])
        return {'sheet': inputs['sheet']}

    monkeypatch.setattr(apart, 'result_apart', result)
    for content, sheet, count in ((b'a', 'x', 1), (b'a', 'y', 2), (b'ab', 'y', 3)):
        path.write_bytes(content)
        for _ in range(2):
            frame, told = apart.frame_apart(path, 'module:task', sheet=sheet)
            assert frame['a'].to_list() == [len(content)]
            assert told == {'sheet': sheet}
        assert len(tasks) == count


def test_a_table_may_come_to_all_that_is_allowed(refused, monkeypatch):
    monkeypatch.setattr(limits, 'SPARSE', 800 * limits.MEGA)
    apart.check_room(10_000_000, 10)
    apart.check_room(5_000_000, 10, limits.TEXT_CELL)
    apart.check_room(0, 10)
    refused('numbers', apart.check_room, 10_000_001, 10)
    with pytest.raises(apart.Unreadable):
        apart.check_room(5_000_001, 10, limits.TEXT_CELL)
