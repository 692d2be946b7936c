# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Limits of all that is read: bytes, depth, values, columns; texts and JSON within them.

A small file may come to very much. Every reader takes its limit from here, before it reads.

"""

import json
from pathlib import Path
from typing import Any

from surrogate.files import InputError

MEGA = 1_000_000
TEXT = 8 * MEGA
"""
Largest YAML, and JSON other than a log [byte]; a larger text of signals is read by a process of
its own.
"""
TABLE = 64 * MEGA
"""
Largest table that is read as one text [byte], such as JSON, XML, lines of an adapter and a value
a line.
"""
DEPTH = 64
"""Most parts within parts of YAML and JSON, and within a column of Parquet."""
VALUES = 100_000
"""Most values of a YAML text, those of an alias as often as it stands."""
MESSAGE = 32 * MEGA
"""Largest message of a bag, unpacked [byte]."""
CHUNK = 64 * MEGA
"""Most that the records of a chunk come to, unpacked [byte]."""
RECORDS = 500_000
"""Most records of a chunk; of one with fewer bytes in its file as many as those."""
SUMMARY = 32 * MEGA
"""Largest summary of an MCAP file [byte]."""
WAITING = 64 * MEGA
"""
Most that messages hold which wait for earlier ones [byte]; beyond, the first of them waits no
longer.
"""
PACKING = 200
"""
Largest size of what is unpacked over that of its file [-]; `CHUNK` is always allowed, of Parquet
`WORKBOOK`, and arrays come to `SPARSE` at most.
"""
COLUMNS = 5000
"""Most columns of a table."""
LINE = 4 * MEGA
"""Longest line of a table [byte]."""
WORKBOOK = 512 * MEGA
"""
Largest workbook and text of gzip, unpacked, text of UTF-16, and file of MATLAB, HDF5, TDMS or MDF;
what columns of a Parquet file may always come to [byte].
"""
XLSX_CELL = 80
"""What a cell of a workbook takes in memory while it is read, as measured [B]."""
NUMBER_CELL = 8
"""What a number of a Parquet file or of a signal takes in memory while it is read [B]."""
RECORD_CELL = 64
"""What a cell of a record of JSON or XML takes in memory while it is read, as measured [B]."""
CELLS_HERE = 128 * MEGA
"""
What the cells of a text of signals may come to [byte] that is read at once; one of more is read by
a process of its own.
"""
TEXT_CELL = 16
"""What a text in a column of a signal takes in memory while it is read, at least [B]."""
SPARSE = 640 * MEGA
"""What rows x columns x cell of any workbook, and of signals side by side, may come to [byte]."""
MEMORY = 1600 * MEGA
"""
What those of the largest workbook may come to, and the process that reads a workbook or signals
[byte].
"""
FOOTER = 2000
"""
Longest footer of a Parquet file that is read at once [B]: a level takes six bytes, and 400
levels do no harm.
"""
SURFACE = 256 * 2**20
"""Largest surface file, and the most that it may come to when unpacked [byte]."""
# Of an operating point, asked or on file.
SPEED, LOAD = 1e5, 1e7  # [rev/min], [N]
COLDEST, HOTTEST = -60.0, 250.0  # [degC]


def most_unpacked(size: int) -> int:
    """Return what a file of a size [byte] may come to when it is unpacked [byte]."""
    return max(PACKING * size, CHUNK)


def read_text(path: str | Path, *, encoding: str = 'utf-8', most: int = TEXT) -> str:
    """Return a text of `most` bytes; raises InputError, OSError and UnicodeDecodeError."""
    with Path(path).open(encoding=encoding) as stream:
        text = stream.read(most + 1)
    if len(text) > most:
        raise InputError(f'it is larger than {most / MEGA:g} MB')
    return text


def read_json(text: str | bytes) -> Any:
    """Return the content of a JSON text; raises InputError."""
    if len(text) > TEXT:
        raise InputError(f'it is larger than {TEXT / MEGA:g} MB')
    try:
        content = json.loads(text)
    except (ValueError, RecursionError) as error:
        raise InputError(f'it is no JSON ({error})') from None
    if is_deeper(content, DEPTH):
        raise InputError(f'it nests deeper than {DEPTH}')
    return content


def is_deeper(content: Any, depth: int) -> bool:
    """Return True if lists and maps nest deeper than allowed."""
    if not isinstance(content, dict | list):
        return False
    parts = content.values() if isinstance(content, dict) else content
    held = (part for part in parts if isinstance(part, dict | list))
    return depth == 0 or any(is_deeper(part, depth - 1) for part in held)
