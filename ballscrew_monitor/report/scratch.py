# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Hidden folders for what waits while a report is made, which do not outlive the reports.

A process keeps a lock in its folder as long as it lives, so that one that was left by a killed
process is known from one in use, also on a network file system that knows locks.

"""

from collections.abc import Iterator
import contextlib
import fcntl
from pathlib import Path
import shutil
import uuid

PREFIX, LOCK = '.rows-', 'lock'


@contextlib.contextmanager
def scratch_folder(directory: Path) -> Iterator[Path]:
    """Give a folder in `directory` until the block ends, and remove what was left of others."""
    directory.mkdir(parents=True, exist_ok=True)
    remove_left(directory)
    # Named before it is there, so that no interrupt comes between its making and the `try`.
    folder = directory / f'{PREFIX}{uuid.uuid4().hex}'
    try:
        folder.mkdir(mode=0o700)
        with (folder / LOCK).open('w') as lock:
            with contextlib.suppress(OSError):  # without locks there, nobody removes what is left
                fcntl.flock(lock, fcntl.LOCK_EX)
            yield folder
    finally:
        shutil.rmtree(folder, ignore_errors=True)


def remove_left(directory: Path) -> None:
    """Remove the folders in `directory` whose process is gone."""
    for folder in directory.glob(f'{PREFIX}*'):
        with contextlib.suppress(OSError), (folder / LOCK).open('r+') as lock:
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
            shutil.rmtree(folder, ignore_errors=True)
