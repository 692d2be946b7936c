# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Messages out of pages alone are those that sqlite3 itself has written, of whatever length."""

import contextlib
import os
import sqlite3

from ballscrew_monitor.recordings.sqlite_storage import ends_with_a_page, whole_messages
import pytest

TABLE = (
    'CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER NOT NULL, '
    'timestamp INTEGER NOT NULL, data BLOB NOT NULL)'
)
SMALLEST = 512  # [bytes] of a page


def content(length):
    """Return data of a length in which each byte tells its place."""
    return b''.join(place.to_bytes(3, 'big') for place in range(length // 3 + 1))[:length]


def write(path, messages, page_size=SMALLEST):
    with contextlib.closing(sqlite3.connect(path)) as base, base:
        base.execute(f'PRAGMA page_size = {page_size}')
        base.execute(TABLE)
        rows = enumerate(messages, start=1)
        base.executemany('INSERT INTO messages VALUES(?, ?, ?, ?)', [(i, *row) for i, row in rows])
    return path


@pytest.mark.parametrize('page_size', [SMALLEST, 1024, 4096])
def test_data_of_every_length_are_read_on_through_further_pages(tmp_path, page_size):
    """Each length has its own part in the page itself, up to some further pages."""
    lengths = range(3 * SMALLEST) if page_size == SMALLEST else range(0, 3 * page_size, 7)
    messages = [(1, 10**18 + length, content(length)) for length in lengths]
    path = write(tmp_path / 'all.db3', messages, page_size)
    assert list(whole_messages(path)) == messages


def test_pages_of_64_kib_have_a_size_of_their_own(tmp_path):
    messages = [(2, 3, content(length)) for length in (65_000, 65_500, 65_536, 200_000)]
    path = write(tmp_path / 'large.db3', messages, 65536)
    assert list(whole_messages(path)) == messages


@pytest.mark.parametrize('number', [0, 1, 2, 127, 128, 2**15, 2**23, 2**31, 2**47, 2**62, -1])
def test_integers_of_every_size(tmp_path, number):
    messages = [(1, number, b'data'), (number, 1, b'')]
    assert list(whole_messages(write(tmp_path / 'one.db3', messages))) == messages


def test_of_a_file_that_is_cut_the_rows_of_whole_pages_are_read(tmp_path):
    messages = [(1, number, content(100)) for number in range(200)]
    path = write(tmp_path / 'cut.db3', messages)
    assert ends_with_a_page(path)
    os.truncate(path, path.stat().st_size // 2 + 1)
    assert not ends_with_a_page(path)
    found = list(whole_messages(path))
    assert found == messages[: len(found)]
    assert 80 < len(found) < 120


def test_a_message_whose_further_pages_are_lost_is_passed_over(tmp_path):
    messages = [(1, 1, content(9000)), (1, 2, b'short')]
    path = write(tmp_path / 'lost.db3', messages)
    os.truncate(path, 3 * SMALLEST)
    assert list(whole_messages(path)) == messages[1:]
