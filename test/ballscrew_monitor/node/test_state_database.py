# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The database: whole or as before, for one node, within its limit, whatever becomes of it."""

import contextlib
import random
import shutil
import sqlite3

from ballscrew_monitor.core.state import NOT_ENDED, NOT_SHELVED
from ballscrew_monitor.judge.kept import AxisRecord
from ballscrew_monitor.judge.records import Memory
from ballscrew_monitor.node.state_database import FILE, read_entries, StateDatabase
from ballscrew_monitor.node.state_records import by_key, Corrections, entry_of, Kind
import pytest
from surrogate.files import InputError, store

LIMIT = 400_000  # [B]
LESS_THAN_NOTHING = """UPDATE axes SET memory = '{"running_time": -1}'"""


class Opened(StateDatabase):
    """A database that is opened at once."""

    def __init__(self, folder, limit=LIMIT):
        self.damage = []
        super().__init__(folder, limit, damage=self.damage)
        self.found = self.load()

    def setting(self, name):
        return self.database.execute(f'PRAGMA {name}').fetchone()[0]

    @property
    def event(self):
        return self.found[AxisRecord, 'x'].event

    def fill(self, *numbers):
        """Write an entry for each number and a record that knows of them, at once."""
        facts = {'text': 'x' * 200}
        entries = [entry_of(Kind.EVENT_BEGIN, 'x', one, facts) for one in numbers]
        self.write(entries, [AxisRecord(axis='x', event=numbers[-1])])

    def size(self):
        """Return the size [B] of its files but for the shared memory."""
        return sum(
            one.stat().st_size for one in self.folder.iterdir() if one.suffix[-4:] != '-shm'
        )


@pytest.fixture(name='make')
def make_database(tmp_path):
    with contextlib.ExitStack() as stack:

        def make(folder=tmp_path, **changes):
            database = Opened(folder, **changes)
            stack.callback(database.close)
            return database

        yield make


def stamps(folder):
    return [one.stamp_ns for one in read_entries(folder)]


def test_what_is_written_is_found_again(make, tmp_path):
    memory = Memory(event_number=7, angle=0.1 + 0.2)
    axis = AxisRecord.of('x', memory, NOT_ENDED, NOT_SHELVED, 0)
    records = by_key([axis, Corrections('x', 'abc')])
    database = make()
    assert database.found == {}
    assert (database.setting('journal_mode'), database.setting('synchronous')) == ('wal', 2)
    database.write([entry_of(Kind.NODE_START, None, 1, {})] * 2, records.values())
    database.write([entry_of(Kind.NODE_STOP, None, 2, {})], [])
    assert stamps(tmp_path) == [1, 1, 2]
    database.close()
    assert {path.name for path in tmp_path.iterdir()} == {'lock', FILE}
    found = make().found
    assert repr(found) == repr(records)


def test_a_second_node_waits_until_the_first_is_gone(make, tmp_path):
    first = make()
    with pytest.raises(InputError, match=f'{tmp_path} is in use by another node of this name'):
        make()
    first.fill(1)
    first.close()
    assert make().event == 1


@pytest.mark.parametrize('limit', [LIMIT, 100 * LIMIT], ids=['begun again', 'appended'])
def test_a_power_cut_leaves_all_of_a_commit_or_nothing(make, tmp_path, limit):
    """Of what is written into the write-ahead log any beginning may have reached the disk."""
    random.seed(1)
    database = make(tmp_path / 'node', limit=limit)
    for number in (1, 2):
        database.fill(*[number] * 20)
        shutil.copytree(tmp_path / 'node', tmp_path / f'after_{number}')
    before, after = ((tmp_path / f'after_{one}' / f'{FILE}-wal').read_bytes() for one in (1, 2))
    before = before.ljust(len(after), b'\0')
    written = [at for at in range(len(after)) if before[at] != after[at]]
    begin, end = written[0], written[-1] + 1
    assert (begin < 32) is (limit == LIMIT)  # its header
    for cut in (begin, end - 1, end, *random.sample(range(begin, end), 20)):
        place = tmp_path / f'cut_{cut}'
        shutil.copytree(tmp_path / 'after_1', place)
        garbage = random.randbytes(min(600, end - cut))
        rest = cut + len(garbage)
        torn = after[:cut] + garbage + before[rest:]
        (place / f'{FILE}-wal').write_bytes(torn)
        last = 2 if cut == end else 1
        assert make(place).event == last
        assert stamps(place) == [1] * 20 + [2] * 20 * (last - 1)


@pytest.mark.parametrize('why', ['shared memory', 'network'])
def test_where_no_write_ahead_log_works_a_journal_is_rolled_back(make, tmp_path, monkeypatch, why):
    make(tmp_path / 'killed').fill(1)
    place = tmp_path / 'place'
    shutil.copytree(tmp_path / 'killed', place)
    (place / f'{FILE}-shm').unlink()
    if why == 'network':
        monkeypatch.setattr(store, 'on_network', lambda folder: True)
    else:
        (place / f'{FILE}-shm').mkdir()
    database = make(place)
    assert (database.setting('journal_mode'), database.setting('synchronous')) == ('truncate', 2)
    database.fill(2)
    assert (database.event, stamps(place)) == (1, [1, 2])


def spoil(folder, *statements):
    with contextlib.closing(sqlite3.connect(folder / FILE, isolation_level=None)) as database:
        for statement in statements:
            database.execute(statement)


@pytest.mark.parametrize(
    ('statements', 'why', 'number'),
    [
        (['PRAGMA user_version = 7'], 'is of another version (7, known is 1)', 3),
        (['DROP TABLE axes'], 'is damaged (no such table: axes)', 0),
        (['ALTER TABLE axes DROP COLUMN reason'], 'is damaged (table axes has other columns)', 3),
        (["UPDATE axes SET ending = 'LUCK'"], "is damaged ('LUCK')", 3),
        ([LESS_THAN_NOTHING], 'is damaged (running_time is -1)', 3),
        (['UPDATE axes SET event = 1 << 32'], 'is damaged (event is 4294967296, allowed', 0),
        (
            ["INSERT INTO corrections VALUES ('x', '', '[1')"],
            'is damaged (it is no JSON (Expecting',
            3,
        ),
    ],
)
def test_what_no_node_has_left_is_kept_aside(make, tmp_path, statements, why, number):
    database = make()
    database.fill(1, 2, 3)
    database.close()
    spoil(tmp_path, *statements)
    again = make()
    (said,) = again.damage
    assert said.startswith(f'{tmp_path / FILE} {why}')
    assert said.endswith(f', moved to {FILE}.aside')
    assert stamps(tmp_path) == []
    # The numbers of events go on where they can be read, and nothing else does.
    expected = by_key([AxisRecord(axis='x', event=number)]) if number else {}
    assert repr(again.found) == repr(expected)
    with contextlib.closing(sqlite3.connect(tmp_path / f'{FILE}.aside')) as aside:
        assert aside.execute('SELECT count(*) FROM events').fetchone() == (3,)


@pytest.mark.parametrize(('where', 'end'), [(0, 4096), (12288, 16384), (-8192, -4096)])
def test_a_damaged_file_is_kept_aside(make, tmp_path, where, end):
    database = make()
    database.fill(*range(100))
    database.close()
    content = bytearray((tmp_path / FILE).read_bytes())
    content[where:end] = b'\xa5' * 4096
    (tmp_path / FILE).write_bytes(content)
    again = make()
    assert 'is damaged (' in again.damage[0]
    assert (tmp_path / f'{FILE}.aside').read_bytes()[100:] == content[100:]
    again.fill(100)
    assert stamps(tmp_path) == [100]


def test_a_killed_beginning_is_begun_again_and_a_removed_file_noticed(make, tmp_path):
    (tmp_path / FILE).touch()
    database = make()
    assert (database.found, database.damage) == ({}, [])
    assert database.is_open
    (tmp_path / FILE).unlink()
    assert not database.is_open


def test_a_full_disk_loses_nothing_that_was_kept(make, tmp_path, refused):
    database = make()
    database.fill(1)
    pages = database.setting('page_count')
    database.setting(f'max_page_count = {pages}')
    refused('database_disk_full', database.fill, *range(2, 100))
    assert stamps(tmp_path) == [1]
    database.close()
    assert make().event == 1


def test_the_oldest_entries_go_and_all_stays_within_the_limit(make, tmp_path):
    database = make()
    for number in range(1, 2001, 100):
        database.fill(*range(number, number + 100))
        assert database.size() <= LIMIT
    kept = stamps(tmp_path)
    assert kept == list(range(kept[0], 2001))
    assert kept[0] > 1
    assert len(kept) > 500


def test_a_limit_that_was_lowered_holds_from_the_next_start_on(make, tmp_path):
    database = make(limit=10 * LIMIT)
    database.fill(*range(5000))
    database.close()
    assert database.size() > LIMIT
    database = make()
    assert database.size() <= LIMIT
    assert (database.event, database.damage, stamps(tmp_path)[-1]) == (4999, [], 4999)


def test_somebody_who_reads_without_an_end_does_not_let_the_journal_grow(make, tmp_path, refused):
    database = make()
    with contextlib.closing(sqlite3.connect(tmp_path / FILE, isolation_level=None)) as reader:
        reader.execute('BEGIN')
        reader.execute('SELECT count(*) FROM axes').fetchall()
        with contextlib.suppress(InputError):
            for number in range(1000):
                database.fill(*[number] * 20)
        refused('state_limit_0_4', database.fill, 1000)
        assert database.size() < LIMIT + 20_000
    database.fill(1000)
    assert stamps(tmp_path)[-1] == 1000
    assert database.size() < LIMIT


@pytest.mark.parametrize('column', ['time', 'axis', 'kind', 'facts'])
def test_a_damaged_text_hides_no_other_entry(make, tmp_path, column):
    database = make()
    database.fill(*range(5))
    database.close()
    before = read_entries(tmp_path)
    spoil(
        tmp_path,
        f"UPDATE events SET {column} = CAST(x'65e5' || {column} AS TEXT) WHERE number = 3",
    )
    after = read_entries(tmp_path)
    assert getattr(after[2], column) == f'e\\xe5{getattr(before[2], column)}'
    assert (after[:2], after[3:]) == (before[:2], before[3:])
    assert after[2].record().keys() >= {'time', 'stamp_ns', 'axis', 'kind'}


def test_who_reads_is_told_why_there_is_nothing_to_read(make, tmp_path, refused):
    with pytest.raises(InputError, match=f'{tmp_path} has no {FILE}: name the state_dir'):
        read_entries(tmp_path)
    make().close()
    spoil(tmp_path, 'PRAGMA user_version = 7')
    refused('another_version_7', read_entries, tmp_path)
    (tmp_path / FILE).write_bytes(b'no database' * 1000)
    refused('cannot_read_file', read_entries, tmp_path)
