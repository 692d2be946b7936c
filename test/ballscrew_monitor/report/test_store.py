# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Rows survive being stored; a file is whole or not there; hidden folders go with a process."""

import os
import subprocess
import sys

from ballscrew_monitor.core.judgement import Zone
from ballscrew_monitor.recordings.columns import CODED, COLUMNS, joined
from ballscrew_monitor.report import store as store_module
from ballscrew_monitor.report.store import block_of, frame_of, RowStore, scratch_folder
import numpy as np
import polars as pl
import pytest

KILLED = """
import os
import signal
import sys
from pathlib import Path
from ballscrew_monitor.report.store import scratch_folder
with scratch_folder(Path(sys.argv[1])) as folder:
    (folder / 'rows').touch()
    os.kill(os.getpid(), signal.SIGKILL)
"""


def assert_same(one, other):
    assert one.axis == other.axis
    for name in COLUMNS:
        np.testing.assert_array_equal(getattr(one, name), getattr(other, name), err_msg=name)
        assert getattr(one, name).dtype == getattr(other, name).dtype


def test_columns_come_back_from_a_frame(judged):
    block = judged.columns(zone=np.arange(100) % 3, tick=np.arange(100) % 2 == 0)
    assert_same(block_of(frame_of(block)), block)


@pytest.mark.parametrize('kind', CODED.values())
def test_codes_count_from_zero_without_a_hole(kind):
    assert [member.value for member in kind] == list(range(len(kind)))


def test_parquet_holds_all_rows_by_axis_or_none_with_the_same_columns(judged, tmp_path):
    blocks = [judged.columns(0, 60), judged.columns(0, 40, axis='y'), judged.columns(60, 40)]
    with scratch_folder(tmp_path) as folder:
        store = RowStore(folder)
        for block in blocks:
            store.add(block)
        store.write(tmp_path / 'states.parquet')
        assert_same(joined(list(store.blocks('x'))), joined([blocks[0], blocks[2]]))
    found = pl.read_parquet(tmp_path / 'states.parquet')
    assert found.columns == ['axis', *COLUMNS]
    assert found['axis'].value_counts().sort('axis').rows() == [('x', 100), ('y', 40)]
    assert found['zone'].unique().to_list() == [Zone.OPTIMAL.name]
    assert_same(block_of(found.filter(pl.col('axis') == 'y')), blocks[1])
    assert [path.name for path in tmp_path.iterdir()] == ['states.parquet']
    with scratch_folder(tmp_path) as folder:
        RowStore(folder).write(tmp_path / 'states.parquet')
    empty = pl.read_parquet(tmp_path / 'states.parquet')
    assert empty.schema == frame_of(judged.columns()).schema
    assert empty.height == 0


def test_what_a_killed_process_has_left_is_removed_and_what_is_in_use_is_not(tmp_path):
    environment = os.environ | {'PYTHONPATH': os.pathsep.join(sys.path)}
    subprocess.run([sys.executable, '-c', KILLED, str(tmp_path)], env=environment, check=False)
    (left,) = tmp_path.iterdir()
    with scratch_folder(tmp_path) as first, scratch_folder(tmp_path) as second:
        assert not left.exists()
        assert set(tmp_path.iterdir()) == {first, second}
    assert not list(tmp_path.iterdir())


def test_where_there_are_no_locks_nothing_is_taken_away(tmp_path, monkeypatch):
    def refuse(*_):
        raise OSError

    monkeypatch.setattr(store_module.fcntl, 'flock', refuse)
    with scratch_folder(tmp_path) as first, scratch_folder(tmp_path) as second:
        assert set(tmp_path.iterdir()) == {first, second}


def test_an_interrupt_as_soon_as_a_folder_is_there_leaves_nothing(tmp_path, monkeypatch):
    make = os.mkdir

    def make_and_interrupt(*arguments):
        make(*arguments)
        raise KeyboardInterrupt

    monkeypatch.setattr(os, 'mkdir', make_and_interrupt)
    with pytest.raises(KeyboardInterrupt), scratch_folder(tmp_path):
        raise AssertionError
    assert not list(tmp_path.iterdir())
