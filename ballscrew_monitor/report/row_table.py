# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
The rows of one axis on disk: a plain file of the columns that pages and tables ask for.

Rows come as they are judged and are appended, so that a recording larger than memory becomes one
file. Queries read a part of it after the other: no more of it is resident than a part.

"""

from collections.abc import Callable, Iterator
import enum
from pathlib import Path
from typing import Any

from ballscrew_monitor.core.conversions import Direction, Nut
from ballscrew_monitor.core.judgement import (
    ContactState,
    Level,
    PointSource,
    PointValidity,
    Reason,
    Zone,
)
import numpy as np
from numpy.typing import NDArray
import polars as pl
from polars.io.plugins import register_io_source
from surrogate.surface import Regime

PART = 16_384
"""Rows of a part, of 120 bytes each."""
ROW_GROUP = 65_536
"""Rows of a group in the Parquet that users get."""


COLUMNS: dict[str, Any] = {
    'stamp': np.int64,
    'log_time': np.int64,
    'speed': np.float64,
    'axial_load': np.float64,
    'temperature': np.float64,
    'motor_torque': np.float64,
    'speed_source': PointSource,
    'axial_load_source': PointSource,
    'temperature_source': PointSource,
    'motor_torque_source': PointSource,
    'direction': Direction,
    'validity': PointValidity,
    'efficiency': np.float64,
    'rcs': np.float64,
    'film_ratio': np.float64,
    'friction_torque': np.float64,
    'machine_torque': np.float64,
    'axial_load_uncertainty': np.float64,
    'worst_nut': Nut,
    'regime': Regime,
    'contact_state': ContactState,
    'gates': np.uint8,
    'zone': Zone,
    'reason': Reason,
    'level': Level,
    'event_id': np.uint32,
    'tick': np.bool_,
    'published': np.bool_,
}
"""Type of each column, or the class of its codes: numbers in the file, words in the table."""
FIELDS = {name: name for name in COLUMNS} | {'log_time': 'now', 'worst_nut': 'machine_nut'}
"""Field of a row that a column holds."""
CODES = {name: kind for name, kind in COLUMNS.items() if issubclass(kind, enum.IntEnum)}
WORDS = {
    name: pl.Series(words, dtype=pl.Enum(words))
    for name, kind in CODES.items()
    for words in [[member.name for member in kind]]
}
"""Words for the codes of a column, in their order."""
STORED = np.dtype([(name, np.uint8 if name in CODES else kind) for name, kind in COLUMNS.items()])
"""A row in the file."""


class RowTable:
    """The rows of one axis in a file."""

    def __init__(self, path: Path) -> None:
        self.rows, self._path = 0, path

    def add(self, rows: NDArray[Any]) -> None:
        """Append rows, an array of ROW with at least one."""
        stored = np.empty(len(rows), STORED)
        for name, field in FIELDS.items():
            stored[name] = rows[field]
        with self._path.open('ab') as file:
            file.write(stored.tobytes())
        self.rows += len(rows)

    def parts(self, *, ahead: int = 0) -> Iterator[pl.DataFrame]:
        """Yield the rows in parts, each with as many of the next one as lie `ahead`."""
        for begin in range(0, self.rows, PART):
            offset = begin * STORED.itemsize
            yield frame_of(np.fromfile(self._path, STORED, PART + ahead, offset=offset))

    def collect(
        self, query: Callable[[pl.LazyFrame], pl.LazyFrame], *, ahead: int = 0
    ) -> pl.DataFrame:
        """Return what a query finds in each part, one below the other; there must be a row."""
        return pl.concat([query(part.lazy()).collect() for part in self.parts(ahead=ahead)])


def frame_of(stored: NDArray[Any]) -> pl.DataFrame:
    """Return the columns of rows, an array of STORED."""
    return pl.DataFrame({name: np.ascontiguousarray(stored[name]) for name in COLUMNS})


class RowStore:
    """Keeps the rows of all axes in a folder, which is a `scratch_folder`."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self._tables: dict[str, RowTable] = {}

    def add(self, axis: str, rows: NDArray[Any]) -> None:
        """Keep rows, an array of ROW with at least one."""
        if axis not in self._tables:
            self._tables[axis] = RowTable(self._folder / f'{len(self._tables)}.rows')
        self._tables[axis].add(rows)

    def table(self, axis: str) -> RowTable:
        """Return the rows of an axis that has some."""
        return self._tables[axis]

    def write(self, path: Path) -> None:
        """Write all rows as Parquet, those of an axis after those of the one before."""
        schema = _named('', frame_of(np.empty(0, STORED))).schema

        def named(*_: object) -> Iterator[pl.DataFrame]:
            for axis, table in self._tables.items():
                yield from (_named(axis, part) for part in table.parts())

        frames = register_io_source(named, schema=schema)
        frames.sink_parquet(path, compression='zstd', row_group_size=ROW_GROUP)


def _named(axis: str, frame: pl.DataFrame) -> pl.DataFrame:
    words = (WORDS[name].gather(frame[name]).alias(name) for name in WORDS)
    whose = pl.Series('axis', [axis], dtype=pl.String).new_from_index(0, frame.height)
    return frame.with_columns(*words).insert_column(0, whose)
