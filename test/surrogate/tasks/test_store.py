# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Kept results: bit for bit, whole or dropped, of one version, whatever kills the writer."""

import json
import math
import resource
import signal
import struct
import subprocess
import sys

from hypothesis import given, settings
from hypothesis import strategies as st
import numpy as np
import pytest
from surrogate.surface.file import SurfaceError
from surrogate.tasks.store import clear, store_path, task_key, TaskStore
from surrogate.worker import plain_result

WORK = 'test 1'
WORDS = st.text(max_size=8).filter(lambda word: not word.startswith('$'))
PLAIN = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats() | st.text(max_size=8),
    lambda parts: st.lists(parts, max_size=4) | st.dictionaries(WORDS, parts, max_size=4),
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


@settings(max_examples=60)
@given(st.dictionaries(WORDS, PLAIN, max_size=5))
def test_results_come_back_bit_for_bit(tmp_path_factory, result):
    """Whatever the floats are, in the same process and after opening the file again."""
    out = tmp_path_factory.mktemp('store') / 'map.npz'
    with TaskStore(out, WORK) as store:
        store.put('key', result)
        assert bits(store.get('key')) == bits(result)
    with TaskStore(out, WORK) as again:
        assert 'key' in again
        assert bits(again.get('key')) == bits(result)


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
        for result in ({'a': np.zeros(3)}, {'$float': '1'}, {1: 2.0}):
            with pytest.raises(TypeError):
                store.put('key', result)
        assert len(store) == 0
    assert plain_result({'a': (np.float64(0.5), 1)}) == {'a': [0.5, 1]}


def test_a_torn_end_is_dropped_wherever_it_was_torn(tmp_path):
    """Cut after any byte, the file keeps every whole line and takes the next result."""
    out = tmp_path / 'map.npz'
    whole = filled(out)
    head = whole.index(b'\n') + 1
    for length in range(len(whole)):
        store_path(out).write_bytes(whole[:length])
        kept = max(whole[:length].count(b'\n') - 1, 0)
        with TaskStore(out, WORK) as store:
            assert len(store) == kept
            assert store.dropped == (length > head and not whole[:length].endswith(b'\n'))
            store.put('next', {'rcs': 1.0})
        with TaskStore(out, WORK) as again:
            assert len(again) == kept + 1
            assert again.dropped == 0


@settings(max_examples=60)
@given(st.data())
def test_a_damaged_line_costs_that_line_alone(tmp_path_factory, data):
    """A flipped byte in a result is found by its checksum; the others stay."""
    out = tmp_path_factory.mktemp('store') / 'map.npz'
    damaged = bytearray(filled(out))
    place = data.draw(st.integers(damaged.index(b'\n') + 1, len(damaged) - 1))
    damaged[place] ^= data.draw(st.integers(1, 255))
    store_path(out).write_bytes(damaged)
    with TaskStore(out, WORK) as store:
        # A flip can end a line early or join two, which costs the two.
        assert 1 <= len(store) <= 2
        assert store.dropped >= 1
        for number in range(3):
            assert store.get(f'key{number}') in (None, {'rcs': number / 3})


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
    assert f'`ballscrew surface clean {out}` removes them' in str(caught.value)
    assert '\n' not in str(caught.value)
    assert store_path(out).read_bytes() == before
    assert clear(out) is True
    assert clear(out) is False
    with TaskStore(out, 'test 2') as store:
        assert len(store) == 0


@pytest.mark.parametrize('content', [b'hello', b'hello\n', b'{}\n', b'[1]\n'])
def test_something_else_is_not_a_store(tmp_path, content, refused):
    out = tmp_path / 'map.npz'
    store_path(out).write_bytes(content)
    refused('store_results', TaskStore, out, WORK)
    assert store_path(out).read_bytes() == content


def test_two_builds_do_not_share_a_store(tmp_path):
    """The second is told so; when the first is done it may."""
    out = tmp_path / 'map.npz'
    with TaskStore(out, WORK), pytest.raises(SurfaceError, match='in use by another build of'):
        TaskStore(out, WORK)
    with TaskStore(out, WORK) as store:
        assert len(store) == 0


def test_a_full_disk_costs_nothing_that_was_kept(tmp_path):
    """A real limit on the size of a file: one sentence, the file as it was, and on it goes."""
    out = tmp_path / 'map.npz'
    size = len(filled(out))
    limits = resource.getrlimit(resource.RLIMIT_FSIZE)
    with TaskStore(out, WORK) as store:
        resource.setrlimit(resource.RLIMIT_FSIZE, (size + 20, limits[1]))
        try:
            with pytest.raises(SurfaceError, match='cannot be written, .*; 3 results are kept'):
                store.put('next', {'rcs': 1.0})
        finally:
            resource.setrlimit(resource.RLIMIT_FSIZE, limits)
        assert store_path(out).stat().st_size == size
        assert 'next' not in store
        store.put('next', {'rcs': 1.0})
    with TaskStore(out, WORK) as again:
        assert len(again) == 4
        assert again.dropped == 0


def test_a_place_that_cannot_be_written_is_one_sentence(tmp_path, refused):
    store_path(tmp_path / 'a.npz').mkdir()
    (tmp_path / 'file').write_text('')
    for out in (tmp_path / 'a.npz', tmp_path / 'file' / 'b.npz'):
        refused('cannot_written', TaskStore, out, WORK)
    refused('cannot_removed', clear, tmp_path / 'a.npz')


def test_floats_are_hexadecimal_on_file(tmp_path):
    """A person can read the lines; a list of floats is one word each."""
    out = tmp_path / 'map.npz'
    with TaskStore(out, WORK) as store:
        store.put('key', {'rcs': 0.5, 'curve': [1.0, math.inf]})
    line = store_path(out).read_bytes().splitlines()[1]
    assert json.loads(line.partition(b' ')[2]) == [
        'key',
        {
            'curve': {'$floats': '0x1.0000000000000p+0 inf'},
            'rcs': {'$float': '0x1.0000000000000p-1'},
        },
    ]
