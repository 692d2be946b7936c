# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Bags of a recorder that was killed: SQLite works what it has left into the file."""

from collections import namedtuple
import contextlib
import os
import shutil
import sqlite3
import tempfile

from ballscrew_monitor.recordings.bag import Bag
from ballscrew_monitor.recordings.sqlite_storage import ends_with_a_page
import pytest

TABLE = (
    'CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER NOT NULL, '
    'timestamp INTEGER NOT NULL, data BLOB NOT NULL)'
)
TOPICS = """
CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT NOT NULL, type TEXT NOT NULL,
    serialization_format TEXT NOT NULL, offered_qos_profiles TEXT NOT NULL);
INSERT INTO topics VALUES(1, '/a', 'std_msgs/msg/Float64', 'cdr', '');
"""
SMALLEST = 512  # [bytes] of a page
HALF = 100  # messages


def insert(base, first):
    """Insert half of the messages, whose times are numbered from `first` on."""
    rows = [(1, 10**18 + number, bytes(300)) for number in range(first, first + HALF)]
    base.executemany('INSERT INTO messages(topic_id, timestamp, data) VALUES(?, ?, ?)', rows)


@pytest.fixture
def left(tmp_path):
    """
    Return the function that makes the bag of a recorder that was killed.

    Half of the messages are in its file; a journal of the kind `mode` belongs to the others.

    """
    with contextlib.closing(sqlite3.connect(tmp_path / 'a_0.db3', isolation_level=None)) as base:

        def leave(mode):
            base.execute(f'PRAGMA page_size = {SMALLEST}')
            base.execute(f'PRAGMA journal_mode = {mode}')
            base.execute('PRAGMA cache_size = 1')  # pages are written before they are committed
            base.executescript(f'{TABLE}; {TOPICS}')
            for first in (0, HALF):
                base.execute('PRAGMA wal_checkpoint(TRUNCATE)')
                base.execute('BEGIN')
                insert(base, first)
                if not first or mode == 'WAL':
                    base.execute('COMMIT')
            bag = tmp_path / 'bag'
            bag.mkdir()
            for path in tmp_path.glob('a_0.db3*'):
                if not path.name.endswith('-shm'):
                    shutil.copyfile(path, bag / path.name)
            return bag

        yield leave


def held(path):
    """Return the bytes of all files of a folder."""
    return {file.name: file.read_bytes() for file in path.iterdir()}


def times(bag):
    return [message.log_time - 10**18 for message in bag.messages()]


def damage(file, place, data=b'?' * 8):
    with file.open('r+b') as stream:
        stream.seek(place)
        stream.write(data)


@pytest.mark.parametrize('salvage', [False, True])
@pytest.mark.parametrize('name', ['', 'a_0.db3'])
def test_messages_in_a_write_ahead_log_are_read_and_the_bag_is_left_as_it_is(
    name, salvage, left, tmp_path, monkeypatch
):
    path, scratch = left('WAL'), tmp_path / 'scratch'
    scratch.mkdir()
    monkeypatch.setattr(tempfile, 'tempdir', str(scratch))
    before = held(path)
    assert before.keys() == {'a_0.db3', 'a_0.db3-wal'}
    path.chmod(0o555)
    bag = Bag(path / name, salvage=salvage)
    assert times(bag) == [*range(2 * HALF)]
    assert bag.topics['/a'].count == 2 * HALF
    assert (bag.notes, held(path)) == ([], before)
    assert bag.files == [path / 'a_0.db3']
    assert held(scratch / os.listdir(scratch)[0]).keys() == {'a_0.db3'}
    del bag
    assert not os.listdir(scratch)


def test_a_file_ends_with_a_page(left):
    path = left('WAL') / 'a_0.db3'
    assert ends_with_a_page(path)
    os.truncate(path, path.stat().st_size - 1)
    assert not ends_with_a_page(path)


def test_without_a_journal_nothing_is_copied(left, monkeypatch):
    path = left('WAL')
    (path / 'a_0.db3-wal').write_bytes(b'')
    monkeypatch.setattr(tempfile, 'mkdtemp', None)
    assert times(Bag(path)) == [*range(HALF)]


@pytest.mark.parametrize('place', [-1, 0.5, 200, 16], ids=['end', 'half', 'first page', 'begin'])
def test_pages_of_a_write_ahead_log_that_are_not_used_are_told(place, left, says):
    path = left('WAL')
    log = path / 'a_0.db3-wal'
    if place == -1:
        os.truncate(log, log.stat().st_size - 1)  # the transaction has lost its end
    else:
        damage(log, int(place * log.stat().st_size) if place == 0.5 else place)
    bag = Bag(path)
    assert times(bag) == [*range(HALF)]
    assert bag.notes == [says('pages_left_out', file=path / 'a_0.db3')]


def test_a_bag_whose_messages_are_all_in_damaged_pages_says_so(left, refused):
    path = left('WAL')
    log = (path / 'a_0.db3-wal').rename(path / 'held')
    with contextlib.closing(sqlite3.connect(path / 'a_0.db3', isolation_level=None)) as base:
        base.execute('DELETE FROM messages')
    damage(log.rename(path / 'a_0.db3-wal'), 16)
    refused('all_left_out', Bag, path)


def test_pages_of_an_earlier_round_of_a_write_ahead_log_are_no_loss(left, tmp_path):
    left('WAL')
    bag = tmp_path / 'other'
    bag.mkdir()
    with contextlib.closing(sqlite3.connect(tmp_path / 'a_0.db3', isolation_level=None)) as base:
        base.execute('PRAGMA wal_checkpoint(FULL)')
        base.execute(
            "INSERT INTO messages(topic_id, timestamp, data) VALUES(1, 1000000000000000200, x'')"
        )
        for name in ('a_0.db3', 'a_0.db3-wal'):
            shutil.copyfile(tmp_path / name, bag / name)
    assert times(Bag(bag)) == [*range(2 * HALF + 1)]
    assert not Bag(bag).notes


def test_a_transaction_that_was_not_finished_is_rolled_back(left, says):
    path = left('DELETE')
    file, before = path / 'a_0.db3', held(path)
    assert before.keys() == {'a_0.db3', 'a_0.db3-journal'}
    bag = Bag(path)
    assert times(bag) == [*range(HALF)]
    assert bag.notes == [says('rolled_back', file=file)]
    assert held(path) == before


def test_a_rollback_journal_may_be_finished_or_damaged(left, says):
    path = left('WAL')
    file, journal = path / 'a_0.db3', path / 'a_0.db3-journal'
    (path / 'a_0.db3-wal').unlink()
    for content, notes in ((b'?', [says('may_be_among', file=file)]), (b'\0', [])):
        journal.write_bytes(content * 600)
        bag = Bag(path)
        assert (times(bag), bag.notes) == ([*range(HALF)], notes)


def test_a_transaction_that_cannot_be_rolled_back_is_refused(left, refused):
    path = left('DELETE')
    damage(path / 'a_0.db3-journal', 0)
    refused('damaged', Bag, path)


def test_a_bag_that_is_being_written_is_no_half(left, monkeypatch, refused):
    path = left('WAL')
    copyfile = shutil.copyfile

    def copied(source, target):
        os.utime(path / 'a_0.db3', ns=(1, 1))  # the recorder moves its log into the file
        return copyfile(source, target)

    monkeypatch.setattr(shutil, 'copyfile', copied)
    for salvage in (False, True):
        os.utime(path / 'a_0.db3', ns=(2, 2))
        refused('being_written', Bag, path / 'a_0.db3', salvage=salvage)


def test_a_copy_takes_half_of_the_free_disk_at_most(left, monkeypatch, refused):
    path = left('WAL')
    size = sum(map(len, held(path).values()))
    usage = namedtuple('Usage', 'free')
    monkeypatch.setattr(shutil, 'disk_usage', lambda folder: usage(2 * size))
    assert len(times(Bag(path))) == 2 * HALF
    monkeypatch.setattr(shutil, 'disk_usage', lambda folder: usage(2 * size - 1))
    refused('half_of_the_disk', Bag, path)


def test_a_log_whose_file_is_damaged_is_one_sentence(left, refused):
    path = left('WAL')
    damage(path / 'a_0.db3', 100, bytes(400))  # the schema
    damage(path / 'a_0.db3-wal', 16)
    refused('damaged', Bag, path)
    refused('damaged', Bag, path / 'a_0.db3', salvage=True)
