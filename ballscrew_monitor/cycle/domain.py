# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
A ROS domain that nobody on this machine uses: found, kept, and rid of what killed processes left.

Every DDS participant listens on UDP ports that follow from its domain and its number in it
(DDSI-RTPS 2.3, 9.6.1), so a port that cannot be bound betrays a participant. The port of a
number that no participant reaches serves as a lock between two runs that look at the same time;
it is set free whatever happens to the process.

A killed process leaves files of FastDDS in the shared memory. A segment of a participant has a
random name and a lock file, which its process keeps locked with flock(2) as long as it lives:
where the lock can be had the owner is gone for good, which is the rule of `fastdds shm clean` too.
A port has a number that another participant of the domain will want again, and not always a lock
file: its domain must be one in which nobody is. A file that any process has open or mapped is left
alone whatever its lock says: it may not be locked yet.

"""

import collections
from collections.abc import Collection, Iterable, Iterator
import contextlib
import fcntl
import os
from pathlib import Path
import random
import re
import socket

from surrogate.files import InputError

DOMAINS = range(1, 101)  # 0 is everybody's default; above, ports may be taken by any client
PORT_BASE, DOMAIN_GAIN, UNICAST_OFFSET, PARTICIPANT_GAIN = 7400, 250, 10, 2
PARTICIPANTS = range(10)  # numbers looked at; they are given out from 0
LOCK_PARTICIPANT = 119
LOOPBACK = '127.0.0.1'
SHARED_MEMORY = Path('/dev/shm')
# A segment or a port, its lock files, and the mutex of a port.
_FILE = re.compile(
    r'(?:sem\.)?(?P<name>fast(?:rtps|dds)_(?:port(?P<port>\d+)|[0-9a-f]{16}))(?:_el|_sl|_mutex)?'
)


def port(domain: int, participant: int) -> int:
    """Return the UDP port on which a participant of a domain listens for discovery."""
    return PORT_BASE + DOMAIN_GAIN * domain + UNICAST_OFFSET + PARTICIPANT_GAIN * participant


def is_free(domain: int) -> bool:
    """Return True if no participant on this machine listens in `domain`."""
    for participant in PARTICIPANTS:
        bound = _bind(port(domain, participant))
        if bound is None:
            return False
        bound.close()
    return True


@contextlib.contextmanager
def held(domain: int) -> Iterator[bool]:
    """Hold a domain, if it is free; yield True if it is."""
    lock = _bind(port(domain, LOCK_PARTICIPANT), LOOPBACK)
    if lock is None:
        yield False
        return
    with lock:
        yield is_free(domain)


@contextlib.contextmanager
def free_domain() -> Iterator[int]:
    """Give a free domain and hold it; raises InputError when all are taken."""
    for domain in random.sample(DOMAINS, len(DOMAINS)):
        with held(domain) as free:
            if free:
                yield domain
                return
    raise InputError(
        f'no free ROS domain among {DOMAINS[0]} to {DOMAINS[-1]}, '
        'end some of the programs that use one'
    )


def _bind(number: int, address: str = '') -> socket.socket | None:
    """Return a socket bound to a UDP port, None when somebody has it on any address."""
    bound = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    try:
        bound.bind((address, number))
    except OSError:
        bound.close()
        return None
    return bound


def remove_stale(free_domains: Collection[int], folder: Path = SHARED_MEMORY) -> None:
    """Remove what nobody uses; nobody may be in `free_domains`, nor come into them meanwhile."""
    if not folder.is_dir():
        return
    for path in stale(folder, free_domains):
        with contextlib.suppress(FileNotFoundError, PermissionError):
            path.unlink()


def stale(folder: Path, free_domains: Collection[int]) -> set[Path]:
    """Return the files of FastDDS in `folder` that are of this user and that nobody uses."""
    groups = collections.defaultdict(list)
    for path in folder.iterdir():
        with contextlib.suppress(FileNotFoundError):
            name = _FILE.fullmatch(path.name)
            if name and path.stat().st_uid == os.geteuid():
                groups[name['name'], name['port']].append(path)
    if not groups:
        return set()
    # Looked up after the files: whoever made one has it by now.
    processes = Path('/proc').glob('[0-9]*')
    used = {file for process in processes for file in files_of(process, folder)}
    return {
        path
        for (_, number), paths in groups.items()
        if not used.intersection(paths) and _is_left(paths, number, free_domains)
        for path in paths
    }


def _is_left(paths: Iterable[Path], number: str | None, free_domains: Collection[int]) -> bool:
    """Return True if the files of a segment, or of a port `number`, have nobody any more."""
    locks = [path for path in paths if path.name.endswith(('_el', '_sl'))]
    if any(map(_is_locked, locks)):
        return False
    if number is None or int(number) < PORT_BASE:  # below are the ports that are of no domain
        return bool(locks)
    return (int(number) - PORT_BASE) // DOMAIN_GAIN in free_domains


def _is_locked(path: Path) -> bool:
    """Return True if a process holds the lock file, or it is not ours to open."""
    try:
        with path.open('rb') as file:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except OSError:
        return True
    return False


def files_of(process: Path, folder: Path) -> Iterator[Path]:
    """Yield the files of `folder` that a process has, as far as /proc lets it be seen."""
    with contextlib.suppress(OSError):  # it has ended, or is of somebody else
        for line in (process / 'maps').read_text(errors='replace').splitlines():
            before, slash, name = line.partition(f' {folder}/')
            if slash:
                yield folder / name
        for opened in (process / 'fd').iterdir():
            with contextlib.suppress(OSError):
                yield Path(os.readlink(opened))
