# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Removes what killed processes have left of FastDDS in the shared memory.

A segment of a participant has a random name and a lock file, which its process keeps locked with
flock(2) as long as it lives: where the lock can be had the owner is gone for good, which is the
rule of `fastdds shm clean` too. A port has a number that another participant of the domain will
want again, and not always a lock file: its domain must be one in which nobody is. A file that any
process has open or mapped is left alone whatever its lock says: it may not be locked yet.

"""

import collections
from collections.abc import Collection, Iterable, Iterator
import contextlib
import fcntl
import os
from pathlib import Path
import re

from ballscrew_monitor.cycle.domain import DOMAIN_GAIN, PORT_BASE

SHARED_MEMORY = Path('/dev/shm')
PROCESSES = Path('/proc')
# A segment or a port, its lock files, and the mutex of a port.
_FILE = re.compile(
    r'(?:sem\.)?(?P<name>fast(?:rtps|dds)_(?:port(?P<port>\d+)|[0-9a-f]{16}))(?:_el|_sl|_mutex)?'
)


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
        found = _FILE.fullmatch(path.name)
        if found and _is_mine(path):
            groups[found['name'], found['port']].append(path)
    if not groups:
        return set()
    used = set(_used_files(folder))  # looked up after the files: whoever made one has it by now
    return {
        path
        for (_, port), paths in groups.items()
        if not used.intersection(paths) and _is_left(paths, port, free_domains)
        for path in paths
    }


def _is_left(paths: Iterable[Path], port: str | None, free_domains: Collection[int]) -> bool:
    """Tell whether the files of a segment, or of a `port`, have nobody any more."""
    locks = [path for path in paths if path.name.endswith(('_el', '_sl'))]
    if any(map(_is_locked, locks)):
        return False
    if port is None or int(port) < PORT_BASE:  # below are the ports that are of no domain
        return bool(locks)
    return domain_of(int(port)) in free_domains


def _is_mine(path: Path) -> bool:
    try:
        return path.stat().st_uid == os.geteuid()
    except FileNotFoundError:
        return False


def _is_locked(path: Path) -> bool:
    """Tell whether a process holds the lock file; one that is not ours to open counts as held."""
    try:
        with path.open('rb') as file:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except OSError:
        return True
    return False


def _used_files(folder: Path) -> Iterator[Path]:
    """Yield the files of `folder` that the processes of this user have open or mapped."""
    for process in PROCESSES.glob('[0-9]*'):
        yield from files_of(process, folder)


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


def domain_of(port: int) -> int:
    """Return the domain of the number of a port."""
    return (port - PORT_BASE) // DOMAIN_GAIN
