# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""The directory of what outlives the node: its place, its lock, its limit."""

import errno
import os

from ballscrew_monitor.node import state_folder
from ballscrew_monitor.node.state_folder import state_directory, StateFolder
import pytest
from surrogate.files import InputError


def test_a_second_node_of_the_name_keeps_nothing_and_says_so(tmp_path):
    first, second = StateFolder(tmp_path), StateFolder(tmp_path)
    assert second.reason == f'{tmp_path} is in use by another node of this name'
    assert second.write('x.json', {}) == second.reason
    assert second.read('x.json', dict) is None
    first.close()
    assert second.take()
    assert (second.reason, second.write('x.json', {})) == ('', '')
    second.close()


def test_no_directory_keeps_nothing(tmp_path):
    folder = StateFolder(None)
    assert not folder.wanted
    assert not folder.take()
    assert folder.write('x.json', {}) == 'state_dir is empty'
    (tmp_path / 'file').write_text('')
    assert 'cannot be written, Not a directory' in StateFolder(tmp_path / 'file' / 'state').reason


def test_a_directory_is_taken_as_soon_as_it_is_there(tmp_path):
    place = tmp_path / 'disk'
    place.write_text('not mounted yet')
    folder = StateFolder(place / 'state')
    assert folder.reason
    assert not folder.take()
    place.unlink()
    assert folder.take()
    assert (folder.reason, folder.write('x.json', {})) == ('', '')
    folder.close()


def test_what_a_killed_node_left_behind_is_swept(tmp_path):
    for name in ('.x.memory.ab12.json', '.hidden'):
        (tmp_path / name).write_text('half')
    StateFolder(tmp_path).close()
    assert {path.name for path in tmp_path.iterdir()} == {'.hidden', 'lock'}


def test_the_oldest_logs_go_first(tmp_path):
    folder = StateFolder(tmp_path, limit=1000)
    for number in (1, 2, 10):
        (tmp_path / f'events.{number:06d}.jsonl').write_text('x' * 300)
    assert folder.make_room(100)
    assert len(list(tmp_path.glob('*.jsonl'))) == 3
    assert folder.make_room(101)
    assert not (tmp_path / 'events.000001.jsonl').exists()
    assert not folder.make_room(1001)
    assert not list(tmp_path.glob('*.jsonl'))
    folder.close()


def test_a_damaged_file_in_a_directory_that_cannot_be_written_is_told(tmp_path, monkeypatch):
    folder = StateFolder(tmp_path)
    (tmp_path / 'x.json').write_text('[')

    def refuse(path, target):
        raise OSError(errno.EROFS, os.strerror(errno.EROFS))

    monkeypatch.setattr(state_folder.Path, 'replace', refuse)
    with pytest.raises(InputError, match='and cannot be moved, Read-only file system'):
        folder.read('x.json', dict)
    folder.close()


@pytest.mark.parametrize(
    ('wanted', 'place'),
    [
        ('', None),
        ('/var/lib/screw', '/var/lib/screw'),
        ('auto', '/state/ballscrew_monitor/cell/monitor'),
    ],
)
def test_where_things_are_kept(monkeypatch, wanted, place):
    monkeypatch.setenv('XDG_STATE_HOME', '/state')
    found = state_directory(wanted, '/cell/monitor')
    assert found is None if place is None else str(found) == place


def test_without_the_variable_it_is_the_place_of_the_specification(monkeypatch):
    monkeypatch.delenv('XDG_STATE_HOME', raising=False)
    monkeypatch.setenv('HOME', '/someone')
    found = state_directory('auto', '/monitor')
    assert str(found) == '/someone/.local/state/ballscrew_monitor/monitor'
