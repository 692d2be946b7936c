# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Kept results: bit for bit, right or not there, of one version, whatever kills the writer."""

import contextlib
import math
import resource
import signal
import sqlite3
import struct
import subprocess
import sys

from hypothesis import given
from hypothesis import strategies as st
import numpy as np
import pytest
from surrogate.surface.file import SurfaceError
from surrogate.tasks.store import clear, store_path, task_key, TaskStore

WORK = 'test 1'
PLAIN = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats() | st.text(max_size=8),
    lambda parts: st.lists(parts, max_size=4) | st.dictionaries(st.text(max_size=8), parts),
    max_leaves=12,
)
WRITER = """
import sys
from surrogate.tasks.store import TaskStore
with TaskStore(sys.argv[1], 'test 1') as store:
    for number in range(len(store), 10**9):
        store.put(f'{number:064d}', {'value': number / 7})
        print(number, flush=True)
"""


def bits(value):
    """Return plain JSON with every float as its bytes, so that NaN and -0.0 can be compared."""
    if isinstance(value, float):
        return struct.pack('<d', value) if value == value else 'nan'
    if isinstance(value, dict):
        return {key: bits(part) for key, part in value.items()}
    return [bits(part) for part in value] if isinstance(value, list) else (value, type(value))


def filled(out, number=3):
    with TaskStore(out, WORK) as store:
        for one in range(number):
            store.put(f'key{one}', {'rcs': one / 3})
    return store_path(out).read_bytes()


@given(st.dictionaries(st.text(max_size=8), PLAIN, max_size=5))
def test_results_come_back_bit_for_bit(tmp_path_factory, result):
    """Whatever the floats are, in the same process and after opening the file again."""
    out = tmp_path_factory.mktemp('store') / 'map.npz'
    with TaskStore(out, WORK) as store:
        store.put('key', result)
        assert bits(store.get('key')) == bits(result)
    with TaskStore(out, WORK) as again:
        assert 'key' in again
        assert bits(again.get('key')) == bits(result)
    assert [path.name for path in out.parent.iterdir()] == [store_path(out).name]


def test_a_key_is_the_content(refused):
    """The order of the inputs does not matter; every bit, type and word of them does."""
    inputs = {'speed': 0.1, 'draws': [1, 2]}
    key = task_key(WORK, inputs)
    assert key == task_key(WORK, {'draws': [1, 2], 'speed': 0.1})
    assert len(key) == 64
    others = (
        task_key('test 2', inputs),
        task_key(WORK, inputs | {'speed': math.nextafter(0.1, 1)}),
        task_key(WORK, inputs | {'draws': [1.0, 2]}),
    )
    assert len({key, *others}) == 4
    refused('json_compliant', task_key, WORK, {'speed': math.nan})


def test_only_plain_results_are_kept(tmp_path):
    with TaskStore(tmp_path / 'map.npz', WORK) as store:
        for result in ({'a': np.zeros(3)}, {1: 2.0}):
            with pytest.raises(TypeError):
                store.put('key', result)
        assert len(store) == 0


def test_a_flipped_bit_in_a_result_costs_that_result_alone(tmp_path):
    """Found by its checksum; the others stay, and the one that is missing is kept again."""
    out = tmp_path / 'map.npz'
    whole = filled(out)
    place = whole.index(b'{"rcs": 0.3333333333333333}')
    for at in range(place, place + 27):
        damaged = bytearray(whole)
        damaged[at] ^= 1 << at % 8
        store_path(out).write_bytes(damaged)
        with TaskStore(out, WORK) as store:
            assert [store.get(f'key{one}') for one in (0, 2)] == [{'rcs': 0.0}, {'rcs': 2 / 3}]
            assert 'key1' not in store
            store.put('key1', {'rcs': 1 / 3})
            assert store.get('key1') == {'rcs': 1 / 3}


@given(st.data())
def test_a_damaged_file_gives_no_wrong_result(tmp_path_factory, data):
    """Cut off or damaged anywhere: a result is right or not there, and the next one is kept."""
    out = tmp_path_factory.mktemp('store') / 'map.npz'
    damaged = bytearray(filled(out, 30))
    place = data.draw(st.integers(0, len(damaged) - 1))
    if data.draw(st.booleans()):
        del damaged[place:]
    else:
        damaged[place] ^= data.draw(st.integers(1, 255))
    store_path(out).write_bytes(damaged)
    refusal = ''
    try:
        with TaskStore(out, WORK) as store:
            for number in range(30):
                assert store.get(f'key{number}') in (None, {'rcs': number / 3})
            store.put('next', {'rcs': 1.0})
        with TaskStore(out, WORK) as again:
            assert again.get('next') == {'rcs': 1.0}
    except SurfaceError as error:
        refusal = str(error)
    assert not refusal or (place < 100 and 'not a store of results' in refusal)  # the head


def test_results_on_whole_pages_outlive_a_damaged_one(tmp_path, capsys):
    """The file is kept aside, and a sentence says so."""
    out = tmp_path / 'map.npz'
    damaged = bytearray(filled(out, 400))
    page = damaged.index(b'"rcs": 100.0}') // 4096 * 4096
    end = page + 8
    damaged[page:end] = b'\xff' * 8
    store_path(out).write_bytes(damaged)
    with TaskStore(out, WORK) as store:
        found = [store.get(f'key{number}') for number in range(400)]
        assert 0 < len(store) < 400
    assert [one for one in found if one] == [
        {'rcs': number / 3} for number, one in enumerate(found) if one
    ]
    told = capsys.readouterr().err
    assert told.startswith(f'{store_path(out)} is damaged (')
    assert store_path(out).with_name('map.npz.store.aside').read_bytes() == damaged


def test_a_kill_loses_the_result_in_hand_at_most(tmp_path):
    """SIGKILL at work: whatever was said to be kept is kept, and the next run goes on."""
    out, said = tmp_path / 'map.npz', -1
    for count in (1, 5, 50):
        with subprocess.Popen(
            [sys.executable, '-c', WRITER, str(out)], stdout=subprocess.PIPE, text=True
        ) as writer:
            assert writer.stdout
            for _ in range(count):
                said = int(writer.stdout.readline())
            writer.kill()
            said = max([said, *map(int, writer.stdout.read().split())])
        assert writer.returncode == -signal.SIGKILL
        with TaskStore(out, WORK) as store:
            assert len(store) in (said + 1, said + 2)
            assert store.get(f'{said:064d}') == {'value': said / 7}


def test_results_of_another_version_are_refused(tmp_path, refused):
    """One sentence that names both versions and the command that clears the file."""
    out = tmp_path / 'map.npz'
    before = filled(out)
    with refused('results_test_1') as caught:
        TaskStore(out, 'test 2')
    assert '\n' not in str(caught.value)
    assert store_path(out).read_bytes() == before
    store_path(out).with_name('map.npz.store-journal').touch()
    assert clear(out) is True
    assert clear(out) is False
    assert list(tmp_path.iterdir()) == []
    with TaskStore(out, 'test 2') as store:
        assert len(store) == 0


@pytest.mark.parametrize('content', [b'hello', b'hello\n', b'{}\n', b'[1]\n' * 1000])
def test_something_else_is_not_a_store(tmp_path, content, refused):
    out = tmp_path / 'map.npz'
    store_path(out).write_bytes(content)
    refused('store_results', TaskStore, out, WORK)
    assert store_path(out).read_bytes() == content


def test_a_database_of_another_version_is_not_a_store(tmp_path, refused):
    out = tmp_path / 'map.npz'
    filled(out)
    with contextlib.closing(sqlite3.connect(store_path(out))) as database:
        database.execute('PRAGMA user_version = 7')
    refused('store_results', TaskStore, out, WORK)


def test_two_builds_do_not_share_a_store(tmp_path):
    """The second is told so; when the first is done it may."""
    out = tmp_path / 'map.npz'
    with TaskStore(out, WORK), pytest.raises(SurfaceError, match='in use by another build of'):
        TaskStore(out, WORK)
    with TaskStore(out, WORK) as store:
        assert len(store) == 0


def test_a_full_disk_costs_nothing_that_was_kept(tmp_path):
    """A real limit on the size of a file: one sentence, and on it goes when there is room."""
    out = tmp_path / 'map.npz'
    size = len(filled(out))
    limits = resource.getrlimit(resource.RLIMIT_FSIZE)
    large = {'text': 10 * size * 'x'}
    with TaskStore(out, WORK) as store:
        resource.setrlimit(resource.RLIMIT_FSIZE, (size + 20, limits[1]))
        try:
            with pytest.raises(SurfaceError, match='cannot be written, .*; 3 results are kept'):
                store.put('next', large)
        finally:
            resource.setrlimit(resource.RLIMIT_FSIZE, limits)
        assert 'next' not in store
        store.put('next', large)
    with TaskStore(out, WORK) as again:
        assert len(again) == 4
        assert again.get('next') == large


def test_a_place_that_cannot_be_written_is_one_sentence(tmp_path, refused):
    store_path(tmp_path / 'a.npz').mkdir()
    (tmp_path / 'file').write_text('')
    for out in (tmp_path / 'a.npz', tmp_path / 'file' / 'b.npz'):
        refused('cannot_written', TaskStore, out, WORK)
    refused('cannot_removed', clear, tmp_path / 'a.npz')
