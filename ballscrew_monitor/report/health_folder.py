# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
A folder of collected logs: for each log and axis one Parquet file of a few kB.

Files lie in machine=M/axis=A/day=YYYY-MM-DD. Their columns are the fields of `CELL` with machine,
axis and log beside them; `facts` holds all else as JSON in the first row. The name of a file says
which log it is of, in which version, and how many further axes of that log follow: they are
written down to 0, so a log is complete once that one is there.

"""

from collections.abc import Iterator, Mapping, Sequence
import dataclasses
import hashlib
import json
import os
from pathlib import Path
import re
from typing import Any
from urllib.parse import quote, unquote

from ballscrew_monitor.health.bands import day_of
from ballscrew_monitor.health.records import CELL
from ballscrew_monitor.health.summary import array_of, date_text
from ballscrew_monitor.recordings.declared import record_of
from ballscrew_monitor.report.health_history import AxisHistory
import polars as pl
from surrogate.files import InputError, new_file, to_json
from surrogate.files.limits import MEGA

VERSION = 1
"""Version of what is collected; logs of another one are collected again."""
MACHINE, AXIS, DAY = 'machine=', 'axis=', 'day='
NAME = re.compile(r'[0-9a-f]{16}-[0-9a-f]{16}-\d+\.parquet')
LONGEST_NAME = 200
"""Bytes of the name of a folder, of which file systems allow 255."""
LARGEST = 8 * MEGA
"""Largest file of one log [byte]."""
MOST_CELLS = 100_000
COLUMNS = ('machine', 'axis', 'log', 'cells')  # fields with columns of their own


def identity_of(log: Path, given: Sequence[Path | None]) -> str:
    """
    Return place and version of a log, by which its files are named.

    Size and time of modification tell a version, and so do the contents of what is `given`, such
    as a map, None for none.

    """
    files = sorted(path for path in log.rglob('*') if path.is_file()) if log.is_dir() else [log]
    parts: list[Any] = [VERSION]
    for file in files:
        status = file.stat()
        parts.append((file.name, status.st_size, status.st_mtime_ns))
    parts += [None if path is None else _digest(path.read_bytes()) for path in given]
    place = _digest(os.fsencode(os.path.abspath(log)))
    return f'{place}-{_digest(repr(parts).encode())}'


def _digest(content: bytes) -> str:
    return hashlib.sha256(content).hexdigest()[:16]


def is_health_folder(path: Path) -> bool:
    """Return True if a folder holds collected logs."""
    return path.is_dir() and any(path.glob(f'{MACHINE}*/{AXIS}*'))


def place_of(name: str) -> str:
    """Return the place of a log, by its identity or by the name of one of its files."""
    return name.partition('-')[0]


def held_logs(folder: Path) -> dict[str, list[Path]]:
    """Return the files of each log of a folder, by its place."""
    held: dict[str, list[Path]] = {}
    for axis_folder in axis_folders(folder).values():
        for path in _files(axis_folder):
            held.setdefault(place_of(path.name), []).append(path)
    return held


def is_complete(files: Sequence[Path], identity: str) -> bool:
    """Return True if the files of a log hold all of its axes in a version."""
    return any(path.name == f'{identity}-0.parquet' for path in files)


def keep(
    folder: Path, identity: str, histories: Sequence[AxisHistory], former: Sequence[Path]
) -> None:
    """Keep what a log holds of each of its axes, in place of the `former` files of that log."""
    kept = set()
    for left, history in zip(range(len(histories))[::-1], histories, strict=True):
        path = _place(folder, history) / f'{identity}-{left}.parquet'
        with new_file(path) as temporary:
            frame_of(history).write_parquet(temporary, compression='zstd', statistics=False)
        kept.add(path)
    for path in former:
        if path not in kept:
            path.unlink(missing_ok=True)


def frame_of(history: AxisHistory) -> pl.DataFrame:
    """Return the columns of a history."""
    plain, cells = dataclasses.asdict(history), array_of(history.cells)
    facts = json.dumps(to_json({k: v for k, v in plain.items() if k not in COLUMNS}))
    count, names = len(cells), {name: plain[name] for name in ('machine', 'axis', 'log')}
    return pl.DataFrame(
        {name: cells[name] for name in CELL.names or ()}
        | {name: [text] * count for name, text in names.items()}
        | {'facts': [facts, *[None] * (count - 1)]}
    )


def _place(folder: Path, history: AxisHistory) -> Path:
    day = date_text(day_of(history.first))
    machine, axis = (_name(text) for text in history.key)
    return folder / f'{MACHINE}{machine}' / f'{AXIS}{axis}' / f'{DAY}{day}'


def _name(text: str) -> str:
    """Return a name of a machine as the name of a folder."""
    name = quote(text, safe=' ')
    if len(name) <= LONGEST_NAME:
        return name
    return f'{quote(text[-LONGEST_NAME // 12 :], safe=" ")} {_digest(text.encode())}'


def axis_folders(folder: Path) -> dict[tuple[str, str], Path]:
    """Return the folder of each machine and axis, by the names that the folders bear."""
    return {
        (
            unquote(path.parent.name.removeprefix(MACHINE)),
            unquote(path.name.removeprefix(AXIS)),
        ): path
        for path in sorted(folder.glob(f'{MACHINE}*/{AXIS}*'))
        if path.is_dir()
    }


def _files(axis_folder: Path) -> Iterator[Path]:
    paths = sorted(axis_folder.glob(f'{DAY}*/*.parquet'))
    return (path for path in paths if NAME.fullmatch(path.name))


def read_axis(axis_folder: Path) -> tuple[list[AxisHistory], list[str]]:
    """
    Return the logs of one axis, and a sentence about each file that cannot be read.

    Of a log of which several versions are there, as when a run was killed, the newest counts.

    """
    newest: dict[str, Path] = {}
    for path in _files(axis_folder):
        other = newest.get(place_of(path.name))
        if other is None or other.stat().st_mtime_ns < path.stat().st_mtime_ns:
            newest[place_of(path.name)] = path
    histories, notes = [], []
    for path in newest.values():
        try:
            histories.append(read_entry(path))
        except InputError as error:
            notes.append(str(error))
    return histories, notes


def read_entry(path: Path) -> AxisHistory:
    """Return what a file of the folder holds; raises InputError for one that is damaged."""
    try:
        return _read(path)
    except InputError:
        raise
    except (OSError, ValueError, TypeError, KeyError, pl.exceptions.PolarsError) as error:
        raise _damaged(path, ' '.join(str(error).split())[:100]) from None


def _read(path: Path) -> AxisHistory:
    size = path.stat().st_size
    if size > LARGEST:
        raise _damaged(path, f'it has {size / MEGA:.0f} MB, allowed are {LARGEST / MEGA:.0f} MB')
    frame = pl.read_parquet(path, n_rows=MOST_CELLS + 1, use_statistics=False, glob=False)
    if not 0 < len(frame) <= MOST_CELLS:
        raise _damaged(path, f'it has {len(frame)} rows, allowed are 1 to {MOST_CELLS}')
    facts: Mapping[str, Any] = json.loads(frame['facts'][0])
    names = {name: frame[name][0] for name in ('machine', 'axis', 'log')}
    cells = frame.select(CELL.names or ()).to_dicts()
    return record_of(AxisHistory, {**facts, **names, 'cells': cells})


def _damaged(path: Path, why: str) -> InputError:
    return InputError(
        f'{path} is damaged and left out ({why}): delete it, and collect its log again'
    )
