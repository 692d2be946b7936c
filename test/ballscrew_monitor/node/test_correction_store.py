# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Corrections on the disk: whole or not at all, for one node, and never a guess."""

import errno
import json
import types

from ballscrew_monitor.node import state_folder
from ballscrew_monitor.node.correction_store import CorrectionStore
from ballscrew_monitor.node.state_folder import StateFolder
import pytest
from surrogate.files import InputError

SOLVE = types.SimpleNamespace(
    speed=0.1 + 0.2, opposing_load=-1e3, temperature=313.15, solved={'rcs': 1 / 3}
)


@pytest.fixture(name='store')
def make_store(tmp_path):
    folder = StateFolder(tmp_path / 'state')
    yield CorrectionStore(folder)
    folder.close()


def test_what_is_kept_comes_back_bit_for_bit(store):
    assert store.load('x') == ('', [])
    assert store.save('x', 'abc', [SOLVE]) == ''
    sha256, (kept,) = store.load('x')
    assert sha256 == 'abc'
    assert (kept.speed, kept.opposing_load, kept.temperature) == (0.1 + 0.2, -1e3, 313.15)
    assert kept.solved == {'rcs': 1 / 3}


def test_each_axis_has_its_own_and_the_last_word_counts(store):
    store.save('x', 'abc', [SOLVE])
    store.save('y', 'abc', [SOLVE, SOLVE])
    store.save('x', 'abc', [])
    assert [len(store.load(axis)[1]) for axis in 'xy'] == [0, 2]


def test_a_full_disk_loses_nothing_that_was_kept(store, monkeypatch):
    store.save('x', 'abc', [SOLVE])

    def full(path, content):
        raise OSError(errno.ENOSPC, 'No space left on device', str(path))

    monkeypatch.setattr(state_folder, 'replace_file', full)
    assert 'No space left on device' in store.save('x', 'abc', [SOLVE, SOLVE])
    assert len(store.load('x')[1]) == 1


@pytest.mark.parametrize(
    'content',
    [
        '',
        '[1',
        '{}',
        '{"version": 2, "surface": "abc", "corrections": []}',
        '{"version": 1, "surface": "abc", "corrections": [{"speed_rad_s": "fast"}]}',
        '{"version": 1, "surface": "abc", "corrections": 3}',
    ],
)
def test_a_damaged_file_is_moved_aside_with_a_sentence(store, tmp_path, content):
    path = tmp_path / 'state' / 'x.corrections.json'
    path.write_text(content)
    with pytest.raises(InputError, match='moved to x.corrections.damaged'):
        store.load('x')
    assert path.with_suffix('.damaged').read_text() == content
    assert store.load('x') == ('', [])


def test_corrections_leave_room_for_the_sums(tmp_path):
    folder = StateFolder(tmp_path, limit=1000)
    store = CorrectionStore(folder)
    assert store.save('x', 'abc', [SOLVE]) == ''
    assert store.save('y', 'abc', [SOLVE] * 9) == f'{tmp_path} is at its state_limit of 0.001 MB'
    assert [len(store.load(axis)[1]) for axis in 'xy'] == [1, 0]
    folder.close()


def test_the_file_says_its_units(store, tmp_path):
    store.save('x', 'abc', [SOLVE])
    content = json.loads((tmp_path / 'state' / 'x.corrections.json').read_text())
    assert set(content['corrections'][0]) == {
        'speed_rad_s',
        'opposing_load_N',
        'temperature_K',
        'solved',
    }
