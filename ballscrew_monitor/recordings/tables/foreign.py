# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Files of controls and measuring systems that are no rows of cells: JSON, XML, SHDR, MATLAB, HDF5.

Each becomes a frame with a column for each signal, and its size is bounded before. What a library
reads, and a large text, is read by a process of bounded memory. A signal of other times than its
neighbours has rows of its own.

"""

from collections import Counter
from collections.abc import Callable, Iterator, Mapping
import contextlib
import dataclasses
import json
import math
from pathlib import Path
import re
from typing import Any
from xml.etree import ElementTree

from ballscrew_monitor.recordings.tables import (
    arrays,
    json_layouts,
    line_messages,
    long_form,
    waveforms,
)
from ballscrew_monitor.recordings.tables.apart import frame_apart
from ballscrew_monitor.recordings.tables.cells import first_line, readable, Unreadable
from ballscrew_monitor.recordings.tables.codings import text_of
from ballscrew_monitor.recordings.tables.heads import with_unit
from ballscrew_monitor.recordings.tables.layouts import (
    ADAPTER,
    format_of,
    FORMATS,
    period_of,
    RECORDER,
)
from ballscrew_monitor.recordings.tables.signals import columns_of_records, side_by_side, Signals
from polars.exceptions import PolarsError
from surrogate.files import InputError, limits

JSON = re.compile(rb'\{\s*["}]|\[\s*(?:[\[{"\]]|-?\d|null|true|false|NaN)')
"""How JSON begins; the name of a section in brackets does otherwise."""
NUMBERS = re.compile(rb'[\[,:"=]\s*-?\d[\d.eE+-]*\s*(?=[\],}"])')
"""Numbers of JSON, and those in quotes."""
DOCUMENT = re.compile('<!(?:DOCTYPE|ENTITY)', re.I)


def kind_of(head: bytes) -> str:
    """Return what a file is by its first bytes, empty for rows of cells."""
    return next((name for name, kind in KINDS.items() if kind.begins(head)), '')


def _text(head: bytes) -> bytes:
    return head.lstrip(b'\xef\xbb\xbf \t\r\n')


def _is_hdf(head: bytes) -> bool:
    return head.startswith((b'\x89HDF', b'MATLAB 7.3')) or head[512:516] == b'\x89HDF'


def _is_shdr(head: bytes) -> bool:
    if not line_messages.is_shdr(_text(head)):
        return False
    form = long_form.long_form(long_form.first_lines(head))
    return not (form and form.has_names)


def holds_numbers(head: bytes, kind: str, fewest: int) -> bool:
    """Return True if a file of a kind that begins so holds signals, so many numbers at least."""
    return kind not in ('json', 'xml') or len(NUMBERS.findall(head)) >= fewest


def read_signals(path: Path, kind: str) -> Signals:
    """Return the signals of a file of a kind; raises InputError."""
    size, most = path.stat().st_size, limits.WORKBOOK if KINDS[kind].is_binary else limits.TABLE
    if size > most:
        raise InputError(
            f'log {path} has more than {most // limits.MEGA} MB, allowed for its kind: save its '
            'signals as CSV or Parquet'
        )
    is_text = not KINDS[kind].is_binary and size <= limits.TEXT
    if is_text and _come_to(path, KINDS[kind].names) <= limits.CELLS_HERE:
        return _signals(path, kind)
    frame, told = frame_apart(path, f'{__name__}:write_signals', kind=kind)
    programs = {one.program: one for one in (*FORMATS, ADAPTER, RECORDER)}
    return Signals(frame=frame, **{**told, 'program': programs.get(told['program'])})


def _come_to(path: Path, names_of: re.Pattern[bytes] | None) -> int:
    """Return what cells of JSON or XML come to at most [byte]: a few names may be of many rows."""
    if names_of is None:
        return 0
    text = path.read_bytes()
    names = {match[1] for match in names_of.finditer(text)}
    records, cells = max(text.count(b'{'), text.count(b'rec')), text.count(b',')
    return len(names) * max(records * limits.RECORD_CELL, cells * limits.NUMBER_CELL)


def write_signals(inputs: Mapping[str, str]) -> dict[str, Any]:
    """Write the signals of a file `path` of a `kind` to `target`; raises InputError."""
    path, kind = Path(inputs['path']), inputs['kind']
    signals = _signals(path, kind)
    with readable(f'log {path} cannot be read', Exception):
        signals.frame.write_ipc(inputs['target'])
    names = [field.name for field in dataclasses.fields(signals) if field.name != 'frame']
    told = {name: getattr(signals, name) for name in names}
    return told | {'program': signals.program.program if signals.program else ''}


def _signals(path: Path, kind: str) -> Signals:
    with readable(f'log {path} cannot be read'), _of_its_kind(path, kind):
        signals = KINDS[kind].read(path)
    if not signals.frame.height:
        raise InputError(f'log {path} holds no signal with numbers')
    return signals


@contextlib.contextmanager
def _of_its_kind(path: Path, kind: str) -> Iterator[None]:
    """Raise InputError for all that a reader meets in a file that is not as its kind should be."""
    failure = f'log {path} cannot be read'
    try:
        yield
    except (InputError, PolarsError, MemoryError):
        raise
    except (Unreadable, json.JSONDecodeError, ElementTree.ParseError) as error:
        raise InputError(f'{failure}: {first_line(error)}') from None
    except RecursionError:
        raise InputError(f'{failure}: its lists nest too deeply') from None
    except Exception:
        raise InputError(
            f'{failure}, it must be {KINDS[kind].expected}: correct it, or save its signals as CSV'
        ) from None


def _xml(path: Path) -> Signals:
    """Return the signals of a trace: names by their keys, and a record for each time."""
    text = path.read_text('utf-8', errors='replace')
    if DOCUMENT.search(text):
        raise Unreadable('it states a type of document')
    root = ElementTree.fromstring(text)
    named, keys, rows, start = {}, {}, [], ''
    periods: set[float] = set()
    for element in root.iter():
        tag, held = element.tag.rpartition('}')[2], element.attrib
        if tag == 'signal' and 'key' in held:
            named[held['key']] = _name_of_signal(held)
        elif tag == 'dataSignal' and 'id' in held:
            own = _name_of_signal(held) if 'name' in held else ''
            keys[held['id']] = own or named.get(held.get('key', ''), held['id'])
            periods.add(period_of(held.get('interval', ''), 's'))
        elif tag == 'frameHeader':
            start = start or held.get('startTime', '')
        elif tag == 'rec':
            rows.append(dict(held))
    if not rows:
        raise TypeError
    counts = Counter(keys.values())
    names = {key: name if counts[name] == 1 else f'{name} {key}' for key, name in keys.items()}
    frame = side_by_side(columns_of_records(rows)).rename(names, strict=False)
    period = periods.pop() if len(periods) == 1 else math.nan
    return Signals(frame=frame, start=start, period=period)


def _name_of_signal(held: Mapping[str, str]) -> str:
    """Return axis, name and description of a signal of a trace, with its unit in brackets."""
    parts = (held.get(one, '') for one in ('axis', 'axisName', 'name', 'description'))
    unit = next((held[one] for one in ('units', 'unit', 'unitsType') if held.get(one)), '')
    return with_unit(' '.join(dict.fromkeys(part for part in parts if part)), unit)


def _long(path: Path) -> Signals:
    frame, separator = long_form.read_long(path)
    with path.open('rb') as stream:
        first = text_of(stream.read(limits.MEGA)).partition('\n')[0]
    return Signals(frame=frame, separator=separator, program=format_of(first))


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class Kind:
    """
    A kind of file: how it begins, what it must be, and the reader of all its signals.

    A library reads one that `is_binary`. Signals that are `grouped` are called as `run.speed`.
    Numbers in texts have a point in one that `is_pointed` by its rules. `names` finds those of
    cells in a text, whose records may be of more memory than it has bytes.

    """

    begins: Callable[[bytes], bool]
    expected: str
    read: Callable[[Path], Signals]
    is_binary: bool = False
    is_grouped: bool = False
    is_pointed: bool = False
    names: re.Pattern[bytes] | None = None


KINDS = {
    'tdms': Kind(
        begins=lambda head: head.startswith(b'TDSm'),
        expected='a TDMS file with channels of numbers',
        read=waveforms.read_tdms,
        is_binary=True,
        is_grouped=True,
    ),
    'mdf': Kind(
        begins=lambda head: head.startswith(b'MDF     '),
        expected='an MDF file with signals of numbers',
        read=waveforms.read_mdf,
        is_binary=True,
    ),
    'mat': Kind(
        begins=lambda head: head.startswith(b'MATLAB 5.0'),
        expected='a file of MATLAB with arrays of numbers',
        read=arrays.read_mat,
        is_binary=True,
        is_grouped=True,
    ),
    'hdf': Kind(
        begins=_is_hdf,
        expected='a file of HDF5 with arrays of numbers',
        read=arrays.read_hdf,
        is_binary=True,
        is_grouped=True,
    ),
    'json': Kind(
        begins=lambda head: bool(JSON.match(_text(head))),
        expected='a list of records, lists by the names of signals, or the trace of a data '
        'recorder',
        read=json_layouts.read_json,
        names=re.compile(rb'"((?:[^"\\]|\\.)*)"\s*:', re.S),
    ),
    'xml': Kind(
        begins=lambda head: _text(head).startswith(b'<'),
        expected='a trace with signals, frames and a record for each time',
        read=_xml,
        is_pointed=True,
        names=re.compile(rb'([^\s=<>"\']+)\s*=\s*["\']'),
    ),
    'shdr': Kind(
        begins=_is_shdr,
        expected='lines of an MTConnect adapter, a time and pairs of a name and a value each',
        read=line_messages.read_shdr,
        is_pointed=True,
    ),
    'echo': Kind(
        begins=lambda head: line_messages.is_echo(long_form.first_lines(head)),
        expected='the messages of one topic, a line each with numbers for all of its joints',
        read=lambda path: Signals(frame=line_messages.read_echo(path)),
        is_pointed=True,
    ),
    'long': Kind(
        begins=lambda head: long_form.long_form(long_form.first_lines(head)) is not None,
        expected='a table with a time, the name of a signal and its value in each line',
        read=_long,
    ),
}
"""Kinds of files by the names that `kind_of` returns; the first one counts that begins so."""
