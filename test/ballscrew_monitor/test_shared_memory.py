# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Which files of FastDDS the tests may remove."""

import fcntl
import os

from ballscrew_monitor.cycle.domain import port
import pytest

SEGMENT = 'fastrtps_0123456789abcdef'
PORT = f'fastrtps_port{port(7, 0) + 1}'


@pytest.fixture
def folder(tmp_path):
    """Return a folder with a segment, a port without and one with locks, and other files."""
    for name in (SEGMENT, PORT, f'fastdds_port{port(8, 1) + 1}'):
        (tmp_path / name).touch()
    for name in (f'{SEGMENT}_el', f'sem.{PORT}_mutex', f'fastdds_port{port(8, 1) + 1}_sl'):
        (tmp_path / name).touch()
    for name in ('fastrtps_port7000', 'fastrtps_fedcba9876543210', 'lttng-ust-wait-6', 'sem.x'):
        (tmp_path / name).touch()
    return tmp_path


def names(paths):
    return {path.name for path in paths}


def test_a_segment_is_stale_when_its_lock_can_be_had(folder, shared_memory):
    assert names(shared_memory.stale_segments(folder, set())) == {SEGMENT, f'{SEGMENT}_el'}
    with (folder / f'{SEGMENT}_el').open() as owner:
        fcntl.flock(owner, fcntl.LOCK_EX)
        assert not shared_memory.stale_segments(folder, set())
    assert names(shared_memory.stale_segments(folder, set())) == {SEGMENT, f'{SEGMENT}_el'}


def test_a_port_is_stale_in_a_free_domain_only(folder, shared_memory):
    ports = shared_memory.stale_segments(folder, {7}) - shared_memory.stale_segments(folder, set())
    assert names(ports) == {PORT, f'sem.{PORT}_mutex'}
    assert (
        len(
            shared_memory.stale_segments(folder, {7, 8})
            - shared_memory.stale_segments(folder, {7})
        )
        == 2
    )


def test_a_port_that_somebody_listens_to_is_kept(folder, shared_memory):
    with (folder / f'fastdds_port{port(8, 1) + 1}_sl').open() as listener:
        fcntl.flock(listener, fcntl.LOCK_SH)
        assert shared_memory.stale_segments(folder, {8}) == shared_memory.stale_segments(
            folder, set()
        )


def test_what_cannot_be_opened_is_kept(folder, shared_memory):
    lock = folder / f'{SEGMENT}_el'
    lock.unlink()
    lock.mkdir()
    assert not shared_memory.stale_segments(folder, set())


@pytest.fixture
def runs(tmp_path, shared_memory):
    """Return a function that makes the context of a run of the tests, and who has cleaned."""
    cleaned = []

    def make(name):
        return shared_memory.last_one_cleans(tmp_path, lambda: cleaned.append(name))

    return make, cleaned


def test_the_last_of_the_runs_at_work_cleans(runs):
    make, cleaned = runs
    with make('first'):
        with make('second'):
            pass
        assert cleaned == []
    assert cleaned == ['first']


def test_after_a_failure_nothing_is_held(runs, tmp_path):
    make, cleaned = runs
    with pytest.raises(ValueError, match='why'), make('failed'):
        raise ValueError('why')
    assert cleaned == []
    descriptor = os.open(tmp_path, os.O_RDONLY)
    fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
    os.close(descriptor)
