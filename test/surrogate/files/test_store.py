# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Stores: every record comes back, whole transactions alone, and no bad file is in the way."""

import contextlib
import dataclasses
import enum
import math
import os
from pathlib import Path
import signal
import sqlite3
import subprocess
import sys
from typing import NamedTuple

from hypothesis import example, given
from hypothesis import strategies as st
import pytest
from surrogate.files.store import (
    connected,
    is_passing,
    MAY_BE_NAN,
    on_network,
    opened_to_read,
    plain_text,
    readable,
    size_of,
    Store,
    Table,
)

LIMIT = 1_000_000  # [B]
NUMBERS = st.integers(-(2**63), 2**63 - 1)
TEXTS = st.text(st.characters(codec='utf-8'), max_size=8)
# Of a zero SQLite keeps no sign.
FINITE = st.floats(allow_nan=False, allow_infinity=False).map(lambda number: number + 0.0)
ANY = st.floats().map(lambda number: number + 0.0)


class Kind(enum.IntEnum):
    A = 0
    B = 7


class Place(NamedTuple):
    left: int
    right: int


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class Sample:
    name: str
    place: Place
    number: int = 0
    share: float = 0.0
    drag: float = math.nan
    load: float = dataclasses.field(default=0.0, metadata=MAY_BE_NAN)
    good: bool = False
    kind: Kind = Kind.A
    times: tuple[float, ...] = ()
    axis: str | None = None
    left_out: int = 0


SAMPLES = Table(
    name='samples',
    kind=Sample,
    key='row',
    index='owner, number',
    beside={'row': int, 'owner': str},
    without=('left_out',),
)
RECORDS = st.builds(
    Sample,
    name=TEXTS,
    place=st.builds(Place, NUMBERS, NUMBERS),
    number=NUMBERS,
    share=FINITE,
    drag=ANY,
    load=ANY,
    good=st.booleans(),
    kind=st.sampled_from(Kind),
    times=st.lists(st.floats(allow_nan=False), max_size=4).map(tuple),
    axis=st.none() | TEXTS,
)
KILLED = """
import pathlib, sys
sys.path.insert(0, sys.argv[2])
from test_store import opened, Place, Sample, SAMPLES
store = opened(pathlib.Path(sys.argv[1]))
begin = len(store.rows(SAMPLES)) // 10
for number in range(begin, 10**6):
    with store.transaction():
        for part in range(10):
            store.put(SAMPLES, [Sample(name='x', place=Place(number, part))], owner='x')
    print(number, flush=True)
"""
"""A process that writes ten rows at a time."""


def opened(folder, **changes):
    store = Store(folder / 'a.sqlite3', [SAMPLES], **{'version': 3, 'limit': LIMIT} | changes)
    store.connect()
    return store


def sample(number, **changes):
    return Sample(name=f'{number}', place=Place(number, 0), **changes)


def records(store):
    return [record for _, record in readable(SAMPLES, store.rows(SAMPLES, 'ORDER BY row'))]


@given(st.lists(RECORDS, max_size=4))
@example([Sample(name='a\0b', place=Place(-(2**63), 2**63 - 1), times=(-0.0, math.inf))])
def test_records_come_back_bit_for_bit(tmp_path_factory, given_records):
    """In the same process and by somebody who only reads."""
    folder = tmp_path_factory.mktemp('store')
    store = opened(folder)
    with store.transaction():
        last = store.put(SAMPLES, given_records, owner='x')
    assert last == len(given_records)
    assert repr(records(store)) == repr(given_records)
    with opened_to_read(folder, 'a.sqlite3', [SAMPLES], 3) as reader:
        rows = reader.rows(SAMPLES, 'WHERE owner = ? ORDER BY row', 'x')
        assert repr([SAMPLES.read(row) for row in rows]) == repr(given_records)
    store.close()
    assert [path.name for path in folder.iterdir()] == ['a.sqlite3']


@pytest.mark.parametrize(
    'change',
    [
        {'name': None},
        {'name': 5},
        {'name': '\udce5'},
        {'place_left': None},
        {'number': 0.5},
        {'share': None},
        {'share': math.inf},
        {'share': 'much'},
        {'good': 2},
        {'kind': 3},
        {'times': b'1234567'},
        {'times': 1.0},
        {'axis': 1},
    ],
)
def test_a_row_that_nobody_has_written_is_refused(change):
    row = SAMPLES.row(sample(1))
    assert repr(SAMPLES.read(row)) == repr(sample(1))
    with pytest.raises((ValueError, TypeError, KeyError)):
        SAMPLES.read(row | change)


def test_a_flipped_bit_in_a_text_hides_its_row_alone(tmp_path):
    """Whichever letter it is in: the text is another one, or none at all."""
    store = opened(tmp_path)
    with store.transaction():
        store.put(SAMPLES, [sample(number, axis='Montag') for number in range(5)], owner='x')
    store.close()
    whole = store.file.read_bytes()
    place = whole.index(b'Montag')
    for at in range(place, place + 6):
        for bit in range(8):
            damaged = bytearray(whole)
            damaged[at] ^= 1 << bit
            store.file.write_bytes(damaged)
            store.connect()
            found = records(store)
            assert len(found) in (4, 5)
            assert [one.axis for one in found].count('Montag') == 4
            store.close()
    assert plain_text(b'M\xe5'.decode('utf-8', 'surrogateescape')) == 'M\\xe5'
    assert (plain_text('M'), plain_text(3)) == ('M', 3)


def test_a_kill_loses_the_transaction_in_hand_at_most(tmp_path):
    """After any number of writes, and within the one that comes next."""
    here = str(Path(__file__).parent)
    for writes in (1, 2, 5, 20):
        command = [sys.executable, '-c', KILLED, str(tmp_path), here]
        with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as writer:
            for _ in range(writes):
                last = int(writer.stdout.readline())
            writer.kill()
            last = max([last, *map(int, writer.stdout.read().split())])
        assert writer.returncode == -signal.SIGKILL
        store = opened(tmp_path)
        found = records(store)
        store.close()
        assert len(found) in (10 * (last + 1), 10 * (last + 2))
        assert [one.place.right for one in found] == [*range(10)] * (len(found) // 10)


def test_what_fails_in_a_transaction_is_undone(tmp_path):
    store = opened(tmp_path)

    def fail():
        with store.transaction():
            store.put(SAMPLES, [sample(1)], owner='x')
            store.put(SAMPLES, [None], owner='x')

    with pytest.raises(AttributeError):
        fail()
    assert records(store) == []
    store.let_go()
    with pytest.raises(sqlite3.OperationalError, match='is not open'):
        store.rows(SAMPLES)


@pytest.mark.parametrize(
    ('statement', 'why'),
    [
        ('PRAGMA user_version = 7', 'is of another version (7, known is 3)'),
        ('DROP TABLE samples', 'is damaged (no such table: samples)'),
        (
            'ALTER TABLE samples RENAME COLUMN drag TO lag',
            'is damaged (table samples has other columns)',
        ),
        (
            'ALTER TABLE samples ADD COLUMN more REAL',
            'is damaged (table samples has other columns)',
        ),
    ],
)
def test_what_nobody_has_left_is_kept_aside(tmp_path, statement, why, refused):
    """What can be had of it is had before; who only reads is told."""
    store = opened(tmp_path)
    with store.transaction():
        store.put(SAMPLES, [sample(1)], owner='x')
    store.close()
    with contextlib.closing(sqlite3.connect(store.file, isolation_level=None)) as database:
        database.execute('CREATE TABLE another (a)')
        database.execute(statement)

    def read():
        with opened_to_read(tmp_path, 'a.sqlite3', [SAMPLES], 3):
            pass

    with refused('bad_file', why=why):
        read()
    rescued = []
    found, sentence = store.recovered(lambda: records(store), lambda: rescued.append(store.used))
    assert (found, len(rescued)) == ([], 1)
    assert sentence == f'{store.file} {why}, moved to a.sqlite3.aside'
    aside = tmp_path / 'a.sqlite3.aside'
    with contextlib.closing(sqlite3.connect(aside)) as database:
        tables = database.execute('SELECT count(*) FROM sqlite_master').fetchone()
    assert tables[0] > 0
    store.close()


def test_one_that_is_opened_alone_is_for_nobody_else(tmp_path):
    store = opened(tmp_path, alone=True)
    with pytest.raises(sqlite3.OperationalError, match='locked') as caught:
        opened(tmp_path, alone=True)
    assert is_passing(caught.value)
    store.close()
    opened(tmp_path, alone=True).close()
    assert [path.name for path in tmp_path.iterdir()] == ['a.sqlite3']


def test_a_file_that_another_one_has_replaced_is_not_open(tmp_path):
    store = opened(tmp_path)
    assert store.is_open
    store.file.rename(tmp_path / 'before')
    assert not store.is_open
    store.file.touch()
    assert not store.is_open
    store.connect()
    assert store.is_open
    store.close()
    assert not store.is_open


@pytest.mark.parametrize('alone', [False, True])
def test_the_journal_takes_a_sixteenth_of_the_limit(tmp_path, alone):
    with contextlib.closing(connected(tmp_path / 'a.sqlite3', 2**20, alone=alone)) as database:
        assert database.execute('PRAGMA journal_size_limit').fetchone() == (2**16,)
        assert database.execute('PRAGMA wal_autocheckpoint').fetchone() == (2**16 // 4096,)


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
    assert size_of(mounts) > size_of(tmp_path / 'missing') == 0


def test_what_only_cannot_be_had_now_is_no_damage_and_sets_nothing_aside(tmp_path):
    store = opened(tmp_path)
    store.close()
    with contextlib.closing(sqlite3.connect(store.file, isolation_level=None)) as holder:
        holder.execute('BEGIN EXCLUSIVE')
        with pytest.raises(sqlite3.OperationalError) as caught:
            store.recovered(lambda: None)
    assert is_passing(caught.value)
    assert not is_passing(ValueError('no record'))
    assert not store.is_open
    assert [path.name for path in tmp_path.iterdir()] == ['a.sqlite3']


def test_who_reads_is_told_that_there_is_nothing(tmp_path, refused):
    def read():
        with opened_to_read(tmp_path, 'a.sqlite3', [SAMPLES], 3):
            pass

    refused('no_file', read)
    (tmp_path / 'a.sqlite3').write_bytes(b'no database' * 1000)
    refused('cannot_read', read)
