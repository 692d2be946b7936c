# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""A ROS domain of one's own; files of FastDDS go with killed processes, never with living ones."""

from collections import Counter
import contextlib
import fcntl
import mmap
import os
from pathlib import Path
import re
import socket
import subprocess
import sys

from ballscrew_monitor.cycle import domain as domains
from ballscrew_monitor.cycle.domain import free_domain, port, remove_stale, SHARED_MEMORY, stale
from ballscrew_monitor.cycle.node_process import child_environment
import pytest

SEGMENT = 'fastrtps_0123456789abcdef'
SEGMENT_NAME = re.compile(r'fast(rtps|dds)_[0-9a-f]{16}')
PORT = f'fastrtps_port{port(7, 0) + 1}'


def test_ports_are_those_of_the_specification():
    # DDSI-RTPS 2.3, 9.6.1.1: PB + DG * domainId + d1 + PG * participantId.
    assert port(0, 0) == 7410
    assert port(42, 3) == 7400 + 250 * 42 + 10 + 2 * 3
    highest = port(domains.DOMAINS[-1], domains.LOCK_PARTICIPANT)
    assert highest < 32768  # from here on the kernel gives ports to clients


def test_a_domain_is_held_by_one_at_a_time_and_not_free_with_a_participant():
    with free_domain() as one, free_domain() as other:
        assert one != other
        assert {one, other} <= set(domains.DOMAINS)
    with free_domain() as found:
        with domains.held(found) as free:
            assert not free
    with domains.held(found) as free:
        assert free
    with free_domain() as found:
        assert domains.is_free(found)
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as participant:
            participant.bind(('', port(found, 1)))
            assert not domains.is_free(found)
        assert domains.is_free(found)


def test_when_all_are_taken_it_says_so(monkeypatch, refused):
    with free_domain() as found:
        monkeypatch.setattr(domains, 'DOMAINS', range(found, found + 1))
        with refused('free_ros_domain'), free_domain():
            pass


def test_domains_are_drawn_at_random(monkeypatch):
    monkeypatch.setattr(domains, 'is_free', lambda number: True)
    found: Counter[int] = Counter()
    for _ in range(20):
        with free_domain() as number:
            found[number] += 1
    assert len(found) > 1


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


def test_a_segment_is_stale_when_its_lock_can_be_opened_and_had(folder):
    assert names(stale(folder, set())) == {SEGMENT, f'{SEGMENT}_el'}
    with (folder / f'{SEGMENT}_el').open() as owner:
        fcntl.flock(owner, fcntl.LOCK_EX)
        assert not stale(folder, set())
    assert names(stale(folder, set())) == {SEGMENT, f'{SEGMENT}_el'}
    lock = folder / f'{SEGMENT}_el'
    lock.unlink()
    lock.mkdir()
    assert not stale(folder, set())


@pytest.mark.parametrize('name', [SEGMENT, f'{SEGMENT}_el'])
def test_a_segment_that_a_process_has_open_is_kept(folder, name):
    with (folder / name).open():  # its lock could be had: it has just been made
        assert not stale(folder, set())
    assert stale(folder, set())


def test_a_segment_that_a_process_has_mapped_is_kept(folder):
    (folder / SEGMENT).write_bytes(b'0')
    with (folder / SEGMENT).open('r+b') as file:
        mapped = mmap.mmap(file.fileno(), 1)
    assert not stale(folder, set())
    mapped.close()
    assert stale(folder, set())


def test_what_is_of_another_user_is_kept(folder, monkeypatch):
    monkeypatch.setattr(os, 'geteuid', lambda: os.getuid() + 1)
    assert not stale(folder, {7, 8})


def test_which_ports_are_stale(folder):
    ports = stale(folder, {7}) - stale(folder, set())
    assert names(ports) == {PORT, f'sem.{PORT}_mutex'}
    assert len(stale(folder, {7, 8}) - stale(folder, {7})) == 2
    with (folder / f'fastdds_port{port(8, 1) + 1}_sl').open() as listener:
        fcntl.flock(listener, fcntl.LOCK_SH)
        assert stale(folder, {8}) == stale(folder, set())
    assert 'fastrtps_port7000' not in names(stale(folder, {7, 8}))
    (folder / 'fastrtps_port7000_el').touch()
    assert {'fastrtps_port7000', 'fastrtps_port7000_el'} <= names(stale(folder, set()))


@pytest.fixture
def two():
    """
    Return two processes with a participant each, with their segments and domains.

    In one domain each would map what the other one makes.

    """
    script = 'import rclpy; rclpy.init(); n = rclpy.create_node("n"); print(flush=True); input()'
    with contextlib.ExitStack() as stack:
        made = []
        for _ in range(2):
            domain = stack.enter_context(free_domain())
            process = subprocess.Popen(
                [sys.executable, '-c', script],
                env=child_environment(domain),
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
            )
            stack.enter_context(process)
            stack.callback(process.kill)
            assert process.stdout.readline() == b'\n'
            files = set(domains.files_of(Path(f'/proc/{process.pid}'), SHARED_MEMORY))
            segments = {path for path in files if SEGMENT_NAME.match(path.name)}
            made.append((process, segments, domain))
        yield made


def test_what_a_killed_process_leaves_is_removed_and_a_living_one_keeps_its_own(two, wait_for):
    def remove_until_gone(paths, domain):
        """Another process that removes what is stale may hold a lock for a moment."""
        wait_for(
            lambda: not any(path.exists() for path in paths),
            'the end of what a killed process left',
            meanwhile=lambda: remove_stale({domain}),
        )

    (killed, left, domain), (living, kept, other) = two
    killed.kill()
    killed.wait()
    assert left
    assert kept
    remove_until_gone(left, domain)
    assert all(path.exists() for path in kept)
    living.kill()
    living.wait()
    remove_until_gone(kept, other)


@pytest.fixture
def runs(tmp_path, shared_memory):
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


def test_after_a_failure_nothing_is_held(runs, tmp_path, refused):
    make, cleaned = runs
    with refused('why_2'), make('failed'):
        raise ValueError('why')
    assert cleaned == []
    descriptor = os.open(tmp_path, os.O_RDONLY)
    fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
    os.close(descriptor)
