# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Files that appear whole or not at all."""

import os

import pytest
from surrogate.files import new_file, new_folder, printable, replace_file


def test_a_file_is_made_with_its_directory_and_replaced(tmp_path, refused):
    """Readable by all, and nothing else is left in the directory."""
    path = tmp_path / 'a' / 'b' / 'file'
    for content in (b'one', b'two'):
        replace_file(path, content)
        assert path.read_bytes() == content
    assert path.stat().st_mode & 0o777 == 0o644
    assert list(path.parent.iterdir()) == [path]
    refused('regular_file', replace_file, tmp_path, b'one')


def test_a_failure_leaves_what_was_there(tmp_path, monkeypatch, refused):
    """The disk is full when the bytes are flushed."""
    path = tmp_path / 'file'
    replace_file(path, b'one')

    def full(_):
        raise OSError(28, 'No space left on device')

    monkeypatch.setattr(os, 'fsync', full)
    refused('space_left_device', replace_file, path, b'two')
    assert path.read_bytes() == b'one'
    assert list(tmp_path.iterdir()) == [path]


class Refused(Exception):
    """What ends a block."""


@pytest.mark.parametrize('make', [new_folder, lambda folder: new_file(folder / 'file')])
def test_what_is_refused_leaves_no_empty_folder(tmp_path, make):
    with pytest.raises(Refused), make(tmp_path / 'a' / 'b'):
        raise Refused
    assert not list(tmp_path.iterdir())
    (tmp_path / 'a').mkdir()
    with pytest.raises(Refused), make(tmp_path / 'a' / 'b' / 'c'):
        raise Refused
    assert list(tmp_path.rglob('*')) == [tmp_path / 'a']


def test_what_is_refused_leaves_what_was_written(tmp_path):
    kept = tmp_path / 'a' / 'b' / 'kept'

    def write_and_refuse():
        with new_folder(kept.parent / 'c'):
            kept.touch()
            raise Refused

    with pytest.raises(Refused):
        write_and_refuse()
    assert list(kept.parent.iterdir()) == [kept]


def test_a_text_cannot_steer_a_terminal():
    assert printable('a\x1b[2J\x07\r\x9bb\n\tä°') == 'a\\x1b[2J\\x07\\x0d\\x9bb\n\tä°'
