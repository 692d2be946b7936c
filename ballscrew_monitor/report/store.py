# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Judged rows as a Parquet file, and as blocks that can be read again while a report is made.

The blocks wait in a directory of their own until all are there, so that a recording larger than
memory becomes one file, and a report can go through them twice. Codes are stored by their names.
The directory is hidden and does not outlive the report: a process keeps a lock in it as long as it
lives, so that one that was left by a killed process is known from one in use, also on a network
file system that knows locks.

"""

from collections.abc import Iterator
import contextlib
import enum
import fcntl
from pathlib import Path
import shutil
from typing import Any
import uuid

from ballscrew_monitor.recordings.columns import CODED, COLUMNS, JudgedColumns
import numpy as np
import polars as pl
from surrogate.files import new_file

PREFIX, LOCK = '.rows-', 'lock'


def frame_of(block: JudgedColumns) -> pl.DataFrame:
    """Return a block of rows as a frame; the axis is its first column."""
    columns: dict[str, Any] = {'axis': [block.axis] * len(block)}
    for name in COLUMNS:
        values = getattr(block, name)
        columns[name] = _named(values, CODED[name]) if name in CODED else values
    return pl.DataFrame(columns, schema_overrides={'axis': pl.String})


def block_of(frame: pl.DataFrame) -> JudgedColumns:
    """Return a frame with rows of one axis, at least one, as a block."""
    arrays = {
        name: (frame[name].to_physical() if name in CODED else frame[name]).to_numpy()
        for name in COLUMNS
    }
    return JudgedColumns(
        axis=frame['axis'][0],
        **{name: np.ascontiguousarray(arrays[name], dtype=kind) for name, kind in COLUMNS.items()},
    )


def _named(values: Any, kind: type[enum.IntEnum]) -> pl.Series:
    names = [member.name for member in kind]
    return pl.Series(names, dtype=pl.Enum(names)).gather(values)


class RowStore:
    """
    Keeps blocks of rows on disk, by axis, in a `folder`.

    The folder is a `scratch_folder`, which goes with what else was put there.

    """

    def __init__(self, folder: Path) -> None:
        """Begin with no block."""
        self.folder = folder
        self._parts: dict[str, list[Path]] = {}
        self._count = 0

    def add(self, block: JudgedColumns) -> None:
        """Keep a block."""
        if len(block):
            part = self.folder / f'{self._count:06d}.arrow'
            frame_of(block).write_ipc(part)
            self._parts.setdefault(block.axis, []).append(part)
            self._count += 1

    def blocks(self, axis: str) -> Iterator[JudgedColumns]:
        """Yield the blocks of an axis in order."""
        for part in self._parts.get(axis, []):
            yield block_of(pl.read_ipc(part))

    def write(self, path: Path) -> None:
        """Write all rows as Parquet, which appears only when it is complete."""
        parts = [part for axis in self._parts.values() for part in axis]
        with new_file(path) as partial:
            if parts:
                pl.scan_ipc(parts).sink_parquet(partial, compression='zstd')
            else:
                nothing = {name: np.empty(0, kind) for name, kind in COLUMNS.items()}
                frame_of(JudgedColumns(axis='', **nothing)).write_parquet(partial)


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
