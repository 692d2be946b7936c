# Copyright 2026 ballscrew_monitor contributors
# SPDX-License-Identifier: Apache-2.0
"""
Files of controls and measuring systems that are no rows of cells: JSON, XML, SHDR, MATLAB, HDF5.

Each becomes a frame with a column for each signal, and its size is bounded before. What a library
reads, and a large text, is read by a process of bounded memory. A signal of other times than its
neighbours has rows of its own.

"""

from collections import Counter
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
import contextlib
import dataclasses
import importlib
import json
import math
from pathlib import Path
import re
from typing import Any
from xml.etree import ElementTree

from ballscrew_monitor.core.conversions import SECOND
from ballscrew_monitor.recordings.tables import json_layouts, line_messages, long_form
from ballscrew_monitor.recordings.tables.apart import check_room, frame_apart
from ballscrew_monitor.recordings.tables.cells import first_line, readable, Unreadable
from ballscrew_monitor.recordings.tables.heads import factor_word, Head, Property, unlike
from ballscrew_monitor.recordings.tables.layouts import (
    ADAPTER,
    Format,
    format_of,
    FORMATS,
    LONGEST_PERIOD,
    OTHER_ROWS,
    RECORDER,
)
from ballscrew_monitor.recordings.tables.names import read_name
from ballscrew_monitor.recordings.tables.quantities import RATED
from ballscrew_monitor.recordings.tables.unit_names import BRACKETS, words_of
from ballscrew_monitor.recordings.words import listed
import numpy as np
import polars as pl
from polars.exceptions import PolarsError
from surrogate.files import InputError, limits

OF_RECORDER = {'LOAD': RATED, 'TORQUE': 'N m', 'CURRENT': 'A'}
"""Units of signals of a data recorder, which its file does not state."""
EXPECTED = {
    'json': 'a list of records, lists by the names of signals, or the trace of a data recorder',
    'xml': 'a trace with signals, frames and a record for each time',
    'shdr': 'lines of an MTConnect adapter, a time and pairs of a name and a value each',
    'echo': 'the messages of one topic, a line each with numbers for all of its joints',
    'long': 'a table with a time, the name of a signal and its value in each line',
    'mat': 'a file of MATLAB with arrays of numbers',
    'hdf': 'a file of HDF5 with arrays of numbers',
    'tdms': 'a TDMS file with channels of numbers',
    'mdf': 'an MDF file with signals of numbers',
}
"""What a file of each kind must be."""
OF_LISTS = 'its cells are lists'
SCALE_FACTOR, ADD_OFFSET, MISSING = 'scale_factor', 'add_offset', ('_FillValue', 'missing_value')
"""Attributes of the CF conventions: a value is the number times the factor plus the offset."""
BINARY = ('mat', 'hdf', 'tdms', 'mdf')
"""Kinds that libraries read."""
GROUPED = ('mat', 'hdf', 'tdms')
"""Kinds whose signals are in groups, as `run.speed`."""
NUMERIC = 'double single logical int8 int16 int32 int64 uint8 uint16 uint32 uint64'.split()
"""Classes of arrays of numbers in files of MATLAB."""
STEP, BEGIN, OFFSET = 'wf_increment', 'wf_start_time', 'wf_start_offset'
"""Properties of a waveform: its step [s], its start, and its first sample after that [s]."""
JSON = re.compile(rb'\{\s*["}]|\[\s*(?:[\[{"\]]|-?\d|null|true|false|NaN)')
"""How JSON begins; the name of a section in brackets does otherwise."""
NUMBERS = re.compile(rb'[\[,:"=]\s*-?\d[\d.eE+-]*\s*(?=[\],}"])')
"""Numbers of JSON, and those in quotes."""
NAMES_OF_CELLS = {
    'json': re.compile(rb'"((?:[^"\\]|\\.)*)"\s*:', re.S),
    'xml': re.compile(rb'([^\s=<>"\']+)\s*=\s*["\']'),
}
"""Names of cells in texts of signals."""
DOCUMENT = re.compile('<!(?:DOCTYPE|ENTITY)', re.I)
RATES = frozenset(
    'fs rate samplerate samplingrate samplefrequency samplingfrequency frequency'.split()
)
PERIODS = frozenset('ts dt sampletime samplingtime sampleperiod samplingperiod period'.split())
DOUBTFUL = frozenset('rate frequency period'.split())
"""Names of numbers that may be the rate or period of rows; the doubtful ones may be of others."""
SIGNATURES = ((b'TDSm', 'tdms'), (b'MDF     ', 'mdf'), (b'MATLAB 5.0', 'mat'), (b'\x89HDF', 'hdf'))


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class Signals:
    """
    Signals of a file as a frame, and what the file says besides them; a period in [s].

    Cells that are texts were parted by a `separator`; `factors` says of a signal that it may have
    to be scaled, `unclear_period` of numbers that they may be the period. `left_out` has the
    reason why a part of the file is not among them, by its name, and `more_rows` the records there
    of the same signals; `empty_rows` are numbers of records without any; `arrays` are the lengths
    of those that stand side by side.

    """

    frame: pl.DataFrame
    period: float = math.nan
    start: str = ''
    separator: str = ''
    program: Format | None = None
    factors: str = ''
    unclear_period: str = ''
    left_out: Mapping[str, str] = dataclasses.field(default_factory=dict)
    more_rows: int = 0
    empty_rows: Sequence[int] = ()
    arrays: Mapping[str, int] = dataclasses.field(default_factory=dict)

    def head(self) -> Head:
        """Return what the head of a text would say."""
        properties = {'start': Property(text=self.start, row=1)} if self.start else {}
        return Head(
            names=unlike(self.frame.columns),
            separator=self.separator,
            program=self.program,
            begin=0,
            first=1,
            properties=properties,
            period=self.period,
            unclear_period=self.unclear_period,
            factors=self.factors,
        )


def kind_of(head: bytes) -> str:
    """Return what a file is by its first bytes, empty for rows of cells."""
    for signature, kind in SIGNATURES:
        if head.startswith(signature):
            return kind
    if head.startswith(b'MATLAB 7.3') or head[512:516] == b'\x89HDF':
        return 'hdf'
    text = head.lstrip(b'\xef\xbb\xbf \t\r\n')
    if JSON.match(text):
        return 'json'
    if text.startswith((b'<?xml', b'<')):
        return 'xml'
    lines = long_form.first_lines(head)
    form = long_form.long_form(lines)
    if line_messages.is_shdr(text) and not (form and form.has_names):
        return 'shdr'
    if line_messages.is_echo(lines):
        return 'echo'
    return 'long' if form else ''


def holds_numbers(head: bytes, kind: str, fewest: int) -> bool:
    """Return True if a file of a kind that begins so holds signals, so many numbers at least."""
    return kind not in ('json', 'xml') or len(NUMBERS.findall(head)) >= fewest


def read_signals(path: Path, kind: str) -> Signals:
    """Return the signals of a file of a kind; raises InputError."""
    size, most = path.stat().st_size, limits.WORKBOOK if kind in BINARY else limits.TABLE
    if size > most:
        raise InputError(
            f'log {path} has more than {most // limits.MEGA} MB, allowed for its kind: save its '
            'signals as CSV or Parquet'
        )
    if kind not in BINARY and size <= limits.TEXT and _come_to(path, kind) <= limits.CELLS_HERE:
        return _signals(path, kind)
    frame, told = frame_apart(path, f'{__name__}:write_signals', kind=kind)
    programs = {one.program: one for one in (*FORMATS, ADAPTER, RECORDER)}
    return Signals(frame=frame, **{**told, 'program': programs.get(told['program'])})


def _come_to(path: Path, kind: str) -> int:
    """Return what cells of JSON or XML come to at most [byte]: a few names may be of many rows."""
    if kind not in NAMES_OF_CELLS:
        return 0
    text = path.read_bytes()
    names = {match[1] for match in NAMES_OF_CELLS[kind].finditer(text)}
    records, cells = text.count(b'{' if kind == 'json' else b'rec'), text.count(b',')
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
        signals = READERS[kind](path)
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
            f'{failure}, it must be {EXPECTED[kind]}: correct it, or save its signals as CSV'
        ) from None


def _json(path: Path) -> Signals:
    content = json_layouts.parsed(path.read_bytes())
    if limits.is_deeper(content, limits.DEPTH):
        raise Unreadable(f'it nests deeper than {limits.DEPTH}')
    header = content.get('Header') if isinstance(content, dict) else None
    if isinstance(header, dict) and 'SignalListHFData' in header:
        return _sinumerik_json(content)
    left_out, factors, more_rows = {}, '', 0
    content = json_layouts.plain_table(content)
    if isinstance(content, dict):
        lists = {key: value for key, value in content.items() if isinstance(value, list)}
        records = [key for key, one in lists.items() if one and isinstance(one[0], dict)]
        factors = ', '.join(_stated_factors(content))
        if not records:
            nested = {name for name, cells in lists.items() if any(map(_is_nested, cells))}
            lists = {name: cells for name, cells in lists.items() if name not in nested}
            period, unclear = _period_beside(content, lists)
            return Signals(
                frame=_side_by_side(lists),
                factors=factors,
                period=period,
                unclear_period=unclear,
                left_out=dict.fromkeys(sorted(nested), OF_LISTS),
                arrays=_lengths(lists),
            )
        chosen = max(records, key=lambda name: json_layouts.motion_of(lists[name]))
        content = json_layouts.plain_table(lists[chosen])
        others = [name for name in records if name != chosen]
        left_out = dict.fromkeys(others, f'the records of {chosen} are read')
        more_rows = sum(_rows_alike(lists[chosen], lists[name]) for name in others)
    if not _are_all(dict, content):
        raise TypeError
    nested = {name for one in content for name, cell in one.items() if _is_nested(cell)}
    return Signals(
        frame=_of_records(content, nested),
        left_out=left_out | dict.fromkeys(sorted(nested), OF_LISTS),
        more_rows=more_rows,
        empty_rows=[at + 1 for at, record in enumerate(content) if not record],
        factors=factors,
    )


def _is_nested(cell: Any) -> bool:
    return isinstance(cell, list | dict)


def _of_records(
    records: Sequence[Mapping[str, Any]], without: Collection[str] = ()
) -> pl.DataFrame:
    """Return records as rows, with a column for each name that one of them holds."""
    names = {name: None for record in records for name in record if name not in without}
    check_room(len(records), len(names), limits.RECORD_CELL)
    if len(names) > limits.COLUMNS:
        raise Unreadable(f'it has {len(names)} columns, allowed are {limits.COLUMNS}')
    return pl.from_dicts(
        [{name: record.get(name) for name in names} for record in records] if without else records,
        infer_schema_length=None,
    )


def _rows_alike(records: Sequence[Any], others: Sequence[Any]) -> int:
    """Return how many other records there are if they are of the signals of some, else 0."""
    held = [one[0].keys() if isinstance(one[0], dict) else set() for one in (records, others)]
    return len(others) if held[0] and held[0] <= held[1] else 0


def _period_beside(content: Mapping[str, Any], lists: Mapping[str, Any]) -> tuple[float, str]:
    """Return the period [s] that a number beside lists states, and what may be one if unclear."""
    stated = json_layouts.stated_periods(content)
    numbers = {key: one for key, one in content.items() if isinstance(one, int | float)}
    periods = stated | _periods(numbers)
    others = _of_other_rows(numbers)
    told = ', '.join(f'{name} = {numbers[name]:g}' for name in [*periods, *others])
    if others or _are_uneven(lists):
        period = math.nan
    elif len(periods) == 1 and stated:
        (period,) = stated.values()
        period = period if period <= LONGEST_PERIOD else math.nan
    else:
        period = _period_of_rows(periods, lists)
    return period, told if math.isnan(period) else ''


def _of_other_rows(content: Mapping[str, Any]) -> list[str]:
    """Return the names of numbers that make rows other than the samples of a period."""
    return [
        name
        for name, number in content.items()
        if OTHER_ROWS.search(' '.join(words_of(name)))
        and np.asarray(number).dtype.kind in 'iuf'
        and float(number) != 1.0
    ]


def _periods(numbers: Mapping[str, Any]) -> dict[str, float]:
    """Return the periods [s] that numbers may be by their names."""
    last = {name: re.sub('[_ ]', '', name.rpartition('.')[2].lower()) for name in numbers}
    return {
        name: 1.0 / float(value) if last[name] in RATES else float(value)
        for name, value in numbers.items()
        if last[name] in RATES | PERIODS and float(value) > 0.0
    }


def _stated_factors(content: Mapping[str, Any], before: str = '') -> Iterator[str]:
    """Yield numbers besides the signals that may scale these, by the words of their paths."""
    for key, value in content.items():
        name = f'{before}{key}'
        if isinstance(value, dict):
            yield from _stated_factors(value, f'{name}.')
            continue
        of = next((word for part in name.split('.') if (word := _factor(part))), '')
        if of and np.asarray(value).dtype.kind in 'iuf':
            if (np.asarray(value) != (0.0 if of == 'offset' else 1.0)).any():
                yield f'{name} {np.squeeze(value)}'


def _factor(label: str) -> str:
    """Return the word of a label for what scales or shifts the values, empty for any other."""
    return 'cal' if label.lower() == 'cal' else factor_word(label.replace('_', ' '))


def _sinumerik_json(content: Mapping[str, Any]) -> Signals:
    """Return the fast signals of a data recorder: a row for each cycle of the control."""
    header, parts = content['Header'], _list_of(dict, content.get('Payload'))
    listed = _list_of(dict, header['SignalListHFData'])
    if listed is None or not all('Name' in signal for signal in listed):
        raise Unreadable('SignalListHFData of its Header must be a list of signals with a Name')
    if parts is None or not _are_all(list, [p.get('HFData', []) for p in parts]):
        raise Unreadable('its Payload must be a list of parts, HFData in each a list of rows')
    names = []
    for signal in listed:
        name, axis = str(signal['Name']), str(signal.get('Axis', ''))
        plain, letter = name.split('|')[0], axis if re.fullmatch(r'[A-Za-z]\d?', axis) else ''
        plain = f'{plain} [{OF_RECORDER[plain]}]' if plain in OF_RECORDER else plain
        names.append(f'{letter} {plain}' if letter else plain)
    rows = [row for part in parts for row in part.get('HFData', ())]
    if not rows:
        raise Unreadable('no part of its Payload holds a row of HFData')
    if not _are_all(list, rows) or {*map(len, rows)} != {len(names)}:
        raise Unreadable(f'a row of HFData holds other than {len(names)} cells, one a signal')
    columns = list(zip(*rows, strict=True))
    held = {name: list(column) for name, column in zip(unlike(names), columns, strict=True)}
    begin, cycle = header.get('Initial'), header.get('CycleTimeMs') or math.nan
    if not isinstance(cycle, int | float):
        raise Unreadable('CycleTimeMs of its Header is no number')
    start = str(begin.get('Time', '')) if isinstance(begin, dict) else ''
    others = _of_other_rows({name: one for name, one in header.items() if np.ndim(one) == 0})
    unclear = [f'{name} = {header[name]:g}' for name in ('CycleTimeMs', *others) if others]
    return Signals(
        frame=pl.DataFrame(held, strict=False),
        period=math.nan if others else float(cycle) * 1e-3,
        unclear_period=', '.join(unclear),
        start=start,
        program=RECORDER,
    )


def _list_of(kind: type, values: Any) -> Any:
    """Return values if they are a list of a kind, else None."""
    return values if _are_all(kind, values) else None


def _are_all(kind: type, values: object) -> bool:
    return isinstance(values, list) and all(isinstance(one, kind) for one in values)


def _xml(path: Path) -> Signals:
    """Return the signals of a trace: names by their keys, and a record for each time."""
    text = path.read_text('utf-8', errors='replace')
    if DOCUMENT.search(text):
        raise Unreadable('it states a type of document')
    root = ElementTree.fromstring(text)
    named, keys, rows, start = {}, {}, [], ''
    for element in root.iter():
        tag, held = element.tag.rpartition('}')[2], element.attrib
        if tag == 'signal' and 'key' in held:
            parts = (held.get(one, '') for one in ('axis', 'axisName', 'name', 'description'))
            unit = held.get('units') or held.get('unit') or ''
            name = ' '.join(dict.fromkeys(part for part in parts if part))
            named[held['key']] = f'{name} [{unit}]' if unit else name
        elif tag == 'dataSignal' and 'id' in held:
            keys[held['id']] = held.get('name') or named.get(held.get('key', ''), held['id'])
        elif tag == 'frameHeader':
            start = start or held.get('startTime', '')
        elif tag == 'rec':
            rows.append(dict(held))
    if not rows:
        raise TypeError
    counts = Counter(keys.values())
    names = {key: name if counts[name] == 1 else f'{name} {key}' for key, name in keys.items()}
    frame = _of_records(rows).rename(names, strict=False)
    return Signals(frame=frame, start=start)


def _long(path: Path) -> Signals:
    frame, separator = long_form.read_long(path)
    with path.open('rb') as stream:
        first = long_form.decoded(stream.read(limits.MEGA)).partition('\n')[0]
    return Signals(frame=frame, separator=separator, program=format_of(first))


def _mat(path: Path) -> Signals:
    from scipy.io import loadmat, whosmat

    _check_arrays(shape for _, shape, kind in whosmat(path) if kind in NUMERIC)
    content = loadmat(path, squeeze_me=True, struct_as_record=False)
    held = {key: value for key, value in content.items() if not key.startswith('__')}
    return _arrays(dict(_flattened(held)))


def _flattened(content: Mapping[str, Any], before: str = '') -> Iterable[tuple[str, Any]]:
    """Yield the arrays of structures with their names, as `log.x.position`."""
    for key, value in content.items():
        name = f'{before}{key}'
        if hasattr(value, '_fieldnames'):
            fields = {field: getattr(value, field) for field in value._fieldnames}
            yield from _flattened(fields, f'{name}.')
        else:
            yield name, value


def _hdf(path: Path) -> Signals:
    h5py = _optional('h5py', path, 'HDF5 and MATLAB 7.3')
    found: dict[str, Any] = {}
    factors: list[str] = []
    datasets: dict[str, Any] = {}

    def visit(name: str, item: Any) -> None:
        called = name.replace('/', '.')
        if isinstance(item, h5py.Dataset):
            datasets[called] = item
        else:
            factors.extend(_unclear_factors(called, item.attrs))

    with h5py.File(path, 'r') as file:
        factors.extend(_unclear_factors('', file.attrs))
        file.visititems(visit)
        numeric = {
            called: item
            for called, item in datasets.items()
            if item.dtype.kind in 'iufb' or item.dtype.names
        }
        _check_arrays(one.shape or () for one in numeric.values() for _ in one.dtype.names or '-')
        for called, item in datasets.items():
            shape, is_numeric = item.shape or (), called in numeric
            if not is_numeric or not _columns_of(shape):  # it is not read
                found[called] = np.broadcast_to(0.0 if is_numeric else np.void(b' '), shape)
                continue
            for field in item.dtype.names or ():
                found[f'{called}.{field}'] = np.squeeze(item[field])
            if not item.dtype.names:
                units = np.ravel(item.attrs.get('unit', item.attrs.get('units', b'')))
                unit = units[0] if units.size else ''
                told = unit.decode() if isinstance(unit, bytes) else str(unit)
                found[f'{called} [{told}]' if told else called] = _scaled(item)
                factors.extend(_unclear_factors(called, item.attrs))
        signals = _arrays(found)
    told = ', '.join(filter(None, [*factors, signals.factors]))
    return dataclasses.replace(signals, factors=told)


def _scaled(dataset: Any) -> Any:
    """Return the values of a dataset, by the attributes that the CF conventions define."""
    values, attributes = np.squeeze(dataset[()]), dataset.attrs
    missing = [attributes[name] for name in MISSING if name in attributes]
    if not missing and not {SCALE_FACTOR, ADD_OFFSET} & set(attributes):
        return values
    known = np.where(np.isin(values, missing), math.nan, values)
    return known * attributes.get(SCALE_FACTOR, 1.0) + attributes.get(ADD_OFFSET, 0.0)


def _unclear_factors(name: str, attributes: Mapping[str, Any]) -> Iterable[str]:
    """Return attributes of a dataset that may scale it, which no convention defines."""
    known = (SCALE_FACTOR, ADD_OFFSET)
    numbers = {key: value for key, value in attributes.items() if key not in known}
    of = f'{name}: ' if name else ''
    return (f'{of}{told}' for told in _stated_factors(numbers))


def _columns_of(shape: Sequence[int]) -> int:
    """Return how many columns an array makes, 0 for one that is no table."""
    plain = [count for count in shape if count != 1]
    columns = min(plain) if len(plain) == 2 else 1
    return columns if len(plain) < 3 and columns <= limits.COLUMNS else 0


def _check_arrays(shapes: Iterable[Sequence[int]]) -> None:
    """Raise Unreadable if arrays of some shapes come to more than is allowed side by side."""
    tables = [shape for shape in shapes if math.prod(shape) > 1 and _columns_of(shape)]
    check_room(max(map(max, tables), default=0), sum(map(_columns_of, tables)))


def _arrays(content: Mapping[str, Any]) -> Signals:
    """Return arrays as signals: those of one length, and columns of a matrix, side by side."""
    held: dict[str, Any] = {}
    left_out: dict[str, str] = {}
    periods: dict[str, float] = {}
    for name, value in content.items():
        array = np.asarray(value)
        if array.dtype.kind not in 'iufb':
            left_out |= {name: 'it holds no numbers'} if array.size > 1 else {}
        elif array.ndim == 0:
            periods |= _periods({name: array})
        elif array.ndim == 1 and len(array) > 1:
            held[name] = array
        elif array.ndim == 2 and _columns_of(array.shape):
            tall = array if array.shape[0] >= array.shape[1] else array.T
            held |= {f'{name} {at + 1}': tall[:, at] for at in range(tall.shape[1])}
        elif array.size > 1:
            left_out[name] = f'it is an array of {" x ".join(map(str, array.shape))}'
    scalars = {name: value for name, value in content.items() if np.ndim(value) == 0}
    others = _of_other_rows(scalars)
    told = ', '.join(f'{name} = {float(content[name]):g}' for name in [*periods, *others])
    unknown = others or _are_uneven(held)
    period = math.nan if unknown else _period_of_rows(periods, held)
    return Signals(
        frame=_side_by_side(held, np.float64),
        period=period,
        factors=', '.join(_stated_factors(scalars)),
        unclear_period=told if math.isnan(period) else '',
        left_out=left_out,
        arrays=_lengths(held),
    )


def _period_of_rows(periods: Mapping[str, float], arrays: Iterable[str]) -> float:
    """Return the only period [s] if its name is plain and all arrays stand beside it, else NaN."""
    if len(periods) != 1:
        return math.nan
    ((name, period),) = periods.items()
    group, _, last = name.rpartition('.')
    beside = all(one.rpartition('.')[0] == group for one in arrays)
    plain = last.lower() not in DOUBTFUL
    return period if beside and plain and period <= LONGEST_PERIOD else math.nan


def _lengths(columns: Mapping[str, Any]) -> dict[str, int]:
    return {name: len(column) for name, column in columns.items()}


def _are_uneven(columns: Mapping[str, Any]) -> bool:
    """Return True if quantities are of several lengths: a period is that of one of them alone."""
    return len({len(column) for name, column in columns.items() if read_name(name).kind}) > 1


def _side_by_side(columns: Mapping[str, Any], kind: Any = None) -> pl.DataFrame:
    """Return columns of several lengths, of a kind, as a frame, those of one length together."""
    lengths = dict.fromkeys(len(column) for column in columns.values())
    height = max(lengths, default=0)
    check_room(height, len(columns))
    series = [
        pl.Series(
            name, column if kind is None else np.asarray(column, kind), strict=False
        ).extend_constant(None, height - length)
        for length in lengths
        for name, column in columns.items()
        if len(column) == length
    ]
    return pl.DataFrame(series)


def _tdms(path: Path) -> Signals:
    library = _optional('nptdms', path, 'TDMS', 'npTDMS')
    with library.TdmsFile.open(path) as file:
        groups = [group for group in file.groups() if group.channels()]
        channels = [channel for group in groups for channel in group.channels()]
        check_room(max(map(len, channels), default=0), len(channels))
        waves = {channel: Waveform.of(channel.properties) for channel in channels}
        timed = {channel.group_name for channel, wave in waves.items() if wave}
        left_out: dict[str, str] = {}
        held: dict[str, Any] = {}
        by_name: dict[str, Waveform | None] = {}
        for channel, wave in waves.items():
            before = f'{channel.group_name}.' if len(groups) > 1 else ''
            unit, name = channel.properties.get('unit_string', ''), f'{before}{channel.name}'
            if timed and channel.group_name not in timed:
                left_out[name] = f'its group states no {STEP}, and others do'
                continue
            name = f'{name} [{unit}]' if unit else name
            held[name] = channel[:]
            if held[name].dtype.kind in 'iufb':
                by_name[name] = wave
    return dataclasses.replace(_of_waveforms(held, by_name), left_out=left_out)


@dataclasses.dataclass(frozen=True, kw_only=True, slots=True)
class Waveform:
    """Times of the samples of a channel: an `offset` [ns] after a `start`, by a `step` [s]."""

    start: np.datetime64 | None
    offset: int
    step: float

    @classmethod
    def of(cls, properties: Mapping[str, Any]) -> 'Waveform | None':
        """Return what a channel states, None for one without a step."""
        step, start = float(properties.get(STEP, 0.0)), properties.get(BEGIN)
        begin = None if start is None else np.datetime64(start, 'ns')
        offset = round(float(properties.get(OFFSET, 0.0)) * SECOND)
        return cls(start=begin, offset=offset, step=step) if 0.0 < step < math.inf else None


def _of_waveforms(held: Mapping[str, Any], waves: Mapping[str, Waveform | None]) -> Signals:
    """Return channels of numbers, with a time before those that begin or step as no others do."""
    by_wave: dict[Waveform | None, list[str]] = {}
    for name, wave in waves.items():
        by_wave.setdefault(wave, []).append(name)
    bare, clocks = by_wave.pop(None, []), [wave for wave in by_wave if wave]
    starts = {wave.start for wave in clocks}
    told = '; '.join(f'{STEP} = {wave.step:g} of {listed(by_wave[wave])}' for wave in clocks)
    if len(clocks) > 1 and (bare or None in starts and len(starts) > 1):
        lacking = bare or [name for wave in clocks if wave.start is None for name in by_wave[wave]]
        raise Unreadable(
            f'its waveforms begin or step apart, {told}, and {listed(lacking)} states no '
            f'{STEP if bare else BEGIN}: write it into each channel, or save the signals as CSV '
            'with a column of the time'
        )
    if not clocks:
        return Signals(frame=_side_by_side(held), arrays=_lengths(held))
    first = min(clocks, key=lambda wave: _begin(wave))
    start = '' if first.start is None else str(first.start + np.timedelta64(first.offset, 'ns'))
    if len(clocks) == 1:
        unclear = f'{told}, none of {listed(bare)}' if bare else ''
        period = math.nan if bare else first.step
        return Signals(
            frame=_side_by_side(held),
            period=period,
            unclear_period=unclear,
            start=start,
            arrays=_lengths(held) if bare else {},
        )
    columns: dict[str, Any] = {}
    for wave in clocks:
        names = by_wave[wave]
        rows = np.arange(max(len(held[name]) for name in names))
        begin = (_begin(wave) - _begin(first)) / SECOND
        columns[f'{BRACKETS.sub("", names[0]).strip()} time [s]'] = begin + wave.step * rows
        columns |= {name: held[name] for name in names}
    return Signals(frame=_side_by_side(columns | dict(held)), start=start)


def _begin(wave: Waveform) -> int:
    """Return when the first sample of a waveform is [ns]."""
    return (0 if wave.start is None else int(wave.start.astype(np.int64))) + wave.offset


def _mdf(path: Path) -> Signals:
    file = _optional('asammdf', path, 'MDF').MDF(path)
    groups = file.groups
    check_room(
        sum(group.channel_group.cycles_nr for group in groups),
        sum(len(group.channels) - 1 for group in groups) + 1,
    )
    by_time: list[dict[str, Any]] = []
    counts: Counter[str] = Counter()
    for signal in file.iter_channels(copy_master=False):
        if signal.samples.dtype.kind in 'iuf' and signal.samples.ndim == 1:
            if not by_time or not np.array_equal(by_time[-1]['time [s]'], signal.timestamps):
                by_time.append({'time [s]': signal.timestamps})
            counts[signal.name] += 1
            several = counts[signal.name] > 1
            name = f'{signal.name} {counts[signal.name]}' if several else signal.name
            by_time[-1][f'{name} [{signal.unit}]' if signal.unit else name] = signal.samples
    frames = [pl.DataFrame(columns) for columns in by_time]
    frame = pl.concat(frames, how='diagonal').sort('time [s]') if frames else pl.DataFrame()
    return Signals(frame=frame, start=str(file.header.start_time))


def _optional(module: str, path: Path, what: str, package: str = '') -> Any:
    """Return a module that users install for one kind of file; raises InputError without it."""
    try:
        return importlib.import_module(module)
    except ImportError:
        raise InputError(
            f'log {path} is a file of {what}, which needs the package {package or module}: pip '
            f'install {package or module}, or save its signals as CSV'
        ) from None


READERS: dict[str, Callable[[Path], Signals]] = {
    'json': _json,
    'xml': _xml,
    'shdr': lambda path: Signals(frame=line_messages.read_shdr(path), program=ADAPTER),
    'echo': lambda path: Signals(frame=line_messages.read_echo(path)),
    'long': _long,
    'mat': _mat,
    'hdf': _hdf,
    'tdms': _tdms,
    'mdf': _mdf,
}
"""Readers of each kind of file; each returns all signals."""
