# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""Any log as a bag: a bag of whatever storage, or a table and the map of its columns."""

from pathlib import Path

from ballscrew_monitor.recordings.bag import Bag
from ballscrew_monitor.recordings.bag_files import ACTIVE, is_bag, is_table, kind_of
from ballscrew_monitor.recordings.words import Shown, shown_progress
from surrogate.files import InputError

SIGNALS = (b'PK', b'MATLAB', b'\x89HDF', b'TDSm', b'MDF ')
"""How files of signals begin."""
CONTROLS = set(range(9))
"""Bytes that no text holds."""


def opened_log(path: Path, *, mapping: Path | None = None, shown: Shown = shown_progress) -> Bag:
    """
    Return the log at `path` as a bag; one that has lost its end is read up to there.

    A table is looked through by the map in the file `mapping`; how far that is, is shown. Raises
    InputError when there is no log, or a map is missing or too much.

    """
    if not path.exists():
        raise InputError(f'log {path} does not exist, it must be a bag or a table')
    if path.is_dir() or is_bag(path):
        if mapping is not None:
            raise InputError(f'log {path} is a bag, a map is for tables')
        if path.is_dir() and not is_bag(path) and not any(path.glob(f'*{ACTIVE}')):
            tables = sorted(file.name for file in path.iterdir() if is_table(file))
            hint = (
                f'; its tables, such as {tables[0]}, are to be named one by one' if tables else ''
            )
            raise InputError(f'{path} holds no log, neither a bag nor a file of one{hint}')
        return Bag(path, salvage=True)
    may_be_table = is_table(path)
    if not may_be_table and path.is_file() and kind_of(path) != 'rosbag1':
        from ballscrew_monitor.recordings.tables.codings import GZIP, wide_coding

        with path.open('rb') as stream:
            head = stream.read(512)
        # A text, packed or not, or a file of signals may have any ending.
        is_known = head.startswith((*SIGNALS, GZIP)) or bool(wide_coding(head))
        may_be_table = is_known or not (head.startswith(b'\x89') or CONTROLS & set(head))
    if not may_be_table:
        raise InputError(
            f'log {path} is neither a bag nor a table, it must be of MCAP, sqlite3, CSV, Parquet, '
            'xlsx, or a file of signals'
        )
    if mapping is None:
        raise InputError(
            f'log {path} is no bag, a table needs a map: ballscrew import {path} --guess > '
            f'map.yaml, then --map map.yaml'
        )
    from ballscrew_monitor.recordings.tables.log import TableLog
    from ballscrew_monitor.recordings.tables.mapping import read_map

    return TableLog(path, read_map(mapping), shown)
