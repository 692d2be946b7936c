# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
The rows of one axis on disk: an Arrow file of the columns that pages and tables ask for.

Rows come as they are judged, and some arrays of them become a record batch, so that a recording
larger than memory becomes one file. No library here appends to such a file, and the form is
simple: the schema, the batches, and a footer that lists where each of them lies. polars writes
each batch; the footer of the first of them is kept, with the list of all in the place of its own.

The file is mapped, not read. Queries go over parts of it, one after the other, so that no more of
it is resident than a part.

"""

from collections.abc import Callable, Iterator
import enum
import io
from pathlib import Path
import struct
from typing import Any, NamedTuple

from ballscrew_monitor.core.conversions import Direction, Nut
from ballscrew_monitor.core.judgement import (
    ContactState,
    Level,
    PointSource,
    PointValidity,
    Reason,
    Zone,
)
from ballscrew_monitor.judge.many import ROW
import numpy as np
from numpy.typing import NDArray
import polars as pl
from polars.io.plugins import register_io_source
from surrogate.surface import Regime

PART = 65_536
"""Rows of a part, of 120 bytes each."""
BATCH = 32_768
"""Rows from which on a record batch is written: to find a part, polars looks at every batch."""
MAGIC = b'ARROW1'
END = struct.pack('<iI', -1, 0)
"""First and last bytes of an Arrow file, and what ends its batches."""
BATCHES = 3  # number of the field of a footer that lists the batches
BLOCK = struct.Struct('<qi4xq')
"""Place of a batch in the file, and the bytes of its head and of its columns."""


class Column(NamedTuple):
    """Field of a row that a column holds, its type, and the class of its codes if it has some."""

    field: str
    kind: Any = np.float64
    codes: type[enum.IntEnum] | None = None


def _code(field: str, codes: type[enum.IntEnum]) -> Column:
    return Column(field, np.uint8, codes)


COLUMNS = {
    'stamp': Column('stamp', np.int64),
    'log_time': Column('now', np.int64),
    'speed': Column('speed'),
    'axial_load': Column('axial_load'),
    'temperature': Column('temperature'),
    'motor_torque': Column('motor_torque'),
    'speed_source': _code('speed_source', PointSource),
    'axial_load_source': _code('axial_load_source', PointSource),
    'temperature_source': _code('temperature_source', PointSource),
    'motor_torque_source': _code('motor_torque_source', PointSource),
    'direction': _code('direction', Direction),
    'validity': _code('validity', PointValidity),
    'efficiency': Column('efficiency'),
    'rcs': Column('rcs'),
    'film_ratio': Column('film_ratio'),
    'friction_torque': Column('friction_torque'),
    'machine_torque': Column('machine_torque'),
    'axial_load_uncertainty': Column('axial_load_uncertainty'),
    'worst_nut': _code('machine_nut', Nut),
    'regime': _code('regime', Regime),
    'contact_state': _code('contact_state', ContactState),
    'gates': Column('gates', np.uint8),
    'zone': _code('zone', Zone),
    'reason': _code('reason', Reason),
    'level': _code('level', Level),
    'event_id': Column('event_id', np.uint32),
    'tick': Column('tick', np.bool_),
    'published': Column('published', np.bool_),
}
"""The columns by name; codes are numbers in the file, words in the table that users get."""
WORDS = {
    name: pl.Series(words, dtype=pl.Enum(words))
    for name, column in COLUMNS.items()
    if column.codes
    for words in [[member.name for member in column.codes]]
}
"""Words for the codes of a column, in their order."""


def frame_of(rows: NDArray[Any]) -> pl.DataFrame:
    """Return the columns of rows, an array of ROW."""
    return pl.DataFrame(
        {name: rows[column.field].astype(column.kind) for name, column in COLUMNS.items()}
    )


class RowTable:
    """The rows of one axis in a file, which is whole when it has ended."""

    def __init__(self, path: Path) -> None:
        """Begin the file with the first rows."""
        self.rows = 0
        self._path, self._size = path, 0
        self._waiting: list[pl.DataFrame] = []
        self._blocks: list[bytes] = []
        self._footer = b''

    def add(self, rows: NDArray[Any]) -> None:
        """Write rows, an array of ROW with at least one, as soon as they make a batch."""
        self.rows += len(rows)
        self._waiting.append(frame_of(rows))
        if sum(map(len, self._waiting)) >= BATCH:
            self._add_batch()

    def _add_batch(self) -> None:
        written = io.BytesIO()
        pl.concat(self._waiting, rechunk=True).write_ipc(written, record_batch_size=self.rows)
        self._waiting.clear()
        file = written.getbuffer()
        footer, place = _footer_of(file)
        begin, head, body = BLOCK.unpack_from(footer, place)
        if not self._blocks:
            self._footer = footer
            self._write(file[:begin])  # with the schema
        self._blocks.append(BLOCK.pack(self._size, head, body))
        end = begin + head + body
        self._write(file[begin:end])

    def end(self) -> None:
        """Write the rest, and the list of the batches; nothing can be added afterwards."""
        if self._waiting:
            self._add_batch()
        footer = _with_blocks(self._footer, self._blocks)
        self._write(b''.join([END, footer, struct.pack('<i', len(footer)), MAGIC]))

    def _write(self, data: bytes | memoryview) -> None:
        with self._path.open('ab') as file:
            self._size += file.write(data)

    def parts(self, *, ahead: int = 0) -> Iterator[pl.LazyFrame]:
        """Yield the rows in parts, each with as many of the next one as lie `ahead`."""
        for begin in range(0, self.rows, PART):
            yield pl.scan_ipc(self._path).slice(begin, PART + ahead)

    def collect(
        self, query: Callable[[pl.LazyFrame], pl.LazyFrame], *, ahead: int = 0
    ) -> pl.DataFrame:
        """Return what a query finds in each part, one below the other; there must be a row."""
        return pl.concat([query(part).collect() for part in self.parts(ahead=ahead)])


def _footer_of(file: memoryview) -> tuple[bytes, int]:
    """Return the footer of an Arrow file, and the place in it of its only batch."""
    end = len(file) - len(MAGIC) - 4
    (size,) = struct.unpack_from('<i', file, end)
    begin = end - size
    footer = bytes(file[begin:end])
    at = _reference(footer)
    return footer, at + _unsigned(footer, at) + 4


def _reference(footer: bytes) -> int:
    """Return where a footer says how far away its list of batches is: a flatbuffer."""
    table = _unsigned(footer, 0)
    fields = table - struct.unpack_from('<i', footer, table)[0] + 4
    return table + int(struct.unpack_from('<H', footer, fields + 2 * BATCHES)[0])


def _unsigned(footer: bytes, at: int) -> int:
    return int(struct.unpack_from('<I', footer, at)[0])


def _with_blocks(footer: bytes, blocks: list[bytes]) -> bytes:
    """Return a footer that lists these batches; numbers of 8 bytes lie at multiples of 8."""
    longer = bytearray(footer) + bytes((4 - len(footer)) % 8)
    at = _reference(footer)
    struct.pack_into('<I', longer, at, len(longer) - at)
    return bytes(longer + struct.pack('<I', len(blocks)) + b''.join(blocks))


class RowStore:
    """Keeps the rows of all axes in a folder, which is a `scratch_folder`."""

    def __init__(self, folder: Path) -> None:
        """Begin with no row."""
        self._folder = folder
        self._tables: dict[str, RowTable] = {}

    def add(self, axis: str, rows: NDArray[Any]) -> None:
        """Keep rows, an array of ROW with at least one."""
        if axis not in self._tables:
            self._tables[axis] = RowTable(self._folder / f'{len(self._tables)}.arrow')
        self._tables[axis].add(rows)

    def end(self) -> None:
        """Let the tables be whole."""
        for table in self._tables.values():
            table.end()

    def table(self, axis: str) -> RowTable:
        """Return the rows of an axis that has some."""
        return self._tables[axis]

    def write(self, path: Path) -> None:
        """Write all rows as Parquet, those of an axis after those of the one before."""
        schema = _named('', frame_of(np.empty(0, ROW))).schema
        frames = register_io_source(lambda *_: self._frames(), schema=schema)
        frames.sink_parquet(path, compression='zstd', row_group_size=PART)

    def _frames(self) -> Iterator[pl.DataFrame]:
        for axis, table in self._tables.items():
            for part in table.parts():
                yield _named(axis, part.collect())


def _named(axis: str, frame: pl.DataFrame) -> pl.DataFrame:
    """Return a frame with its axis and the words of codes."""
    words = (WORDS[name].gather(frame[name]).alias(name) for name in WORDS)
    whose = pl.Series('axis', [axis], dtype=pl.String).new_from_index(0, frame.height)
    return frame.with_columns(*words).insert_column(0, whose)
