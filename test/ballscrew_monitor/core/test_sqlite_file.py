# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""SQLite files: where they may lie, whether they are known, and what becomes of others."""

import contextlib
import os
import sqlite3

from ballscrew_monitor.core.sqlite_file import (
    connected,
    is_empty,
    is_passing,
    let_go,
    on_network,
    opened_to_read,
    set_file_aside,
    size_of,
)
import pytest

LIMIT = 1_000_000  # [B]


def test_a_file_system_of_another_machine_is_known_by_its_name(tmp_path):
    device = tmp_path.stat().st_dev
    number = f'{os.major(device)}:{os.minor(device)}'
    mounts = tmp_path / 'mountinfo'
    for kind, other, expected in (('nfs4', 'ext4', True), ('ext4', 'nfs4', False)):
        mounts.write_text(
            f'22 1 {number} / / rw,relatime shared:1 - {kind} server:/x rw\n'
            f'23 1 0:999 / /mnt rw - {other} /dev/vdb rw\n'
        )
        assert on_network(tmp_path, mounts) is expected
    assert not on_network(tmp_path, tmp_path / 'missing')


def test_a_file_is_empty_once_and_known_by_its_version(tmp_path, says):
    file = tmp_path / 'one.sqlite3'
    assert size_of(file) == 0
    database = connected(file, LIMIT)
    assert is_empty(database, 3)
    database.executescript('CREATE TABLE a (b); PRAGMA user_version = 3')
    assert not is_empty(database, 3)
    with pytest.raises(ValueError, match='is of another version') as caught:
        is_empty(database, 4)
    let_go(database, alone=True)
    let_go(None)
    assert {one.name for one in tmp_path.iterdir()} == {file.name}
    size = size_of(file)
    assert size > 0
    assert set_file_aside(file, caught.value) == says('other_version', folder=tmp_path)
    assert size_of(tmp_path / 'one.sqlite3.aside') == size
    assert not file.exists()


def test_what_only_cannot_be_had_now_is_no_damage(tmp_path):
    file = tmp_path / 'one.sqlite3'
    with contextlib.closing(sqlite3.connect(file, isolation_level=None)) as holder:
        holder.execute('CREATE TABLE a (b)')
        holder.execute('BEGIN IMMEDIATE')
        other = sqlite3.connect(file, timeout=0.0, isolation_level=None)
        with contextlib.closing(other), pytest.raises(sqlite3.OperationalError) as caught:
            other.execute('BEGIN IMMEDIATE')
    assert is_passing(caught.value)
    assert not is_passing(ValueError('no record'))


def test_who_reads_a_file_of_another_version_is_told_so(tmp_path, refused):
    def read():
        with opened_to_read(tmp_path, 'one.sqlite3', 4) as database:
            return database.execute('SELECT b FROM a').fetchall()

    refused('no_file', read)
    with contextlib.closing(sqlite3.connect(tmp_path / 'one.sqlite3')) as database:
        database.executescript('CREATE TABLE a (b); PRAGMA user_version = 3')
    refused('cannot_read', read)
