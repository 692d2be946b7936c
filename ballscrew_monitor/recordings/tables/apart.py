# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Frames that a process of bounded memory makes of a file, and what a frame may come to.

A library that reads files of others may abort, or ask for more memory than there is. Only its own
process ends then, and the log is refused in one sentence.

"""

from collections.abc import Mapping
import functools
import importlib
from pathlib import Path
import tempfile
from typing import Any

from ballscrew_monitor.recordings.tables.cells import Unreadable
import polars as pl
from surrogate.files import InputError, limits
from surrogate.tasks.child import result_apart


def frame_apart(path: Path, task: str, **inputs: str) -> tuple[pl.DataFrame, Mapping[str, Any]]:
    """
    Return the frame that a task makes of a file, and what else the task says of it.

    The task, `module:function`, finds the file under `path`, and writes the frame to `target` as
    Arrow. Raises InputError.

    """
    state = path.stat()
    stated = tuple(sorted(inputs.items()))
    return _read(task, path.resolve(), str(path), stated, state.st_mtime_ns, state.st_size)


@functools.lru_cache(maxsize=1)  # a log is opened again and again; its cells are a file in memory
def _read(
    task: str, place: Path, shown: str, inputs: tuple[tuple[str, str], ...], *state: int
) -> tuple[pl.DataFrame, Mapping[str, Any]]:
    with tempfile.TemporaryDirectory(prefix='ballscrew_table_') as folder:
        target = Path(folder) / 'cells.arrow'
        stated = {'path': shown, 'target': str(target), **dict(inputs)}
        failure = f'log {shown} cannot be read'
        result = result_apart(task, stated, memory=limits.MEMORY, failure=failure)
        return pl.read_ipc(target), result  # its memory is the file, which stays without its name


def library_of(module: str, path: Path, what: str, package: str = '') -> Any:
    """Return a library that users install for one kind of file; raises InputError without it."""
    try:
        return importlib.import_module(module)
    except ImportError:
        raise InputError(
            f'log {path} is a file of {what}, which needs the package {package or module}: pip '
            f'install {package or module}, or save its signals as CSV'
        ) from None


def check_room(rows: int, columns: int, cell: int = limits.NUMBER_CELL) -> None:
    """Raise Unreadable if rows x columns x cell [byte] are more than a table may come to."""
    come_to = rows * columns * cell
    if come_to > limits.SPARSE:
        raise Unreadable(
            f'{columns} columns of {rows} rows come to {come_to / limits.MEGA:.0f} MB at {cell} '
            f'bytes for a cell, allowed are {limits.SPARSE // limits.MEGA} MB: leave signals out '
            'of the file, or split it'
        )
